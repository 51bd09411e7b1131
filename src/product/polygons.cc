#include "product/polygons.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "product/axis_features.h"
#include "product/flats.h"
#include "product/mesh_ray.h"

namespace hvas::product {
namespace {

constexpr std::size_t kMostPairs = 4000;  // Of opposite planes; a choice, for the time it takes.
constexpr double kCentred = 0.25;         // Of the width, by which a flat's middle may be aside.
constexpr double kLeastDepth = 0.05;      // Of the width: a chamfer's rest is no form. A choice.

/** Two opposite flats: `width` apart, and away from one another (outside) or facing (a recess). */
struct FlatPair {
  const Flat* a;
  const Flat* b;
  double width;
  double middle;  ///< Offset of the middle plane along the normal of `a` [m].
  bool is_recess;
};

std::vector<FlatPair> CollectFlatPairs(const std::vector<Flat>& flats, RecognitionLimits* limits) {
  std::vector<FlatPair> pairs;
  for (std::size_t i = 0; i < flats.size(); ++i) {
    for (std::size_t j = i + 1; j < flats.size(); ++j) {
      const Flat& a = flats[i];
      const Flat& b = flats[j];
      if (a.normal.dot(b.normal) > -1 + 0.5 * kSameFlatAngle * kSameFlatAngle) {
        continue;
      }
      const double width = (a.centre - b.centre).dot(a.normal);
      if (std::abs(width) == 0) {
        continue;
      }
      if (pairs.size() == kMostPairs) {
        limits->Add("more than 4,000 pairs of planes for drives and polygons");
        return pairs;
      }
      pairs.push_back(
          {&a, &b, std::abs(width), 0.5 * (a.centre + b.centre).dot(a.normal), width < 0});
    }
  }
  return pairs;
}

/** Point of the line with direction n_p x n_q in which the middle planes of two pairs meet. */
Vec3 CalcLinePoint(const FlatPair& p, const FlatPair& q, const Vec3& near) {
  Mat3 A;
  const Vec3 axis = p.a->normal.cross(q.a->normal).normalized();
  A.row(0) = p.a->normal;
  A.row(1) = q.a->normal;
  A.row(2) = axis;
  return A.inverse() * Vec3(p.middle, q.middle, axis.dot(near));
}

/** Whether a flat is a side of a polygon about an axis: its middle is at the axis, seen along its
 normal. */
bool IsCentred(const Part& part, const Flat& flat, const Vec3& origin, const Vec3& axis,
               double width) {
  const FlatExtent side = CalcFlatExtent(part, flat.face, origin, axis.cross(flat.normal));
  return std::abs(0.5 * (side.low + side.high)) < kCentred * width;
}

/** Whether a pocket lets its counterpart through at an end: beside its flats nothing is in front,
 however wide a hole is in its floor. */
bool IsOpenBesideFlats(const Part& part, const PolygonForm& polygon, const Vec3& middle,
                       const Vec3& direction) {
  constexpr double kBeside = 0.45;  // Of the width, from the axis: near the flats. A choice.
  return std::none_of(polygon.faces.begin(), polygon.faces.end(), [&](FaceId face) {
    const Vec3& n = part.faces[face.index()].surface.axis;
    return IsBlocked(part, middle - kBeside * polygon.width * n, direction,
                     part.box_B.size().norm());
  });
}

/** Gives a pocket with a hole in its floor its one open end. */
void CloseFloor(const Part& part, PolygonForm* polygon) {
  if (polygon->kind != PolygonKind::kRegular || !polygon->is_recess || !polygon->is_through) {
    return;
  }
  const Vec3 middle = polygon->origin_B + 0.5 * polygon->depth * polygon->axis_B;
  const bool is_open_here = IsOpenBesideFlats(part, *polygon, middle, -polygon->axis_B);
  const bool is_open_there = IsOpenBesideFlats(part, *polygon, middle, polygon->axis_B);
  polygon->is_through = is_open_here == is_open_there;
  if (!is_open_here && is_open_there) {
    polygon->origin_B += polygon->depth * polygon->axis_B;
    polygon->axis_B = -polygon->axis_B;
  }
}

/** Completes a polygon whose kind, sense, width, flats and number of sides are there. */
std::optional<PolygonForm> Complete(const Part& part, PolygonForm polygon, const Vec3& origin,
                                    const Vec3& axis, const FlatExtent& along) {
  if (along.length() < kLeastDepth * polygon.width) {
    return std::nullopt;
  }
  std::sort(polygon.faces.begin(), polygon.faces.end());
  polygon.flat_B = part.faces[polygon.faces.front().index()].surface.axis;
  const double across = std::max(polygon.width, polygon.diameter);
  const auto end = FindOpenEnd(part, polygon.faces, polygon.is_recess, across, origin, axis, along);
  if (!end) {
    return std::nullopt;
  }
  polygon.origin_B = end->origin_B;
  polygon.axis_B = end->axis_B;
  polygon.depth = end->depth;
  polygon.is_through = end->is_through;
  CloseFloor(part, &polygon);
  return polygon;
}

FlatExtent Unbounded() {
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

/** Narrows what all flats have along an axis to that of one more. */
void Narrow(const FlatExtent& extent, FlatExtent* along) {
  along->low = std::max(along->low, extent.low);
  along->high = std::min(along->high, extent.high);
}

/** The regular polygon of pairs of flats, where they make one. */
std::optional<PolygonForm> MakeRegular(const Part& part, const std::vector<const FlatPair*>& pairs,
                                       double tolerance) {
  const FlatPair& p = *pairs[0];
  const Vec3 axis = Canonical(p.a->normal.cross(pairs[1]->a->normal).normalized());
  const Vec3 origin = CalcLinePoint(p, *pairs[1], p.a->centre);
  PolygonForm polygon;
  polygon.sides = static_cast<int>(2 * pairs.size());
  polygon.is_recess = p.is_recess;
  polygon.width = p.width;
  FlatExtent along = Unbounded();
  for (const FlatPair* pair : pairs) {
    if (std::abs(pair->a->normal.dot(axis)) > kSameFlatAngle ||
        std::abs(pair->a->normal.dot(origin) - pair->middle) >
            4 * tolerance + kSameFlatWidth * pair->width) {
      return std::nullopt;
    }
    for (const Flat* flat : {pair->a, pair->b}) {
      if (!IsCentred(part, *flat, origin, axis, p.width)) {
        return std::nullopt;
      }
      Narrow(CalcFlatExtent(part, flat->face, origin, axis), &along);
      polygon.faces.push_back(flat->face);
    }
  }
  auto made = Complete(part, std::move(polygon), origin, axis, along);
  if (made) {
    made->flat_B = p.a->normal;
  }
  return made;
}

/** Whether two pairs of flats can belong to a regular polygon with so many sides. */
bool DoBelong(const FlatPair& p, const FlatPair& q, int sides) {
  if (p.is_recess != q.is_recess || std::abs(p.width - q.width) > kSameFlatWidth * p.width) {
    return false;
  }
  const double corner = 2 * std::numbers::pi / sides;
  const double angle = std::acos(std::clamp(p.a->normal.dot(q.a->normal), -1.0, 1.0));
  const double turns = angle / corner;
  return std::abs(turns - std::round(turns)) * corner < kSameFlatAngle && angle > 0.5 * corner &&
         angle < std::numbers::pi - 0.5 * corner;
}

/** Adds the polygons with `left` more pairs of flats than the chosen ones, from number `from` on.
 */
void AddRegular(const Part& part, const std::vector<FlatPair>& pairs, std::size_t from, int sides,
                double tolerance, std::vector<const FlatPair*>* chosen,
                std::vector<PolygonForm>* found) {
  if (static_cast<int>(2 * chosen->size()) == sides) {
    if (auto polygon = MakeRegular(part, *chosen, tolerance)) {
      found->push_back(std::move(*polygon));
    }
    return;
  }
  for (std::size_t i = from; i < pairs.size(); ++i) {
    const bool may_be = std::all_of(chosen->begin(), chosen->end(), [&](const FlatPair* pair) {
      return DoBelong(*pair, pairs[i], sides);
    });
    if (may_be) {
      chosen->push_back(&pairs[i]);
      AddRegular(part, pairs, i + 1, sides, tolerance, chosen, found);
      chosen->pop_back();
    }
  }
}

/** A flat beside an axis. */
struct SideFlat {
  FaceId face;
  Vec3 normal;
  double
      distance;  ///< Signed distance of its plane from the axis; positive: it looks away from it.
  FlatExtent side;   ///< Extent along the flat, across the axis, from the axis.
  FlatExtent along;  ///< Extent along the axis.

  [[nodiscard]] double middle() const { return 0.5 * (side.low + side.high); }
};

/** The flats beside the axis of a hole or shaft. */
struct AxisFlats {
  Vec3 origin;
  Vec3 axis;
  FlatExtent along;  ///< Of the hole or shaft.
  std::vector<SideFlat> flats;
};

AxisFlats CollectAround(const Part& part, const Feature& feature, const std::vector<Flat>& flats) {
  constexpr double kFarthest = 1.2;  // Of the radius: teeth are beside a bore. A choice.
  const double sense = feature.axis_B.dot(Canonical(feature.axis_B));
  AxisFlats around{feature.origin_B, Canonical(feature.axis_B), {}, {}};
  around.along.Add(sense * feature.span_low);
  around.along.Add(sense * feature.span_high);
  for (const Flat& flat : flats) {
    if (std::abs(flat.normal.dot(around.axis)) > kSameFlatAngle ||
        DistanceToAxis(flat.centre, around.origin, around.axis) > kFarthest * feature.radius) {
      continue;
    }
    const SideFlat beside{
        flat.face, flat.normal, flat.normal.dot(flat.centre - around.origin),
        CalcFlatExtent(part, flat.face, around.origin, around.axis.cross(flat.normal)),
        CalcFlatExtent(part, flat.face, around.origin, around.axis)};
    if (beside.along.low < around.along.high && around.along.low < beside.along.high) {
      around.flats.push_back(beside);
    }
  }
  return around;
}

/** Whether a flat cuts a round: it is as wide as the chord at its distance. */
bool IsChord(const SideFlat& flat, double radius) {
  constexpr double kNearest = 0.3;    // Of the radius: farther in it is a half, no flat. A choice.
  constexpr double kSameChord = 0.1;  // Of the chord: edges are broken. A choice.
  const double distance = std::abs(flat.distance);
  if (distance < kNearest * radius || distance > (1 - kSameFlatWidth) * radius) {
    return false;
  }
  const double chord = 2 * std::sqrt(radius * radius - distance * distance);
  return std::abs(flat.side.length() - chord) < kSameChord * chord &&
         2 * std::abs(flat.middle()) < kSameChord * chord;
}

/** D and double D about a hole or shaft. */
std::optional<PolygonForm> FindFlatted(const Part& part, const Feature& feature,
                                       const AxisFlats& around, double tolerance) {
  std::vector<const SideFlat*> chords;
  for (const SideFlat& flat : around.flats) {
    if ((flat.distance < 0) == (feature.kind == FeatureKind::kHole) &&
        IsChord(flat, feature.radius)) {
      chords.push_back(&flat);
    }
  }
  if (chords.empty() || chords.size() > 2) {
    return std::nullopt;
  }
  const double distance = std::abs(chords.front()->distance);
  const double off = std::abs(std::abs(chords.back()->distance) - distance);
  if (chords.size() == 2 && (off > 4 * tolerance + kSameFlatWidth * distance ||
                             chords[0]->normal.dot(chords[1]->normal) > -1 + kSameFlatAngle)) {
    return std::nullopt;
  }
  PolygonForm polygon;
  polygon.kind = PolygonKind::kFlatted;
  polygon.sides = static_cast<int>(chords.size());
  polygon.is_recess = feature.kind == FeatureKind::kHole;
  polygon.diameter = 2 * feature.radius;
  polygon.width = chords.size() == 1 ? feature.radius + distance : 2 * distance;
  FlatExtent along = around.along;
  for (const SideFlat* flat : chords) {
    Narrow(flat->along, &along);
    polygon.faces.push_back(flat->face);
  }
  return Complete(part, std::move(polygon), around.origin, around.axis, along);
}

/** Whether angles are multiples of an n-th of a turn from the first one. */
bool AreEven(const std::vector<double>& angles, int n) {
  constexpr double kEvenAngle = 0.02;  // Of the angle between teeth. A choice.
  return std::all_of(angles.begin(), angles.end(), [&](double angle) {
    const double steps = (angle - angles.front()) * n / (2 * std::numbers::pi);
    return std::abs(steps - std::round(steps)) < kEvenAngle;
  });
}

/** The spline whose teeth are so wide, about a hole or shaft. */
std::optional<PolygonForm> MakeSpline(const Part& part, const Feature& feature,
                                      const AxisFlats& around, double half_width,
                                      double tolerance) {
  constexpr std::size_t kLeastSplineTeeth = 4;  // Fewer are keys. A choice.
  constexpr double kFarOut = 0.4;  // Of the radius: where flanks have their middle at least.
  PolygonForm polygon;
  polygon.kind = PolygonKind::kSpline;
  polygon.is_recess = feature.kind == FeatureKind::kHole;
  polygon.diameter = 2 * feature.radius;
  polygon.width = 2 * half_width;
  FlatExtent along = Unbounded();
  std::vector<double> left;  // Angles of the flanks on either side of their teeth.
  std::vector<double> right;
  const Mat3 R = spatial::FrameFromZ(around.axis).toRotationMatrix();
  for (const SideFlat& flat : around.flats) {
    if ((flat.distance < 0) != polygon.is_recess ||
        std::abs(std::abs(flat.distance) - half_width) > 4 * tolerance ||
        std::abs(flat.middle()) < kFarOut * feature.radius) {
      continue;
    }
    const Vec3 n = R.transpose() * flat.normal;
    (flat.middle() > 0 ? left : right).push_back(std::atan2(n.y(), n.x()));
    polygon.faces.push_back(flat.face);
    Narrow(flat.along, &along);
  }
  polygon.sides = static_cast<int>(left.size());
  if (left.size() < kLeastSplineTeeth || left.size() != right.size() ||
      !AreEven(left, polygon.sides) || !AreEven(right, polygon.sides)) {
    return std::nullopt;
  }
  return Complete(part, std::move(polygon), around.origin, around.axis, along);
}

std::optional<PolygonForm> FindSpline(const Part& part, const Feature& feature,
                                      const AxisFlats& around, double tolerance) {
  constexpr double kWidest = 0.6;  // Half a tooth's width, of the radius. A choice.
  std::vector<double> tried;
  for (const SideFlat& flat : around.flats) {
    const double half = std::abs(flat.distance);
    const bool is_known = std::any_of(tried.begin(), tried.end(), [&](double other) {
      return std::abs(other - half) < 4 * tolerance;
    });
    if (is_known || half > kWidest * feature.radius || half < 4 * tolerance) {
      continue;
    }
    tried.push_back(half);
    if (auto spline = MakeSpline(part, feature, around, half, tolerance)) {
      return spline;
    }
  }
  return std::nullopt;
}

void Sort(std::vector<PolygonForm>* found) {
  std::stable_sort(found->begin(), found->end(), [](const PolygonForm& a, const PolygonForm& b) {
    return a.faces.front() < b.faces.front();
  });
  const auto same = [](const PolygonForm& a, const PolygonForm& b) { return a.faces == b.faces; };
  found->erase(std::unique(found->begin(), found->end(), same), found->end());
}

std::vector<PolygonForm> FindRegularAmong(const Part& part, const std::vector<FlatPair>& pairs,
                                          int sides, double tolerance) {
  std::vector<PolygonForm> found;
  std::vector<const FlatPair*> chosen;
  AddRegular(part, pairs, 0, sides, tolerance, &chosen, &found);
  return found;
}

}  // namespace

std::vector<PolygonForm> FindRegularPolygons(const Part& part, int sides, double tolerance,
                                             RecognitionLimits* limits) {
  const std::vector<Flat> flats = CollectFlats(part, limits);
  std::vector<PolygonForm> found =
      FindRegularAmong(part, CollectFlatPairs(flats, limits), sides, tolerance);
  Sort(&found);
  return found;
}

std::vector<PolygonForm> FindPolygons(const Part& part, double tolerance,
                                      RecognitionLimits* limits) {
  const std::vector<Flat> flats = CollectFlats(part, limits);
  const std::vector<FlatPair> pairs = CollectFlatPairs(flats, limits);
  std::vector<PolygonForm> found;
  for (const int sides : {8, 6, 4}) {
    for (PolygonForm& polygon : FindRegularAmong(part, pairs, sides, tolerance)) {
      // An octagon has the flats of two squares.
      const bool is_part = std::any_of(found.begin(), found.end(), [&](const PolygonForm& other) {
        return std::includes(other.faces.begin(), other.faces.end(), polygon.faces.begin(),
                             polygon.faces.end());
      });
      if (!is_part) {
        found.push_back(std::move(polygon));
      }
    }
  }
  for (const Feature& feature : part.features) {
    if (!IsCylinder(feature.kind)) {
      continue;
    }
    const AxisFlats around = CollectAround(part, feature, flats);
    if (auto flatted = FindFlatted(part, feature, around, tolerance)) {
      found.push_back(std::move(*flatted));
    }
    if (auto spline = FindSpline(part, feature, around, tolerance)) {
      found.push_back(std::move(*spline));
    }
  }
  Sort(&found);
  return found;
}

}  // namespace hvas::product
