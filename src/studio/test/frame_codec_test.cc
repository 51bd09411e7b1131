#include "studio/frame_codec.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "studio/frames.h"

namespace hvas::studio {
namespace {

using protocol::Acknowledgement;
using protocol::HandInput;

// What tools/protocol/generate.py writes into every golden file.
constexpr std::uint32_t kSeq = 7;
constexpr std::uint32_t kEpoch = 3;
constexpr std::int64_t kTimeNs = 1'234'567'890'123;

std::string Golden(const std::string& name) {
  std::ifstream file(std::string(HVAS_GOLDEN_FRAMES) + "/" + name + ".bin", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/** Item i of a golden file: start, start + 0.5, ..., whole where the field is. */
template <std::size_t N>
std::array<float, N> Climb(float first) {
  std::array<float, N> values{};
  for (std::size_t k = 0; k < N; ++k) {
    values[k] = first + 0.5F * static_cast<float>(k);
  }
  return values;
}

template <typename Item>
std::string Frame(std::span<const Item> items) {
  std::string bytes;
  AppendFrame<Item>(items, kSeq, kEpoch, kTimeNs, &bytes);
  return bytes;
}

HandInput PlainInput() {
  HandInput input;
  input.buttons = 1;
  input.p_WH_m = {0.1F, -0.2F, 0.3F};
  input.q_WH = {1, 0, 0, 0};
  input.client_ms = 20;
  return input;
}

std::string InputFrame(const HandInput& input) {
  return Frame<HandInput>(std::span(&input, 1));
}

std::string CreditFrame(std::uint32_t seq) {
  const Acknowledgement credit{seq};
  return Frame<Acknowledgement>(std::span(&credit, 1));
}

protocol::Header HeaderOf(const std::string& bytes) {
  protocol::Header header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

std::string WithHeader(std::string bytes, const protocol::Header& header) {
  std::memcpy(bytes.data(), &header, sizeof(header));
  return bytes;
}

TEST(FrameCodecTest, PosesAreTheGoldenBytes) {
  std::vector<protocol::BodyPose> poses(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const float first = 1 + 100 * static_cast<float>(i);
    poses[i] = {1 + 100 * i, Climb<3>(first + 0.5F), Climb<4>(first + 2)};
  }
  const std::string golden = Golden("poses");
  ASSERT_FALSE(golden.empty());
  EXPECT_EQ(Frame<protocol::BodyPose>(poses), golden);
}

TEST(FrameCodecTest, HandsAreTheGoldenBytes) {
  std::vector<protocol::HandState> hands(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const float first = 1 + 100 * static_cast<float>(i);
    float next = first;
    const auto whole = [&next] {
      next += 0.5F;
      return static_cast<std::uint32_t>(next - 0.5F);
    };
    const auto number = [&next] {
      next += 0.5F;
      return next - 0.5F;
    };
    const auto three = [&next] {
      next += 1.5F;
      return Climb<3>(next - 1.5F);
    };
    const auto four = [&next] {
      next += 2;
      return Climb<4>(next - 2);
    };
    protocol::HandState& hand = hands[i];
    hand.hand = whole();
    hand.state = whole();
    hand.occurrence = whole();
    hand.mate = whole();
    hand.gate_actions = whole();
    hand.contact_count = whole();
    hand.p_WH_m = three();
    hand.q_WH = four();
    hand.p_WT_m = three();
    hand.q_WT = four();
    hand.p_WD_m = three();
    hand.q_WD = four();
    hand.f_felt_W_n = three();
    hand.t_felt_W_nm = three();
    hand.f_true_W_n = three();
    hand.t_true_W_nm = three();
    hand.peak_felt_n = number();
    hand.axial_true_n = number();
    hand.axial_felt_n = number();
    hand.depth_m = number();
    hand.depth_goal_m = number();
    hand.tilt_rad = number();
    hand.offset_m = number();
    hand.penetration_m = number();
    hand.p_WAxis_m = three();
    hand.axis_W = three();
  }
  const std::string golden = Golden("hands");
  ASSERT_FALSE(golden.empty());
  EXPECT_EQ(Frame<protocol::HandState>(hands), golden);
}

TEST(FrameCodecTest, DeformationsAreTheGoldenBytes) {
  const std::vector<protocol::Deformation> deformations{{1, 1.5F}, {101, 101.5F}};
  const std::string golden = Golden("deformations");
  ASSERT_FALSE(golden.empty());
  EXPECT_EQ(Frame<protocol::Deformation>(deformations), golden);
}

/** The deformations of the next message to a client. */
std::vector<protocol::Deformation> ListSent(const std::vector<double>& amounts, ShownState* shown) {
  LiveFrame frame;
  frame.deformations = amounts;
  std::string bytes = MakeFrames(frame, kTimeNs, kSeq, shown);
  std::vector<protocol::Deformation> sent;
  while (!bytes.empty()) {
    const protocol::Header header = HeaderOf(bytes);
    if (header.kind == static_cast<std::uint16_t>(protocol::FrameKind::kDeformations)) {
      sent.resize(header.count);
      std::memcpy(sent.data(), bytes.data() + sizeof(header),
                  header.count * sizeof(protocol::Deformation));
    }
    bytes.erase(0, header.size);
  }
  return sent;
}

TEST(FrameCodecTest, DeformationsAreSentAtFirstAllAndThenWhereTheyLookDifferent) {
  ShownState shown;
  EXPECT_TRUE(ListSent({}, &shown).empty());
  EXPECT_EQ(ListSent({0, 1e-3, 0}, &shown).size(), 3U);
  EXPECT_TRUE(ListSent({0, 1e-3 + 0.9e-6, 0}, &shown).empty());
  const auto changed = ListSent({0, 1e-3 + 1.1e-6, 2e-6}, &shown);
  ASSERT_EQ(changed.size(), 2U);
  EXPECT_EQ(changed[0].index, 1U);
  EXPECT_FLOAT_EQ(changed[0].amount_m, 1.0011e-3F);
  EXPECT_EQ(changed[1].index, 2U);
  // What is as drawn again is told, by however little it was deformed.
  EXPECT_EQ(ListSent({0, 1e-3 + 1.1e-6, 0}, &shown).size(), 1U);
  // Slow changes add up.
  int messages = 0;
  for (int i = 0; i <= 100; ++i) {
    messages += ListSent({0, 1e-3 + 1.1e-6, i * 0.1e-6}, &shown).empty() ? 0 : 1;
  }
  EXPECT_NEAR(messages, 10, 1);
}

TEST(FrameCodecTest, ContactsAreTheGoldenBytes) {
  std::vector<protocol::ContactPoint> contacts(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const float first = 1 + 100 * static_cast<float>(i);
    contacts[i] = {1 + 100 * i, 1 + 100 * i, Climb<3>(first + 1), Climb<3>(first + 2.5F)};
  }
  const std::string golden = Golden("contacts");
  ASSERT_FALSE(golden.empty());
  EXPECT_EQ(Frame<protocol::ContactPoint>(contacts), golden);
}

TEST(FrameCodecTest, GoldenCreditIsRead) {
  const auto frames = ReadClientFrames(Golden("credit"));
  ASSERT_TRUE(frames) << frames.error().ToString();
  ASSERT_EQ(frames->credits.size(), 2u);
  EXPECT_EQ(frames->credits[0].seq, 1u);
  EXPECT_EQ(frames->credits[1].seq, 101u);
  EXPECT_TRUE(frames->inputs.empty());
}

/** The golden input with rotations of length one, where the file counts on. */
TEST(FrameCodecTest, GoldenInputIsRead) {
  std::string bytes = Golden("input");
  ASSERT_EQ(bytes.size(), sizeof(protocol::Header) + 2 * sizeof(HandInput));
  EXPECT_FALSE(ReadClientFrames(bytes)) << "(3.5, 4, ...) is no rotation";
  const std::array<float, 4> unit{0.5F, -0.5F, 0.5F, -0.5F};
  for (std::size_t i = 0; i < 2; ++i) {
    std::memcpy(
        bytes.data() + sizeof(protocol::Header) + i * sizeof(HandInput) + offsetof(HandInput, q_WH),
        unit.data(), sizeof(unit));
  }
  const auto frames = ReadClientFrames(bytes);
  ASSERT_TRUE(frames) << frames.error().ToString();
  ASSERT_EQ(frames->inputs.size(), 2u);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const HandInput& input = frames->inputs[i];
    const float first = 1 + 100 * static_cast<float>(i);
    EXPECT_EQ(input.hand, 1 + 100 * i);
    EXPECT_EQ(input.buttons, 1 + 100 * i);
    EXPECT_EQ(input.p_WH_m, Climb<3>(first + 1));
    EXPECT_EQ(input.q_WH, unit);
    EXPECT_EQ(input.client_ms, first + 4.5F);
  }
}

TEST(FrameCodecTest, FrameWithoutItemsIsAHeader) {
  EXPECT_EQ(Frame<protocol::BodyPose>({}).size(), sizeof(protocol::Header));
  const auto frames = ReadClientFrames(Frame<HandInput>({}));
  ASSERT_TRUE(frames);
  EXPECT_TRUE(frames->inputs.empty());
}

TEST(FrameCodecTest, SeveralFramesComeInOneMessage) {
  HandInput later = PlainInput();
  later.client_ms = 30;
  const auto frames = ReadClientFrames(InputFrame(PlainInput()) + CreditFrame(4) +
                                       InputFrame(later) + CreditFrame(5));
  ASSERT_TRUE(frames) << frames.error().ToString();
  ASSERT_EQ(frames->inputs.size(), 2u);
  EXPECT_EQ(frames->inputs[1].client_ms, 30);
  ASSERT_EQ(frames->credits.size(), 2u);
  EXPECT_EQ(frames->credits[1].seq, 5u);
}

TEST(FrameCodecTest, UnknownKindIsPassedOverByItsSize) {
  std::string unknown = InputFrame(PlainInput());
  protocol::Header header = HeaderOf(unknown);
  header.kind = 999;
  header.count = 1'000'000;  // of items whose size nobody knows
  unknown = WithHeader(unknown, header);
  const auto frames = ReadClientFrames(unknown + CreditFrame(5));
  ASSERT_TRUE(frames) << frames.error().ToString();
  EXPECT_TRUE(frames->inputs.empty());
  ASSERT_EQ(frames->credits.size(), 1u);
  EXPECT_EQ(frames->credits[0].seq, 5u);
}

TEST(FrameCodecTest, EveryCutMessageIsRefused) {
  const std::string whole = InputFrame(PlainInput()) + CreditFrame(5);
  const std::size_t first = InputFrame(PlainInput()).size();
  for (std::size_t size = 1; size < whole.size(); ++size) {
    EXPECT_EQ(ReadClientFrames(whole.substr(0, size)).has_value(), size == first) << size;
  }
  EXPECT_TRUE(ReadClientFrames(whole));
  EXPECT_FALSE(ReadClientFrames(whole + "H"));
}

TEST(FrameCodecTest, WrongHeaderIsRefused) {
  const std::string good = CreditFrame(5);
  const auto refuses = [&good](auto change) {
    protocol::Header header = HeaderOf(good);
    change(&header);
    const auto frames = ReadClientFrames(WithHeader(good, header));
    return !frames && frames.error().code == ErrorCode::kInvalid && !frames.error().remedy.empty();
  };
  EXPECT_TRUE(refuses([](auto* h) { h->magic += 1; }));
  EXPECT_TRUE(refuses([](auto* h) { h->version = protocol::kVersion + 1; }));
  EXPECT_TRUE(refuses([](auto* h) { h->version = 0; }));
  EXPECT_TRUE(refuses([](auto* h) { h->size += 1; }));  // more than came
  EXPECT_TRUE(refuses([](auto* h) { h->size = std::numeric_limits<std::uint32_t>::max(); }));
  EXPECT_TRUE(refuses([](auto* h) { h->size = 0; }));  // would never end
  EXPECT_TRUE(refuses([](auto* h) { h->size = sizeof(protocol::Header) - 1; }));
  EXPECT_TRUE(refuses([](auto* h) { h->size = sizeof(protocol::Header); }));  // items missing
  EXPECT_TRUE(refuses([](auto* h) { h->count = 0; }));                        // items left over
  EXPECT_TRUE(refuses([](auto* h) { h->count = 2; }));
  EXPECT_TRUE(refuses([](auto* h) { h->count = 0x40000001; }));  // 4 * count is 4 in 32 bits
  EXPECT_TRUE(refuses([](auto* h) { h->count = std::numeric_limits<std::uint32_t>::max(); }));
}

TEST(FrameCodecTest, MoreItemsThanAClientHasReasonToSendAreRefused) {
  const std::vector<HandInput> inputs(65, PlainInput());
  EXPECT_FALSE(ReadClientFrames(Frame<HandInput>(inputs)));
  EXPECT_TRUE(ReadClientFrames(Frame<HandInput>(std::span(inputs).first(64))));
  const std::vector<Acknowledgement> credits(65);
  EXPECT_FALSE(ReadClientFrames(Frame<Acknowledgement>(credits)));
  EXPECT_TRUE(ReadClientFrames(Frame<Acknowledgement>(std::span(credits).first(64))));
}

TEST(FrameCodecTest, NumbersThatAreNotFiniteAreRefused) {  // N11: clamp every number
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    for (std::size_t k = 0; k < 8; ++k) {
      HandInput input = PlainInput();
      if (k < 3) {
        input.p_WH_m[k] = bad;
      } else if (k < 7) {
        input.q_WH[k - 3] = bad;
      } else {
        input.client_ms = bad;
      }
      EXPECT_FALSE(ReadClientFrames(InputFrame(input))) << k << ": " << bad;
    }
  }
}

TEST(FrameCodecTest, RotationsMustBeOfLengthOne) {
  const auto accepts = [](std::array<float, 4> q) {
    HandInput input = PlainInput();
    input.q_WH = q;
    return ReadClientFrames(InputFrame(input)).has_value();
  };
  EXPECT_TRUE(accepts({0, 0, 1, 0}));
  EXPECT_TRUE(accepts({0.7071F, 0, 0.7071F, 0}));
  EXPECT_FALSE(accepts({0, 0, 0, 0}));
  EXPECT_FALSE(accepts({1, 1, 0, 0}));
  EXPECT_FALSE(accepts({0.5F, 0, 0, 0}));
  EXPECT_FALSE(accepts({1e30F, 0, 0, 0}));  // its square is infinite
}

TEST(FrameCodecTest, OneBadInputRefusesTheWholeMessage) {
  HandInput bad = PlainInput();
  bad.p_WH_m[1] = std::nanf("");
  EXPECT_FALSE(ReadClientFrames(CreditFrame(5) + InputFrame(bad)));
}

}  // namespace
}  // namespace hvas::studio
