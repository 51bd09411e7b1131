#include "app/fit.h"

#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/fit_batch.h"
#include "app/fit_card.h"
#include "app/report_failure.h"
#include "base/atomic_file.h"
#include "base/units.h"
#include "fits/fit_search.h"
#include "fits/materials.h"

namespace hvas::app {
namespace {

/** As they are typed: lengths in mm and um. */
struct CardArguments {
  std::string fit;
  double length_mm{0};
  double hub_mm{0};
  double bore_mm{0};
  std::string material, hub_material, shaft_material;
  double friction{0.15};
  double rz_um{0};
  std::string smoothing{"din2017"};
  FitCardOptions card;
  bool is_json{false};
};

struct BatchArguments {
  std::string in;
  std::string out;
};

struct SearchArguments {
  double nominal_mm{0};
  double min_um{0};
  double max_um{0};
  std::string basis{"hole"};
  bool is_json{false};
};

Result<fits::PressMaterial> FindPressMaterial(const std::string& name, std::string* found) {
  const auto match = fits::FindMaterial(name);
  if (!match) {
    return Fail(ErrorCode::kNotFound, fmt::format("there is no material \"{}\"", name), {},
                "name it as EN, DIN or AISI do: S355, 42CrMo4, 304, EN-GJL-250, CuSn8");
  }
  *found = std::string(match->material->name);
  return fits::ToPressMaterial(*match->material);
}

Result<FitCardOptions> MakeOptions(const CardArguments& a) {
  FitCardOptions options = a.card;
  Result<SizedFit> fit = ParseSizedFit(a.fit);
  if (!fit) {
    return Unexpected(fit.error());
  }
  options.fit = *fit;
  if (options.population > 0 && (!(a.length_mm > 0) || !fit->hole || !fit->shaft)) {
    return Fail(ErrorCode::kInvalid, "a population needs a hole, a shaft and a length", {},
                "give both classes and --length");
  }
  fits::PressFitParameters& p = options.press;
  p.joint_diameter = fit->nominal;
  p.length = units::FromMm(a.length_mm);
  p.hub_diameter = a.hub_mm > 0 ? units::FromMm(a.hub_mm) : 2 * fit->nominal;
  p.shaft_bore = units::FromMm(a.bore_mm);
  p.friction_in = p.friction_release = p.friction_torque = a.friction;
  p.hub_roughness = p.shaft_roughness = units::FromUm(a.rz_um);
  p.smoothing = a.smoothing == "none"      ? fits::Smoothing::kNone
                : a.smoothing == "din2001" ? fits::Smoothing::kDin2001
                                           : fits::Smoothing::kDin2017;
  const std::string both = a.material.empty() ? "S355" : a.material;
  const Result<fits::PressMaterial> hub =
      FindPressMaterial(a.hub_material.empty() ? both : a.hub_material, &options.hub_material);
  const Result<fits::PressMaterial> shaft = FindPressMaterial(
      a.shaft_material.empty() ? both : a.shaft_material, &options.shaft_material);
  if (!hub || !shaft) {
    return Unexpected((hub ? shaft : hub).error());
  }
  p.hub = *hub;
  p.shaft = *shaft;
  return options;
}

int PrintCard(const CardArguments& arguments) {
  const Result<FitCardOptions> options = MakeOptions(arguments);
  if (!options) {
    return ReportFailure(options.error());
  }
  const Result<FitCard> card = MakeFitCard(*options);
  if (!card) {
    return ReportFailure(card.error());
  }
  fmt::print("{}", arguments.is_json ? ToJson(*card).dump(2) + "\n" : ToText(*card));
  return 0;
}

int RunBatch(const BatchArguments& arguments, Result<void> (*add)(CsvTable*)) {
  Result<CsvTable> table = CsvTable::Read(arguments.in);
  if (!table) {
    return ReportFailure(table.error());
  }
  if (Result<void> done = add(&*table); !done) {
    Error error = done.error();
    error.where = arguments.in + ", " + error.where;
    return ReportFailure(error);
  }
  if (arguments.out.empty()) {
    fmt::print("{}", table->ToText());
    return 0;
  }
  const Result<void> written = WriteAtomically(arguments.out, table->ToText());
  return written ? 0 : ReportFailure(written.error());
}

int Search(const SearchArguments& a) {
  const auto found =
      fits::FindFits(units::FromMm(a.nominal_mm), units::FromUm(a.min_um), units::FromUm(a.max_um),
                     a.basis == "shaft" ? fits::FitBasis::kShaft : fits::FitBasis::kHole);
  if (!found) {
    return ReportFailure(found.error());
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const fits::FoundFit& f : *found) {
    const double low_um = units::ToUm(f.limits.min_clearance);
    const double high_um = units::ToUm(f.limits.max_clearance);
    if (a.is_json) {
      json.push_back({{"fit", f.fit.ToString()},
                      {"is_common", f.is_common},
                      {"min_clearance_um", low_um},
                      {"max_clearance_um", high_um}});
    } else {
      fmt::print("{:<10} {:>+8.1f} to {:>+8.1f} um{}\n", f.fit.ToString(), low_um, high_um,
                 f.is_common ? "  common" : "");
    }
  }
  if (a.is_json) {
    fmt::print("{}\n", json.dump(2));
  } else if (found->empty()) {
    fmt::print("no fit of the {} basis has clearances within {:g} to {:g} um at {:g} mm\n", a.basis,
               a.min_um, a.max_um, a.nominal_mm);
  }
  return 0;
}

void AddBatch(CLI::App* fit, const char* name, const char* description, const char* columns,
              Result<void> (*add)(CsvTable*), int* status) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* command = fit->add_subcommand(name, description);
  command->add_option("--batch", arguments->in, "Table to read (CSV); - for the standard input")
      ->required();
  command->add_option("-o,--output", arguments->out, "Table to write; the standard output without");
  command->footer(
      fmt::format("{}\nExample:\n  hvas fit {} --batch in.csv -o out.csv", columns, name));
  command->callback([arguments, add, status] { *status = RunBatch(*arguments, add); });
}

void AddSearch(CLI::App* fit, int* status) {
  auto arguments = std::make_shared<SearchArguments>();
  CLI::App* search = fit->add_subcommand("search", "Standard fits with clearances in a range");
  search->add_option("--nominal", arguments->nominal_mm, "Nominal diameter [mm]")->required();
  search->add_option("--min", arguments->min_um, "Least clearance [um]; negative: interference")
      ->required();
  search->add_option("--max", arguments->max_um, "Largest clearance [um]")->required();
  search->add_option("--basis", arguments->basis, "hole (H) or shaft (h)")
      ->check(CLI::IsMember({"hole", "shaft"}));
  search->add_flag("--json", arguments->is_json, "Print one JSON document");
  search->footer("Example:\n  hvas fit search --nominal 40 --min 5 --max 60");
  search->callback([arguments, status] { *status = Search(*arguments); });
}

}  // namespace

void AddFit(CLI::App* app, int* status) {
  CLI::App* fit = app->add_subcommand("fit", "Limits, press fits and insertion of ISO 286 fits");
  auto a = std::make_shared<CardArguments>();
  fit->add_option("fit", a->fit, "Diameter and classes: \"40 H7/p6\", \"40 H7\", \"1.5in H7/g6\"");
  fit->add_option("--length", a->length_mm,
                  "Of the joint [mm]; with it the press fit is calculated")
      ->check(CLI::PositiveNumber);
  fit->add_option("--hub", a->hub_mm, "Outer diameter of the hub [mm]; twice the nominal without")
      ->check(CLI::PositiveNumber);
  fit->add_option("--bore", a->bore_mm, "Bore of a hollow shaft [mm]")
      ->check(CLI::NonNegativeNumber);
  fit->add_option("--material", a->material, "Of both parts [S355]");
  fit->add_option("--hub-material", a->hub_material, "Of the hub");
  fit->add_option("--shaft-material", a->shaft_material, "Of the shaft");
  fit->add_option("--mu", a->friction, "Coefficient of friction")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  fit->add_option("--rz", a->rz_um, "Roughness Rz of both surfaces [um]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  fit->add_option("--smoothing", a->smoothing,
                  "Interference lost to roughness: none, din2001 (0.8), din2017 (0.4 of the sum)")
      ->check(CLI::IsMember({"none", "din2001", "din2017"}))
      ->capture_default_str();
  fit->add_option("--population", a->card.population, "Draw so many assemblies")
      ->check(CLI::PositiveNumber);
  fit->add_option("--seed", a->card.seed, "Of the population")->capture_default_str();
  fit->add_option("--press", a->card.press_force, "What the press can do [N]")
      ->check(CLI::PositiveNumber);
  fit->add_flag("--json", a->is_json, "Print one JSON document");
  fit->footer(
      "Examples:\n"
      "  hvas fit \"40 H7/g6\"\n"
      "  hvas fit \"40 H7/p6\" --length 50 --hub 80 --material S355\n"
      "  hvas fit \"40 H7/k6\" --length 50 --rz 6.3 --population 1000000 --press 20000 --json\n"
      "  hvas fit limits --batch classes.csv -o limits.csv\n"
      "  hvas fit search --nominal 40 --min 5 --max 60");
  AddBatch(fit, "limits", "Limits of a table of classes",
           "In: nominal_mm, class. Out: kind, upper_um, lower_um; empty, and a reason, where the "
           "standard defines nothing.",
           AddLimits, status);
  AddBatch(
      fit, "press", "Press fits of a table of joints",
      "In: d_F_mm, D_hub_mm, d_bore_shaft_mm, U_eff_diametral_mm, L_mm, mu, E_hub_MPa, nu_hub, "
      "E_shaft_MPa, nu_shaft. Out: pressure, expansions, stresses, force, torque.",
      AddPressFits, status);
  AddBatch(
      fit, "peg", "Answers to a table of questions about a peg in a hole",
      "In: kind (two_point, two_point_depth, jamming, wedging, statics, chamfer, one_point), id, "
      "inputs (as in \"D=40 d=39.9 l=10\"), output, unit. Out: value.",
      AddInsertions, status);
  AddSearch(fit, status);
  fit->callback([a, fit, status] {
    if (!fit->get_subcommands().empty()) {
      return;
    }
    if (a->fit.empty()) {
      throw CLI::RequiredError("a fit, or one of limits, press, peg, search,");
    }
    *status = PrintCard(*a);
  });
}

}  // namespace hvas::app
