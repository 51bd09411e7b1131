#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "studio/access.h"
#include "studio/workbench.h"
#include "study/study_folder.h"

namespace hvas::studio {

/** Runs the session of one participant of a study: connects the study's state machine and journal
 with the workbench that trials run on and with the clients of the participant and the experimenter
 (docs/protocol.md). For the hub's thread. */
class StudyDesk {
 public:
  struct Options {
    std::string participant;        ///< "P01"
    std::filesystem::path product;  ///< File of the product that the protocol names.
    bool has_person{false};  ///< The simulated person does the trials, to demonstrate a study.
    bool keeps_records{true};
    std::function<std::int64_t()> unix_ms;  ///< Wall clock for the journal: Unix time [ms].
  };

  /** Resumes the participant's journal, or begins it. Errors: those of the journal, and of events
   in it that contradict the protocol; kInvalid when the folder has simulated participants. */
  [[nodiscard]] static Result<std::unique_ptr<StudyDesk>> Open(study::StudyFolder folder,
                                                               Workbench* bench, Options options);

  /** Sets the link that the experimenter passes on: path and fragment. @pre no client has
   joined. */
  void SetParticipantLink(std::string link) { participant_link_ = std::move(link); }

  /** Opens the product on the workbench; the session can begin once it is open. */
  void Start();

  /** Executes the command "study". @param now_ns  By LiveScene::clock(), here and
   in what follows. @returns the reply. */
  [[nodiscard]] Result<Json> Do(Role role, const Json& command, std::int64_t now_ns);

  /** Handles an event of the workbench. @returns whether the state has changed. */
  bool OnBenchEvent(const Json& event, std::int64_t now_ns);

  /** Checks time limits; to be called periodically. @returns whether the state has changed. */
  bool Poll(std::int64_t now_ns);

  /** Makes the state of the session with what a role may see. */
  [[nodiscard]] Json MakeState(Role role, std::int64_t now_ns) const;

  /** Makes the event "study", which has this state. */
  [[nodiscard]] Json MakeEvent(Role role, std::int64_t now_ns) const;

  /** Checks whether a part may be taken now. Errors: kInvalid while no trial runs, and in trials in
   which constraints are picked. */
  [[nodiscard]] Result<void> CheckTake() const;

 private:
  using Kind = study::StudyEvent::Kind;

  StudyDesk(study::StudyFolder folder, Workbench* bench, Options options, study::Journal journal,
            int number);

  [[nodiscard]] Result<void> RecordEvent(study::StudyEvent event);
  [[nodiscard]] Result<void> Execute(Role role, const std::string& action, const Json& command,
                                     std::int64_t now_ns);
  [[nodiscard]] Result<void> Consent(const Json& command);
  [[nodiscard]] Result<void> BeginTrial(std::int64_t now_ns);
  [[nodiscard]] Result<void> Continue();
  [[nodiscard]] Result<void> AnswerQuestion(const Json& command);
  [[nodiscard]] Result<void> AddNote(const Json& command);
  [[nodiscard]] Result<Json> Pick(Role role, const Json& command, std::int64_t now_ns);
  [[nodiscard]] Result<void> Abort(const std::string& reason);
  void BeginOnBench();
  /** Ends the run on the workbench; the trial is over with the event "trial_over". */
  void EndOnBench(study::Outcome outcome);
  [[nodiscard]] Result<void> FinishTrial();
  [[nodiscard]] const study::Condition* FindCurrentCondition() const;
  [[nodiscard]] bool IsPicking() const;
  void AddTrialAtHand(std::int64_t now_ns, bool sees_all, Json* state) const;
  void AddForExperimenter(Json* state) const;
  [[nodiscard]] Json MakeQuestion() const;
  [[nodiscard]] Json MakeDone() const;

  study::StudyFolder folder_;
  Workbench* bench_;
  Options options_;
  study::Journal journal_;
  study::StudySession session_;
  std::string id_;
  std::string participant_link_;
  bool is_resumed_{false};
  bool is_open_{false};  ///< The product is open.
  std::string hold_;     ///< State of the held part; empty: none.
  std::string last_abort_;
  std::shared_ptr<LiveTrial> trial_;      ///< Trial on the workbench; null: none.
  std::optional<study::Outcome> ending_;  ///< Outcome of the trial; none while it runs.
  std::int64_t training_since_ns_{0};
  std::size_t training_runs_{0};          ///< Runs of the training in this start of the program.
  std::vector<product::MateId> missing_;  ///< Constraints that have not been picked yet.
  std::optional<product::OccurrenceId> part_;
};

}  // namespace hvas::studio
