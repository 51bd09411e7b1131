#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace hvas::campaign {

/** Why a product cannot be assembled, or would not be sound. */
enum class Cause : std::uint8_t {
  kNone,       ///< Nothing.
  kPress,      ///< The press is not strong enough for a joint.
  kYield,      ///< The pressure in a fit exceeds the elastic limit of a part.
  kNotSeated,  ///< The simulated person did not bring a part to its place.
};

inline constexpr std::array<std::string_view, 4> kCauses{"none", "press", "yield", "not_seated"};

/** Result of one run: one product as made. Pure numbers, so that they fit into a row of a table. */
struct RunResult {
  std::int64_t run{0};   ///< Number in the plan.
  std::int64_t cell{0};  ///< Cell::index.
  std::int64_t seed{0};
  bool is_complete{false};  ///< It can be assembled.
  /** What fails first: the largest utilisation, where it is above 1; kNotSeated goes before. */
  Cause cause{Cause::kNone};
  /** Id of the mate that it is about, or of the occurrence for kNotSeated; -1: none. */
  std::int64_t entity{-1};
  double utilisation{0};     ///< Largest ratio of a force or pressure to its limit.
  double force{0};           ///< Largest force to press a part in [N].
  double clearance{0};       ///< Least mean diametral clearance of all fits [m]; 0: no fits.
  double pressure_share{0};  ///< Largest ratio of a pressure to the elastic limit.
  double time{0};            ///< Session time [s]; 0 with the method fits.
};

}  // namespace hvas::campaign
