#include "mates/axis_rules.h"

#include <algorithm>
#include <cmath>

namespace hvas::mates {
namespace {

double CalcAxisDistance(const Vec3& axis, const Vec3& p_on_axis, const Vec3& q) {
  return axis.cross(q - p_on_axis).norm();
}

/** Whether an engagement centres: a pilot of a flange, short as it is, and a thread. */
bool DoesCentre(const PlacedAxisHit& hit) {
  // Choices: what a printed pilot or one of H9/d9 may have, and the shortest that is turned.
  constexpr double kCentringPlay = 0.1e-3;  // [m] of the radius.
  constexpr double kCentringRatio = 0.02;   // Of the radius; the smaller one counts.
  constexpr double kCentringLength = 0.05;  // Of the diameter.
  return hit.play() <= std::min(kCentringPlay * hit.scale, kCentringRatio * hit.hole_radius) &&
         hit.length() >= kCentringLength * 2 * hit.hole_radius;
}

/** Whether a shaft has so much play that it only passes. */
bool DoesPass(const PlacedAxisHit& hit) {
  constexpr double kPassingPlay = 0.05;  // Of the radius; H11/c11 has 0.037 at 6 mm. A choice.
  return hit.play() > kPassingPlay * hit.hole_radius;
}

/** The tightest of the long engagements: of those that are half as long as the longest or more, the
 one with the smallest difference of radii, then the longest. Where some of them centre, those that
 the shaft only passes do not count. */
const PlacedAxisHit* ChooseTightest(std::vector<const PlacedAxisHit*> group) {
  if (std::any_of(group.begin(), group.end(),
                  [](const PlacedAxisHit* hit) { return DoesCentre(*hit); })) {
    std::erase_if(group, [](const PlacedAxisHit* hit) { return DoesPass(*hit); });
  }
  double longest = 0;
  for (const PlacedAxisHit* hit : group) {
    longest = std::max(longest, hit->length());
  }
  const PlacedAxisHit* best = nullptr;
  for (const PlacedAxisHit* hit : group) {
    if (hit->length() < 0.5 * longest) {
      continue;
    }
    constexpr double kSame = 1e-7;  // [m]: a tenth of the finest tolerance of ISO 286. A choice.
    const double gain = best == nullptr ? 1.0 : std::abs(best->play()) - std::abs(hit->play());
    if (best == nullptr || gain > kSame ||
        (gain > -kSame && hit->length() > best->length() + kSame)) {
      best = hit;
    }
  }
  return best;
}

/** Length that two engagements on one axis share along it [m]; negative: the gap between them. */
double CalcSharedLength(const PlacedAxisHit& a, const PlacedAxisHit& b) {
  const double first = a.axis_W.dot(b.CalcPoint(b.low) - a.origin_W);
  const double last = a.axis_W.dot(b.CalcPoint(b.high) - a.origin_W);
  return std::min(a.high, std::max(first, last)) - std::max(a.low, std::min(first, last));
}

}  // namespace

AxisRules::AxisRules(const InferenceLimits& limits, const std::vector<PlacedAxisHit>& hits,
                     WorkWatch* watch)
    : limits_(limits), hits_(hits), watch_(watch), cos_angle_(std::cos(limits.angle)) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hits_of_hole_[{hits[i].hole_occurrence, hits[i].hole}].push_back(i);
    hits_of_shaft_[{hits[i].shaft_occurrence, hits[i].shaft}].push_back(i);
    hits_of_part_[hits[i].shaft_occurrence].push_back(i);
  }
}

bool AxisRules::IsSameAxis(const PlacedAxisHit& s, const PlacedAxisHit& t) const {
  return std::abs(s.axis_W.dot(t.axis_W)) >= cos_angle_ &&
         CalcAxisDistance(s.axis_W, s.origin_W, t.CalcPoint(0.5 * (t.low + t.high))) <
             limits_.axis_distance * s.scale;
}

/** True where a third part (a bushing) fills part of the ring between hole and shaft. */
bool AxisRules::HasPartBetween(const PlacedAxisHit& hit) const {
  const double difference = hit.play();
  if (difference <= 1e-6) {
    return false;
  }
  double filled = 0;
  for (const std::size_t i : hits_of_hole_.at({hit.hole_occurrence, hit.hole})) {
    if (!MayGoOn(watch_)) {
      return false;
    }
    const PlacedAxisHit& outer = hits_[i];
    if (outer.shaft_occurrence == hit.shaft_occurrence || std::abs(outer.play()) >= difference) {
      continue;
    }
    for (const std::size_t j : hits_of_shaft_.at({hit.shaft_occurrence, hit.shaft})) {
      const PlacedAxisHit& inner = hits_[j];
      if (inner.hole_occurrence == outer.shaft_occurrence && std::abs(inner.play()) < difference &&
          inner.hole_radius < outer.shaft_radius) {
        const double first = hit.axis_W.dot(inner.CalcPoint(inner.low) - hit.origin_W);
        const double last = hit.axis_W.dot(inner.CalcPoint(inner.high) - hit.origin_W);
        const double low = std::max({hit.low, outer.low, std::min(first, last)});
        const double high = std::min({hit.high, outer.high, std::max(first, last)});
        filled += std::max(0.0, high - low);
      }
    }
  }
  return filled > 0.1 * hit.length();
}

/** True for a wide hole around a shaft which another part guides on the same axis. */
bool AxisRules::IsLoosePassage(const PlacedAxisHit& hit) const {
  // Clearance holes of ISO 273, coarse, have up to 0.2 of the screw's radius from M3 on, less a
  // rounding of some standard's own.
  constexpr double kClearanceHole = 0.21;
  const auto is_loose = [this](const PlacedAxisHit& h) {
    return h.play() > limits_.radius_difference * h.scale &&
           !(h.is_screw && h.play() <= kClearanceHole * h.shaft_radius);
  };
  if (!is_loose(hit)) {
    return false;
  }
  const std::vector<std::size_t>& others = hits_of_part_.at(hit.shaft_occurrence);
  return std::any_of(others.begin(), others.end(), [&](std::size_t i) {
    const PlacedAxisHit& other = hits_[i];
    return other.hole_occurrence != hit.hole_occurrence && !is_loose(other) &&
           IsSameAxis(hit, other);
  });
}

std::vector<const PlacedAxisHit*> AxisRules::ChooseWorking(std::size_t begin,
                                                           std::size_t end) const {
  std::vector<std::vector<const PlacedAxisHit*>> groups;
  for (std::size_t i = begin; i < end && MayGoOn(watch_); ++i) {
    const PlacedAxisHit& hit = hits_[i];
    if (HasPartBetween(hit) || IsLoosePassage(hit)) {
      continue;
    }
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return IsSameAxis(*group.front(), hit);
    });
    if (found != groups.end()) {
      found->push_back(&hit);
    } else {
      groups.push_back({&hit});
    }
  }
  std::vector<const PlacedAxisHit*> chosen;
  chosen.reserve(groups.size());
  for (const auto& group : groups) {
    const std::size_t first = chosen.size();
    chosen.push_back(ChooseTightest(group));
    // A pin passes several bores of one part, one behind the other: the knuckles of a hinge, the
    // ears of a clevis.
    for (const PlacedAxisHit* hit : group) {
      const bool is_alike =
          std::abs(hit->play() - chosen[first]->play()) < limits_.axis_distance * hit->scale;
      if (is_alike && std::none_of(chosen.begin() + static_cast<std::ptrdiff_t>(first),
                                   chosen.end(), [&](const PlacedAxisHit* other) {
                                     return CalcSharedLength(*other, *hit) > 0;
                                   })) {
        chosen.push_back(hit);
      }
    }
  }
  return chosen;
}

bool AxisRules::IsUnbolted(const PlacedHoleHit& holes) const {
  const auto in_a = hits_of_hole_.find({holes.a, holes.hole_a});
  const auto in_b = hits_of_hole_.find({holes.b, holes.hole_b});
  if (in_a == hits_of_hole_.end() || in_b == hits_of_hole_.end()) {
    return true;
  }
  return std::none_of(in_a->second.begin(), in_a->second.end(), [&](std::size_t i) {
    return MayGoOn(watch_) &&
           std::any_of(in_b->second.begin(), in_b->second.end(), [&](std::size_t j) {
             return hits_[i].shaft_occurrence == hits_[j].shaft_occurrence;
           });
  });
}

}  // namespace hvas::mates
