#include "app/assembly/run_report.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/devices/latency_json.h"
#include "app/output/text_layout.h"
#include "app/product/product_json.h"
#include "base/units.h"
#include "haptics/free_bodies.h"
#include "session/hand_names.h"
#include "simulation/shapes.h"

namespace hvas::app {
namespace {

using assembly::DeviceInHand;
using assembly::RunOutcome;
using simulation::ExecutionReport;
using simulation::Model;
using simulation::PartResult;

double ToS(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

/** Session time over the time that was taken for it. */
double Ratio(const ExecutionReport& report, std::int64_t taken_ns) {
  return taken_ns > 0 ? ToS(report.session_ns) / ToS(taken_ns) : 0.0;
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

nlohmann::ordered_json ToJson(const DeviceInHand& device) {
  return {{"address", device.address},
          {"model", device.model},
          {"profile", device.profile},
          {"emulated", device.is_emulated},
          {"notes", device.notes}};
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

void PrintContactLimits(const simulation::ContactLimits& limits) {
  if (limits.truncated_ticks > 0) {
    fmt::print("{}", Fold(fmt::format("incomplete contact: in {} ticks there were more points or "
                                      "contacts than a tick has room for (docs/limits.md)\n",
                                      limits.truncated_ticks)));
  }
  if (limits.crowded_ticks > 0) {
    fmt::print("{}", Fold(fmt::format("loose parts: in {} ticks one stood still, because {} moved "
                                      "already (docs/limits.md)\n",
                                      limits.crowded_ticks, haptics::FreeBodies::kMaxAwake)));
  }
}

/** Without those that came from the fixture. */
std::size_t CountSeatedBy(const RunOutcome& outcome, std::size_t hand) {
  return static_cast<std::size_t>(
      std::count_if(outcome.parts.begin(), outcome.parts.end(), [hand](const PartResult& part) {
        return part.is_seated && part.hand == hand && part.time > 0;
      }));
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

std::string NameOfHand(std::size_t hand) {
  return fmt::format("{} hand", session::OrdinalOfHand(hand));
}

const std::string& PathOf(const Model& model, product::OccurrenceId id) {
  static const std::string kNone = "empty hand";
  return id.is_valid() ? model.product->occurrences[id.index()].path : kNone;
}

nlohmann::ordered_json MakeAsideJson(const Model& model, const sequence::SequenceStep& aside) {
  const Vec3 way_W = Vec3::Zero() - aside.extraction_W;  // A zero has no sign for people.
  return {{"id", aside.occurrence.value()},
          {"name", PathOf(model, aside.occurrence)},
          {"direction", {way_W.x(), way_W.y(), way_W.z()}},
          {"distance_mm", units::ToMm(aside.engage_distance)},
          {"turns", !aside.way.empty()}};
}

nlohmann::ordered_json MakeHoldJson(const simulation::PartResult& part) {
  return {{"hand", part.hand},
          {"reason", part.reason},
          {"note", part.note},
          {"time_s", part.time},
          {"path_m", part.path},
          {"peak_true_n", part.peak_true},
          {"peak_felt_n", part.peak_felt},
          {"fit_true_n", part.fit_true},
          {"fit_felt_n", part.fit_felt},
          {"preload_n", part.preload},
          {"tightening_nm", part.tightening},
          {"deepest_um", units::ToUm(part.deepest)}};
}

nlohmann::ordered_json MakeRunJson(const Model& model, const SessionReport& report) {
  const RunOutcome& outcome = report.run;
  nlohmann::ordered_json json;
  const ExecutionReport& run = outcome.execution;
  json["product"] = model.product->name;
  json["source"] = model.product->source;
  if (!model.product->placement.drawn_poses.empty()) {
    json["diagnostics"] = DiagnosticsToJson(model.product->placement.diagnostics);
  }
  json["seed"] = report.seed;
  json["digest"] = outcome.digest;
  json["force_map"] = haptics::ToString(report.force_map);
  json["hands"] = outcome.hands;
  for (const DeviceInHand& device : outcome.devices) {
    json[session::MakeDeviceKey(device.hand)] = ToJson(device);
  }
  json["preparation_s"] = ToS(report.preparation_ns);
  json["contact_shapes_bytes"] = simulation::CalcShapeMemory(model).total();
  json["session_s"] = ToS(run.session_ns);
  json["wall_s"] = ToS(run.wall_ns);
  json["real_time_factor"] = Ratio(run, run.wall_ns);
  json["ticks"] = run.ticks;
  json["tick_us"] = MakeLatencyJson(run.compute);
  json["slowest_ticks"] = ToJson(model, run.slowest);
  json["truncated_ticks"] = run.contact_limits.truncated_ticks;
  json["crowded_ticks"] = run.contact_limits.crowded_ticks;
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
  return json;
}

void PrintJson(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void PrintRun(const Model& model, const SessionReport& report, const std::string& summary) {
  const RunOutcome& outcome = report.run;
  const ExecutionReport& run = outcome.execution;
  std::string text = fmt::format(
      "\n{}: {} after {:.1f} s of work; prepared in {:.1f} s (contact shapes: "
      "{:.1f} MB), computed in {:.1f} s ({:.1f} x real time",
      model.product->source, summary, ToS(run.session_ns), ToS(report.preparation_ns),
      1e-6 * static_cast<double>(simulation::CalcShapeMemory(model).total()), ToS(run.wall_ns),
      Ratio(run, run.wall_ns));
  if (!report.is_realtime) {
    text += fmt::format("; {:.1f} s of processor time, {:.1f} x", ToS(run.cpu_ns),
                        Ratio(run, run.cpu_ns));
  }
  fmt::print("{}", Fold(text + ")\n"));
  PrintTicks(model, run);
  PrintContactLimits(run.contact_limits);
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
