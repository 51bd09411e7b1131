#pragma once

#include <functional>
#include <vector>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace hvas::cad {

/** What loose faces make when they are joined along common edges. */
struct SewnFaces {
  std::vector<TopoDS_Shape> solids;  ///< One for each closed shell that is no cavity.
  TopoDS_Shape open;       ///< A compound of the shells and faces that do not close; or null.
  int open_edges{0};       ///< Edges that only one face of `open` has.
  double tolerance_mm{0};  ///< Distance within which edges were one [mm].

  /** The face that a face became; itself where nothing is known. */
  std::function<TopoDS_Shape(const TopoDS_Shape&)> modified;
};

/** Joins faces whose edges lie within the tolerance [mm] of each other, and makes solids of what is
 closed then. A closed shell inside another one is a cavity in it, a shell in the cavity a solid
 again (even-odd rule). May throw what OpenCASCADE throws. */
[[nodiscard]] SewnFaces SewFaces(const std::vector<TopoDS_Shape>& faces, double tolerance_mm);

}  // namespace hvas::cad
