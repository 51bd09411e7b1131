#include "app/campaign/campaign_report.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "campaign/slurm.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using campaign::CellSummary;
using campaign::Summary;

constexpr std::size_t kMostRows = 50;      // Of a table for people; --json has all. A choice.
constexpr std::size_t kMostFactors = 8;    // Likewise.
constexpr std::size_t kMostEffects = 3;    // Combinations whose factors are listed: likewise.
constexpr std::int64_t kFewestRuns = 100;  // Ten for each bin of an effect: fewer are noise.

std::string NameCause(campaign::Cause cause) {
  return std::string(campaign::kCauses[static_cast<std::size_t>(cause)]);
}

Json MakeIndexJson(const std::optional<statistics::SobolIndex>& index) {
  if (!index) {
    return nullptr;
  }
  constexpr double kNoMinus = 0;  // Added, it leaves no zero with a minus.
  return {{"first", index->first + kNoMinus},
          {"first_ci", {index->first_ci.low + kNoMinus, index->first_ci.high + kNoMinus}},
          {"total", index->total + kNoMinus},
          {"total_ci", {index->total_ci.low + kNoMinus, index->total_ci.high + kNoMinus}}};
}

Json MakeEffectJson(const campaign::MainEffect& effect) {
  Json bins = Json::array();
  for (const campaign::EffectBin& bin : effect.bins) {
    bins.push_back(
        {{"deviation_um", units::ToUm(bin.deviation)},
         {"runs", bin.runs},
         {"complete", bin.complete},
         {"mean_force_n",
          bin.runs > 0 ? Json(bin.force_sum / static_cast<double>(bin.runs)) : Json(nullptr)}});
  }
  return {{"factor", effect.factor},
          {"yield_range", effect.yield_range},
          {"force_range_n", effect.force_range},
          {"force_variance_share", effect.force_ratio},
          {"bins", std::move(bins)}};
}

Json MakeCellJson(const campaign::Plan& plan, const CellSummary& cell) {
  Json json{{"cell", cell.cell.index},
            {"name", cell.name},
            {"product", plan.products[cell.cell.product].string()},
            {"fits", plan.fits[cell.cell.fit].id},
            {"sizes", plan.sizes[cell.cell.sizes].id},
            {"materials", plan.materials[cell.cell.material].id},
            {"person", campaign::Plan::NamePerson(plan.persons[cell.cell.person])},
            {"runs", cell.runs},
            {"complete", cell.complete},
            {"yield", cell.yield->share},
            {"yield_ci", {cell.yield->ci.low, cell.yield->ci.high}},
            {"mean_force_n", cell.force_mean},
            {"force_quantiles_n", cell.force_quantiles},
            {"largest_force_n", cell.force_max},
            {"least_clearance_um", units::ToUm(cell.clearance_min)},
            {"mean_clearance_um", units::ToUm(cell.clearance_mean)},
            {"mean_time_s", cell.time_mean}};
  json["tolerance_um"] = cell.tolerance ? Json(units::ToUm(*cell.tolerance)) : Json(nullptr);
  json["cost_rank"] = cell.cost_rank ? Json(*cell.cost_rank) : Json(nullptr);
  json["is_not_dominated"] = cell.is_best;
  json["failures"] = Json::array();
  for (const campaign::FailureCount& failure : cell.failures) {
    json["failures"].push_back({{"cause", NameCause(failure.cause)},
                                {"entity", failure.entity},
                                {"name", failure.name},
                                {"runs", failure.count}});
  }
  json["main_effects"] = Json::array();
  for (const campaign::MainEffect& effect : cell.effects) {
    json["main_effects"].push_back(MakeEffectJson(effect));
  }
  json["sobol"] = Json::array();
  for (const campaign::SobolOfFactor& factor : cell.sobol) {
    json["sobol"].push_back({{"factor", factor.factor},
                             {"complete", MakeIndexJson(factor.complete)},
                             {"force", MakeIndexJson(factor.force)}});
  }
  return json;
}

/** Formats a force in newtons: three digits, or whole newtons. */
std::string FormatForce(double force) {
  return force < 100 ? fmt::format("{:.3g}", force) : fmt::format("{:.0f}", force);
}

std::string MakeYieldTable(const Summary& summary) {
  TextTable table({"combination\n", "runs\n", "complete\n%", "force, N\nmedian", "\n99 %",
                   "\nlargest", "\nfails first"});
  for (std::size_t i = 0; i < std::min(summary.cells.size(), kMostRows); ++i) {
    const CellSummary& cell = summary.cells[i];
    table.Add({cell.name, fmt::format("{}", cell.runs),
               fmt::format("{:.3f}", 100 * cell.yield->share), FormatForce(cell.force_quantiles[1]),
               FormatForce(cell.force_quantiles[3]), FormatForce(cell.force_max),
               cell.failures.empty() ? "-" : NameCause(cell.failures.front().cause)});
  }
  return table.ToText();
}

/** Formats an index of Sobol without a minus before a zero. */
std::string FormatIndex(double index) {
  return fmt::format("{:.3f}", std::round(1e3 * index) / 1e3 + 0.0);
}

std::string MakeFactorTable(const CellSummary& cell) {
  if (cell.effects.empty() || cell.runs < kFewestRuns) {
    return {};
  }
  TextTable table({cell.name + "\nfactor", "range of\nyield, %", "range of\nforce, N",
                   "S force\nfirst", "\ntotal", "S complete\nfirst", "\ntotal"});
  for (std::size_t i = 0; i < std::min(cell.effects.size(), kMostFactors); ++i) {
    const campaign::MainEffect& effect = cell.effects[i];
    std::vector<std::string> cells{effect.factor, fmt::format("{:.3f}", 100 * effect.yield_range),
                                   FormatForce(effect.force_range)};
    const auto found = std::find_if(cell.sobol.begin(), cell.sobol.end(), [&](const auto& sobol) {
      return sobol.factor == effect.factor;
    });
    for (const auto member :
         {&campaign::SobolOfFactor::force, &campaign::SobolOfFactor::complete}) {
      const bool has_index = found != cell.sobol.end() && ((*found).*member).has_value();
      cells.push_back(has_index ? FormatIndex(((*found).*member)->first) : "-");
      cells.push_back(has_index ? FormatIndex(((*found).*member)->total) : "-");
    }
    table.Add(std::move(cells));
  }
  return "\n" + table.ToText();
}

}  // namespace

Json MakeCampaignJson(const campaign::Plan& plan, const Summary& summary) {
  Json json{{"schema", "hvas-campaign-summary-1"},
            {"campaign", summary.id},
            {"method", campaign::kMethods[static_cast<std::size_t>(plan.method)]},
            {"digest", summary.digest},
            {"shards", summary.shards},
            {"runs", summary.runs},
            {"runs_done", summary.runs_done},
            {"missing_shards", campaign::FormatRanges(summary.missing)},
            {"damaged_shards", Json::array()},
            {"notes", summary.notes},
            {"force_quantile_shares", campaign::kForceShares},
            {"cells", Json::array()},
            {"worst", Json::array()}};
  for (const auto& [shard, what] : summary.damaged) {
    json["damaged_shards"].push_back({{"shard", shard}, {"error", what}});
  }
  for (const CellSummary& cell : summary.cells) {
    json["cells"].push_back(MakeCellJson(plan, cell));
  }
  for (const campaign::WorstRun& worst : summary.worst) {
    const campaign::RunResult& r = worst.result;
    json["worst"].push_back({{"run", r.run},
                             {"cell", r.cell},
                             {"seed", r.seed},
                             {"complete", r.is_complete},
                             {"cause", NameCause(r.cause)},
                             {"force_n", r.force},
                             {"utilisation", r.utilisation},
                             {"command", worst.play}});
  }
  return json;
}

std::string MakeCampaignText(const campaign::Plan& plan, const Summary& summary) {
  std::string text = fmt::format(
      "{}: {} of {} runs, method {}, digest {}\n\n", summary.id, summary.runs_done, summary.runs,
      campaign::kMethods[static_cast<std::size_t>(plan.method)], summary.digest);
  text += MakeYieldTable(summary);
  for (std::size_t i = 0; i < std::min(summary.cells.size(), kMostEffects); ++i) {
    text += MakeFactorTable(summary.cells[i]);
  }
  if (!summary.worst.empty()) {
    const campaign::WorstRun& worst = summary.worst.front();
    text += "\n" + Fold(fmt::format("Worst run: {} ({}, utilisation {:.3g}); to play it:\n",
                                    worst.result.run, NameCause(worst.result.cause),
                                    worst.result.utilisation));
    text += "  " + worst.play + "\n";
  }
  if (!summary.notes.empty()) {
    text += Fold("Note: " + summary.notes + "\n");
  }
  if (!summary.missing.empty()) {
    text += Fold(fmt::format("{} of {} shards are missing: {}\n", summary.missing.size(),
                             summary.shards, campaign::FormatRanges(summary.missing)));
  }
  for (const auto& [shard, what] : summary.damaged) {
    text += Fold(fmt::format("Shard {} is not used: {}\n", shard, what));
  }
  return text;
}

Json MakeStatusJson(const campaign::CampaignFolder& folder,
                    const campaign::CampaignStatus& status) {
  return {{"schema", "hvas-campaign-status-1"},
          {"campaign", folder.plan().id},
          {"shards", status.shards},
          {"shards_done", status.done},
          {"runs", status.runs},
          {"runs_done", status.runs_done},
          {"runs_per_s", status.rate ? Json(*status.rate) : Json(nullptr)},
          {"left_s", status.left ? Json(*status.left) : Json(nullptr)}};
}

std::string MakeStatusText(const campaign::CampaignFolder& folder,
                           const campaign::CampaignStatus& status) {
  std::string text = fmt::format("{}: {} of {} shards, {} of {} runs\n", folder.plan().id,
                                 status.done, status.shards, status.runs_done, status.runs);
  if (status.rate) {
    text += fmt::format("{:.3g} runs/s between the oldest and the newest shard, {:.3g} s left\n",
                        *status.rate, *status.left);
  }
  return text;
}

}  // namespace hvas::app
