#include "mates/infer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "fits/threads.h"
#include "mates/axis_rules.h"
#include "mates/build_mate.h"
#include "mates/drawing_errors.h"
#include "mates/drawn_oddities.h"
#include "mates/fasteners.h"
#include "mates/joints.h"
#include "mates/judge.h"
#include "mates/mate_key.h"
#include "mates/pair_search.h"
#include "mates/prismatic_fits.h"
#include "mates/propose_fit.h"
#include "mates/surface_pairs.h"
#include "mates/unit_doubt.h"
#include "product/same_place.h"
#include "spatial/box_pairs.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureId;
using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using product::Part;
using product::Pose;
using product::Product;

/** What one pair of occurrences has, and where its axes begin in the list of all. */
struct Pair {
  OccurrenceId a;
  OccurrenceId b;
  PairHits hits;
  std::size_t first_axis{0};
};

/** Coplanar faces of a pair, which make one mate. */
struct PlaneGroup {
  std::vector<const PlaneHit*> hits;
  const PlaneHit* largest{nullptr};
  double area{0};
  Vec3 moment_A{Vec3::Zero()};
};

class Inference {
 public:
  Inference(Product* product, const InferenceLimits& limits, WorkWatch* watch)
      : product_(product),
        limits_(limits),
        watch_(watch),
        cos_angle_(std::cos(limits.angle)),
        fasteners_(ClassifyOccurrences(*product)),
        original_of_(product::FindOriginals(*product)) {}

  std::vector<DrawnOddity> Run() {
    FindPairs();
    KeepScrewsOffAxis();
    product_->mates.clear();
    product_->alignments.clear();
    const AxisRules rules(limits_, axis_hits_, watch_);
    std::vector<DrawnOddity> oddities;
    for (std::size_t i = 0; i < pairs_.size() && MayGoOn(watch_); ++i) {
      const Pair& pair = pairs_[i];
      const std::size_t end = i + 1 < pairs_.size() ? pairs_[i + 1].first_axis : axis_hits_.size();
      const std::vector<const PlacedAxisHit*> working = rules.ChooseWorking(pair.first_axis, end);
      for (const PlacedAxisHit* hit : working) {
        Add(MateKind::kAxisHole, hit->hole_occurrence, hit->hole, hit->shaft_occurrence,
            hit->shaft);
      }
      AddSeats(pair);
      AddPlanes(pair);
      AddAlignments(pair, rules, working);
      CollectOddities(pair, &oddities);
    }
    ProposeFits();
    Finish();
    return oddities;
  }

  /** As FindOriginals() has it. */
  [[nodiscard]] const std::vector<OccurrenceId>& original_of() const { return original_of_; }

 private:
  [[nodiscard]] const Pose& PoseOf(OccurrenceId id) const {
    return product_->occurrences[id.index()].X_WB;
  }

  [[nodiscard]] const Feature& FeatureOf(OccurrenceId id, FeatureId feature) const {
    return product_->part_of(id).features[feature.index()];
  }

  [[nodiscard]] double SizeOf(OccurrenceId id) const {
    const spatial::Box& box = product_->part_of(id).box_B;
    return box.is_empty() ? 0.0 : box.size().norm();
  }

  [[nodiscard]] double ScaleOf(const Pair& pair) const {
    return CalcLengthScale(std::min(SizeOf(pair.a), SizeOf(pair.b)));
  }

  void FindPairs() {
    std::vector<spatial::Box> boxes;
    double largest = 0;
    for (const product::Occurrence& occurrence : product_->occurrences) {
      const bool is_copy = original_of_[occurrence.id.index()].is_valid();
      boxes.push_back(
          is_copy ? spatial::Box()
                  : spatial::Transform(occurrence.X_WB, product_->part_of(occurrence.id).box_B));
      largest = std::max(largest, SizeOf(occurrence.id));
    }
    PairSearch search(*product_, limits_, watch_);
    const double margin = limits_.near_gap * CalcLengthScale(largest);
    spatial::ForEachPair(boxes, margin, watch_, [&](std::size_t i, std::size_t k) {
      const PairHits& hits = search.Find(OccurrenceId(i), OccurrenceId(k));
      if (!hits.is_empty()) {
        Pair pair{OccurrenceId(i), OccurrenceId(k), hits, axis_hits_.size()};
        for (const AxisHit& hit : pair.hits.axes) {
          axis_hits_.push_back(Place(pair, hit));
        }
        pairs_.push_back(std::move(pair));
      }
      return true;
    });
  }

  [[nodiscard]] PlacedAxisHit Place(const Pair& pair, const AxisHit& hit) const {
    PlacedAxisHit placed;
    placed.hole_occurrence = hit.is_hole_in_a ? pair.a : pair.b;
    placed.shaft_occurrence = hit.is_hole_in_a ? pair.b : pair.a;
    placed.hole = hit.hole;
    placed.shaft = hit.shaft;
    const Feature& hole = FeatureOf(placed.hole_occurrence, hit.hole);
    const Pose& X_WB = PoseOf(placed.hole_occurrence);
    placed.origin_W = X_WB * hole.origin_B;
    placed.axis_W = X_WB.q() * hole.axis_B;
    placed.hole_radius = hole.radius;
    placed.shaft_radius = FeatureOf(placed.shaft_occurrence, hit.shaft).radius;
    placed.low = hit.low;
    placed.high = hit.high;
    placed.scale = ScaleOf(pair);
    placed.is_off_axis = hit.is_off_axis;
    placed.is_screw = fasteners_[placed.shaft_occurrence.index()] == FastenerKind::kScrew;
    return placed;
  }

  /** Whether a shaft is screwed in where it is on its hole's axis. */
  [[nodiscard]] bool IsThread(const PlacedAxisHit& hit) const {
    const Feature& hole = FeatureOf(hit.hole_occurrence, hit.hole);
    return !hit.is_off_axis && (fasteners_[hit.hole_occurrence.index()] == FastenerKind::kNut ||
                                hole.thread != product::ThreadKind::kNone ||
                                fits::FindThreadOfPair(2 * hit.hole_radius, 2 * hit.shaft_radius));
  }

  /** Of what is off the axis of its hole keeps the screws, and what is screwed in elsewhere, in the
   holes of parts that they do not centre in: other shafts are in wide holes by chance. */
  void KeepScrewsOffAxis() {
    using Shaft = std::pair<OccurrenceId, FeatureId>;
    std::set<Shaft> screws;
    std::set<std::pair<Shaft, OccurrenceId>> centred;
    for (const PlacedAxisHit& hit : axis_hits_) {
      const Shaft shaft(hit.shaft_occurrence, hit.shaft);
      if (hit.is_screw || IsThread(hit)) {
        screws.insert(shaft);
      }
      if (!hit.is_off_axis) {
        centred.insert({shaft, hit.hole_occurrence});
      }
    }
    const auto is_chance = [&](const PlacedAxisHit& hit) {
      const Shaft shaft(hit.shaft_occurrence, hit.shaft);
      return hit.is_off_axis &&
             (screws.count(shaft) == 0 || centred.count({shaft, hit.hole_occurrence}) > 0);
    };
    std::vector<PlacedAxisHit> kept;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const std::size_t end = i + 1 < pairs_.size() ? pairs_[i + 1].first_axis : axis_hits_.size();
      const std::size_t first = kept.size();
      for (std::size_t k = pairs_[i].first_axis; k < end; ++k) {
        if (!is_chance(axis_hits_[k])) {
          kept.push_back(axis_hits_[k]);
          kept.back().is_screw |=
              screws.count({kept.back().shaft_occurrence, kept.back().shaft}) > 0;
        }
      }
      pairs_[i].first_axis = first;
    }
    axis_hits_ = std::move(kept);
  }

  [[nodiscard]] MateSide SideOf(OccurrenceId id, FeatureId feature) const {
    return {id, feature, PoseOf(id)};
  }

  void Add(MateKind kind, OccurrenceId a, FeatureId feature_a, OccurrenceId b,
           FeatureId feature_b) {
    Mate mate = BuildMate(*product_, kind, SideOf(a, feature_a), SideOf(b, feature_b));
    mate.surfaces = FindSurfacePairs(*product_, mate, watch_);
    product_->mates.push_back(std::move(mate));
  }

  /** One seat for each pair of features: cones and balls have no steps to choose from. */
  void AddSeats(const Pair& pair) {
    for (const SeatHit& hit : pair.hits.seats) {
      const OccurrenceId seat = hit.is_seat_in_a ? pair.a : pair.b;
      const OccurrenceId body = hit.is_seat_in_a ? pair.b : pair.a;
      Mate mate = BuildMate(*product_, hit.kind, SideOf(seat, hit.seat), SideOf(body, hit.body));
      if (hit.kind == MateKind::kSphereSeat) {
        mate.overlap = CalcSphereOverlap(*product_, mate);
        if (mate.overlap <= 0) {
          continue;  // Concentric, but the socket is on the other side.
        }
      }
      mate.surfaces = FindSurfacePairs(*product_, mate, watch_);
      product_->mates.push_back(std::move(mate));
    }
  }

  /** Whether some other planes of a pair face each other the other way round, so that one part is
   between walls of the other one: parallel ones, or those of a dovetail or polygon. */
  [[nodiscard]] bool IsBetweenWalls(const Pair& pair, const PlaneHit& hit) const {
    constexpr double kOpposed = -0.45;  // Dovetails have flanks of up to 60 deg, polygons 60 deg.
    const Vec3& nhat = FeatureOf(pair.a, hit.a).axis_B;
    const auto opposes = [&](const PlaneHit& other) {
      return nhat.dot(FeatureOf(pair.a, other.a).axis_B) <= kOpposed;
    };
    return std::any_of(pair.hits.planes.begin(), pair.hits.planes.end(), opposes) ||
           std::any_of(pair.hits.walls.begin(), pair.hits.walls.end(), opposes);
  }

  /** Planes of a pair that touch, or that hold one part between walls of the other one. */
  [[nodiscard]] std::vector<const PlaneHit*> ListMatedPlanes(const Pair& pair) const {
    std::vector<const PlaneHit*> hits;
    for (const PlaneHit& hit : pair.hits.planes) {
      hits.push_back(&hit);
    }
    for (const PlaneHit& hit : pair.hits.walls) {
      if (IsBetweenWalls(pair, hit)) {
        hits.push_back(&hit);
      }
    }
    return hits;
  }

  [[nodiscard]] std::vector<PlaneGroup> GroupPlanes(const Pair& pair) const {
    const double gap = limits_.plane_gap * ScaleOf(pair);
    std::vector<PlaneGroup> groups;
    for (const PlaneHit* const plane : ListMatedPlanes(pair)) {
      if (!MayGoOn(watch_)) {
        break;
      }
      const PlaneHit& hit = *plane;
      const auto found = std::find_if(groups.begin(), groups.end(), [&](const PlaneGroup& group) {
        const Vec3& nhat = FeatureOf(pair.a, group.largest->a).axis_B;
        return nhat.dot(FeatureOf(pair.a, hit.a).axis_B) >= cos_angle_ &&
               std::abs(nhat.dot(hit.centroid_A - group.largest->centroid_A)) < 2 * gap;
      });
      PlaneGroup& group = found != groups.end() ? *found : groups.emplace_back();
      if (group.largest == nullptr || hit.area > group.largest->area) {
        group.largest = &hit;
      }
      group.hits.push_back(&hit);
      group.area += hit.area;
      group.moment_A += hit.area * hit.centroid_A;
    }
    return groups;
  }

  void AddPlanes(const Pair& pair) {
    const std::size_t first = product_->mates.size();
    for (const PlaneGroup& group : GroupPlanes(pair)) {
      const MateSide a = SideOf(pair.a, group.largest->a);
      const MateSide b = SideOf(pair.b, group.largest->b);
      Mate mate = BuildMate(*product_, MateKind::kFaceFace, a, b);
      MoveFrames(*product_, a, b, a.X_WB * Vec3(group.moment_A / group.area), &mate);
      mate.overlap = group.area;
      std::vector<FeaturePair> features;
      for (const PlaneHit* hit : group.hits) {
        features.emplace_back(hit->a, hit->b);
      }
      mate.surfaces = FindSurfacePairs(*product_, mate, features, watch_);
      product_->mates.push_back(std::move(mate));
    }
    JoinWalls(product_, first);
  }

  /** Holes in line with nothing through both, one hint for a pair and axis; none where the parts
   are mated on that axis already. */
  void AddAlignments(const Pair& pair, const AxisRules& rules,
                     const std::vector<const PlacedAxisHit*>& working) {
    std::vector<std::pair<Vec3, Vec3>> known;  // Point and axis, in the first part.
    for (const PlacedAxisHit* hit : working) {
      const Pose X_AW = PoseOf(pair.a).Inverse();
      known.emplace_back(X_AW * hit->origin_W, X_AW.q() * hit->axis_W);
    }
    for (const HoleHit& hit : pair.hits.holes) {
      if (!MayGoOn(watch_)) {
        return;
      }
      const Feature& hole = FeatureOf(pair.a, hit.a);
      const double limit = limits_.axis_distance * ScaleOf(pair);
      const bool is_known = std::any_of(known.begin(), known.end(), [&](const auto& axis) {
        return std::abs(axis.second.dot(hole.axis_B)) >= cos_angle_ &&
               axis.second.cross(hole.origin_B - axis.first).norm() < limit;
      });
      if (is_known || !rules.IsUnbolted({pair.a, pair.b, hit.a, hit.b})) {
        continue;
      }
      known.emplace_back(hole.origin_B, hole.axis_B);
      const Mate frames =
          BuildMate(*product_, MateKind::kAxisHole, SideOf(pair.a, hit.a), SideOf(pair.b, hit.b));
      product_->alignments.push_back({frames.a, frames.b});
    }
  }

  static void CollectOddities(const Pair& pair, std::vector<DrawnOddity>* oddities) {
    for (const std::optional<PlaneHit>& hit : {pair.hits.nearest, pair.hits.overlapping}) {
      if (hit) {
        oddities->push_back({pair.a, pair.b, hit->gap, hit->area});
      }
    }
  }

  /** How many nuts sit on each part. */
  [[nodiscard]] std::vector<int> CountNuts() const {
    std::vector<int> nuts(product_->occurrences.size(), 0);
    for (const Mate& mate : product_->mates) {
      if (mate.kind == MateKind::kAxisHole &&
          fasteners_[mate.a.occurrence.index()] == FastenerKind::kNut) {
        ++nuts[mate.b.occurrence.index()];
      }
    }
    return nuts;
  }

  /** How far a shaft is off its hole's axis, and along which axes of the hole's part. */
  [[nodiscard]] std::string DescribeOffset(const Mate& mate, double offset) const {
    const Feature& shaft = FeatureOf(mate.b.occurrence, mate.b.feature);
    const Vec3 d_B = mate.b.X_BM.p() - shaft.origin_B;
    const Vec3 off_W =
        PoseOf(mate.b.occurrence).q() * Vec3(d_B.dot(shaft.axis_B) * shaft.axis_B - d_B);
    constexpr double kDigits = 1e3;  // What is printed: zero has no sign. A choice.
    const Vec3 off_mm = units::ToMm(1.0) * (PoseOf(mate.a.occurrence).q().conjugate() * off_W);
    const auto print = [](double value) { return std::round(kDigits * value) / kDigits + 0.0; };
    return fmt::format(", {:.3f} mm off its axis (x {:.3f}, y {:.3f}, z {:.3f})",
                       units::ToMm(offset), print(off_mm.x()), print(off_mm.y()),
                       print(off_mm.z()));
  }

  void ProposeFits() {
    const std::vector<int> nuts = CountNuts();
    for (Mate& mate : product_->mates) {
      if (mate.kind == MateKind::kAxisHole) {
        FitEvidence evidence = MakeFitEvidence(*product_, mate, fasteners_);
        // A bolt with a nut passes through its other holes; it is not screwed into them.
        const int others =
            nuts[mate.b.occurrence.index()] - (evidence.hole_part == FastenerKind::kNut ? 1 : 0);
        evidence.nut_on_shaft = evidence.shaft_part == FastenerKind::kScrew && others > 0;
        mate.fit = ProposeFit(evidence);
        const double offset = CalcOffset(*product_, mate);
        if (offset > limits_.axis_distance) {
          mate.fit->reason += DescribeOffset(mate, offset);
        }
      }
    }
    std::erase_if(product_->mates,
                  [this](const Mate& mate) { return IsBeyondAnyFit(*product_, mate); });
  }

  void Finish() {
    for (std::size_t i = 0; i < product_->mates.size(); ++i) {
      Mate& mate = product_->mates[i];
      mate.id = product::MateId(i);
      Judge(*product_, limits_, fasteners_[mate.a.occurrence.index()],
            fasteners_[mate.b.occurrence.index()], &mate);
    }
    AssignKeys(product_);
    BuildJoints(product_, watch_);
  }

  Product* product_;
  InferenceLimits limits_;
  WorkWatch* watch_;
  double cos_angle_{1};
  std::vector<FastenerKind> fasteners_;
  std::vector<OccurrenceId> original_of_;
  std::vector<Pair> pairs_;
  std::vector<PlacedAxisHit> axis_hits_;
};

}  // namespace

void Infer(Product* product, Diagnostics* diagnostics, const InferenceLimits& limits) {
  (void)Infer(product, diagnostics, nullptr, limits);  // Without a watch nothing ends it.
}

Result<void> Infer(Product* product, Diagnostics* diagnostics, WorkWatch* watch,
                   const InferenceLimits& limits) {
  Inference inference(product, limits, watch);
  const std::vector<DrawnOddity> oddities = inference.Run();
  if (!MayGoOn(watch)) {
    return Unexpected(watch->Explain("finding the mates", product->source));
  }
  ReportOddities(*product, oddities, inference.original_of(), diagnostics);
  ReportDoubtfulUnit(*product, diagnostics);
  return {};
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

int CountLinkedParts(const Product& product) {
  return CalcLinkage(product).linked_parts;
}

}  // namespace hvas::mates
