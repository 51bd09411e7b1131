#include "contact/helix.h"

#include <limits>
#include <utility>

#include "base/units.h"

namespace hvas::contact {
namespace {

constexpr std::size_t kSidesBefore = 2;  // Helix::sides.
constexpr std::size_t kBins = 256;       // Of a pitch, to find the side at a place. A choice.

/** Unit normal in space of a side at a radius. */
Vec3 InSpace(const Helix& helix, const HelixSide& side, double radius) noexcept {
  const double slope = side.n_z * helix.sense * helix.pitch / (units::kTurn * radius);
  return Vec3(side.n_r, -slope, side.n_z).normalized();
}

/** The angle of a direction in turns, from -1/2 to 1/2: the series of the arc tangent up to the
 15th power for |t| <= tan 22.5 deg, within 3e-9 of a turn. The library's function takes three times
 as long here, and is what most of the time of a query in a thread goes to. */
double CalcTurn(double y, double x) noexcept {
  const double small = std::min(std::abs(x), std::abs(y));
  const double large = std::max(std::abs(x), std::abs(y));
  if (!(large > 0)) {
    return 0;
  }
  constexpr double kTan22 = 0.41421356237309503;  // sqrt(2) - 1, exact.
  const bool is_steep = small > kTan22 * large;
  const double t = is_steep ? (small - large) / (small + large) : small / large;
  const double q = t * t;
  const double series =
      t * (1 - q * (1. / 3 -
                    q * (1. / 5 -
                         q * (1. / 7 - q * (1. / 9 - q * (1. / 11 - q * (1. / 13 - q / 15)))))));
  double turn = series / units::kTurn + (is_steep ? 0.125 : 0);
  turn = std::abs(y) > std::abs(x) ? 0.25 - turn : turn;
  turn = x < 0 ? 0.5 - turn : turn;
  return y < 0 ? -turn : turn;
}

}  // namespace

void Helix::Complete() {
  (void)HelixAzimuths();  // Made before a query asks for them.
  SetAxis(axis, u);
  const std::size_t count = corners.size();
  sides.clear();
  inverse_pitch = 1 / pitch;
  least_cosine = 1;
  for (std::size_t i = 0; i < count + 2 * kSidesBefore; ++i) {
    // The corner that is kSidesBefore before the i-th one, of as many turns as it takes.
    const auto corner_at = [&](std::size_t k) {
      const std::size_t turned = k + 2 * count - kSidesBefore;  // Two turns from below zero.
      const std::size_t turns = turned / count;
      const double turn = static_cast<double>(turns) - 2;
      const HelixCorner& corner = corners[turned % count];
      return std::pair(corner.z + turn * pitch, corner.r);
    };
    const auto [z, r] = corner_at(i);
    const auto [z_end, r_end] = corner_at(i + 1);
    HelixSide side;
    side.z = z;
    side.r = r;
    side.dz = z_end - z;
    side.dr = r_end - r;
    side.slope = side.dr / side.dz;
    side.inverse = 1 / (side.dz * side.dz + side.dr * side.dr);
    side.n_z = -outward * side.dr * std::sqrt(side.inverse);
    side.n_r = outward * side.dz * std::sqrt(side.inverse);
    sides.push_back(side);
    least_cosine = std::min(least_cosine, std::abs(side.n_r));
  }
  least_radius = std::numeric_limits<double>::infinity();
  largest_radius = 0;
  for (std::size_t i = 0; i < count; ++i) {
    HelixCorner& corner = corners[i];
    least_radius = std::min(least_radius, corner.r);
    largest_radius = std::max(largest_radius, corner.r);
    const HelixSide& before = sides[kSidesBefore + i - 1];
    const HelixSide& behind = sides[kSidesBefore + i];
    corner.normals = {InSpace(*this, before, corner.r), InSpace(*this, behind, corner.r)};
    // Where the material is within, it is convex where the profile turns towards the axis.
    corner.is_convex = outward * (before.dz * behind.dr - before.dr * behind.dz) < 0;
  }
  const double rise = pitch / (units::kTurn * least_radius);
  least_cosine /= std::sqrt(1 + rise * rise);
  side_at.assign(kBins, 0);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double z = static_cast<double>(bin) / kBins * pitch;
    std::size_t side = kSidesBefore - 1;
    while (sides[side + 1].z <= z) {
      ++side;
    }
    side_at[bin] = static_cast<std::uint16_t>(side);
  }
}

const std::array<std::array<double, 2>, kHelixAzimuths>& HelixAzimuths() noexcept {
  static const auto azimuths = [] {
    std::array<std::array<double, 2>, kHelixAzimuths> all{};
    for (std::size_t i = 0; i < kHelixAzimuths; ++i) {
      const double angle = units::kTurn * static_cast<double>(i) / kHelixAzimuths;
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return azimuths;
}

HelixDistance CalcHelixDistance(const Helix& helix, const HelixPoint& at, double limit) noexcept {
  double z = at.height - helix.sense * helix.pitch * CalcTurn(at.sine, at.cosine);
  z -= helix.pitch * std::floor(z * helix.inverse_pitch);
  z = z >= 0 && z < helix.pitch ? z : 0;
  const HelixSide* side =
      &helix.sides[helix.side_at[static_cast<std::size_t>(z * helix.inverse_pitch * kBins)]];
  while (side[1].z <= z) {
    ++side;
  }
  const double profile = side->r + (z - side->z) * side->slope;
  const double gap = helix.outward * (at.radius - profile);
  // The sides lean no more than that; where the gap is negative, the distance is no less than it.
  if ((gap > 0 ? gap * helix.least_cosine : gap) >= limit) {
    return {std::numeric_limits<double>::infinity(), helix.u};
  }
  // The nearest of three sides: in a plane through the axis, along it and away from it.
  double least = std::numeric_limits<double>::infinity();
  double n_z = 0;
  double n_r = 1;
  for (const HelixSide* s = side - 1; s <= side + 1; ++s) {
    const double z_a = z - s->z;
    const double r_a = at.radius - s->r;
    const double share = (z_a * s->dz + r_a * s->dr) * s->inverse;
    const double to = share < 0 ? 0 : (share > 1 ? 1 : share);
    const double off_z = z_a - to * s->dz;
    const double off_r = r_a - to * s->dr;
    const double squared = off_z * off_z + off_r * off_r;
    if (squared >= least) {
      continue;
    }
    least = squared;
    constexpr double kOnIt = 1e-9;  // [m]: nearer to a corner than that a direction is rounding.
    if (to == share || squared < kOnIt * kOnIt) {
      n_z = s->n_z;
      n_r = s->n_r;
    } else {
      // Beside a corner the direction is that of the way to it, which leads inwards from inside.
      const double scale = (off_r * helix.outward < 0 ? -1 : 1) / std::sqrt(squared);
      n_z = scale * off_z;
      n_r = scale * off_r;
    }
  }
  const double sign = gap >= 0 ? 1 : -1;
  const double rise = helix.sense * helix.pitch / units::kTurn;
  const double slope = n_z * rise / std::max(at.radius, helix.least_radius);
  const double stretch = 1 / std::sqrt(1 + slope * slope);
  return {sign * std::sqrt(least) * stretch,
          FromCylinder(helix, at, stretch * n_r, -stretch * slope, stretch * n_z)};
}

double CalcThreadOverlap(const Helix& helix, const Helix& other, const Mat3& R,
                         const Vec3& p) noexcept {
  constexpr double kSamePitch = 0.02;  // Of it: what fits of meshes may be wrong by. A choice.
  constexpr double kSteepest = 0.2;    // [rad]: flanks that lean by more face others. A choice.
  if (helix.outward == other.outward || helix.sense != other.sense ||
      std::abs(helix.pitch - other.pitch) > kSamePitch * helix.pitch) {
    return 0;
  }
  const Helix& inner = helix.outward > 0 ? other : helix;
  const Helix& outer = helix.outward > 0 ? helix : other;
  if (outer.least_radius > inner.largest_radius || outer.largest_radius < inner.least_radius) {
    return 0;
  }
  const Vec3 axis = R * other.axis;
  const double cosine = axis.dot(helix.axis);
  if (std::abs(cosine) < std::cos(kSteepest)) {
    return 0;
  }
  // Where the two axes are nearest to the middle of what they have in common.
  const Vec3 d = R * other.origin + p - helix.origin;
  const double start = d.dot(helix.axis);
  const double end_a = start + cosine * other.low;
  const double end_b = start + cosine * other.high;
  const double low = std::max(helix.low, std::min(end_a, end_b));
  const double high = std::min(helix.high, std::max(end_a, end_b));
  if (low >= high) {
    return 0;
  }
  const Vec3 at = d + (0.5 * (low + high) - start) / cosine * axis;
  const Vec3 off = at - at.dot(helix.axis) * helix.axis;
  return off.norm() < inner.largest_radius - inner.least_radius ? high - low : 0;
}

}  // namespace hvas::contact
