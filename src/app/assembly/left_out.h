#pragma once

#include <string>
#include <vector>

#include "orders/gap_reason.h"
#include "simulation/model.h"

namespace hvas::app {

/** Why parts have no way in (assembly::ExplainGaps), for pages and tables. Reasons are those of the
 first of the model's gaps; the others have their sentence only, and say so. */
struct LeftOut {
  const simulation::Model* model{nullptr};
  const std::vector<orders::GapReason>* reasons{nullptr};
};

/** The reason of a part; null where it was not looked into. */
[[nodiscard]] const orders::GapReason* FindReason(const LeftOut& left_out,
                                                  product::OccurrenceId id);

/** Prints the parts that have no way in, with their reasons in sentences. */
void PrintLeftOut(const LeftOut& left_out);

/** A section of a page, "left-out": the same, with a picture of each reason; empty where no part is
 left out. */
[[nodiscard]] std::string MakeLeftOutSection(const LeftOut& left_out);

/** That section with the names alone, where nobody looked into why. */
[[nodiscard]] std::string MakeLeftOutList(const std::vector<std::string>& paths);

}  // namespace hvas::app
