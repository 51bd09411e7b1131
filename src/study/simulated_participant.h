#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "record/recorder.h"
#include "simulation/identification.h"
#include "simulation/model.h"
#include "simulation/simulated_person.h"
#include "study/protocol.h"
#include "study/trial_result.h"

/** Participants who are no people: what a study's program, its report and its statistics are tried
 with before people come. They stand for nobody, and what they give is marked as simulated. */
namespace hvas::study {

/** How one simulated participant differs from another. Factors are lognormal about 1. Where the
 numbers come from: docs/algorithms/simulated_person.md. */
struct Skill {
  double reaction_s{0.4};  ///< Before a trial's first motion [s].
  /** Factor of all speeds of the arm. No more than 1: faster, the part would lag behind the hand by
   more than the coupling bears, and the arm learns that lag as if it were weight. */
  double speed{1};
  double mouse{1};        ///< Factor of all times with the mouse.
  double aim{1};          ///< Factor of where the hand and the eye err.
  double tremor{1};       ///< Factor.
  double weber{0.10};     ///< Just noticeable difference of a force, as a part of it.
  double threshold{0.1};  ///< Least force that is perceived [N].
};

/** The skill of a participant. The same number and seed give the same. */
[[nodiscard]] Skill DrawSkill(int participant, std::uint64_t seed);

/** Who does one trial: with that skill, and as one does it each time a little otherwise. */
[[nodiscard]] simulation::PersonOptions MakePerson(const Skill& skill, Random* random);

/** How long somebody takes to set constraints with the mouse, by the keystroke-level model: Card,
 Moran and Newell, CACM 23(7), 1980. To the mouse H; for each constraint twice (M, P, K) and (P, K):
 the first surface, the second, and the kind of constraint. M 1.35 s, P 1.1 s, K 0.2 s, H 0.4 s,
 each time lognormal with a deviation of a fifth [s].
 @param constraints  As many as the part has mates; at least 1. */
[[nodiscard]] double DrawPickingTime(int constraints, const Skill& skill, Random* random);

/** What a trial is of. */
struct TrialSetup {
  std::shared_ptr<const simulation::Model> model;  ///< With the condition's fit.
  std::size_t step{0};                             ///< Of its sequence: the part's.
  double mating_window{3};                         ///< [s]
};

/** Sets what is on in a condition: contact, mates, fits, and how they are felt. */
void ApplyCondition(const Condition& condition, haptics::TickOptions* tick);

/** The options of the tick in a condition, without a device. */
[[nodiscard]] haptics::TickOptions MakeTickOptions(const Condition& condition);

/** Has a simulated person do a trial in virtual time: the parts before the one at hand are in their
 place. Repeats bit for bit.
 @param record  The file that the session goes to; empty: none. Errors: the recorder's. */
[[nodiscard]] Result<TrialResult> RunSimulatedTrial(const TrialSetup& setup,
                                                    const Condition& condition, const Skill& skill,
                                                    std::uint64_t seed,
                                                    const std::filesystem::path& record);

/** The step of a model in which a part is put in its place. Errors: kNotFound for no such part, and
 for one that comes to no place by itself. @param part  Name, path, or end of the path. */
[[nodiscard]] Result<std::size_t> FindPartStep(const simulation::Model& model,
                                               const std::string& part);

/** Mates of a step's part with parts that come before it. */
[[nodiscard]] std::vector<product::MateId> ListConstraints(const simulation::Model& model,
                                                           std::size_t step);

/** The observer that this participant is in blind identification. */
[[nodiscard]] Result<simulation::FitObserver> MakeObserver(const Skill& skill,
                                                           const Condition& condition,
                                                           std::uint64_t seed);

/** The place of a fit among those that the observer knows. Errors: kUnsupported for another. */
[[nodiscard]] Result<int> FindShownFit(const std::string& fit);

}  // namespace hvas::study
