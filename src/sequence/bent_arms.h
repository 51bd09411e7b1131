#pragma once

#include <vector>

#include "product/product.h"
#include "sequence/giving_force.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

/** Finds what of a part bends aside where another one passes it: arms, or a wall that goes all the
 way round. The root of an arm is where the part is two and a half times as thick as at its
 thinnest, or ends.
 @param samples  Contacts of the way, as Extraction::SampleGiving() has them.
 @param inward_sign  1 where the normals of contact point into the part's material, else -1.
 @param way_W  Unit, the way of the part that moves; a contact is on the part as drawn once it is
 moved back by what has been travelled along it, where the part itself moves. */
[[nodiscard]] std::vector<BentArm> FindBentArms(const product::Product& product,
                                                const GivingPair& give,
                                                const GivingSamples& samples, double inward_sign,
                                                const Vec3& way_W);

}  // namespace hvas::sequence
