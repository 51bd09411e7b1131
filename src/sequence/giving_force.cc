#include "sequence/giving_force.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "fits/friction.h"
#include "sequence/fit_of_mate.h"

namespace hvas::sequence {
namespace {

using product::FlexibleKind;
using product::Part;

// Moduli of parts whose file names no material [Pa]: ABS, spring steel, and the rubber of the
// example of Green and English (1994). Usual values, and choices.
constexpr double kPlasticModulus = 2e9;
constexpr double kSpringSteelModulus = 206e9;
constexpr double kRubberModulus = 5e6;
constexpr double kStiffestRubber = 0.1e9;  // No rubber is stiffer: the name means something else.
constexpr double kSoftestMetal = 10e9;
// Faces that are drawn steeper than 60 degrees have an edge that is not: a choice.
const double kSteepest = std::tan(std::numbers::pi / 3);
// An open ring has this share of its circumference, for a gap of some 30 degrees. A choice.
constexpr double kShareOfRing = 0.9;

double PlasticModulusOf(const Part& part) {
  return part.material.is_standard_assumed ? kPlasticModulus : part.material.youngs_modulus;
}

struct RingSize {
  double outer{0};      // Diameter [m].
  double thickness{0};  // Along its axis.
};

/** A ring lies flat in its box: its least side is its thickness. */
RingSize RingSizeOf(const Part& part) {
  const Vec3 size = part.box_B.size();
  return {size.maxCoeff(), size.minCoeff()};
}

std::optional<fits::ORing> ORingOf(const Part& part) {
  const RingSize size = RingSizeOf(part);
  if (!(size.thickness > 0) || size.outer < 3 * size.thickness) {
    return std::nullopt;
  }
  const double own = part.material.youngs_modulus;
  return fits::ORing{size.outer - size.thickness, size.thickness,
                     own < kStiffestRubber ? own : kRubberModulus};
}

/** Its radial width from its volume: pi D_m w t and the gap. */
std::optional<fits::OpenRing> OpenRingOf(const Part& part) {
  const RingSize size = RingSizeOf(part);
  const double area = part.mass.volume / (kShareOfRing * std::numbers::pi * size.thickness);
  const double root = size.outer * size.outer - 4 * area;
  if (!(size.thickness > 0) || !(area > 0) || !(root > 0)) {
    return std::nullopt;
  }
  const double width = 0.5 * (size.outer - std::sqrt(root));
  const double own = part.material.youngs_modulus;
  return fits::OpenRing{0.5 * (size.outer - width), width, size.thickness,
                        own > kSoftestMetal ? own : kSpringSteelModulus};
}

}  // namespace

double FindKineticFriction(const product::Product& product, product::OccurrenceId a,
                           product::OccurrenceId b) {
  return fits::FindFriction(SurfaceOf(product.part_of(a).material),
                            SurfaceOf(product.part_of(b).material), fits::FrictionLaw{})
      .kinetic_coefficient;
}

void FinishGiven(double spacing, std::vector<double>* given) {
  const double most = kSteepest * spacing;
  for (std::size_t i = 1; i < given->size(); ++i) {
    (*given)[i] = std::max((*given)[i], (*given)[i - 1] - most);
  }
  for (std::size_t i = given->size() - 1; i > 0; --i) {
    (*given)[i - 1] = std::max((*given)[i - 1], (*given)[i] - most);
  }
  while (!given->empty() && given->back() == 0) {
    given->pop_back();
  }
}

std::shared_ptr<const haptics::GivingCurve> MakeGivingCurve(const product::Product& product,
                                                            const GivingPair& give,
                                                            const GivingSamples& samples,
                                                            const Bending* bending) {
  const Part& part = product.part_of(give.flexible);
  const double deepest =
      samples.given.empty() ? 0.0 : *std::max_element(samples.given.begin(), samples.given.end());
  if (!(deepest > 0)) {
    return nullptr;
  }
  auto curve = std::make_shared<haptics::GivingCurve>();
  switch (give.kind) {
    case FlexibleKind::kORing:
      // Put over its shaft it stretches freely; in its groove it is squeezed by what passes.
      if (const auto ring = ORingOf(part); ring && give.moved == give.flexible) {
        curve->stiffness = fits::CalcStretchStiffness(*ring);
      } else {
        curve->squeezed = ring;
      }
      break;
    case FlexibleKind::kRetainingRing:
      if (const auto ring = OpenRingOf(part)) {
        curve->stiffness = fits::CalcSpreadStiffness(*ring);
      }
      break;
    case FlexibleKind::kSnapHook:
    case FlexibleKind::kForm:
      if (bending != nullptr) {
        curve->stiffness =
            fits::CalcArmStiffness({bending->length, std::max(samples.breadth, bending->thickness),
                                    bending->thickness, PlasticModulusOf(part)});
      }
      break;
    default:
      break;
  }
  if (!curve->squeezed && !(curve->stiffness > 0)) {
    return nullptr;
  }
  curve->friction = FindKineticFriction(product, give.flexible, give.other);
  curve->spacing = samples.spacing;
  // Samples of the contact see the nearest way out of a thin wall; the width has all of it.
  const double scale = give.width > 0 ? give.width / deepest : 1.0;
  for (const double given : samples.given) {
    curve->given.push_back(scale * given);
  }
  FinishGiven(curve->spacing, &curve->given);
  return curve;
}

}  // namespace hvas::sequence
