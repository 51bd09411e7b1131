#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "base/work_watch.h"
#include "mates/limits.h"
#include "product/ids.h"

namespace hvas::mates {

/** A hole of one occurrence and a shaft of another that engage, as drawn: on one axis, or a screw
 in a hole whose axis it misses by less than its play. */
struct PlacedAxisHit {
  product::OccurrenceId hole_occurrence;
  product::OccurrenceId shaft_occurrence;
  product::FeatureId hole;
  product::FeatureId shaft;
  Vec3 origin_W;  ///< Origin of the hole.
  Vec3 axis_W;
  double hole_radius{0};
  double shaft_radius{0};
  double low{0};  ///< Engaged interval along the axis from the origin [m].
  double high{0};
  double scale{1};  ///< Scale of lengths, for this pair of parts.
  bool is_off_axis{false};
  bool is_screw{false};  ///< The shaft is one that is screwed in somewhere.

  [[nodiscard]] double length() const { return high - low; }

  [[nodiscard]] double play() const { return hole_radius - shaft_radius; }

  [[nodiscard]] Vec3 CalcPoint(double s) const { return origin_W + s * axis_W; }
};

/** Two holes of two parts on one axis, one behind the other. */
struct PlacedHoleHit {
  product::OccurrenceId a, b;
  product::FeatureId hole_a, hole_b;
};

/** Chooses among what engages, knowing all parts of the product. */
class AxisRules {
 public:
  /** Hits in the order of their pairs of parts; all must outlive this. Choices are of no use once
   the watch has ended them. */
  AxisRules(const InferenceLimits& limits, const std::vector<PlacedAxisHit>& hits,
            WorkWatch* watch = nullptr);

  /** Keeps of the hits [begin, end), which belong to one pair of parts, the working ones of each
   axis: none where a third part (a bushing) lies between, nor for a wide passage around a shaft
   that another part guides; the tightest of the long engagements, and those as tight as it that lie
   before or behind it. */
  [[nodiscard]] std::vector<const PlacedAxisHit*> ChooseWorking(std::size_t begin,
                                                                std::size_t end) const;

  /** True where nothing engages in both holes. */
  [[nodiscard]] bool IsUnbolted(const PlacedHoleHit& holes) const;

  [[nodiscard]] bool IsSameAxis(const PlacedAxisHit& s, const PlacedAxisHit& t) const;

 private:
  using Key = std::pair<product::OccurrenceId, product::FeatureId>;

  [[nodiscard]] bool HasPartBetween(const PlacedAxisHit& hit) const;
  [[nodiscard]] bool IsLoosePassage(const PlacedAxisHit& hit) const;

  InferenceLimits limits_;
  const std::vector<PlacedAxisHit>& hits_;
  WorkWatch* watch_;
  double cos_angle_{1};
  std::map<Key, std::vector<std::size_t>> hits_of_hole_;
  std::map<Key, std::vector<std::size_t>> hits_of_shaft_;
  std::map<product::OccurrenceId, std::vector<std::size_t>> hits_of_part_;  // By the shaft's.
};

}  // namespace hvas::mates
