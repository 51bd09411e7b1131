#include "studio/recording.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "assembly/assembly_setup.h"
#include "product/names.h"
#include "studio/frames.h"

namespace hvas::studio {
namespace {

/** Events that a page needs to play the session. */
constexpr std::array<std::string_view, 9> kClientEvents{
    "taken", "state", "dropped", "placement", "step", "safety", "device", "demo", "notes"};

std::vector<std::byte> BytesOf(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

Recording::Recording(std::unique_ptr<record::Recorder> recorder,
                     std::shared_ptr<const OpenScene> scene, std::string id, std::string name)
    : scene_(std::move(scene)),
      id_(std::move(id)),
      name_(std::move(name)),
      recorder_(std::move(recorder)),
      sink_(recorder_.get(), *scene_->model) {}

Result<std::shared_ptr<Recording>> Recording::Start(const std::filesystem::path& file,
                                                    const std::string& name,
                                                    std::shared_ptr<const OpenScene> scene,
                                                    const Json& scene_json,
                                                    std::function<void()> on_failed) {
  record::RecorderOptions options;
  options.path = file;
  options.is_threaded = true;
  options.ring_ticks *= 2;  // Eight seconds of two hands, two of eight.
  options.on_error = [on_failed = std::move(on_failed)](const Error&) { on_failed(); };
  auto recorder = assembly::MakeRecorder(*scene->model, options,
                                         {{kNameMeta, name}, {kProductDigestMeta, scene->digest}});
  if (!recorder) {
    return Unexpected(recorder.error());
  }
  (*recorder)->AddAttachment({kSceneAttachment, BytesOf(scene_json.dump())});
  (*recorder)->AddAttachment({kGlbAttachment, BytesOf(*scene->glb)});
  return std::shared_ptr<Recording>(
      new Recording(std::move(*recorder), std::move(scene), file.stem().string(), name));
}

void Recording::Begin(simulation::Simulation* simulation) {
  start_ns_ = sink_.t_ns();
  sink_.Begin(simulation);
}

void Recording::OnTick(std::size_t hand, const device::DeviceState& device,
                       const haptics::TickOutput& out) noexcept {
  if (is_on_.load(std::memory_order_relaxed)) {
    sink_.OnTick(hand, device, out);
  }
}

void Recording::OnEvent(const simulation::SimulationEvent& event) {
  if (is_on_) {
    sink_.OnEvent(event);
  }
}

void Recording::OnFlight(const std::vector<simulation::FlightTick>& ticks) {
  if (is_on_) {
    sink_.OnFlight(ticks);
  }
}

void Recording::AddFrame(const LiveFrame& frame) {
  if (!is_on_) {
    return;
  }
  const std::int64_t t_ns = start_ns_ + frame.frame.t_ns;
  const std::string bytes = MakeFrames(frame, t_ns, ++frame_count_, &shown_);
  recorder_->AddFrame({t_ns, BytesOf(bytes)});
}

void Recording::AddClientEvent(const Json& event) {
  const std::string name = event.value("event", "");
  if (is_on_ &&
      std::find(kClientEvents.begin(), kClientEvents.end(), name) != kClientEvents.end()) {
    recorder_->AddEvent({sink_.t_ns(), kClientEventKind,
                         event.value("occurrence", record::kNoOccurrence), event.dump()});
  }
}

Result<void> Recording::Stop() {
  is_on_ = false;
  return recorder_->Finish();
}

Json Recording::Describe() const {
  return {{"on", is_on_.load()},
          {"id", id_},
          {"name", name_},
          {"t_s", 1e-9 * static_cast<double>(sink_.t_ns())}};
}

}  // namespace hvas::studio
