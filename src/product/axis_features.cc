#include "product/axis_features.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "base/units.h"

namespace hvas::product {
namespace {

// Angles of docs/algorithms/features.md, "Round enough to hold": more than half a turn, with a
// margin.
constexpr double kLeastCoverage = units::FromDeg(200);
constexpr double kLargestGap = units::FromDeg(160);  // What 200 deg in one piece leave.
constexpr double kLeastSum = units::FromDeg(60);     // Of several arcs.
constexpr double kShortestArc = units::FromDeg(20);  // That guides; the tips of teeth do not.
// Half a turn: what ends a slot or a tongue between its two walls, within the deviation of meshes.
constexpr double kHalfTurn = units::FromDeg(180);
constexpr double kHalfTurnSlack = units::FromDeg(2);
constexpr double kSameDirection = 1e-3;  // Same direction or half angle [rad].

using Arc = std::pair<double, double>;  // Start and length [rad].

/** A face with its extent along its axis and around it. */
struct AxisFace {
  std::uint32_t face{0};
  double low{0}, high{0};  // Along the axis of its group [m].
  std::vector<Arc> arcs;   // Covered.
};

/** Faces of one surface and sense; may still fall apart along the axis. */
struct AxisGroup {
  Surface surface;
  double slack{0};  // How far its surface may be off [m].
  std::vector<AxisFace> faces;
};

AxisFace MeasureFace(const Part& part, std::uint32_t index, const Surface& surface) {
  const Face& face = part.faces[index];
  const Mat3 R = spatial::FrameFromZ(surface.axis).toRotationMatrix();
  AxisFace measured;
  measured.face = index;
  measured.low = std::numeric_limits<double>::infinity();
  measured.high = -measured.low;
  for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
    const auto& triangle = part.mesh.triangles[face.first_triangle + i];
    std::array<double, 3> angle{};
    std::size_t count = 0;
    for (const std::uint32_t vertex : triangle) {
      const Vec3 q = R.transpose() * (part.mesh.vertices[vertex] - surface.origin);
      measured.low = std::min(measured.low, q.z());
      measured.high = std::max(measured.high, q.z());
      constexpr double kOnAxis = 1e-9;  // The apex of a cone has no angle [m].
      if (std::hypot(q.x(), q.y()) > kOnAxis) {
        angle[count++] = std::atan2(q.y(), q.x());
      }
    }
    // A triangle spans less than half a turn: unwrap about its first corner.
    double low = 0;
    double high = 0;
    for (std::size_t k = 1; k < count; ++k) {
      const double turn = std::remainder(angle[k] - angle[0], units::kTurn);
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    measured.arcs.emplace_back(angle[0] + low, high - low);
  }
  return measured;
}

struct Coverage {
  double sum{0};  ///< Length of the union of arcs [rad].
  double largest_gap{units::kTurn};
};

/** The union of arcs as arcs that do not touch, by their start in [0, 2 pi); the last may go on
 beyond 2 pi. */
std::vector<Arc> MergeArcs(const std::vector<const AxisFace*>& faces) {
  constexpr double kTouching = 1e-6;  // Rounding between neighbouring triangles [rad].
  std::vector<Arc> arcs;
  for (const AxisFace* face : faces) {
    for (const auto& [start, length] : face->arcs) {
      arcs.emplace_back(start - units::kTurn * std::floor(start / units::kTurn), length);
    }
  }
  std::sort(arcs.begin(), arcs.end());
  std::vector<Arc> merged;
  const auto end_of = [](const Arc& arc) { return arc.first + arc.second; };
  for (const Arc& arc : arcs) {
    if (merged.empty() || arc.first > end_of(merged.back()) + kTouching) {
      merged.push_back(arc);
    } else {
      Arc& last = merged.back();
      last.second = std::max(last.second, end_of(arc) - last.first);
    }
  }
  // What reaches beyond a full turn covers the first ones.
  while (merged.size() > 1 &&
         end_of(merged.back()) - units::kTurn + kTouching >= merged.front().first) {
    Arc& last = merged.back();
    last.second = std::max(last.second, end_of(merged.front()) + units::kTurn - last.first);
    merged.erase(merged.begin());
  }
  return merged;
}

/** Of the arcs that are `shortest` or longer. */
Coverage CalcCoverage(const std::vector<const AxisFace*>& faces, double shortest = 0) {
  std::vector<Arc> arcs = MergeArcs(faces);
  arcs.erase(std::remove_if(arcs.begin(), arcs.end(),
                            [shortest](const Arc& arc) { return arc.second < shortest; }),
             arcs.end());
  Coverage coverage;
  if (arcs.empty()) {
    return coverage;
  }
  coverage.largest_gap = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const Arc& next = arcs[(i + 1) % arcs.size()];
    const double turn = i + 1 == arcs.size() ? units::kTurn : 0;
    const double gap = next.first + turn - arcs[i].first - arcs[i].second;
    coverage.largest_gap = std::max(coverage.largest_gap, gap);
    coverage.sum += std::min(arcs[i].second, units::kTurn);
  }
  return coverage;
}

std::vector<const AxisFace*> PointTo(const std::vector<AxisFace>& faces) {
  std::vector<const AxisFace*> pointers(faces.size());
  std::transform(faces.begin(), faces.end(), pointers.begin(),
                 [](const AxisFace& face) { return &face; });
  return pointers;
}

constexpr std::size_t kMostFaces = 64;  // Beyond that it is a pattern of some kind, no bore.

/** The smallest of the largest gaps at any station along the axis [rad]. */
double CalcLeastGap(const std::vector<AxisFace>& faces) {
  double least = units::kTurn;
  if (faces.size() > kMostFaces) {
    return least;
  }
  for (const AxisFace& at : faces) {
    const double station = 0.5 * (at.low + at.high);
    std::vector<const AxisFace*> there;
    for (const AxisFace& face : faces) {
      if (face.low <= station && station <= face.high) {
        there.push_back(&face);
      }
    }
    const Coverage coverage = CalcCoverage(there, kShortestArc);
    if (coverage.sum >= kLeastSum) {
      least = std::min(least, coverage.largest_gap);
    }
  }
  return least;
}

constexpr std::size_t kLeastTeeth = 12;  // Of a spline; fewer are a polygon or keys. A choice.
constexpr std::size_t kMostTeeth = 400;  // Beyond that a knurl holds nothing. A choice.

/** Whether faces are the ends of teeth: short arcs, evenly around the axis. */
bool AreTeeth(const std::vector<AxisFace>& faces) {
  constexpr double kUneven = 1.5;  // Largest gap, of the mean one: a choice.
  if (faces.size() < kLeastTeeth || faces.size() > kMostTeeth) {
    return false;
  }
  const std::vector<const AxisFace*> pointers = PointTo(faces);
  const std::vector<Arc> arcs = MergeArcs(pointers);
  const bool are_short = std::all_of(arcs.begin(), arcs.end(),
                                     [](const Arc& arc) { return arc.second < kShortestArc; });
  const Coverage coverage = CalcCoverage(pointers);
  const double mean_gap = (units::kTurn - coverage.sum) / static_cast<double>(arcs.size());
  return are_short && arcs.size() >= kLeastTeeth && coverage.largest_gap < kUneven * mean_gap;
}

/** Whether two cylinders or cones are one, looked at near the face that the second is under. */
bool IsSameSurface(const Surface& a, const Surface& b, const Box& box_b, double tolerance) {
  if (a.kind != b.kind || a.outward != b.outward || !IsParallel(a.axis, b.axis)) {
    return false;
  }
  const Vec3 near = b.origin + (box_b.centre() - b.origin).dot(b.axis) * b.axis;
  if (DistanceToAxis(near, a.origin, a.axis) >= tolerance) {
    return false;
  }
  if (a.kind == SurfaceKind::kCylinder) {
    return std::abs(a.radius - b.radius) < tolerance;
  }
  const double radius = (near - b.origin).norm() * std::tan(b.second);
  return std::abs(a.second - b.second) < kSameDirection && a.axis.dot(b.axis) > 0 &&
         std::abs((near - a.origin).dot(a.axis) * std::tan(a.second) - radius) < tolerance;
}

/** Groups the faces of one kind of surface. The search looks only at groups whose key, the radius
 or the half angle, is near. */
std::vector<AxisGroup> GroupFaces(const Part& part, SurfaceKind kind, double tolerance) {
  std::vector<AxisGroup> groups;
  std::multimap<double, std::size_t> by_key;
  for (std::uint32_t i = 0; i < part.faces.size(); ++i) {
    const Face& face = part.faces[i];
    if (face.surface.kind != kind || face.triangle_count == 0) {
      continue;
    }
    Surface surface = face.surface;
    if (kind == SurfaceKind::kCylinder) {
      surface.axis = Canonical(surface.axis);
    }
    const double key = kind == SurfaceKind::kCylinder ? surface.radius : surface.second;
    const double slack = tolerance + face.residual;
    const double reach = kind == SurfaceKind::kCylinder ? 2 * slack : kSameDirection;
    std::size_t found = groups.size();
    for (auto it = by_key.lower_bound(key - reach); it != by_key.end() && it->first <= key + reach;
         ++it) {
      const AxisGroup& group = groups[it->second];
      if (it->second < found &&
          IsSameSurface(group.surface, surface, face.box_B, std::max(slack, group.slack))) {
        found = it->second;
      }
    }
    if (found == groups.size()) {
      groups.push_back({surface, slack, {}});
      by_key.emplace(key, found);
    }
    groups[found].faces.push_back(MeasureFace(part, i, groups[found].surface));
  }
  return groups;
}

FeatureKind KindOf(const Surface& surface) {
  if (surface.kind == SurfaceKind::kCylinder) {
    return surface.outward > 0 ? FeatureKind::kShaft : FeatureKind::kHole;
  }
  return surface.outward > 0 ? FeatureKind::kTaper : FeatureKind::kConeSeat;
}

/** From faces that touch along the axis; a cylinder's origin is the middle of its span. */
Feature MakeFeature(const Part& part, const Surface& surface, std::vector<AxisFace> faces) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  Feature feature;
  feature.kind = KindOf(surface);
  std::sort(faces.begin(), faces.end(),
            [](const AxisFace& a, const AxisFace& b) { return a.face < b.face; });
  std::vector<const AxisFace*> pointers;
  for (const AxisFace& face : faces) {
    low = std::min(low, face.low);
    high = std::max(high, face.high);
    feature.area += part.faces[face.face].area;
    feature.faces.emplace_back(face.face);
    pointers.push_back(&face);
  }
  feature.coverage = CalcCoverage(pointers).sum;
  feature.axis_B = surface.axis;
  if (surface.kind == SurfaceKind::kCylinder) {
    feature.origin_B = surface.origin + 0.5 * (low + high) * surface.axis;
    feature.radius = surface.radius;
    feature.span_low = -0.5 * (high - low);
    feature.span_high = 0.5 * (high - low);
  } else {
    feature.origin_B = surface.origin;
    feature.half_angle = surface.second;
    feature.span_low = std::max(0.0, low);
    feature.span_high = high;
    feature.radius = high * std::tan(surface.second);
  }
  return feature;
}

/** Takes out the features of several arcs that another one of the same axis keeps everything away
 from: the bottoms of splines and of grooves along a bore. */
void RemoveShielded(double tolerance, std::vector<Feature>* features) {
  const auto is_shielded = [&](const Feature& outer) {
    if (outer.coverage >= kLeastCoverage || !IsCylinder(outer.kind)) {
      return false;
    }
    return std::any_of(features->begin(), features->end(), [&](const Feature& inner) {
      const double sense = outer.kind == FeatureKind::kHole ? 1 : -1;
      const double offset = (inner.origin_B - outer.origin_B).dot(outer.axis_B);
      const double common = std::min(outer.span_high, offset + inner.span_high) -
                            std::max(outer.span_low, offset + inner.span_low);
      return inner.kind == outer.kind && sense * (outer.radius - inner.radius) > tolerance &&
             IsParallel(inner.axis_B, outer.axis_B) &&
             DistanceToAxis(inner.origin_B, outer.origin_B, outer.axis_B) < tolerance &&
             common > 0.5 * (outer.span_high - outer.span_low);
    });
  };
  std::vector<bool> is_out;
  for (const Feature& feature : *features) {
    is_out.push_back(is_shielded(feature));
  }
  std::size_t i = 0;
  features->erase(std::remove_if(features->begin(), features->end(),
                                 [&](const Feature&) { return is_out[i++]; }),
                  features->end());
}

/** Whether faces cover half a turn in one piece. */
bool IsHalfTurn(const std::vector<AxisFace>& faces) {
  const std::vector<const AxisFace*> pointers = PointTo(faces);
  const Coverage coverage = CalcCoverage(pointers);
  return std::abs(coverage.sum - kHalfTurn) < kHalfTurnSlack &&
         std::abs(coverage.largest_gap - kHalfTurn) < kHalfTurnSlack;
}

/** Features that hold nothing by themselves. */
struct PartialFeatures {
  std::vector<Feature> toothed;
  std::vector<Feature> half_turns;
};

std::vector<Feature> FindAxisFeatures(const Part& part, SurfaceKind kind, double tolerance,
                                      RecognitionLimits* limits,
                                      PartialFeatures* partial = nullptr) {
  std::vector<Feature> found;
  for (AxisGroup& group : GroupFaces(part, kind, tolerance)) {
    std::sort(group.faces.begin(), group.faces.end(), [](const AxisFace& a, const AxisFace& b) {
      return std::pair(a.low, a.face) < std::pair(b.low, b.face);
    });
    std::vector<AxisFace> run;
    double end = 0;
    const auto flush = [&] {
      if (run.empty()) {
        return;
      }
      const bool is_limited = run.size() > kMostFaces;
      const double gap = run.size() > 1 ? CalcLeastGap(run) : units::kTurn;
      const bool is_toothed = partial != nullptr && AreTeeth(run);
      const bool is_half = partial != nullptr && !is_limited && IsHalfTurn(run);
      Feature feature = MakeFeature(part, group.surface, std::move(run));
      if (feature.coverage >= kLeastCoverage || gap <= kLargestGap) {
        found.push_back(std::move(feature));
      } else if (is_toothed) {
        partial->toothed.push_back(std::move(feature));
      } else if (is_half) {
        partial->half_turns.push_back(std::move(feature));
      } else if (is_limited) {
        limits->Add("more than 64 faces on one axis");
      }
      run = {};
    };
    for (AxisFace& face : group.faces) {
      if (!run.empty() && face.low > end + tolerance) {
        flush();
      }
      end = run.empty() ? face.high : std::max(end, face.high);
      run.push_back(std::move(face));
    }
    flush();
  }
  std::stable_sort(found.begin(), found.end(), [](const Feature& a, const Feature& b) {
    return a.faces.front() < b.faces.front();
  });
  RemoveShielded(tolerance, &found);
  return found;
}

/** Keeps the half turns that end a slot or a tongue: one of the same radius and sense looks the
 other way, and the line between their axes is the middle of both. */
void KeepRoundEnds(const Part& part, double tolerance, std::vector<Feature>* half_turns) {
  constexpr double kAlong = 0.99;  // Cosine of what a middle may lie beside the line: 8 degrees.
  std::vector<Vec3> middles;
  middles.reserve(half_turns->size());
  for (const Feature& feature : *half_turns) {
    middles.push_back(CalcArcDirection(part, feature).normalized());
  }
  const auto has_partner = [&](std::size_t i) {
    const Feature& own = (*half_turns)[i];
    for (std::size_t k = 0; k < half_turns->size(); ++k) {
      const Feature& other = (*half_turns)[k];
      const Vec3 offset = own.origin_B - other.origin_B;
      const Vec3 away = offset - offset.dot(own.axis_B) * own.axis_B;
      const double common = std::min(own.span_high, other.span_high - offset.dot(own.axis_B)) -
                            std::max(own.span_low, other.span_low - offset.dot(own.axis_B));
      if (other.kind == own.kind && IsParallel(own.axis_B, other.axis_B) &&
          std::abs(own.radius - other.radius) < tolerance && away.norm() > tolerance &&
          common > 0.5 * (own.span_high - own.span_low) &&
          middles[i].dot(away.normalized()) > kAlong &&
          middles[k].dot(-away.normalized()) > kAlong) {
        return true;
      }
    }
    return false;
  };
  std::vector<Feature> ends;
  for (std::size_t i = 0; i < half_turns->size(); ++i) {
    if (has_partner(i)) {
      ends.push_back((*half_turns)[i]);
    }
  }
  *half_turns = std::move(ends);
}

}  // namespace

Vec3 Canonical(const Vec3& axis) {
  Vec3::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? Vec3(-axis) : axis;
}

bool IsParallel(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() < kSameDirection;
}

double DistanceToAxis(const Vec3& p, const Vec3& origin, const Vec3& axis) {
  return (p - origin).cross(axis).norm();
}

Vec3 CalcArcDirection(const Part& part, const Feature& feature) {
  double area = 0;
  Vec3 sum = Vec3::Zero();
  for (const FaceId id : feature.faces) {
    const Face& face = part.faces[id.index()];
    for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
      const auto& [a, b, c] = part.mesh.triangles[face.first_triangle + i];
      const Vec3& p = part.mesh.vertices[a];
      const Vec3& q = part.mesh.vertices[b];
      const Vec3& r = part.mesh.vertices[c];
      const double piece = 0.5 * (q - p).cross(r - p).norm();
      const Vec3 from_origin = (p + q + r) / 3 - feature.origin_B;
      const Vec3 radial = from_origin - from_origin.dot(feature.axis_B) * feature.axis_B;
      area += piece;
      sum += piece * radial.normalized();
    }
  }
  return area > 0 ? Vec3(sum / area) : Vec3::Zero();
}

bool IsRoundEnd(const Feature& feature) {
  return IsCylinder(feature.kind) && std::abs(feature.coverage - kHalfTurn) < kHalfTurnSlack;
}

std::vector<Feature> FindCylinders(const Part& part, double tolerance, RecognitionLimits* limits,
                                   std::vector<Feature>* partial) {
  PartialFeatures found;
  std::vector<Feature> whole =
      FindAxisFeatures(part, SurfaceKind::kCylinder, tolerance, limits, &found);
  *partial = std::move(found.toothed);
  KeepRoundEnds(part, tolerance, &found.half_turns);
  partial->insert(partial->end(), found.half_turns.begin(), found.half_turns.end());
  return whole;
}

bool IsToothed(const Feature& feature) {
  return IsCylinder(feature.kind) && feature.faces.size() >= kLeastTeeth &&
         feature.coverage < kLeastCoverage &&
         feature.coverage < kShortestArc * static_cast<double>(feature.faces.size());
}

std::vector<Feature> FindCones(const Part& part, double tolerance, RecognitionLimits* limits) {
  return FindAxisFeatures(part, SurfaceKind::kCone, tolerance, limits);
}

}  // namespace hvas::product
