#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orders/order_rules.h"

namespace hvas::shopfloor {

/** What keeps a move from coming after another one. */
enum class ArrowReason : std::uint8_t {
  kMeets,       ///< Its part would meet the other one before its place.
  kMate,        ///< A mate with the other part leaves it no way in.
  kMovedAside,  ///< A part is moved aside for it, which was found without the other one.
  kGiving,      ///< Parts give on its way, which was found without the other one.
  kTurning,     ///< Its way turns, and was found without the other one.
};

/** One move has to come before another one, or at least was found so. */
struct OrderArrow {
  std::size_t first{0};             ///< Number of the move in the rules.
  std::size_t then{0};              ///< The other one's.
  product::OccurrenceId then_part;  ///< Its leading part.
  ArrowReason reason{ArrowReason::kMeets};
  product::OccurrenceId other;  ///< The part that the reason is about; invalid where there is none.
  double travelled{0};          ///< kMeets: distance before its place at which they would meet [m].
  bool is_certain{false};       ///< The other one would stand in every way of the first.
  bool is_implied{false};       ///< Two other arrows say the same.
};

/** All arrows of an order's rules, by the moves that come first. */
[[nodiscard]] std::vector<OrderArrow> ListArrows(const orders::OrderRules& rules);

}  // namespace hvas::shopfloor
