#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "campaign/plan.h"
#include "campaign/run_result.h"
#include "fits/size_distribution.h"
#include "product/product.h"
#include "sequence/fit_of_mate.h"

namespace hvas::campaign {

/** What varies from one product as made to the next. */
enum class FactorKind : std::uint8_t { kHole, kShaft, kSurface, kFriction, kRoughness };

/** One factor of a product: what varies in one of its fits, independent of the others. */
struct Factor {
  std::size_t mate{0};  ///< Index into FitModel::mates().
  FactorKind kind{FactorKind::kHole};
  std::string name;  ///< "m0 hole", for people.
};

/** A fit of a product before its sizes are drawn. */
struct FittedMate {
  product::MateId id;
  std::string name;  ///< "m0 H7/p6 bushing/shaft", for people.
  sequence::FitToDraw fit;
  std::optional<fits::SizeDistribution> hole, shaft;  ///< Deviations; none: as drawn or measured.
  std::size_t joint{0};         ///< Mates with one number join one pair of parts.
  std::size_t first_factor{0};  ///< Index of its first value among those of all factors.
};

/** A fit as made. */
struct MadeFit {
  double force{0};      ///< Largest force to press it in [N].
  double clearance{0};  ///< Mean diametral clearance [m].
  double pressure_share{0};
};

/** All fits of a product, and how they are made: the method `fits`. Immutable. Factors have values
 of 64 random bits, which are those of sequence::MakeFitForce for the same seed: with the spread
 kZone, a run has the sizes of `hvas assemble --sizes any --seed SEED`. */
class FitModel {
 public:
  /** Errors: kInvalid where a capability does not suit a zone, or a parameter of a fit is out of
   its range. A mate whose fit the standard does not define is a warning, and left out.
   @pre diagnostics != nullptr. */
  [[nodiscard]] static Result<FitModel> Make(const product::Product& product,
                                             const SizeVariant& sizes, Diagnostics* diagnostics);

  [[nodiscard]] const std::vector<FittedMate>& mates() const { return mates_; }

  /** All factors, in the order of their values. */
  [[nodiscard]] const std::vector<Factor>& factors() const { return factors_; }

  /** Draws the values of all factors for a seed. @pre as many values as factors. */
  void DrawFactors(std::uint64_t seed, std::span<std::uint64_t> values) const;

  /** Calculates one fit from the values of all factors. */
  [[nodiscard]] MadeFit CalcFit(std::size_t mate, std::span<const std::uint64_t> values) const;

  /** Draws sizes, roughness and friction of one fit: its parameters. */
  [[nodiscard]] fits::FitForceParameters DrawParameters(
      std::size_t mate, std::span<const std::uint64_t> values) const;

  /** Judges a product with these fits: all but run, cell, seed and time. @pre one for each mate. */
  [[nodiscard]] RunResult Judge(std::span<const MadeFit> fits, const Plan& plan) const;

 private:
  Result<void> AddMate(const product::Product& product, const product::Mate& mate,
                       Diagnostics* diagnostics);

  SizeVariant sizes_;
  std::vector<FittedMate> mates_;
  std::vector<Factor> factors_;
  std::size_t joint_count_{0};
};

/** Sets on the mates of a product the sizes, the roughness and the friction that a seed draws, for
 spreads that the preparation of a model does not know itself.
 @param sizes  Those that the model was made with. */
void SetDrawnConditions(const FitModel& model, std::uint64_t seed, const SizeVariant& sizes,
                        product::Product* product);

}  // namespace hvas::campaign
