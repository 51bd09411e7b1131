// Haply Inverse3 through the WebSocket of its Inverse Service (docs/devices/haply.md).
#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/triple_buffer.h"
#include "device/drivers/haply_messages.h"
#include "device/drivers/polled_guard.h"
#include "device/drivers/websocket.h"
#include "device/drivers/wire_drivers.h"

namespace hvas::device {
namespace {

constexpr const char* kName = "haply";
// The service listens at one of these ports. The times that it is given, and the tries, are
// choices.
constexpr std::array<std::uint16_t, 2> kPorts{10001, 10000};
constexpr int kConnectTimeout_ms = 1000;
constexpr std::int64_t kSnapshotNs = 500'000'000;
constexpr int kSnapshotTries = 3;
constexpr std::int64_t kPeriodNs =
    500'000;  // between messages at least: the service's loop is ours
constexpr std::int64_t kReplyNs = 2'000'000;  // The wait for the answer to a request: a choice.
constexpr std::int64_t kSilentNs = 1'000'000'000;  // then the connection is made anew
constexpr std::int64_t kRetryNs = 250'000'000;     // Time between tries to connect: a choice.
constexpr std::int64_t kAskAgainNs = 50'000'000;   // while no device is listed

struct HaplyAddress {
  std::string host{"localhost"};
  std::vector<std::uint16_t> ports{kPorts.begin(), kPorts.end()};
  std::string device_id;
};

/** "[HOST[:PORT]][/DEVICE_ID]" */
Result<HaplyAddress> ParseAddress(const std::string& text) {
  HaplyAddress address;
  const std::size_t slash = text.find('/');
  const std::string place = text.substr(0, slash);
  address.device_id = slash == std::string::npos ? "" : text.substr(slash + 1);
  const std::size_t colon = place.rfind(':');
  if (!place.empty() && colon != 0) {
    address.host = place.substr(0, colon);
  }
  if (colon != std::string::npos) {
    const std::string port = place.substr(colon + 1);
    std::uint16_t number = 0;
    const auto [end, failure] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (failure != std::errc() || end != port.data() + port.size() || number == 0) {
      return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a port number", port), text,
                  "write haply:HOST:PORT, for example haply:localhost:10001");
    }
    address.ports = {number};
  }
  return address;
}

/** A force and when it was given. */
struct Command {
  Vec3 force{Vec3::Zero()};
  std::int64_t t_ns{0};
};

/** The conversation with a service about one device. One thread at a time; it allocates. */
class Conversation {
 public:
  Conversation(std::string host, std::uint16_t port, std::string device_id, const Clock& clock)
      : host_(std::move(host)), port_(port), device_id_(std::move(device_id)), clock_(clock) {}

  Conversation(const Conversation&) = delete;
  Conversation& operator=(const Conversation&) = delete;
  ~Conversation() = default;

  /** Connects, and finds the device. Errors: kNotFound, kUnreadable. */
  Result<haply::Message> Start() {
    auto socket = WebSocket::Connect(host_, port_, kConnectTimeout_ms);
    if (!socket) {
      return Unexpected(socket.error());
    }
    socket_ = std::move(*socket);
    is_first_ = true;
    tells_force_ = false;
    unshown_ = 0;
    heard_ns_ = clock_.NowNs();
    haply::Message message;
    for (int i = 0; i < kSnapshotTries && !message.has_device; ++i) {
      if (i > 0) {
        socket_->Send(haply::FullStateMessage());
      }
      const auto text = socket_->Receive(kSnapshotNs);
      message = text ? haply::ParseMessage(*text, device_id_) : haply::Message{};
    }
    if (!message.has_device) {
      socket_.reset();
      return Fail(ErrorCode::kNotFound,
                  device_id_.empty()
                      ? "the Inverse Service runs, but no Inverse3 is connected"
                      : fmt::format("the Inverse Service has no device \"{}\"", device_id_),
                  where(), "connect its cable and power, and wait for its light");
    }
    const auto dialect = haply::DialectOf(message.version);
    is_dialect_known_ = dialect.has_value();
    dialect_ = dialect.value_or(haply::Dialect::kVector);
    device_id_ = message.device_id;
    return message;
  }

  /** Publishes what came. Connects first when it has to. */
  void TakeIn(std::int64_t timeout_ns) {
    if (!IsConnected()) {
      return;
    }
    bool has_reply = false;
    while (const auto text = socket_->Receive(has_reply ? 0 : timeout_ns)) {
      has_reply = true;
      newest_ = haply::ParseMessage(*text, device_id_);
      heard_ns_ = clock_.NowNs();
    }
    if (has_reply) {
      JudgeDialect();
      Publish();
    }
    if (!socket_->is_open() || clock_.NowNs() - heard_ns_ > kSilentNs) {
      Lose();
    }
  }

  /** Says the newest force, as far as its age lets it, and thereby asks for a state. */
  void Say() {
    if (socket_ == nullptr) {
      return;
    }
    if (!newest_.has_device) {
      if (clock_.NowNs() >= ask_ns_) {
        ask_ns_ = clock_.NowNs() + kAskAgainNs;
        socket_->Send(haply::FullStateMessage());
      }
      return;
    }
    commands_.Update();
    const Command& command = commands_.value();
    said_ = hold_.CalcShare(command.t_ns, clock_.NowNs()) * command.force;
    socket_->Send(
        haply::ForceMessage(dialect_, device_id_, said_, std::exchange(is_first_, false)));
  }

  /** Says good-bye: no force. */
  void End() {
    if (socket_ != nullptr && newest_.has_device) {
      socket_->Send(haply::ForceMessage(dialect_, device_id_, Vec3::Zero(), is_first_));
    }
    socket_.reset();
  }

  [[nodiscard]] bool is_connected() const { return socket_ != nullptr; }

  [[nodiscard]] std::string where() const { return fmt::format("ws://{}:{}", host_, port_); }

  TripleBuffer<Command>& commands() { return commands_; }

  TripleBuffer<DeviceState>& states() { return states_; }

 private:
  bool IsConnected() {
    if (socket_ == nullptr && clock_.NowNs() >= retry_ns_) {
      retry_ns_ = clock_.NowNs() + kRetryNs;
      if (auto message = Start()) {
        newest_ = std::move(*message);
      }
    }
    return socket_ != nullptr;
  }

  void Lose() {
    socket_.reset();
    retry_ns_ = clock_.NowNs() + kRetryNs;
    newest_ = {};
    Publish();
  }

  /** A service that tells no version, and shows no force though it has power and is given one,
   reads the other dialect. Tried once on a connection. */
  void JudgeDialect() {
    constexpr double kClear = 0.2;     // [N], told to the device and clear to see: a choice.
    constexpr double kNothing = 0.01;  // [N], shown by the device, that is none: a choice.
    constexpr int kReplies = 25;       // Replies without a force until it is changed: a choice.
    tells_force_ = tells_force_ || newest_.force.has_value();
    const double shown = newest_.force.value_or(Vec3::Zero()).norm();
    const bool is_unshown =
        tells_force_ && newest_.has_power && said_.norm() > kClear && shown < kNothing;
    unshown_ = is_unshown ? unshown_ + 1 : 0;
    if (!is_dialect_known_ && unshown_ > kReplies) {
      dialect_ = haply::Dialect::kValues;
      is_dialect_known_ = true;
    }
  }

  void Publish() {
    DeviceState state;
    state.X_DH = PoseFromWire(newest_.q, newest_.p);
    state.V_DH.v = newest_.v;
    state.buttons = newest_.buttons;
    state.condition = !newest_.has_device      ? Condition::kLost
                      : !newest_.is_calibrated ? Condition::kNotCalibrated
                      : !newest_.has_power     ? Condition::kNoForce
                                               : Condition::kReady;
    states_.Write(state);
  }

  std::string host_;
  std::uint16_t port_;
  std::string device_id_;
  const Clock& clock_;
  std::unique_ptr<WebSocket> socket_;
  TripleBuffer<Command> commands_;
  ForceHold hold_;
  TripleBuffer<DeviceState> states_;
  haply::Message newest_;
  haply::Dialect dialect_{haply::Dialect::kVector};
  bool is_dialect_known_{false};
  bool is_first_{true};
  bool tells_force_{false};
  int unshown_{0};
  Vec3 said_{Vec3::Zero()};
  std::int64_t heard_ns_{0};
  std::int64_t retry_ns_{0};
  std::int64_t ask_ns_{0};
};

class Inverse3 final : public Device {
 public:
  Inverse3(std::unique_ptr<Conversation> conversation, DeviceInfo info, const Clock& clock)
      : conversation_(std::move(conversation)),
        info_(std::move(info)),
        clock_(clock),
        guard_(info_.profile, clock) {
    if (&clock != &SystemClock()) {
      turn_ = TakeTurn;
    } else {
      thread_ = std::thread([this] { Run(); });
    }
  }

  ~Inverse3() override {
    {
      const std::scoped_lock lock(mutex_);
      stops_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) {
      thread_.join();
    }
    conversation_->End();
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }

  [[nodiscard]] DeviceState Read() noexcept override {
    guard_.Begin();
    if (turn_ != nullptr) {
      turn_(conversation_.get(), false);
    }
    if (!conversation_->states().Update()) {
      return is_lost_ ? guard_.Refuse(Condition::kLost) : guard_.Repeat();
    }
    const DeviceState& state = conversation_->states().value();
    is_lost_ = state.condition == Condition::kLost;
    return is_lost_ ? guard_.Refuse(Condition::kLost) : guard_.Accept(state);
  }

  void Write(const spatial::Wrench& F_H_D) noexcept override {
    conversation_->commands().Write({guard_.Permit(F_H_D).f, clock_.NowNs()});
    if (turn_ != nullptr) {
      turn_(conversation_.get(), true);
    }
  }

 private:
  static void TakeTurn(Conversation* conversation, bool says) {
    if (says) {
      conversation->Say();
    } else {
      conversation->TakeIn(0);
    }
  }

  /** In real time the conversation has a thread of its own, whose rate is the service's. */
  void Run() {
    std::unique_lock lock(mutex_);
    while (!stops_) {
      lock.unlock();
      const auto start = std::chrono::steady_clock::now();
      conversation_->Say();
      conversation_->TakeIn(kReplyNs);
      const auto nap =
          std::chrono::nanoseconds(conversation_->is_connected() ? kPeriodNs : kRetryNs);
      lock.lock();
      wake_.wait_until(lock, start + nap, [this] { return stops_; });
    }
  }

  std::unique_ptr<Conversation> conversation_;
  DeviceInfo info_;
  const Clock& clock_;
  PolledGuard guard_;
  /** Set in virtual time, which a thread would not know: the haptic thread, for which real time is
   nothing then, speaks and listens itself. */
  void (*turn_)(Conversation* conversation, bool says){nullptr};
  bool is_lost_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stops_{false};
  std::thread thread_;
};

DeviceInfo InfoOf(const haply::Message& message, const std::string& host, std::uint16_t port) {
  DeviceInfo info;
  info.driver = kName;
  info.address = fmt::format("{}:{}:{}/{}", kName, host, port, message.device_id);
  info.model = "Inverse3";
  info.serial = message.device_id;
  info.version = message.version;
  info.is_emulated = message.is_emulated;
  info.profile = FindProfile("inverse3")->profile;
  info.profile_note = "the service reports no limits; these are assumed by HVAS";
  info.capabilities.force_axes = 3;
  info.capabilities.senses_rotation = message.has_handle;
  info.capabilities.button_count = message.has_handle ? 3 : 0;
  return info;
}

class Haply final : public Driver {
 public:
  Haply()
      : Driver({kName, "Haply Inverse3 (Inverse Service)",
                "[HOST[:PORT]][/DEVICE_ID] of the Inverse Service, for example "
                "haply:localhost:10001/049D"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override {
    ProbeReport report = BeginReport();
    const auto device = OpenAt(HaplyAddress{}, surroundings, &report.looked_for);
    if (!device) {
      report.problems.push_back(device.error());
    } else if (opens_devices) {
      report.devices.push_back((*device)->info());
    }
    return report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& text, const Surroundings& surroundings) const override {
    const auto address = ParseAddress(text);
    if (!address) {
      return Unexpected(address.error());
    }
    std::vector<Finding> ignored;
    return OpenAt(*address, surroundings, &ignored);
  }

 private:
  static Result<std::unique_ptr<Device>> OpenAt(const HaplyAddress& address,
                                                const Surroundings& surroundings,
                                                std::vector<Finding>* looked_for) {
    Error error;
    for (const std::uint16_t port : address.ports) {
      auto conversation = std::make_unique<Conversation>(address.host, port, address.device_id,
                                                         *surroundings.clock);
      const auto message = conversation->Start();
      const std::string where = conversation->where();
      looked_for->push_back({"Inverse Service", where, message.has_value(),
                             message ? message->version : message.error().message});
      if (message) {
        return std::make_unique<Inverse3>(
            std::move(conversation), InfoOf(*message, address.host, port), *surroundings.clock);
      }
      // A service without a device is more to the point than a port where nobody listens.
      if (error.message.empty() || !message.error().remedy.empty()) {
        error = message.error();
      }
    }
    if (error.remedy.empty()) {
      error.message = fmt::format("the Inverse Service is not running ({})", error.message);
      error.where = looked_for->front().where;
      error.remedy =
          "start Haply's Inverse Service on this machine (haply-inverse-service), or give "
          "its address: haply:HOST:PORT";
    }
    return Unexpected(error);
  }
};

}  // namespace

const Driver& HaplyDriver() {
  static const Haply driver;
  return driver;
}

}  // namespace hvas::device
