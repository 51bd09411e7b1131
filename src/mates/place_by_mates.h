#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/work_watch.h"
#include "product/product.h"

/** Assembled poses from the user's mates (X12, docs/algorithms/mates.md, section 6): what a CAD
 file never positioned is assembled where the mates say, and everything that asks for the assembled
 pose gets that one. */
namespace hvas::mates {

/** A mate of the user that the others do not allow. */
struct MateContradiction {
  std::string mate;                 ///< Its key.
  std::vector<std::string> others;  ///< Keys of those that exclude it; empty: not found out.
  std::string message;              ///< Which ones, and by how much it is off.
};

struct Placement {
  bool is_placed{
      false};  ///< Whether there are mates of the user that the drawn poses do not fulfil.
  std::vector<MateContradiction> contradictions;
  std::vector<product::Mate> removed;  ///< Mates of the assembled poses that are removed by key.
};

/** Sets the assembled poses (Occurrence::X_WB) of a product by its mates of the user. The drawn
 poses are kept in Product::placement, and are where it starts from each time.

 Where the drawn poses fulfil all of them, nothing changes, or the parts go back to these poses.
 Else parts that are drawn mated stay together as bodies, but for parts that the user's mates pull
 apart; in each group of bodies that mates join, the one with the largest part stays; the others go
 where the mates say, and as they are drawn in what the mates leave free (see PlaceBodies). Engaged
 inferred mates between the bodies hold as well; contacts of planes that the user's mates exclude do
 not. Then the mates are inferred anew in the assembled poses, without those of
 Product::removed_mates, and the user's are made anew there; fits that were stated stay, by key.

 A mate that contradicts earlier ones does not count. Product::placement.diagnostics has what the
 inference finds in the assembled poses, the contradictions ("mate-contradiction"), and what the
 user's mates leave free ("mate-freedom").
 Fails when the watch ends it; the product is then as it was. */
[[nodiscard]] Result<Placement> PlaceByMates(product::Product* product, WorkWatch* watch = nullptr);

/** Adds a mate of MakeMate(), or makes the one that is there already the user's, and places the
 parts. Fails where it contradicts the others; the product is then as it was. @returns its id. */
[[nodiscard]] Result<product::MateId> AddMateAndPlace(product::Product* product,
                                                      product::Mate mate);

/** Removes the mate that a text names (see FindMate), and places the parts.
 @returns the mate, as it was. */
[[nodiscard]] Result<product::Mate> RemoveMateAndPlace(product::Product* product,
                                                       std::string_view text);

}  // namespace hvas::mates
