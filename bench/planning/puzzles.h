#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "contact/shape.h"
#include "paths/way.h"

namespace hvas::bench {

/** Triangles in metres. */
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/** A part, what it is among, and where it has to go. */
struct Puzzle {
  std::string name;
  TriangleMesh part, around;
  std::shared_ptr<const contact::Shape> part_shape, around_shape;
  spatial::Pose X_WB_start;
  std::optional<spatial::Pose> X_WB_goal;
  double tolerance{50e-6};
  std::vector<paths::ScrewAxis> axes;
};

/** Reads a puzzle of OMPL.app: NAME.cfg and the meshes that it names. A unit is a millimetre here.
 The part's origin is the mean of its vertices, as OMPL.app has it.
 @param spacing  Of contact samples [m]; 0: as contact chooses. */
[[nodiscard]] Result<Puzzle> LoadPuzzle(const std::string& config, double spacing);

/** Reads a nut and a bolt of Factory, of a size as m16_tight. The nut is on the bolt, `along` [m]
 above where it has been put, as far round as the thread wants. */
[[nodiscard]] Result<Puzzle> LoadNut(const std::string& folder, const std::string& size,
                                     bool has_axis, double spacing);

/** Reads two meshes as they are assembled, in millimetres: FOLDER/0.obj is to come out of
 FOLDER/1.obj.
 @param has_surfaces  Whether surfaces are fitted to the triangles. */
[[nodiscard]] Result<Puzzle> LoadPair(const std::string& folder, bool has_surfaces, double spacing);

}  // namespace hvas::bench
