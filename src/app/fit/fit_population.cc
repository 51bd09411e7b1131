#include "app/fit/fit_population.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/fit/csv_table.h"
#include "app/output/length_text.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"

namespace hvas::app {
namespace {

using nlohmann::ordered_json;

Result<fits::SizeDistribution> MakeSpread(const fits::Limits& limits, double nominal,
                                          const std::vector<double>& measured,
                                          const FitPopulationOptions& options, bool is_hole) {
  switch (options.spread) {
    case SizeSpread::kCapability:
      // The worse side for pressing in: small holes, thick shafts.
      return fits::SizeDistribution::FromCapability(limits, options.cp, options.cpk, !is_hole);
    case SizeSpread::kUniform:
      return fits::SizeDistribution::Uniform(limits);
    case SizeSpread::kMeasured:
      if (!measured.empty()) {
        std::vector<double> deviations = measured;
        for (double& d : deviations) {
          d -= nominal;
        }
        return fits::SizeDistribution::FromMeasured(deviations);
      }
      break;
    case SizeSpread::kPaper:
      break;
  }
  return fits::SizeDistribution::FromZone(limits);
}

bool HasRoughness(const std::vector<FitCard>& cards) {
  return std::any_of(cards.begin(), cards.end(), [](const FitCard& card) {
    return card.options.press.hub_roughness + card.options.press.shaft_roughness > 0;
  });
}

constexpr const char* kDrawnRoughness =
    "roughness is drawn along the joint (B(l)), so it cannot be smoothed as well";

double Percent(double share) {
  return 100 * share;
}

}  // namespace

fits::PressFitParameters WithDrawnRoughness(fits::PressFitParameters press) {
  press.smoothing = fits::Smoothing::kNone;
  return press;
}

Result<void> ReadSizes(const std::string& file, FitPopulationOptions* options) {
  const Result<CsvTable> table = CsvTable::Read(file, CsvTable::kAnyDelimiter);
  if (!table) {
    return Unexpected(table.error());
  }
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    for (const auto& [column, sizes] :
         {std::pair("hole_mm", &options->holes), std::pair("shaft_mm", &options->shafts)}) {
      if (table->Get(i, column).empty()) {
        continue;
      }
      const std::optional<double> value_mm = ParseNumber(table->Get(i, column));
      if (!value_mm || !std::isfinite(*value_mm) || !(*value_mm > 0)) {
        return Fail(ErrorCode::kInvalid,
                    fmt::format("{} is not a diameter: \"{}\"", column, table->Get(i, column)),
                    fmt::format("{}, row {}", file, i + 1), "write diameters in millimetres");
      }
      sizes->push_back(units::FromMm(*value_mm));
    }
  }
  if (options->holes.empty() && options->shafts.empty()) {
    return Fail(ErrorCode::kInvalid, "the table has no sizes", file,
                "give columns hole_mm and shaft_mm, or one of them, with diameters in millimetres");
  }
  options->spread = SizeSpread::kMeasured;
  return {};
}

Result<void> ReadDiametersAlong(const std::string& file, FitPopulationOptions* options) {
  const Result<CsvTable> table = CsvTable::Read(file, CsvTable::kAnyDelimiter);
  if (!table) {
    return Unexpected(table.error());
  }
  if (const auto complete = table->Require({"depth_mm", "hole_mm", "shaft_mm"}); !complete) {
    return complete;
  }
  for (std::size_t i = 0; i < table->row_count(); ++i) {
    const auto refuse = [&](const char* what) {
      return Fail(ErrorCode::kInvalid, what, fmt::format("{}, line {}", file, table->LineOf(i)),
                  "write depths from the mouth by ascending depth, and diameters above 0, in mm");
    };
    const std::optional<double> depth_mm = ParseNumber(table->Get(i, "depth_mm"));
    if (!depth_mm || !(*depth_mm >= 0)) {
      return refuse("the depth is no number of at least 0");
    }
    for (const auto& [column, along] : {std::pair("hole_mm", &options->hole_along),
                                        std::pair("shaft_mm", &options->shaft_along)}) {
      if (table->Get(i, column).empty()) {
        continue;
      }
      const std::optional<double> value_mm = ParseNumber(table->Get(i, column));
      if (!value_mm || !std::isfinite(*value_mm) || !(*value_mm > 0)) {
        return refuse("the diameter is no number above 0");
      }
      if (!along->empty() && along->back().depth >= units::FromMm(*depth_mm)) {
        return refuse("the depth is not larger than the one before");
      }
      along->push_back({units::FromMm(*depth_mm), units::FromMm(*value_mm)});
    }
  }
  if (options->hole_along.empty() || options->shaft_along.empty()) {
    return Fail(ErrorCode::kInvalid, "the table lacks diameters of the hole or of the shaft", file,
                "give at least one of each");
  }
  return {};
}

Result<fits::Population> DrawPopulation(const std::vector<FitCard>& cards,
                                        const FitPopulationOptions& options) {
  if (options.spread == SizeSpread::kMeasured && cards.size() > 1) {
    return Fail(ErrorCode::kInvalid, "measured sizes can be used with one fit only", {},
                "give one fit, or omit the measured sizes");
  }
  fits::PopulationParameters p;
  for (const FitCard& card : cards) {
    if (!card.most) {
      return Fail(ErrorCode::kInvalid, "a population needs a hole, a shaft and a length",
                  card.Title(), "give both classes and --length");
    }
    const double nominal = card.options.fit.nominal;
    Result<fits::SizeDistribution> hole =
        MakeSpread(*card.hole, nominal, options.holes, options, true);
    Result<fits::SizeDistribution> shaft =
        MakeSpread(*card.shaft, nominal, options.shafts, options, false);
    if (!hole || !shaft) {
      return Unexpected((hole ? shaft : hole).error());
    }
    p.lands.push_back({*std::move(hole), *std::move(shaft), card.options.start, options.stations,
                       WithDrawnRoughness(card.options.press)});
  }
  p.count = options.count;
  p.seed = options.seed;
  p.threads = options.threads > 0
                  ? options.threads
                  : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (options.press_force > 0) {
    p.press_force = options.press_force;
  }
  p.depths = options.depths;
  return fits::CalcPopulation(p);
}

std::string SpreadText(const FitPopulationOptions& options) {
  switch (options.spread) {
    case SizeSpread::kCapability:
      return fmt::format("sizes normal, C_p {:g}, C_pk {:g}", options.cp, options.cpk);
    case SizeSpread::kUniform:
      return "sizes uniform over the zone";
    case SizeSpread::kMeasured:
      return fmt::format("{} measured holes, {} measured shafts", options.holes.size(),
                         options.shafts.size());
    case SizeSpread::kPaper:
      break;
  }
  return "sizes in whole um, normal, sigma a sixth of the zone";
}

std::string SharesText(const fits::Population& batch, const FitPopulationOptions& options) {
  std::string text =
      fmt::format("with interference {:.3f} %, yielding {:.3f} %",
                  Percent(batch.any_interference_share), Percent(batch.any_yield_share));
  if (options.press_force > 0) {
    text += fmt::format(", beyond a press of {:g} N {:.3f} %", options.press_force,
                        Percent(batch.over_press_share));
  }
  return text;
}

std::string ToText(const fits::Population& batch, const std::vector<FitCard>& cards,
                   const FitPopulationOptions& options) {
  std::string text = fmt::format("{} assemblies, {}, seed {}:\n  {}\n", batch.count,
                                 SpreadText(options), options.seed, SharesText(batch, options));
  if (HasRoughness(cards)) {
    text += fmt::format("  {}\n", kDrawnRoughness);
  }
  const LengthText lengths(cards.front().options.unit);
  TextTable clearances({std::string("clearance, ") + lengths.small_unit(), "mean", "sigma", "0.1 %",
                        "5 %", "50 %", "95 %", "99.9 %"});
  for (std::size_t k = 0; k < cards.size(); ++k) {
    const fits::LandStatistics& land = batch.lands[k];
    const auto told = [&lengths](double clearance) {
      return fmt::format("{:.2f}", lengths.smalls_per_metre() * clearance + 0.0);
    };
    std::vector<std::string> cells{cards[k].Title(), told(land.mean_clearance),
                                   told(land.sigma_clearance)};
    std::transform(land.clearance_quantiles.begin(), land.clearance_quantiles.end(),
                   std::back_inserter(cells), told);
    clearances.Add(std::move(cells));
  }
  text += clearances.ToText(2);
  TextTable forces({std::string("force, N\ndepth, ") + lengths.size_unit(), "\nmean", "\n0.1 %",
                    "\n5 %", "\n50 %", "\n95 %", "\n99.9 %"},
                   0);
  for (const fits::ForceBand& band : batch.bands) {
    std::vector<std::string> cells{fmt::format("{:.3f}", lengths.sizes_per_metre() * band.depth),
                                   fmt::format("{:.1f}", band.mean)};
    for (const double quantile : band.quantiles) {
      cells.push_back(fmt::format("{:.1f}", quantile));
    }
    forces.Add(std::move(cells));
  }
  return Fold(text) + forces.ToText(2);
}

ordered_json ToJson(const fits::Population& batch, const std::vector<FitCard>& cards,
                    const FitPopulationOptions& options) {
  ordered_json json{{"count", batch.count},
                    {"seed", options.seed},
                    {"sizes", SpreadText(options)},
                    {"interference_share", batch.any_interference_share},
                    {"yield_share", batch.any_yield_share}};
  if (HasRoughness(cards)) {
    json["roughness"] = kDrawnRoughness;
  }
  if (options.press_force > 0) {
    json["press_limit_n"] = options.press_force;
    json["over_press_share"] = batch.over_press_share;
  }
  json["quantile_shares"] = fits::kBandShares;
  for (std::size_t k = 0; k < cards.size(); ++k) {
    const fits::LandStatistics& land = batch.lands[k];
    ordered_json quantiles_um = ordered_json::array();
    for (const double quantile : land.clearance_quantiles) {
      quantiles_um.push_back(units::ToUm(quantile));
    }
    json["fits"].push_back({{"fit", cards[k].Title()},
                            {"mean_clearance_um", units::ToUm(land.mean_clearance)},
                            {"sigma_clearance_um", units::ToUm(land.sigma_clearance)},
                            {"clearance_quantiles_um", quantiles_um},
                            {"interference_share", land.interference_share},
                            {"yield_share", land.yield_share}});
  }
  for (const fits::ForceBand& band : batch.bands) {
    json["force"].push_back({{"depth_mm", units::ToMm(band.depth)},
                             {"mean_n", band.mean},
                             {"quantiles_n", band.quantiles}});
  }
  return json;
}

}  // namespace hvas::app
