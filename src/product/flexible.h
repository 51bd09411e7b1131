#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "product/ids.h"

/** Parts that have to give to get to their places, or to let others get to theirs
 (docs/algorithms/flexible.md). */
namespace hvas::product {

struct Part;
struct Product;

/** What gives, and how. Records have the numbers: new kinds come last. */
enum class FlexibleKind {
  kStated,         ///< The user says so.
  kORing,          ///< It is stretched over a land, and squeezed in its groove.
  kRetainingRing,  ///< It is opened or closed by the depth of its groove.
  kSnapHook,       ///< It bends by its undercut.
  kGasket,         ///< It is squeezed: seals.
  kSpring,
  kCable,   ///< It bends: cables, hoses, belts.
  kRubber,  ///< It is stretched: grommets, tyres, and what is of rubber.
  kRivet,   ///< Its second head is formed in its place.
  kForm,  ///< A wall or an arm of it bends: found where a way needs it (no part is classified so).
  kLipSeal,  ///< Its lip is spread by its shaft.
};

[[nodiscard]] const char* ToString(FlexibleKind kind);

/** A part that may give, or is stated to be rigid. */
struct FlexiblePart {
  OccurrenceId occurrence;
  FlexibleKind kind{FlexibleKind::kStated};
  double allowance{0};  ///< How far it may give where it meets another part [m]; 0: it is rigid.
  std::string reason;   ///< What says so, in a few words.
};

/** What the name of a part says; none where it is that of something rigid, as "cable holder" is. */
[[nodiscard]] std::optional<FlexibleKind> FindFlexibleKind(std::string_view name);

/** Recognises a part that gives by its name, its material or its form, with the allowance of its
 kind; its occurrence is left open. None where a part is rigid. */
[[nodiscard]] std::optional<FlexiblePart> ClassifyFlexible(const Part& part);

/** Recognises it by name and material alone. */
[[nodiscard]] std::optional<FlexiblePart> ClassifyFlexibleByWords(const Part& part);

/** What is known or stated of how a part gives; null where nothing is. */
[[nodiscard]] const FlexiblePart* FindFlexible(const Product& product, OccurrenceId id);

}  // namespace hvas::product
