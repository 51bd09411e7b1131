#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "base/random.h"
#include "fits/fit_force.h"
#include "fits/iso286.h"

/** Choice of the pair of parts that a fit is shown with. Sizes come from the tolerance zones, the
 surface B(l) from Rz. A pair from the zones of H7/k6 can have clearance, or interference, along its
 whole length; nobody can feel a transition fit with it. */
namespace hvas::fits {

enum class PairChoice : std::uint8_t {
  kOnePair,  ///< Sizes in mid zone; of a transition fit, hole and shaft of one size (paper W, 3.3).
  kOfKind,   ///< Sizes and surface are drawn again until ShowsKind.
  kAny,      ///< Sizes are drawn from the zones once.
};

inline constexpr std::array<std::string_view, 3> kPairChoices{"one-pair", "of-kind", "any"};

[[nodiscard]] constexpr std::string_view ToString(PairChoice choice) {
  return kPairChoices[static_cast<std::size_t>(choice)];
}

/** Most pairs that are drawn in search of one that shows its kind. A kind that one of 100 pairs
 shows is missed in 4 of 100,000 searches. */
inline constexpr int kMostPairsDrawn = 1000;

/** Shape of S(l) along the mating length, which is linear between its stations. */
struct ClearanceShape {
  int rises{0};                  ///< Number of stretches with S < 0: the steps of the force.
  double interference_share{0};  ///< Share of the length with S < 0.
};

/** @param clearances  S at equal steps from the mouth inwards, the ends included [m]. */
[[nodiscard]] ClearanceShape CalcClearanceShape(std::span<const double> clearances) noexcept;

/** Whether a pair shows the kind of its fit: S > 0 throughout, S < 0 throughout, or, for a
 transition fit, at least two rises of the force with a plateau between them, and S < 0 on one to
 four fifths of the length (paper W, 3.3: equation W(9) gives stairs where S changes its sign). */
[[nodiscard]] bool ShowsKind(std::span<const double> clearances, FitKind kind) noexcept;

/** The hole or the shaft of a pair. */
struct SideToDraw {
  std::optional<Limits> zone;  ///< None: the diameter is `drawn`.
  double drawn{0};             ///< Diameter in the CAD file [m].
  double expansion{1};         ///< Diameter at its temperature over that at 20 C.
};

struct PairToDraw {
  SideToDraw hole, shaft;
  FitKind kind{FitKind::kClearance};
  PairChoice choice{PairChoice::kOfKind};
};

/** Draws diameters and surface of a pair: sets hole_diameter, shaft_diameter and seed. Measured
 diameters in the parameters stay, and only the surface changes. A draw takes the same from `random`
 whatever the choice. @returns false where none of kMostPairsDrawn pairs shows the kind; the last
 one stays. @param parameters  All others are set. */
bool DrawPair(const PairToDraw& pair, Random* random, FitForceParameters* parameters);

}  // namespace hvas::fits
