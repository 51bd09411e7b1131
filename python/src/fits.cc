#include <algorithm>

#include "arguments.h"

namespace hvas::python {
namespace {

constexpr int kStations = 20;  // Along the land, as fits::PopulationLand has it.

const char* NameOf(fits::FitKind kind) {
  return kind == fits::FitKind::kClearance    ? "clearance"
         : kind == fits::FitKind::kTransition ? "transition"
                                              : "interference";
}

py::object CalcLimits(const std::string& code, const py::object& diameter_object) {
  const double diameter = ToNumber("diameter", diameter_object, kLength);
  const fits::FitLimits limits = Take(fits::CalcFitLimits(Take(fits::ParseFit(code)), diameter));
  return MakeDataclass(
      "FitLimits",
      py::dict(
          py::arg("code") = code, py::arg("nominal") = diameter,
          py::arg("kind") = NameOf(limits.kind),
          py::arg("hole") = py::make_tuple(limits.hole.lower + 0.0, limits.hole.upper + 0.0),
          py::arg("shaft") = py::make_tuple(limits.shaft.lower + 0.0, limits.shaft.upper + 0.0),
          py::arg("min_clearance") = limits.min_clearance,
          py::arg("max_clearance") = limits.max_clearance));
}

fits::PressFitParameters MakePress(double diameter, const py::object& length, double interference,
                                   const py::object& hub, double shaft_bore,
                                   const py::object& friction_object) {
  const double hub_diameter = ToNumber("hub_diameter", hub, kLengthOrNone);
  const double friction = ToNumber("friction", friction_object, kFriction);
  fits::PressFitParameters parameters;
  parameters.joint_diameter = diameter;
  parameters.length = ToNumber("length", length, kLength);
  parameters.interference = interference;
  parameters.hub_diameter = hub_diameter > 0 ? hub_diameter : 2 * diameter;
  parameters.shaft_bore = shaft_bore;
  parameters.friction_in = friction;
  parameters.friction_release = friction;
  parameters.friction_torque = friction;
  return parameters;
}

py::object CalcPress(const py::object& diameter, const py::object& length,
                     const py::object& interference, const py::object& hub_diameter,
                     const py::object& shaft_bore, const py::object& friction) {
  const fits::PressFit fit = Take(fits::CalcPressFit(
      MakePress(ToNumber("diameter", diameter, kLength), length,
                ToNumber("interference", interference, kLengthOrNone), hub_diameter,
                ToNumber("shaft_bore", shaft_bore, kLengthOrNone), friction)));
  return MakeDataclass(
      "PressFit",
      py::dict(py::arg("pressure") = fit.pressure, py::arg("press_in_force") = fit.press_in_force,
               py::arg("push_out_force") = fit.push_out_force, py::arg("torque") = fit.torque,
               py::arg("hub_expansion") = fit.hub_expansion,
               py::arg("shaft_contraction") = fit.shaft_contraction));
}

py::object CalcPopulation(const std::string& code, const py::object& diameter_object,
                          const py::object& length, const py::object& count, const py::object& seed,
                          const py::object& hub_diameter, const py::object& friction,
                          const py::object& threads) {
  constexpr std::int64_t kMostAssemblies = 100'000'000;  // As `hvas fit --population` has it.
  constexpr std::int64_t kMostThreads = 256;             // As `hvas fit --threads` has it.
  const double diameter = ToNumber("diameter", diameter_object, kLength);
  const fits::FitLimits limits = Take(fits::CalcFitLimits(Take(fits::ParseFit(code)), diameter));
  fits::PopulationParameters parameters;
  parameters.lands.push_back({fits::SizeDistribution::FromZone(limits.hole),
                              fits::SizeDistribution::FromZone(limits.shaft), 0, kStations,
                              MakePress(diameter, length, 0, hub_diameter, 0, friction)});
  parameters.count = ToInteger("count", count, 1, kMostAssemblies);
  parameters.seed = ToSeed("seed", seed);
  parameters.threads = static_cast<int>(ToInteger("threads", threads, 1, kMostThreads));
  auto drawn = [&] {
    const py::gil_scoped_release unlocked;
    return fits::CalcPopulation(parameters);
  }();
  const fits::Population population = Take(std::move(drawn));
  const std::size_t rows = population.bands.size();
  const std::size_t columns = fits::kBandShares.size();
  py::array_t<double> depth(static_cast<py::ssize_t>(rows));
  py::array_t<double> mean(static_cast<py::ssize_t>(rows));
  py::array_t<double> quantiles({rows, columns});
  for (std::size_t i = 0; i < rows; ++i) {
    const auto at = static_cast<py::ssize_t>(i);
    depth.mutable_at(at) = population.bands[i].depth;
    mean.mutable_at(at) = population.bands[i].mean;
    for (std::size_t j = 0; j < columns; ++j) {
      quantiles.mutable_at(at, static_cast<py::ssize_t>(j)) = population.bands[i].quantiles[j];
    }
  }
  const fits::LandStatistics& statistics = population.lands.front();
  return MakeDataclass("Population",
                       py::dict(py::arg("count") = population.count,
                                py::arg("mean_clearance") = statistics.mean_clearance,
                                py::arg("sigma_clearance") = statistics.sigma_clearance,
                                py::arg("interference_share") = statistics.interference_share,
                                py::arg("shares") = py::array_t<double>(
                                    static_cast<py::ssize_t>(columns), fits::kBandShares.data()),
                                py::arg("depth") = depth, py::arg("mean_force") = mean,
                                py::arg("force_quantiles") = quantiles));
}

}  // namespace

void DefineFits(py::module_* module) {
  module->def("fit_limits", &CalcLimits, py::arg("code"), py::arg("diameter"));
  module->def("press_fit", &CalcPress, py::arg("diameter"), py::arg("length"),
              py::arg("interference"), py::arg("hub_diameter") = 0.0, py::arg("shaft_bore") = 0.0,
              py::arg("friction") = 0.15);
  module->def("population", &CalcPopulation, py::arg("code"), py::arg("diameter"),
              py::arg("length"), py::arg("count") = 100'000, py::arg("seed") = 0,
              py::arg("hub_diameter") = 0.0, py::arg("friction") = 0.15, py::arg("threads") = 1);
}

}  // namespace hvas::python
