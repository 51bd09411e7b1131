// The parts of a model that are drawn deformed.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "fits/pressed_parts.h"
#include "mates/elastic_parts.h"
#include "sequence/sequence.h"
#include "simulation/deformation.h"
#include "simulation/pressed_pairs.h"

namespace hvas::simulation {
namespace {

using product::ElasticKind;
using product::ElasticPart;
using product::FlexibleKind;
using product::OccurrenceId;
using product::Part;
using product::Product;

constexpr int kSectors = 720;       // Of a turn, in which a ring is there or not: a choice.
constexpr int kShareHalvings = 50;  // Of the compression of a part of a stack: below a nanometre.

/** A ring or a tube: its axis, and its radii. */
struct RingForm {
  Vec3 centre_B{Vec3::Zero()};
  Vec3 axis_B{Vec3::UnitZ()};
  double inner{0};  // [m]
  double outer{0};  // [m]
};

/** The axis of a ring is that of its largest face of revolution, or where it has none the short way
 through its box. */
RingForm FindRingForm(const Part& part) {
  RingForm ring;
  Eigen::Index shortest = 0;
  (void)part.box_B.size().minCoeff(&shortest);
  ring.axis_B = Vec3::Unit(shortest);
  ring.centre_B = part.box_B.centre();
  double largest = 0;
  for (const product::Face& face : part.faces) {
    const bool is_round = face.surface.kind == spatial::SurfaceKind::kCylinder ||
                          face.surface.kind == spatial::SurfaceKind::kTorus ||
                          face.surface.kind == spatial::SurfaceKind::kCone;
    if (is_round && face.area > largest) {
      largest = face.area;
      ring.axis_B = face.surface.axis.normalized();
      ring.centre_B = face.surface.origin;
    }
  }
  ring.inner = std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : part.mesh.vertices) {
    const double radius = (vertex - ring.centre_B).cross(ring.axis_B).norm();
    ring.inner = std::min(ring.inner, radius);
    ring.outer = std::max(ring.outer, radius);
  }
  return ring;
}

/** The direction from the axis of a ring to its back, opposite of its gap; none where it is closed.
 */
std::optional<Vec3> FindBack(const Part& part, const RingForm& ring) {
  const Vec3 x_B = ring.axis_B.unitOrthogonal();
  const Vec3 y_B = ring.axis_B.cross(x_B);
  std::vector<bool> is_there(kSectors, false);
  const auto angle_of = [&](const Vec3& p_B) {
    const Vec3 d = p_B - ring.centre_B;
    return std::atan2(d.dot(y_B), d.dot(x_B));
  };
  constexpr double kSector =  // A definition.
      2 * std::numbers::pi / kSectors;
  for (const auto& triangle : part.mesh.triangles) {
    const double first = angle_of(part.mesh.vertices[triangle[0]]);
    double low = 0;
    double high = 0;
    for (const std::uint32_t v : triangle) {
      const double off =
          std::remainder(angle_of(part.mesh.vertices[v]) - first, 2 * std::numbers::pi);
      low = std::min(low, off);
      high = std::max(high, off);
    }
    const auto begin = static_cast<int>(std::ceil((first + low) / kSector));
    const auto end = static_cast<int>(std::floor((first + high) / kSector));
    for (int i = begin; i <= end; ++i) {
      is_there[static_cast<std::size_t>((i % kSectors + kSectors) % kSectors)] = true;
    }
  }
  // The longest run of sectors in which there is nothing, round and round.
  int longest = 0;
  int end_of_longest = 0;
  int run = 0;
  for (int i = 0; i < 2 * kSectors; ++i) {
    run = is_there[static_cast<std::size_t>(i % kSectors)] ? 0 : run + 1;
    if (run > longest && run <= kSectors) {
      longest = run;
      end_of_longest = i;
    }
  }
  if (longest == 0 || longest >= kSectors) {
    return std::nullopt;
  }
  const double gap = (end_of_longest - 0.5 * (longest - 1)) * kSector;
  return Vec3(-std::cos(gap) * x_B - std::sin(gap) * y_B);
}

/** A ring that changes its radius as a whole; open where it has a gap. */
DeformationForm MakeRingForm(const Part& part, const RingForm& ring) {
  DeformationForm form;
  form.origin_B = ring.centre_B;
  form.axis_B = ring.axis_B;
  form.range = {ring.inner, ring.outer};
  form.length = 0.5 * (ring.inner + ring.outer);
  const auto back = FindBack(part, ring);
  form.kind = back ? DeformationKind::kOpen : DeformationKind::kRadial;
  form.aside_B = back.value_or(ring.axis_B.unitOrthogonal());
  return form;
}

/** How far the coordinates along an axis of some points rise with a measure of them: the sum of
 products with what the measure is beyond its mean. */
template <typename Measure>
double CalcRise(const Part& part, const Vec3& axis_B, const Measure& measure) {
  double mean = 0;
  for (const Vec3& vertex : part.mesh.vertices) {
    mean += measure(vertex) / static_cast<double>(part.mesh.vertices.size());
  }
  double sum = 0;
  for (const Vec3& vertex : part.mesh.vertices) {
    sum += (vertex - part.box_B.centre()).dot(axis_B) * (measure(vertex) - mean);
  }
  return sum;
}

/** A part that is pressed along its axis.
 @param to_presser_B  Unit, along its axis, from the end that stays. */
DeformationForm MakePressForm(const Part& part, const ElasticPart& elastic,
                              const Vec3& to_presser_B) {
  DeformationForm form;
  form.kind = DeformationKind::kPress;
  form.axis_B = to_presser_B;
  form.length = elastic.length;
  form.origin_B = elastic.centre_B - 0.5 * elastic.length * form.axis_B;
  const RingForm ring{elastic.centre_B, to_presser_B, 0.5 * elastic.inner, 0.5 * elastic.outer};
  if (elastic.kind == ElasticKind::kDiscSpring) {
    form.kind = DeformationKind::kCone;
    form.range = {ring.inner, ring.outer};
    const double rise = CalcRise(part, to_presser_B, [&](const Vec3& p_B) {
      return (p_B - ring.centre_B).cross(ring.axis_B).norm();
    });
    // It stands on the edge that is lower; drawn flat, on the outer one.
    constexpr double kFlat = 1e-12;  // [m^2]: rounding of a sum. A choice.
    form.shares = rise > kFlat ? std::array{0.0, 1.0} : std::array{1.0, 0.0};
  } else if (elastic.kind == ElasticKind::kLockWasher) {
    if (const auto back = FindBack(part, ring)) {
      form.kind = DeformationKind::kHelix;
      form.aside_B = *back;
      const Vec3 side_B = form.axis_B.cross(*back);
      const double rise = CalcRise(part, to_presser_B, [&](const Vec3& p_B) {
        const Vec3 d = p_B - ring.centre_B;
        return std::atan2(d.dot(side_B), d.dot(*back));
      });
      form.shares = {rise < 0 ? -1.0 : 1.0, 0};
    }
  }
  return form;
}

DeformationForm MakeArmForm(const sequence::BentArm& arm) {
  DeformationForm form;
  form.kind = arm.is_round ? DeformationKind::kFlare : DeformationKind::kBend;
  form.origin_B = arm.root_B;
  form.axis_B = arm.axis_B;
  form.aside_B = arm.aside_B;
  form.length = arm.length;
  form.range = arm.range;
  form.across = arm.across;
  form.shares = {arm.bends_inwards ? -1.0 : 1.0, 0};
  return form;
}

/** The lip of a seal, which its shaft spreads. */
DeformationForm MakeLipForm(const ElasticPart& seal) {
  DeformationForm form;
  form.kind = DeformationKind::kFlare;
  form.origin_B = seal.centre_B + seal.lip_root * seal.axis_B;
  form.axis_B = std::copysign(1.0, seal.lip_at - seal.lip_root) * seal.axis_B;
  form.aside_B = seal.axis_B.unitOrthogonal();
  form.length = seal.lip_length();
  form.range = {0, seal.lip_radius};
  form.shares = {1, 0};
  return form;
}

class Lister {
 public:
  Lister(const Product& product, const sequence::Sequence& sequence)
      : product_(product), sequence_(sequence) {}

  void AddGive(const sequence::GivingPair& give) {
    const sequence::SequenceStep* step = sequence::FindInsertion(sequence_, give.moved);
    if (give.curve == nullptr || step == nullptr) {
      return;
    }
    const DeformationSource source{
        give.moved,         give.moved == give.flexible ? give.other : give.flexible,
        step->extraction_W, give.width > 0 ? give.width : give.depth,
        give.curve,         {}};
    const Part& part = product_.part_of(give.flexible);
    if (give.kind == FlexibleKind::kRetainingRing) {
      AddRing({give.flexible, MakeRingForm(part, FindRingForm(part)), 0, 1, {}, {}}, source);
    } else if (give.kind == FlexibleKind::kORing) {
      const RingForm ring = FindRingForm(part);
      DeformationForm form = MakeRingForm(part, ring);
      form.kind = DeformationKind::kRadial;
      if (give.curve->squeezed) {
        form.shares = give.is_outside ? std::array{0.0, -1.0} : std::array{1.0, 0.0};
      }
      AddRing({give.flexible, form, 0, 1, {}, {}}, source);
    } else {
      for (const sequence::BentArm& arm : give.arms) {
        list_.push_back({give.flexible, MakeArmForm(arm), 0, 1, {source}, {}});
      }
    }
  }

  void AddSqueezed(const PressedPair& pair) {
    const OccurrenceId id = pair.parts.front();
    const ElasticPart* elastic = FindElastic(product_, id);
    const sequence::SequenceStep* step = sequence::FindInsertion(sequence_, pair.moved);
    const double most = std::max(std::abs(pair.growth[0]), std::abs(pair.growth[1]));
    if (elastic == nullptr || step == nullptr || !(most > 0)) {
      return;
    }
    if (elastic->kind == ElasticKind::kLipSeal) {
      if (elastic->lip_radius > 0) {
        const double free = 0.5 * (elastic->free_size - elastic->inner);
        AddRing({id, MakeLipForm(*elastic), free, 1, {}, {}}, SourceOf(pair, *step, {}));
      }
      return;
    }
    const Part& part = product_.part_of(id);
    const RingForm ring{elastic->centre_B, elastic->axis_B, 0.5 * elastic->inner,
                        0.5 * elastic->outer};
    DeformationForm form = MakeRingForm(part, ring);
    Deformable deformable{id, form, 0, 1, {}, {}};
    // Drawn at its nominal size, its free one is larger.
    const double oversize = 0.5 * (elastic->free_size - elastic->outer);
    if (elastic->kind == ElasticKind::kSlitPin) {
      deformable.sign = -1;
      deformable.free = oversize;
    } else {
      deformable.form.kind = DeformationKind::kRadial;
      if (std::abs(oversize) > kLeastDrawn && !HasFreeForm(id)) {
        deformable.form.shares = {0, 1};
        deformable.free = oversize;
        list_.push_back(deformable);
        deformable.free = 0;
      }
      deformable.form.shares = {pair.growth[0] / most, pair.growth[1] / most};
    }
    // It yields, but its hole is as narrow as it is.
    AddRing(std::move(deformable), SourceOf(pair, *step, {0, most}));
  }

  void AddPressed(const PressedPair& pair) {
    const sequence::SequenceStep* step = sequence::FindInsertion(sequence_, pair.moved);
    if (step == nullptr || pair.curve == nullptr) {
      return;
    }
    const bool moves_itself = pair.support == pair.moved || Has(step->members, pair.support);
    const Vec3 to_presser_W = (moves_itself ? -1.0 : 1.0) * step->extraction_W;
    std::vector<std::size_t> below;
    // From what stands on the support to what the presser meets.
    for (std::size_t k = pair.parts.size(); k-- > 0;) {
      const OccurrenceId id = pair.parts[k];
      const ElasticPart& elastic = *FindElastic(product_, id);
      const spatial::Pose& X_WB = product_.occurrences[id.index()].X_WB;
      const double sign = (X_WB.q() * elastic.axis_B).dot(to_presser_W) > 0 ? 1 : -1;
      DeformationForm form = MakePressForm(product_.part_of(id), elastic, sign * elastic.axis_B);
      const std::vector<std::size_t> carried = below;
      below.push_back(AddPress({id,
                                form,
                                std::max(0.0, elastic.free_size - elastic.length),
                                -1,
                                {SourceOf(pair, *step, MakeOwnTable(pair, k))},
                                {}}));
      if (!carried.empty()) {
        form.kind = DeformationKind::kShift;
        DeformationSource place;
        place.moved = id;
        place.against = pair.support;
        place.out_W = to_presser_W;
        list_.push_back({id, form, 0, 1, {place}, carried});
      }
    }
  }

  [[nodiscard]] std::vector<Deformable> Finish() { return std::move(list_); }

 private:
  static bool Has(const std::vector<OccurrenceId>& ids, OccurrenceId id) {
    return std::find(ids.begin(), ids.end(), id) != ids.end();
  }

  /** @param own  DeformationSource::own. */
  static DeformationSource SourceOf(const PressedPair& pair, const sequence::SequenceStep& step,
                                    std::vector<double> own) {
    return {pair.moved,       pair.against, step.extraction_W,
            pair.compression, pair.curve,   std::move(own)};
  }

  /** Whether a sleeve's free form is in the list. */
  [[nodiscard]] bool HasFreeForm(OccurrenceId id) const {
    return std::any_of(list_.begin(), list_.end(), [id](const Deformable& known) {
      return known.occurrence == id && known.free != 0;
    });
  }

  /** Adds a ring, or another source to the same ring: of two the larger amount counts. */
  void AddRing(Deformable ring, const DeformationSource& source) {
    for (Deformable& known : list_) {
      if (known.occurrence == ring.occurrence && known.form.kind == ring.form.kind &&
          known.form.shares == ring.form.shares) {
        known.sources.push_back(source);
        return;
      }
    }
    ring.sources.push_back(source);
    list_.push_back(std::move(ring));
  }

  /** Adds a part that is pressed, or another source to it. @returns its index. */
  std::size_t AddPress(Deformable part) {
    for (std::size_t i = 0; i < list_.size(); ++i) {
      if (list_[i].occurrence == part.occurrence && list_[i].form.kind == part.form.kind) {
        list_[i].sources.push_back(part.sources.front());
        return i;
      }
    }
    list_.push_back(std::move(part));
    return list_.size() - 1;
  }

  /** How far one part of a stack is pressed at each step of the table of all: each has the force of
   all, so its own compression follows by halving. */
  [[nodiscard]] std::vector<double> MakeOwnTable(const PressedPair& pair, std::size_t k) const {
    const auto law = mates::MakePressedPart(*FindElastic(product_, pair.parts[k]));
    if (pair.parts.size() < 2 || !law) {
      return {};
    }
    std::vector<double> own;
    for (const double force : pair.curve->pressed) {
      double low = 0;
      double high = pair.compression;
      for (int i = 0; i < kShareHalvings; ++i) {
        const double middle = 0.5 * (low + high);
        (fits::CalcPressForce(*law, middle) < force ? low : high) = middle;
      }
      own.push_back(force > 0 ? 0.5 * (low + high) : 0);
    }
    return own;
  }

  const Product& product_;
  const sequence::Sequence& sequence_;
  std::vector<Deformable> list_;
};

}  // namespace

std::vector<Deformable> ListDeformables(const Product& product, const sequence::Sequence& sequence,
                                        const std::vector<PressedPair>& presses) {
  Lister lister(product, sequence);
  for (const sequence::GivingPair& give : sequence.gives) {
    lister.AddGive(give);
  }
  for (const PressedPair& pair : presses) {
    if (pair.is_radial) {
      lister.AddSqueezed(pair);
    } else {
      lister.AddPressed(pair);
    }
  }
  return lister.Finish();
}

}  // namespace hvas::simulation
