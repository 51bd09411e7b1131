#include "app/fit_card.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/names.h"
#include "base/units.h"
#include "fits/insertion.h"
#include "fits/thermal_joining.h"
#include "mates/make_fit.h"

namespace hvas::app {
namespace {

using nlohmann::ordered_json;

constexpr double kMeltLimitC = 350;  // Hubs of steel are seldom heated further.

Unexpected NoFit(std::string_view text) {
  return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is no size with a fit", text), {},
              "write the nominal diameter in mm and the classes, as in \"40 H7/p6\", \"40 H7\" or "
              "\"1.5in H7/g6\"");
}

/** Micrometres to three digits; zero has no sign. */
std::string Um(double length) {
  return fmt::format("{:g}", std::round(units::ToUm(length) * 1e3) / 1e3 + 0.0);
}

std::string SignedUm(double length) {
  const std::string text = Um(length);
  return length > 0 && text != "0" ? "+" + text : text;
}

ordered_json FiniteOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

fits::ThermalJoint MakeThermalJoint(const FitCard& card) {
  const fits::PressFitParameters& p = card.options.press;
  return {p.joint_diameter, std::max(0.0, -card.limits->min_clearance), p.hub.thermal_expansion,
          p.shaft.thermal_expansion, card.options.room_c};
}

struct JoiningTemperatures {
  double hub_c;    // Heating the hub alone.
  double shaft_c;  // Cooling the shaft alone.
};

JoiningTemperatures CalcJoining(const FitCard& card) {
  const fits::ThermalJoint joint = MakeThermalJoint(card);
  const double clearance = fits::CalcJoiningClearance(joint.joint_diameter);
  return {fits::CalcHubTemperature(joint, clearance, joint.room_c),
          fits::CalcShaftTemperature(joint, clearance, joint.room_c)};
}

Result<fits::Population> DrawPopulation(const FitCard& card) {
  const FitCardOptions& options = card.options;
  fits::PopulationParameters p;
  p.lands.push_back({fits::SizeDistribution::FromZone(*card.hole),
                     fits::SizeDistribution::FromZone(*card.shaft), 0, options.stations,
                     options.press});
  p.count = options.population;
  p.seed = options.seed;
  p.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (options.press_force > 0) {
    p.press_force = options.press_force;
  }
  p.depths = options.stations;
  return fits::CalcPopulation(p);
}

Result<fits::PressFit> PressAt(const FitCard& card, double clearance) {
  fits::PressFitParameters p = card.options.press;
  p.interference = -clearance;
  return fits::CalcPressFit(p);
}

}  // namespace

Result<SizedFit> ParseSizedFit(std::string_view text) {
  SizedFit sized;
  const char* begin = text.data();
  const char* const end = begin + text.size();
  while (begin != end && *begin == ' ') {
    ++begin;
  }
  double size = 0;
  const auto [after, error] = std::from_chars(begin, end, size);
  if (error != std::errc() || !std::isfinite(size)) {
    return NoFit(text);
  }
  std::string_view rest(after, static_cast<std::size_t>(end - after));
  const auto skip = [&rest](std::string_view word) {
    while (rest.starts_with(' ')) {
      rest.remove_prefix(1);
    }
    const bool is_there = rest.starts_with(word);
    rest.remove_prefix(is_there ? word.size() : 0);
    return is_there;
  };
  const bool is_inch = skip("in") || skip("\"");
  if (!is_inch) {
    skip("mm");
  }
  skip("");
  sized.nominal = is_inch ? size * units::kMetresPerInch : units::FromMm(size);
  if (rest.find_first_of("/- ") != std::string_view::npos) {
    const Result<fits::FitClass> fit = fits::ParseFit(rest);
    if (!fit) {
      return Unexpected(fit.error());
    }
    sized.hole = fit->hole;
    sized.shaft = fit->shaft;
    return sized;
  }
  const Result<fits::ToleranceClass> one = fits::ParseToleranceClass(rest);
  if (!one) {
    return NoFit(text);
  }
  (one->is_hole() ? sized.hole : sized.shaft) = *one;
  return sized;
}

Result<FitCard> MakeFitCard(const FitCardOptions& options) {
  FitCard card;
  card.options = options;
  const SizedFit& fit = options.fit;
  for (const auto& [side, limits] :
       {std::pair(&fit.hole, &card.hole), std::pair(&fit.shaft, &card.shaft)}) {
    if (side->has_value()) {
      const Result<fits::Limits> found = fits::CalcLimits(**side, fit.nominal);
      if (!found) {
        return Unexpected(found.error());
      }
      *limits = *found;
    }
  }
  if (!fit.hole || !fit.shaft) {
    return card;
  }
  card.limits = *fits::CalcFitLimits({*fit.hole, *fit.shaft}, fit.nominal);
  if (!(options.press.length > 0)) {
    return card;
  }
  card.options.press.joint_diameter = fit.nominal;
  for (const auto& [clearance, press] :
       {std::pair(card.limits->max_clearance, &card.least),
        std::pair(0.5 * (card.limits->min_clearance + card.limits->max_clearance), &card.mean),
        std::pair(card.limits->min_clearance, &card.most)}) {
    const Result<fits::PressFit> at = PressAt(card, clearance);
    if (!at) {
      return Unexpected(at.error());
    }
    *press = *at;
  }
  if (options.population > 0) {
    Result<fits::Population> population = DrawPopulation(card);
    if (!population) {
      return Unexpected(population.error());
    }
    card.population = *std::move(population);
  }
  return card;
}

namespace {

std::string LimitsText(const FitCard& card) {
  const SizedFit& fit = card.options.fit;
  std::string text;
  const auto side = [&](const char* name, const auto& tolerance, const auto& limits) {
    if (limits) {
      text += fmt::format("  {:<6} {:<6} {:>8} / {:>8} um   {:.4f} to {:.4f} mm\n", name,
                          tolerance->ToString(), SignedUm(limits->upper), SignedUm(limits->lower),
                          units::ToMm(fit.nominal + limits->lower),
                          units::ToMm(fit.nominal + limits->upper));
    }
  };
  side("hole", fit.hole, card.hole);
  side("shaft", fit.shaft, card.shaft);
  if (card.limits) {
    text += fmt::format("  clearance of the diameters {} to {} um: {} fit\n",
                        SignedUm(card.limits->min_clearance), SignedUm(card.limits->max_clearance),
                        ToString(mates::ToKind(card.limits->kind)));
  }
  return text;
}

std::string PressText(const FitCard& card) {
  const fits::PressFitParameters& p = card.options.press;
  std::string text = fmt::format(
      "joint {:g} mm long, hub {:g} mm {}, shaft {}{}, mu {:g}, Rz {:g} and {:g} um\n",
      units::ToMm(p.length), units::ToMm(p.hub_diameter), card.options.hub_material,
      card.options.shaft_material,
      p.shaft_bore > 0 ? fmt::format(" with a bore of {:g} mm", units::ToMm(p.shaft_bore)) : "",
      p.friction_in, units::ToUm(p.hub_roughness), units::ToUm(p.shaft_roughness));
  text += fmt::format("  {:<30} {:>12} {:>12} {:>12}\n", "interference", "least", "mean", "most");
  const auto row = [&](const char* name, auto value) {
    text += fmt::format("  {:<30} {:>12} {:>12} {:>12}\n", name, value(*card.least),
                        value(*card.mean), value(*card.most));
  };
  using fits::PressFit;
  const auto fixed = [](double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value + 0.0, digits) : std::string("-");
  };
  row("effective, um", [](const PressFit& f) { return Um(f.effective_interference); });
  row("pressure, MPa", [&](const PressFit& f) { return fixed(units::ToMpa(f.pressure), 2); });
  row("force to press in, N", [&](const PressFit& f) { return fixed(f.press_in_force, 1); });
  row("force to push out, N", [&](const PressFit& f) { return fixed(f.push_out_force, 1); });
  row("torque, N m", [&](const PressFit& f) { return fixed(f.torque, 2); });
  row("hub bore, hoop, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.hoop), 1); });
  row("hub bore, von Mises, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.von_mises()), 1); });
  row("hub bore, Tresca, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.tresca()), 1); });
  row("shaft, hoop, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.shaft_governing.hoop), 1); });
  row("margin by von Mises", [&](const PressFit& f) { return fixed(f.margin_von_mises(), 2); });
  row("margin by Tresca", [&](const PressFit& f) { return fixed(f.margin_tresca(), 2); });
  if (card.most->margin_von_mises() < 1) {
    text += "  the largest interference yields: its figures are those of an elastic joint\n";
  }
  if (card.limits->min_clearance < 0) {
    const JoiningTemperatures joining = CalcJoining(card);
    text += fmt::format(
        "to join with {} um of play: heat the hub to {:.0f} C{}, or cool the shaft to "
        "{:.0f} C{}\n",
        Um(fits::CalcJoiningClearance(p.joint_diameter)), joining.hub_c,
        joining.hub_c > kMeltLimitC ? " (more than steel should have)" : "", joining.shaft_c,
        joining.shaft_c < -196 ? " (colder than liquid nitrogen)" : "");
  }
  if (card.limits->max_clearance > 0) {
    const fits::PegInHole pair{p.joint_diameter + card.limits->max_clearance, p.joint_diameter};
    text += fmt::format("largest tilt that enters: {:.2f} deg; below {:.3f} deg nothing wedges\n",
                        units::ToDeg(fits::CalcLargestTilt(pair)),
                        units::ToDeg(fits::CalcWedgingTilt(pair, p.friction_in)));
  }
  return text;
}

std::string PopulationText(const FitCard& card) {
  const fits::Population& batch = *card.population;
  const fits::LandStatistics& land = batch.lands.front();
  std::string text = fmt::format(
      "{} assemblies: clearance {} +- {} um (one sigma), with interference {:.3f} %, yielding "
      "{:.3f} %",
      batch.count, SignedUm(land.mean_clearance), Um(land.sigma_clearance),
      100 * land.interference_share, 100 * land.yield_share);
  if (card.options.press_force > 0) {
    text += fmt::format(", beyond the press {:.3f} %", 100 * batch.over_press_share);
  }
  text += fmt::format("\n  {:>9} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}\n", "depth, mm",
                      "mean, N", "0.1 %", "5 %", "50 %", "95 %", "99.9 %");
  for (const fits::ForceBand& band : batch.bands) {
    text += fmt::format("  {:>9.3f} {:>11.1f}", units::ToMm(band.depth), band.mean);
    for (const double quantile : band.quantiles) {
      text += fmt::format(" {:>11.1f}", quantile);
    }
    text += "\n";
  }
  return text;
}

ordered_json ToJson(const fits::PressFit& f) {
  return {{"effective_interference_um", units::ToUm(f.effective_interference)},
          {"pressure_mpa", units::ToMpa(f.pressure)},
          {"press_in_force_n", f.press_in_force},
          {"push_out_force_n", f.push_out_force},
          {"torque_nm", f.torque},
          {"hub_expansion_um", units::ToUm(f.hub_expansion)},
          {"shaft_contraction_um", units::ToUm(f.shaft_contraction)},
          {"hub_hoop_mpa", units::ToMpa(f.hub_bore.hoop)},
          {"hub_von_mises_mpa", units::ToMpa(f.hub_bore.von_mises())},
          {"hub_tresca_mpa", units::ToMpa(f.hub_bore.tresca())},
          {"shaft_hoop_mpa", units::ToMpa(f.shaft_governing.hoop)},
          {"margin_von_mises", FiniteOrNull(f.margin_von_mises())},
          {"margin_tresca", FiniteOrNull(f.margin_tresca())}};
}

ordered_json ToJson(const fits::Population& batch) {
  const fits::LandStatistics& land = batch.lands.front();
  ordered_json json{{"count", batch.count},
                    {"mean_clearance_um", units::ToUm(land.mean_clearance)},
                    {"sigma_clearance_um", units::ToUm(land.sigma_clearance)},
                    {"interference_share", land.interference_share},
                    {"yield_share", land.yield_share},
                    {"over_press_share", batch.over_press_share},
                    {"quantile_shares", fits::kBandShares}};
  for (const fits::ForceBand& band : batch.bands) {
    json["force"].push_back({{"depth_mm", units::ToMm(band.depth)},
                             {"mean_n", band.mean},
                             {"quantiles_n", band.quantiles}});
  }
  return json;
}

}  // namespace

std::string ToText(const FitCard& card) {
  const SizedFit& fit = card.options.fit;
  const std::string code = fit.hole && fit.shaft ? fits::FitClass{*fit.hole, *fit.shaft}.ToString()
                                                 : (fit.hole ? fit.hole : fit.shaft)->ToString();
  std::string text = fmt::format("{:g} mm {}\n", units::ToMm(fit.nominal), code);
  text += LimitsText(card);
  if (card.most) {
    text += PressText(card);
  }
  if (card.population) {
    text += PopulationText(card);
  }
  return text;
}

ordered_json ToJson(const FitCard& card) {
  const SizedFit& fit = card.options.fit;
  ordered_json json{{"schema", "hvas-fit-1"}, {"nominal_mm", units::ToMm(fit.nominal)}};
  const auto side = [&](const char* name, const auto& tolerance, const auto& limits) {
    if (limits) {
      json[name] = {{"class", tolerance->ToString()},
                    {"upper_um", units::ToUm(limits->upper)},
                    {"lower_um", units::ToUm(limits->lower)}};
    }
  };
  side("hole", fit.hole, card.hole);
  side("shaft", fit.shaft, card.shaft);
  if (card.limits) {
    json["kind"] = ToString(mates::ToKind(card.limits->kind));
    json["min_clearance_um"] = units::ToUm(card.limits->min_clearance);
    json["max_clearance_um"] = units::ToUm(card.limits->max_clearance);
  }
  if (card.most) {
    json["press"] = {
        {"least", ToJson(*card.least)}, {"mean", ToJson(*card.mean)}, {"most", ToJson(*card.most)}};
    if (card.limits->min_clearance < 0) {
      const JoiningTemperatures joining = CalcJoining(card);
      json["joining"] = {{"heat_hub_to_c", joining.hub_c}, {"cool_shaft_to_c", joining.shaft_c}};
    }
  }
  if (card.population) {
    json["population"] = ToJson(*card.population);
  }
  return json;
}

}  // namespace hvas::app
