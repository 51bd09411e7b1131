#include "app/fit/fit_arguments.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/fit/csv_table.h"
#include "app/output/choice.h"
#include "app/output/json_flag.h"
#include "app/output/number_range.h"
#include "base/units.h"
#include "fits/joint_friction.h"
#include "fits/materials.h"
#include "fits/thermal_joining.h"

namespace hvas::app {

const CLI::Validator& Millimetres() {
  static const CLI::Validator validator(
      [](std::string& text) {
        if (text.starts_with(' ') || text.ends_with(' ')) {
          return std::string();  // It is no number for any other option, either.
        }
        std::string_view rest = text;
        const std::optional<double> length = TakeLength(&rest);
        if (length && rest.empty()) {
          text = fmt::format("{}", units::ToMm(*length));
        }
        return std::string();  // What is no length the option itself refuses.
      },
      "");
  return validator;
}

void AddUnitOption(CLI::App* command, std::optional<LengthUnit>* unit) {
  AddChoice(command, "--unit", unit,
            Choices<LengthUnit>{{"mm", LengthUnit::kMillimetre}, {"in", LengthUnit::kInch}},
            "Unit of the results: millimetres and micrometres, or inches and thousandths of an "
            "inch; default: the unit of the fit");
}

namespace {

/** What there is to join parts at: nothing is colder than liquid nitrogen. */
const CLI::Validator& Temperature() {
  static const CLI::Validator validator(
      [](const std::string& text) {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) {
          return text + " is not a temperature";
        }
        if (value < fits::kAbsoluteZero_c) {
          return text + " C is below absolute zero, -273.15 C";
        }
        if (value < fits::kNitrogen_c) {
          return text + " C is below the temperature of liquid nitrogen, -196 C";
        }
        return value <= 1000 ? std::string() : text + " C is above the limit of 1000 C for joining";
      },
      "-196 TO 1000");
  return validator;
}

constexpr std::int64_t kMaxAssemblies = 100'000'000;  // What is kept of them takes 0.3 GB.
// More than any machine that it ran on has: a choice.
constexpr std::int64_t kMaxThreads = 256;

/** The value of the k-th fit in a list with one for each, or one for all. */
double Pick(const std::vector<double>& list, std::size_t k, double otherwise) {
  return list.empty() ? otherwise : list[std::min(k, list.size() - 1)];
}

/** A material as it is named, or as its values are given. */
struct NamedMaterial {
  fits::Material material;
  std::string name;
  fits::JoiningMaterial joining;
};

Unexpected FailNoMaterial(const std::string& what) {
  return Fail(ErrorCode::kNotFound, what, {},
              "use a designation of EN, DIN or AISI (hvas fit materials lists them), with values "
              "of your own behind it or alone: \"S355 Re=400 alpha=12\", \"E=210 nu=0.3 Re=355\"");
}

/** Sets a value; E in GPa, Re and Rm in MPa, alpha and cold in 1e-6/K, rho in kg/m^3. */
bool SetValue(std::string_view key, double value, NamedMaterial* named) {
  fits::Material& m = named->material;
  if (key == "E") {
    m.youngs_modulus = units::FromGpa(value);
  } else if (key == "nu") {
    m.poisson_ratio = value;
  } else if (key == "Re") {
    m.yield_strength = units::FromMpa(value);
  } else if (key == "Rm") {
    m.tensile_strength = units::FromMpa(value);
  } else if (key == "rho") {
    m.density = value;
  } else if (key == "alpha") {
    m.thermal_expansion = named->joining.heating = 1e-6 * value;
    named->joining.cooling = 0.77e-6 * value;
    named->joining.source = "given; 0.77 of it for cooling unless cold is given";
  } else if (key == "cold") {
    named->joining.cooling = 1e-6 * value;
  } else {
    return false;
  }
  return value > 0;
}

/** "S355", "S355 Re=400 alpha=12" or "E=210 nu=0.3 Re=355 alpha=11": a name, values, or both. */
Result<NamedMaterial> FindNamed(const std::string& text) {
  NamedMaterial named;
  std::vector<std::string> values;
  std::string base;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    if (word.find('=') != std::string::npos) {
      values.push_back(word);
    } else if (!word.empty()) {
      base += (base.empty() ? "" : " ") + word;
    }
  }
  if (!base.empty() || values.empty()) {
    const auto match = fits::FindMaterial(base);
    if (!match) {
      return FailNoMaterial(fmt::format("there is no material \"{}\"", text));
    }
    named.material = *match->material;
    named.name = std::string(match->material->name);
  } else {
    named.material = {"", "", 0, -1, 7850, 0, 0, 11e-6, ""};
    named.name = "own";
  }
  named.joining = fits::FindJoiningMaterial(named.material);
  for (const std::string& word : values) {
    const std::size_t equals = word.find('=');
    const std::optional<double> value = ParseNumber(std::string_view(word).substr(equals + 1));
    if (!value || !std::isfinite(*value) ||
        !SetValue(std::string_view(word).substr(0, equals), *value, &named)) {
      return FailNoMaterial(
          fmt::format("\"{}\" is not a positive value of E [GPa], nu, Re, Rm [MPa], rho [kg/m3], "
                      "alpha or cold [1e-6/K]",
                      word));
    }
    named.name += " " + word;
  }
  if (!(named.material.youngs_modulus > 0) || !(named.material.poisson_ratio >= 0)) {
    return FailNoMaterial(fmt::format("\"{}\" needs both E and nu", text));
  }
  return named;
}

void SetFriction(const FitArguments& a, const fits::Material& hub, const fits::Material& shaft,
                 FitCardOptions* options) {
  fits::PressFitParameters& p = options->press;
  const bool is_shrunk = a.is_shrunk || a.hub_c || a.shaft_c;
  fits::PressFriction friction = fits::FindPressFriction(hub, shaft, {is_shrunk, a.is_oiled});
  if (a.friction >= 0) {
    friction = {a.friction, a.friction, a.friction, "given"};
  }
  if (a.friction_out >= 0) {
    friction.release = friction.slip = a.friction_out;
    friction.source += a.friction >= 0 ? "" : "; holding: as given";
  }
  p.friction_in = friction.in;
  p.friction_release = p.friction_torque = friction.release;
  options->friction_slip = friction.slip;
  options->friction_source = friction.source;
}

Result<FitCardOptions> MakeOptions(const FitArguments& a, std::size_t k) {
  FitCardOptions options;
  Result<SizedFit> fit = ParseSizedFit(a.fits[k]);
  if (!fit) {
    return Unexpected(fit.error());
  }
  options.fit = *fit;
  options.start = units::FromMm(Pick(a.start_mm, k, 0));
  options.lead_in_angle = units::FromDeg(a.chamfer_deg);
  options.chamfer_width = units::FromMm(a.chamfer_width_mm);
  fits::PressFitParameters& p = options.press;
  p.joint_diameter = fit->nominal;
  p.length = units::FromMm(Pick(a.length_mm, k, 0));
  p.breadth = units::FromMm(a.breadth_mm);
  p.hub_diameter = a.hub_mm.empty() ? 2 * fit->nominal : units::FromMm(Pick(a.hub_mm, k, 0));
  p.shaft_bore = units::FromMm(Pick(a.bore_mm, k, 0));
  p.hub_roughness = units::FromUm(a.hub_rz_um >= 0 ? a.hub_rz_um : a.rz_um);
  p.shaft_roughness = units::FromUm(a.shaft_rz_um >= 0 ? a.shaft_rz_um : a.rz_um);
  p.smoothing = a.smoothing == "none"      ? fits::Smoothing::kNone
                : a.smoothing == "din2001" ? fits::Smoothing::kDin2001
                                           : fits::Smoothing::kDin2017;
  const std::string both = a.material.empty() ? "S355" : a.material;
  const Result<NamedMaterial> hub = FindNamed(a.hub_material.empty() ? both : a.hub_material);
  const Result<NamedMaterial> shaft = FindNamed(a.shaft_material.empty() ? both : a.shaft_material);
  if (!hub || !shaft) {
    return Unexpected((hub ? shaft : hub).error());
  }
  p.hub = fits::ToPressMaterial(hub->material);
  p.shaft = fits::ToPressMaterial(shaft->material);
  options.hub_material = hub->name;
  options.shaft_material = shaft->name;
  options.hub_joining = hub->joining;
  options.shaft_joining = shaft->joining;
  options.room_c = a.room_c;
  options.unit = a.unit.value_or(fit->unit);
  options.hub_c = a.hub_c;
  options.shaft_c = a.shaft_c;
  options.join_speed = units::FromMm(a.join_speed_mm_s);
  options.hub_heat = hub->material.density * fits::SpecificHeatOf(hub->material.group);
  options.shaft_heat = shaft->material.density * fits::SpecificHeatOf(shaft->material.group);
  SetFriction(a, hub->material, shaft->material, &options);
  return options;
}

Result<void> CheckLists(const FitArguments& a) {
  for (const auto& [name, size] :
       {std::pair("--length", a.length_mm.size()), std::pair("--hub", a.hub_mm.size()),
        std::pair("--bore", a.bore_mm.size()), std::pair("--start", a.start_mm.size())}) {
    if (size > 1 && size != a.fits.size()) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("{} has {} values for {} fits", name, size, a.fits.size()), {},
                  "give one value for all fits, or one for each, separated by commas");
    }
  }
  return {};
}

void AddBatchArguments(CLI::App* fit, FitArguments* a) {
  const char* const group = "Populations";
  fit->add_option("--population", a->population.count, "Number of assemblies to simulate")
      ->transform(Count(kMaxAssemblies))
      ->group(group);
  fit->add_option("--seed", a->population.seed, "Seed of the random numbers")
      ->capture_default_str()
      ->group(group);
  fit->add_option("--press-limit,--press", a->population.press_force,
                  "Force limit of the press [N]")
      ->check(Positive())
      ->group(group);
  fit->add_option("--sizes-spread", a->spread,
                  "Distribution of sizes: paper (normal in whole um, sigma a sixth of the zone) or "
                  "uniform; see also --cp and --sizes")
      ->check(CLI::IsMember({"paper", "uniform"}))
      ->capture_default_str()
      ->group(group);
  fit->add_option("--cp", a->cp, "Process capability C_p of both sizes: normal, not truncated")
      ->check(Positive())
      ->group(group);
  fit->add_option("--cpk", a->cpk,
                  "Process capability C_pk, with a shift towards interference; default: C_p")
      ->check(Positive())
      ->group(group);
  fit->add_option("--sizes", a->sizes, "Table of measured diameters: hole_mm, shaft_mm (CSV)")
      ->group(group);
  fit->add_option("--stations", a->population.stations, "Number N of intervals of the roughness")
      ->check(CLI::Range(1, 256))
      ->capture_default_str()
      ->group(group);
  fit->add_option("--threads", a->population.threads,
                  "Number of threads; it does not change the results [all cores]")
      ->transform(Count(kMaxThreads))
      ->group(group);
}

void AddPlotArguments(CLI::App* fit, FitArguments* a) {
  const char* const group = "Plots";
  fit->add_option("--curve", a->curve,
                  "Write force over depth, pressing in and pulling out: .svg or .csv")
      ->group(group);
  fit->add_option("--along", a->along,
                  "Table of one pair's diameters along its length: depth_mm, hole_mm, shaft_mm "
                  "(CSV); the curve then shows this pair in place of a tight one")
      ->group(group);
  fit->add_option("--step", a->step_mm, "Step of the curve's depth [mm]; default: a 200th of it")
      ->check(Positive())
      ->group(group);
  fit->add_option("--jamming", a->jamming, "Write the jamming and wedging diagrams: .svg")
      ->group(group);
  fit->add_option(
         "--at", a->at_mm,
         "Depth l of the diagram, from the tip's corner to the rim [mm]; default: half the length")
      ->check(Positive())
      ->group(group);
  fit->add_option("--load", a->load,
                  "Load on the shaft at the centre of its tip: transverse and axial force [N], "
                  "moment [N mm]")
      ->delimiter(',')
      ->check(AnyNumber())
      ->expected(3)
      ->group(group);
}

void AddSizeArguments(CLI::App* fit, FitArguments* a) {
  fit->add_option("fit", a->fits,
                  "Diameter and classes: 40 H7/p6, 40 H7, 1.5in H7/g6, 1.5in RC4; several fits "
                  "belong to one pair of parts");
  const auto add_list = [fit](const char* name, std::vector<double>* list, const char* text) {
    return fit->add_option(name, *list, text)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->transform(Millimetres());
  };
  add_list("--length", &a->length_mm,
           "Length of the joint [mm], or with a unit: 2in; needed for the press fit. With several "
           "fits: one for each, separated by commas, or one for all; the same holds for --hub, "
           "--bore, --start")
      ->check(Positive());
  add_list("--hub", &a->hub_mm,
           "Outer diameter of the hub [mm]; default: twice the nominal diameter")
      ->check(Positive());
  add_list("--bore", &a->bore_mm, "Bore of a hollow shaft [mm]")->check(NotNegative());
  add_list("--start", &a->start_mm, "Depth of the shaft at which the fit begins to engage [mm]")
      ->check(NotNegative());
  fit->add_option(
         "--breadth", a->breadth_mm,
         "Breadth of flat walls across the way [mm]: the sizes are the widths of a slot and "
         "a tongue, and --hub that of the part with the slot, both walls included")
      ->check(Positive())
      ->transform(Millimetres());
  fit->add_option("--chamfer", a->chamfer_deg,
                  "Angle of the lead-in chamfer from the axis [deg]; default: a sharp edge")
      ->check(Positive());
  fit->add_option("--chamfer-width", a->chamfer_width_mm,
                  "Radial width of the chamfers of hole and shaft together [mm]")
      ->check(NotNegative())
      ->transform(Millimetres());
}

void AddMaterialArguments(CLI::App* fit, FitArguments* a) {
  fit->add_option("--material", a->material,
                  "Material of both parts [S355]; with values of your own behind the name or "
                  "alone: E=210 nu=0.3 Re=355 alpha=11 (GPa, MPa, 1e-6/K)");
  fit->add_option("--hub-material", a->hub_material, "Material of the hub");
  fit->add_option("--shaft-material", a->shaft_material, "Material of the shaft");
  fit->add_option("--mu", a->friction,
                  "Coefficient of friction; default: by the pair of materials (hvas fit friction), "
                  "the high value for pressing in and the low one for holding")
      ->check(NotNegative());
  fit->add_option(
         "--mu-out", a->friction_out,
         "Coefficient of friction for holding, against release and rotation; default: as for --mu")
      ->check(NotNegative());
  fit->add_flag("--oiled", a->is_oiled, "Use friction with mineral oil instead of dry friction");
  fit->add_flag("--shrunk", a->is_shrunk,
                "Use the friction of a joint by heat or cold instead of one pressed in; implied by "
                "--hub-temp and --shaft-temp");
}

void AddRoughnessArguments(CLI::App* fit, FitArguments* a) {
  fit->add_option("--rz", a->rz_um, "Roughness Rz of both surfaces [um]")
      ->check(NotNegative())
      ->capture_default_str();
  fit->add_option("--hub-rz", a->hub_rz_um, "Roughness Rz of the hub [um]")->check(NotNegative());
  fit->add_option("--shaft-rz", a->shaft_rz_um, "Roughness Rz of the shaft [um]")
      ->check(NotNegative());
  fit->add_option(
         "--smoothing", a->smoothing,
         "Loss of interference by smoothing: none, din2001 (0.8) or din2017 (0.4 of the sum of Rz)")
      ->check(CLI::IsMember({"none", "din2001", "din2017"}))
      ->capture_default_str();
}

void AddJoiningArguments(CLI::App* fit, FitArguments* a) {
  fit->add_option(
         "--hub-temp", a->hub_c,
         "Temperature of the hub when joining [C]; adds the play, and whether the joint sticks")
      ->check(Temperature());
  fit->add_option("--shaft-temp", a->shaft_c, "Temperature of the shaft when joining [C]")
      ->check(Temperature());
  fit->add_option("--room", a->room_c,
                  "Reference temperature of the sizes, and of parts not heated or cooled [C]")
      ->check(Temperature())
      ->capture_default_str();
  fit->add_option("--join-speed", a->join_speed_mm_s, "Speed of joining by heat or cold [mm/s]")
      ->check(Positive())
      ->capture_default_str();
}

/** An option that has an effect only with another one. */
struct Need {
  const char* option;
  std::vector<const char*> one_of;
};

const std::vector<Need>& ListNeeds() {
  static const std::vector<const char*> batch{"--population", "--curve"};
  static const std::vector<Need> needs{{"--hub", {"--length"}},
                                       {"--bore", {"--length"}},
                                       {"--breadth", {"--length"}},
                                       {"--material", {"--length"}},
                                       {"--hub-material", {"--length"}},
                                       {"--shaft-material", {"--length"}},
                                       {"--mu", {"--length"}},
                                       {"--mu-out", {"--length"}},
                                       {"--oiled", {"--length"}},
                                       {"--shrunk", {"--length"}},
                                       {"--rz", {"--length"}},
                                       {"--hub-rz", {"--length"}},
                                       {"--shaft-rz", {"--length"}},
                                       {"--smoothing", {"--length"}},
                                       {"--chamfer-width", {"--length"}},
                                       {"--population", {"--length"}},
                                       {"--curve", {"--length"}},
                                       {"--jamming", {"--length"}},
                                       {"--start", batch},
                                       {"--chamfer", {"--curve"}},
                                       {"--room", {"--length"}},
                                       {"--hub-temp", {"--length"}},
                                       {"--shaft-temp", {"--length"}},
                                       {"--hub-temp", {"--hub"}},
                                       {"--join-speed", {"--hub-temp", "--shaft-temp"}},
                                       {"--seed", batch},
                                       {"--press-limit", batch},
                                       {"--sizes-spread", batch},
                                       {"--cp", batch},
                                       {"--cpk", batch},
                                       {"--sizes", batch},
                                       {"--stations", batch},
                                       {"--threads", batch},
                                       {"--step", {"--curve"}},
                                       {"--along", {"--curve"}},
                                       {"--at", {"--jamming"}},
                                       {"--load", {"--jamming"}}};
  return needs;
}

/** Options that have no effect where all of others are given. */
const std::vector<std::pair<const char*, std::vector<const char*>>>& ListOverruled() {
  static const std::vector<std::pair<const char*, std::vector<const char*>>> overruled{
      {"--bore", {"--breadth"}},
      {"--hub-temp", {"--breadth"}},
      {"--shaft-temp", {"--breadth"}},
      {"--oiled", {"--mu"}},
      {"--shrunk", {"--mu"}},
      {"--material", {"--hub-material", "--shaft-material"}},
      {"--rz", {"--hub-rz", "--shaft-rz"}},
      {"--sizes-spread", {"--sizes"}},
      {"--sizes-spread", {"--cp"}},
      {"--sizes-spread", {"--cpk"}}};
  return overruled;
}

}  // namespace

void AddFitArguments(CLI::App* fit, FitArguments* a) {
  AddSizeArguments(fit, a);
  AddMaterialArguments(fit, a);
  AddRoughnessArguments(fit, a);
  AddJoiningArguments(fit, a);
  AddUnitOption(fit, &a->unit);
  AddJsonFlag(fit, &a->is_json, "fit");
  AddBatchArguments(fit, a);
  AddPlotArguments(fit, a);
}

Result<void> CheckEffects(const CLI::App& fit) {
  const auto has = [&fit](const char* name) { return fit.count(name) > 0; };
  for (const Need& need : ListNeeds()) {
    if (has(need.option) && std::none_of(need.one_of.begin(), need.one_of.end(), has)) {
      const std::string needed = fmt::format("{}", fmt::join(need.one_of, " or "));
      return Fail(ErrorCode::kInvalid,
                  fmt::format("{} has no effect without {}", need.option, needed), {},
                  fmt::format("give {}, or omit {}", needed, need.option));
    }
  }
  for (const auto& [option, others] : ListOverruled()) {
    if (has(option) && std::all_of(others.begin(), others.end(), has)) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("{} has no effect together with {}", option, fmt::join(others, " and ")), {},
          "omit one of them");
    }
  }
  return {};
}

Result<void> CheckEffects(const FitArguments& arguments, const std::vector<FitCard>& cards) {
  const auto any = [&cards](const auto& has) {
    return std::any_of(cards.begin(), cards.end(), has);
  };
  const auto fail = [](const char* what, const char* remedy) {
    return Fail(ErrorCode::kInvalid, what, {}, remedy);
  };
  if (!arguments.length_mm.empty() && !any([](const FitCard& c) { return c.limits.has_value(); })) {
    return fail("--length has no effect on one class alone",
                "give the classes of hole and shaft, as in \"40 H7/p6\"");
  }
  if ((arguments.hub_c || arguments.shaft_c) &&
      !any([](const FitCard& c) { return c.limits && c.limits->min_clearance < 0; })) {
    return fail("--hub-temp and --shaft-temp have no effect on a clearance fit",
                "omit them, or choose a fit with interference");
  }
  if (arguments.chamfer_width_mm > 0 &&
      !any([](const FitCard& c) { return c.limits && c.limits->max_clearance > 0; })) {
    return fail("--chamfer-width has no effect on an interference fit",
                "omit it; --chamfer is the lead-in angle");
  }
  return {};
}

Result<std::vector<FitCard>> MakeCards(const FitArguments& arguments) {
  if (Result<void> check = CheckLists(arguments); !check) {
    return Unexpected(check.error());
  }
  std::vector<FitCard> cards;
  for (std::size_t k = 0; k < arguments.fits.size(); ++k) {
    const Result<FitCardOptions> options = MakeOptions(arguments, k);
    if (!options) {
      return Unexpected(options.error());
    }
    Result<FitCard> card = MakeFitCard(*options);
    if (!card) {
      return Unexpected(card.error());
    }
    cards.push_back(*std::move(card));
  }
  return cards;
}

Result<FitPopulationOptions> MakePopulationOptions(const FitArguments& arguments) {
  FitPopulationOptions options = arguments.population;
  if (!arguments.sizes.empty() && (arguments.cp > 0 || arguments.cpk > 0)) {
    return Fail(ErrorCode::kInvalid, "sizes can be measured or follow a capability, but not both",
                {}, "omit --sizes, or --cp and --cpk");
  }
  if (!arguments.sizes.empty()) {
    if (Result<void> read = ReadSizes(arguments.sizes, &options); !read) {
      return Unexpected(read.error());
    }
  } else if (arguments.cp > 0 || arguments.cpk > 0) {
    options.spread = SizeSpread::kCapability;
    options.cp = arguments.cp > 0 ? arguments.cp : arguments.cpk;
    options.cpk = arguments.cpk > 0 ? arguments.cpk : arguments.cp;
  } else if (arguments.spread == "uniform") {
    options.spread = SizeSpread::kUniform;
  }
  if (!arguments.along.empty()) {
    if (arguments.fits.size() != 1) {
      return Fail(ErrorCode::kInvalid, "diameters along the length go with one fit only", {},
                  "give one fit, or omit --along");
    }
    if (Result<void> read = ReadDiametersAlong(arguments.along, &options); !read) {
      return Unexpected(read.error());
    }
  }
  options.depths = options.stations;
  return options;
}

fits::PegLoad MakeLoad(const FitArguments& arguments) {
  return {arguments.load[0], arguments.load[1], 1e-3 * arguments.load[2]};
}

}  // namespace hvas::app
