#include "device/drivers/haply_messages.h"

#include <array>
#include <cstdlib>
#include <limits>

#include <nlohmann/json.hpp>

#include "base/parse_json.h"

namespace hvas::device::haply {
namespace {

using nlohmann::json;

const json& Member(const json& object, const char* key) {
  static const json none;
  if (!object.is_object()) {
    return none;
  }
  const auto found = object.find(key);
  return found != object.end() ? *found : none;
}

double Number(const json& object, const char* key, double otherwise) {
  if (!object.is_object() || !object.contains(key)) {
    return otherwise;
  }
  const json& value = object[key];
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

Vec3 Vector(const json& object) {
  return {Number(object, "x", 0), Number(object, "y", 0), Number(object, "z", 0)};
}

bool Flag(const json& object, const char* key, bool otherwise) {
  const json& value = Member(object, key);
  return value.is_boolean() ? value.get<bool>() : otherwise;
}

std::string Text(const json& object, const char* key) {
  const json& value = Member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/** The entry of a list with an id, or its first one; none where there is none. */
const json& Entry(const json& list, const std::string& device_id) {
  static const json none;
  if (!list.is_array()) {
    return none;
  }
  for (const json& entry : list) {
    if (entry.is_object() && (device_id.empty() || Text(entry, "device_id") == device_id)) {
      return entry;
    }
  }
  return none;
}

void ReadDevice(const json& entry, Message* message) {
  const json& state = Member(entry, "state");
  const json& status = Member(entry, "status");
  message->has_device = true;
  message->device_id = Text(entry, "device_id");
  message->p = Vector(Member(state, "cursor_position"));
  message->v = Vector(Member(state, "cursor_velocity"));
  if (state.is_object() && state.contains("current_cursor_force")) {
    message->force = Vector(state["current_cursor_force"]);
  }
  message->is_calibrated = Flag(status, "calibrated", true);
  message->has_power = Flag(status, "power_supply", true);
}

void ReadHandle(const json& entry, Message* message) {
  const json& state = Member(entry, "state");
  const json& q = Member(state, "orientation");
  const json& buttons = Member(state, "buttons");
  message->has_handle = true;
  // A quaternion that is left out is the identity; one without a w has turned by half a turn.
  const double w = q.is_object() && !q.empty() && !q.contains("w") ? 0 : Number(q, "w", 1);
  message->q = Quat(w, Number(q, "x", 0), Number(q, "y", 0), Number(q, "z", 0));
  constexpr std::array kButtons{"a", "b", "c"};
  for (std::size_t i = 0; i < kButtons.size(); ++i) {
    message->buttons |= Flag(buttons, kButtons[i], false) ? 1U << i : 0U;
  }
}

}  // namespace

std::optional<Dialect> DialectOf(std::string_view version) {
  const std::string text(version);
  char* end = nullptr;
  const long major = std::strtol(text.c_str(), &end, 10);
  if (end == text.c_str() || *end != '.') {
    return std::nullopt;
  }
  const char* const rest = end + 1;
  const long minor = std::strtol(rest, &end, 10);
  if (end == rest) {
    return std::nullopt;
  }
  return major > 3 || (major == 3 && minor >= 5) ? Dialect::kVector : Dialect::kValues;
}

Message ParseMessage(std::string_view text, const std::string& device_id) {
  Message message;
  const json document = ParseJson<json>(text);
  if (!document.is_object()) {
    return message;
  }
  message.is_readable = true;
  message.version = Text(document, "version");
  if (message.version.empty()) {
    message.version = Text(Member(document, "session"), "version");
  }
  message.is_emulated = Flag(document, "hvas_emulator", false);
  const json& device = Entry(Member(document, "inverse3"), device_id);
  if (device.is_object()) {
    ReadDevice(device, &message);
  }
  const json& handle = Entry(Member(document, "wireless_verse_grip"), "");
  if (handle.is_object()) {
    ReadHandle(handle, &message);
  }
  return message;
}

std::string ForceMessage(Dialect dialect, const std::string& device_id, const Vec3& force,
                         bool is_first) {
  const char* const key = dialect == Dialect::kVector ? "vector" : "values";
  json message;
  if (is_first) {
    message["session"]["configure"]["profile"]["name"] = "org.hvas:assembly";
  }
  json device;
  device["device_id"] = device_id;
  device["commands"]["set_cursor_force"][key] = {
      {"x", force.x()}, {"y", force.y()}, {"z", force.z()}};
  message["inverse3"] = json::array({device});
  return message.dump();
}

std::string FullStateMessage() {
  return R"({"session":{"force_render_full_state":{}}})";
}

}  // namespace hvas::device::haply
