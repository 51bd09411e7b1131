#include "record/packing.h"

#include <array>
#include <cmath>
#include <cstring>
#include <set>

#include <gtest/gtest.h>

#include "record/test/sample.h"

namespace hvas::record {
namespace {

using Bytes = std::array<std::byte, kPackedTickSize>;

Bytes PackOne(const TickRecord& tick) {
  Bytes bytes{};
  Pack(tick, bytes);
  return bytes;
}

void ExpectEqual(const spatial::Pose& a, const spatial::Pose& b) {
  EXPECT_EQ(a.p(), b.p());
  EXPECT_EQ(a.q().coeffs(), b.q().coeffs());
}

void ExpectEqual(const spatial::Wrench& a, const spatial::Wrench& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.f, b.f);
}

TEST(Packing, BringsEveryFieldBackBitForBit) {
  for (int i = 0; i < 100; ++i) {
    const TickRecord tick = MakeTick(i);
    const TickRecord back = Unpack(PackOne(tick));
    EXPECT_EQ(back.t_ns, tick.t_ns);
    ExpectEqual(back.device_pose, tick.device_pose);
    EXPECT_EQ(back.device_twist.w, tick.device_twist.w);
    EXPECT_EQ(back.device_twist.v, tick.device_twist.v);
    EXPECT_EQ(back.device_flags, tick.device_flags);
    EXPECT_EQ(back.status, tick.status);
    ExpectEqual(back.X_WH, tick.X_WH);
    ExpectEqual(back.X_WD, tick.X_WD);
    ExpectEqual(back.F_true_W, tick.F_true_W);
    ExpectEqual(back.F_felt_W, tick.F_felt_W);
    EXPECT_EQ(back.held, tick.held);
    EXPECT_EQ(back.state, tick.state);
    EXPECT_EQ(back.contact_count, tick.contact_count);
    EXPECT_EQ(back.depth, tick.depth);
    EXPECT_EQ(back.deepest, tick.deepest);
    for (std::size_t k = 0; k < tick.contacts.size(); ++k) {
      EXPECT_EQ(back.contacts[k].p_WC, tick.contacts[k].p_WC);
      EXPECT_EQ(back.contacts[k].nhat_W, tick.contacts[k].nhat_W);
      EXPECT_EQ(back.contacts[k].distance, tick.contacts[k].distance);
    }
    EXPECT_EQ(back.hand, tick.hand);
    EXPECT_EQ(back.sample_ns, tick.sample_ns);
    EXPECT_EQ(back.device_buttons, tick.device_buttons);
    EXPECT_EQ(back.device_condition, tick.device_condition);
    EXPECT_EQ(back.vendor_code, tick.vendor_code);
    EXPECT_EQ(back.device_grip, tick.device_grip);
    EXPECT_EQ(back.model_age_ns, tick.model_age_ns);
    EXPECT_EQ(back.client_age_ns, tick.client_age_ns);
    EXPECT_EQ(back.effort_level, tick.effort_level);
    EXPECT_EQ(back.commands, tick.commands);
  }
}

// The layout is a file format: these offsets may not move without a new schema version.
TEST(Packing, PutsFieldsAtTheirPlacesLittleEndian) {
  TickRecord tick;
  tick.t_ns = 0x0102030405060708;
  tick.device_pose = spatial::Pose(Quat(0.5, 0.5, -0.5, 0.5), Vec3(1, 2, 3));
  tick.device_flags = 0x11223344;
  tick.hand = 9;
  tick.sample_ns = 0x0a0b0c0d0e0f1011;
  tick.effort_level = 3;
  tick.commands = 5;
  tick.held = 7;
  const Bytes bytes = PackOne(tick);
  EXPECT_EQ(bytes[0], std::byte{0x08});
  EXPECT_EQ(bytes[7], std::byte{0x01});
  const auto number = [&bytes](std::size_t offset) {
    double value = 0;
    std::memcpy(&value, &bytes[offset], sizeof(value));
    return value;
  };
  EXPECT_EQ(number(8), 1);  // p
  EXPECT_EQ(number(24), 3);
  EXPECT_EQ(number(32), 0.5);  // w of q first
  EXPECT_EQ(number(48), -0.5);
  EXPECT_EQ(bytes[112], std::byte{0x44});  // after the twist
  EXPECT_EQ(bytes[328], std::byte{0x07});  // after two poses and two wrenches
  EXPECT_EQ(bytes[407], std::byte{0x09});  // after the contacts: where schema 1 ended
  EXPECT_EQ(bytes[408], std::byte{0x11});
  EXPECT_EQ(bytes[449], std::byte{0x03});  // where schema 2 ended
  EXPECT_EQ(bytes[450], std::byte{0x05});
  EXPECT_EQ(PackedTickSize(1), 407u);
  EXPECT_EQ(PackedTickSize(2), 450u);
  EXPECT_EQ(PackedTickSize(3), bytes.size());
}

TEST(Packing, TickOfAnOlderSchemaIsTheBeginningOfThisOne) {
  const TickRecord tick = MakeTick(5);
  const Bytes bytes = PackOne(tick);
  const TickRecord back = Unpack(std::span(bytes).first(PackedTickSize(1)), 1);
  ExpectEqual(back.device_pose, tick.device_pose);
  ExpectEqual(back.X_WD, tick.X_WD);
  EXPECT_EQ(back.device_flags, tick.device_flags);
  EXPECT_EQ(back.contacts[1].distance, tick.contacts[1].distance);
  EXPECT_EQ(back.hand, 0) << "as a record of one hand means it";
  EXPECT_EQ(back.sample_ns, 0);
  EXPECT_EQ(back.device_condition, 0);
  EXPECT_TRUE(std::isnan(back.device_grip));
  const TickRecord second = Unpack(std::span(bytes).first(PackedTickSize(2)), 2);
  EXPECT_EQ(second.hand, tick.hand);
  EXPECT_EQ(second.effort_level, tick.effort_level);
  EXPECT_EQ(second.commands, 0u);
}

TEST(Packing, KeepsSpecialNumbers) {
  TickRecord tick;
  tick.depth = -0.0;
  const TickRecord back = Unpack(PackOne(tick));
  EXPECT_TRUE(std::signbit(back.depth));
  EXPECT_EQ(back.deepest, std::numeric_limits<double>::infinity());
  EXPECT_EQ(back.held, kNoOccurrence);
  EXPECT_TRUE(std::isnan(back.device_grip));
}

TEST(Packing, UsesEveryByte) {
  // Over many ticks every byte takes more than one value: none is padding.
  std::array<std::set<std::byte>, kPackedTickSize> seen;
  for (int i = 0; i < 300; ++i) {
    const Bytes bytes = PackOne(MakeTick(1000003 * i));
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      seen[k].insert(bytes[k]);
    }
  }
  for (std::size_t k = 8; k < seen.size(); ++k) {
    EXPECT_GT(seen[k].size(), 1u) << k;
  }
}

}  // namespace
}  // namespace hvas::record
