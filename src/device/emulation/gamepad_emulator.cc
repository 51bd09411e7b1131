#include "device/emulation/gamepad_emulator.h"

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "device/drivers/evdev_node.h"
#include "device/emulation/rate_person.h"

namespace hvas::device {
namespace {

constexpr const char* kGamepadName = "Emulated gamepad";
constexpr const char* kSerial = "EMULATED-1";
// Ranges as pads with 16 and 10 bits report them.
constexpr std::int32_t kStickMax = 32767;
constexpr std::int32_t kTriggerMax = 1023;
constexpr std::int64_t kRumbleLength_ms = 200;  // as the driver asks for

struct Axis {
  std::uint16_t code;
  std::int32_t minimum;
  std::int32_t maximum;
  std::int32_t value;
};

using Axes = std::array<Axis, 8>;

/** The axes of a common gamepad, at rest. */
constexpr Axes kAtRest{{{ABS_X, -kStickMax, kStickMax, 0},
                        {ABS_Y, -kStickMax, kStickMax, 0},
                        {ABS_Z, 0, kTriggerMax, 0},
                        {ABS_RX, -kStickMax, kStickMax, 0},
                        {ABS_RY, -kStickMax, kStickMax, 0},
                        {ABS_RZ, 0, kTriggerMax, 0},
                        {ABS_HAT0X, -1, 1, 0},
                        {ABS_HAT0Y, -1, 1, 0}}};

constexpr std::initializer_list<std::uint16_t> kKeys{BTN_SOUTH, BTN_EAST, BTN_NORTH,  BTN_WEST,
                                                     BTN_TL,    BTN_TR,   BTN_SELECT, BTN_START};

class GamepadServer final : public WireServer {
 public:
  GamepadServer(const WireSite& site, std::filesystem::path path, Descriptor events,
                Descriptor calls)
      : device_(*site.device),
        path_(std::move(path)),
        events_listener_(std::move(events)),
        calls_listener_(std::move(calls)),
        person_(device_.profile().workspace) {}

  [[nodiscard]] std::string address() const override {
    return fmt::format("gamepad:{}", path_.string());
  }

  void Serve() override {
    const bool is_gone = device_.fault() == Fault::kUnplugged;
    Accept(events_listener_, is_gone, &events_);
    Accept(calls_listener_, is_gone, &calls_);
    std::array<std::byte, 512> buffer;
    std::erase_if(calls_, [&](const Descriptor& client) {
      std::size_t count = 0;
      Transfer transfer = Transfer::kNothing;
      while ((transfer = TryReceive(client, buffer, &count)) == Transfer::kDone) {
        Answer(client, std::span(buffer).first(count));
      }
      return transfer == Transfer::kClosed;
    });
    std::erase_if(events_, [&](const Descriptor& client) {
      std::size_t count = 0;
      Transfer transfer = Transfer::kNothing;
      while ((transfer = TryReceive(client, buffer, &count)) == Transfer::kDone) {
        Play(std::span(buffer).first(count));
      }
      return transfer == Transfer::kClosed;
    });
  }

  void Emit(std::int64_t step_ns) override {
    const Fault fault = device_.fault();
    if (fault == Fault::kUnplugged) {
      events_.clear();
      calls_.clear();
      playing_ns_ = 0;
      return;
    }
    playing_ns_ = std::max<std::int64_t>(playing_ns_ - step_ns, 0);
    spatial::Wrench F;
    F.f.z() = playing_ns_ > 0 ? gain_ : 0;
    device_.Command(F);
    if (fault == Fault::kStalled || events_.empty()) {
      return;
    }
    Push(fault, 1e-9 * static_cast<double>(step_ns));
  }

 private:
  static void Accept(const Descriptor& listener, bool is_gone, std::vector<Descriptor>* clients) {
    for (Descriptor client = TryAccept(listener); client.is_open(); client = TryAccept(listener)) {
      if (!is_gone) {
        clients->push_back(std::move(client));
      }
    }
  }

  /** Pushes sticks and buttons as the person wants, and tells of what changed. */
  void Push(Fault fault, double dt) {
    std::vector<input_event> events;
    const bool is_garbled =
        fault == Fault::kNotANumber || fault == Fault::kJump || fault == Fault::kCalibrationLost;
    const Deflection wanted = person_.Deflect(device_.truth().X_DH);
    Axes axes = kAtRest;
    const auto stick = [](double share) {
      return static_cast<std::int32_t>(std::lround(kStickMax * share));
    };
    const auto trigger = [](double share) {
      return static_cast<std::int32_t>(std::lround(kTriggerMax * std::max(0.0, share)));
    };
    axes[0].value = is_garbled ? 100 * kStickMax : stick(wanted.move.x());
    axes[1].value = stick(-wanted.move.y());
    axes[2].value = trigger(-wanted.move.z());
    axes[3].value = stick(-wanted.turn.z());
    axes[4].value = stick(wanted.turn.x());
    axes[5].value = trigger(wanted.move.z());
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i].value != axes_[i].value) {
        events.push_back(MakeEvent(EV_ABS, axes[i].code, axes[i].value));
      }
    }
    axes_ = axes;
    constexpr double kRollStart = 0.12;  // a shoulder button is all or nothing
    const std::uint32_t buttons = device_.Sense().buttons;
    SetKey(BTN_SOUTH, (buttons & 1) != 0, &events);
    SetKey(BTN_EAST, (buttons & 2) != 0, &events);
    SetKey(BTN_TL, wanted.turn.y() < -kRollStart, &events);
    SetKey(BTN_TR, wanted.turn.y() > kRollStart, &events);
    if (!events.empty()) {
      events.push_back(MakeEvent(EV_SYN, SYN_REPORT, 0));
      Send(events);
    }
    if (!is_garbled) {
      person_.See(Shown(), dt);
    }
  }

  /** What the sticks do to the pose, in steps as they are sent. */
  [[nodiscard]] Deflection Shown() const {
    const auto stick = [this](std::size_t i) {
      return static_cast<double>(axes_[i].value) / kStickMax;
    };
    const auto trigger = [this](std::size_t i) {
      return static_cast<double>(axes_[i].value) / kTriggerMax;
    };
    const auto key = [this](std::uint16_t code) {
      return std::count(pressed_.begin(), pressed_.end(), code) > 0 ? 0.5 : 0.0;
    };
    return {Vec3(stick(0), -stick(1), trigger(5) - trigger(2)),
            Vec3(stick(4), key(BTN_TR) - key(BTN_TL), -stick(3))};
  }

  static input_event MakeEvent(std::uint16_t type, std::uint16_t code, std::int32_t value) {
    input_event event{};
    event.type = type;
    event.code = code;
    event.value = value;
    return event;
  }

  void SetKey(std::uint16_t code, bool is_pressed, std::vector<input_event>* events) {
    const auto found = std::find(pressed_.begin(), pressed_.end(), code);
    if (is_pressed == (found != pressed_.end())) {
      return;
    }
    events->push_back(MakeEvent(EV_KEY, code, is_pressed ? 1 : 0));
    if (is_pressed) {
      pressed_.push_back(code);
    } else {
      pressed_.erase(found);
    }
  }

  void Send(const std::vector<input_event>& events) {
    for (const Descriptor& client : events_) {
      ::send(client.value(), events.data(), events.size() * sizeof(input_event),
             MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }

  void Play(std::span<const std::byte> bytes) {
    for (; bytes.size() >= sizeof(input_event); bytes = bytes.subspan(sizeof(input_event))) {
      input_event event;
      std::memcpy(&event, bytes.data(), sizeof(event));
      if (event.type != EV_FF) {
        continue;
      }
      if (event.code == FF_GAIN) {
        gain_ = static_cast<double>(event.value) / 0xFFFF;
      } else {
        playing_ns_ = event.value != 0 ? kRumbleLength_ms * 1'000'000 : 0;
      }
    }
  }

  /** What the kernel answers to an ioctl, for the requests that the driver makes. */
  void Answer(const Descriptor& client, std::span<const std::byte> bytes) {
    EvdevCall call{};
    if (bytes.size() < sizeof(call)) {
      return;
    }
    std::memcpy(&call, bytes.data(), sizeof(call));
    std::vector<std::byte> data(_IOC_SIZE(call.request));
    const bool is_known = Fill(call.request, bytes.subspan(sizeof(call)), data);
    const EvdevAnswer answer{is_known ? 0 : -1, is_known ? 0 : EINVAL};
    std::vector<std::byte> reply(sizeof(answer));
    std::memcpy(reply.data(), &answer, sizeof(answer));
    reply.insert(reply.end(), data.begin(), data.end());
    ::send(client.value(), reply.data(), reply.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  bool Fill(unsigned long request, std::span<const std::byte> given, std::span<std::byte> data) {
    const unsigned long number = _IOC_NR(request);
    const auto text = [&data](const char* value) {
      std::memcpy(data.data(), value, std::min(data.size(), std::strlen(value) + 1));
    };
    const auto set = [&data](std::size_t bit) {
      if (bit / 8 < data.size()) {
        data[bit / 8] |= static_cast<std::byte>(1U << (bit % 8));
      }
    };
    if (number == _IOC_NR(EVIOCGNAME(0))) {
      text(kGamepadName);
    } else if (number == _IOC_NR(EVIOCGUNIQ(0))) {
      text(kSerial);
    } else if (number == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) {
      std::for_each(kKeys.begin(), kKeys.end(), set);
    } else if (number == _IOC_NR(EVIOCGKEY(0))) {
      std::for_each(pressed_.begin(), pressed_.end(), set);
    } else if (number == _IOC_NR(EVIOCGBIT(EV_ABS, 0))) {
      std::for_each(axes_.begin(), axes_.end(), [&set](const Axis& axis) { set(axis.code); });
    } else if (number == _IOC_NR(EVIOCGBIT(EV_FF, 0))) {
      set(FF_RUMBLE);
      set(FF_GAIN);
    } else if (request == EVIOCSFF && given.size() == data.size()) {
      std::memcpy(data.data(), given.data(), given.size());
      ff_effect effect;
      std::memcpy(&effect, data.data(), sizeof(effect));
      effect.id = 0;
      std::memcpy(data.data(), &effect, sizeof(effect));
    } else {
      return FillAxis(request, data);
    }
    return true;
  }

  bool FillAxis(unsigned long request, std::span<std::byte> data) const {
    for (const Axis& axis : axes_) {
      if (request == EVIOCGABS(axis.code)) {
        input_absinfo info{};
        info.value = axis.value;
        info.minimum = axis.minimum;
        info.maximum = axis.maximum;
        std::memcpy(data.data(), &info, sizeof(info));
        return true;
      }
    }
    return false;
  }

  EmulatedDevice& device_;
  std::filesystem::path path_;
  Descriptor events_listener_;
  Descriptor calls_listener_;
  std::vector<Descriptor> events_;
  std::vector<Descriptor> calls_;
  RatePerson person_;
  Axes axes_{kAtRest};
  std::vector<std::uint16_t> pressed_;
  double gain_{1};
  std::int64_t playing_ns_{0};
};

}  // namespace

Result<std::unique_ptr<WireServer>> MakeGamepadServer(const WireSite& site) {
  const std::filesystem::path path = site.root / "dev/input/event0";
  auto events = ListenAt(path, SOCK_SEQPACKET);
  auto calls = ListenAt(path.string() + EvdevNode::kCalls, SOCK_SEQPACKET);
  if (!events || !calls) {
    return Unexpected(events ? calls.error() : events.error());
  }
  return std::make_unique<GamepadServer>(site, path, std::move(*events), std::move(*calls));
}

}  // namespace hvas::device
