#include "record/packing.h"

#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "base/check.h"

namespace hvas::record {
namespace {

static_assert(std::endian::native == std::endian::little, "packing copies bytes as they are");

class ByteWriter {
 public:
  explicit ByteWriter(std::byte* to) : to_(to) {}

  template <typename T>
  void operator()(const T& value) noexcept {
    std::memcpy(to_, &value, sizeof(value));
    to_ += sizeof(value);
  }

 private:
  std::byte* to_;
};

class ByteReader {
 public:
  explicit ByteReader(const std::byte* from) : from_(from) {}

  template <typename T>
  void operator()(T& value) noexcept {
    std::memcpy(&value, from_, sizeof(value));
    from_ += sizeof(value);
  }

 private:
  const std::byte* from_;
};

// A pose as plain numbers: p, then q as w, x, y, z.
using FlatPose = std::array<double, 7>;

// Notes what a writer would write.
class NumberLister {
 public:
  template <typename T>
  void operator()(const T& /*value*/) {
    static_assert(std::is_arithmetic_v<T>);
    if constexpr (std::is_floating_point_v<T>) {
      numbers_.push_back(sizeof(T) == sizeof(double) ? PackedNumber::kDouble
                                                     : PackedNumber::kFloat);
    } else {
      constexpr std::array kIntegers{PackedNumber::kByte, PackedNumber::kShort,
                                     PackedNumber::kInteger, PackedNumber::kLong};
      numbers_.push_back(kIntegers[std::bit_width(sizeof(T)) - 1]);
    }
  }

  void operator()(const FlatPose& pose) {
    numbers_.insert(numbers_.end(), pose.size(), PackedNumber::kDouble);
  }

  [[nodiscard]] std::vector<PackedNumber>& numbers() { return numbers_; }

 private:
  std::vector<PackedNumber> numbers_;
};

FlatPose Flatten(const spatial::Pose& pose) {
  const Quat& q = pose.q();
  return {pose.p().x(), pose.p().y(), pose.p().z(), q.w(), q.x(), q.y(), q.z()};
}

spatial::Pose Unflatten(const FlatPose& v) {
  return {Quat(v[3], v[4], v[5], v[6]), Vec3(v[0], v[1], v[2])};
}

// These two alone know the order of the fields. `F` is a ByteWriter, a ByteReader or a
// NumberLister, which allocates.
template <typename F, typename Tick, typename Poses>
void VisitFieldsOf1(F& f, Tick& tick, Poses& poses) noexcept {
  const auto vector = [&f](auto& v) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      f(v[i]);
    }
  };
  f(tick.t_ns);
  f(poses[0]);
  vector(tick.device_twist.w);
  vector(tick.device_twist.v);
  f(tick.device_flags);
  f(tick.status);
  f(poses[1]);
  f(poses[2]);
  vector(tick.F_true_W.t);
  vector(tick.F_true_W.f);
  vector(tick.F_felt_W.t);
  vector(tick.F_felt_W.f);
  f(tick.held);
  f(tick.state);
  f(tick.contact_count);
  f(tick.depth);
  f(tick.deepest);
  for (auto& contact : tick.contacts) {
    vector(contact.p_WC);
    vector(contact.nhat_W);
    f(contact.distance);
  }
}

// What schema 2 added.
template <typename F, typename Tick>
void VisitFieldsOf2(F& f, Tick& tick) noexcept {
  f(tick.hand);
  f(tick.sample_ns);
  f(tick.device_buttons);
  f(tick.device_condition);
  f(tick.vendor_code);
  f(tick.device_grip);
  f(tick.model_age_ns);
  f(tick.client_age_ns);
  f(tick.effort_level);
}

// Bytes of a tick in the first version of the format, and in the second, which has more.
constexpr std::size_t kPackedTickSize1 =
    sizeof(std::int64_t) + 3 * sizeof(FlatPose) + 18 * sizeof(double) + 3 * sizeof(std::uint32_t) +
    sizeof(std::uint8_t) + sizeof(std::uint16_t) + 2 * sizeof(double) +
    std::size_t{7} * TickRecord::kContacts * sizeof(float);
constexpr std::size_t kPackedTickSize2 = kPackedTickSize1 + 3 * sizeof(std::uint8_t) +
                                         3 * sizeof(std::int64_t) + 2 * sizeof(std::uint32_t) +
                                         sizeof(double);
static_assert(kPackedTickSize == kPackedTickSize2 + sizeof(std::uint32_t));

}  // namespace

std::size_t PackedTickSize(std::int64_t schema) noexcept {
  switch (schema) {
    case 1:
      return kPackedTickSize1;
    case 2:
      return kPackedTickSize2;
    default:
      return kPackedTickSize;
  }
}

void Pack(const TickRecord& tick, std::span<std::byte, kPackedTickSize> bytes) noexcept {
  const std::array<FlatPose, 3> poses{Flatten(tick.device_pose), Flatten(tick.X_WH),
                                      Flatten(tick.X_WD)};
  ByteWriter writer(bytes.data());
  VisitFieldsOf1(writer, tick, poses);
  VisitFieldsOf2(writer, tick);
  writer(tick.commands);
}

TickRecord Unpack(std::span<const std::byte> bytes, std::int64_t schema) noexcept {
  HVAS_DEMAND(bytes.size() >= PackedTickSize(schema));
  ByteReader reader(bytes.data());
  TickRecord tick;
  std::array<FlatPose, 3> poses{};
  VisitFieldsOf1(reader, tick, poses);
  tick.device_pose = Unflatten(poses[0]);
  tick.X_WH = Unflatten(poses[1]);
  tick.X_WD = Unflatten(poses[2]);
  if (schema >= 2) {
    VisitFieldsOf2(reader, tick);
  }
  if (schema >= 3) {
    reader(tick.commands);
  }
  return tick;
}

TickRecord Unpack(std::span<const std::byte, kPackedTickSize> bytes) noexcept {
  return Unpack(bytes, kSchemaVersion);
}

std::vector<PackedNumber> ListPackedNumbers() {
  const TickRecord tick;
  const std::array<FlatPose, 3> poses{};
  NumberLister lister;
  VisitFieldsOf1(lister, tick, poses);
  VisitFieldsOf2(lister, tick);
  lister(tick.commands);
  return std::move(lister.numbers());
}

}  // namespace hvas::record
