#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "record/recorder.h"
#include "session/session_recorder.h"
#include "studio/json.h"
#include "studio/open_scene.h"
#include "studio/record_parts.h"

namespace hvas::studio {

/** A recording in progress: one scene, through all live runs that follow one another. */
class Recording final : public simulation::Sink {
 public:
  /** @param file  File to write; its stem is the recording's id.
   @param scene_json  Response to GET /api/scene.
   @param on_failed  Called once, on another thread, when writing has failed for good.
   Errors: those of record::Recorder::Create. */
  static Result<std::shared_ptr<Recording>> Start(const std::filesystem::path& file,
                                                  const std::string& name,
                                                  std::shared_ptr<const OpenScene> scene,
                                                  const Json& scene_json,
                                                  std::function<void()> on_failed);

  /** Begins with a run. @pre its state is restored, and its loops do not run yet. */
  void Begin(simulation::Simulation* simulation);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** Adds a frame as clients get it. Called on the publish thread. */
  void AddFrame(const LiveFrame& frame);
  /** Adds an event as clients get it. Any thread but the haptic one may call it. */
  void AddClientEvent(const Json& event);

  /** Closes the file. A run may keep this as its sink; nothing is written any more.
   Errors: those of writing the file. */
  [[nodiscard]] Result<void> Stop();

  /** Whether writing has failed for good. */
  [[nodiscard]] bool has_failed() const { return recorder_->error().has_value(); }

  [[nodiscard]] const OpenScene* scene() const { return scene_.get(); }

  /** Makes the field "recording" of docs/protocol.md. */
  [[nodiscard]] Json Describe() const;

 private:
  Recording(std::unique_ptr<record::Recorder> recorder, std::shared_ptr<const OpenScene> scene,
            std::string id, std::string name);

  std::shared_ptr<const OpenScene> scene_;
  std::string id_;
  std::string name_;
  std::unique_ptr<record::Recorder> recorder_;
  session::SessionRecorder sink_;
  std::atomic<bool> is_on_{true};
  std::atomic<std::int64_t> start_ns_{0};  ///< Session time at which the present run began [ns].
  std::uint32_t frame_count_{0};           ///< Used by the publish thread only.
  ShownState shown_;                       ///< What the last frame has shown; publish thread only.
};

}  // namespace hvas::studio
