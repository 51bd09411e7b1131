#include "contact/helix_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace hvas::contact {

HelixPlace PlaceOf(const Helix& helix, const Vec3& p) {
  const HelixPoint at = Locate(helix, p);
  const double azimuth = std::atan2(at.sine, at.cosine);
  return {at.height - helix.sense * helix.pitch * azimuth / units::kTurn, at.radius, at.height};
}

double ReducedToPitch(double z, double pitch) {
  const double reduced = z - pitch * std::floor(z / pitch);
  return reduced < pitch ? reduced : 0.0;
}

HelixProfile::HelixProfile(double pitch)
    : pitch_(pitch), radius_(kSteps, -std::numeric_limits<double>::infinity()) {}

void HelixProfile::AddEdge(const HelixPlace& a, const HelixPlace& b) {
  const HelixPlace& first = a.z < b.z ? a : b;
  const HelixPlace& last = a.z < b.z ? b : a;
  const double step = pitch_ / kSteps;
  const auto begin = static_cast<long>(std::ceil(first.z / step));
  const auto end = static_cast<long>(std::floor(last.z / step));
  for (long i = begin; i <= end; ++i) {
    const double way = last.z - first.z;
    const double share = way > 0 ? (static_cast<double>(i) * step - first.z) / way : 0;
    Raise(i, first.r + share * (last.r - first.r));
  }
}

bool HelixProfile::is_whole() const {
  return std::all_of(radius_.begin(), radius_.end(), [](double r) { return std::isfinite(r); });
}

std::vector<HelixCorner> HelixProfile::MakeCorners(double tolerance) const {
  const auto most = std::max_element(radius_.begin(), radius_.end()) - radius_.begin();
  const auto least = std::min_element(radius_.begin(), radius_.end()) - radius_.begin();
  const auto from = static_cast<std::size_t>(std::min(most, least));
  const auto to = static_cast<std::size_t>(std::max(most, least));
  std::vector<std::size_t> kept;
  Divide(from, to, tolerance, &kept);
  Divide(to, from + kSteps, tolerance, &kept);
  for (const std::size_t forced : {from, to}) {
    DropStraight(forced, tolerance, &kept);
  }
  return Sharpen(kept);
}

void HelixProfile::Raise(long i, double r) {
  const auto count = static_cast<long>(kSteps);
  double& radius = radius_[static_cast<std::size_t>((i % count + count) % count)];
  radius = std::max(radius, r);
}

HelixProfile::Vec2 HelixProfile::At(std::size_t i) const {
  return {static_cast<double>(i) * pitch_ / kSteps, radius_[i % kSteps]};
}

void HelixProfile::Divide(std::size_t from, std::size_t to, double tolerance,
                          std::vector<std::size_t>* kept) const {
  const Vec2 a = At(from);
  const Vec2 way = (At(to) - a).normalized();
  double most = tolerance;
  std::size_t at = from;
  for (std::size_t i = from + 1; i < to; ++i) {
    const Vec2 d = At(i) - a;
    const double off = std::abs(way.x() * d.y() - way.y() * d.x());
    if (off > most) {
      most = off;
      at = i;
    }
  }
  if (at == from) {
    kept->push_back(from);
    return;
  }
  Divide(from, at, tolerance, kept);
  Divide(at, to, tolerance, kept);
}

void HelixProfile::DropStraight(std::size_t step, double tolerance,
                                std::vector<std::size_t>* kept) const {
  const auto at = std::find(kept->begin(), kept->end(), step);
  if (kept->size() < 3 || at == kept->end()) {
    return;
  }
  const std::size_t before = at == kept->begin() ? kept->back() - kSteps : *(at - 1);
  const std::size_t behind = at + 1 == kept->end() ? kept->front() + kSteps : *(at + 1);
  // Unsigned numbers wrap alike: counted from a pitch up, none is below zero.
  const Vec2 a = At(before + kSteps);
  const Vec2 way = (At(behind + kSteps) - a).normalized();
  const Vec2 d = At(step + kSteps) - a;
  if (std::abs(way.x() * d.y() - way.y() * d.x()) < tolerance) {
    kept->erase(at);
  }
}

std::vector<HelixCorner> HelixProfile::Sharpen(const std::vector<std::size_t>& kept) const {
  const std::size_t count = kept.size();
  std::vector<HelixCorner> corners;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = k > 0 ? kept[k - 1] : kept[count - 1] - kSteps;
    const std::size_t behind = k + 1 < count ? kept[k + 1] : kept[0] + kSteps;
    // Unsigned numbers wrap alike: heights below zero are counted from a pitch up.
    const Vec2 at = Meet(before + kSteps, kept[k] + kSteps, behind + kSteps);
    HelixCorner corner;
    corner.z = ReducedToPitch(at.x(), pitch_);
    corner.r = at.y();
    corners.push_back(corner);
  }
  std::sort(corners.begin(), corners.end(),
            [](const HelixCorner& a, const HelixCorner& b) { return a.z < b.z; });
  const double least = 1e-6 * pitch_;  // Nearer ones are one.
  const auto last = std::unique(
      corners.begin(), corners.end(),
      [least](const HelixCorner& a, const HelixCorner& b) { return b.z - a.z < least; });
  corners.erase(last, corners.end());
  return corners;
}

HelixProfile::Vec2 HelixProfile::Meet(std::size_t before, std::size_t corner,
                                      std::size_t behind) const {
  constexpr std::size_t kLong = 6;  // Steps; a line through fewer is no better. A choice.
  constexpr double kFar = 4;        // Steps that a corner may move: more is another one. A choice.
  Vec2 at = At(corner);
  if (corner - before < kLong || behind - corner < kLong) {
    return at;
  }
  const auto [p, m] = FitLine(before + 1, corner - 1);
  const auto [q, n] = FitLine(corner + 1, behind - 1);
  const double cross = m.x() * n.y() - m.y() * n.x();
  if (std::abs(cross) < 1e-3) {
    return at;
  }
  const Vec2 d = q - p;
  const Vec2 meet = p + (d.x() * n.y() - d.y() * n.x()) / cross * m;
  return (meet - at).norm() < kFar * pitch_ / kSteps ? meet : at;
}

std::pair<HelixProfile::Vec2, HelixProfile::Vec2> HelixProfile::FitLine(std::size_t from,
                                                                        std::size_t to) const {
  Vec2 middle = Vec2::Zero();
  for (std::size_t i = from; i <= to; ++i) {
    middle += At(i);
  }
  middle /= static_cast<double>(to - from + 1);
  Vec2 slope = Vec2::Zero();
  for (std::size_t i = from; i <= to; ++i) {
    const Vec2 d = At(i) - middle;
    slope += d.x() * d;
  }
  return {middle, slope.normalized()};
}

}  // namespace hvas::contact
