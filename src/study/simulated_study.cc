#include "study/simulated_study.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "study/simulated_participant.h"
#include "study/trial_pair.h"

namespace hvas::study {
namespace {

using Kind = StudyEvent::Kind;

constexpr std::uint64_t kTrialStream = 1000;    // plus the index of the trial
constexpr std::uint64_t kObserverStream = 102;  // No other stream has this number.

/** Models of a study's trials; conditions with equal fits share one. */
class Setups {
 public:
  /** @param seed  Draws a pair of each condition: one whose kind of fit no pair shows is refused
   before anybody begins. */
  static Result<Setups> Make(const Protocol& protocol, const ModelSource& models,
                             std::uint64_t seed) {
    Setups setups;
    for (const Block& block : protocol.blocks) {
      for (const std::size_t condition : block.conditions) {
        const auto added = setups.Add(protocol, condition, block.is_identification, models, seed);
        if (!added) {
          return Unexpected(added.error());
        }
      }
    }
    return setups;
  }

  [[nodiscard]] const TrialSetup& Of(std::size_t condition, bool is_identification) const {
    return setups_.at({condition, is_identification});
  }

 private:
  Result<void> Add(const Protocol& protocol, std::size_t index, bool is_identification,
                   const ModelSource& models, std::uint64_t seed) {
    const Condition& condition = protocol.conditions[index];
    const std::string& part = protocol.PartOf(condition, is_identification);
    auto& model = models_[MakeFitKey(condition, part)];
    if (model == nullptr) {
      auto made = models(condition, part);
      if (!made) {
        return Unexpected(made.error());
      }
      model = std::move(*made);
    }
    const auto step = FindPartStep(*model, part);
    if (!step) {
      return Unexpected(step.error());
    }
    if (const auto pair = DrawPair(*model, *step, condition, seed); !pair) {
      return Unexpected(pair.error());
    }
    if (is_identification && !FindFittedMate(*model, *step)) {
      return Fail(ErrorCode::kInvalid, "no mate of the part has a fit that can be identified",
                  "condition " + condition.id, "write a \"fit\" for the condition");
    }
    setups_[{index, is_identification}] = {model, *step, protocol.mating_window};
    return {};
  }

  std::map<std::string, std::shared_ptr<const simulation::Model>> models_;
  std::map<std::pair<std::size_t, bool>, TrialSetup> setups_;  ///< By condition and kind of block.
};

/** Runs the session of one participant. */
class Walk {
 public:
  Walk(const StudyFolder& folder, const Setups& setups, KeptRecords records, int participant,
       Journal* journal, std::atomic<std::size_t>* trials_done)
      : folder_(folder),
        setups_(setups),
        records_(records),
        journal_(journal),
        trials_done_(trials_done),
        session_(&folder.protocol(), participant, folder.seed()),
        skill_(DrawSkill(participant, folder.seed())) {}

  Result<void> Run() {
    if (auto applied = ApplyAll(journal_->events(), &session_); !applied) {
      return applied;
    }
    *trials_done_ += session_.done().size();
    for (Phase phase = session_.phase(); phase != Phase::kDone && phase != Phase::kDeclined;
         phase = session_.phase()) {
      if (auto done = Step(phase); !done) {
        return done;
      }
    }
    return {};
  }

 private:
  Result<void> Step(Phase phase) {
    StudyEvent event;
    event.trial = session_.trial().value_or(0);
    switch (phase) {
      case Phase::kWaiting:
        event.kind = Kind::kBegun;
        break;
      case Phase::kConsent:
        event.kind = Kind::kConsent;
        event.agrees = true;
        event.language = folder_.protocol().languages.front();
        break;
      case Phase::kTraining:
        event.kind = session_.is_running() ? Kind::kTrainingEnded : Kind::kTrainingBegun;
        break;
      case Phase::kReady:
        event.kind = Kind::kTrialBegun;
        break;
      case Phase::kRunning: {
        auto result = RunTrial(event.trial);
        if (!result) {
          return Unexpected(result.error());
        }
        event.kind = Kind::kTrialEnded;
        event.result = std::move(*result);
        ++*trials_done_;
        break;
      }
      case Phase::kQuestion:
        event.kind = Kind::kAnswered;
        event.question = session_.question()->id;
        event.trial = session_.question()->trial;
        if (session_.question()->question == nullptr) {
          auto answer = Identify(event.trial);
          if (!answer) {
            return Unexpected(answer.error());
          }
          event.value = std::move(*answer);
        }
        break;
      case Phase::kPaused:
        event.kind = Kind::kResumed;
        break;
      case Phase::kDeclined:
      case Phase::kDone:
        return {};
    }
    return Tell(event);
  }

  Result<void> Tell(const StudyEvent& event) {
    if (auto applied = session_.Apply(event); !applied) {
      return applied;
    }
    return journal_->Append(event);
  }

  Result<TrialResult> RunTrial(std::size_t trial) {
    const PlannedTrial& planned = session_.schedule()[trial];
    const Block& block = session_.BlockOf(trial);
    const auto setup = DrawSetup(trial);
    if (!setup) {
      return Unexpected(setup.error());
    }
    if (block.is_identification) {
      TrialResult result;  // the observer gets the force of an insertion; nothing moves
      result.outcome = Outcome::kDone;
      result.pair = DescribePair(*setup->model, setup->step);
      return result;
    }
    const bool is_kept = records_ == KeptRecords::kAll || (records_ == KeptRecords::kLast &&
                                                           planned.repetition == block.repetitions);
    const bool has_session = session_.ConditionOf(trial).method != Method::kPicking;
    const std::filesystem::path record =
        is_kept && has_session
            ? folder_.RecordFile(FormatParticipantId(session_.participant()), trial)
            : std::filesystem::path();
    std::error_code ignored;
    std::filesystem::remove(record, ignored);  // record of an interrupted trial
    return RunSimulatedTrial(*setup, session_.ConditionOf(trial), skill_,
                             SeedOf(kTrialStream + trial), record);
  }

  /** The observer repeats exactly: one that goes on is shown again what came before. */
  Result<std::string> Identify(std::size_t trial) {
    const Block& block = session_.BlockOf(trial);
    if (observed_block_ != &block) {
      if (auto made = TrainObserver(trial); !made) {
        return Unexpected(made.error());
      }
      for (std::size_t before = 0; before < trial; ++before) {
        if (&session_.BlockOf(before) == &block) {
          static_cast<void>(Answer(before));
        }
      }
    }
    return Answer(trial);
  }

  Result<void> TrainObserver(std::size_t trial) {
    const Block& block = session_.BlockOf(trial);
    std::vector<PairSource> alternatives;
    for (const std::size_t condition : block.conditions) {
      const TrialSetup& setup = setups_.Of(condition, true);
      alternatives.push_back(
          MakePairSource(setup.model, setup.step, folder_.protocol().conditions[condition]));
    }
    auto observer = MakeObserver(skill_, session_.ConditionOf(trial), alternatives,
                                 SeedOf(kObserverStream + session_.schedule()[trial].block));
    if (!observer) {
      return Unexpected(observer.error());
    }
    observer_.emplace(std::move(*observer));
    observed_block_ = &block;
    return {};
  }

  Result<std::string> Answer(std::size_t trial) {
    const auto setup = DrawSetup(trial);
    if (!setup) {
      return Unexpected(setup.error());
    }
    const std::size_t answer = observer_->Answer(FindShownPair(*setup->model, setup->step));
    return AnswerNameOf(folder_.protocol().conditions[session_.BlockOf(trial).conditions[answer]]);
  }

  /** Draws the pair of a trial. */
  [[nodiscard]] Result<TrialSetup> DrawSetup(std::size_t trial) const {
    TrialSetup setup =
        setups_.Of(session_.schedule()[trial].condition, session_.BlockOf(trial).is_identification);
    auto drawn = DrawPair(*setup.model, setup.step, session_.ConditionOf(trial),
                          CalcPairSeed(folder_.seed(), session_.participant(), trial));
    if (!drawn) {
      return Unexpected(drawn.error());
    }
    setup.model = std::move(*drawn);
    return setup;
  }

  [[nodiscard]] std::uint64_t SeedOf(std::uint64_t stream) const {
    return MixSeed(folder_.seed(), stream, static_cast<std::uint64_t>(session_.participant()));
  }

  const StudyFolder& folder_;
  const Setups& setups_;
  KeptRecords records_;
  Journal* journal_;
  std::atomic<std::size_t>* trials_done_;
  StudySession session_;
  Skill skill_;
  const Block* observed_block_{nullptr};
  std::optional<FitObserver> observer_;
};

}  // namespace

Result<void> RunSimulatedStudy(const StudyFolder& folder, const ModelSource& models,
                               const SimulatedStudyOptions& options) {
  const auto setups = Setups::Make(folder.protocol(), models, folder.seed());
  if (!setups) {
    return Unexpected(setups.error());
  }
  const auto count = static_cast<std::size_t>(options.participants);
  const std::size_t total = count * static_cast<std::size_t>(folder.protocol().CountTrials());
  std::atomic<std::size_t> trials_done{0};
  std::vector<std::optional<Error>> errors(count);
  ForEachIndex(
      count, options.threads,
      [&](std::size_t i) {
        const int participant = static_cast<int>(i) + 1;
        auto journal = folder.OpenJournal(FormatParticipantId(participant), true);
        const Result<void> done =
            journal
                ? Walk(folder, *setups, options.records, participant, &*journal, &trials_done).Run()
                : Result<void>(Unexpected(journal.error()));
        if (!done) {
          errors[i] = done.error();
        }
      },
      [&](std::size_t) {
        if (options.progress) {
          options.progress(trials_done.load(), total);
        }
      });
  const auto first = std::find_if(errors.begin(), errors.end(),
                                  [](const auto& error) { return error.has_value(); });
  return first == errors.end() ? Result<void>() : Result<void>(Unexpected(**first));
}

}  // namespace hvas::study
