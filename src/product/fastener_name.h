#pragma once

#include <optional>
#include <string_view>

namespace hvas::product {

/** What the names of a part say about it. */
enum class FastenerKind { kNone, kScrew, kNut };

/** Reads names as "Screw", "bolt", "M3x16", "DIN 912", "ISO4762", "BHCS", "nut", "heat-set insert",
 "Zylinderschraube", "tuerca"; nuts and threaded inserts are kNut. What only goes with a fastener is
 kNone: "nut holder", "screw hole", "M4 spacer". Letters' case does not matter. */
[[nodiscard]] FastenerKind ClassifyName(std::string_view name);

/** Whether a name is that of a pin that is pressed in: "Dowel pin 3x10", "Stift". */
[[nodiscard]] bool IsPinName(std::string_view name);

/** A thread's size; `pitch` is 0 where it is not known. */
struct ThreadSize {
  double diameter{0};           ///< Nominal (major) [m].
  double pitch{0};              ///< [m]
  bool is_pitch_stated{false};  ///< False where it is the coarse one by rule.
};

/** The thread that a name states: "M3", "M8x1", "M3x0.5", "M3x16" (M3 coarse, 16 long), "M2.5",
 "M3x0,5", "1/4-20", "1/4 in - 20", "#10-32", "10-24 UNC", "3/8 16 UNC". A number after the size is
 a pitch when it is at most 0.3 of the diameter, else a length. A metric size without a pitch has
 the coarse one of ISO 261; an inch size counts only with its threads per inch. */
[[nodiscard]] std::optional<ThreadSize> ParseThreadSize(std::string_view name);

/** Coarse pitch of ISO 261 for a nominal diameter of its first and second choice, M1 to M64, within
 `tolerance` [m] of it; 0 where there is none. */
[[nodiscard]] double FindCoarsePitch(double diameter, double tolerance = 1e-6);

}  // namespace hvas::product
