#pragma once

#include <string>

#include "campaign/plan.h"
#include "campaign/summary.h"

namespace hvas::campaign {

/** Makes the page of results: yield over tolerance, forces, failures, cost against yield, effects
 and sensitivities, the worst runs with the commands that play them. HTML that needs no other file;
 equal summaries give equal bytes. */
[[nodiscard]] std::string MakeCampaignPage(const Plan& plan, const Summary& summary);

}  // namespace hvas::campaign
