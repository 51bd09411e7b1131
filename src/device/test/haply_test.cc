// The Inverse Service: what is said in both dialects, and conversations with services old, new,
// gone and come back (N8).
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "device/drivers/haply_messages.h"
#include "device/drivers/websocket.h"
#include "device/emulation/haply_server.h"
#include "device/test/wire_rig.h"

namespace hvas::device {
namespace {

using haply::Dialect;
using testing::kTickNs;
using testing::OptionsOf;
using testing::Push;
using testing::WireRig;

TEST(HaplyMessagesTest, AForceIsWrittenInBothDialects) {
  EXPECT_EQ(
      haply::ForceMessage(Dialect::kVector, "049D", Vec3(0, 0, 1.5), true),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"vector":{"x":0.0,"y":0.0,"z":1.5}}},)"
      R"("device_id":"049D"}],"session":{"configure":{"profile":{"name":"org.hvas:assembly"}}}})");
  EXPECT_EQ(
      haply::ForceMessage(Dialect::kValues, "049D", Vec3(-1, 0, 0), false),
      R"({"inverse3":[{"commands":{"set_cursor_force":{"values":{"x":-1.0,"y":0.0,"z":0.0}}},)"
      R"("device_id":"049D"}]})");
  EXPECT_EQ(haply::FullStateMessage(), R"({"session":{"force_render_full_state":{}}})");
}

TEST(HaplyMessagesTest, TheVersionTellsTheDialect) {
  EXPECT_EQ(haply::DialectOf("3.5.0"), Dialect::kVector);
  EXPECT_EQ(haply::DialectOf("3.10"), Dialect::kVector);
  EXPECT_EQ(haply::DialectOf("4.0.1"), Dialect::kVector);
  EXPECT_EQ(haply::DialectOf("3.1.2"), Dialect::kValues);
  EXPECT_EQ(haply::DialectOf("2.9"), Dialect::kValues);
  for (const char* none : {"", "new", "3", "3.", ".5"}) {
    EXPECT_EQ(haply::DialectOf(none), std::nullopt) << none;
  }
}

TEST(HaplyMessagesTest, AStateIsReadWithDefaultsForWhatIsLeftOut) {
  const haply::Message message = haply::ParseMessage(
      R"({"session":{"version":"3.5.1"},
          "inverse3":[{"device_id":"1111"},
                      {"device_id":"049D","state":{"cursor_position":{"x":0.1,"z":-0.2},
                                                   "cursor_velocity":{"y":1},
                                                   "current_cursor_force":{}}}],
          "wireless_verse_grip":[{"state":{"orientation":{"x":1.0},"buttons":{"a":true,"c":true}}}]})",
      "049D");
  EXPECT_TRUE(message.is_readable && message.has_device && message.has_handle);
  EXPECT_EQ(message.version, "3.5.1");
  EXPECT_EQ(message.device_id, "049D");
  EXPECT_EQ(message.p, Vec3(0.1, 0, -0.2));
  EXPECT_EQ(message.v, Vec3(0, 1, 0));
  EXPECT_EQ(message.force, Vec3(0, 0, 0));
  EXPECT_EQ(message.q.coeffs(), Quat(0, 1, 0, 0).coeffs());
  EXPECT_EQ(message.buttons, 5u);
  EXPECT_FALSE(message.is_emulated);
  const haply::Message plain = haply::ParseMessage(R"({"inverse3":[{"device_id":"2"}]})", "");
  EXPECT_TRUE(plain.has_device && plain.is_calibrated && plain.has_power);
  EXPECT_FALSE(plain.has_handle || plain.force.has_value());
  EXPECT_EQ(plain.q.w(), 1);
}

TEST(HaplyMessagesTest, WhatIsNoStateIsNotTakenForOne) {
  for (const char* text : {"", "[", "[]", "7", "null", "{\"inverse3\":7}", "{\"inverse3\":[]}",
                           "{\"inverse3\":[7]}", "{\"inverse3\":[{\"device_id\":\"other\"}]}"}) {
    EXPECT_FALSE(haply::ParseMessage(text, "049D").has_device) << text;
  }
  const haply::Message message =
      haply::ParseMessage(R"({"inverse3":[{"state":{"cursor_position":{"x":null}}}]})", "");
  EXPECT_TRUE(std::isnan(message.p.x()));
}

TEST(HaplyTest, TheHandleTurnsAndHasButtons) {
  EmulatorOptions options = OptionsOf("inverse3");
  options.profile.rotation_resolution = 1e-4;
  options.X_DH = {spatial::RotationFromVector(Vec3(0, 0, 0.5)), Vec3(0.01, 0.02, 0.03)};
  WireRig rig(HaplyDriver(), options);
  ASSERT_TRUE(rig.is_open());
  const DeviceInfo& info = rig.device().info();
  EXPECT_EQ(info.version, "3.5.0");
  EXPECT_TRUE(info.is_emulated && info.capabilities.senses_rotation);
  EXPECT_EQ(info.capabilities.torque_axes, 0);
  HandIntent hand;
  hand.X_DR = options.X_DH;
  hand.buttons = 2;
  rig.hardware().SetHand(hand);
  const DeviceState state = rig.Run(20);
  EXPECT_TRUE(state.is_clutching && !state.is_gripping);
  EXPECT_NEAR(spatial::RotationVector(state.X_DH.q()).z(), 0.5, 1e-3);
  EXPECT_LT((state.X_DH.p() - options.X_DH.p()).norm(), 1e-4);
}

TEST(HaplyTest,
     AnOldServiceIsFoundOutBySilentMotors) {  // no version, "values", empty list at first
  WireRig rig(HaplyDriver(), OptionsOf("inverse3"), MakeOldHaplyServer);
  ASSERT_TRUE(rig.is_open());
  EXPECT_EQ(rig.device().info().version, "");
  HandIntent hand;
  hand.stiffness = 3000;
  rig.hardware().SetHand(hand);
  rig.Run(20, Push(1));
  EXPECT_EQ(rig.truth().F_H_D.f.norm(), 0);
  rig.Run(40, Push(1));
  EXPECT_NEAR(rig.truth().F_H_D.f.x(), 1, 1e-9);
}

TEST(HaplyTest, AServiceThatRestartsIsFoundAgain) {
  auto server = WebSocketServer::Listen(0);
  ASSERT_TRUE(server);
  const std::uint16_t port = (*server)->port();
  const auto answer = [](const std::string&) -> std::optional<std::string> {
    return R"({"inverse3":[{"device_id":"1"}]})";
  };
  const auto greet = [answer] { return *answer(""); };
  std::atomic<bool> stops{false};
  std::atomic<bool> is_down{false};
  std::thread service([&] {
    while (!stops) {
      if (is_down && *server != nullptr) {
        (*server)->Drop();
        server->reset();
      } else if (!is_down && *server == nullptr) {
        server = WebSocketServer::Listen(port);
      } else if (*server != nullptr) {
        (*server)->Serve(greet, answer);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  VirtualClock clock;
  Surroundings surroundings;
  surroundings.clock = &clock;
  const auto device = HaplyDriver().Open("localhost:" + std::to_string(port), surroundings);
  ASSERT_TRUE(device) << device.error().ToString();
  const auto run_until = [&](Condition condition) {
    constexpr int kLimit = 20000;  // of ticks; nothing here depends on how fast the thread is
    for (int i = 0; i < kLimit; ++i) {
      clock.Advance(kTickNs);
      if ((*device)->Read().condition == condition) {
        return true;
      }
      (*device)->Write({});
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return false;
  };
  EXPECT_TRUE(run_until(Condition::kReady));
  is_down = true;
  EXPECT_TRUE(run_until(Condition::kLost));
  is_down = false;
  EXPECT_TRUE(run_until(Condition::kReady));
  stops = true;
  service.join();
}

std::string ErrorOf(const std::string& address) {
  const auto device = HaplyDriver().Open(address, {});
  EXPECT_FALSE(device);
  return device ? "" : device.error().ToString();
}

TEST(HaplyDriverTest, WithoutAServiceItSaysWhichOneItAskedForAndWhatToDo) {
  auto server = WebSocketServer::Listen(0);
  ASSERT_TRUE(server);
  const std::string port = std::to_string((*server)->port());
  server->reset();
  const std::string error = ErrorOf("localhost:" + port);
  EXPECT_NE(error.find("ws://localhost:" + port), std::string::npos) << error;
  EXPECT_NE(error.find("the Inverse Service is not running"), std::string::npos) << error;
  EXPECT_NE(error.find("start Haply's Inverse Service"), std::string::npos) << error;
  EXPECT_NE(ErrorOf("localhost:haply").find("is not a port"), std::string::npos);
}

TEST(HaplyDriverTest, AServiceWithoutThisDeviceSaysSo) {
  auto emulator = StartWireEmulator("haply", OptionsOf("inverse3"));
  ASSERT_TRUE(emulator);
  const std::string address = (*emulator)->address().substr(6);
  EXPECT_NE(ErrorOf(address + "/0000").find("has no device \"0000\""), std::string::npos);
  (*emulator)->device().SetFault(Fault::kUnplugged);
  EXPECT_NE(ErrorOf(address).find("no Inverse3 is connected"), std::string::npos);
}

TEST(HaplyDriverTest, ProbingNamesBothPorts) {  // on a machine without the service
  const ProbeReport report = HaplyDriver().Probe({}, false);
  ASSERT_GE(report.looked_for.size(), 1u);
  EXPECT_EQ(report.looked_for[0].where, "ws://localhost:10001");
  if (!report.looked_for[0].is_found) {
    ASSERT_EQ(report.looked_for.size(), 2u);
    EXPECT_EQ(report.looked_for[1].where, "ws://localhost:10000");
    EXPECT_EQ(report.problems.size(), 1u);
  }
}

}  // namespace
}  // namespace hvas::device
