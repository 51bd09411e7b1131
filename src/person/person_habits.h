#pragma once

/** Habits of the simulated person on its way to a place that also count on the way in. Where each
 number comes from: docs/algorithms/simulated_person.md, "Where its numbers come from". */
namespace hvas::person {

inline constexpr double kStandOff = 6e-3;  // [m] before anything engages, where approach ends
inline constexpr double kStuckBeforeSearch = 1.2;  // [s] that it is stuck until it searches

}  // namespace hvas::person
