#include "product/hole_patterns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/units.h"
#include "product/axis_features.h"

namespace hvas::product {
namespace {

constexpr std::size_t kLeast = 3;  // Holes of a pattern.
// The work for circles and rows goes with the square and the cube of the number of holes; a
// perforated plate or the vias of a board are asked only whether they are one grid.
constexpr std::size_t kMostForCircles = 400;
constexpr std::size_t kMostForRows = 60;

using Vec2 = Eigen::Vector2d;

bool IsHole(FormKind kind) {
  return kind == FormKind::kThroughHole || kind == FormKind::kBlindHole ||
         kind == FormKind::kSteppedHole || kind == FormKind::kCounterboredHole ||
         kind == FormKind::kCountersunkHole;
}

/** A hole of a group, in the plane of their entries. */
struct Spot {
  std::size_t form{0};
  Vec2 p;
};

struct Group {
  Vec3 origin;
  Eigen::Matrix3d R;  // From the frame whose z is along the holes.
  std::vector<Spot> spots;
};

bool IsAlike(const Form& a, const Form& b, double tolerance) {
  return a.kind == b.kind && a.count == b.count && a.axis_B.dot(b.axis_B) > 0 &&
         IsParallel(a.axis_B, b.axis_B) && std::abs(a.diameter - b.diameter) < tolerance &&
         std::abs(a.depth - b.depth) < tolerance &&
         std::abs((b.origin_B - a.origin_B).dot(a.axis_B)) < tolerance;
}

std::vector<Group> CollectGroups(const std::vector<Form>& forms, double tolerance) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    if (!IsHole(forms[i].kind)) {
      continue;
    }
    auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return IsAlike(forms[g.spots.front().form], forms[i], tolerance);
    });
    if (group == groups.end()) {
      groups.push_back(
          {forms[i].origin_B, spatial::FrameFromZ(forms[i].axis_B).toRotationMatrix(), {}});
      group = std::prev(groups.end());
    }
    const Vec3 q = group->R.transpose() * (forms[i].origin_B - group->origin);
    group->spots.push_back({i, q.head<2>()});
  }
  return groups;
}

/** Finds patterns in one group and takes their spots out of it. */
class PatternFinder {
 public:
  PatternFinder(const std::vector<Form>& forms, Group group, double tolerance)
      : forms_(forms), group_(std::move(group)), tolerance_(tolerance) {}

  std::vector<Form> Find(RecognitionLimits* limits) {
    if (group_.spots.size() < kLeast) {
      return {};
    }
    TryCircles(Centroid(), false, group_.spots.size());
    TryGrid();
    if (group_.spots.size() > kMostForCircles) {
      limits->Add("more than 400 equal holes for patterns on circles");
    }
    for (const Form& form : forms_) {
      const bool is_round =
          IsHole(form.kind) || form.kind == FormKind::kBoss || form.kind == FormKind::kShaft;
      if (is_round && group_.spots.size() <= kMostForCircles &&
          IsParallel(form.axis_B, group_.R.col(2))) {
        const Vec3 q = group_.R.transpose() * (form.origin_B - group_.origin);
        // One of its own is a centre only for all of the others.
        const std::size_t least = FindAt(q.head<2>()) ? group_.spots.size() - 1 : kLeast;
        TryCircles(q.head<2>(), true, std::max(least, kLeast));
      }
    }
    TryCircles(Centroid(), false, kLeast);
    TrySeparateCircles();
    if (group_.spots.size() > kMostForRows) {
      limits->Add("more than 60 equal holes for patterns in rows");
    }
    while (group_.spots.size() >= kLeast && group_.spots.size() <= kMostForRows && TryRow()) {
    }
    return std::move(patterns_);
  }

 private:
  [[nodiscard]] Vec2 Centroid() const {
    Vec2 sum = Vec2::Zero();
    for (const Spot& spot : group_.spots) {
      sum += spot.p;
    }
    return sum / std::max(1.0, static_cast<double>(group_.spots.size()));
  }

  void Add(const std::vector<std::size_t>& members, const Vec2& centre, double diameter) {
    Form form;
    form.kind = FormKind::kHolePattern;
    form.origin_B = group_.origin + group_.R * Vec3(centre.x(), centre.y(), 0);
    form.axis_B = group_.R.col(2);
    form.diameter = diameter;
    form.count = static_cast<int>(members.size());
    std::vector<std::size_t> sorted = members;
    std::sort(sorted.begin(), sorted.end());
    for (const std::size_t i : sorted) {
      const Form& hole = forms_[group_.spots[i].form];
      form.features.insert(form.features.end(), hole.features.begin(), hole.features.end());
      form.faces.insert(form.faces.end(), hole.faces.begin(), hole.faces.end());
    }
    for (auto it = sorted.rbegin(); it != sorted.rend(); ++it) {
      group_.spots.erase(group_.spots.begin() + static_cast<std::ptrdiff_t>(*it));
    }
    patterns_.push_back(std::move(form));
  }

  /** `least` spots or more at one distance from a centre, evenly around it. */
  void TryCircles(const Vec2& centre, bool is_axis, std::size_t least) {
    if (group_.spots.size() < kLeast) {
      return;
    }
    std::vector<std::pair<double, std::size_t>> by_distance;
    for (std::size_t i = 0; i < group_.spots.size(); ++i) {
      by_distance.emplace_back((group_.spots[i].p - centre).norm(), i);
    }
    std::sort(by_distance.begin(), by_distance.end());
    for (std::size_t begin = 0; begin < by_distance.size();) {
      std::size_t end = begin;
      std::vector<std::size_t> members;
      while (end < by_distance.size() &&
             by_distance[end].first < by_distance[begin].first + 2 * tolerance_) {
        members.push_back(by_distance[end++].second);
      }
      if (members.size() >= least && by_distance[begin].first > tolerance_ &&
          IsEven(members, centre, by_distance[begin].first, is_axis)) {
        Add(members, centre, 2 * by_distance[begin].first);
        return TryCircles(centre, is_axis, least);  // The indices have changed.
      }
      begin = end;
    }
  }

  /** Even steps all around; about the axis of something else a part of a circle will do, whose
   steps go into the full turn. */
  [[nodiscard]] bool IsEven(const std::vector<std::size_t>& members, const Vec2& centre,
                            double radius, bool is_axis) const {
    std::vector<double> angles;
    for (const std::size_t i : members) {
      const Vec2 q = group_.spots[i].p - centre;
      angles.push_back(std::atan2(q.y(), q.x()));
    }
    std::sort(angles.begin(), angles.end());
    std::vector<double> gaps;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double next = i + 1 < angles.size() ? angles[i + 1] : angles[0] + units::kTurn;
      gaps.push_back(next - angles[i]);
    }
    std::sort(gaps.begin(), gaps.end());
    const double slack = 4 * tolerance_ / radius;
    if (gaps.back() - gaps.front() < slack) {
      return true;
    }
    const double turns = units::kTurn / gaps.front();
    return is_axis && gaps[gaps.size() - 2] - gaps.front() < slack &&
           std::abs(turns - std::round(turns)) < slack * turns;
  }

  /** All spots in equal even circles beside each other: two bolt circles in one plate. */
  void TrySeparateCircles() {
    constexpr std::size_t kMostOnOne = 8;  // Holes on a circle beside others: a choice.
    for (std::size_t k = kMostOnOne; k >= kLeast; --k) {
      const std::size_t n = group_.spots.size();
      if (n % k != 0 || n <= k || n > kMostForRows) {
        continue;
      }
      const auto circles = FindPartition(k);
      if (circles.empty()) {
        continue;
      }
      // By their places: indices change as circles are taken out.
      std::vector<std::vector<Vec2>> members;
      for (const auto& circle : circles) {
        members.emplace_back();
        for (const std::size_t i : circle) {
          members.back().push_back(group_.spots[i].p);
        }
      }
      for (const auto& points : members) {
        std::vector<std::size_t> indices;
        Vec2 centre = Vec2::Zero();
        for (const Vec2& p : points) {
          indices.push_back(*FindAt(p));
          centre += p / static_cast<double>(points.size());
        }
        Add(indices, centre, 2 * (points.front() - centre).norm());
      }
      return;
    }
  }

  /** Divides all spots into even circles of k and of one radius, the smallest; empty where that
   cannot be. */
  [[nodiscard]] std::vector<std::vector<std::size_t>> FindPartition(std::size_t k) const {
    const auto& spots = group_.spots;
    std::vector<std::vector<std::size_t>> circles;
    std::vector<bool> is_used(spots.size(), false);
    double side = 0;
    for (std::size_t a = 0; a < spots.size(); ++a) {
      if (is_used[a]) {
        continue;
      }
      std::vector<std::size_t> best;
      double best_side = 0;
      for (std::size_t b = 0; b < spots.size(); ++b) {
        const double length = (spots[b].p - spots[a].p).norm();
        if (b == a || is_used[b] || (side > 0 && std::abs(length - side) > 2 * tolerance_) ||
            (!best.empty() && length >= best_side)) {
          continue;
        }
        const auto polygon = FindPolygon(a, b, k, is_used);
        if (!polygon.empty()) {
          best = polygon;
          best_side = length;
        }
      }
      if (best.empty()) {
        return {};
      }
      side = best_side;
      for (const std::size_t i : best) {
        is_used[i] = true;
      }
      circles.push_back(std::move(best));
    }
    return circles;
  }

  /** The regular polygon of k unused spots with the side from a to b, turning left; or empty. */
  [[nodiscard]] std::vector<std::size_t> FindPolygon(std::size_t a, std::size_t b, std::size_t k,
                                                     const std::vector<bool>& is_used) const {
    std::vector<std::size_t> polygon{a, b};
    Vec2 side = group_.spots[b].p - group_.spots[a].p;
    const Eigen::Rotation2Dd turn(units::kTurn / static_cast<double>(k));
    while (polygon.size() < k) {
      side = turn * side;
      const auto next = FindAt(group_.spots[polygon.back()].p + side);
      if (!next || is_used[*next]) {
        return {};
      }
      polygon.push_back(*next);
    }
    return polygon;
  }

  /** All spots in one full grid, whose directions are those from a corner to its nearest spots. */
  void TryGrid() {
    const auto& spots = group_.spots;
    if (spots.size() <= kLeast) {
      return;
    }
    // A corner: the spot farthest from the centre.
    const Vec2 centre = Centroid();
    std::size_t corner = 0;
    for (std::size_t i = 1; i < spots.size(); ++i) {
      if ((spots[i].p - centre).norm() > (spots[corner].p - centre).norm() + tolerance_) {
        corner = i;
      }
    }
    const auto u = FindNearest(corner, std::nullopt);
    const auto v = u ? FindNearest(corner, *u) : std::nullopt;
    if (!v) {
      return;
    }
    long columns = 0;
    long rows = 0;
    for (const Spot& spot : spots) {
      const Vec2 q = spot.p - spots[corner].p;
      const double a = q.dot(*u) / u->squaredNorm();
      const double b = q.dot(*v) / v->squaredNorm();
      if ((q - std::round(a) * *u - std::round(b) * *v).norm() > 2 * tolerance_ ||
          std::round(a) < 0 || std::round(b) < 0) {
        return;
      }
      columns = std::max(columns, std::lround(a) + 1);
      rows = std::max(rows, std::lround(b) + 1);
    }
    if (columns > 1 && rows > 1 && columns * rows == static_cast<long>(spots.size())) {
      std::vector<std::size_t> all(spots.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] = i;
      }
      Add(all, centre, 0);
    }
  }

  /** From a spot to its nearest one, at a right angle to `across` where that is given. */
  [[nodiscard]] std::optional<Vec2> FindNearest(std::size_t from,
                                                std::optional<Vec2> across) const {
    std::optional<Vec2> nearest;
    for (std::size_t i = 0; i < group_.spots.size(); ++i) {
      const Vec2 q = group_.spots[i].p - group_.spots[from].p;
      const bool is_right = !across || std::abs(q.dot(*across)) < 2 * tolerance_ * across->norm();
      if (i != from && is_right && (!nearest || q.norm() < nearest->norm() - tolerance_)) {
        nearest = q;
      }
    }
    return nearest;
  }

  /** The longest evenly spaced row of at least three; spots between its own break it. */
  bool TryRow() {
    const auto& spots = group_.spots;
    std::vector<std::size_t> best;
    for (std::size_t a = 0; a < spots.size(); ++a) {
      for (std::size_t b = 0; b < spots.size(); ++b) {
        if (a == b) {
          continue;
        }
        const Vec2 step = spots[b].p - spots[a].p;
        if (FindAt(spots[a].p - step) || FindAt(spots[a].p + 0.5 * step)) {
          continue;  // Not its first, or not its neighbour.
        }
        std::vector<std::size_t> row{a, b};
        for (auto next = FindAt(spots[b].p + step); next; next = FindAt(spots[*next].p + step)) {
          row.push_back(*next);
        }
        if (row.size() > best.size() ||
            (row.size() == best.size() && step.norm() < Step(best) - tolerance_)) {
          best = row;
        }
      }
    }
    if (best.size() < kLeast) {
      return false;
    }
    const Vec2 centre = 0.5 * (spots[best.front()].p + spots[best.back()].p);
    Add(best, centre, 0);
    return true;
  }

  [[nodiscard]] double Step(const std::vector<std::size_t>& row) const {
    return (group_.spots[row[1]].p - group_.spots[row[0]].p).norm();
  }

  [[nodiscard]] std::optional<std::size_t> FindAt(const Vec2& p) const {
    for (std::size_t i = 0; i < group_.spots.size(); ++i) {
      if ((group_.spots[i].p - p).norm() < 2 * tolerance_) {
        return i;
      }
    }
    return std::nullopt;
  }

  const std::vector<Form>& forms_;
  Group group_;
  double tolerance_;
  std::vector<Form> patterns_;
};

}  // namespace

std::vector<Form> FindHolePatterns(const std::vector<Form>& forms, double tolerance,
                                   RecognitionLimits* limits) {
  std::vector<Form> patterns;
  for (Group& group : CollectGroups(forms, tolerance)) {
    const std::vector<Form> found = PatternFinder(forms, std::move(group), tolerance).Find(limits);
    patterns.insert(patterns.end(), found.begin(), found.end());
  }
  return patterns;
}

}  // namespace hvas::product
