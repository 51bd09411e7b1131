#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "fits/pressed_parts.h"
#include "mates/side_file.h"
#include "product/product.h"

namespace hvas::mates {

/** Sets the parts of a product that push back: those that are recognised
 (product::FindElasticPart) and those that are stated, with what is stated of their sizes. Parts
 that are stated to be rigid, by an allowance of 0 or `--rigid`, push back only where they are
 stated here. To be called after SetFlexibleParts(). Errors: kNotFound for a name that nothing in
 the product has; kInvalid where a part is stated without a kind and none is recognised, or a size
 that its force depends on is not known. */
[[nodiscard]] Result<void> SetElasticParts(const std::vector<StatedElastic>& stated,
                                           product::Product* product);

/** How far a part is pressed together in its place by what is drawn or stated [m]; 0 where it is
 not. Parts along their axis: free length less the drawn one. */
[[nodiscard]] double CalcCompression(const product::ElasticPart& part);

/** The closed form of a part that is pressed along its axis; none where a size is not known, or its
 hole presses it. */
[[nodiscard]] std::optional<fits::PressedPart> MakePressedPart(const product::ElasticPart& part);

/** Radial force on the whole lip of a seal for each metre by which its shaft spreads it [N/m].
 @pre The sizes that it depends on are known. */
[[nodiscard]] double CalcLipStiffness(const product::ElasticPart& seal);

/** The size that the force of a part depends on and that is not known, as in "active coils"; empty
 where none is missing. */
[[nodiscard]] std::string FindMissingSize(const product::ElasticPart& part);

/** Describes sizes and force of a part, as in "wire 2 mm, mean diameter 18 mm, 6.5 active coils:
 27.5 N/mm; pressed together by 3 mm in its place: 82.5 N". */
[[nodiscard]] std::string DescribeElastic(const product::ElasticPart& part);

}  // namespace hvas::mates
