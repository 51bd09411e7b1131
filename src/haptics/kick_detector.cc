#include "haptics/kick_detector.h"

#include <algorithm>
#include <cmath>

namespace hvas::haptics {
namespace {

constexpr std::array kSpans{4e-3, 8e-3, 16e-3};  // [s]
/** Three positions, each rounded by half a step, the middle one counted twice. */
constexpr double kSteps = 2.0;

}  // namespace

Kick KickDetector::Update(const Vec3& p, const Vec3& f, double dt) noexcept {
  time_ += dt;
  newest_ = (newest_ + 1) % kSize;
  samples_[newest_] = {time_, p, f.norm()};
  count_ = std::min(count_ + 1, kSize);
  for (const double span : kSpans) {
    if (const Kick kick = Judge(span, f); kick != Kick::kNone) {
      return kick;
    }
  }
  return Kick::kNone;
}

const KickDetector::Sample* KickDetector::FindBefore(double age) const noexcept {
  constexpr double kRounding = 1e-9;  // [s]
  for (std::size_t back = 1; back < count_; ++back) {
    const Sample& sample = samples_[(newest_ + kSize - back) % kSize];
    if (time_ - sample.time >= age - kRounding) {
      return &sample;
    }
  }
  return nullptr;
}

Kick KickDetector::Judge(double span, const Vec3& f) const noexcept {
  const Sample* start = FindBefore(2 * span);
  const Sample* middle = FindBefore(span);
  if (start == nullptr || middle == nullptr || middle->time <= start->time) {
    return Kick::kNone;
  }
  const double late = time_ - middle->time;
  const double early = middle->time - start->time;
  const Vec3 moved = samples_[newest_].p - middle->p;
  const Vec3 e = moved - late / early * (middle->p - start->p);
  const double noise = kSteps * thresholds_.resolution;
  const double square = late * late;
  const double force = f.norm();
  if (force >= thresholds_.min_force && middle->force >= thresholds_.min_force) {
    const Vec3 along = f / force;
    if (-e.dot(along) > noise + thresholds_.hand * square && moved.dot(along) < -noise) {
      return Kick::kAgainst;
    }
  }
  const double strongest = std::max(force, middle->force) / thresholds_.mass + thresholds_.blow;
  const bool is_faster = moved.norm() > late / early * (middle->p - start->p).norm();
  return is_faster && e.norm() > noise + strongest * square ? Kick::kRunaway : Kick::kNone;
}

}  // namespace hvas::haptics
