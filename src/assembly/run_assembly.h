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
#include "simulation/assembly_run.h"
#include "simulation/device_session.h"
#include "simulation/executors.h"
#include "simulation/model.h"

namespace hvas::assembly {

/** How a model is assembled, and who is told of it. */
struct RunOptions {
  /** Addresses of the devices, one for each hand, as device::OpenAnyDevice takes them; an empty one
   is a simulated person without a device. One hand or two. */
  std::vector<std::string> devices{std::string()};
  std::uint64_t seed{1};  ///< The simulated persons' seed.
  haptics::Condition condition{haptics::Condition::kHybrid};
  haptics::ForceMapKind force_map{haptics::ForceMapKind::kPublished};
  simulation::RenderOptions render;
  /** Three threads by the clock, as a real device needs them, instead of virtual time on the
   calling thread, in which the same options give the same digest. */
  bool is_realtime{false};
  double limit_s{0};               ///< Session time after which to stop [s]; 0: CalcTimeLimit().
  std::filesystem::path record;    ///< Empty: no file; the digest is made all the same.
  bool is_record_replaced{false};  ///< A finished record that is there.
  std::stop_token stop;            ///< Ends the run; the account is of what was done until then.

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

/** What came of a run. */
struct RunOutcome {
  /** Each part of the product, in the order of their turns; behind them those that had none, as the
   run was stopped before. */
  std::vector<simulation::PartResult> parts;
  simulation::ExecutionReport execution;
  std::size_t hands{1};
  std::vector<DeviceInHand> devices;
  std::string digest;              ///< The digest of all that was recorded, 32 hexadecimal digits.
  std::uint64_t dropped_ticks{0};  ///< That the record lacks; none in virtual time.
  std::optional<Error> record_error;  ///< Why the record was not written to its end.

  /** Every part is in its place. */
  [[nodiscard]] bool is_complete() const;
};

/** The session time after which a run is stopped as a whole where nobody says when: 120 s for each
 part, and more in proportion where parts are carried around a large product [s]. */
[[nodiscard]] double CalcTimeLimit(const simulation::Model& model);

/** Has a model assembled, part by part in its order: parts begin on the table, and each is taken
 up, brought to its place and put in by a simulated person, or by whoever holds the device. All of
 it is recorded, and faults are set aside with the second before them (simulation::FlightRecorder).
 Returns when every part had its turn, at the limit, or after a stop.
 Errors: kInvalid for other than one hand or two, a rate outside 1000 to 8000 Hz, or a device that
 does not exist; the drivers', where one is not there; those of record::Recorder::Create. A record
 that fails later is RunOutcome::record_error.
 @param model  As PrepareModel gives it. @pre model != nullptr. */
[[nodiscard]] Result<RunOutcome> RunAssembly(const std::shared_ptr<const simulation::Model>& model,
                                             const RunOptions& options);

}  // namespace hvas::assembly
