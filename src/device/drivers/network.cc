#include "device/drivers/network.h"

#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/regular_file.h"
#include "device/drivers/wire_drivers.h"

namespace hvas::device {
namespace {

using network::Refusal;

constexpr const char* kName = "network";
constexpr const char* kDefaultHost = "127.0.0.1";
constexpr std::uint16_t kDefaultPort = 47811;  // A choice, free for users by --device.
constexpr const char* kDefaultKey = "etc/hvas/network.key";
constexpr const char* kMakeKey =
    "make one with (umask 077; head -c 32 /dev/urandom > FILE), and give the device's program the "
    "same file";
constexpr std::size_t kMaxKey = 4096;  // [bytes]: a file with more is no key.
// A choice: thirty times the period of a client that sends 20 hellos a second.
constexpr int kHelloTimeout_ms = 1500;
constexpr std::int64_t kLostNs = 500'000'000;  // of silence
constexpr int kMaxPacketsPerRead = 64;  // A bound, so that nobody can keep a tick busy: a choice.

/** 64 random bits that are not 0, from the system. */
std::uint64_t DrawSession() noexcept {
  std::uint64_t session = 0;
  while (session == 0 && ::getrandom(&session, sizeof(session), 0) == sizeof(session)) {
  }
  return session;
}

Result<network::PacketKey> LoadKey(const std::filesystem::path& file) {
  struct stat status {};

  if (::stat(file.c_str(), &status) != 0) {
    return Fail(ErrorCode::kNotFound, "there is no key for network devices", file.string(),
                kMakeKey);
  }
  if (!S_ISREG(status.st_mode) || (status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return Fail(
        ErrorCode::kInvalid, "other users can read this key, so it is not secret", file.string(),
        fmt::format("make a new key with access for you only: chmod 600 {}", file.string()));
  }
  const Result<std::string> read = ReadRegularFile(file);
  if (!read) {
    return Unexpected(read.error());
  }
  std::string secret = *read;
  while (!secret.empty() && (secret.back() == '\n' || secret.back() == '\r')) {
    secret.pop_back();
  }
  if (secret.size() < network::kMinKey || secret.size() > kMaxKey) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("this key has {} bytes; {} to {} are needed", secret.size(),
                            network::kMinKey, kMaxKey),
                file.string(), kMakeKey);
  }
  return network::PacketKey(secret);
}

struct NetworkAddress {
  std::string host{kDefaultHost};
  std::uint16_t port{kDefaultPort};
  std::filesystem::path key;
};

/** "[[HOST:]PORT][?key=FILE]" */
Result<NetworkAddress> ParseAddress(const std::string& text, const Surroundings& surroundings) {
  NetworkAddress address;
  address.key = surroundings.root / kDefaultKey;
  const std::size_t mark = text.find('?');
  if (mark != std::string::npos) {
    constexpr std::string_view kKey = "key=";
    const std::string_view option = std::string_view(text).substr(mark + 1);
    if (!option.starts_with(kKey) || option.size() == kKey.size()) {
      return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not an option of an address", option),
                  text, "write network:[HOST:]PORT?key=FILE");
    }
    address.key = option.substr(kKey.size());
  }
  const std::string place = text.substr(0, mark);
  if (place.empty()) {
    return address;
  }
  const std::size_t colon = place.rfind(':');
  const std::string port = colon == std::string::npos ? place : place.substr(colon + 1);
  const auto [end, failure] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (failure != std::errc() || end != port.data() + port.size() || address.port == 0) {
    return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" is not a port number", port), text,
                "write network:[HOST:]PORT?key=FILE with a port of 1 to 65535");
  }
  if (colon != std::string::npos) {
    address.host = place.substr(0, colon);
  }
  return address;
}

const char* ToWords(Refusal refusal) {
  switch (refusal) {
    case Refusal::kMalformed:
      return "of another protocol";
    case Refusal::kOtherVersion:
      return "of another version of the protocol";
    case Refusal::kForged:
      return "with another key, or modified in transit";
    case Refusal::kForeignSession:
      return "of another session";
    case Refusal::kReplayed:
      return "sent again";
    case Refusal::kLate:
      return "overtaken by newer ones";
    case Refusal::kNone:
      break;
  }
  return "taken";
}

/** "; refused: 3 packets with another key, ..."; empty when none was. */
std::string RefusedInWords(const LinkCounts& counts) {
  std::string text;
  for (std::size_t i = 1; i < counts.refused.size(); ++i) {
    if (counts.refused[i] > 0) {
      text += fmt::format("{} {} {}", text.empty() ? "; refused:" : ",", counts.refused[i],
                          ToWords(static_cast<Refusal>(i)));
    }
  }
  return text;
}

double Percent(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? 100 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

NetworkDevice::NetworkDevice(DatagramSocket socket, const network::PacketKey& key,
                             const Clock& clock)
    : socket_(std::move(socket)), key_(key), clock_(clock) {}

bool NetworkDevice::WaitForHello(int timeout_ms, const std::string& address) {
  const std::int64_t end_ns = MonotonicNs() + std::int64_t{timeout_ms} * 1'000'000;
  while (!has_hello_) {
    const std::int64_t left_ms = (end_ns - MonotonicNs()) / 1'000'000;
    if (left_ms <= 0) {
      return false;
    }
    socket_.WaitFor(static_cast<int>(left_ms));
    network::StatePacket ignored;
    (void)Receive(&ignored);
  }
  info_ = network::InfoOf(hello_, address);
  guard_ = std::make_unique<PolledGuard>(info_.profile, clock_);
  heard_ns_ = clock_.NowNs();
  return true;
}

DeviceState NetworkDevice::Read() noexcept {
  const std::int64_t now_ns = guard_->Begin();
  network::StatePacket packet;
  if (!Receive(&packet)) {
    return now_ns - heard_ns_ > kLostNs ? guard_->Refuse(Condition::kLost) : guard_->Repeat();
  }
  heard_ns_ = now_ns;
  CountTrip(packet);
  return guard_->Accept(network::StateOf(packet));
}

void NetworkDevice::Write(const spatial::Wrench& F_H_D) noexcept {
  const spatial::Wrench F = guard_->Permit(F_H_D);
  network::WrenchPacket packet;
  std::copy_n(F.t.data(), 3, packet.t.begin());
  std::copy_n(F.f.data(), 3, packet.f.begin());
  packet.state_sequence = session_.window.newest();
  Send(packet);
}

template <typename Body>
void NetworkDevice::Send(const Body& body) noexcept {
  if (session_.id == 0) {
    return;
  }
  network::Header header;
  header.session = session_.id;
  header.sequence = ++session_.sent;
  header.t_ns = clock_.NowNs();
  socket_.Send(network::Seal(key_, header, body).bytes(), device_);
  wrenches_.store(session_.sent, std::memory_order_relaxed);
}

NetworkDevice::~NetworkDevice() {
  Send(network::Bye{});
}

bool NetworkDevice::Receive(network::StatePacket* newest) noexcept {
  std::array<std::byte, network::kMaxPacket + 1> buffer;
  bool has_state = false;
  for (int i = 0; i < kMaxPacketsPerRead; ++i) {
    Endpoint sender;
    const auto bytes = socket_.Receive(buffer, &sender);
    if (!bytes) {
      break;
    }
    const network::Opened opened = network::Open(key_, *bytes);
    const Refusal refusal = Take(opened, sender, newest);
    if (refusal != Refusal::kNone) {
      refused_[static_cast<std::size_t>(refusal)].fetch_add(1, std::memory_order_relaxed);
    } else if (opened.header.type == network::PacketType::kState) {
      device_ = sender;
      has_state = true;
    }
  }
  return has_state;
}

Refusal NetworkDevice::Take(const network::Opened& opened, const Endpoint& sender,
                            network::StatePacket* newest) noexcept {
  if (opened.refusal != Refusal::kNone) {
    return opened.refusal;
  }
  if (network::Hello hello; network::Read(opened, &hello)) {
    return Take(hello, sender);
  }
  return TakeState(opened, newest);
}

Refusal NetworkDevice::Take(const network::Hello& hello, const Endpoint& sender) noexcept {
  if (has_hello_ && !IsSameDevice(hello)) {
    return Refusal::kForeignSession;
  }
  if (has_hello_ && hello.nonce == hello_.nonce) {
    return Refusal::kReplayed;
  }
  // Somebody may have recorded this hello. So it changes nothing yet: only who has the key can send
  // a state in the session that it is offered here.
  hello_ = hello;
  has_hello_ = true;
  pending_session_ = DrawSession();
  network::Header header;
  header.session = pending_session_;
  header.sequence = 0;
  header.t_ns = clock_.NowNs();
  socket_.Send(network::Seal(key_, header, network::Welcome{hello.nonce}).bytes(), sender);
  return Refusal::kNone;
}

bool NetworkDevice::IsSameDevice(const network::Hello& hello) const noexcept {
  return hello.model == hello_.model && hello.serial == hello_.serial &&
         hello.limits == hello_.limits && hello.force_axes == hello_.force_axes &&
         hello.torque_axes == hello_.torque_axes;
}

Refusal NetworkDevice::TakeState(const network::Opened& opened,
                                 network::StatePacket* newest) noexcept {
  network::StatePacket state;
  if (!network::Read(opened, &state)) {
    return Refusal::kMalformed;
  }
  const std::uint64_t id = opened.header.session;
  if (id != 0 && id == pending_session_) {
    session_ = {id, {}, 0};
    pending_session_ = 0;
  }
  if (id == 0 || id != session_.id) {
    return Refusal::kForeignSession;
  }
  const Refusal refusal = session_.window.Take(opened.header.sequence);
  if (refusal == Refusal::kNone) {
    *newest = state;
    states_.fetch_add(1, std::memory_order_relaxed);
  }
  states_lost_.store(session_.window.missing(), std::memory_order_relaxed);
  return refusal;
}

void NetworkDevice::CountTrip(const network::StatePacket& state) noexcept {
  if (state.wrench_sequence == 0 || state.wrench_sequence > session_.sent) {
    return;
  }
  round_trip_ns_.store(clock_.NowNs() - state.wrench_t_ns, std::memory_order_relaxed);
  const std::uint64_t due = state.wrench_sequence;
  wrenches_lost_.store(due - std::min(due, state.wrench_count), std::memory_order_relaxed);
}

LinkCounts NetworkDevice::counts() const noexcept {
  LinkCounts counts;
  counts.states = states_.load(std::memory_order_relaxed);
  counts.states_lost = states_lost_.load(std::memory_order_relaxed);
  counts.wrenches = wrenches_.load(std::memory_order_relaxed);
  counts.wrenches_lost = wrenches_lost_.load(std::memory_order_relaxed);
  counts.round_trip_ns = round_trip_ns_.load(std::memory_order_relaxed);
  for (std::size_t i = 0; i < refused_.size(); ++i) {
    counts.refused[i] = refused_[i].load(std::memory_order_relaxed);
  }
  return counts;
}

std::string NetworkDevice::Explain(const DeviceState& state) const {
  const LinkCounts now = counts();
  return fmt::format(
      "{}; lost {:.1f} % of its states and {:.1f} % of its wrenches, round trip {:.1f} ms{}",
      Device::Explain(state), Percent(now.states_lost, now.states_lost + now.states),
      Percent(now.wrenches_lost, now.wrenches), 1e-6 * static_cast<double>(now.round_trip_ns),
      RefusedInWords(now));
}

namespace {

class Network final : public Driver {
 public:
  Network()
      : Driver({kName, "Network device (HVAS's own UDP protocol)",
                "[[HOST:]PORT][?key=FILE] to listen on, for example "
                "network:127.0.0.1:47811?key=/etc/hvas/network.key"}) {}

  [[nodiscard]] ProbeReport ProbeUnchecked(const Surroundings& surroundings,
                                           bool opens_devices) const override {
    ProbeReport report = BeginReport();
    const std::filesystem::path file = surroundings.root / kDefaultKey;
    const auto key = LoadKey(file);
    report.looked_for.push_back({"key", file.string(), key.has_value(), ""});
    if (!key) {
      report.problems.push_back(key.error());
      return report;
    }
    // Only tried here: whoever opens the device binds it again.
    const auto bound = DatagramSocket::Bind(kDefaultHost, kDefaultPort).map([](auto&&) {});
    report.looked_for.push_back(
        {"free port", fmt::format("UDP {}:{}", kDefaultHost, kDefaultPort), bound.has_value(), ""});
    if (!bound) {
      report.problems.push_back(bound.error());
    }
    return opens_devices && bound ? Wait(std::move(report), surroundings) : report;
  }

  [[nodiscard]] Result<std::unique_ptr<Device>> OpenUnchecked(
      const std::string& text, const Surroundings& surroundings) const override {
    const auto address = ParseAddress(text, surroundings);
    if (!address) {
      return Unexpected(address.error());
    }
    const auto key = LoadKey(address->key);
    if (!key) {
      return Unexpected(key.error());
    }
    auto socket = DatagramSocket::Bind(address->host, address->port);
    if (!socket) {
      return Unexpected(socket.error());
    }
    auto device = std::make_unique<NetworkDevice>(std::move(*socket), *key, *surroundings.clock);
    if (!device->WaitForHello(kHelloTimeout_ms, text)) {
      return Fail(ErrorCode::kNotFound,
                  fmt::format("no device connected within {} s{}", 1e-3 * kHelloTimeout_ms,
                              RefusedInWords(device->counts())),
                  fmt::format("UDP {}:{}", address->host, address->port),
                  "start the device's program, with this address and the same key");
    }
    return device;
  }

 private:
  [[nodiscard]] ProbeReport Wait(ProbeReport report, const Surroundings& surroundings) const {
    if (const auto device = Open("", surroundings)) {
      report.devices.push_back((*device)->info());
    } else {
      report.problems.push_back(device.error());
    }
    return report;
  }
};

}  // namespace

const Driver& NetworkDriver() {
  static const Network driver;
  return driver;
}

}  // namespace hvas::device
