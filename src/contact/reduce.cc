#include "contact/reduce.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace hvas::contact {
namespace {

constexpr double kDiagonal = 0.70710678118654752440;

// A direction's cell on a cube whose faces are cut in 5 x 5: cells of about 20 degrees. Odd, so
// that the axes lie in the middle of a cell and rounding does not split a plane.
std::uint64_t DirectionCell(const Vec3& n) {
  const double x = std::abs(n.x());
  const double y = std::abs(n.y());
  const double z = std::abs(n.z());
  const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
  const double scale = 2.5 / std::abs(n[axis]);
  const auto cut = [](double t) { return std::clamp(static_cast<int>(t + 2.5), 0, 4); };
  const int side = 2 * axis + (n[axis] < 0 ? 1 : 0);
  const int a = cut(n[axis == 2 ? 0 : axis + 1] * scale);
  const int b = cut(n[axis == 0 ? 2 : axis - 1] * scale);
  return static_cast<std::uint64_t>((side * 5 + a) * 5 + b);
}

}  // namespace

void ContactReducer::Clear() noexcept {
  slots_.fill(0);
  group_count_ = 0;
  count_ = 0;
  deepest_ = std::numeric_limits<double>::infinity();
  is_full_ = false;
}

ContactReducer::Group* ContactReducer::Find(std::uint64_t key, const Vec3& nhat_S) noexcept {
  std::size_t slot = (key * 0x9e3779b97f4a7c15ULL) >> 55U;
  static_assert(kSlots == 512);
  while (slots_[slot] != 0) {
    Group& group = groups_[slots_[slot] - 1U];
    if (group.key == key) {
      return &group;
    }
    slot = (slot + 1) % kSlots;
  }
  if (group_count_ == kMaxGroups) {
    return nullptr;
  }
  Group& group = groups_[group_count_++];
  slots_[slot] = static_cast<std::uint16_t>(group_count_);
  group.key = key;
  const Mat3 frame = spatial::FrameFromZ(nhat_S).toRotationMatrix();
  group.u = frame.col(0);
  group.v = frame.col(1);
  group.least = std::numeric_limits<double>::infinity();
  group.reach.fill(-std::numeric_limits<double>::infinity());
  return &group;
}

void ContactReducer::Add(const RawContact& contact, const Vec3& nhat_S, const Vec3& p_S) noexcept {
  const std::uint32_t number = count_++;
  deepest_ = std::min(deepest_, contact.distance);
  const std::uint64_t key = (static_cast<std::uint64_t>(contact.body) << 40U) |
                            (static_cast<std::uint64_t>(contact.scene_face) << 8U) |
                            DirectionCell(nhat_S);
  Group* group = Find(key, nhat_S);
  if (group == nullptr) {
    is_full_ = true;
    return;
  }
  if (contact.distance < group->least) {
    group->least = contact.distance;
    group->deepest = {contact, number};
  }
  const double a = group->u.dot(p_S);
  const double b = group->v.dot(p_S);
  const double c = kDiagonal * (a + b);
  const double d = kDiagonal * (a - b);
  const double reach[kTangents] = {a, -a, b, -b, c, -c, d, -d};
  unsigned further = 0;
  for (std::size_t k = 0; k < kTangents; ++k) {
    further |= (reach[k] > group->reach[k] ? 1U : 0U) << k;
  }
  for (; further != 0; further &= further - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(further));
    group->reach[k] = reach[k];
    group->extremes[k] = {contact, number};
  }
}

std::size_t ContactReducer::Select(std::span<RawContact> out) noexcept {
  std::array<std::uint16_t, kMaxGroups> order;
  for (std::size_t i = 0; i < group_count_; ++i) {
    order[i] = static_cast<std::uint16_t>(i);
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(group_count_),
            [&](std::uint16_t a, std::uint16_t b) {
              const double da = groups_[a].least;
              const double db = groups_[b].least;
              return da != db ? da < db : groups_[a].key < groups_[b].key;
            });
  std::size_t written = 0;
  for (std::size_t i = 0; i < group_count_ && written < out.size(); ++i) {
    out[written++] = groups_[order[i]].deepest.contact;
  }
  for (std::size_t k = 0; k < kTangents; ++k) {
    for (std::size_t i = 0; i < group_count_ && written < out.size(); ++i) {
      const Group& group = groups_[order[i]];
      const std::uint32_t number = group.extremes[k].number;
      bool is_new = number != group.deepest.number;
      for (std::size_t j = 0; j < k; ++j) {
        is_new = is_new && number != group.extremes[j].number;
      }
      if (is_new) {
        out[written++] = group.extremes[k].contact;
      }
    }
  }
  return written;
}

}  // namespace hvas::contact
