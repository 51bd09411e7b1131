#include "record/tick_coding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/check.h"
#include "record/packing.h"
#include "record/range_coder.h"
#include "spatial/rounding.h"

namespace hvas::record {
namespace {

// The columns that the predictions know by name, in the order of packed ticks.
constexpr std::size_t kTime = 0;
constexpr std::size_t kDevicePose = 1;
constexpr std::size_t kDeviceTwist = 8;
constexpr std::size_t kTrackedPose = 16;
constexpr std::size_t kDisplayedPose = 23;
constexpr std::size_t kTrueWrench = 30;
constexpr std::size_t kFeltWrench = 36;
constexpr std::size_t kDepth = 45;
constexpr std::size_t kDeepest = 46;
constexpr std::size_t kContacts = 47;
constexpr std::size_t kContactDistance = 53;
constexpr std::size_t kHand = 61;
constexpr std::size_t kColumns = 71;

constexpr std::size_t kNumbersOfTwist = 6;    // Of a wrench, too.
constexpr std::size_t kNumbersOfContact = 7;  // Place, normal and distance, as packed.
constexpr std::size_t kHands = 2;             // As many as a session has at most.

using Row = std::array<std::uint64_t, kColumns>;  // The bits of a tick's numbers.

struct Layout {
  std::array<PackedNumber, kColumns> columns;
  std::array<std::size_t, kColumns> order;  // In which columns are coded.
  std::array<double, kColumns> steps{};     // Of which the numbers are multiples; 0: of none.

  Layout() {
    const std::vector<PackedNumber> numbers = ListPackedNumbers();
    HVAS_DEMAND(numbers.size() == kColumns);
    std::copy(numbers.begin(), numbers.end(), columns.begin());
    // Whose tick it is and how fast the handle moves come first: what follows is predicted by them.
    std::size_t at = 0;
    order[at++] = kHand;
    order[at++] = kTime;
    for (std::size_t i = 0; i < kNumbersOfTwist; ++i) {
      order[at++] = kDeviceTwist + i;
    }
    for (std::size_t column = 0; column < kColumns; ++column) {
      if (std::find(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(at), column) ==
          order.begin() + static_cast<std::ptrdiff_t>(at)) {
        order[at++] = column;
      }
    }
    SetSteps();
  }

  void SetSteps() {
    const auto set = [this](std::size_t from, std::size_t count, double step) {
      std::fill_n(steps.begin() + static_cast<std::ptrdiff_t>(from), count, step);
    };
    for (const std::size_t pose : {kDevicePose, kTrackedPose, kDisplayedPose}) {
      set(pose, 3, spatial::kLengthStep);
      set(pose + 3, 4, spatial::kQuaternionStep);
    }
    set(kDeviceTwist, kNumbersOfTwist, spatial::kVelocityStep);
    for (const std::size_t wrench : {kTrueWrench, kFeltWrench}) {
      set(wrench, 3, spatial::kTorqueStep);
      set(wrench + 3, 3, spatial::kForceStep);
    }
    set(kDepth, 1, spatial::kLengthStep);
    set(kDeepest, 1, spatial::kLengthStep);
    for (std::size_t i = 0; i < TickRecord::kContacts; ++i) {
      set(kContacts + i * kNumbersOfContact, kNumbersOfContact - 1, kContactStep);
      set(kContacts + (i + 1) * kNumbersOfContact - 1, 1, spatial::kLengthStep);
    }
  }

  static const Layout& Get() {
    static const Layout layout;
    return layout;
  }
};

double ToDouble(PackedNumber type, std::uint64_t bits) {
  return type == PackedNumber::kDouble
             ? std::bit_cast<double>(bits)
             : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
}

std::uint64_t ToBits(PackedNumber type, double value) {
  return type == PackedNumber::kDouble ? std::bit_cast<std::uint64_t>(value)
                                       : std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

bool IsReal(PackedNumber type) {
  return type == PackedNumber::kDouble || type == PackedNumber::kFloat;
}

// Bits as a number that grows as what they mean does, and back: of real numbers, negative ones are
// turned round.
std::uint64_t ToRank(PackedNumber type, std::uint64_t bits) {
  const std::uint64_t sign = std::uint64_t{1} << (8 * SizeOf(type) - 1);
  if (!IsReal(type)) {
    return bits;
  }
  return (bits & sign) != 0 ? ~bits & (sign | (sign - 1)) : bits | sign;
}

std::uint64_t FromRank(PackedNumber type, std::uint64_t rank) {
  const std::uint64_t sign = std::uint64_t{1} << (8 * SizeOf(type) - 1);
  if (!IsReal(type)) {
    return rank;
  }
  return (rank & sign) != 0 ? rank & ~sign : ~rank & (sign | (sign - 1));
}

// Multiples of a step as numbers that grow as they do, and back. What is beyond 2^53 steps is taken
// for infinite, and what is no number for zero.
constexpr double kMostSteps = 0x1p53;
constexpr std::uint64_t kRankOfZero = std::uint64_t{1} << 63;

std::uint64_t ToStepRank(double step, double value) {
  if (std::isnan(value)) {
    return kRankOfZero;
  }
  const double steps = std::nearbyint(std::clamp(value / step, -kMostSteps, kMostSteps));
  return kRankOfZero + static_cast<std::uint64_t>(static_cast<std::int64_t>(steps));
}

double FromStepRank(double step, std::uint64_t rank) {
  const auto steps = static_cast<double>(static_cast<std::int64_t>(rank - kRankOfZero));
  return std::abs(steps) < kMostSteps
             ? steps * step
             : std::copysign(std::numeric_limits<double>::infinity(), steps);
}

// Whether a number comes back from its steps bit for bit; a negative zero does not.
bool IsOfSteps(PackedNumber type, double step, std::uint64_t bits) {
  return ToBits(type, FromStepRank(step, ToStepRank(step, ToDouble(type, bits)))) == bits;
}

bool IsOfSteps(const Layout& layout, const Row& row) {
  for (std::size_t column = 0; column < kColumns; ++column) {
    const double step = layout.steps[column];
    if (step > 0 && !IsOfSteps(layout.columns[column], step, row[column])) {
      return false;
    }
  }
  return true;
}

// How the numbers of a column are counted: in steps, or as representable numbers.
struct Scale {
  PackedNumber type;
  double step;  // 0: all that can be represented.

  [[nodiscard]] unsigned width() const {
    return step > 0 ? 64 : static_cast<unsigned>(8 * SizeOf(type));
  }

  [[nodiscard]] std::uint64_t RankOfBits(std::uint64_t bits) const {
    return step > 0 ? RankOf(ToDouble(type, bits)) : ToRank(type, bits);
  }

  [[nodiscard]] std::uint64_t RankOf(double value) const {
    return step > 0 ? ToStepRank(step, value) : ToRank(type, ToBits(type, value));
  }

  [[nodiscard]] std::uint64_t BitsOf(std::uint64_t rank) const {
    return step > 0 ? ToBits(type, FromStepRank(step, rank)) : FromRank(type, rank);
  }
};

// The last values of a column and their backward differences, by which polynomials go on.
class Series {
 public:
  // Above it, rounding grows by more than the rest shrinks: measured on frame_500.
  static constexpr std::size_t kMostOrder = 9;

  // By the polynomial through the last `order` values, or as many as there are.
  [[nodiscard]] double Extrapolate(std::size_t order) const {
    double sum = 0;
    for (std::size_t k = std::min(order, count_); k-- > 0;) {
      sum += differences_[k];
    }
    return sum;
  }

  void Add(double value) {
    double difference = value;
    for (std::size_t k = 0; k < kMostOrder && k <= count_; ++k) {
      const double before = differences_[k];
      differences_[k] = difference;
      difference -= before;
    }
    count_ = std::min(count_ + 1, kMostOrder);
  }

 private:
  std::array<double, kMostOrder> differences_{};
  std::size_t count_{0};
};

// A rigid pose as it is packed: p, then q as w, x, y, z. Its functions have one rounding on every
// machine: they use no function that the library approximates.
struct RigidPose {
  std::array<double, 3> p;
  std::array<double, 4> q;
};

std::array<double, 4> Multiply(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] + a[2] * b[0] + a[3] * b[1] - a[1] * b[3],
          a[0] * b[3] + a[3] * b[0] + a[1] * b[2] - a[2] * b[1]};
}

std::array<double, 4> Normalise(const std::array<double, 4>& q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

std::array<double, 3> Rotate(const std::array<double, 4>& q, const std::array<double, 3>& v) {
  const std::array<double, 4> turned =
      Multiply(Multiply(q, {0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {turned[1], turned[2], turned[3]};
}

// exp(w dt) for small angles, by its series.
std::array<double, 4> MakeTurn(const std::array<double, 3>& w, double dt) {
  const std::array<double, 3> half{0.5 * (w[0] * dt), 0.5 * (w[1] * dt), 0.5 * (w[2] * dt)};
  const double s = half[0] * half[0] + half[1] * half[1] + half[2] * half[2];
  const double cosine = 1 - s / 2 * (1 - s / 12 * (1 - s / 30));
  const double sinc = 1 - s / 6 * (1 - s / 20 * (1 - s / 42));
  return {cosine, sinc * half[0], sinc * half[1], sinc * half[2]};
}

// What moves with a body that was at `before` and is at `now`.
RigidPose Carry(const RigidPose& before, const RigidPose& now, const RigidPose& carried) {
  const std::array<double, 4> turn =
      Multiply(now.q, {before.q[0], -before.q[1], -before.q[2], -before.q[3]});
  std::array<double, 3> arm{};
  for (std::size_t k = 0; k < 3; ++k) {
    arm[k] = carried.p[k] - before.p[k];
  }
  arm = Rotate(turn, arm);
  RigidPose result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result.p[k] = now.p[k] + arm[k];
  }
  result.q = Normalise(Multiply(turn, carried.q));
  return result;
}

constexpr std::size_t kOwn = Series::kMostOrder;        // Predictions by the column alone.
constexpr std::size_t kRelative = 6;                    // By what it was more than expected.
constexpr std::size_t kPredictions = kOwn + kRelative;  // All of a column.

// What is known of one column of one hand.
struct Column {
  std::uint64_t last{0};  // Its bits.
  std::uint64_t before_last{0};
  Series own;
  Series excess;  // Over what is expected by other columns.
  double expected{std::numeric_limits<double>::quiet_NaN()};
  std::array<std::uint32_t, kPredictions> misses{};  // Of late: bits of each prediction's error.
};

// Probabilities of what predictions miss in one column.
struct MissModel {
  std::array<BitModel, 2> is_hit;  // By whether the last one was.
  std::array<BitModel, 64> length;
  bool was_hit{false};
};

int LengthOf(std::uint64_t miss) {
  return static_cast<int>(std::bit_width(miss));
}

// Codes ticks one after the other, in the direction that `Coder` has: RangeEncoder or RangeDecoder.
template <typename Coder>
class TickCoder {
 public:
  TickCoder(Coder* coder, std::int64_t schema) : coder_(*coder), has_steps_(schema >= 6) {}

  // Codes a tick, or fills it.
  void Code(Row* row) {
    const Layout& layout = Layout::Get();
    bool is_odd = false;
    if (has_steps_) {
      is_odd = !IsOfSteps(layout, *row);  // What a decoder says is overwritten.
      coder_.Code(&is_odd_, &is_odd);
    }
    for (const std::size_t column : layout.order) {
      if (column == kTime) {
        hand_ = static_cast<std::size_t>((*row)[kHand] % kHands);
      }
      Expect(column, *row);
      const bool is_stepped = has_steps_ && !is_odd;
      CodeNumber(column, {layout.columns[column], is_stepped ? layout.steps[column] : 0},
                 &(*row)[column]);
    }
    has_row_[hand_] = true;
    rows_[hand_] = *row;
  }

 private:
  static double Get(const Row& row, std::size_t column) {
    return std::bit_cast<double>(row[column]);
  }

  static RigidPose GetPose(const Row& row, std::size_t column) {
    RigidPose pose{};
    for (std::size_t k = 0; k < 3; ++k) {
      pose.p[k] = Get(row, column + k);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      pose.q[k] = Get(row, column + 3 + k);
    }
    return pose;
  }

  void ExpectPose(std::size_t column, const RigidPose& pose) {
    for (std::size_t k = 0; k < 3; ++k) {
      columns_[hand_][column + k].expected = pose.p[k];
    }
    for (std::size_t k = 0; k < 4; ++k) {
      columns_[hand_][column + 3 + k].expected = pose.q[k];
    }
  }

  // Finds what the columns before this one say about it, and about those that belong to it.
  void Expect(std::size_t column, const Row& row) {
    const Row& before = rows_[hand_];
    if (column >= kFeltWrench && column < kFeltWrench + kNumbersOfTwist) {
      columns_[hand_][column].expected = Get(row, column - kFeltWrench + kTrueWrench);
    } else if (column == kContactDistance) {
      columns_[hand_][column].expected = Get(row, kDeepest);
    } else if (!has_row_[hand_]) {
      return;
    } else if (column == kDevicePose) {
      // The handle goes on as fast as it is now.
      const double dt =
          static_cast<double>(static_cast<std::int64_t>(row[kTime] - before[kTime])) / 1e9;
      RigidPose pose = GetPose(before, kDevicePose);
      for (std::size_t k = 0; k < 3; ++k) {
        pose.p[k] += Get(row, kDeviceTwist + 3 + k) * dt;
      }
      const std::array<double, 4> turn = MakeTurn(
          {Get(row, kDeviceTwist), Get(row, kDeviceTwist + 1), Get(row, kDeviceTwist + 2)}, dt);
      pose.q = Normalise(Multiply(turn, pose.q));
      ExpectPose(column, pose);
    } else if (column == kTrackedPose) {
      ExpectPose(column, Carry(GetPose(before, kDevicePose), GetPose(row, kDevicePose),
                               GetPose(before, kTrackedPose)));
    } else if (column == kDisplayedPose) {
      ExpectPose(column, Carry(GetPose(before, kTrackedPose), GetPose(row, kTrackedPose),
                               GetPose(before, kDisplayedPose)));
    }
  }

  // The ranks of all predictions of a column. Those that are not finite give way to the last value.
  std::array<std::uint64_t, kPredictions> Predict(const Column& column, const Scale& scale) const {
    std::array<std::uint64_t, kPredictions> ranks;
    const std::uint64_t last = scale.RankOfBits(column.last);
    ranks.fill(last);
    if (!IsReal(scale.type)) {
      ranks[1] = 2 * last - scale.RankOfBits(column.before_last);
      return ranks;
    }
    for (std::size_t k = 1; k < kPredictions; ++k) {
      const double value = k < kOwn ? column.own.Extrapolate(k + 1)
                                    : column.expected + column.excess.Extrapolate(k - kOwn);
      if (std::isfinite(value)) {
        ranks[k] = scale.RankOf(value);
      }
    }
    return ranks;
  }

  void CodeNumber(std::size_t number, const Scale& scale, std::uint64_t* bits) {
    Column& column = columns_[hand_][number];
    const std::size_t count = IsReal(scale.type) ? kPredictions : 2;
    const auto ranks = Predict(column, scale);
    const auto begin = column.misses.begin();
    const auto best = static_cast<std::size_t>(
        std::min_element(begin, begin + static_cast<std::ptrdiff_t>(count)) - begin);
    const unsigned width = scale.width();
    const std::uint64_t mask = ~std::uint64_t{0} >> (64 - width);
    // Errors to both sides, small ones first.
    const auto miss_of = [&](std::uint64_t rank, std::uint64_t predicted) {
      const std::uint64_t error = (rank - predicted) & mask;
      const bool is_below = (error >> (width - 1)) != 0;
      return ((error << 1) ^ (is_below ? mask : 0)) & mask;
    };
    std::uint64_t miss = miss_of(scale.RankOfBits(*bits), ranks[best]);
    CodeMiss(&models_[hand_][number], &miss);
    const std::uint64_t error = (miss >> 1) ^ ((miss & 1) != 0 ? mask : 0);
    const std::uint64_t rank = (ranks[best] + error) & mask;
    *bits = scale.BitsOf(rank);
    for (std::size_t k = 0; k < count; ++k) {
      constexpr std::uint32_t kUnit = 64;   // Of a bit.
      constexpr std::uint32_t kMemory = 8;  // Ticks that count most: a choice.
      const auto length = static_cast<std::uint32_t>(LengthOf(miss_of(rank, ranks[k])));
      column.misses[k] += kUnit * length / kMemory - column.misses[k] / kMemory;
    }
    column.before_last = column.last;
    column.last = *bits;
    if (IsReal(scale.type)) {
      const double value = ToDouble(scale.type, *bits);
      column.own.Add(value);
      column.excess.Add(value - column.expected);
    }
  }

  void CodeMiss(MissModel* model, std::uint64_t* miss) {
    bool is_hit = *miss == 0;
    coder_.Code(&model->is_hit[model->was_hit ? 1 : 0], &is_hit);
    model->was_hit = is_hit;
    if (is_hit) {
      *miss = 0;
      return;
    }
    // The length, from 1 to 64, as a way down a tree.
    const auto length = static_cast<unsigned>(LengthOf(*miss) - 1);
    unsigned node = 1;
    for (int level = 5; level >= 0; --level) {
      bool bit = (length >> level & 1U) != 0;
      coder_.Code(&model->length[node], &bit);
      node = 2 * node + (bit ? 1U : 0U);
    }
    const int below_first = static_cast<int>(node - 64);
    std::uint64_t rest = *miss & ((std::uint64_t{1} << below_first) - 1);
    coder_.CodeBits(below_first, &rest);
    *miss = std::uint64_t{1} << below_first | rest;
  }

  Coder& coder_;
  bool has_steps_;
  BitModel is_odd_;  // A tick with numbers that are no multiples of their steps.
  std::size_t hand_{0};
  std::array<std::array<Column, kColumns>, kHands> columns_{};
  std::array<std::array<MissModel, kColumns>, kHands> models_{};
  std::array<Row, kHands> rows_{};
  std::array<bool, kHands> has_row_{};
};

constexpr int kBitsOfCount = 16;  // Of the number of ticks in a block.

}  // namespace

std::vector<std::byte> EncodeTicks(std::span<const std::byte> packed) {
  HVAS_DEMAND(packed.size() % kPackedTickSize == 0);
  const Layout& layout = Layout::Get();
  std::uint64_t count = packed.size() / kPackedTickSize;
  HVAS_DEMAND(count < 1U << kBitsOfCount);
  RangeEncoder encoder;
  encoder.CodeBits(kBitsOfCount, &count);
  TickCoder<RangeEncoder> coder(&encoder, kSchemaVersion);
  for (const std::byte* from = packed.data(); from != packed.data() + packed.size();) {
    Row row{};
    for (std::size_t column = 0; column < kColumns; ++column) {
      std::memcpy(&row[column], from, SizeOf(layout.columns[column]));
      from += SizeOf(layout.columns[column]);
    }
    coder.Code(&row);
  }
  return encoder.Finish();
}

std::vector<std::byte> DecodeTicks(std::span<const std::byte> block, std::size_t count,
                                   std::int64_t schema) {
  const Layout& layout = Layout::Get();
  RangeDecoder decoder(block);
  std::uint64_t encoded = 0;
  decoder.CodeBits(kBitsOfCount, &encoded);
  if (encoded != count) {
    return {};
  }
  std::vector<std::byte> packed(count * kPackedTickSize);
  TickCoder<RangeDecoder> coder(&decoder, schema);
  for (std::byte* to = packed.data(); to != packed.data() + packed.size();) {
    Row row{};
    coder.Code(&row);
    for (std::size_t column = 0; column < kColumns; ++column) {
      std::memcpy(to, &row[column], SizeOf(layout.columns[column]));
      to += SizeOf(layout.columns[column]);
    }
  }
  return decoder.is_at_end() ? packed : std::vector<std::byte>();
}

}  // namespace hvas::record
