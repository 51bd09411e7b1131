#include "app/fit/fit_card.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/text_layout.h"
#include "base/units.h"
#include "fits/insertion.h"
#include "mates/make_fit.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using nlohmann::ordered_json;

ordered_json FiniteOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

fits::ThermalJoint MakeThermalJoint(const FitCard& card) {
  const FitCardOptions& o = card.options;
  return {o.press.joint_diameter,
          std::max(0.0, -card.limits->min_clearance),
          o.hub_joining.heating,
          o.shaft_joining.cooling,
          o.room_c,
          o.hub_joining.cooling,
          o.shaft_joining.heating};
}

/** Ways to get the clearance of DIN 7190-1; nothing where a way would take more than there is. */
struct JoiningTemperatures {
  double clearance;           // To be had [m].
  double hub_c;               // Heating the hub alone.
  double shaft_c;             // Cooling the shaft alone.
  double nitrogen_clearance;  // With the shaft in liquid nitrogen and the hub as it is [m].
  double dry_ice_hub_c;       // Heating the hub with the shaft at kDryIce_c.
  double nitrogen_hub_c;      // The same at kNitrogen_c.
};

JoiningTemperatures CalcJoining(const FitCard& card) {
  const fits::ThermalJoint joint = MakeThermalJoint(card);
  const double clearance = fits::CalcJoiningClearance(joint.joint_diameter);
  const auto hub_c = [&](double shaft_c) {
    return std::max(joint.room_c, fits::CalcHubTemperature(joint, clearance, shaft_c));
  };
  return {clearance,
          hub_c(joint.room_c),
          fits::CalcShaftTemperature(joint, clearance, joint.room_c),
          fits::CalcHotClearance(joint, joint.room_c, fits::kNitrogen_c),
          hub_c(fits::kDryIce_c),
          hub_c(fits::kNitrogen_c)};
}

std::string JoiningText(const FitCard& card) {
  const LengthText lengths(card.options.unit);
  const JoiningTemperatures joining = CalcJoining(card);
  const fits::JoiningMaterial& hub = card.options.hub_joining;
  const fits::JoiningMaterial& shaft = card.options.shaft_joining;
  const auto heat = [&hub](double hub_c) {
    return hub_c <= hub.hottest_c
               ? fmt::format("heat the hub to {:.0f} C", std::ceil(hub_c))
               : fmt::format("impossible: the hub would need {:.0f} C", std::ceil(hub_c));
  };
  std::string text = fmt::format(
      "joining with {} {} of play, alpha {:g}e-6/K of the hub (heated), {:g}e-6/K of the shaft "
      "(cooled):\n",
      lengths.Small(joining.clearance), lengths.small_unit(), 1e6 * hub.heating,
      1e6 * shaft.cooling);
  text += fmt::format("  by heat: {}, at most {:g} C ({})\n", heat(joining.hub_c), hub.hottest_c,
                      hub.limit_source);
  if (joining.shaft_c >= fits::kNitrogen_c) {
    text += fmt::format("  by cold: cool the shaft to {:.0f} C\n", std::floor(joining.shaft_c));
  } else {
    text += fmt::format("  by cold: impossible: in liquid nitrogen, {:g} C, the play is {} {}\n",
                        fits::kNitrogen_c, lengths.Small(joining.nitrogen_clearance),
                        lengths.small_unit());
  }
  text += fmt::format("  by both: cool the shaft to {:g} C (dry ice), {}\n", fits::kDryIce_c,
                      heat(joining.dry_ice_hub_c));
  text += fmt::format("  by both: cool the shaft to {:g} C (liquid nitrogen), {}\n",
                      fits::kNitrogen_c, heat(joining.nitrogen_hub_c));
  return text + (hub.source == shaft.source
                     ? fmt::format("  alpha: {}\n", hub.source)
                     : fmt::format("  alpha: {}; of the shaft: {}\n", hub.source, shaft.source));
}

ordered_json JoiningJson(const FitCard& card) {
  const JoiningTemperatures joining = CalcJoining(card);
  const fits::JoiningMaterial& hub = card.options.hub_joining;
  const fits::JoiningMaterial& shaft = card.options.shaft_joining;
  const auto heat = [&hub](double hub_c) {
    return hub_c <= hub.hottest_c ? ordered_json(hub_c) : ordered_json();
  };
  return {{"play_um", units::ToUm(joining.clearance)},
          {"heat_hub_to_c", heat(joining.hub_c)},
          {"cool_shaft_to_c",
           joining.shaft_c >= fits::kNitrogen_c ? ordered_json(joining.shaft_c) : ordered_json()},
          {"with_dry_ice_heat_hub_to_c", heat(joining.dry_ice_hub_c)},
          {"with_nitrogen_heat_hub_to_c", heat(joining.nitrogen_hub_c)},
          {"play_in_nitrogen_um", units::ToUm(joining.nitrogen_clearance)},
          {"hub_limit_c", hub.hottest_c},
          {"hub_limit_source", hub.limit_source},
          {"hub_heating_per_k", hub.heating},
          {"hub_expansion_source", hub.source},
          {"shaft_cooling_per_k", shaft.cooling},
          {"shaft_expansion_source", shaft.source}};
}

bool HasJoining(const FitCard& card) {
  return card.options.hub_c || card.options.shaft_c;
}

/** Joining at the temperatures that were asked for. */
struct HotJoint {
  double hub_c, shaft_c;
  double clearance;  // Of the largest interference [m].
  double sticking;   // Depth, infinite where it does not stick [m].
};

HotJoint CalcHotJoint(const FitCard& card) {
  const FitCardOptions& o = card.options;
  const fits::PressFitParameters& p = o.press;
  const fits::ThermalJoint joint = MakeThermalJoint(card);
  HotJoint hot{o.hub_c.value_or(o.room_c), o.shaft_c.value_or(o.room_c), 0, 0};
  hot.clearance = fits::CalcHotClearance(joint, hot.hub_c, hot.shaft_c);
  if (hot.clearance > 0) {
    const auto ring = [&p](double outer, double inner) {
      return 0.25 * std::numbers::pi * (outer * outer - inner * inner) * p.length;
    };
    hot.sticking = fits::CalcStickingDepth(joint, hot.hub_c, hot.shaft_c,
                                           {o.hub_heat * ring(p.hub_diameter, p.joint_diameter),
                                            o.shaft_heat * ring(p.joint_diameter, p.shaft_bore),
                                            fits::CalcGapConductance(hot.clearance), o.join_speed});
  }
  return hot;
}

bool IsHubTooHot(const FitCard& card) {
  return card.options.hub_c.value_or(card.options.room_c) > card.options.hub_joining.hottest_c;
}

std::string MakeHotJointText(const FitCard& card) {
  const LengthText lengths(card.options.unit);
  const HotJoint hot = CalcHotJoint(card);
  std::string text = fmt::format("hub at {:g} C, shaft at {:g} C: {} {} of play", hot.hub_c,
                                 hot.shaft_c, lengths.Small(hot.clearance), lengths.small_unit());
  if (IsHubTooHot(card)) {
    text += fmt::format("; above the hub's limit of {:g} C", card.options.hub_joining.hottest_c);
  }
  if (!(hot.clearance > 0)) {
    return text + ", which cannot be assembled\n";
  }
  return text + fmt::format(
                    "; at {}/s it {}\n", lengths.Size(card.options.join_speed),
                    hot.sticking < card.options.press.length
                        ? fmt::format("the joint sticks at a depth of {:.3g} {}",
                                      hot.sticking * lengths.sizes_per_metre(), lengths.size_unit())
                        : "the joint is complete before it sticks");
}

/** How a shaft gets in. */
struct Entry {
  double window;  // Beside the axis, upright, radial [m].
  double largest_tilt, wedging_tilt;
};

/** @param clearance  Of the diameters, >= 0: the least one is the worst case. */
Entry CalcEntry(const FitCard& card, double clearance) {
  const fits::PressFitParameters& p = card.options.press;
  const fits::PegInHole pair{p.joint_diameter + clearance, p.joint_diameter};
  return {fits::CalcEntryWindow(pair, card.options.chamfer_width, 0), fits::CalcLargestTilt(pair),
          std::max(0.0, fits::CalcWedgingTilt(pair, p.friction_in))};
}

double CalcLeastClearance(const FitCard& card) {
  return std::max(0.0, card.limits->min_clearance);
}

ordered_json EntryJson(const FitCard& card) {
  const auto json = [](const Entry& entry) {
    return ordered_json{{"window_um", units::ToUm(entry.window)},
                        {"largest_tilt_deg", units::ToDeg(entry.largest_tilt)},
                        {"wedging_tilt_deg", FiniteOrNull(units::ToDeg(entry.wedging_tilt))}};
  };
  ordered_json entry = json(CalcEntry(card, CalcLeastClearance(card)));
  entry["with_largest_clearance"] = json(CalcEntry(card, card.limits->max_clearance));
  return entry;
}

std::string EntryText(const FitCard& card) {
  const LengthText lengths(card.options.unit);
  const Entry worst = CalcEntry(card, CalcLeastClearance(card));
  const Entry best = CalcEntry(card, card.limits->max_clearance);
  return fmt::format(
             "limits for entering, from the smallest to the largest clearance: upright {} to {} {} "
             "off the axis, tilt {:.2f} to {:.2f} deg\n",
             lengths.Small(worst.window), lengths.Small(best.window), lengths.small_unit(),
             units::ToDeg(worst.largest_tilt), units::ToDeg(best.largest_tilt)) +
         (card.limits->min_clearance > 0
              ? fmt::format(
                    "  no wedging below {:.3f} deg in the worst case, the smallest clearance\n",
                    units::ToDeg(worst.wedging_tilt))
              : std::string("  in the worst case there is no clearance, and the shaft wedges at "
                            "any tilt\n"));
}

Result<fits::PressFit> CalcPressFit(const FitCard& card, double clearance) {
  fits::PressFitParameters p = card.options.press;
  p.interference = -clearance;
  return fits::CalcPressFit(p);
}

}  // namespace

std::string FitCard::Title() const {
  return LengthText(options.unit).Size(options.fit.nominal) + " " + options.fit.ClassText();
}

std::string FitCard::JointText() const {
  const fits::PressFitParameters& p = options.press;
  const LengthText lengths(options.unit);
  std::string text = "joint " + lengths.Size(p.length) + " long";
  if (p.breadth > 0) {
    text += " and " + lengths.Size(p.breadth) + " broad between flat walls";
  }
  text += fmt::format(", {} {} {}, {} {}", p.breadth > 0 ? "slot in" : "hub",
                      lengths.Size(p.hub_diameter), options.hub_material,
                      p.breadth > 0 ? "tongue" : "shaft", options.shaft_material);
  if (p.shaft_bore > 0) {
    text += fmt::format(" with a bore of {}", lengths.Size(p.shaft_bore));
  }
  text += fmt::format(
      ", mu {:g} for pressing in, {:g} for holding, {:g} for sliding out ({}), Rz {} and {} {}",
      p.friction_in, p.friction_release, options.friction_slip, options.friction_source,
      lengths.Small(p.hub_roughness), lengths.Small(p.shaft_roughness), lengths.small_unit());
  if (options.start > 0) {
    text += fmt::format(", from a depth of {} on", lengths.Size(options.start));
  }
  if (options.lead_in_angle > 0) {
    text += fmt::format(", chamfer {:g} deg from the axis", units::ToDeg(options.lead_in_angle));
  }
  return text;
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
  if (fit.ansi) {
    card.limits = fit.ansi->limits;
    card.hole = card.limits->hole;
    card.shaft = card.limits->shaft;
  } else if (fit.hole && fit.shaft) {
    card.limits = *fits::CalcFitLimits({*fit.hole, *fit.shaft}, fit.nominal);
  } else {
    return card;
  }
  if (!(options.press.length > 0)) {
    return card;
  }
  card.options.press.joint_diameter = fit.nominal;
  for (const auto& [clearance, press] :
       {std::pair(card.limits->max_clearance, &card.least),
        std::pair(0.5 * (card.limits->min_clearance + card.limits->max_clearance), &card.mean),
        std::pair(card.limits->min_clearance, &card.most)}) {
    const Result<fits::PressFit> at = CalcPressFit(card, clearance);
    if (!at) {
      return Unexpected(at.error());
    }
    *press = *at;
  }
  return card;
}

namespace {

/** What keeps it sliding out after it has broken loose, at full depth [N]. */
double SlideOut(const FitCard& card, const fits::PressFit& press) {
  const fits::PressFitParameters& p = card.options.press;
  return card.options.friction_slip * press.outline * p.length * press.pressure;
}

/** The class of the ABC system in a fit of ANSI B4.1; empty where a side has none. */
std::string HoleClass(const SizedFit& fit) {
  return fit.ansi ? std::string(fit.ansi->hole) : fit.hole ? fit.hole->ToString() : "";
}

std::string ShaftClass(const SizedFit& fit) {
  return fit.ansi ? std::string(fit.ansi->shaft) : fit.shaft ? fit.shaft->ToString() : "";
}

std::string LimitsText(const FitCard& card) {
  const SizedFit& fit = card.options.fit;
  const LengthText lengths(card.options.unit);
  std::string text;
  const auto side = [&](const char* name, const std::string& tolerance, const auto& limits) {
    if (limits) {
      text += fmt::format("  {:<6} {:<6} {:>8} / {:>8} {}   {} to {} {}\n", name, tolerance,
                          lengths.SignedSmall(limits->upper), lengths.SignedSmall(limits->lower),
                          lengths.small_unit(), lengths.Exact(fit.nominal + limits->lower),
                          lengths.Exact(fit.nominal + limits->upper), lengths.size_unit());
    }
  };
  side("hole", HoleClass(fit), card.hole);
  side("shaft", ShaftClass(fit), card.shaft);
  if (card.limits) {
    text += fmt::format("  {}clearance {} to {} {}: {} fit\n",
                        card.options.press.breadth > 0 ? "" : "diametral ",
                        lengths.SignedSmall(card.limits->min_clearance),
                        lengths.SignedSmall(card.limits->max_clearance), lengths.small_unit(),
                        ToString(mates::ToKind(card.limits->kind)));
  }
  return text;
}

/** What the most that there is does to the material. */
std::string StrengthText(const FitCard& card) {
  const fits::PressFit& most = *card.most;
  std::string text;
  if (most.is_hub_brittle && fits::IsFracturing(most)) {
    text += fmt::format(
        "  the hub is brittle, and the margin of its hoop stress to its tensile strength is below "
        "{:g}\n",
        fits::kBrittleSafety);
  }
  if (most.pressure > most.shaft_limit.von_mises ||
      (!most.is_hub_brittle && most.pressure > most.hub_limit.von_mises)) {
    text +=
        "  the largest interference causes yielding; its values are those of an elastic joint\n";
  }
  return text;
}

std::string PressText(const FitCard& card) {
  const LengthText lengths(card.options.unit);
  const std::string small = lengths.small_unit();
  std::string text = card.JointText() + "\n";
  text += fmt::format("  {:<32} {:>12} {:>12} {:>12}\n", "interference", "least", "mean", "most");
  const auto row = [&](const std::string& name, auto value) {
    text += fmt::format("  {:<32} {:>12} {:>12} {:>12}\n", name, value(*card.least),
                        value(*card.mean), value(*card.most));
  };
  using fits::PressFit;
  const auto fixed = [](double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value + 0.0, digits) : std::string("-");
  };
  row("effective, " + small,
      [&](const PressFit& f) { return lengths.Small(f.effective_interference); });
  row("pressure, MPa", [&](const PressFit& f) { return fixed(units::ToMpa(f.pressure), 2); });
  row("hub widens by, " + small, [&](const PressFit& f) { return lengths.Small(f.hub_expansion); });
  row("shaft narrows by, " + small,
      [&](const PressFit& f) { return lengths.Small(f.shaft_contraction); });
  row("force to press in, N", [&](const PressFit& f) { return fixed(f.press_in_force, 1); });
  row("force to push out, N", [&](const PressFit& f) { return fixed(f.push_out_force, 1); });
  row("force to slide on out, N", [&](const PressFit& f) { return fixed(SlideOut(card, f), 1); });
  row("torque, N m", [&](const PressFit& f) { return fixed(f.torque, 2); });
  row("hub bore, hoop, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.hoop), 1); });
  row("hub bore, von Mises, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.von_mises()), 1); });
  row("hub bore, Tresca, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.hub_bore.tresca()), 1); });
  row("shaft, hoop, MPa",
      [&](const PressFit& f) { return fixed(units::ToMpa(f.shaft_governing.hoop), 1); });
  if (card.most->is_hub_brittle) {
    row(fmt::format("hub, fracture, margin (to be {:g})", fits::kBrittleSafety),
        [&](const PressFit& f) { return fixed(f.margin_hub(), 2); });
    row("shaft, yield, margin", [&](const PressFit& f) { return fixed(f.margin_shaft(), 2); });
  } else {
    row("margin by von Mises", [&](const PressFit& f) { return fixed(f.margin_von_mises(), 2); });
    row("margin by Tresca", [&](const PressFit& f) { return fixed(f.margin_tresca(), 2); });
  }
  text += StrengthText(card);
  if (card.limits->min_clearance < 0) {
    text += JoiningText(card);
    if (HasJoining(card)) {
      text += MakeHotJointText(card);
    }
  }
  return card.limits->max_clearance > 0 ? text + EntryText(card) : text;
}

ordered_json ToJson(const FitCard& card, const fits::PressFit& f) {
  return {{"effective_interference_um", units::ToUm(f.effective_interference)},
          {"pressure_mpa", units::ToMpa(f.pressure)},
          {"press_in_force_n", f.press_in_force},
          {"push_out_force_n", f.push_out_force},
          {"slide_out_force_n", SlideOut(card, f)},
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

}  // namespace

std::string ToText(const FitCard& card) {
  std::string text = card.Title() + "\n";
  text += LimitsText(card);
  if (card.most) {
    text += PressText(card);
  }
  return Fold(text);
}

ordered_json ToJson(const FitCard& card) {
  const SizedFit& fit = card.options.fit;
  ordered_json json{{"nominal_mm", units::ToMm(fit.nominal)}};
  if (fit.ansi) {
    json["ansi_b41"] = fit.ansi->name;
  }
  const auto side = [&](const char* name, const std::string& tolerance, const auto& limits) {
    if (limits) {
      json[name] = {{"class", tolerance},
                    {"upper_um", units::ToUm(limits->upper)},
                    {"lower_um", units::ToUm(limits->lower)}};
    }
  };
  side("hole", HoleClass(fit), card.hole);
  side("shaft", ShaftClass(fit), card.shaft);
  if (card.limits) {
    json["kind"] = ToString(mates::ToKind(card.limits->kind));
    json["min_clearance_um"] = units::ToUm(card.limits->min_clearance);
    json["max_clearance_um"] = units::ToUm(card.limits->max_clearance);
  }
  if (card.most) {
    const fits::PressFitParameters& p = card.options.press;
    json["joint"] = {{"length_mm", units::ToMm(p.length)},
                     {"start_mm", units::ToMm(card.options.start)},
                     {"hub_mm", units::ToMm(p.hub_diameter)},
                     {"bore_mm", units::ToMm(p.shaft_bore)},
                     {"breadth_mm", units::ToMm(p.breadth)},
                     {"chamfer_deg", units::ToDeg(card.options.lead_in_angle)},
                     {"hub_material", card.options.hub_material},
                     {"shaft_material", card.options.shaft_material},
                     {"is_hub_brittle", card.most->is_hub_brittle},
                     {"mu", p.friction_in},
                     {"mu_out", p.friction_release},
                     {"mu_slip", card.options.friction_slip},
                     {"mu_source", card.options.friction_source},
                     {"hub_rz_um", units::ToUm(p.hub_roughness)},
                     {"shaft_rz_um", units::ToUm(p.shaft_roughness)},
                     {"smoothing_loss_um", units::ToUm(card.most->smoothing_loss)}};
    if (card.limits->max_clearance > 0) {
      json["entry"] = EntryJson(card);
    }
    json["press"] = {{"least", ToJson(card, *card.least)},
                     {"mean", ToJson(card, *card.mean)},
                     {"most", ToJson(card, *card.most)}};
    if (card.limits->min_clearance < 0) {
      json["joining"] = JoiningJson(card);
      if (HasJoining(card)) {
        const HotJoint hot = CalcHotJoint(card);
        json["joining"]["asked"] = {{"hub_c", hot.hub_c},
                                    {"shaft_c", hot.shaft_c},
                                    {"is_hub_too_hot", IsHubTooHot(card)},
                                    {"clearance_um", units::ToUm(hot.clearance)},
                                    {"sticking_depth_mm", FiniteOrNull(units::ToMm(hot.sticking))}};
      }
    }
  }
  return json;
}

}  // namespace hvas::app
