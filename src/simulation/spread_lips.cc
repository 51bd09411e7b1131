// Lips of seals that a shaft spreads on its way.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mates/elastic_parts.h"
#include "sequence/giving_force.h"
#include "simulation/insert_walk.h"
#include "simulation/pressed_pairs.h"

namespace hvas::simulation {
namespace {

using product::ElasticKind;
using product::ElasticPart;
using product::Feature;
using product::FeatureKind;
using product::OccurrenceId;
using product::Product;

constexpr int kSpreadSteps = 240;       // Of a curve: chamfers are some tenth of a way. A choice.
constexpr double kMostSpread = 2.5e-3;  // [m]: further out a shaft passes no lip. A choice.
constexpr double kOffAxis = 0.3e-3;     // [m] that the two axes may be apart as drawn. A choice.
constexpr double kTilted = 1e-3;        // [rad] between the two axes: as drawn they are parallel.

/** The shaft that a lip runs on: cylinders and cones of one part about the axis of the seal, along
 which heights count from the seal's centre. */
struct LipShaft {
  OccurrenceId part;
  std::vector<Feature> features;  // Axis and origin are those of the seal's frame.

  /** Radius at a height; 0 beyond the ends. */
  [[nodiscard]] double RadiusAt(double height) const {
    double radius = 0;
    for (const Feature& feature : features) {
      const double along = (height - feature.origin_B.z()) * feature.axis_B.z();
      if (along >= feature.span_low && along <= feature.span_high) {
        const double here = feature.kind == FeatureKind::kShaft
                                ? feature.radius
                                : std::abs(along) * std::tan(feature.half_angle);
        radius = std::max(radius, here);
      }
    }
    return radius;
  }

  /** The heights between which the shaft is. */
  [[nodiscard]] std::array<double, 2> Span() const {
    std::array<double, 2> span{std::numeric_limits<double>::infinity(),
                               -std::numeric_limits<double>::infinity()};
    for (const Feature& feature : features) {
      for (const double end : {feature.span_low, feature.span_high}) {
        const double height = feature.origin_B.z() + feature.axis_B.z() * end;
        span[0] = std::min(span[0], height);
        span[1] = std::max(span[1], height);
      }
    }
    return span;
  }
};

class LipSearch {
 public:
  LipSearch(const Product& product, const sequence::Sequence& sequence)
      : product_(product), sequence_(sequence) {
    for (const ElasticPart& part : product.elastic) {
      if (part.kind == ElasticKind::kLipSeal && mates::FindMissingSize(part).empty()) {
        AddShafts(part);
      }
    }
  }

  std::vector<PressedPair> Run() {
    if (!lips_.empty()) {
      WalkInserts(product_, sequence_, [this](const InsertStep& insert) {
        for (const Lip& lip : lips_) {
          FindSpread(insert, lip);
        }
      });
    }
    return std::move(pairs_);
  }

 private:
  struct Lip {
    const ElasticPart* seal{nullptr};
    LipShaft shaft;
    double given{0};  // How far it is spread in its place [m].
  };

  void AddShafts(const ElasticPart& seal) {
    const spatial::Pose& X_WB = product_.occurrences[seal.occurrence.index()].X_WB;
    for (const product::Occurrence& other : product_.occurrences) {
      if (other.id == seal.occurrence) {
        continue;
      }
      Lip lip{&seal, ListShaft(seal, X_WB, other.id), 0};
      const double spread = lip.shaft.RadiusAt(seal.lip_at) - 0.5 * seal.free_size;
      if (spread > kLeastPressed && spread < kMostSpread) {
        lip.given = spread;
        lips_.push_back(std::move(lip));
      }
    }
  }

  /** The cylinders and cones of a part about the axis of a seal. */
  [[nodiscard]] LipShaft ListShaft(const ElasticPart& seal, const spatial::Pose& X_WB,
                                   OccurrenceId other) const {
    LipShaft shaft{other, {}};
    const spatial::Pose X_BO = X_WB.Inverse() * product_.occurrences[other.index()].X_WB;
    for (const Feature& feature : product_.part_of(other).features) {
      if (feature.kind != FeatureKind::kShaft && feature.kind != FeatureKind::kTaper) {
        continue;
      }
      const Vec3 axis_B = X_BO.q() * feature.axis_B;
      const Vec3 from_centre = X_BO * feature.origin_B - seal.centre_B;
      const double height = from_centre.dot(seal.axis_B);
      if (axis_B.cross(seal.axis_B).norm() > kTilted ||
          (from_centre - height * seal.axis_B).norm() > kOffAxis) {
        continue;
      }
      Feature about = feature;
      about.origin_B = {0, 0, height};
      about.axis_B = {0, 0, axis_B.dot(seal.axis_B) > 0 ? 1.0 : -1.0};
      shaft.features.push_back(std::move(about));
    }
    return shaft;
  }

  void FindSpread(const InsertStep& insert, const Lip& lip) {
    const sequence::SequenceStep& step = *insert.step;
    const OccurrenceId own = lip.seal->occurrence;
    const bool is_own = insert.Moves(own);
    if (is_own == insert.Moves(lip.shaft.part) ||
        !insert.HasPlaced(is_own ? lip.shaft.part : own)) {
      return;
    }
    const Vec3 axis_W = product_.occurrences[own.index()].X_WB.q() * lip.seal->axis_B;
    const double along = step.extraction_W.dot(axis_W);
    if (std::abs(along) < kAlongAxis) {
      return;
    }
    // On the way out the lip goes up along the shaft, or the shaft down through the lip.
    const double up = (along > 0 ? 1.0 : -1.0) * (is_own ? 1.0 : -1.0);
    const std::array<double, 2> span = lip.shaft.Span();
    const double until =
        (up > 0 ? span[1] - lip.seal->lip_at : lip.seal->lip_at - span[0]) + kMostSpread;
    PressedPair pair;
    pair.moved = step.occurrence;
    pair.parts = {own};
    pair.support = lip.shaft.part;
    pair.against = is_own ? lip.shaft.part : own;
    pair.is_radial = true;
    pair.growth = {lip.given, 0};
    pair.source = "lip as a short shell, Hetenyi";
    auto curve = std::make_shared<haptics::GivingCurve>();
    curve->stiffness = mates::CalcLipStiffness(*lip.seal);
    curve->friction = sequence::FindKineticFriction(product_, own, lip.shaft.part);
    curve->spacing = until / kSpreadSteps;
    for (int i = 0; i < kSpreadSteps; ++i) {
      const double radius = lip.shaft.RadiusAt(lip.seal->lip_at + up * i * curve->spacing);
      const double spread = std::max(0.0, radius - 0.5 * lip.seal->free_size);
      pair.compression = std::max(pair.compression, std::min(spread, kMostSpread));
      curve->given.push_back(std::min(spread, kMostSpread));
    }
    sequence::FinishGiven(curve->spacing, &curve->given);
    pair.force = haptics::CalcGivingPeak(*curve).in;
    pair.curve = std::move(curve);
    pairs_.push_back(std::move(pair));
  }

  const Product& product_;
  const sequence::Sequence& sequence_;
  std::vector<Lip> lips_;
  std::vector<PressedPair> pairs_;
};

}  // namespace

std::vector<PressedPair> ListSpreadLips(const Product& product,
                                        const sequence::Sequence& sequence) {
  return LipSearch(product, sequence).Run();
}

}  // namespace hvas::simulation
