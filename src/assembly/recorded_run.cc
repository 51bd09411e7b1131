#include "assembly/recorded_run.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "session/hand_names.h"
#include "session/session_recorder.h"
#include "simulation/flight_recorder.h"

namespace hvas::assembly {
namespace {

using simulation::Model;

Result<void> Check(const Model& model, const RunOptions& options) {
  constexpr double kSlowest = 1000;  // [Hz]: X4.
  constexpr double kFastest = 8000;  // [Hz]: a choice.
  if (options.devices.empty() || options.devices.size() > haptics::kMaxHands) {
    return Fail(ErrorCode::kInvalid, fmt::format("there are no {} hands", options.devices.size()),
                model.product->source, fmt::format("ask for 1 to {} hands", haptics::kMaxHands));
  }
  const double rate_hz = options.render.rate_hz;
  if (!(rate_hz >= kSlowest && rate_hz <= kFastest)) {
    return Fail(ErrorCode::kInvalid, fmt::format("the haptic loop cannot run at {} Hz", rate_hz),
                model.product->source, fmt::format("ask for {} to {} Hz", kSlowest, kFastest));
  }
  return {};
}

Result<std::unique_ptr<record::Recorder>> MakeRunRecorder(const Model& model,
                                                          const RunOptions& options,
                                                          const record::Meta& further) {
  static constexpr const char* kConditions[] = {"collision", "constraint", "hybrid"};
  record::RecorderOptions recorder;
  recorder.path = options.record;
  recorder.is_threaded = options.is_realtime;
  recorder.ring_ticks *= options.devices.size();
  recorder.replaces = options.is_record_replaced;
  recorder.on_error = options.on_record_error;
  record::Meta meta = further;
  meta["condition"] = kConditions[static_cast<std::size_t>(options.condition)];
  meta["force_map"] = haptics::ToString(options.force_map);
  const std::size_t hands = options.devices.size();
  for (std::size_t hand = 0; hand < std::max(session::kHandsOfMeta, hands); ++hand) {
    meta[session::MakeDeviceKey(hand)] = hand < hands ? options.devices[hand] : std::string();
  }
  if (options.person) {
    meta["person"] = person::ToString(*options.person);
  }
  return MakeRecorder(model, recorder, meta);
}

Result<std::vector<Hand>> MakeHands(const Model& model, const RunOptions& options) {
  std::vector<Hand> hands;
  for (const std::string& device : options.devices) {
    auto hand =
        MakeHand(model, {device, options.render, person::SeedOfHand(options.seed, hands.size()),
                         options.is_realtime, options.person});
    if (!hand) {
      return Unexpected(hand.error());
    }
    hand->tick.condition = options.condition;
    hand->tick.force_map = options.force_map;
    haptics::Apply(options.guidance, &hand->tick);
    hands.push_back(std::move(*hand));
  }
  return hands;
}

}  // namespace

Result<RunOutcome> RunRecorded(const Model& model, const RunOptions& options,
                               const record::Meta& further, const SetupMaker& make_setup) {
  if (const auto checked = Check(model, options); !checked) {
    return Unexpected(checked.error());
  }
  auto recorder = MakeRunRecorder(model, options, further);
  if (!recorder) {
    return Unexpected(recorder.error());
  }
  auto hands = MakeHands(model, options);
  if (!hands) {
    return Unexpected(hands.error());
  }
  session::SessionRecorder sink(recorder->get(), model);
  const std::unique_ptr<RunSetup> setup = make_setup(std::move(*hands), &sink);
  sink.Begin(&setup->simulation());
  simulation::PartRun& run = setup->part_run();
  run.on_part = options.on_part;
  RunOutcome outcome;
  outcome.hands = setup->hands().size();
  outcome.devices = DescribeDevices(setup->hands());
  if (options.on_begin) {
    options.on_begin(outcome.devices);
  }
  simulation::FlightRecorder flight(options.render.rate_hz, outcome.hands);
  simulation::Execution execution =
      setup->MakeExecution(options.limit_s > 0 ? options.limit_s : CalcTimeLimit(model));
  execution.flight = &flight;
  execution.on_frame = options.on_frame;
  execution.is_done = [&] { return run.is_done() || options.stop.stop_requested(); };
  outcome.execution =
      options.is_realtime ? simulation::RunRealtime(execution) : simulation::RunLockstep(execution);
  outcome.parts = run.results();
  if (const auto finished = (*recorder)->Finish(); !finished) {
    outcome.record_error = finished.error();
  }
  outcome.digest = (*recorder)->Digest();
  outcome.dropped_ticks = (*recorder)->dropped_ticks();
  return outcome;
}

}  // namespace hvas::assembly
