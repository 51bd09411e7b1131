#include "mates/pair_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mates/build_mate.h"
#include "product/axis_features.h"
#include "product/same_place.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::MateKind;
using product::Part;
using product::PartId;
using product::Pose;
using product::Product;
using spatial::Box;

constexpr double kAlignedGap = 2e-3;          // Between the ends of holes in line [m].
constexpr double kSphereInterference = 0.01;  // Part of the radius.
constexpr double kCosTilted = 0.9986;         // Of a shaft that leans in its hole: 3 deg. A choice.
constexpr double kAlignedShare = 0.1;         // Of the shorter hole, that may lie in the other.

/** The box of a hole, shaft or cone: that of a cylinder around its span. */
Box CalcAxialBox(const Feature& feature) {
  Box box;
  box.Add(feature.origin_B + feature.span_low * feature.axis_B);
  box.Add(feature.origin_B + feature.span_high * feature.axis_B);
  // A disc of radius r across a unit axis reaches r sqrt(1 - n_i^2) along coordinate i.
  const Vec3 reach =
      feature.radius * (Vec3::Ones() - feature.axis_B.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return {box.low - reach, box.high + reach};
}

Box CalcFaceBox(const Part& part, const Feature& feature) {
  Box box;
  for (const product::FaceId face : feature.faces) {
    box.Add(part.faces[face.index()].box_B);
  }
  return box;
}

Box CalcFeatureBox(const Part& part, const Feature& feature) {
  if (feature.kind == FeatureKind::kPlane) {
    return CalcFaceBox(part, feature);
  }
  if (product::IsSphere(feature.kind)) {
    return Box{feature.origin_B, feature.origin_B}.Expanded(feature.radius);
  }
  return CalcAxialBox(feature);
}

std::size_t CountTriangles(const Part& part, const Feature& feature) {
  std::size_t count = 0;
  for (const product::FaceId face : feature.faces) {
    count += part.faces[face.index()].triangle_count;
  }
  return count;
}

/** The triangles of a plane feature in a frame P of a plane. */
std::vector<Triangle2> Flatten(const Part& part, const Feature& feature, const Pose& X_PB) {
  const Mat3 R_PB = X_PB.R();
  std::vector<Triangle2> triangles;
  triangles.reserve(CountTriangles(part, feature));
  for (const product::FaceId face_id : feature.faces) {
    const product::Face& face = part.faces[face_id.index()];
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      Triangle2 flat;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& p_B = part.mesh.vertices[part.mesh.triangles[face.first_triangle + t][k]];
        flat[k] = (R_PB * p_B + X_PB.p()).head<2>();
      }
      triangles.push_back(flat);
    }
  }
  return triangles;
}

/** Whether a cylinder is none that goes around: the ends of teeth, the round end of a slot. */
bool IsPartial(const Feature& feature) {
  return product::IsToothed(feature) || product::IsRoundEnd(feature);
}

/** Whether two cylinders are whole ones, or round ends on the same side of their axes: a tongue in
 its slot. What is round lies in the end of a slot by chance. Arcs in one frame. */
bool DoEndsFit(const Vec3& arc_a, const Vec3& arc_b) {
  constexpr double kSameSide = 0.95;  // Cosine: 18 degrees. A choice.
  return (arc_a.isZero() && arc_b.isZero()) ||
         arc_a.dot(arc_b) > kSameSide * arc_a.norm() * arc_b.norm();
}

Pose MakePlaneFrame(const Feature& plane) {
  return {spatial::FrameFromZ(plane.axis_B), plane.origin_B};
}

}  // namespace

/** What a search of one pair needs at hand. */
struct PairSearch::Context {
  PartId part_a, part_b;
  const Part& a;
  const Part& b;
  Pose X_AB;
  double scale{1};
};

std::size_t PairSearch::PairKeyHash::operator()(const PairKey& key) const noexcept {
  std::uint64_t hash = (std::uint64_t{key.a} << 32U) | key.b;
  for (const std::int64_t value : {key.x, key.y, key.z}) {
    hash = (hash ^ static_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29U;
  }
  return static_cast<std::size_t>(hash);
}

PairSearch::PairSearch(const Product& product, const InferenceLimits& limits, WorkWatch* watch)
    : product_(product),
      limits_(limits),
      watch_(watch),
      cos_angle_(std::cos(limits.angle)),
      parts_(product.parts.size()) {}

const PairSearch::SearchPart& PairSearch::Prepare(PartId id) {
  SearchPart& search = parts_[id.index()];
  if (search.is_ready) {
    return search;
  }
  const Part& part = product_.parts[id.index()];
  search.is_ready = true;
  search.size = part.box_B.is_empty() ? 0.0 : part.box_B.size().norm();
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    const bool turns = product::IsCylinder(feature.kind) || product::IsCone(feature.kind);
    constexpr double kOneArc = 0.5;  // Half a turn in one piece has 2/pi, in several less.
    const Vec3 arc_B = product::IsRoundEnd(feature) ? product::CalcArcDirection(part, feature)
                                                    : Vec3(Vec3::Zero());
    const bool is_end = arc_B.norm() > kOneArc;
    if (turns && !is_end && feature.coverage < limits_.coverage && feature.faces.size() < 2) {
      continue;  // Fillets. Features of several arcs hold a shaft between them.
    }
    const Box box = CalcFeatureBox(part, feature);
    if (!box.is_empty()) {
      search.features.push_back(
          {FeatureId(i), feature.kind, &feature, box, is_end ? arc_B : Vec3(Vec3::Zero())});
    }
  }
  return search;
}

const PairHits& PairSearch::Find(product::OccurrenceId a, product::OccurrenceId b) {
  const product::Occurrence& occurrence_a = product_.occurrences[a.index()];
  const product::Occurrence& occurrence_b = product_.occurrences[b.index()];
  const Pose X_AB = occurrence_a.X_WB.Inverse() * occurrence_b.X_WB;
  if (!limits_.reuse_equal_pairs) {
    last_ = {};
    Search(occurrence_a.part, occurrence_b.part, X_AB, &last_);
    return last_;
  }
  const PairKey key{occurrence_a.part.value(), occurrence_b.part.value(),
                    product::PlaceCell(X_AB.p().x()), product::PlaceCell(X_AB.p().y()),
                    product::PlaceCell(X_AB.p().z())};
  std::vector<Known>& known = known_[key];
  for (const Known& entry : known) {
    if (product::IsSamePose(entry.X_AB, X_AB)) {
      return entry.hits;
    }
  }
  known.push_back({X_AB, {}});
  Search(occurrence_a.part, occurrence_b.part, X_AB, &known.back().hits);
  return known.back().hits;
}

void PairSearch::Search(PartId id_a, PartId id_b, const Pose& X_AB, PairHits* hits) {
  ++searched_;
  Prepare(id_a);
  Prepare(id_b);
  const SearchPart& a = parts_[id_a.index()];
  const SearchPart& b = parts_[id_b.index()];
  const Context context{id_a,
                        id_b,
                        product_.parts[id_a.index()],
                        product_.parts[id_b.index()],
                        X_AB,
                        CalcLengthScale(std::min(a.size, b.size))};
  const double margin = std::max(limits_.near_gap, limits_.wall_gap) * context.scale;
  const double hole_margin = std::max(margin, kAlignedGap * context.scale);
  const Box box_b = spatial::Transform(X_AB, context.b.box_B);
  const Box common{context.a.box_B.low.cwiseMax(box_b.low),
                   context.a.box_B.high.cwiseMin(box_b.high)};
  const Box close = common.Expanded(margin);
  const Box close_to_holes = common.Expanded(hole_margin);
  std::vector<const SearchFeature*> features_a;
  std::vector<const SearchFeature*> holes_a;
  for (const SearchFeature& feature : a.features) {
    if (feature.box.Overlaps(close)) {
      features_a.push_back(&feature);
    }
    if (feature.kind == FeatureKind::kHole && feature.box.Overlaps(close_to_holes) &&
        !IsPartial(*feature.feature)) {
      holes_a.push_back(&feature);
    }
  }
  std::vector<MovedFeature> features_b;
  std::vector<MovedFeature> holes_b;
  const Mat3 R_AB = X_AB.R();
  for (const SearchFeature& feature : b.features) {
    const MovedFeature moved{&feature, spatial::Transform(X_AB, feature.box),
                             R_AB * feature.feature->origin_B + X_AB.p(),
                             R_AB * feature.feature->axis_B};
    if (moved.box.Overlaps(close)) {
      features_b.push_back(moved);
    }
    if (feature.kind == FeatureKind::kHole && moved.box.Overlaps(close_to_holes) &&
        !IsPartial(*feature.feature)) {
      holes_b.push_back(moved);
    }
  }
  for (const SearchFeature* feature_a : features_a) {
    if (!MayGoOn(watch_)) {
      return;
    }
    const Box box = feature_a->box.Expanded(margin);
    for (const MovedFeature& feature_b : features_b) {
      if (box.Overlaps(feature_b.box)) {
        TestPair(context, *feature_a, feature_b, hits);
      }
    }
  }
  TestHoles(context, holes_a, holes_b, hits);
}

namespace {

bool IsSameCone(const Feature& seat, const Feature& taper, const Pose& X_ST,
                const InferenceLimits& limits, double scale) {
  if (std::abs(seat.half_angle - taper.half_angle) >= limits.cone_angle) {
    return false;
  }
  const AxialSpans spans = CalcAxialSpans(seat, taper, X_ST);
  if (spans.sense < 0 || spans.length() <= limits.axial_overlap * scale ||
      spans.axis_distance >= limits.axis_distance * scale) {
    return false;
  }
  const double middle = 0.5 * (spans.low + spans.high);
  const double gap =
      (middle * std::tan(seat.half_angle) - (middle - spans.shift) * std::tan(taper.half_angle)) *
      std::cos(seat.half_angle);
  return std::abs(gap) < limits.cone_gap * scale;
}

/** True where a part has a cylinder of the given kind on the axis of `about`, within its span and
 with a radius between two others. X_AB: pose of the part in that of the axis. */
bool HasCylinderBetween(const Part& part, FeatureKind kind, const Feature& about, const Pose& X_AB,
                        const AxisHit& hit, double low_radius, double high_radius, double limit) {
  return std::any_of(part.features.begin(), part.features.end(), [&](const Feature& feature) {
    if (feature.kind != kind || feature.radius < low_radius || feature.radius > high_radius ||
        about.axis_B.cross(X_AB.q() * feature.axis_B).norm() > 1e-2) {
      return false;
    }
    const AxialSpans spans = CalcAxialSpans(about, feature, X_AB);
    return spans.axis_distance < limit &&
           std::min(hit.high, spans.second_high) - std::max(hit.low, spans.second_low) >
               0.5 * (hit.high - hit.low);
  });
}

/** True where a shaft that is larger than the hole does not fill it but runs around the hole's
 part: a tube in a wider tube. Then the shaft's part is hollow there, or the hole's part ends
 before. */
bool IsAround(const Part& hole_part, const Feature& hole, const Part& shaft_part,
              const Feature& shaft, const Pose& X_HS, const AxisHit& hit, double limit) {
  constexpr double kSame = 1e-6;  // [m]: equal radii differ by rounding alone. A choice.
  return shaft.radius > hole.radius + kSame &&
         (HasCylinderBetween(shaft_part, FeatureKind::kHole, hole, X_HS, hit, hole.radius + kSame,
                             shaft.radius, limit) ||
          HasCylinderBetween(hole_part, FeatureKind::kShaft, hole, Pose(), hit, hole.radius,
                             shaft.radius - kSame, limit));
}

/** Whether teeth allow a hole and a shaft to be one in the other: splines with equal teeth; the
 bottoms of a hub's teeth on a shaft that is drawn smooth; and a hub that is drawn smooth on teeth,
 not larger than they are, as the bore around a gear is. */
bool DoTeethFit(const Feature& hole, const Feature& shaft) {
  constexpr double kSame = 1e-6;         // [m]: equal radii differ by rounding alone. A choice.
  constexpr double kSmoothRatio = 0.02;  // Of the radius, for a shaft without teeth: a choice.
  const bool has_hole = product::IsToothed(hole);
  const bool has_shaft = product::IsToothed(shaft);
  if (has_hole && has_shaft) {
    return hole.faces.size() == shaft.faces.size();
  }
  return (!has_hole || std::abs(hole.radius - shaft.radius) <= kSmoothRatio * shaft.radius) &&
         (!has_shaft || hole.radius <= shaft.radius + kSame);
}

/** Whether a shaft that is off its hole's axis, or tilted in it, is inside the hole all along. */
bool IsInside(const Feature& hole, const Feature& shaft, const Pose& X_HS, const AxisHit& hit) {
  constexpr double kRounding = 1e-6;  // [m]: by which drawn circles that touch overlap. A choice.
  const Vec3 axis = X_HS.q() * shaft.axis_B;
  const Vec3 origin = X_HS * shaft.origin_B;
  const auto is_inside_at = [&](double at) {
    const Vec3 p = hole.origin_B + at * hole.axis_B;
    return axis.cross(p - origin).norm() <= hole.radius - shaft.radius + kRounding;
  };
  return is_inside_at(hit.low) && is_inside_at(hit.high);
}

bool DoEngage(const Feature& hole, const Feature& shaft, const Pose& X_HS,
              const InferenceLimits& limits, double scale, double cos_angle, AxisHit* hit) {
  if (std::abs(hole.radius - shaft.radius) >=
      CalcLargestPlay(limits, scale, std::min(hole.radius, shaft.radius))) {
    return false;
  }
  const AxialSpans spans = CalcAxialSpans(hole, shaft, X_HS);
  hit->low = spans.low;
  hit->high = spans.high;
  hit->is_off_axis = spans.axis_distance >= limits.axis_distance * scale ||
                     std::abs(hole.axis_B.dot(X_HS.q() * shaft.axis_B)) < cos_angle;
  return spans.length() > limits.axial_overlap * scale &&
         (!hit->is_off_axis || IsInside(hole, shaft, X_HS, *hit));
}

}  // namespace

void PairSearch::TestPair(const Context& context, const SearchFeature& a, const MovedFeature& b,
                          PairHits* hits) {
  if (a.kind == FeatureKind::kPlane || b.own->kind == FeatureKind::kPlane) {
    if (a.kind == b.own->kind && a.feature->axis_B.dot(b.axis) <= -cos_angle_) {
      TestPlanes(context, a, b, hits);
    }
    return;
  }
  const bool is_first = a.kind == FeatureKind::kHole || a.kind == FeatureKind::kConeSeat ||
                        a.kind == FeatureKind::kSocket;
  const FeatureKind seat = is_first ? a.kind : b.own->kind;
  const FeatureKind body = is_first ? b.own->kind : a.kind;
  if (seat == FeatureKind::kSocket && body == FeatureKind::kBall) {
    TestBall(context, a, b, is_first, hits);
  } else if (std::abs(a.feature->axis_B.dot(b.axis)) >= kCosTilted) {
    TestOnAxis(context, a, b, is_first, hits);
  }
}

void PairSearch::TestBall(const Context& context, const SearchFeature& a, const MovedFeature& b,
                          bool is_seat_in_a, PairHits* hits) const {
  const SearchFeature& seat = is_seat_in_a ? a : *b.own;
  const SearchFeature& ball = is_seat_in_a ? *b.own : a;
  const double play = seat.feature->radius - ball.feature->radius;
  const double most =
      CalcLargestPlay(limits_, context.scale, std::min(seat.feature->radius, ball.feature->radius));
  // A ball does not go into a socket that is smaller, but for the roughness of drawing.
  const double least = -kSphereInterference * ball.feature->radius;
  if ((b.origin - a.feature->origin_B).norm() < limits_.axis_distance * context.scale &&
      play < most && play > least) {
    hits->seats.push_back({MateKind::kSphereSeat, is_seat_in_a, seat.id, ball.id});
  }
}

void PairSearch::TestOnAxis(const Context& context, const SearchFeature& a, const MovedFeature& b,
                            bool is_seat_in_a, PairHits* hits) const {
  const SearchFeature& seat = is_seat_in_a ? a : *b.own;
  const SearchFeature& body = is_seat_in_a ? *b.own : a;
  const Pose X_SB = is_seat_in_a ? context.X_AB : context.X_AB.Inverse();
  if (seat.kind == FeatureKind::kHole && body.kind == FeatureKind::kShaft) {
    AxisHit hit{is_seat_in_a, seat.id, body.id};
    const Part& hole_part = is_seat_in_a ? context.a : context.b;
    const Part& shaft_part = is_seat_in_a ? context.b : context.a;
    if (DoEndsFit(a.arc_B, context.X_AB.q() * b.own->arc_B) &&
        DoTeethFit(*seat.feature, *body.feature) &&
        DoEngage(*seat.feature, *body.feature, X_SB, limits_, context.scale, cos_angle_, &hit) &&
        !IsAround(hole_part, *seat.feature, shaft_part, *body.feature, X_SB, hit,
                  limits_.axis_distance * context.scale)) {
      hits->axes.push_back(hit);
    }
  } else if (seat.kind == FeatureKind::kConeSeat && body.kind == FeatureKind::kTaper &&
             std::abs(a.feature->axis_B.dot(b.axis)) >= cos_angle_ &&
             IsSameCone(*seat.feature, *body.feature, X_SB, limits_, context.scale)) {
    hits->seats.push_back({MateKind::kConeSeat, is_seat_in_a, seat.id, body.id});
  }
}

void PairSearch::TestHoles(const Context& context, const std::vector<const SearchFeature*>& of_a,
                           const std::vector<MovedFeature>& of_b, PairHits* hits) const {
  for (const SearchFeature* a : of_a) {
    if (!MayGoOn(watch_)) {
      return;
    }
    const Box box = a->box.Expanded(kAlignedGap * context.scale);
    for (const MovedFeature& b : of_b) {
      const Feature& hole_a = *a->feature;
      const Feature& hole_b = *b.own->feature;
      const double smaller = std::min(hole_a.radius, hole_b.radius);
      if (!box.Overlaps(b.box) || std::abs(hole_a.axis_B.dot(b.axis)) < cos_angle_ ||
          std::abs(hole_a.radius - hole_b.radius) >=
              CalcLargestPlay(limits_, context.scale, smaller)) {
        continue;
      }
      const AxialSpans spans = CalcAxialSpans(hole_a, hole_b, context.X_AB);
      const double shorter =
          std::min(spans.first_high - spans.first_low, spans.second_high - spans.second_low);
      if (spans.axis_distance < limits_.axis_distance * context.scale &&
          spans.length() < kAlignedShare * shorter &&
          -spans.length() < std::min(kAlignedGap * context.scale, 2 * smaller)) {
        hits->holes.push_back({a->id, b.own->id});
      }
    }
  }
}

/** The triangles in the plane's own frame, for features that are asked for again and again. */
const std::vector<Triangle2>& PairSearch::FlattenOnce(PartId part, const SearchFeature& feature) {
  const auto key = std::pair(part.value(), feature.id.value());
  const auto found = triangles_.find(key);
  if (found != triangles_.end()) {
    return found->second;
  }
  return triangles_
      .emplace(key, Flatten(product_.parts[part.index()], *feature.feature,
                            MakePlaneFrame(*feature.feature).Inverse()))
      .first->second;
}

void PairSearch::TestPlanes(const Context& context, const SearchFeature& a, const MovedFeature& b,
                            PairHits* hits) {
  const Feature& plane_a = *a.feature;
  const Feature& plane_b = *b.own->feature;
  const double touch = limits_.plane_gap * context.scale;
  const double near = std::max(touch, limits_.near_gap * context.scale);
  const double far = std::max(near, limits_.wall_gap * context.scale);
  // A first look that allows for the tilt over the distance of the two reference points.
  const Vec3 between = b.origin - plane_a.origin_B;
  if (std::abs(plane_a.axis_B.dot(between)) >= far + limits_.angle * between.norm()) {
    return;
  }
  // In the frame of the finer one (a base plate has many neighbours), near the other only.
  const bool is_a_finer = CountTriangles(context.a, plane_a) >= CountTriangles(context.b, plane_b);
  const Pose X_AP = is_a_finer ? MakePlaneFrame(plane_a) : context.X_AB * MakePlaneFrame(plane_b);
  const Pose X_PA = X_AP.Inverse();
  const std::vector<Triangle2> coarse = is_a_finer
                                            ? Flatten(context.b, plane_b, X_PA * context.X_AB)
                                            : Flatten(context.a, plane_a, X_PA);
  const std::vector<Triangle2>& fine =
      is_a_finer ? FlattenOnce(context.part_a, a) : FlattenOnce(context.part_b, *b.own);
  const Overlap overlap = CalcOverlap(SelectNear(fine, coarse), coarse, watch_);
  const double least = std::max(limits_.area_ratio * std::min(plane_a.area, plane_b.area),
                                limits_.area * context.scale * context.scale);
  if (overlap.area <= least) {
    return;
  }
  const Vec3 centroid = X_AP * Vec3(overlap.centroid.x(), overlap.centroid.y(), 0);
  // Along the outward normal of the finer plane to the other one.
  const double gap = is_a_finer ? -b.axis.dot(b.origin - centroid)
                                : -plane_a.axis_B.dot(plane_a.origin_B - centroid);
  const PlaneHit hit{a.id, b.own->id, overlap.area, gap, centroid};
  if (std::abs(gap) < touch) {
    hits->planes.push_back(hit);
    return;
  }
  const double smaller_area = std::min(plane_a.area, plane_b.area);
  if (gap > -near && gap < far && overlap.area > limits_.wall_area_ratio * smaller_area) {
    hits->walls.push_back(hit);
  }
  if (std::abs(gap) < near) {
    std::optional<PlaneHit>& largest = gap > 0 ? hits->nearest : hits->overlapping;
    if (!largest || hit.area > largest->area) {
      largest = hit;
    }
  }
}

}  // namespace hvas::mates
