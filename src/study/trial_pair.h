#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "product/product.h"
#include "simulation/model.h"
#include "study/identification.h"
#include "study/protocol.h"
#include "study/trial_result.h"

/** Pairs of parts that the trials of a study are done with. Sizes and surface B(l) are drawn anew
 for every trial, by the same code for a person at a device, a simulated person, and the simulated
 observer of blind identification (W1, W8, W12). */
namespace hvas::study {

/** Sets the fit and the sizes of a condition on the axis-hole mates of a part.
 Errors: those of mates::AssignFit; kInvalid where a measured diameter, of the condition or of the
 product's side file, lies outside the condition's fit, and where the side file states another
 diameter, roughness or friction than the condition. */
[[nodiscard]] Result<void> ApplyFit(const Condition& condition, const std::string& part,
                                    product::Product* product);

/** Makes a text that is equal for conditions whose ApplyFit does the same. */
[[nodiscard]] std::string MakeFitKey(const Condition& condition, const std::string& part);

/** Calculates the seed of the pair of a trial. @param trial  Index in the participant's schedule.
 */
[[nodiscard]] std::uint64_t CalcPairSeed(std::uint64_t study_seed, int participant,
                                         std::size_t trial);

/** Draws the pair of a trial. @param model  Of a product with the condition's fit.
 Errors: kUnsupported where no pair shows the kind of the fit (fits::ShowsKind). */
[[nodiscard]] Result<std::shared_ptr<const simulation::Model>> DrawPair(
    const simulation::Model& model, std::size_t step, const Condition& condition,
    std::uint64_t seed);

/** Finds the fit of a step's part that is felt most: that of the longest engagement. Nothing where
 no mate of it has a fit. */
[[nodiscard]] std::optional<product::MateId> FindFittedMate(const simulation::Model& model,
                                                            std::size_t step);

/** The pair of a step's part, for the observer. @pre FindFittedMate finds a mate. */
[[nodiscard]] ShownPair FindShownPair(const simulation::Model& model, std::size_t step);

/** Draws pairs as DrawPair does, for the observer's training. @pre FindFittedMate finds a mate. */
[[nodiscard]] PairSource MakePairSource(std::shared_ptr<const simulation::Model> model,
                                        std::size_t step, const Condition& condition);

/** The pair of a step's part, for the results. Nothing where no mate of it has a fit. */
[[nodiscard]] std::optional<TrialPair> DescribePair(const simulation::Model& model,
                                                    std::size_t step);

}  // namespace hvas::study
