#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "record/recorder.h"
#include "session/session_recorder.h"
#include "studio/open_scene.h"

namespace hvas::studio {

/** What is added to a record for a page that plays it. */
inline constexpr const char* kSceneAttachment = "scene.json";
inline constexpr const char* kGlbAttachment = "model.glb";
inline constexpr const char* kToldKind = "told";  ///< Of an event: as viewers were told.
inline constexpr const char* kNameMeta = "name";  ///< What people call it.

/** A session of one scene that is being recorded, over the live runs that follow one another. */
class Recording final : public simulation::Sink {
 public:
  /** @param file  Its stem is the recording's id.
   @param scene_json  As GET /api/scene has it.
   @param on_failed  Called once, on another thread, when nothing can be written any more.
   Errors: those of record::Recorder::Create. */
  static Result<std::shared_ptr<Recording>> Start(const std::filesystem::path& file,
                                                  const std::string& name,
                                                  std::shared_ptr<const OpenScene> scene,
                                                  const nlohmann::ordered_json& scene_json,
                                                  std::function<void()> on_failed);

  /** A run begins: before its loops do, and after it was restored. */
  void Begin(simulation::Simulation* simulation);

  void OnTick(std::size_t hand, const device::DeviceState& device,
              const haptics::TickOutput& out) noexcept override;
  void OnEvent(const simulation::SimulationEvent& event) override;
  void OnFlight(const std::vector<simulation::FlightTick>& ticks) override;

  /** What viewers are shown; publish thread. */
  void AddFrame(const LiveFrame& frame);
  /** What viewers are told; any thread but the haptic one. */
  void AddTold(const nlohmann::ordered_json& event);

  /** Ends the file. A run may go on with this as its sink; nothing is written any more.
   Errors: what the disk has said. */
  [[nodiscard]] Result<void> Stop();

  /** Whether nothing can be written any more. */
  [[nodiscard]] bool has_failed() const { return recorder_->error().has_value(); }

  [[nodiscard]] const OpenScene* scene() const { return scene_.get(); }

  /** "recording" of docs/protocol.md. */
  [[nodiscard]] nlohmann::ordered_json Describe() const;

 private:
  Recording(std::unique_ptr<record::Recorder> recorder, std::shared_ptr<const OpenScene> scene,
            std::string id, std::string name);

  std::shared_ptr<const OpenScene> scene_;
  std::string id_;
  std::string name_;
  std::unique_ptr<record::Recorder> recorder_;
  session::SessionRecorder sink_;
  std::atomic<bool> is_on_{true};
  std::atomic<std::int64_t> start_ns_{0};  ///< Session time at which the run of now began.
  std::uint32_t frame_count_{0};           ///< The publish thread's own.
  std::vector<spatial::Pose> shown_;       ///< Likewise.
};

}  // namespace hvas::studio
