#pragma once

#include <atomic>
#include <cstddef>

#include <BRepMesh_Context.hxx>
#include <TopTools_MapOfShape.hxx>

namespace hvas::cad {

/** The deflection inside freeform faces over that of edges. */
inline constexpr double kFreeformInterior = 2;

/** How a shape is meshed by OpenCASCADE: faces have deflections of their own inside, and the work
 has a bound. The mesher adds nodes inside a freeform face until the deflection is met, and the time
 for one of them grows with their number, so that on a long, wound or badly parametrised surface it
 does not end. The bound counts nodes and not seconds: it is met or not, whatever the machine. */
class MeshContext : public BRepMesh_Context {
 public:
  /** @param analytic  The faces that need not be finer inside than their angle asks for; null: all
   faces are as fine inside as at their edges. Outlives the object.
   @param max_nodes  Of all faces together. */
  MeshContext(const TopTools_MapOfShape* analytic, double deflection_mm, std::size_t max_nodes)
      : analytic_(analytic), deflection_mm_(deflection_mm), max_nodes_(max_nodes) {}

  Standard_Boolean PreProcessModel() override;
  Standard_Boolean DiscretizeFaces(const Message_ProgressRange& range) override;

  /** Whether the bound was reached: some faces are coarser than wanted. */
  [[nodiscard]] bool is_bound_reached() const { return nodes_ > max_nodes_; }

 private:
  const TopTools_MapOfShape* analytic_;
  double deflection_mm_;
  std::size_t max_nodes_;
  std::atomic<std::size_t> nodes_{0};
};

}  // namespace hvas::cad
