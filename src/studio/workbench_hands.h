#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/job_thread.h"
#include "base/result.h"
#include "simulation/table_subassembly.h"
#include "studio/event_bus.h"
#include "studio/hand_rack.h"
#include "studio/json.h"
#include "studio/live_scene.h"
#include "studio/scene_observer.h"

namespace hvas::studio {

/** What a hand takes. */
struct TakenParts {
  spatial::Pose X_WH;           ///< The hand moves there.
  sequence::SequenceStep step;  ///< What moves, and its way in.
  std::vector<simulation::TablePlace> table_places;
};

/** Makes the reply of docs/protocol.md. */
[[nodiscard]] Json ToJson(const TakenParts& taken);

/** Hands of the workbench: their number, their devices, and what they take. Any thread may call any
 function; all return at once, and leave slow work to the worker. */
class WorkbenchHands final : public SceneObserver {
 public:
  /** @param devices  Addresses of DeviceList. */
  WorkbenchHands(LiveScene* live, EventBus* events, JobThread* worker,
                 const std::vector<std::string>& devices)
      : live_(live), events_(events), worker_(worker), devices_(devices) {}

  /** Takes a part with a hand that follows the pointer, with all that it was put together with or
   alone. */
  [[nodiscard]] Result<TakenParts> Take(
      std::size_t hand, product::OccurrenceId id,
      simulation::TakeExtent extent = simulation::TakeExtent::kWhole);
  void Move(std::size_t hand, const spatial::Pose& X_WH, bool is_gripping);
  [[nodiscard]] Result<void> Release(std::size_t hand);
  /** Takes hold, with a hand, of what another one holds as well. Errors: as of HandOver, and
   kInvalid where a third hand has hold of it already. */
  [[nodiscard]] Result<TakenParts> Help(std::size_t hand, std::size_t other);
  /** Passes what a hand holds into another one. Errors: kInvalid where the first one holds nothing,
   the second one holds something, or either has a device, whose grip is its user's. */
  [[nodiscard]] Result<void> HandOver(std::size_t from, std::size_t to);

  /** Sets the number of hands: 1 to HandRack::kMaxHands. Reports by the event "hands". */
  [[nodiscard]] Result<void> SetCount(std::size_t count);

  /** Assigns a device of the DeviceList to a hand. Reports by the event "hands" or "failed".
   Errors: kNotFound for an index that the list does not have, the same for each. */
  [[nodiscard]] Result<void> UseDevice(std::size_t hand, std::size_t device, double scale);

  /** Searches for devices, on a thread of its own: a product is opened meanwhile. Reports by the
   event "devices". */
  void SearchDevices();

  /** Ends the search; does nothing when it is called again. */
  void Stop() { search_thread_.Stop(); }

  [[nodiscard]] const DeviceList& devices() const { return devices_; }

  /** Makes the field "devices" of docs/protocol.md. */
  [[nodiscard]] Json DescribeDevices() const { return device_search_.Describe(); }

  /** Makes the field "hands" of docs/protocol.md. */
  [[nodiscard]] Json Describe() const;

 private:
  void ConfigureRun(const OpenScene& scene, LiveOptions* live) override;
  void OnRunBegun() override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  /** Finds the run, for a command to a hand that follows the pointer. Errors: those of
   LiveScene::FindRunForHands; kInvalid for a hand that is missing or has a device. */
  [[nodiscard]] Result<std::shared_ptr<LiveRun>> FindRun(std::size_t hand) const;
  /** Finds the run, for what goes between two hands that follow pointers: `from` holds a part, `to`
   holds nothing. Errors: those of FindRun; kInvalid where it is otherwise. */
  [[nodiscard]] Result<std::shared_ptr<LiveRun>> FindPair(std::size_t from, std::size_t to) const;
  /** Checks whether the hands can be changed. Errors: those of LiveScene::CheckIdle, but none
   without a scene. */
  [[nodiscard]] Result<void> CheckChange() const;
  /** Begins another run with the present hands. */
  void Restart();
  void PublishHands() const;

  LiveScene* const live_;
  EventBus* const events_;
  JobThread* const worker_;
  const DeviceList devices_;
  HandRack rack_{&devices_};
  /** The rack has been changed, and the run with the devices before has not ended. */
  std::atomic<bool> is_changing_{false};
  DeviceSearch device_search_{&devices_};
  JobThread search_thread_;  ///< Last member, so that it ends before the others are destroyed.
};

}  // namespace hvas::studio
