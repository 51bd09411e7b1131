#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/test/temporary_folder.h"
#include "record/recorder.h"
#include "record/tick_record.h"

namespace hvas::record {

inline constexpr std::int64_t kTickNs = 1'000'000;

/** A tick with every field set, decided by its number alone. */
inline TickRecord MakeTick(std::int64_t number) {
  Random random(static_cast<std::uint64_t>(number) + 1);
  const auto vector = [&random] {
    const double x = random.Uniform(-1, 1);
    const double y = random.Uniform(-1, 1);
    return Vec3(x, y, random.Uniform(-1, 1));
  };
  const auto pose = [&] {
    const Vec3 p = vector();
    const Vec3 v = vector();
    return spatial::Pose(Quat(random.Uniform(-1, 1), v.x(), v.y(), v.z()).normalized(), p);
  };
  TickRecord tick;
  tick.t_ns = number * kTickNs;
  tick.device_pose = pose();
  tick.device_twist = {vector(), vector()};
  tick.device_flags = static_cast<std::uint32_t>(random.NextBits());
  tick.status = static_cast<std::uint32_t>(random.NextBits());
  tick.X_WH = pose();
  tick.X_WD = pose();
  tick.F_true_W = {vector(), vector()};
  tick.F_felt_W = {vector(), vector()};
  tick.held = static_cast<std::uint32_t>(random.NextBits());
  tick.state = static_cast<std::uint8_t>(random.NextBits());
  tick.contact_count = static_cast<std::uint16_t>(random.NextBits());
  tick.depth = random.Uniform(-1, 1);
  tick.deepest = random.Uniform(-1, 1);
  for (ContactRecord& contact : tick.contacts) {
    contact.p_WC = vector().cast<float>();
    contact.nhat_W = vector().cast<float>();
    contact.distance = static_cast<float>(random.Uniform(-1, 1));
  }
  tick.hand = static_cast<std::uint8_t>(random.NextBits());
  tick.sample_ns = static_cast<std::int64_t>(random.NextBits());
  tick.device_buttons = static_cast<std::uint32_t>(random.NextBits());
  tick.device_condition = static_cast<std::uint8_t>(random.NextBits());
  tick.vendor_code = static_cast<std::int32_t>(random.NextBits());
  tick.device_grip = random.Uniform(-1, 1);
  tick.model_age_ns = static_cast<std::int64_t>(random.NextBits());
  tick.client_age_ns = static_cast<std::int64_t>(random.NextBits());
  tick.effort_level = static_cast<std::uint8_t>(random.NextBits());
  tick.commands = static_cast<std::uint32_t>(random.NextBits());
  return tick;
}

inline Event MakeEvent(std::int64_t number) {
  return {number * kTickNs, number % 2 == 0 ? "seated" : "captured",
          number % 3 == 0 ? kNoOccurrence : static_cast<std::uint32_t>(number),
          "{\"depth_mm\": " + std::to_string(number) + ", \"name\": \"Büchse\"}"};
}

inline Command MakeCommand(std::int64_t number) {
  return {number * kTickNs, number, number == 0 ? "begin" : "take",
          "{\"occurrence\": " + std::to_string(number) + ", \"x_m\": 0.1}"};
}

inline std::vector<std::byte> MakeBytes(std::int64_t number, std::size_t size) {
  Random random(static_cast<std::uint64_t>(number) + 1);
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(random.NextBits());
  }
  return bytes;
}

inline Frame MakeFrame(std::int64_t number) {
  return {number * kTickNs, MakeBytes(number, 200 + static_cast<std::size_t>(number % 100))};
}

/** Writes a finished record: ticks, three of each other kind, and an attachment "product". */
inline void WriteSampleRecord(const std::filesystem::path& path, const Meta& meta, int ticks) {
  const auto recorder = Recorder::Create({path}, meta);
  for (int i = 0; i < ticks; ++i) {
    (*recorder)->AddTick(MakeTick(i));
  }
  for (int i = 0; i < 3; ++i) {
    (*recorder)->AddEvent(MakeEvent(i));
    (*recorder)->AddCommand(MakeCommand(i));
    (*recorder)->AddFrame(MakeFrame(i));
  }
  (*recorder)->AddAttachment({"product", MakeBytes(1, 1000)});
  EXPECT_TRUE((*recorder)->Finish().has_value());
}

/** A file name in a folder of its own, removed with its side files at the end. */
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name) : path_(folder_ / name) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  testing::TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace hvas::record
