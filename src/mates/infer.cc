#include "mates/infer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "mates/fasteners.h"
#include "mates/plane_overlap.h"
#include "mates/propose_fit.h"

namespace hvas::mates {
namespace {

using product::Connector;
using product::Face;
using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::Fit;
using product::FitKind;
using product::Mate;
using product::MateId;
using product::MateKind;
using product::Occurrence;
using product::OccurrenceId;
using product::Part;
using product::Product;
using spatial::Box;
using spatial::Pose;

/** A feature of an occurrence where it is drawn. */
struct PlacedFeature {
  FeatureId id;
  FeatureKind kind{FeatureKind::kPlane};
  Vec3 origin_W;
  Vec3 axis_W;
  double radius{0};
  double low{0};
  double high{0};
  double area{0};
  Box box_W;
};

struct PlacedOccurrence {
  OccurrenceId id;
  Box box_W;
  double size{0};
  std::vector<PlacedFeature> features;
};

struct OccurrencePair {
  std::size_t a{0};
  std::size_t b{0};
};

/** A hole and a shaft that engage. Several hits make a mate. */
struct AxisHit {
  std::size_t hole_occurrence{0};
  std::size_t shaft_occurrence{0};
  const PlacedFeature* hole{nullptr};
  const PlacedFeature* shaft{nullptr};
  double low{0};  // Engaged interval along the hole's axis from the hole's origin.
  double high{0};

  [[nodiscard]] double length() const { return high - low; }

  [[nodiscard]] double radius_difference() const { return hole->radius - shaft->radius; }

  [[nodiscard]] Vec3 CalcPoint(double s) const { return hole->origin_W + s * hole->axis_W; }
};

struct PlaneHit {
  const PlacedFeature* a{nullptr};
  const PlacedFeature* b{nullptr};
  double area{0};
  Vec3 centroid_W;
};

/** One for parts of ordinary size; the ratio beyond. */
double CalcScale(double size) {
  constexpr double kSmall = 5e-3;
  constexpr double kLarge = 1.0;
  return size < kSmall ? size / kSmall : std::max(1.0, size / kLarge);
}

Box CalcAxialBox(const Feature& feature, const Pose& X_WB) {
  const Vec3 axis_W = X_WB.q() * feature.axis_B;
  const Vec3 origin_W = X_WB * feature.origin_B;
  Box box;
  box.Add(origin_W + feature.span_low * axis_W);
  box.Add(origin_W + feature.span_high * axis_W);
  // A disc of radius r across a unit axis reaches r sqrt(1 - n_i^2) along coordinate i.
  const Vec3 reach = feature.radius * (Vec3::Ones() - axis_W.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return {box.low - reach, box.high + reach};
}

PlacedOccurrence Place(const Product& product, const Occurrence& occurrence,
                       const InferenceLimits& limits) {
  const Part& part = product.part_of(occurrence.id);
  PlacedOccurrence placed;
  placed.id = occurrence.id;
  placed.box_W = spatial::Transform(occurrence.X_WB, part.box_B);
  placed.size = part.box_B.is_empty() ? 0.0 : part.box_B.size().norm();
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    const bool is_plane = feature.kind == FeatureKind::kPlane;
    if (!is_plane && feature.coverage < limits.coverage) {
      continue;  // Fillets and slot ends.
    }
    PlacedFeature out;
    out.id = FeatureId(i);
    out.kind = feature.kind;
    out.origin_W = occurrence.X_WB * feature.origin_B;
    out.axis_W = occurrence.X_WB.q() * feature.axis_B;
    out.radius = feature.radius;
    out.low = feature.span_low;
    out.high = feature.span_high;
    out.area = feature.area;
    if (is_plane) {
      for (const product::FaceId face : feature.faces) {
        out.box_W.Add(spatial::Transform(occurrence.X_WB, part.faces[face.index()].box_B));
      }
    } else {
      out.box_W = CalcAxialBox(feature, occurrence.X_WB);
    }
    if (!out.box_W.is_empty()) {
      placed.features.push_back(out);
    }
  }
  return placed;
}

/** All pairs whose boxes meet, by a sweep along the axis on which the product is longest. */
std::vector<OccurrencePair> FindPairs(const std::vector<PlacedOccurrence>& placed, double margin) {
  Box all;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i].box_W.is_empty()) {
      all.Add(placed[i].box_W);
      order.push_back(i);
    }
  }
  if (order.empty()) {
    return {};
  }
  Eigen::Index axis = 0;
  all.size().maxCoeff(&axis);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return placed[i].box_W.low[axis] < placed[j].box_W.low[axis];
  });
  std::vector<OccurrencePair> pairs;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box box = placed[order[i]].box_W.Expanded(margin);
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Box& other = placed[order[j]].box_W;
      if (other.low[axis] > box.high[axis]) {
        break;
      }
      if (box.Overlaps(other)) {
        pairs.push_back({std::min(order[i], order[j]), std::max(order[i], order[j])});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const OccurrencePair& p, const OccurrencePair& q) {
    return std::pair(p.a, p.b) < std::pair(q.a, q.b);
  });
  return pairs;
}

std::vector<const PlacedFeature*> SelectWithin(const PlacedOccurrence& placed, const Box& box) {
  std::vector<const PlacedFeature*> selected;
  for (const PlacedFeature& feature : placed.features) {
    if (feature.box_W.Overlaps(box)) {
      selected.push_back(&feature);
    }
  }
  return selected;
}

double CalcAxisDistance(const Vec3& axis, const Vec3& p_on_axis, const Vec3& q) {
  return axis.cross(q - p_on_axis).norm();
}

class Inference {
 public:
  Inference(Product* product, const InferenceLimits& limits) : product_(product), limits_(limits) {
    placed_.reserve(product->occurrences.size());
    for (const Occurrence& occurrence : product->occurrences) {
      placed_.push_back(Place(*product, occurrence, limits));
      fasteners_.push_back(ClassifyOccurrence(*product, occurrence));
    }
    cos_angle_ = std::cos(limits.angle);
  }

  void Run() {
    double largest = 0;
    for (const PlacedOccurrence& placed : placed_) {
      largest = std::max(largest, placed.size);
    }
    pairs_ = FindPairs(placed_, limits_.plane_gap * CalcScale(largest));
    std::vector<std::vector<PlaneHit>> plane_hits(pairs_.size());
    std::vector<std::size_t> first_axis_hit;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      first_axis_hit.push_back(axis_hits_.size());
      FindHits(pairs_[i], &plane_hits[i]);
    }
    first_axis_hit.push_back(axis_hits_.size());
    IndexHits();
    product_->mates.clear();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      AddAxisMates(first_axis_hit[i], first_axis_hit[i + 1]);
      AddPlaneMates(pairs_[i], plane_hits[i]);
    }
    ProposeFits();
  }

 private:
  [[nodiscard]] double ScaleOf(std::size_t a, std::size_t b) const {
    return CalcScale(std::min(placed_[a].size, placed_[b].size));
  }

  void FindHits(const OccurrencePair& pair, std::vector<PlaneHit>* plane_hits) {
    const PlacedOccurrence& a = placed_[pair.a];
    const PlacedOccurrence& b = placed_[pair.b];
    const double margin = limits_.plane_gap * ScaleOf(pair.a, pair.b);
    const Box common{(a.box_W.low.cwiseMax(b.box_W.low) - Vec3::Constant(margin)),
                     (a.box_W.high.cwiseMin(b.box_W.high) + Vec3::Constant(margin))};
    const std::vector<const PlacedFeature*> features_b = SelectWithin(b, common);
    for (const PlacedFeature* feature_a : SelectWithin(a, common)) {
      const Box box = feature_a->box_W.Expanded(margin);
      for (const PlacedFeature* feature_b : features_b) {
        if (!box.Overlaps(feature_b->box_W) ||
            std::abs(feature_a->axis_W.dot(feature_b->axis_W)) < cos_angle_) {
          continue;
        }
        if (feature_a->kind == FeatureKind::kHole && feature_b->kind == FeatureKind::kShaft) {
          TestAxes(pair.a, pair.b, *feature_a, *feature_b);
        } else if (feature_a->kind == FeatureKind::kShaft &&
                   feature_b->kind == FeatureKind::kHole) {
          TestAxes(pair.b, pair.a, *feature_b, *feature_a);
        } else if (feature_a->kind == FeatureKind::kPlane &&
                   feature_b->kind == FeatureKind::kPlane) {
          TestPlanes(pair, *feature_a, *feature_b, plane_hits);
        }
      }
    }
  }

  void TestAxes(std::size_t hole_occurrence, std::size_t shaft_occurrence,
                const PlacedFeature& hole, const PlacedFeature& shaft) {
    const double scale = ScaleOf(hole_occurrence, shaft_occurrence);
    const double most = std::max(limits_.radius_difference * scale,
                                 limits_.radius_ratio * std::min(hole.radius, shaft.radius));
    if (std::abs(hole.radius - shaft.radius) >= most) {
      return;
    }
    const double sense = hole.axis_W.dot(shaft.axis_W) < 0 ? -1.0 : 1.0;
    const double shift = hole.axis_W.dot(shaft.origin_W - hole.origin_W);
    const double shaft_low = shift + (sense > 0 ? shaft.low : -shaft.high);
    const double shaft_high = shift + (sense > 0 ? shaft.high : -shaft.low);
    const double low = std::max(hole.low, shaft_low);
    const double high = std::min(hole.high, shaft_high);
    if (high - low <= limits_.axial_overlap * scale) {
      return;
    }
    // Where they engage, not at whatever point of the axis the file gives as its origin.
    const Vec3 middle_W = hole.origin_W + 0.5 * (low + high) * hole.axis_W;
    if (CalcAxisDistance(shaft.axis_W, shaft.origin_W, middle_W) >= limits_.axis_distance * scale) {
      return;
    }
    axis_hits_.push_back({hole_occurrence, shaft_occurrence, &hole, &shaft, low, high});
  }

  [[nodiscard]] std::size_t CountTriangles(std::size_t occurrence, FeatureId id) const {
    const Part& part = product_->part_of(placed_[occurrence].id);
    std::size_t count = 0;
    for (const product::FaceId face : part.features[id.index()].faces) {
      count += part.faces[face.index()].triangle_count;
    }
    return count;
  }

  /** The triangles of a plane feature in the frame P of a plane. */
  [[nodiscard]] std::vector<Triangle2> Flatten(std::size_t occurrence, FeatureId id,
                                               const Pose& X_PW) const {
    const Occurrence& placed = product_->occurrences[occurrence];
    const Part& part = product_->part_of(placed.id);
    const Pose X_PB = X_PW * placed.X_WB;
    const Mat3 R_PB = X_PB.R();
    std::vector<Triangle2> triangles;
    triangles.reserve(CountTriangles(occurrence, id));
    for (const product::FaceId face_id : part.features[id.index()].faces) {
      const Face& face = part.faces[face_id.index()];
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

  /** The same in the plane's own frame, for features that are asked for again and again. */
  const std::vector<Triangle2>& FlattenOnce(std::size_t occurrence, const PlacedFeature& feature,
                                            const Pose& X_PW) {
    const auto key = std::pair(occurrence, feature.id.index());
    const auto found = triangles_.find(key);
    if (found != triangles_.end()) {
      return found->second;
    }
    return triangles_.emplace(key, Flatten(occurrence, feature.id, X_PW)).first->second;
  }

  void TestPlanes(const OccurrencePair& pair, const PlacedFeature& a, const PlacedFeature& b,
                  std::vector<PlaneHit>* hits) {
    if (a.axis_W.dot(b.axis_W) > 0) {
      return;
    }
    const double scale = ScaleOf(pair.a, pair.b);
    const double gap = limits_.plane_gap * scale;
    // A first look that allows for the tilt over the distance of the two reference points.
    const Vec3 between_W = b.origin_W - a.origin_W;
    if (std::abs(a.axis_W.dot(between_W)) >= gap + limits_.angle * between_W.norm()) {
      return;
    }
    // In the frame of the finer one (a base plate has many neighbours), near the other only.
    const bool is_a_finer = CountTriangles(pair.a, a.id) >= CountTriangles(pair.b, b.id);
    const PlacedFeature& fine = is_a_finer ? a : b;
    const PlacedFeature& coarse = is_a_finer ? b : a;
    const Pose X_WP(spatial::FrameFromZ(fine.axis_W), fine.origin_W);
    const Pose X_PW = X_WP.Inverse();
    const std::vector<Triangle2> near = Flatten(is_a_finer ? pair.b : pair.a, coarse.id, X_PW);
    const Overlap overlap =
        CalcOverlap(SelectNear(FlattenOnce(is_a_finer ? pair.a : pair.b, fine, X_PW), near), near);
    const double least =
        std::max(limits_.area_ratio * std::min(a.area, b.area), limits_.area * scale * scale);
    if (overlap.area <= least) {
      return;
    }
    const Vec3 centroid_W = X_WP * Vec3(overlap.centroid.x(), overlap.centroid.y(), 0);
    if (std::abs(coarse.axis_W.dot(centroid_W - coarse.origin_W)) >= gap) {
      return;
    }
    hits->push_back({&a, &b, overlap.area, centroid_W});
  }

  void IndexHits() {
    for (std::size_t i = 0; i < axis_hits_.size(); ++i) {
      hits_of_hole_[axis_hits_[i].hole].push_back(i);
      hits_of_shaft_[axis_hits_[i].shaft].push_back(i);
      hits_of_part_[axis_hits_[i].shaft_occurrence].push_back(i);
    }
  }

  /** True where a third part (a bushing) fills part of the ring between hole and shaft. */
  [[nodiscard]] bool HasPartBetween(const AxisHit& hit) const {
    const double difference = hit.radius_difference();
    if (difference <= 1e-6) {
      return false;
    }
    double filled = 0;
    for (const std::size_t i : hits_of_hole_.at(hit.hole)) {
      const AxisHit& outer = axis_hits_[i];
      if (outer.shaft_occurrence == hit.shaft_occurrence ||
          std::abs(outer.radius_difference()) >= difference) {
        continue;
      }
      for (const std::size_t j : hits_of_shaft_.at(hit.shaft)) {
        const AxisHit& inner = axis_hits_[j];
        if (inner.hole_occurrence == outer.shaft_occurrence &&
            std::abs(inner.radius_difference()) < difference &&
            inner.hole->radius < outer.shaft->radius) {
          const double inner_first =
              hit.hole->axis_W.dot(inner.CalcPoint(inner.low) - hit.hole->origin_W);
          const double inner_last =
              hit.hole->axis_W.dot(inner.CalcPoint(inner.high) - hit.hole->origin_W);
          const double low = std::max({hit.low, outer.low, std::min(inner_first, inner_last)});
          const double high = std::min({hit.high, outer.high, std::max(inner_first, inner_last)});
          filled += std::max(0.0, high - low);
        }
      }
    }
    return filled > 0.1 * hit.length();
  }

  /** True for a wide hole around a shaft which another part guides on the same axis. */
  [[nodiscard]] bool IsLoosePassage(const AxisHit& hit) const {
    const auto is_loose = [this](const AxisHit& h) {
      return h.radius_difference() >
             limits_.radius_difference * ScaleOf(h.hole_occurrence, h.shaft_occurrence);
    };
    if (!is_loose(hit)) {
      return false;
    }
    const std::vector<std::size_t>& others = hits_of_part_.at(hit.shaft_occurrence);
    return std::any_of(others.begin(), others.end(), [&](std::size_t i) {
      const AxisHit& other = axis_hits_[i];
      return other.hole_occurrence != hit.hole_occurrence && !is_loose(other) &&
             IsSameAxis(hit, other);
    });
  }

  [[nodiscard]] bool IsSameAxis(const AxisHit& s, const AxisHit& t) const {
    const double limit = limits_.axis_distance * ScaleOf(s.hole_occurrence, s.shaft_occurrence);
    return std::abs(s.hole->axis_W.dot(t.hole->axis_W)) >= cos_angle_ &&
           CalcAxisDistance(s.hole->axis_W, s.hole->origin_W, t.CalcPoint(0.5 * (t.low + t.high))) <
               limit;
  }

  /** The tightest of the long engagements: of two that are half as long as the longest or more, the
   one with the smaller difference of radii, then the longer one. */
  static const AxisHit& ChooseWorking(const std::vector<const AxisHit*>& group) {
    double longest = 0;
    for (const AxisHit* hit : group) {
      longest = std::max(longest, hit->length());
    }
    const AxisHit* best = nullptr;
    for (const AxisHit* hit : group) {
      if (hit->length() < 0.5 * longest) {
        continue;
      }
      constexpr double kSame = 1e-7;
      const double gain = best == nullptr ? 1.0
                                          : std::abs(best->radius_difference()) -
                                                std::abs(hit->radius_difference());
      if (best == nullptr || gain > kSame ||
          (gain > -kSame && hit->length() > best->length() + kSame)) {
        best = hit;
      }
    }
    return *best;
  }

  void AddAxisMates(std::size_t begin, std::size_t end) {
    std::vector<std::vector<const AxisHit*>> groups;
    for (std::size_t i = begin; i < end; ++i) {
      const AxisHit& hit = axis_hits_[i];
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
    for (const std::vector<const AxisHit*>& group : groups) {
      AddAxisMate(ChooseWorking(group));
    }
  }

  void AddAxisMate(const AxisHit& hit) {
    const double middle = 0.5 * (hit.low + hit.high);
    const Pose X_WM(spatial::FrameFromZ(hit.hole->axis_W), hit.CalcPoint(middle));
    Mate mate = MakeMate(MateKind::kAxisHole, hit.hole_occurrence, hit.hole->id, X_WM,
                         hit.shaft_occurrence, hit.shaft->id, X_WM);
    const double sense = hit.hole->axis_W.dot(hit.shaft->axis_W) < 0 ? -1.0 : 1.0;
    const double shift = hit.hole->axis_W.dot(hit.shaft->origin_W - X_WM.p());
    mate.hole_low = hit.hole->low - middle;
    mate.hole_high = hit.hole->high - middle;
    mate.shaft_low = shift + (sense > 0 ? hit.shaft->low : -hit.shaft->high);
    mate.shaft_high = shift + (sense > 0 ? hit.shaft->high : -hit.shaft->low);
    mate.hole_radius = hit.hole->radius;
    mate.shaft_radius = hit.shaft->radius;
    mate.overlap = hit.length();
    product_->mates.push_back(std::move(mate));
  }

  void AddPlaneMates(const OccurrencePair& pair, const std::vector<PlaneHit>& hits) {
    struct Group {
      const PlaneHit* largest{nullptr};
      double area{0};
      Vec3 moment_W{Vec3::Zero()};
    };

    const double gap = limits_.plane_gap * ScaleOf(pair.a, pair.b);
    std::vector<Group> groups;
    for (const PlaneHit& hit : hits) {
      const auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
        const Vec3& nhat_W = group.largest->a->axis_W;
        return nhat_W.dot(hit.a->axis_W) >= cos_angle_ &&
               std::abs(nhat_W.dot(hit.centroid_W - group.largest->centroid_W)) < 2 * gap;
      });
      Group& group = found != groups.end() ? *found : groups.emplace_back();
      if (group.largest == nullptr || hit.area > group.largest->area) {
        group.largest = &hit;
      }
      group.area += hit.area;
      group.moment_W += hit.area * hit.centroid_W;
    }
    for (const Group& group : groups) {
      const PlacedFeature& a = *group.largest->a;
      const Vec3 centre_W = group.moment_W / group.area;
      const Vec3 origin_W = centre_W - a.axis_W.dot(centre_W - a.origin_W) * a.axis_W;
      const Quat q_WM = spatial::FrameFromZ(a.axis_W);
      const Quat half_turn(0, 1, 0, 0);  // About x: z of the other side opposes this one's.
      Mate mate = MakeMate(MateKind::kFaceFace, pair.a, a.id, Pose(q_WM, origin_W), pair.b,
                           group.largest->b->id, Pose(q_WM * half_turn, origin_W));
      mate.overlap = group.area;
      product_->mates.push_back(std::move(mate));
    }
  }

  [[nodiscard]] Mate MakeMate(MateKind kind, std::size_t a, FeatureId feature_a, const Pose& X_WM,
                              std::size_t b, FeatureId feature_b, const Pose& X_WN) const {
    const Occurrence& occurrence_a = product_->occurrences[a];
    const Occurrence& occurrence_b = product_->occurrences[b];
    Mate mate;
    mate.id = MateId(product_->mates.size());
    mate.kind = kind;
    mate.a = {occurrence_a.id, feature_a, occurrence_a.X_WB.Inverse() * X_WM};
    mate.b = {occurrence_b.id, feature_b, occurrence_b.X_WB.Inverse() * X_WN};
    return mate;
  }

  /** A bolt with a nut passes through its other holes; it is not screwed into them. */
  [[nodiscard]] bool HasNut(const Mate& mate) const {
    return std::any_of(product_->mates.begin(), product_->mates.end(), [&](const Mate& other) {
      return other.kind == MateKind::kAxisHole && other.id != mate.id &&
             other.b.occurrence == mate.b.occurrence &&
             fasteners_[other.a.occurrence.index()] == FastenerKind::kNut;
    });
  }

  void ProposeFits() {
    for (Mate& mate : product_->mates) {
      if (mate.kind != MateKind::kAxisHole) {
        continue;
      }
      FitEvidence evidence;
      evidence.hole_radius = mate.hole_radius;
      evidence.shaft_radius = mate.shaft_radius;
      evidence.hole_part = fasteners_[mate.a.occurrence.index()];
      evidence.shaft_part = fasteners_[mate.b.occurrence.index()];
      evidence.nut_on_shaft = evidence.shaft_part == FastenerKind::kScrew && HasNut(mate);
      mate.fit = ProposeFit(evidence);
    }
  }

  Product* product_;
  InferenceLimits limits_;
  double cos_angle_{1};
  std::vector<PlacedOccurrence> placed_;
  std::vector<FastenerKind> fasteners_;
  std::vector<OccurrencePair> pairs_;
  std::vector<AxisHit> axis_hits_;
  // Looked up only, never iterated: their order may depend on addresses.
  std::map<const PlacedFeature*, std::vector<std::size_t>> hits_of_hole_;
  std::map<const PlacedFeature*, std::vector<std::size_t>> hits_of_shaft_;
  std::map<std::size_t, std::vector<std::size_t>> hits_of_part_;  // By the shaft's occurrence.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<Triangle2>> triangles_;
};

void Report(const Product& product, Diagnostics* diagnostics) {
  std::vector<bool> has_mate(product.occurrences.size(), false);
  for (const Mate& mate : product.mates) {
    has_mate[mate.a.occurrence.index()] = true;
    has_mate[mate.b.occurrence.index()] = true;
    if (mate.fit && mate.fit->kind == FitKind::kInterference) {
      diagnostics->Note("drawn-interference", product.occurrences[mate.b.occurrence.index()].path,
                        "is drawn larger than its hole in " +
                            product.occurrences[mate.a.occurrence.index()].path + " (" +
                            mate.fit->reason + ")",
                        "assign the fit that is meant, if it is no press fit");
    }
  }
  for (const Occurrence& occurrence : product.occurrences) {
    if (!has_mate[occurrence.id.index()] && product.occurrences.size() > 1) {
      diagnostics->Warn("no-mate", occurrence.path,
                        "touches no other part along a plane or in a hole",
                        "define a mate by hand, or check the drawn position");
    }
  }
}

}  // namespace

void Infer(Product* product, Diagnostics* diagnostics, const InferenceLimits& limits) {
  Inference(product, limits).Run();
  Report(*product, diagnostics);
}

Linkage CalcLinkage(const Product& product) {
  std::vector<std::size_t> parent(product.occurrences.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto find_root = [&parent](std::size_t i) {
    while (parent[i] != i) {
      parent[i] = parent[parent[i]];
      i = parent[i];
    }
    return i;
  };
  std::vector<bool> has_mate(parent.size(), false);
  for (const Mate& mate : product.mates) {
    const std::size_t a = mate.a.occurrence.index();
    const std::size_t b = mate.b.occurrence.index();
    has_mate[a] = true;
    has_mate[b] = true;
    parent[find_root(a)] = find_root(b);
  }
  Linkage linkage;
  std::vector<int> sizes(parent.size(), 0);
  for (std::size_t i = 0; i < parent.size(); ++i) {
    if (has_mate[i]) {
      ++linkage.linked_parts;
      const int size = ++sizes[find_root(i)];
      linkage.components += size == 1 ? 1 : 0;
      linkage.largest_component = std::max(linkage.largest_component, size);
    }
  }
  return linkage;
}

int LinkedParts(const Product& product) {
  return CalcLinkage(product).linked_parts;
}

}  // namespace hvas::mates
