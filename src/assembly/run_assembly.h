#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "assembly/hand.h"
#include "base/result.h"
#include "haptics/options.h"
#include "haptics/paper_guidance.h"
#include "simulation/assembly_run.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** Options of a run, and its callbacks. */
struct RunOptions {
  /** Addresses of the devices, one for each of one to haptics::kMaxHands hands, in the form of
   device::OpenAnyDevice; an empty address is a simulated person without a device. */
  std::vector<std::string> devices{std::string()};
  std::uint64_t seed{1};  ///< The simulated persons' seed.
  haptics::Condition condition{haptics::Condition::kHybrid};
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
  haptics::PaperGuidance guidance;  ///< Replaces constants of guidance where it has a value.
  simulation::RenderOptions render;
  /** How simulated persons without a device work; none: guided hands move the parts. */
  std::optional<person::PersonKind> person;
  /** Three threads by the clock, as a real device needs them, instead of virtual time on the
   calling thread, in which the same options give the same digest. */
  bool is_realtime{false};
  double limit_s{0};               ///< Session time after which to stop [s]; 0: CalcTimeLimit().
  std::filesystem::path record;    ///< Empty: no file; the digest is made all the same.
  bool is_record_replaced{false};  ///< A finished record that is there.
  std::stop_token stop;            ///< Ends the run; its results are those until then.

  // Callbacks, all of which may be null.

  /** Called on the calling thread before the run begins, with what DescribeDevices gives. */
  std::function<void(const std::vector<DeviceInHand>&)> on_begin;
  /** Called on the calling thread, which runs the physics loop, after the turn of each part. */
  std::function<void(const simulation::AssemblyProgress&, const simulation::PartResult&)> on_part;
  /** Called on the publish thread with the poses of all parts in W; in real time only. */
  std::function<void(const simulation::Frame&)> on_frame;
  /** Called once when the record can be written no further, by any thread but the haptic one; the
   run goes on. Must not throw. */
  std::function<void(const Error&)> on_record_error;
};

/** Results of a run. */
struct RunOutcome {
  /** Results of all parts in the order of their turns, then those of parts that had no turn before
   the run was stopped. */
  std::vector<simulation::PartResult> parts;
  simulation::ExecutionReport execution;
  std::size_t hands{1};
  std::vector<DeviceInHand> devices;
  std::string digest;                 ///< Digest of the recorded data, 32 hexadecimal digits.
  std::uint64_t dropped_ticks{0};     ///< Ticks missing in the record; 0 in virtual time.
  std::optional<Error> record_error;  ///< Why the record was not written to its end.

  /** Every part is in its place. */
  [[nodiscard]] bool is_complete() const;
};

/** Calculates the default time limit of a run in session time [s]: 120 s for each part, and more in
 proportion where parts are carried around a large product. */
[[nodiscard]] double CalcTimeLimit(const simulation::Model& model);

/** Assembles a model part by part in its order: the parts start on the table, and a simulated
 person, or the user of a device, takes each one, brings it to its place and inserts it. The run is
 recorded, and ticks around a fault are recorded with the second before it
 (simulation::FlightRecorder). Returns when every part had its turn, at the limit, or after a stop.
 Errors: kInvalid for no hands or more than haptics::kMaxHands, a rate outside 1000 to 8000 Hz, or a
 device that does not exist; the drivers', where one is not there; those of
 record::Recorder::Create. A record that fails later is RunOutcome::record_error.
 @param model  As PrepareModel gives it. @pre model != nullptr. */
[[nodiscard]] Result<RunOutcome> RunAssembly(const std::shared_ptr<const simulation::Model>& model,
                                             const RunOptions& options);

}  // namespace hvas::assembly
