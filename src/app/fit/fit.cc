#include "app/fit/fit.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/fit/fit_arguments.h"
#include "app/fit/fit_batch.h"
#include "app/fit/fit_card.h"
#include "app/fit/fit_curve.h"
#include "app/fit/fit_design.h"
#include "app/fit/fit_identify.h"
#include "app/fit/fit_jamming.h"
#include "app/fit/fit_paper.h"
#include "app/fit/fit_peg.h"
#include "app/fit/fit_population.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "app/output/progress.h"
#include "app/output/report_failure.h"
#include "app/output/round_json.h"
#include "app/output/text_layout.h"
#include "base/atomic_file.h"
#include "base/units.h"
#include "fits/fit_search.h"
#include "fits/friction.h"
#include "mates/side_file.h"

namespace hvas::app {
namespace {

struct BatchArguments {
  std::string in;
  std::string out;
};

struct SearchArguments {
  double nominal_mm{0};
  double min_um{0};
  double max_um{0};
  std::string basis{"hole"};
  std::optional<LengthUnit> unit;
  bool is_json{false};
};

bool EndsWith(const std::string& file, std::string_view ending) {
  return file.size() > ending.size() && file.ends_with(ending);
}

/** Writes a plot as the file's name says. */
template <bool kHasCsv, typename Plot>
Result<void> WritePlot(const std::string& file, const Plot& plot) {
  if constexpr (kHasCsv) {
    if (EndsWith(file, ".csv")) {
      return WriteAtomically(file, ToCsv(plot));
    }
  }
  if (!EndsWith(file, ".svg")) {
    return Fail(ErrorCode::kInvalid, fmt::format("a plot cannot be written as \"{}\"", file), {},
                kHasCsv ? "choose a file name ending in .svg or .csv"
                        : "choose a file name ending in .svg");
  }
  return WriteAtomically(file, ToSvg(plot));
}

/** What the arguments ask for, all of it before anything is printed. */
struct Answer {
  std::vector<FitCard> cards;
  FitPopulationOptions options;
  std::optional<fits::Population> population;
  std::optional<FitJamming> jamming;
};

Result<Answer> MakeAnswer(const FitArguments& a) {
  Answer answer;
  Result<std::vector<FitCard>> cards = MakeCards(a);
  if (!cards) {
    return Unexpected(cards.error());
  }
  answer.cards = *std::move(cards);
  if (Result<void> check = CheckEffects(a, answer.cards); !check) {
    return Unexpected(check.error());
  }
  const Result<FitPopulationOptions> options = MakePopulationOptions(a);
  if (!options) {
    return Unexpected(options.error());
  }
  answer.options = *options;
  if (a.has_population) {
    const Busy busy(fmt::format("drawing {} assemblies", options->count));
    Result<fits::Population> population = DrawPopulation(answer.cards, *options);
    if (!population) {
      return Unexpected(population.error());
    }
    answer.population = *std::move(population);
  }
  if (!a.curve.empty()) {
    const Busy busy(fmt::format("drawing {} assemblies for the curve", options->count));
    const Result<FitCurve> curve = MakeFitCurve(answer.cards, *options, units::FromMm(a.step_mm));
    if (!curve) {
      return Unexpected(curve.error());
    }
    if (Result<void> written = WritePlot<true>(a.curve, *curve); !written) {
      return Unexpected(written.error());
    }
  }
  if (!a.jamming.empty()) {
    Result<FitJamming> jamming =
        MakeFitJamming(answer.cards.front(), units::FromMm(a.at_mm), MakeLoad(a));
    if (!jamming) {
      return Unexpected(jamming.error());
    }
    if (Result<void> written = WritePlot<false>(a.jamming, *jamming); !written) {
      return Unexpected(written.error());
    }
    answer.jamming = *std::move(jamming);
  }
  return answer;
}

nlohmann::ordered_json ToJson(const Answer& answer) {
  nlohmann::ordered_json json{{"schema", "hvas-fit-1"}};
  if (answer.cards.size() == 1) {
    json.update(ToJson(answer.cards.front()));
  } else {
    for (const FitCard& card : answer.cards) {
      json["fits"].push_back(ToJson(card));
    }
  }
  if (answer.population) {
    json["population"] = ToJson(*answer.population, answer.cards, answer.options);
  }
  if (answer.jamming) {
    json["jamming"] = ToJson(*answer.jamming);
  }
  RoundNumbers(&json);
  return json;
}

int PrintCard(const FitArguments& arguments) {
  const Result<Answer> answer = MakeAnswer(arguments);
  if (!answer) {
    return ReportFailure(answer.error());
  }
  if (arguments.is_json) {
    fmt::print("{}\n", ToJson(*answer).dump(2));
    return 0;
  }
  for (const FitCard& card : answer->cards) {
    fmt::print("{}", ToText(card));
  }
  if (answer->population) {
    fmt::print("{}", ToText(*answer->population, answer->cards, answer->options));
  }
  if (answer->jamming) {
    fmt::print("{}", ToText(*answer->jamming));
  }
  return 0;
}

struct PaperArguments {
  std::string curve;
  std::uint64_t seed{0};
};

int ShowPaper(const PaperArguments& arguments) {
  const Result<std::vector<PaperCurve>> curves = MakePaperCurves(arguments.seed);
  if (!curves) {
    return ReportFailure(curves.error());
  }
  if (!arguments.curve.empty()) {
    if (Result<void> written = WritePlot<true>(arguments.curve, *curves); !written) {
      return ReportFailure(written.error());
    }
  }
  fmt::print("{}", ToText(*curves));
  return 0;
}

int ShowFriction(bool is_json) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const fits::JointFriction& row : fits::JointFrictionTable()) {
    if (is_json) {
      json.push_back({{"pair", row.pair},
                      {"condition", row.condition},
                      {"symbol", row.symbol},
                      {"low", row.low},
                      {"high", row.high},
                      {"source", row.source},
                      {"status", row.status}});
      continue;
    }
    const std::string range = row.low == row.high ? fmt::format("{:.2f}", row.low)
                                                  : fmt::format("{:.2f}-{:.2f}", row.low, row.high);
    fmt::print(
        "{}{}",
        Fold(fmt::format("{:<28} {:<13} {:<9} {}", row.pair, row.symbol, range, row.condition)),
        Wrap(fmt::format("{}; {}", row.source, row.status), 4));
  }
  if (is_json) {
    fmt::print("{}\n", json.dump(2));
  }
  return 0;
}

int RunBatch(const BatchArguments& arguments, Result<void> (*add)(CsvTable*)) {
  Result<CsvTable> table = CsvTable::Read(arguments.in, CsvTable::kAnyDelimiter);
  if (!table) {
    return ReportFailure(table.error());
  }
  if (Result<void> done = add(&*table); !done) {
    Error error = done.error();
    error.where = arguments.in + ", " + error.where;
    return ReportFailure(error);
  }
  if (arguments.out.empty() || arguments.out == "-") {
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
  const LengthText lengths(a.unit.value_or(LengthUnit::kMillimetre));
  for (const fits::FoundFit& f : *found) {
    const double low_um = units::ToUm(f.limits.min_clearance);
    const double high_um = units::ToUm(f.limits.max_clearance);
    if (a.is_json) {
      json.push_back({{"fit", f.fit.ToString()},
                      {"is_common", f.is_common},
                      {"min_clearance_um", low_um},
                      {"max_clearance_um", high_um}});
    } else {
      fmt::print("{:<10} {:>8} to {:>8} {}{}\n", f.fit.ToString(),
                 lengths.SignedSmall(f.limits.min_clearance),
                 lengths.SignedSmall(f.limits.max_clearance), lengths.small_unit(),
                 f.is_common ? "  common" : "");
    }
  }
  if (a.is_json) {
    RoundNumbers(&json);
    fmt::print("{}\n", json.dump(2));
  } else if (found->empty()) {
    fmt::print("no standard fit of the {} basis has clearances from {:g} to {:g} um at {:g} mm\n",
               a.basis, a.min_um, a.max_um, a.nominal_mm);
  }
  return 0;
}

void AddBatch(CLI::App* fit, const char* name, const char* description, const char* columns,
              Result<void> (*add)(CsvTable*), int* status) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* command = fit->add_subcommand(name, description);
  command->add_option("--batch", arguments->in, "Table to read (CSV); - for standard input")
      ->required();
  command->add_option("-o,--output", arguments->out,
                      "Table to write; default, or -: standard output");
  command->footer(
      fmt::format("{}\nExample:\n  hvas fit {} --batch in.csv -o out.csv", columns, name));
  command->callback([arguments, add, status] { *status = RunBatch(*arguments, add); });
}

void AddSearch(CLI::App* fit, int* status) {
  auto arguments = std::make_shared<SearchArguments>();
  CLI::App* search = fit->add_subcommand("search", "List standard fits with clearances in a range");
  search
      ->add_option("--nominal", arguments->nominal_mm,
                   "Nominal diameter [mm], or with a unit: 1.5in")
      ->required()
      ->check(Positive())
      ->transform(Millimetres());
  search
      ->add_option("--min", arguments->min_um, "Smallest clearance [um]; negative for interference")
      ->check(AnyNumber())
      ->required();
  search
      ->add_option("--max", arguments->max_um, "Largest clearance [um]; negative for interference")
      ->check(AnyNumber())
      ->required();
  search->add_option("--basis", arguments->basis, "Basis system: hole (H) or shaft (h)")
      ->check(CLI::IsMember({"hole", "shaft"}));
  AddUnitOption(search, &arguments->unit);
  AddJsonFlag(search, &arguments->is_json, "fit_search");
  search->footer("Example:\n  hvas fit search --nominal 40 --min 5 --max 60");
  search->callback([arguments, status] { *status = Search(*arguments); });
}

void AddPaper(CLI::App* fit, int* status) {
  auto arguments = std::make_shared<PaperArguments>();
  CLI::App* paper = fit->add_subcommand(
      "paper", "Compute the three force curves of paper W, as displayed and in true newtons");
  paper->add_option("--curve", arguments->curve, "File to write the curves to: .svg or .csv");
  paper->add_option("--seed", arguments->seed, "Seed for roughness and hand motion")
      ->capture_default_str();
  paper->footer("Example:\n  hvas fit paper --curve figure8.svg");
  paper->callback([arguments, status] { *status = ShowPaper(*arguments); });
}

void AddFriction(CLI::App* fit, int* status) {
  auto is_json = std::make_shared<bool>(false);
  CLI::App* friction =
      fit->add_subcommand("friction", "List coefficients of friction with their sources");
  AddJsonFlag(friction, is_json.get(), "fit_friction");
  friction->callback([is_json, status] { *status = ShowFriction(*is_json); });
}

/** Throws where a word can only be a command that is misspelt. */
void CheckCommandWord(const CLI::App& fit, const std::string& word) {
  std::vector<std::string> commands;
  for (const CLI::App* command : fit.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(command->get_name());
  }
  const std::string nearest = mates::FindNearest(word, commands);
  if (!nearest.empty() && !ParseSizedFit(word)) {
    throw CLI::ValidationError(
        fmt::format("\"{}\" is neither a command nor a fit; did you mean \"{}\"?", word, nearest));
  }
}

constexpr const char* kFitFooter =
    "Examples:\n"
    "  hvas fit 40 H7/g6\n"
    "  hvas fit 1.5in RC4\n"
    "  hvas fit 40 H7/p6 --length 50 --hub 80 --material S355 --curve force.svg\n"
    "  hvas fit 40 H7/k6 --length 50 --rz 6.3 --population 1e6 --press-limit 20000\n"
    "  hvas fit 40 H7/p6 35 H7/k6 --length 20,30 --start 0,40 --population 1e6\n"
    "  hvas fit 40 H7/g6 --length 50 --jamming jam.svg --at 20 --load 5,20,100\n"
    "  hvas fit 40 H7/p6 --length 50 --hub-material \"S355 Re=400\" --room 25\n"
    "  hvas fit design --nominal 40 --length 50 --hub 80 --torque 200\n"
    "  hvas fit paper --curve figure8.svg\n"
    "  hvas fit limits --batch classes.csv -o limits.csv\n"
    "  hvas fit search --nominal 40 --min 5 --max 60";

/** The commands that calculate tables. */
void AddTables(CLI::App* fit, int* status) {
  AddBatch(fit, "limits", "Calculate limits for a table of tolerance classes",
           "Input columns: nominal_mm, class. Output columns: kind, upper_um, lower_um; empty, "
           "with a reason, where the standard defines no limits.",
           AddLimits, status);
  AddBatch(fit, "press", "Calculate press fits for a table of joints",
           "Input columns: d_F_mm, D_hub_mm, d_bore_shaft_mm, U_eff_diametral_mm, L_mm, mu, "
           "E_hub_MPa, nu_hub, E_shaft_MPa, nu_shaft. Output columns: pressure, expansions, "
           "stresses, force, torque.",
           AddPressFits, status);
  AddBatch(fit, "peg", "Solve a table of peg-in-hole problems",
           "Input columns: kind (two_point, two_point_depth, jamming, jamming_point, wedging, "
           "statics, chamfer, one_point), id, inputs (for example \"D=40 d=39.9 l=10 mm\"), "
           "output, unit. Output column: value; empty, with a reason, where no peg has such "
           "inputs. Whether a load jams: jamming_point with Fx, Fz, M, l, r, mu; output slides. "
           "The wedging tilt: wedging with D, d, mu; output theta_w.",
           AddInsertions, status);
}

}  // namespace

void AddFit(CLI::App* app, int* status) {
  CLI::App* fit = app->add_subcommand("fit", "Limits, press fits and insertion of ISO 286 fits");
  auto a = std::make_shared<FitArguments>();
  AddFitArguments(fit, a.get());
  fit->footer(kFitFooter);
  AddTables(fit, status);
  AddSearch(fit, status);
  AddFitIdentify(fit, status);
  AddPaper(fit, status);
  AddFriction(fit, status);
  AddFitDesign(fit, status);
  for (CLI::App* command : fit->get_subcommands([](CLI::App*) { return true; })) {
    command->preparse_callback([fit, command](std::size_t) {
      for (const CLI::Option* option : fit->get_options()) {
        if (option->count() > 0) {
          throw CLI::ValidationError(
              option->get_name(), "has no effect before " + command->get_name() + "; leave it out");
        }
      }
    });
  }
  fit->callback([a, fit, status] {
    if (!fit->get_subcommands().empty()) {
      return;
    }
    if (a->fits.empty()) {
      throw CLI::RequiredError(
          "a fit, or a command: limits, press, peg, search, design, paper, friction, materials,");
    }
    a->fits = JoinFitWords(a->fits);
    CheckCommandWord(*fit, a->fits.front());
    a->has_population = fit->count("--population") > 0;
    const Result<void> check = CheckEffects(*fit);
    *status = check ? PrintCard(*a) : ReportMisuse(check.error());
  });
}

}  // namespace hvas::app
