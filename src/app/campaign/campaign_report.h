#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "campaign/campaign_folder.h"
#include "campaign/plan.h"
#include "campaign/summary.h"

namespace hvas::app {

/** Document of --json for merged results, as campaign_summary.schema.json has it. */
[[nodiscard]] nlohmann::ordered_json MakeCampaignJson(const campaign::Plan& plan,
                                                      const campaign::Summary& summary);

/** Merged results for people. */
[[nodiscard]] std::string MakeCampaignText(const campaign::Plan& plan,
                                           const campaign::Summary& summary);

/** Document of --json for how far a campaign is, as campaign_status.schema.json has it. */
[[nodiscard]] nlohmann::ordered_json MakeStatusJson(const campaign::CampaignFolder& folder,
                                                    const campaign::CampaignStatus& status);

/** How far a campaign is, for people. */
[[nodiscard]] std::string MakeStatusText(const campaign::CampaignFolder& folder,
                                         const campaign::CampaignStatus& status);

}  // namespace hvas::app
