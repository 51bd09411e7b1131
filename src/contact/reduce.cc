#include "contact/reduce.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hvas::contact {
namespace {

constexpr double kDiagonal = 0.70710678118654752440;  // 1 / sqrt(2).

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

std::uint64_t KeyOf(std::uint32_t body, std::uint32_t scene_face, const Vec3& nhat_S) {
  return (static_cast<std::uint64_t>(body) << 40U) |
         (static_cast<std::uint64_t>(scene_face) << 8U) | DirectionCell(nhat_S);
}

using Reaches = std::array<double, 8>;

// How far a point is along eight directions of the plane of u and v, 45 degrees apart.
Reaches ReachesOf(const Vec3& u, const Vec3& v, const Vec3& p) {
  const double a = u.dot(p);
  const double b = v.dot(p);
  const double c = kDiagonal * (a + b);
  const double d = kDiagonal * (a - b);
  return {a, -a, b, -b, c, -c, d, -d};
}

}  // namespace

void ContactReducer::Clear() noexcept {
  slots_.fill(0);
  group_count_ = 0;
  count_ = 0;
  deepest_ = std::numeric_limits<double>::infinity();
  is_full_ = false;
}

void ContactReducer::Group::Clear() noexcept {
  least = std::numeric_limits<double>::infinity();
  reach.fill(-std::numeric_limits<double>::infinity());
  roles.fill(0);
}

std::size_t ContactReducer::Group::FreeCell() const noexcept {
  std::size_t cell = 0;
  while (cell + 1 < kCells && roles[cell] != 0) {
    ++cell;
  }
  return cell;
}

void ContactReducer::Group::Give(Roles taken, std::size_t cell) noexcept {
  for (Roles& held : roles) {
    held = static_cast<Roles>(held & ~taken);
  }
  roles[cell] = taken;
}

std::size_t ContactReducer::Group::CellOf(Roles role) const noexcept {
  std::size_t cell = 0;
  while (cell + 1 < kCells && (roles[cell] & role) == 0) {
    ++cell;
  }
  return cell;
}

std::size_t ContactReducer::SlotOf(std::uint64_t key) const noexcept {
  std::size_t slot = (key * 0x9e3779b97f4a7c15ULL) >> 55U;
  static_assert(kSlots == 512);
  while (slots_[slot] != 0 && groups_[slots_[slot] - 1U].key != key) {
    slot = (slot + 1) % kSlots;
  }
  return slot;
}

std::size_t ContactReducer::Find(std::uint64_t key, const Vec3& nhat_S) noexcept {
  const std::size_t slot = SlotOf(key);
  if (slots_[slot] != 0) {
    return slots_[slot] - 1U;
  }
  if (group_count_ == kMaxGroups) {
    return kMaxGroups;
  }
  Group& group = groups_[group_count_++];
  slots_[slot] = static_cast<std::uint16_t>(group_count_);
  group.key = key;
  const Mat3 frame = spatial::FrameFromZ(nhat_S).toRotationMatrix();
  group.u = frame.col(0);
  group.v = frame.col(1);
  group.Clear();
  return group_count_ - 1;
}

void ContactReducer::Add(const RawContact& contact, const Vec3& nhat_S, const Vec3& p_S) noexcept {
  ++count_;
  const std::size_t number = Find(KeyOf(contact.body, contact.scene_face, nhat_S), nhat_S);
  const bool has_group = number < kMaxGroups;
  is_full_ = is_full_ || !has_group;
  if (!has_group || !contact.is_screened) {
    deepest_ = std::min(deepest_, contact.distance);
  }
  if (!has_group) {
    return;
  }
  Group& group = groups_[number];
  const Reaches reach = ReachesOf(group.u, group.v, p_S);
  unsigned further = 0;
  double most = 0;
  for (std::size_t k = 0; k < kTangents; ++k) {
    further |= (reach[k] > group.reach[k] ? 1U : 0U) << k;
    most = std::max(most, reach[k] - group.reach[k]);
  }
  const bool is_deeper = contact.distance < group.least;
  const bool matters = contact.is_screened
                           ? most > kFurther || contact.distance < group.least - kDeeper
                           : further != 0 || is_deeper;
  if (!matters) {
    return;
  }
  const std::size_t cell = group.FreeCell();
  cells_[number][cell] = contact;
  group.Give(static_cast<Roles>(further << 1U | (is_deeper ? kDeepest : 0U)), cell);
  group.least = std::min(group.least, contact.distance);
  for (std::size_t k = 0; k < kTangents; ++k) {
    group.reach[k] = std::max(group.reach[k], reach[k]);
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
    out[written++] = cells_[order[i]][groups_[order[i]].CellOf(kDeepest)];
  }
  // Of each contact that is not the deepest, the first tangent counts.
  for (std::size_t k = 0; k < kTangents; ++k) {
    const auto role = static_cast<Roles>(2U << k);
    for (std::size_t i = 0; i < group_count_ && written < out.size(); ++i) {
      const Group& group = groups_[order[i]];
      const std::size_t cell = group.CellOf(role);
      if ((group.roles[cell] & (role - 1U)) == 0) {
        out[written++] = cells_[order[i]][cell];
      }
    }
  }
  return written;
}

}  // namespace hvas::contact
