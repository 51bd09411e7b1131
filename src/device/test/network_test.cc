// The protocol of docs/devices/network.md, byte by byte, and what is refused (N8).
#include "device/drivers/network.h"

#include <sys/stat.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <openssl/crypto.h>
#include <openssl/hmac.h>

#include "base/test/temporary_folder.h"
#include "device/drivers/polled_guard.h"
#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using hvas::testing::TemporaryFolder;
using network::Refusal;
using testing::kTickNs;
using testing::OptionsOf;
using testing::Push;
using testing::WireRig;

std::atomic<int> openssl_allocations{0};

// Before OpenSSL allocates anything, which it then refuses.
const bool kCountsAllocations = CRYPTO_set_mem_functions(
                                    [](std::size_t size, const char*, int) {
                                      ++openssl_allocations;
                                      return std::malloc(size);
                                    },
                                    [](void* memory, std::size_t size, const char*, int) {
                                      ++openssl_allocations;
                                      return std::realloc(memory, size);
                                    },
                                    [](void* memory, const char*, int) { std::free(memory); }) == 1;

std::span<const std::byte> BytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

std::string HexOf(std::span<const std::byte> bytes) {
  std::string hex;
  for (const std::byte byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    hex += kDigits[static_cast<unsigned>(byte) >> 4U];
    hex += kDigits[static_cast<unsigned>(byte) & 15U];
  }
  return hex;
}

const network::PacketKey& Key() {
  static const network::PacketKey key("sixteen bytes...");
  return key;
}

TEST(PacketKeyTest, TagsAreThoseOfRfc4231) {
  EXPECT_EQ(HexOf(network::PacketKey(std::string(20, '\x0b')).Sign(BytesOf("Hi There"))),
            "b0344c61d8db38535ca8afceaf0bf12b");
  EXPECT_EQ(HexOf(network::PacketKey("Jefe").Sign(BytesOf("what do ya want for nothing?"))),
            "5bdcc146bf60754e6a042426089575c7");
  EXPECT_EQ(HexOf(network::PacketKey(std::string(131, '\xaa'))
                      .Sign(BytesOf("Test Using Larger Than Block-Size Key - Hash Key First"))),
            "60e431591ee0b67f0d8a26aacbf5b77f");
}

TEST(PacketKeyTest, TagsAreThoseOfOpenSslAndAreMadeWithoutAllocating) {
  ASSERT_TRUE(kCountsAllocations);
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    std::string secret(16 + static_cast<std::size_t>(random.Uniform(0, 100)), ' ');
    std::string text(static_cast<std::size_t>(random.Uniform(0, 500)), ' ');
    for (std::string* bytes : {&secret, &text}) {
      for (char& byte : *bytes) {
        byte = static_cast<char>(random.NextBits() & 0xFF);
      }
    }
    unsigned char expected[EVP_MAX_MD_SIZE];
    const int before = openssl_allocations;
    ASSERT_NE(
        HMAC(EVP_sha256(), secret.data(), static_cast<int>(secret.size()),
             reinterpret_cast<const unsigned char*>(text.data()), text.size(), expected, nullptr),
        nullptr);
    EXPECT_GT(openssl_allocations, before);  // why HVAS has its own
    const network::PacketKey key(secret);
    const int mine = openssl_allocations;
    const auto tag = key.Sign(BytesOf(text));
    EXPECT_EQ(openssl_allocations, mine);
    EXPECT_EQ(std::memcmp(tag.data(), expected, tag.size()), 0);
  }
}

TEST(PacketTest, AWrenchLiesAsTheSpecificationSays) {
  network::Header header;
  header.session = 0x1122334455667788;
  header.sequence = 2;
  header.t_ns = 3;
  network::WrenchPacket wrench;
  wrench.t = {1, 0, 0};
  wrench.f = {0, 0, -2};
  wrench.state_sequence = 5;
  const network::Packet packet = network::Seal(Key(), header, wrench);
  const std::string hex = HexOf(packet.bytes());
  EXPECT_EQ(hex.substr(0, hex.size() - 32),
            "48564e50"          // HVNP
            "01"                // version
            "04"                // wrench
            "6800"              // 104 bytes
            "8877665544332211"  // session
            "0200000000000000"  // sequence
            "0300000000000000"  // time
            "000000000000f03f0000000000000000"
            "0000000000000000"  // torque
            "00000000000000000000000000000000"
            "00000000000000c0"  // force
            "0500000000000000");
  const network::Opened opened = network::Open(Key(), packet.bytes());
  ASSERT_EQ(opened.refusal, Refusal::kNone);
  EXPECT_EQ(opened.header.session, header.session);
  network::WrenchPacket read;
  ASSERT_TRUE(network::Read(opened, &read));
  EXPECT_EQ(read.f, wrench.f);
  EXPECT_EQ(read.state_sequence, 5u);
}

TEST(PacketTest, EachTypeHasTheSizeOfTheSpecification) {
  EXPECT_EQ(network::Seal(Key(), {}, network::Hello{}).bytes().size(), 264u);
  EXPECT_EQ(network::Seal(Key(), {}, network::Welcome{}).bytes().size(), 56u);
  EXPECT_EQ(network::Seal(Key(), {}, network::StatePacket{}).bytes().size(), 200u);
  EXPECT_EQ(network::Seal(Key(), {}, network::WrenchPacket{}).bytes().size(), 104u);
  EXPECT_EQ(network::Seal(Key(), {}, network::Bye{}).bytes().size(), 48u);
}

TEST(PacketTest, EveryChangedBitAndEveryCutIsRefused) {
  const network::Packet packet = network::Seal(Key(), {}, network::StatePacket{});
  std::vector<std::byte> bytes(packet.bytes().begin(), packet.bytes().end());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_NE(network::Open(Key(), bytes).refusal, Refusal::kNone) << bit;
    bytes[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_NE(network::Open(Key(), std::span(bytes).first(size)).refusal, Refusal::kNone);
  }
  EXPECT_EQ(network::Open(Key(), bytes).refusal, Refusal::kNone);
  EXPECT_EQ(network::Open(network::PacketKey("another secret.."), bytes).refusal, Refusal::kForged);
  bytes[4] = std::byte{2};
  EXPECT_EQ(network::Open(Key(), bytes).refusal, Refusal::kOtherVersion);
}

TEST(SequenceWindowTest, TakesEachNumberOnceAndOnlyForwards) {
  network::SequenceWindow window;
  EXPECT_EQ(window.Take(0), Refusal::kReplayed);
  EXPECT_EQ(window.Take(1), Refusal::kNone);
  EXPECT_EQ(window.Take(1), Refusal::kReplayed);
  EXPECT_EQ(window.Take(5), Refusal::kNone);
  EXPECT_EQ(window.missing(), 3u);
  EXPECT_EQ(window.Take(3), Refusal::kLate);
  EXPECT_EQ(window.Take(3), Refusal::kReplayed);
  EXPECT_EQ(window.missing(), 2u);
  EXPECT_EQ(window.Take(200), Refusal::kNone);
  EXPECT_EQ(window.Take(4), Refusal::kReplayed);  // too old to know
  EXPECT_EQ(window.Take(137), Refusal::kLate);
}

/** A device's end written by hand: whatever one wants to send. */
class Forger {
 public:
  Forger() : socket_(Bind()) {
    DatagramSocket mine = Bind();
    host_ = *ParseEndpoint("127.0.0.1", mine.port());
    device_ = std::make_unique<NetworkDevice>(std::move(mine), Key(), clock_);
    Say(Hello(1));
    EXPECT_TRUE(device_->WaitForHello(2000, "test"));
    Listen();
  }

  static network::Hello Hello(std::uint64_t nonce) {
    DeviceInfo info;
    info.model = "Arm";
    info.serial = "7";
    info.profile = FindProfile("touch")->profile;
    info.capabilities.force_axes = 3;
    return network::HelloOf(info, nonce);
  }

  static DatagramSocket Bind() { return std::move(*DatagramSocket::Bind("127.0.0.1", 0)); }

  void Say(const network::Hello& hello) { Send(network::Seal(Key(), {}, hello)); }

  [[nodiscard]] static network::Packet State(std::uint64_t session, std::uint64_t sequence,
                                             double x = 0) {
    network::StatePacket state;
    state.p[0] = x;
    network::Header header;
    header.session = session;
    header.sequence = sequence;
    return network::Seal(Key(), header, state);
  }

  void Send(const network::Packet& packet) { socket_.Send(packet.bytes(), host_); }

  /** The session of the last welcome, and the last wrench. */
  void Listen() {
    std::array<std::byte, network::kMaxPacket> buffer;
    Endpoint sender;
    while (const auto bytes = socket_.Receive(buffer, &sender)) {
      const network::Opened opened = network::Open(Key(), *bytes);
      network::Welcome welcome;
      if (network::Read(opened, &welcome)) {
        session = opened.header.session;
      }
      wrench_count += network::Read(opened, &wrench) ? 1 : 0;
    }
  }

  DeviceState Tick() {
    clock_.Advance(kTickNs);
    return device_->Read();
  }

  [[nodiscard]] std::uint64_t Refused(Refusal refusal) const {
    return device_->counts().refused[static_cast<std::size_t>(refusal)];
  }

  NetworkDevice& device() { return *device_; }

  std::uint64_t session{0};
  network::WrenchPacket wrench;
  int wrench_count{0};

 private:
  DatagramSocket socket_;
  Endpoint host_;
  VirtualClock clock_;
  std::unique_ptr<NetworkDevice> device_;
};

TEST(NetworkDeviceTest, WhatTheHelloTellsIsWhatTheDeviceIs) {
  Forger forger;
  const DeviceInfo& info = forger.device().info();
  EXPECT_EQ(info.model, "Arm");
  EXPECT_EQ(info.serial, "7");
  EXPECT_FALSE(info.is_emulated);
  EXPECT_EQ(info.profile.max_force, FindProfile("touch")->profile.max_force);
  EXPECT_EQ(info.profile.max_torque, 0);
  EXPECT_NE(forger.session, 0u);
}

TEST(NetworkDeviceTest, ForeignReplayedLateAndForgedPacketsAreCountedAndChangeNothing) {
  Forger forger;
  forger.Send(Forger::State(forger.session, 10, 0.01));
  EXPECT_TRUE(forger.Tick().is_valid);
  forger.Send(Forger::State(forger.session, 10, 0.02));      // again
  forger.Send(Forger::State(forger.session, 9, 0.02));       // overtaken
  forger.Send(Forger::State(forger.session + 1, 11, 0.02));  // another session
  forger.Send(network::Seal(network::PacketKey("another secret.."), {}, network::StatePacket{}));
  network::Header reflected;
  reflected.session = forger.session;
  reflected.sequence = 13;
  forger.Send(network::Seal(Key(), reflected, network::WrenchPacket{}));  // HVAS's own type
  const DeviceState state = forger.Tick();
  EXPECT_EQ(state.X_DH.p().x(), 0.01);
  EXPECT_EQ(forger.Refused(Refusal::kReplayed), 1u);
  EXPECT_EQ(forger.Refused(Refusal::kLate), 1u);
  EXPECT_EQ(forger.Refused(Refusal::kForeignSession), 1u);
  EXPECT_EQ(forger.Refused(Refusal::kForged), 1u);
  EXPECT_EQ(forger.Refused(Refusal::kMalformed), 1u);
  EXPECT_EQ(forger.device().counts().states, 1u);
  EXPECT_EQ(forger.device().counts().states_lost, 8u);
  const std::string words = forger.device().Explain(state);
  EXPECT_NE(words.find("1 with another key"), std::string::npos) << words;
}

TEST(NetworkDeviceTest, ARecordedHelloDoesNotEndTheSession) {
  Forger forger;
  const std::uint64_t session = forger.session;
  forger.Send(Forger::State(session, 1));
  EXPECT_TRUE(forger.Tick().is_valid);
  forger.Say(Forger::Hello(2));
  forger.Send(Forger::State(session, 2));
  EXPECT_TRUE(forger.Tick().is_valid);
  forger.Listen();
  EXPECT_NE(forger.session, session);  // offered, but taken only by a state in it
  forger.Send(Forger::State(forger.session, 1));
  EXPECT_TRUE(forger.Tick().is_valid);
  forger.Send(Forger::State(session, 3));
  (void)forger.Tick();
  EXPECT_EQ(forger.Refused(Refusal::kForeignSession), 1u);
}

TEST(NetworkDeviceTest, AnotherDeviceIsNotTakenForThisOne) {
  Forger forger;
  network::Hello other = Forger::Hello(2);
  other.serial[0] = '8';
  forger.Say(other);
  (void)forger.Tick();
  EXPECT_EQ(forger.Refused(Refusal::kForeignSession), 1u);
}

TEST(NetworkDeviceTest, AWrenchIsSentOnlyAfterAStateThatIsReady) {
  Forger forger;
  (void)forger.Tick();
  forger.device().Write(Push(1));
  forger.Listen();
  EXPECT_EQ(forger.wrench_count, 0);  // no session yet
  forger.Send(Forger::State(forger.session, 1));
  EXPECT_EQ(forger.Tick().condition, Condition::kReady);
  forger.device().Write(Push(1));
  forger.Listen();
  EXPECT_EQ(forger.wrench.f[0], 1);
  EXPECT_EQ(forger.wrench.state_sequence, 1u);
  for (int i = 0; i < 5; ++i) {
    (void)forger.Tick();
    forger.device().Write(Push(1));
  }
  forger.Listen();
  EXPECT_EQ(forger.wrench.f[0], 0);
  forger.device().Write(Push(1e9));
  forger.Listen();
  EXPECT_EQ(forger.wrench.f[0], 0);
}

TEST(NetworkDeviceTest, LossAndAgeAreCountedInBothDirections) {
  WireRig rig(NetworkDriver(), OptionsOf("network"));
  ASSERT_TRUE(rig.is_open());
  rig.Run(100, Push(0.5));
  const auto* device = dynamic_cast<NetworkDevice*>(&rig.device());
  ASSERT_NE(device, nullptr);
  const LinkCounts counts = device->counts();
  EXPECT_GE(counts.states, 98u);
  EXPECT_EQ(counts.states_lost, 0u);
  EXPECT_EQ(counts.wrenches_lost, 0u);
  EXPECT_EQ(counts.round_trip_ns, kTickNs);
  EXPECT_NE(device->Explain(rig.Run(1)).find("lost 0.0 %"), std::string::npos);
}

std::string ErrorOf(const std::string& address) {
  const auto device = NetworkDriver().Open(address, {});
  EXPECT_FALSE(device);
  return device ? "" : device.error().ToString();
}

TEST(NetworkDriverTest, KeysThatAreMissingReadableByOthersOrShortAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("network.key", "a long enough secret\n");
  const auto expect = [&](const std::string& part) {
    const std::string error = ErrorOf("127.0.0.1:1?key=" + file);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  ::chmod(file.c_str(), 0640);
  expect("other users can read this key");
  expect("chmod 600");
  ::chmod(file.c_str(), 0600);
  folder.Write("network.key", "short");
  expect("this key has 5 bytes");
  std::filesystem::remove(file);
  expect("there is no key");
}

TEST(NetworkDriverTest, AddressesThatCannotBeAreExplained) {
  EXPECT_NE(ErrorOf("127.0.0.1:70000").find("\"70000\" is not a port"), std::string::npos);
  EXPECT_NE(ErrorOf("1?kee=x").find("\"kee=x\" is not an option"), std::string::npos);
  const TemporaryFolder folder;
  const std::string key = "?key=" + folder.Write("k", "a long enough secret").string();
  ::chmod((folder / "k").string().c_str(), 0600);
  EXPECT_NE(ErrorOf("here:2000" + key).find("is not an IPv4 address"), std::string::npos);
  const auto taken = DatagramSocket::Bind("127.0.0.1", 0);
  ASSERT_TRUE(taken);
  const std::string port = std::to_string(taken->port());
  EXPECT_NE(ErrorOf(port + key).find("another program uses this port"), std::string::npos);
}

TEST(NetworkDriverTest, WithoutADeviceItSaysThatNobodySaidHello) {
  const TemporaryFolder folder;
  const std::string key = folder.Write("k", "a long enough secret");
  ::chmod(key.c_str(), 0600);
  const std::uint16_t port = DatagramSocket::Bind("127.0.0.1", 0)->port();
  const std::string error = ErrorOf(std::to_string(port) + "?key=" + key);
  EXPECT_NE(error.find("no device connected within 1.5 s"), std::string::npos) << error;
}

TEST(NetworkDriverTest, ProbingNamesTheKeyThatIsLookedFor) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  surroundings.root = folder.path();
  ProbeReport report = NetworkDriver().Probe(surroundings, false);
  ASSERT_EQ(report.problems.size(), 1u);
  EXPECT_EQ(report.problems[0].where, (folder / "etc/hvas/network.key").string());
  EXPECT_NE(report.problems[0].remedy.find("/dev/urandom"), std::string::npos);
  ::chmod(folder.Write("etc/hvas/network.key", "a long enough secret").c_str(), 0600);
  report = NetworkDriver().Probe(surroundings, false);
  ASSERT_EQ(report.looked_for.size(), 2u);
  EXPECT_TRUE(report.looked_for[0].is_found);
}

TEST(NetworkDriverTest, ProbingDoesNotStandInItsOwnWay) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  surroundings.root = folder.path();
  ::chmod(folder.Write("etc/hvas/network.key", "a long enough secret").c_str(), 0600);
  const ProbeReport report = NetworkDriver().Probe(surroundings, true);
  ASSERT_EQ(report.problems.size(), 1u);
  const std::string problem = report.problems[0].ToString();
  const bool is_taken_by_another = !report.looked_for[1].is_found;
  EXPECT_EQ(problem.find("another program uses this port") != std::string::npos,
            is_taken_by_another)
      << problem;
}

}  // namespace
}  // namespace hvas::device
