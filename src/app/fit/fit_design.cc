#include "app/fit/fit_design.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/length_text.h"
#include "app/output/number_range.h"
#include "app/output/report_failure.h"
#include "app/output/round_json.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "fits/materials.h"
#include "fits/thermal_joining.h"

namespace hvas::app {
namespace {

using nlohmann::ordered_json;

// Proposals are read by people, who compare few: a choice.
constexpr std::size_t kMaxProposals = 5;

Result<void> Check(const FitDemand& d) {
  const bool is_good = d.torque >= 0 && d.axial >= 0 && std::isfinite(d.torque + d.axial) &&
                       d.torque + d.axial > 0 && d.safety >= 1 && std::isfinite(d.safety);
  if (is_good) {
    return {};
  }
  return Fail(ErrorCode::kInvalid, "the joint has no load, or a safety below 1", {},
              "give a positive --torque or --axial, and a --safety of at least 1");
}

FitArguments WithFit(const FitArguments& joint, const FitDemand& demand, const std::string& fit) {
  FitArguments arguments = joint;
  arguments.fits = {fmt::format("{:.6f} {}", demand.nominal_mm, fit)};
  return arguments;
}

std::string ToText(const FitDesign& d) {
  const LengthText lengths(d.unit);
  std::string text = fmt::format(
      "{:g} N m and {:g} N at once with a safety of {:g} need {:.2f} MPa, an interference of at "
      "least {} {};\n"
      "{} {:.2f} MPa, {} {}\n",
      d.demand.torque, d.demand.axial, d.demand.safety, units::ToMpa(d.required_pressure),
      lengths.Small(d.required_interference), lengths.small_unit(),
      d.is_hub_brittle
          ? fmt::format("the brittle hub allows with a safety of {:g}", fits::kBrittleSafety)
          : std::string("it yields (von Mises) at"),
      units::ToMpa(d.largest_pressure), lengths.Small(d.largest_interference),
      lengths.small_unit());
  if (d.proposals.empty()) {
    return Fold(
        text +
        "no standard fit lies between; a longer joint or a thicker hub needs less interference\n");
  }
  text += d.proposals.front().JointText() + "\n";
  TextTable table({"fit", std::string("interference, ") + lengths.small_unit(), "holds, N m",
                   "to press in, N", "margin"});
  for (const FitCard& card : d.proposals) {
    table.Add({card.options.fit.ClassText(),
               fmt::format("{} to {}", lengths.Small(-card.limits->max_clearance),
                           lengths.Small(-card.limits->min_clearance)),
               fmt::format("{:.1f}", card.least->torque),
               fmt::format("{:.0f}", card.most->press_in_force),
               fmt::format("{:.2f}", card.most->margin_von_mises())});
  }
  return Fold(text) + table.ToText(2);
}

ordered_json ToJson(const FitDesign& d) {
  ordered_json json{{"schema", "hvas-fit-design-1"},
                    {"nominal_mm", d.demand.nominal_mm},
                    {"torque_nm", d.demand.torque},
                    {"axial_n", d.demand.axial},
                    {"safety", d.demand.safety},
                    {"required_pressure_mpa", units::ToMpa(d.required_pressure)},
                    {"required_interference_um", units::ToUm(d.required_interference)},
                    {"largest_pressure_mpa", units::ToMpa(d.largest_pressure)},
                    {"largest_interference_um", units::ToUm(d.largest_interference)},
                    {"is_hub_brittle", d.is_hub_brittle},
                    {"proposals", ordered_json::array()}};
  for (const FitCard& card : d.proposals) {
    json["proposals"].push_back(
        {{"fit", card.options.fit.ClassText()},
         {"least_interference_um", units::ToUm(-card.limits->max_clearance)},
         {"largest_interference_um", units::ToUm(-card.limits->min_clearance)},
         {"least_torque_nm", card.least->torque},
         {"least_push_out_force_n", card.least->push_out_force},
         {"largest_press_in_force_n", card.most->press_in_force},
         {"margin_von_mises", card.most->margin_von_mises()}});
  }
  RoundNumbers(&json);
  return json;
}

struct DesignArguments {
  FitDemand demand;
  FitArguments joint;
  double length_mm{0}, hub_mm{0}, bore_mm{0};
  bool is_json{false};
};

int RunDesign(DesignArguments a) {
  a.joint.length_mm = {a.length_mm};
  if (a.hub_mm != 0) {
    a.joint.hub_mm = {a.hub_mm};
  }
  a.joint.bore_mm = {a.bore_mm};
  const Result<FitDesign> design = DesignFit(a.demand, a.joint);
  if (!design) {
    return ReportFailure(design.error());
  }
  fmt::print("{}", a.is_json ? ToJson(*design).dump(2) + "\n" : ToText(*design));
  return 0;
}

ordered_json MaterialsJson() {
  ordered_json json = ordered_json::array();
  for (const fits::Material& m : fits::Materials()) {
    const fits::JoiningMaterial joining = fits::FindJoiningMaterial(m);
    json.push_back({{"name", m.name},
                    {"group", m.group},
                    {"youngs_modulus_mpa", units::ToMpa(m.youngs_modulus)},
                    {"poisson_ratio", m.poisson_ratio},
                    {"density_kg_m3", m.density},
                    {"yield_strength_mpa", units::ToMpa(m.yield_strength)},
                    {"tensile_strength_mpa", units::ToMpa(m.tensile_strength)},
                    {"heating_per_k", joining.heating},
                    {"cooling_per_k", joining.cooling},
                    {"expansion_source", joining.source},
                    {"hottest_c", joining.hottest_c},
                    {"note", m.note}});
  }
  RoundNumbers(&json);
  return json;
}

std::string MaterialsText() {
  TextTable table({"material", "E\nGPa", "nu\n", "rho\nkg/m3", "Re\nMPa", "Rm\nMPa",
                   "alpha\n1e-6/K", "up to\nC"});
  for (const fits::Material& m : fits::Materials()) {
    const fits::JoiningMaterial joining = fits::FindJoiningMaterial(m);
    table.Add({std::string(m.name), fmt::format("{:g}", units::ToMpa(m.youngs_modulus) / 1e3),
               fmt::format("{:g}", m.poisson_ratio), fmt::format("{:g}", m.density),
               fmt::format("{:g}", units::ToMpa(m.yield_strength)),
               fmt::format("{:g}", units::ToMpa(m.tensile_strength)),
               fmt::format("{:.1f} / {:.1f}", 1e6 * joining.heating, 1e6 * joining.cooling),
               fmt::format("{:g}", joining.hottest_c)});
  }
  return table.ToText() + Fold(
                              "alpha: for heating / for cooling when joining; up to: limit for "
                              "heating a hub. --json has groups, sources and notes.\n");
}

}  // namespace

Result<FitDesign> DesignFit(const FitDemand& demand, const FitArguments& joint) {
  if (Result<void> check = Check(demand); !check) {
    return Unexpected(check.error());
  }
  const Result<std::vector<FitCard>> any = MakeCards(WithFit(joint, demand, "H7/h6"));
  if (!any) {
    return Unexpected(any.error());
  }
  if (!any->front().most) {
    return Fail(ErrorCode::kInvalid, "the length of the joint is missing", {},
                "give a positive --length");
  }
  const fits::PressFitParameters& press = any->front().options.press;
  const fits::PressFit& geometry = *any->front().most;
  FitDesign d;
  d.demand = demand;
  d.required_pressure =
      fits::CalcRequiredPressure(press, demand.axial, demand.torque, demand.safety);
  d.largest_pressure = fits::CalcLargestPressure(geometry);
  d.is_hub_brittle = geometry.is_hub_brittle;
  d.unit = joint.unit.value_or(LengthUnit::kMillimetre);
  const Result<double> least = fits::CalcInterferenceFor(d.required_pressure, press);
  const Result<double> most = fits::CalcInterferenceFor(d.largest_pressure, press);
  if (!least || !most) {
    return Unexpected((least ? most : least).error());
  }
  d.required_interference = *least;
  d.largest_interference = *most;
  if (!(d.required_pressure < d.largest_pressure)) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("this load needs {:.1f} MPa, and the joint {} {:.1f} MPa",
                            units::ToMpa(d.required_pressure),
                            d.is_hub_brittle ? "with its brittle hub allows" : "yields at",
                            units::ToMpa(d.largest_pressure)),
                {}, "make the joint longer or the hub thicker, or choose a stronger material");
  }
  const auto found = fits::FindFits(press.joint_diameter, -d.largest_interference,
                                    -d.required_interference, demand.basis);
  if (!found) {
    return Unexpected(found.error());
  }
  for (const fits::FoundFit& fit : *found) {
    if (d.proposals.size() == kMaxProposals) {
      break;
    }
    Result<std::vector<FitCard>> cards = MakeCards(WithFit(joint, demand, fit.fit.ToString()));
    if (!cards) {
      return Unexpected(cards.error());
    }
    d.proposals.push_back(std::move(cards->front()));
  }
  return d;
}

void AddFitDesign(CLI::App* fit, int* status) {
  auto a = std::make_shared<DesignArguments>();
  CLI::App* design = fit->add_subcommand(
      "design", "Find the interference and fits that hold a torque and a force");
  design
      ->add_option("--nominal", a->demand.nominal_mm,
                   "Nominal diameter [mm], or with a unit: 1.5in")
      ->required()
      ->check(Positive())
      ->transform(Millimetres());
  design->add_option("--length", a->length_mm, "Length of the joint [mm]")
      ->required()
      ->check(Positive())
      ->transform(Millimetres());
  design->add_option("--torque", a->demand.torque, "Torque to hold about the axis [N m]")
      ->check(NotNegative());
  design->add_option("--axial", a->demand.axial, "Axial force to hold at the same time [N]")
      ->check(NotNegative());
  design->add_option("--safety", a->demand.safety, "Against slip")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  design
      ->add_option("--hub", a->hub_mm,
                   "Outer diameter of the hub [mm]; default: twice the nominal diameter")
      ->check(Positive())
      ->transform(Millimetres());
  design->add_option("--bore", a->bore_mm, "Bore of a hollow shaft [mm]")
      ->check(NotNegative())
      ->transform(Millimetres());
  design->add_option("--material", a->joint.material, "Material of both parts [S355]");
  design->add_option("--hub-material", a->joint.hub_material, "Material of the hub");
  design->add_option("--shaft-material", a->joint.shaft_material, "Material of the shaft");
  design->add_option("--rz", a->joint.rz_um, "Roughness Rz of both surfaces [um]")
      ->check(NotNegative());
  design
      ->add_option("--mu", a->joint.friction,
                   "Coefficient of friction; default: by the pair of materials")
      ->check(Positive());
  design->add_flag("--oiled", a->joint.is_oiled,
                   "Use friction with mineral oil instead of dry friction");
  design->add_flag("--shrunk", a->joint.is_shrunk,
                   "Use the friction of a joint by heat or cold instead of one pressed in");
  AddChoice(
      design, "--basis", &a->demand.basis,
      Choices<fits::FitBasis>{{"hole", fits::FitBasis::kHole}, {"shaft", fits::FitBasis::kShaft}},
      "Basis system: hole (H) or shaft (h)");
  AddUnitOption(design, &a->joint.unit);
  AddJsonFlag(design, &a->is_json, "fit_design");
  design->footer(
      "Example:\n  hvas fit design --nominal 40 --length 50 --hub 80 --rz 6.3 --torque 200");
  design->callback([a, status] { *status = RunDesign(*a); });

  auto is_json = std::make_shared<bool>(false);
  CLI::App* materials =
      fit->add_subcommand("materials", "List the materials with the properties that fits use");
  AddJsonFlag(materials, is_json.get(), "fit_materials");
  materials->callback([is_json, status] {
    fmt::print("{}", *is_json ? MaterialsJson().dump(2) + "\n" : MaterialsText());
    *status = 0;
  });
}

}  // namespace hvas::app
