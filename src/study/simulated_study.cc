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

namespace hvas::study {
namespace {

using Kind = StudyEvent::Kind;

constexpr std::uint64_t kTrialStream = 1000;    // plus the index of the trial
constexpr std::uint64_t kObserverStream = 102;  // No other stream has this number.

/** Models, indexed by condition. */
using Setups = std::vector<TrialSetup>;

Result<Setups> MakeSetups(const Protocol& protocol, const ModelSource& models) {
  std::map<std::string, std::shared_ptr<const simulation::Model>> by_fit;
  Setups setups;
  for (const Condition& condition : protocol.conditions) {
    auto& model = by_fit[condition.fit];
    if (model == nullptr) {
      auto made = models(condition.fit);
      if (!made) {
        return Unexpected(made.error());
      }
      model = std::move(*made);
    }
    const auto step = FindPartStep(*model, protocol.part);
    if (!step) {
      return Unexpected(step.error());
    }
    setups.push_back({model, *step, protocol.mating_window});
  }
  for (const Block& block : protocol.blocks) {
    for (const std::size_t condition : block.conditions) {
      if (!block.is_identification) {
        continue;
      }
      if (const auto known = FindShownFit(protocol.conditions[condition].fit); !known) {
        return Unexpected(known.error());
      }
    }
  }
  return setups;
}

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
    if (const auto applied = ApplyAll(journal_->events(), &session_); !applied) {
      return applied;
    }
    *trials_done_ += session_.done().size();
    for (Phase phase = session_.phase(); phase != Phase::kDone && phase != Phase::kDeclined;
         phase = session_.phase()) {
      if (const auto done = Step(phase); !done) {
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
    if (const auto applied = session_.Apply(event); !applied) {
      return applied;
    }
    return journal_->Append(event);
  }

  Result<TrialResult> RunTrial(std::size_t trial) {
    const PlannedTrial& planned = session_.schedule()[trial];
    const Block& block = session_.BlockOf(trial);
    if (block.is_identification) {
      TrialResult result;  // the observer gets the force of an insertion; nothing moves
      result.outcome = Outcome::kDone;
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
    return RunSimulatedTrial(setups_[planned.condition], session_.ConditionOf(trial), skill_,
                             SeedOf(kTrialStream + trial), record);
  }

  /** The observer repeats exactly: one that goes on is shown again what came before. */
  Result<std::string> Identify(std::size_t trial) {
    const Block& block = session_.BlockOf(trial);
    if (observed_block_ != &block) {
      auto observer = MakeObserver(skill_, session_.ConditionOf(trial),
                                   SeedOf(kObserverStream + session_.schedule()[trial].block));
      if (!observer) {
        return Unexpected(observer.error());
      }
      observer_.emplace(std::move(*observer));
      observed_block_ = &block;
      for (std::size_t before = 0; before < trial; ++before) {
        if (&session_.BlockOf(before) == &block) {
          static_cast<void>(Answer(before));
        }
      }
    }
    return Answer(trial);
  }

  std::string Answer(std::size_t trial) {
    const int shown = *FindShownFit(session_.ConditionOf(trial).fit);
    const std::string fit =
        simulation::kShownFitNames[static_cast<std::size_t>(observer_->Answer(shown))];
    for (const std::size_t condition : session_.BlockOf(trial).conditions) {
      if (folder_.protocol().conditions[condition].fit == fit) {
        return AnswerNameOf(folder_.protocol().conditions[condition]);
      }
    }
    // An answer that this block does not offer counts as any other wrong one.
    return AnswerNameOf(folder_.protocol().conditions[session_.BlockOf(trial).conditions.front()]);
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
  std::optional<simulation::FitObserver> observer_;
};

}  // namespace

Result<void> RunSimulatedStudy(const StudyFolder& folder, const ModelSource& models,
                               const SimulatedStudyOptions& options) {
  const auto setups = MakeSetups(folder.protocol(), models);
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
