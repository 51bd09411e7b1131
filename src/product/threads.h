#pragma once

#include "product/product.h"
#include "product/recognition_limits.h"

namespace hvas::product {

/** Sets Feature::thread and thread_pitch.

 Modelled: freeform faces around the axis of a hole or shaft whose normals fit a helical motion
 about it (for all of them n.(w x r) + h n.w = 0 with one h; Pottmann and Wallner, Computational
 Line Geometry, 2001, section 5.3), with a pitch 2 pi h of 4 to 40 % of the diameter over at least
 one and a half turns; or coaxial cones that alternate with one spacing (rings drawn for a thread).

 Nominal: by the part's name (ClassifyName) the shank of a screw and the bore of a nut; without a
 name the shank that stands on a hexagonal head or on a head with a hexagonal socket, and the bore
 of a hexagonal nut. Of several shank diameters it is the one at the end away from the head. The
 pitch is what the name states, else the coarse pitch of ISO 261 for the drawn diameter. @pre
 features of the part are there; part != nullptr.
 @param limits Gets the limits that were reached. */
void MarkThreads(Part* part, double tolerance, RecognitionLimits* limits);

/** Whether a screw with the helical faces about the axis of a feature goes in when it is turned
 counterclockwise; false where there are no such faces. */
[[nodiscard]] bool IsLeftHanded(const Part& part, const Feature& feature);

}  // namespace hvas::product
