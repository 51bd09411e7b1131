#include "device/emulation/haply_server.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "device/drivers/websocket.h"

namespace hvas::device {
namespace {

using nlohmann::json;

// A force is let go after this time without a word, as in the drivers.
constexpr std::int64_t kWatchdogNs = 20'000'000;
constexpr const char* kDeviceId = "EMULATED";

enum class Edition { k35, k31 };

/** As the service: what is zero may be left out, and JSON has no way to write what is no number. */
json VectorJson(const Vec3& v) {
  json object = json::object();
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    if (v[k] != 0) {
      object[kAxes[k]] = std::isfinite(v[k]) ? json(v[k]) : json();
    }
  }
  return object;
}

json QuatJson(const Quat& q) {
  json object = VectorJson(q.vec());
  object["w"] = std::isfinite(q.w()) ? json(q.w()) : json();
  return object;
}

class HaplyServer final : public WireServer {
 public:
  HaplyServer(EmulatedDevice* device, std::unique_ptr<WebSocketServer> server, Edition edition)
      : device_(*device),
        server_(std::move(server)),
        edition_(edition),
        is_hidden_(edition == Edition::k31) {
    device_.SetCommandTimeout(kWatchdogNs);
  }

  [[nodiscard]] std::string address() const override {
    return fmt::format("haply:localhost:{}", server_->port());
  }

  void Serve() override {
    server_->Serve([this] { return StateText(); },
                   [this](const std::string& text) { return Answer(text); });
  }

  void Emit(std::int64_t) override {}  // the service never speaks by itself

 private:
  std::optional<std::string> Answer(const std::string& text) {
    const json message = ParseJson<json>(text);
    if (!message.is_object()) {
      return std::nullopt;
    }
    if (message.contains("session") && message["session"].contains("force_render_full_state")) {
      is_hidden_ = false;
    }
    const char* const key = edition_ == Edition::k35 ? "vector" : "values";
    const json::json_pointer force(fmt::format("/inverse3/0/commands/set_cursor_force/{}", key));
    if (message.contains(force) && message[force].is_object()) {
      const json& f = message[force];
      force_ = Vec3(f.value("x", 0.0), f.value("y", 0.0), f.value("z", 0.0));
      device_.Command({Vec3::Zero(), force_});
    }
    const bool is_stalled = device_.fault() == Fault::kStalled;
    return is_stalled ? std::nullopt : std::optional(StateText());
  }

  [[nodiscard]] std::string StateText() const {
    const EmulatedSample sample = device_.Sense();
    json document;
    document["hvas_emulator"] = true;
    if (edition_ == Edition::k35) {
      document["session"]["version"] = "3.5.0";
    }
    document["inverse3"] = json::array();
    document["wireless_verse_grip"] = json::array();
    if (sample.fault != Fault::kUnplugged && !is_hidden_) {
      document["inverse3"].push_back(DeviceJson(sample));
      document["wireless_verse_grip"].push_back(HandleJson(sample));
    }
    return document.dump();
  }

  [[nodiscard]] json DeviceJson(const EmulatedSample& sample) const {
    json device;
    device["device_id"] = kDeviceId;
    device["status"]["calibrated"] = sample.fault != Fault::kCalibrationLost;
    device["status"]["power_supply"] = sample.fault != Fault::kForceRefused && !sample.is_stopped;
    device["state"]["cursor_position"] = VectorJson(sample.X_DH.p());
    device["state"]["cursor_velocity"] = VectorJson(sample.V_DH.v);
    device["state"]["current_cursor_force"] = VectorJson(force_);
    return device;
  }

  static json HandleJson(const EmulatedSample& sample) {
    json handle;
    handle["device_id"] = "EMULATED-GRIP";
    handle["state"]["orientation"] = QuatJson(sample.X_DH.q());
    json& buttons = handle["state"]["buttons"];
    buttons["a"] = (sample.buttons & 1) != 0;
    buttons["b"] = (sample.buttons & 2) != 0;
    buttons["c"] = (sample.buttons & 4) != 0;
    return handle;
  }

  EmulatedDevice& device_;
  std::unique_ptr<WebSocketServer> server_;
  Edition edition_;
  bool is_hidden_;
  Vec3 force_{Vec3::Zero()};
};

Result<std::unique_ptr<WireServer>> Make(const WireSite& site, Edition edition) {
  auto server = WebSocketServer::Listen(0);
  if (!server) {
    return Unexpected(server.error());
  }
  return std::make_unique<HaplyServer>(site.device, std::move(*server), edition);
}

}  // namespace

Result<std::unique_ptr<WireServer>> MakeHaplyServer(const WireSite& site) {
  return Make(site, Edition::k35);
}

Result<std::unique_ptr<WireServer>> MakeOldHaplyServer(const WireSite& site) {
  return Make(site, Edition::k31);
}

}  // namespace hvas::device
