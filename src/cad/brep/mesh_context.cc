#include "cad/brep/mesh_context.h"

#include <algorithm>

#include <BRepMesh_BoundaryParamsRangeSplitter.hxx>
// The last of these headers uses the other two without including them.
// clang-format off
#include <BRepMesh_DataStructureOfDelaun.hxx>
#include <BRepMesh_Delaun.hxx>
#include <BRepMesh_CustomDelaunayBaseMeshAlgo.hxx>
// clang-format on
#include <BRepMesh_DefaultRangeSplitter.hxx>
#include <BRepMesh_DelabellaBaseMeshAlgo.hxx>
#include <BRepMesh_DelaunayBaseMeshAlgo.hxx>
#include <BRepMesh_DelaunayDeflectionControlMeshAlgo.hxx>
#include <BRepMesh_DelaunayNodeInsertionMeshAlgo.hxx>
#include <BRepMesh_FaceDiscret.hxx>
#include <BRepMesh_MeshAlgoFactory.hxx>
#include <BRepMesh_NURBSRangeSplitter.hxx>
#include <IMeshData_Curve.hxx>
#include <IMeshData_Edge.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshData_Model.hxx>
#include <IMeshData_Wire.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressScope.hxx>

namespace hvas::cad {
namespace {

// Largest deflection inside faces over that of edges. Contact does not take distances from the mesh
// of an analytic face, so that angles limit it alone.
constexpr double kAnalyticInterior = 25;
constexpr double kAnalyticAngle = 0.3;  // [rad], inside spheres and tori, also drawn as splines.

/** The nodes that all faces of a shape may have together. Threads share it. */
struct NodeBudget {
  std::atomic<std::size_t>* nodes;
  std::size_t max_nodes;
};

/** Ends the refinement of one face when the budget is spent. The mesher asks between two nodes, and
 the triangles are whole whenever it stops. */
class BudgetIndicator : public Message_ProgressIndicator {
 public:
  explicit BudgetIndicator(const NodeBudget& budget) : budget_(budget) {}

  Standard_Boolean UserBreak() override { return budget_.nodes->load() > budget_.max_nodes; }

  void Show(const Message_ProgressScope& /*scope*/, const Standard_Boolean /*is_forced*/) override {
  }

 private:
  NodeBudget budget_;
};

/** Counts the nodes that the mesher adds: each is looked up on the surface once. */
template <typename Splitter>
class CountingSplitter : public Splitter {
 public:
  void Count(const NodeBudget& budget) const { nodes_ = budget.nodes; }

  [[nodiscard]] gp_Pnt Point(const gp_Pnt2d& p) const {
    if (nodes_ != nullptr) {
      ++*nodes_;
    }
    return Splitter::Point(p);
  }

 private:
  mutable std::atomic<std::size_t>* nodes_{
      nullptr};  // The algorithm hands its splitter out as const.
};

/** The algorithm of OpenCASCADE for faces that are drawn freely, within a budget. Analytic ones
 among them have the angle inside that those have which are drawn as what they are. */
template <typename Splitter>
class BoundedAlgo
    : public BRepMesh_DelaunayDeflectionControlMeshAlgo<CountingSplitter<Splitter>,
                                                        BRepMesh_DelaunayBaseMeshAlgo> {
  using Base = BRepMesh_DelaunayDeflectionControlMeshAlgo<CountingSplitter<Splitter>,
                                                          BRepMesh_DelaunayBaseMeshAlgo>;

 public:
  BoundedAlgo(const NodeBudget& budget, const TopTools_MapOfShape* analytic)
      : budget_(budget), analytic_(analytic) {}

  void Perform(const IMeshData::IFaceHandle& face, const IMeshTools_Parameters& parameters,
               const Message_ProgressRange& range) override {
    IMeshTools_Parameters own = parameters;
    if (analytic_ != nullptr && analytic_->Contains(face->GetFace())) {
      own.AngleInterior = std::max(own.AngleInterior, kAnalyticAngle);
    }
    Base::Perform(face, own, range);
  }

 protected:
  void postProcessMesh(BRepMesh_Delaun& mesher, const Message_ProgressRange& /*range*/) override {
    const opencascade::handle<BudgetIndicator> indicator = new BudgetIndicator(budget_);
    this->getRangeSplitter().Count(budget_);
#ifdef __clang_analyzer__  // The analyzer takes OpenCASCADE's counted references for leaks.
    (void)mesher;
#else
    Base::postProcessMesh(mesher, indicator->Start());
#endif
  }

 private:
  NodeBudget budget_;
  const TopTools_MapOfShape* analytic_;
};

/** Meshes planes with few points at their edges as OpenCASCADE does, and others by a triangulation
 whose time does not go with the square of their number. */
class PlaneAlgo : public IMeshTools_MeshAlgo {
 public:
  void Perform(const IMeshData::IFaceHandle& face, const IMeshTools_Parameters& parameters,
               const Message_ProgressRange& range) override {
    using Few = BRepMesh_DelaunayNodeInsertionMeshAlgo<BRepMesh_DefaultRangeSplitter,
                                                       BRepMesh_DelaunayBaseMeshAlgo>;
    using Many = BRepMesh_DelaunayNodeInsertionMeshAlgo<
        BRepMesh_DefaultRangeSplitter,
        BRepMesh_CustomDelaunayBaseMeshAlgo<BRepMesh_DelabellaBaseMeshAlgo>>;
    constexpr int kMany = 100;  // Below it the two ways take as long (bench/import_bench).
    Handle(IMeshTools_MeshAlgo) algo;
    if (CountPoints(face) > kMany) {
      algo = new Many;
    } else {
      algo = new Few;
    }
    algo->Perform(face, parameters, range);
  }

 private:
  static int CountPoints(const IMeshData::IFaceHandle& face) {
    int count = 0;
    for (int i = 0; i < face->WiresNb(); ++i) {
      const auto& wire = face->GetWire(i);
      for (int k = 0; k < wire->EdgesNb(); ++k) {
        count += wire->GetEdge(k)->GetCurve()->ParametersNb();
      }
    }
    return count;
  }
};

class AlgoFactory : public BRepMesh_MeshAlgoFactory {
 public:
  AlgoFactory(const NodeBudget& budget, const TopTools_MapOfShape* analytic)
      : budget_(budget), analytic_(analytic) {}

  Handle(IMeshTools_MeshAlgo) GetAlgo(const GeomAbs_SurfaceType type,
                                      const IMeshTools_Parameters& parameters) const override {
    switch (type) {
      case GeomAbs_Plane:
        return new PlaneAlgo;
      case GeomAbs_Cylinder:
      case GeomAbs_Cone:
      case GeomAbs_Sphere:
      case GeomAbs_Torus:
        return BRepMesh_MeshAlgoFactory::GetAlgo(type, parameters);
      case GeomAbs_SurfaceOfRevolution:
        return new BoundedAlgo<BRepMesh_BoundaryParamsRangeSplitter>(budget_, analytic_);
      default:
        return new BoundedAlgo<BRepMesh_NURBSRangeSplitter>(budget_, analytic_);
    }
  }

 private:
  NodeBudget budget_;
  const TopTools_MapOfShape* analytic_;
};

}  // namespace

Standard_Boolean MeshContext::PreProcessModel() {
  if (!BRepMesh_Context::PreProcessModel()) {
    return Standard_False;
  }
  if (analytic_ == nullptr) {
    return Standard_True;
  }
  // The edges have their points by now. Freeform faces go by the angle inside.
  ChangeParameters().Angle = std::max(GetParameters().Angle, kAnalyticAngle);
  for (int i = 0; i < GetModel()->FacesNb(); ++i) {
    const auto& face = GetModel()->GetFace(i);
    const double factor =
        analytic_->Contains(face->GetFace()) ? kAnalyticInterior : kFreeformInterior;
    face->SetDeflection(std::max(face->GetDeflection(), factor * deflection_mm_));
  }
  return Standard_True;
}

Standard_Boolean MeshContext::DiscretizeFaces(const Message_ProgressRange& range) {
  SetFaceDiscret(new BRepMesh_FaceDiscret(new AlgoFactory({&nodes_, max_nodes_}, analytic_)));
  return BRepMesh_Context::DiscretizeFaces(range);
}

}  // namespace hvas::cad
