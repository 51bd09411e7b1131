#pragma once

#include <string>
#include <vector>

#include "product/drive_forms.h"
#include "product/product.h"

namespace hvas::orders {

/** A cylinder about the axis of a ToolSpace, from one place of it to another [m]. */
struct ToolCylinder {
  double from{0};
  double to{0};
  double radius{0};
};

/** The space that a tool sweeps while it turns a fastener all the way in. */
struct ToolSpace {
  std::string tool;            ///< "hexagon key 5 mm", "socket 10 mm", "screwdriver".
  Vec3 p_WQ{Vec3::Zero()};     ///< Point of the axis: the open end of the drive, screwed in.
  Vec3 axis_W{Vec3::UnitZ()};  ///< Unit, out of the fastener.
  std::vector<ToolCylinder> cylinders;
};

/** The space of the usual tool on a drive. A hexagon key stands in its socket with the long arm and
 is turned by the short one (arms by ISO 2936); a hexagon outside is turned by a socket on an
 extension; slots and crosses by a screwdriver.
 @param axis_W  Unit, the fastener's way out. @param stroke  By which it comes out in turning [m].
 */
[[nodiscard]] ToolSpace MakeToolSpace(const product::DriveForm& drive, const spatial::Pose& X_WB,
                                      const Vec3& axis_W, double stroke);

/** Whether a part's mesh is in the space: exact for its triangles. */
[[nodiscard]] bool IsInToolSpace(const ToolSpace& space, const product::Part& part,
                                 const spatial::Pose& X_WB);

}  // namespace hvas::orders
