#include "app/assembly/assemble_report.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/devices/latency_json.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "base/units.h"
#include "simulation/shapes.h"

namespace hvas::app {
namespace {

using assembly::DeviceInHand;
using assembly::RunOutcome;
using simulation::ExecutionReport;
using simulation::Model;
using simulation::PartResult;

double ToUs(std::int64_t time_ns) {
  return 1e-3 * static_cast<double>(time_ns);
}

double ToS(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

/** Session time over the time that was taken for it. */
double Ratio(const ExecutionReport& report, std::int64_t taken_ns) {
  return taken_ns > 0 ? ToS(report.session_ns) / ToS(taken_ns) : 0.0;
}

std::size_t CountSeated(const RunOutcome& outcome) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(),
                    [](const PartResult& part) { return part.is_seated; }));
}

/** Without those that came from the fixture. */
std::size_t CountSeatedBy(const RunOutcome& outcome, std::size_t hand) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(), [hand](const PartResult& part) {
        return part.is_seated && part.hand == hand && part.time > 0;
      }));
}

const std::string& PathOf(const Model& model, product::OccurrenceId id) {
  static const std::string kNone = "empty hand";
  return id.is_valid() ? model.product->occurrences[id.index()].path : kNone;
}

nlohmann::ordered_json ToJson(const Model& model, const simulation::SlowTicks& slowest) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const simulation::SlowTick& tick : slowest) {
    json.push_back({{"time_s", ToS(tick.t_ns)},
                    {"compute_us", ToUs(tick.compute_ns)},
                    {"part", PathOf(model, tick.occurrence)},
                    {"state", haptics::ToString(tick.state)},
                    {"points_tested", tick.points_tested},
                    {"contacts", tick.contact_count}});
  }
  return json;
}

nlohmann::ordered_json ToJson(const Model& model, const PartResult& part) {
  return {{"id", part.occurrence.value()},
          {"name", PathOf(model, part.occurrence)},
          {"seated", part.is_seated},
          {"hand", part.hand},
          {"reason", part.reason},
          {"note", part.note},
          {"time_s", part.time},
          {"path_m", part.path},
          {"peak_true_n", part.peak_true},
          {"peak_felt_n", part.peak_felt},
          {"fit_true_n", part.fit_true},
          {"fit_felt_n", part.fit_felt},
          {"deepest_um", units::ToUm(part.deepest)},
          {"insertion_mm", units::ToMm(part.insertion)},
          {"mates", part.mates},
          {"arrival_um", units::ToUm(part.arrival)},
          {"arrival_urad", 1e6 * part.arrival_angle},
          {"pose_error_um", units::ToUm(part.pose_error)},
          {"pose_error_urad", 1e6 * part.pose_error_angle}};
}

nlohmann::ordered_json ToJson(const DeviceInHand& device) {
  return {{"address", device.address},
          {"model", device.model},
          {"profile", device.profile},
          {"emulated", device.is_emulated},
          {"notes", device.notes}};
}

/** A residual below what a double resolves of a product's size is not a measurement. */
std::string DescribeResidual(double residual_um) {
  // A double resolves 1e-16 of a product's size: 1e-10 um of a metre, with the resolver's
  // iterations beside it.
  constexpr double kResolved_um = 1e-6;
  return residual_um < kResolved_um ? "< 1e-6" : fmt::format("{:.1e}", residual_um);
}

void PrintParts(const Model& model, const RunOutcome& outcome) {
  TextTable table({"  #", "part", "time\ns", "path\nm", "true\nN", "felt\nN", "mates",
                   "arrival\num", "tilt\nmrad", "residual\num"},
                  2);
  for (std::size_t i = 0; i < outcome.parts.size(); ++i) {
    const PartResult& part = outcome.parts[i];
    const std::string number = fmt::format("{:>3}", i + 1);
    const std::string name = PathOf(model, part.occurrence);
    if (!part.is_seated) {
      table.Add({number, name}, "NOT IN PLACE: " + part.reason);
      continue;
    }
    table.Add({number, name, fmt::format("{:.2f}", part.time), fmt::format("{:.3f}", part.path),
               fmt::format("{:.2f}", part.peak_true), fmt::format("{:.2f}", part.peak_felt),
               fmt::format("{}", part.mates), fmt::format("{:.1f}", units::ToUm(part.arrival)),
               fmt::format("{:.2f}", 1e3 * part.arrival_angle),
               DescribeResidual(units::ToUm(part.pose_error))},
              part.time == 0 ? "in the fixture" : part.note);
  }
  fmt::print("{}{}", table.ToText(),
             Fold("arrival, tilt: from the place to which the hand brought a part, before it was "
                  "moved exactly there; residual: from there to the file's pose, by the resolution "
                  "of the mates\n"));
}

void PrintTicks(const Model& model, const ExecutionReport& run) {
  std::string text = fmt::format(
      "tick compute: median {:.1f}, p99 {:.1f}, p99.9 {:.1f}, max {:.1f} us ({} ticks, {})\n",
      ToUs(run.compute.Quantile(0.5)), ToUs(run.compute.Quantile(0.99)),
      ToUs(run.compute.Quantile(0.999)), ToUs(run.compute.max_ns()), run.ticks, run.scheduling);
  if (run.slowest.begin() != run.slowest.end()) {
    const simulation::SlowTick& slowest = *run.slowest.begin();
    text += fmt::format("slowest tick: at {:.3f} s, {} with {}; {} points tested, {} contacts\n",
                        ToS(slowest.t_ns), haptics::ToString(slowest.state),
                        PathOf(model, slowest.occurrence), slowest.points_tested,
                        slowest.contact_count);
  }
  fmt::print("{}", Fold(text));
}

void PrintDevices(const RunOutcome& outcome) {
  for (const DeviceInHand& device : outcome.devices) {
    std::string text =
        fmt::format("in the {}: {}{} ({})", outcome.hands == 1 ? "hand" : NameOfHand(device.hand),
                    device.is_emulated ? "EMULATED " : "", device.model, device.address);
    if (outcome.hands > 1) {
      text += fmt::format("; parts put in place: {}", CountSeatedBy(outcome, device.hand));
    }
    fmt::print("{}", Fold(text));
  }
}

}  // namespace

const char* NameOfHand(std::size_t hand) {
  return hand == 0 ? "first hand" : "second hand";
}

void PrintAssemblyJson(const Model& model, const AssemblyReport& report) {
  const RunOutcome& outcome = report.run;
  nlohmann::ordered_json json;
  const ExecutionReport& run = outcome.execution;
  json["product"] = model.product->name;
  json["source"] = model.product->source;
  json["seed"] = report.seed;
  json["digest"] = outcome.digest;
  json["force_map"] = haptics::ToString(report.force_map);
  json["hands"] = outcome.hands;
  constexpr const char* kKeys[] = {"device", "second_device"};
  for (const DeviceInHand& device : outcome.devices) {
    json[kKeys[device.hand]] = ToJson(device);
  }
  json["preparation_s"] = ToS(report.preparation_ns);
  json["contact_shapes_bytes"] = simulation::CalcShapeMemory(model).total();
  json["session_s"] = ToS(run.session_ns);
  json["wall_s"] = ToS(run.wall_ns);
  json["real_time_factor"] = Ratio(run, run.wall_ns);
  json["ticks"] = run.ticks;
  json["tick_us"] = MakeLatencyJson(run.compute);
  json["slowest_ticks"] = ToJson(model, run.slowest);
  json["scheduling"] = run.scheduling;
  if (report.is_realtime) {
    json["ticks_per_s"] = static_cast<double>(run.ticks) / ToS(run.wall_ns);
    json["wake_up_us"] = MakeLatencyJson(run.wake_up);
    json["late_wake_ups"] = run.late_wake_ups;
    json["overruns"] = run.overruns;
    json["dropped_ticks"] = outcome.dropped_ticks;
    json["lost_events"] = run.lost_events;
  } else {
    json["cpu_s"] = ToS(run.cpu_ns);
    json["cpu_real_time_factor"] = Ratio(run, run.cpu_ns);
  }
  json["seated"] = CountSeated(outcome);
  json["parts"] = nlohmann::ordered_json::array();
  for (const PartResult& part : outcome.parts) {
    json["parts"].push_back(ToJson(model, part));
  }
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintAssemblyTable(const Model& model, const AssemblyReport& report) {
  const RunOutcome& outcome = report.run;
  PrintParts(model, outcome);
  const ExecutionReport& run = outcome.execution;
  std::string text = fmt::format(
      "\n{}: {} of {} parts in place after {:.1f} s of work; prepared in {:.1f} s (contact shapes: "
      "{:.1f} MB), computed in {:.1f} s ({:.1f} x real time",
      model.product->source, CountSeated(outcome), outcome.parts.size(), ToS(run.session_ns),
      ToS(report.preparation_ns),
      1e-6 * static_cast<double>(simulation::CalcShapeMemory(model).total()), ToS(run.wall_ns),
      Ratio(run, run.wall_ns));
  if (!report.is_realtime) {
    text += fmt::format("; {:.1f} s of processor time, {:.1f} x", ToS(run.cpu_ns),
                        Ratio(run, run.cpu_ns));
  }
  fmt::print("{}", Fold(text + ")\n"));
  PrintTicks(model, run);
  if (report.is_realtime) {
    fmt::print(
        "{}",
        Fold(fmt::format(
            "realtime: {:.1f} ticks per second; wake-up median {:.1f}, p99 {:.1f}, max {:.1f} "
            "us; {} late wake-ups, {} overruns, {} ticks not recorded, {} events lost\n",
            static_cast<double>(run.ticks) / ToS(run.wall_ns), ToUs(run.wake_up.Quantile(0.5)),
            ToUs(run.wake_up.Quantile(0.99)), ToUs(run.wake_up.max_ns()), run.late_wake_ups,
            run.overruns, outcome.dropped_ticks, run.lost_events)));
  }
  PrintDevices(outcome);
  fmt::print("digest {}\n", outcome.digest);
}

}  // namespace hvas::app
