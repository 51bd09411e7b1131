#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "base/result.h"
#include "person/simulated_person.h"
#include "record/recorder.h"
#include "simulation/model.h"
#include "study/identification.h"
#include "study/protocol.h"
#include "study/trial_result.h"

/** Participants who are no people: what a study's program, its report and its statistics are tried
 with before people come. They stand for nobody, and what they give is marked as simulated. */
namespace hvas::study {

/** Individual differences of a simulated participant. Factors are lognormal with median 1. */
struct Skill {
  double reaction_s{0.4};  ///< Time before a trial's first motion [s].
  /** Factor of all speeds of the arm, at most 1: a faster arm would make the part lag so far behind
   the hand that the coupling saturates, and the arm would learn that lag as if it were weight. */
  double speed{1};
  double mouse{1};        ///< Factor of all times of mouse operations.
  double aim{1};          ///< Factor of the errors of hand and eye.
  double tremor{1};       ///< Factor of the tremor's amplitude.
  double weber{0.10};     ///< Weber fraction of force.
  double threshold{0.1};  ///< Absolute threshold of force [N].
};

/** Draws the skill of a participant. Equal numbers and seeds give equal skills. */
[[nodiscard]] Skill DrawSkill(int participant, std::uint64_t seed);

/** Makes the simulated person for one trial: the skill, with variation from trial to trial. */
[[nodiscard]] person::PersonOptions MakePerson(const Skill& skill, Random* random);

/** Draws the time for setting constraints with the mouse by the keystroke-level model [s] (Card,
 Moran and Newell, CACM 23(7), 1980): H for the hand to the mouse; for each constraint M, P, K for
 the first surface, P, K for the second, and M, P, K for the kind of constraint. M 1.35 s, P 1.1 s,
 K 0.2 s, H 0.4 s; each is lognormal with a deviation of a fifth.
 @param constraints  Number of the part's mates, at least 1. */
[[nodiscard]] double DrawPickingTime(int constraints, const Skill& skill, Random* random);

/** Model and part of a trial. */
struct TrialSetup {
  std::shared_ptr<const simulation::Model> model;  ///< Model with the condition's fit.
  std::size_t step{0};                             ///< Index of the part's step in the sequence.
  double mating_window{3};                         ///< See Protocol [s].
};

/** Sets the options of a condition: contact, mates, fits, and how they are rendered. */
void ApplyCondition(const Condition& condition, haptics::TickOptions* tick);

/** Makes the tick options of a condition without a device. */
[[nodiscard]] haptics::TickOptions MakeTickOptions(const Condition& condition);

/** Runs a trial with a simulated person in virtual time; parts that precede the trial's part are in
 their place. Equal arguments give equal results, bit for bit.
 @param record  File for the record of the session; empty: none. Errors: those of the recorder. */
[[nodiscard]] Result<TrialResult> RunSimulatedTrial(const TrialSetup& setup,
                                                    const Condition& condition, const Skill& skill,
                                                    std::uint64_t seed,
                                                    const std::filesystem::path& record);

/** Finds the step of a model's sequence that inserts a part. @param part  Name, path, or end of the
 path. Errors: kNotFound for an unknown part, and for one without an insertion step of its own. */
[[nodiscard]] Result<std::size_t> FindPartStep(const simulation::Model& model,
                                               const std::string& part);

/** Lists the mates between a step's part and parts that precede it. */
[[nodiscard]] std::vector<product::MateId> ListConstraints(const simulation::Model& model,
                                                           std::size_t step);

/** Lists the mates that a participant has to pick in a trial: all constraints of the part where
 nothing else brings it to its place, the axes among them where picked mates guide the part, none
 where mates are recognised. */
[[nodiscard]] std::vector<product::MateId> ListPickedConstraints(const Condition& condition,
                                                                 const simulation::Model& model,
                                                                 std::size_t step);

/** Makes the observer of this participant for blind identification.
 @param condition  Gives the force map and the coupling.
 @param alternatives  The pairs of each condition that can be the answer. */
[[nodiscard]] Result<FitObserver> MakeObserver(const Skill& skill, const Condition& condition,
                                               const std::vector<PairSource>& alternatives,
                                               std::uint64_t seed);

}  // namespace hvas::study
