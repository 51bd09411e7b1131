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

/** Where a participant's session of a study is run: between the study's state machine with its
 journal, the bench that trials are done on, and the two who look at it (docs/protocol.md). One
 thread's, the hub's. */
class StudyDesk {
 public:
  struct Options {
    std::string participant;        ///< "P01"
    std::filesystem::path product;  ///< That the protocol names, as a file.
    bool has_person{false};         ///< The simulated person does the trials: to show a study.
    bool keeps_records{true};
    std::function<std::int64_t()> unix_ms;  ///< The wall clock, for the journal.
  };

  /** Goes on with the participant's journal, or begins it. Errors: the journal's, or events in it
   that cannot have happened; kInvalid where simulated participants are in this folder. */
  [[nodiscard]] static Result<std::unique_ptr<StudyDesk>> Open(study::StudyFolder folder,
                                                               Workbench* bench, Options options);

  /** For the experimenter to pass on: from the page's "/" on. Before anybody has joined. */
  void SetParticipantLink(std::string link) { participant_link_ = std::move(link); }

  /** Has the product opened; the session may begin once it is. */
  void Start();

  /** The command `study`. @returns what is answered. */
  [[nodiscard]] Result<Json> Do(Role role, const Json& command, std::int64_t now_ns);

  /** Something that the bench told. @returns true when the state has changed. */
  bool OnBench(const Json& event, std::int64_t now_ns);

  /** Now and then: time-outs, the end of the training. @returns true when there is news. */
  bool Poll(std::int64_t now_ns);

  /** The event `study` as a role may see it. */
  [[nodiscard]] Json MakeState(Role role, std::int64_t now_ns) const;

  /** Errors: parts cannot be taken up now: there is no trial, or surfaces are to be picked. */
  [[nodiscard]] Result<void> CheckTake() const;

 private:
  using Kind = study::StudyEvent::Kind;

  StudyDesk(study::StudyFolder folder, Workbench* bench, Options options, study::Journal journal,
            int number);

  [[nodiscard]] Result<void> Tell(study::StudyEvent event);
  [[nodiscard]] Result<void> Act(Role role, const std::string& action, const Json& command,
                                 std::int64_t now_ns);
  [[nodiscard]] Result<void> Consent(const Json& command);
  [[nodiscard]] Result<void> Ready(std::int64_t now_ns);
  [[nodiscard]] Result<void> Next();
  [[nodiscard]] Result<void> Answer(const Json& command);
  [[nodiscard]] Result<void> Note(const Json& command);
  [[nodiscard]] Result<Json> Pick(Role role, const Json& command, std::int64_t now_ns);
  [[nodiscard]] Result<void> Abort(const std::string& reason);
  void BeginOnBench();
  /** Ends what is on the bench; the trial is over when the bench says so. */
  void EndOnBench(study::Outcome outcome);
  [[nodiscard]] Result<void> FinishTrial();
  [[nodiscard]] const study::Condition* ConditionAtHand() const;
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
  bool is_open_{false};  ///< The product is.
  std::string hold_;     ///< State of the held part; empty: none.
  std::string last_abort_;
  std::shared_ptr<LiveTrial> trial_;      ///< On the bench; null: none.
  std::optional<study::Outcome> ending_;  ///< What ended it; none while it runs.
  std::int64_t training_since_ns_{0};
  std::vector<product::MateId> missing_;  ///< Constraints that are still to be picked.
  std::optional<product::OccurrenceId> part_;
};

}  // namespace hvas::studio
