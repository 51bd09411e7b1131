#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "product/ids.h"

/** Parts that have to give to get to their places, or to let others get to theirs
 (docs/algorithms/flexible.md). */
namespace hvas::product {

struct Material;
struct Part;
struct Product;

/** What gives, and how. Records have the numbers: new kinds come last. */
enum class FlexibleKind {
  kStated,         ///< The user says so.
  kORing,          ///< It is stretched over a land, and squeezed in its groove.
  kRetainingRing,  ///< It is opened or closed by the depth of its groove.
  kSnapHook,       ///< A name alone: what of it bends, and how far, only its form says.
  kGasket,         ///< It is squeezed: seals.
  kSpring,
  kCable,   ///< It bends: cables, hoses, belts.
  kRubber,  ///< It is stretched: grommets, tyres, and what is of rubber.
  kRivet,   ///< Its second head is formed in its place.
  kForm,  ///< A wall or an arm of it bends: found where a way needs it (no part is classified so).
  kLipSeal,     ///< Its lip is spread by its shaft.
  kGrooveRing,  ///< It is drawn closed, and lies in a groove: it stretches, or is split.
  kBelt,        ///< It runs slack over what it goes round.
};

inline constexpr FlexibleKind kLastFlexibleKind = FlexibleKind::kBelt;

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

/** Recognises a part that gives by its form, with the allowance of its kind; its occurrence is left
 open. None where a part is rigid. */
[[nodiscard]] std::optional<FlexiblePart> ClassifyFlexibleByForm(const Part& part);

/** Recognises it by name and material alone. A name of a hook or a clip says nothing of how far it
 bends, and gives none. */
[[nodiscard]] std::optional<FlexiblePart> ClassifyFlexibleByWords(const Part& part);

/** Recognises it by its form; where that says nothing, by name and material. */
[[nodiscard]] std::optional<FlexiblePart> ClassifyFlexible(const Part& part);

/** Whether the file names rubber as a material. */
[[nodiscard]] bool IsRubber(const Material& material);

/** Allowance of a kind by the size of a part [m]; 0 where the kind has none. */
[[nodiscard]] double CalcAllowance(FlexibleKind kind, const Part& part);

/** Whether a part is stated to be rigid. */
[[nodiscard]] bool IsStatedRigid(const Product& product, OccurrenceId id);

/** What is known or stated of how a part gives; null where nothing is. */
[[nodiscard]] const FlexiblePart* FindFlexible(const Product& product, OccurrenceId id);

}  // namespace hvas::product
