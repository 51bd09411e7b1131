// Slit pins and sleeves of rubber that a hole or a shaft presses all around.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "fits/elastic_parts.h"
#include "sequence/giving_force.h"
#include "simulation/insert_walk.h"
#include "simulation/pressed_pairs.h"

namespace hvas::simulation {
namespace {

using product::ElasticKind;
using product::ElasticPart;
using product::Mate;
using product::OccurrenceId;
using product::Product;

constexpr double kPinYield = 1.4e9;  // [Pa]: ISO 8752 has 420 to 520 HV, times 3.2. A choice.
constexpr int kSqueezeSteps = 120;   // Of a curve; it is a spline. A choice.

/** Whether ISO 286 has the fit of a mate, whose force then counts. */
bool IsFit(const Mate& mate) {
  return mate.fit && product::IsIsoFit(mate.fit->kind);
}

/** The mate's side that is the elastic part. */
struct ElasticMate {
  const Mate* mate{nullptr};
  const ElasticPart* part{nullptr};
  OccurrenceId other;
  bool is_shaft{true};  // The elastic part is in a hole.
};

/** How much smaller its radius is in its place, or how much wider, and its radial force then. */
struct Squeeze {
  double given{0};                     // [m]
  double stiffness{0};                 // [N/m]
  std::array<double, 2> growth{0, 0};  // Of inner and outer radius, as drawn in its place [m].
  const char* source{""};
};

Squeeze CalcPinSqueeze(const ElasticPart& pin, double hole_radius, double length) {
  const fits::SlitPin law{pin.free_size, pin.thickness, length, pin.modulus, kPinYield};
  const double given = 0.5 * pin.free_size - hole_radius;
  const double force = fits::CalcSlitPinForce(law, given);
  const double stiffness = fits::CalcSpreadStiffness(
      {0.5 * (pin.free_size - pin.thickness), pin.thickness, length, pin.modulus});
  // Beyond its yield it resists by no more.
  return {stiffness > 0 ? std::min(given, force / stiffness) : 0,
          stiffness,
          {-given, -given},
          "open ring that its hole closes, Timoshenko, up to its yield"};
}

/** @param gap  Radial width of the room between hole and shaft, where both are there, else 0. */
Squeeze CalcSleeveSqueeze(const ElasticPart& sleeve, const ElasticMate& side, double length,
                          double gap) {
  const double bore = 0.5 * sleeve.inner;
  const double outside = 0.5 * sleeve.free_size;
  const fits::RubberSleeve law{bore, outside, length, sleeve.modulus};
  if (gap > 0) {
    const double given = outside - bore - gap;
    return {given, fits::CalcSleeveStiffness(law),
            side.is_shaft ? std::array{0.0, -given} : std::array{given, 0.0},
            "wall of rubber, Gent and Lindley"};
  }
  const double given =
      side.is_shaft ? outside - side.mate->hole_radius : side.mate->shaft_radius - bore;
  const double grows = side.is_shaft ? -given : given;
  return {given,
          fits::CalcSleeveHoopStiffness(law),
          {grows, grows},
          "ring of rubber under hoop tension"};
}

/** Length of the shaft in the hole once the shaft is `travel` out along the mate's z, or against
 it. */
double CalcEngaged(const Mate& mate, double travel) {
  return std::max(0.0, std::min(mate.hole_high, mate.shaft_high + travel) -
                           std::max(mate.hole_low, mate.shaft_low + travel));
}

class SqueezeSearch {
 public:
  SqueezeSearch(const Product& product, const sequence::Sequence& sequence)
      : product_(product), sequence_(sequence) {}

  std::vector<PressedPair> Run() {
    CollectMates();
    if (mates_.empty()) {
      return {};
    }
    WalkInserts(product_, sequence_, [this](const InsertStep& insert) {
      for (const ElasticMate& side : mates_) {
        FindSqueeze(insert, side);
      }
    });
    return std::move(pairs_);
  }

 private:
  void CollectMates() {
    for (const Mate& mate : product_.mates) {
      if (mate.kind != product::MateKind::kAxisHole || IsFit(mate)) {
        continue;
      }
      for (const bool is_shaft : {true, false}) {
        const OccurrenceId own = is_shaft ? mate.b.occurrence : mate.a.occurrence;
        const OccurrenceId other = is_shaft ? mate.a.occurrence : mate.b.occurrence;
        const ElasticPart* part = FindElastic(product_, own);
        if (part != nullptr && (part->kind == ElasticKind::kSleeve ||
                                (part->kind == ElasticKind::kSlitPin && is_shaft))) {
          mates_.push_back({&mate, part, other, is_shaft});
        }
      }
    }
  }

  /** The room between the hole and the shaft of a sleeve, both in their place or moved; 0 where one
   is not there. */
  [[nodiscard]] double FindGap(const ElasticMate& side, const InsertStep& insert) const {
    for (const ElasticMate& opposite : mates_) {
      const bool is_there = insert.HasPlaced(opposite.other) || insert.Moves(opposite.other);
      if (opposite.part == side.part && opposite.is_shaft != side.is_shaft && is_there) {
        const Mate& in_hole = side.is_shaft ? *side.mate : *opposite.mate;
        const Mate& on_shaft = side.is_shaft ? *opposite.mate : *side.mate;
        return std::max(0.0, in_hole.hole_radius - on_shaft.shaft_radius);
      }
    }
    return 0;
  }

  void FindSqueeze(const InsertStep& insert, const ElasticMate& side) {
    const sequence::SequenceStep& step = *insert.step;
    const OccurrenceId own = side.part->occurrence;
    const bool is_own = insert.Moves(own);
    if (is_own == insert.Moves(side.other) || !insert.HasPlaced(is_own ? side.other : own)) {
      return;
    }
    const Mate& mate = *side.mate;
    const Vec3 axis_W = product_.occurrences[mate.a.occurrence.index()].X_WB.q() *
                        (mate.a.X_BM.q() * Vec3::UnitZ());
    const double along = step.extraction_W.dot(axis_W);
    if (std::abs(along) < kAlongAxis) {
      return;
    }
    const bool shaft_moves = is_own == side.is_shaft;
    const double direction = (along > 0 ? 1.0 : -1.0) * (shaft_moves ? 1.0 : -1.0);
    const double length = CalcEngaged(mate, 0);
    if (!(length > 0)) {
      return;
    }
    const Squeeze squeeze =
        side.part->kind == ElasticKind::kSlitPin
            ? CalcPinSqueeze(*side.part, mate.hole_radius, length)
            : CalcSleeveSqueeze(*side.part, side, length, FindGap(side, insert));
    if (!(squeeze.given > kLeastPressed) || !(squeeze.stiffness > 0)) {
      return;
    }
    AddPair(step, side, squeeze, direction, is_own ? side.other : own);
  }

  void AddPair(const sequence::SequenceStep& step, const ElasticMate& side, const Squeeze& squeeze,
               double direction, OccurrenceId against) {
    const Mate& mate = *side.mate;
    const double length = CalcEngaged(mate, 0);
    const double until =
        direction > 0 ? mate.hole_high - mate.shaft_low : mate.shaft_high - mate.hole_low;
    auto curve = std::make_shared<haptics::GivingCurve>();
    curve->stiffness = squeeze.stiffness;
    curve->friction = sequence::FindKineticFriction(product_, side.part->occurrence, side.other);
    curve->spacing = until / kSqueezeSteps;
    for (int i = 0; i < kSqueezeSteps; ++i) {
      const double engaged = CalcEngaged(mate, direction * i * curve->spacing);
      curve->given.push_back(squeeze.given * engaged / length);
    }
    PressedPair pair;
    pair.moved = step.occurrence;
    pair.parts = {side.part->occurrence};
    pair.support = side.other;
    pair.compression = squeeze.given;
    pair.force = haptics::CalcGivingPeak(*curve).in;
    pair.against = against;
    pair.is_radial = true;
    pair.growth = squeeze.growth;
    pair.source = squeeze.source;
    pair.curve = std::move(curve);
    pairs_.push_back(std::move(pair));
  }

  const Product& product_;
  const sequence::Sequence& sequence_;
  std::vector<ElasticMate> mates_;
  std::vector<PressedPair> pairs_;
};

}  // namespace

std::vector<PressedPair> ListSqueezedPairs(const Product& product,
                                           const sequence::Sequence& sequence) {
  return SqueezeSearch(product, sequence).Run();
}

}  // namespace hvas::simulation
