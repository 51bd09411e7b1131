#include "study/simulated_participant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "assembly/assembly_setup.h"
#include "mates/assignments.h"
#include "session/session_recorder.h"
#include "simulation/executors.h"
#include "study/schedule.h"
#include "study/trial_pair.h"
#include "study/trial_watch.h"

namespace hvas::study {
namespace {

// No other stream of random numbers has this number.
constexpr std::uint64_t kSkillStream = 101;
constexpr double kMedianSpeed = 0.85;
constexpr int kObserverTraining = 60;  // training insertions for each fit

/** Draws from a lognormal distribution. @param sigma  Standard deviation of the logarithm. */
double Vary(double median, double sigma, Random* random) {
  return median * std::exp(sigma * random->Normal());
}

Result<std::unique_ptr<record::Recorder>> MakeTrialRecorder(const simulation::Model& model,
                                                            const Condition& condition,
                                                            const std::filesystem::path& record) {
  record::RecorderOptions options;
  options.path = record;
  options.replaces = true;  // replaces the record of an aborted trial
  return assembly::MakeRecorder(
      model, options,
      {{"condition", condition.id}, {"simulated", "a simulated participant of a study"}});
}

/** Has a simulated person put the part in, in virtual time. @param sink  Null: nothing is recorded.
 */
TrialResult AssembleInTrial(const TrialSetup& setup, assembly::Hand hand, double limit_s,
                            double reaction_s, session::SessionRecorder* sink) {
  const sequence::SequenceStep& step = setup.model->sequence.steps[setup.step];
  TrialWatch watch(step.occurrence, step.extraction_W, setup.mating_window, hand.tick.dt, sink);
  assembly::AssemblySetup trial(setup.model, std::move(hand), &watch);
  if (sink != nullptr) {
    sink->Begin(&trial.simulation());
  }
  trial.run().Only(setup.step, 1);
  simulation::Execution execution = trial.MakeExecution(std::max(0.0, limit_s));
  const auto begin_ns = std::llround(1e9 * reaction_s);
  std::int64_t now_ns = 0;
  execution.advance = [&] {
    now_ns += simulation::Simulation::kPhysicsStepNs;
    if (now_ns >= begin_ns) {
      trial.run().Advance();
    }
  };
  // The trial ends with seating; motion of the hand after it does not count.
  execution.is_done = [&] { return trial.run().is_done() || watch.is_seated(); };
  const simulation::ExecutionReport report = simulation::RunLockstep(execution);
  TrialResult result = watch.MakeResult();
  result.pair = DescribePair(*setup.model, setup.step);
  if (!watch.is_seated() && !trial.run().is_done()) {
    result.outcome = Outcome::kTimedOut;
    result.time = 1e-9 * static_cast<double>(report.session_ns);
  }
  return result;
}

}  // namespace

Skill DrawSkill(int participant, std::uint64_t seed) {
  Random random(MixSeed(seed, kSkillStream, static_cast<std::uint64_t>(participant)));
  Skill skill;
  skill.reaction_s = Vary(skill.reaction_s, 0.2, &random);
  skill.speed = std::min(1.0, Vary(kMedianSpeed, 0.15, &random));
  skill.mouse = Vary(1, 0.2, &random);
  skill.aim = Vary(1, 0.3, &random);
  skill.tremor = Vary(1, 0.3, &random);
  skill.weber = std::min(0.3, Vary(skill.weber, 0.3, &random));
  skill.threshold = Vary(skill.threshold, 0.3, &random);
  return skill;
}

person::PersonOptions MakePerson(const Skill& skill, Random* random) {
  person::PersonOptions person;
  const double speed = std::min(1.0, skill.speed * Vary(1, 0.1, random));
  person.carry_speed *= speed;
  person.approach_speed *= speed;
  person.insert_speed *= speed;
  person.aim_error *= skill.aim;
  person.aim_error_angle *= skill.aim;
  person.eye_error *= skill.aim;
  person.eye_error_angle *= skill.aim;
  person.tremor *= skill.tremor;
  return person;
}

double DrawPickingTime(int constraints, const Skill& skill, Random* random) {
  // Operators of the keystroke-level model [s] (Card, Moran and Newell, Communications of the ACM
  // 23(7), 1980): think, point, press, hand to the mouse. kSigma, their spread, is a choice.
  constexpr double kMental = 1.35;
  constexpr double kPoint = 1.1;
  constexpr double kClick = 0.2;
  constexpr double kHome = 0.4;
  constexpr double kSigma = 0.2;
  double time = Vary(kHome, kSigma, random);
  for (int i = 0; i < std::max(1, constraints); ++i) {
    // The operators are for the first surface, the second surface and the kind of constraint.
    for (const double operation :
         {kMental, kPoint, kClick, kPoint, kClick, kMental, kPoint, kClick}) {
      time += Vary(operation, kSigma, random);
    }
  }
  return skill.reaction_s + time * skill.mouse;
}

void ApplyCondition(const Condition& condition, haptics::TickOptions* tick) {
  tick->condition = condition.method == Method::kCollision    ? haptics::Condition::kCollision
                    : condition.method == Method::kConstraint ? haptics::Condition::kConstraint
                                                              : haptics::Condition::kHybrid;
  tick->renders_fits = condition.renders_fits;
  tick->force_map = condition.force_map;
  tick->paper_factors = condition.paper_factors;
  tick->guidance.capture = condition.capture;
  tick->coupling.k_lin = condition.coupling;
  haptics::Apply(condition.guidance, tick);
}

haptics::TickOptions MakeTickOptions(const Condition& condition) {
  haptics::TickOptions tick = assembly::MakePersonTick({});
  ApplyCondition(condition, &tick);
  return tick;
}

Result<std::size_t> FindPartStep(const simulation::Model& model, const std::string& part) {
  const auto id = mates::FindOccurrence(*model.product, part);
  if (!id) {
    return Unexpected(id.error());
  }
  const auto& steps = model.sequence.steps;
  const auto found = std::find_if(steps.begin(), steps.end(), [&](const auto& step) {
    return step.occurrence == *id && step.kind == sequence::SequenceStep::Kind::kInsert &&
           step.members.empty();
  });
  if (found == steps.end()) {
    return Fail(ErrorCode::kNotFound, "the assembly has no step that inserts this part by itself",
                part, "name another part of the product");
  }
  if (sequence::FindAside(model.sequence, *id) != nullptr) {
    return Fail(ErrorCode::kInvalid, "another part has to be moved aside to let this one pass",
                part, "name another part of the product");
  }
  return static_cast<std::size_t>(found - steps.begin());
}

std::vector<product::MateId> ListConstraints(const simulation::Model& model, std::size_t step) {
  const auto& steps = model.sequence.steps;
  std::vector<product::MateId> constraints;
  for (const product::MateId id : model.mates_of[steps[step].occurrence.index()]) {
    const product::Mate& mate = model.product->mates[id.index()];
    const product::OccurrenceId other =
        mate.a.occurrence == steps[step].occurrence ? mate.b.occurrence : mate.a.occurrence;
    const auto end = steps.begin() + static_cast<std::ptrdiff_t>(step);
    if (std::any_of(steps.begin(), end, [&](const auto& s) { return s.occurrence == other; })) {
      constraints.push_back(id);
    }
  }
  return constraints;
}

std::vector<product::MateId> ListPickedConstraints(const Condition& condition,
                                                   const simulation::Model& model,
                                                   std::size_t step) {
  const bool is_axis_alone = condition.constraints == Constraints::kPicked;
  if (condition.method != Method::kPicking && !is_axis_alone) {
    return {};
  }
  std::vector<product::MateId> picked = ListConstraints(model, step);
  if (is_axis_alone) {
    std::erase_if(picked, [&model](product::MateId id) {
      return model.product->mates[id.index()].kind != product::MateKind::kAxisHole;
    });
  }
  return picked;
}

Result<TrialResult> RunSimulatedTrial(const TrialSetup& setup, const Condition& condition,
                                      const Skill& skill, std::uint64_t seed,
                                      const std::filesystem::path& record) {
  const simulation::Model& model = *setup.model;
  Random random(seed);
  const auto picked = static_cast<int>(ListPickedConstraints(condition, model, setup.step).size());
  if (condition.method == Method::kPicking) {
    TrialResult result;
    result.time = DrawPickingTime(picked, skill, &random);
    result.outcome = *result.time < condition.time_limit ? Outcome::kDone : Outcome::kTimedOut;
    result.time = std::min(*result.time, condition.time_limit);
    return result;
  }
  const std::uint64_t person_seed = random.NextBits();  // Drawn before the habits, always.
  const person::PersonOptions habits = MakePerson(skill, &random);
  // The axis is picked before the part is taken.
  const double picking_time = picked > 0 ? DrawPickingTime(picked, skill, &random) : 0;
  assembly::Hand hand =
      assembly::MakePersonHand(model, MakeTickOptions(condition), habits, person_seed);
  std::unique_ptr<record::Recorder> recorder;
  std::optional<session::SessionRecorder> sink;
  if (!record.empty()) {
    auto created = MakeTrialRecorder(model, condition, record);
    if (!created) {
      return Unexpected(created.error());
    }
    recorder = std::move(*created);
    sink.emplace(recorder.get(), model);
  }
  auto result = AssembleInTrial(setup, std::move(hand), condition.time_limit - picking_time,
                                skill.reaction_s, sink ? &*sink : nullptr);
  if (recorder != nullptr) {
    if (const auto finished = recorder->Finish(); !finished) {
      return Unexpected(finished.error());
    }
  }
  if (result.time) {
    *result.time += picking_time;
  }
  return result;
}

Result<FitObserver> MakeObserver(const Skill& skill, const Condition& condition,
                                 const std::vector<PairSource>& alternatives, std::uint64_t seed) {
  ObserverOptions options;
  options.seed = seed;
  options.training = kObserverTraining;
  options.map = condition.force_map;
  options.paper_factors = condition.paper_factors;
  options.observer.weber = skill.weber;
  options.observer.threshold = skill.threshold;
  options.coupling_stiffness = condition.coupling;
  options.aim_error *= skill.aim;
  return FitObserver::Train(options, alternatives);
}

}  // namespace hvas::study
