#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "evidence/session_data.h"

namespace hvas::evidence {

/** A part in a hand, from taking it up to letting go. */
struct Hold {
  std::uint32_t occurrence{0};
  std::uint8_t hand{0};
  std::int64_t start_ns{0};
  std::int64_t end_ns{0};
  bool is_seated{false};       ///< When it was let go.
  double peak_true{0};         ///< [N]
  double peak_felt{0};         ///< [N]
  double insertion{0};         ///< Longest that a mate's shaft was in its hole [m].
  double deepest{0};           ///< Deepest penetration, >= 0 [m].
  double path{0};              ///< Length of the way of the point that is followed [m].
  std::int64_t contact_ns{0};  ///< That something pressed.
  int collisions{0};           ///< How often contact began, after a tenth of a second without.
  std::vector<Vec3> points;    ///< Its way in the world, wherever it has moved on by kPointGap [m].
  std::vector<std::int64_t> point_ns;
};

/** [m]: a way drawn on a page bends no finer. A choice. */
inline constexpr double kPointGap = 0.5e-3;

/** All holds of a session, in the order in which they began.
 @param p_BQ  Of an occurrence, the point of it that is followed, in B. */
[[nodiscard]] Result<std::vector<Hold>> FindHolds(
    record::Reader* reader, const record::Reader::Span& span,
    const std::function<Vec3(std::uint32_t occurrence)>& p_BQ);

/** Centres of mass of a product's parts, by occurrence; origins where there is no product. */
[[nodiscard]] std::function<Vec3(std::uint32_t occurrence)> MakeCentres(
    const std::optional<product::Product>& product);

}  // namespace hvas::evidence
