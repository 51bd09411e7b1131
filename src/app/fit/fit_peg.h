#pragma once

#include "app/fit/csv_table.h"

namespace hvas::app {

/** Answers questions about a peg in a hole. In: kind, id, inputs ("D=40 d=39.9 l=10 mm"), output
 (which one), unit. Out: value, reason. Whether a load jams (kind jamming_point, with Fx, Fz, M, l,
 r and mu; output slides) is 1 or 0. An empty `inputs` takes those of the row above with the same
 id. Numbers are in mm, N, N mm, N/mm, N mm/rad and rad, or in the unit that stands behind them; the
 value is in `unit`. What no peg can have (d of D or more, a length or friction below zero, a tilt
 that does not enter) is refused in `reason`. */
[[nodiscard]] Result<void> AddInsertions(CsvTable* table);

}  // namespace hvas::app
