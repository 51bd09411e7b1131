#pragma once

#include <string_view>

#include "base/result.h"
#include "product/product.h"

/** Mates that the user defines, changes and removes (X12). */
namespace hvas::mates {

/** What the user picked of an occurrence: one of its faces, or one of its features. */
struct Pick {
  product::OccurrenceId occurrence;
  product::FaceId face;        ///< Either this is valid,
  product::FeatureId feature;  ///< or this.
};

/** Makes the mate of two picked surfaces, in either order: two planes, a hole and a shaft, a
 conical seat and a taper, a socket and a ball. It has its key, surfaces, evidence, for axis-hole a
 proposed fit, MateOrigin::kUser and confidence 1, and the id that it would get next; it is not
 added.

 Where the parts are drawn mated, within the limits of inference, the frames are those that
 inference would give. Otherwise the second part counts as assembled where it comes from the drawn
 pose by the shortest turn and shift that fulfils the mate: planes with their centres on each other,
 shafts with the middles of the spans together where they do not engage, cones with gap zero,
 spheres with one centre.

 Fails, with a remedy, where the picks do not exist, belong to no feature (a face of a fillet or a
 free form), are of one occurrence, or of kinds or sizes that cannot mate (two holes, a plane and a
 shaft, a shaft far larger or smaller than the hole, cones of different angles), and where it
 contradicts the other mates of the two parts, as two axes square to each other would. Contacts of
 planes that inference found give way: parts may be drawn lying on each other by accident. A mate
 that is there already is returned as it is: with its id, which is below mates.size(), and its
 origin. */
[[nodiscard]] Result<product::Mate> MakeMate(const product::Product& product, const Pick& a,
                                             const Pick& b);

/** Makes a mate of two features anew, in the poses that the product has now; as the user's. Its id
 is the one that it would get next. */
[[nodiscard]] product::Mate RemakeMate(const product::Product& product, const product::Mate& mate);

/** True where the product's poses fulfil a mate within the limits of inference, a shaft engaged in
 its hole. */
[[nodiscard]] bool IsMated(const product::Product& product, const product::Mate& mate);

/** Adds a mate at the end and keeps ids and joints true. @returns its id. */
product::MateId AddMate(product::Product* product, product::Mate mate);

/** The mate that a text names: "m12" (its id), its key, or a beginning of its key that no other
 has. Fails where there is none or more than one. */
[[nodiscard]] Result<product::MateId> FindMate(const product::Product& product,
                                               std::string_view text);

/** Removes the mate that a text names (see FindMate), which inference leaves out from then on
 (Product::removed_mates), and keeps ids and joints true: the ids of the
 mates after it go down by one, keys stay. @returns the mate, as it was. */
[[nodiscard]] Result<product::Mate> RemoveMate(product::Product* product, std::string_view text);

}  // namespace hvas::mates
