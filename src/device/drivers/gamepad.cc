// Gamepads and joysticks of the kernel's evdev interface (docs/devices/gamepad.md).
#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/drivers/evdev_node.h"
#include "device/drivers/polled_guard.h"
#include "device/drivers/rate_control.h"
#include "device/drivers/reopener.h"
#include "device/drivers/wire_drivers.h"

namespace hvas::device {
namespace {

constexpr const char* kName = "gamepad";
// Axes and keys as linux/input-event-codes.h numbers them. Rumble is sent at most 20 times a
// second: a choice, not measured.
constexpr std::size_t kAxisCount = ABS_HAT0Y + 1;
constexpr std::size_t kKeyBits = KEY_CNT;
constexpr std::int64_t kRumblePeriodNs = 50'000'000;
constexpr std::uint16_t kRumbleLength_ms = 200;  // it ends by itself when the haptic thread does
constexpr double kFullRumble = 5;                // [N]

template <std::size_t kBits>
using Bits = std::array<unsigned char, kBits / 8 + 1>;

template <std::size_t kBits>
bool Has(const Bits<kBits>& bits, std::size_t bit) {
  return ((bits[bit / 8] >> (bit % 8)) & 1) != 0;
}

/** What a node says about itself. */
struct Ability {
  std::string name;
  std::string serial;
  bool is_gamepad{false};  ///< Else a joystick.
  bool is_usable{false};
  std::uint16_t effect{0};  ///< FF_RUMBLE, FF_CONSTANT or none.
  bool has_gain{false};
  int button_count{0};
  std::array<input_absinfo, kAxisCount> axes{};
  std::bitset<kAxisCount> has_axis;
};

std::string AskText(const EvdevNode& node, unsigned long request) {
  std::array<char, 128> text{};
  return node.Call(request, text.data()) >= 0 ? std::string(text.data()) : std::string();
}

Ability AskAbility(const EvdevNode& node) {
  Ability ability;
  Bits<kKeyBits> keys{};
  Bits<ABS_CNT> axes{};
  Bits<FF_CNT> effects{};
  node.Call(EVIOCGBIT(EV_KEY, keys.size()), keys.data());
  node.Call(EVIOCGBIT(EV_ABS, axes.size()), axes.data());
  node.Call(EVIOCGBIT(EV_FF, effects.size()), effects.data());
  for (std::size_t i = 0; i < kAxisCount; ++i) {
    ability.has_axis[i] = Has<ABS_CNT>(axes, i) &&
                          node.Call(EVIOCGABS(static_cast<unsigned>(i)), &ability.axes[i]) >= 0 &&
                          ability.axes[i].maximum > ability.axes[i].minimum;
  }
  ability.is_gamepad = Has<kKeyBits>(keys, BTN_GAMEPAD);
  ability.is_usable = (ability.is_gamepad || Has<kKeyBits>(keys, BTN_JOYSTICK)) &&
                      ability.has_axis[ABS_X] && ability.has_axis[ABS_Y];
  ability.effect = Has<FF_CNT>(effects, FF_RUMBLE)     ? FF_RUMBLE
                   : Has<FF_CNT>(effects, FF_CONSTANT) ? FF_CONSTANT
                                                       : std::uint16_t{0};
  ability.has_gain = Has<FF_CNT>(effects, FF_GAIN);
  const std::size_t first = ability.is_gamepad ? BTN_GAMEPAD : BTN_JOYSTICK;
  for (std::size_t i = 0; i < 16; ++i) {
    ability.button_count += Has<kKeyBits>(keys, first + i) ? 1 : 0;
  }
  ability.name = AskText(node, EVIOCGNAME(128));
  ability.serial = AskText(node, EVIOCGUNIQ(128));
  return ability;
}

/** Where sticks and buttons are. RT-safe. */
class Controls {
 public:
  void Start(const Ability& ability) {
    is_gamepad_ = ability.is_gamepad;
    has_axis_ = ability.has_axis;
    axes_ = ability.axes;
    keys_.reset();
    is_implausible_ = false;
  }

  void Take(const input_event& event) noexcept {
    if (event.type == EV_ABS && event.code < kAxisCount) {
      input_absinfo& axis = axes_[event.code];
      const std::int64_t range = std::int64_t{axis.maximum} - axis.minimum;
      is_implausible_ = event.value > axis.maximum + range || event.value < axis.minimum - range;
      axis.value = is_implausible_ ? axis.value : event.value;
    } else if (event.type == EV_KEY && event.code < kKeyBits) {
      keys_[event.code] = event.value != 0;
    }
  }

  void SetAxis(std::size_t code, std::int32_t value) noexcept { axes_[code].value = value; }

  void SetKeys(const Bits<kKeyBits>& keys) noexcept {
    for (std::size_t i = 0; i < kKeyBits; ++i) {
      keys_[i] = Has<kKeyBits>(keys, i);
    }
  }

  [[nodiscard]] bool has_axis(std::size_t code) const noexcept { return has_axis_[code]; }

  [[nodiscard]] bool is_implausible() const noexcept { return is_implausible_; }

  [[nodiscard]] Deflection deflection() const noexcept {
    constexpr double kFine = 0.3;  // of the d-pad
    constexpr double kRoll = 0.5;  // of a shoulder button
    Deflection d;
    if (is_gamepad_) {
      d.move = Vec3(Centred(ABS_X), -Centred(ABS_Y), Trigger(ABS_RZ) - Trigger(ABS_Z)) +
               kFine * Vec3(Centred(ABS_HAT0X), -Centred(ABS_HAT0Y), 0);
      d.turn = {Centred(ABS_RY), kRoll * (Key(BTN_TR) - Key(BTN_TL)), -Centred(ABS_RX)};
    } else {
      d.move = {Centred(ABS_X), -Centred(ABS_Y), -Centred(ABS_HAT0Y)};
      d.turn = {0, Centred(ABS_HAT0X), -Centred(ABS_RZ)};
    }
    return d;
  }

  [[nodiscard]] std::uint32_t buttons() const noexcept {
    const std::size_t first = is_gamepad_ ? BTN_GAMEPAD : BTN_JOYSTICK;
    // South, east, north, west of a gamepad; trigger, thumb and two more of a joystick; select,
    // start.
    const std::array codes{
        first, first + 1, first + 3, first + 4, std::size_t{BTN_SELECT}, std::size_t{BTN_START}};
    std::uint32_t buttons = 0;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      buttons |= static_cast<std::uint32_t>(keys_[codes[i]]) << i;
    }
    return buttons;
  }

 private:
  /** -1 .. 1 */
  [[nodiscard]] double Centred(std::size_t code) const noexcept { return 2 * Trigger(code) - 1; }

  /** 0 .. 1; an axis that is not there is at rest. */
  [[nodiscard]] double Trigger(std::size_t code) const noexcept {
    const input_absinfo& axis = axes_[code];
    if (!has_axis_[code]) {
      const bool is_trigger = is_gamepad_ && (code == ABS_Z || code == ABS_RZ);
      return is_trigger ? 0 : 0.5;
    }
    const double range = static_cast<double>(axis.maximum) - axis.minimum;
    return std::clamp((static_cast<double>(axis.value) - axis.minimum) / range, 0.0, 1.0);
  }

  [[nodiscard]] double Key(std::size_t code) const noexcept { return keys_[code] ? 1 : 0; }

  bool is_gamepad_{false};
  std::bitset<kAxisCount> has_axis_;
  std::array<input_absinfo, kAxisCount> axes_{};
  std::bitset<kKeyBits> keys_;
  bool is_implausible_{false};
};

/** Rumble as strong as the force is. One effect of full strength is kept in the device; its gain
 and its start are events, that do not wait. */
class Rumble {
 public:
  /** May wait. */
  void Start(const EvdevNode& node, const Ability& ability) {
    is_there_ = false;
    has_gain_ = ability.has_gain;
    sent_share_ = 0;
    if (ability.effect == 0) {
      return;
    }
    ff_effect effect{};
    effect.type = ability.effect;
    effect.id = -1;
    effect.replay.length = kRumbleLength_ms;
    if (ability.effect == FF_RUMBLE) {
      effect.u.rumble.strong_magnitude = 0xFFFF;
      effect.u.rumble.weak_magnitude = 0xFFFF;
    } else {
      effect.u.constant.level = 0x7FFF;
    }
    is_there_ = node.Call(EVIOCSFF, &effect) >= 0;
    id_ = static_cast<std::uint16_t>(effect.id);
  }

  /** @param share  Of full strength. RT-safe. */
  void Show(const EvdevNode& node, double share, std::int64_t now_ns) noexcept {
    const bool is_off = share < kLeast;
    if (!is_there_ || (is_off && sent_share_ == 0)) {
      return;
    }
    const bool is_change = std::abs(share - sent_share_) > kLeast || (is_off && sent_share_ > 0);
    if (!is_change && now_ns - sent_ns_ < kRumblePeriodNs) {
      return;
    }
    sent_ns_ = now_ns;
    sent_share_ = is_off ? 0 : share;
    std::array<input_event, 2> events{};
    events[0].type = EV_FF;
    events[0].code = FF_GAIN;
    events[0].value = static_cast<std::int32_t>(0xFFFF * sent_share_);
    events[1].type = EV_FF;
    events[1].code = id_;
    events[1].value = is_off ? 0 : 1;
    node.Send(has_gain_ ? std::span<const input_event>(events) : std::span(events).last(1));
  }

 private:
  static constexpr double kLeast = 0.02;  // Share of full rumble, below which it is off: a choice.

  bool is_there_{false};
  bool has_gain_{false};
  std::uint16_t id_{0};
  double sent_share_{0};
  std::int64_t sent_ns_{0};
};

std::vector<std::filesystem::path> FindNodes(const std::filesystem::path& root) {
  std::vector<std::pair<int, std::filesystem::path>> nodes;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(root / "dev/input", failure)) {
    const std::string name = entry.path().filename().string();
    constexpr std::string_view kBegin = "event";
    const bool is_event = name.starts_with(kBegin) && name.size() > kBegin.size() &&
                          name.find_first_not_of("0123456789", kBegin.size()) == std::string::npos;
    if (is_event) {
      nodes.emplace_back(std::atoi(name.c_str() + kBegin.size()), entry.path());
    }
  }
  std::sort(nodes.begin(), nodes.end());
  std::vector<std::filesystem::path> paths;
  paths.reserve(nodes.size());
  for (auto& [number, path] : nodes) {
    paths.push_back(std::move(path));
  }
  return paths;
}

/** Whether a node that cannot be opened may be what is looked for, by what sys tells everybody
 about its keys: words of 64 bits in hexadecimal, the highest first. Yes where nothing is told. */
bool MayBeUsable(const std::filesystem::path& root, const std::filesystem::path& node) {
  std::ifstream stream(root / "sys/class/input" / node.filename() / "device/capabilities/key");
  std::vector<std::uint64_t> words;
  for (std::string word; stream >> word;) {
    words.insert(words.begin(), std::strtoull(word.c_str(), nullptr, 16));
  }
  const auto has = [&words](std::size_t bit) {
    return bit / 64 < words.size() && ((words[bit / 64] >> (bit % 64)) & 1) != 0;
  };
  return words.empty() || has(BTN_GAMEPAD) || has(BTN_JOYSTICK);
}

DeviceInfo InfoOf(const Ability& ability, const std::filesystem::path& path) {
  DeviceInfo info;
  info.driver = kName;
  info.address = fmt::format("{}:{}", kName, path.string());
  info.model = ability.name.empty() ? "Gamepad" : ability.name;
  info.serial = ability.serial;
  info.is_emulated = ability.serial.starts_with("EMULATED");
  info.profile = FindProfile(kName)->profile;
  info.profile_note = "gamepads report no limits; these are assumed by HVAS";
  info.capabilities.senses_position = false;
  info.capabilities.senses_rotation = true;
  info.capabilities.can_rumble = ability.effect != 0;
  info.capabilities.button_count = std::min(ability.button_count, 6);
  return info;
}

class Gamepad final : public Device, public Reopenable {
 public:
  Gamepad(EvdevNode node, const Ability& ability, DeviceInfo info, std::filesystem::path path,
          std::filesystem::path root, const Clock& clock)
      : node_(std::move(node)),
        info_(std::move(info)),
        path_(std::move(path)),
        root_(std::move(root)),
        clock_(clock),
        guard_(info_.profile, clock),
        rate_(info_.profile.workspace),
        read_ns_(clock.NowNs()),
        reopener_(this, clock) {
    Start(ability);
  }

  ~Gamepad() override {
    if (reopener_.IsThere()) {
      rumble_.Show(node_, 0, clock_.NowNs());
    }
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override {
    const std::int64_t now_ns = guard_.Begin();
    const double dt_s = 1e-9 * static_cast<double>(now_ns - std::exchange(read_ns_, now_ns));
    if (!reopener_.IsThere() || !ReceiveEvents()) {
      return guard_.Refuse(Condition::kLost);
    }
    if (controls_.is_implausible()) {
      return guard_.Refuse(Condition::kImplausible);
    }
    rate_.Step(controls_.deflection(), dt_s);
    DeviceState state;
    state.X_DH = rate_.X_DH();
    state.V_DH = rate_.V_DH();
    state.buttons = controls_.buttons();
    return guard_.Accept(state);
  }

  void Write(const spatial::Wrench& F_H_D) noexcept override {
    if (reopener_.IsThere()) {
      const double force = guard_.is_ready() ? F_H_D.f.norm() : 0;
      rumble_.Show(node_, force > 0 ? std::min(1.0, force / kFullRumble) : 0, clock_.NowNs());
    }
  }

  /** A device that is plugged in again may have another number: the name decides. */
  bool Reopen() override {
    std::vector<std::filesystem::path> paths = FindNodes(root_);
    paths.insert(paths.begin(), path_);
    for (const std::filesystem::path& path : paths) {
      EvdevNode node = EvdevNode::TryOpen(path);
      const Ability ability = node.is_open() ? AskAbility(node) : Ability{};
      if (ability.is_usable && ability.name == info_.model && ability.serial == info_.serial) {
        node_ = std::move(node);
        Start(ability);
        return true;
      }
    }
    return false;
  }

 private:
  void Start(const Ability& ability) {
    controls_.Start(ability);
    rumble_.Start(node_, ability);
  }

  /** Takes all that came; false when the device is gone. */
  bool ReceiveEvents() noexcept {
    constexpr int kMaxReads = 16;  // 64 events each; more wait for the next tick.
    std::array<input_event, 64> events;
    for (int i = 0; i < kMaxReads; ++i) {
      std::size_t count = 0;
      switch (node_.TryReceive(events, &count)) {
        case Transfer::kNothing:
          return true;
        case Transfer::kClosed:
          reopener_.Lose();
          return false;
        case Transfer::kDone:
          Take(std::span(events).first(count));
      }
    }
    return true;
  }

  void Take(std::span<const input_event> events) noexcept {
    for (const input_event& event : events) {
      if (event.type == EV_SYN && event.code == SYN_DROPPED) {
        AskAll();
      } else {
        controls_.Take(event);
      }
    }
  }

  /** The kernel had no room for all events: what is true now is asked for. */
  void AskAll() noexcept {
    for (std::size_t i = 0; i < kAxisCount; ++i) {
      input_absinfo axis{};
      if (controls_.has_axis(i) && node_.Call(EVIOCGABS(static_cast<unsigned>(i)), &axis) >= 0) {
        controls_.SetAxis(i, axis.value);
      }
    }
    Bits<kKeyBits> keys{};
    if (node_.Call(EVIOCGKEY(keys.size()), keys.data()) >= 0) {
      controls_.SetKeys(keys);
    }
  }

  EvdevNode node_;
  DeviceInfo info_;
  std::filesystem::path path_;
  std::filesystem::path root_;
  const Clock& clock_;
  PolledGuard guard_;
  RateControl rate_;
  Controls controls_;
  Rumble rumble_;
  std::int64_t read_ns_;
  Reopener reopener_;  // last: its thread ends before the rest goes
};

Result<std::unique_ptr<Device>> OpenNode(const std::filesystem::path& path,
                                         const Surroundings& surroundings) {
  EvdevNode node = EvdevNode::TryOpen(path);
  if (!node.is_open()) {
    return Unexpected(EvdevProblem(errno, path));
  }
  const Ability ability = AskAbility(node);
  if (!ability.is_usable) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("\"{}\" is not a gamepad or joystick", ability.name), path.string(),
                "omit the address to use the first one found");
  }
  return std::make_unique<Gamepad>(std::move(node), ability, InfoOf(ability, path), path,
                                   surroundings.root, *surroundings.clock);
}

class Gamepads final : public Driver {
 public:
  Gamepads()
      : Driver({kName, "Gamepad or joystick (Linux evdev)",
                "[NODE], for example gamepad:/dev/input/event5"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override {
    ProbeReport report = BeginReport();
    bool has_any = false;
    for (const std::filesystem::path& path : FindNodes(surroundings.root)) {
      EvdevNode node = EvdevNode::TryOpen(path);
      if (!node.is_open()) {
        const int reason = errno;
        if (!MayBeUsable(surroundings.root, path)) {
          continue;
        }
        report.looked_for.push_back({"input device", path.string(), false, "cannot be opened"});
        report.problems.push_back(EvdevProblem(reason, path));
        continue;
      }
      const Ability ability = AskAbility(node);
      report.looked_for.push_back(
          {"gamepad or joystick", path.string(), ability.is_usable, ability.name});
      has_any = has_any || ability.is_usable;
      if (ability.is_usable && opens_devices) {
        report.devices.push_back(InfoOf(ability, path));
      }
    }
    if (!has_any && report.problems.empty()) {
      report.problems.push_back(NoneFound(surroundings));
    }
    return report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& address, const Surroundings& surroundings) const override {
    if (!address.empty()) {
      return OpenNode(address, surroundings);
    }
    Error error = NoneFound(surroundings);
    for (const std::filesystem::path& path : FindNodes(surroundings.root)) {
      auto device = OpenNode(path, surroundings);
      if (device) {
        return device;
      }
      if (device.error().code != ErrorCode::kUnsupported && MayBeUsable(surroundings.root, path)) {
        error = device.error();
      }
    }
    return Unexpected(error);
  }

 private:
  static Error NoneFound(const Surroundings& surroundings) {
    return {ErrorCode::kNotFound, "no gamepad or joystick is connected",
            (surroundings.root / "dev/input").string(), "connect one, or pair it by Bluetooth"};
  }
};

}  // namespace

const Driver& GamepadDriver() {
  static const Gamepads driver;
  return driver;
}

}  // namespace hvas::device
