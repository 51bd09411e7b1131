#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/result.h"
#include "study/protocol.h"
#include "study/schedule.h"
#include "study/trial_result.h"

namespace hvas::study {

enum class Phase : std::uint8_t {
  kWaiting,  ///< The session has not begun, or has not been resumed yet.
  kConsent,
  kTraining,
  kReady,  ///< The next trial can begin.
  kRunning,
  kQuestion,
  kPaused,    ///< The experimenter has interrupted the session.
  kDeclined,  ///< The participant did not consent. Final.
  kDone,
};

inline constexpr std::array<std::string_view, 9> kPhases{
    "waiting", "consent", "training", "ready", "running", "question", "paused", "declined", "done"};

[[nodiscard]] constexpr std::string_view ToString(Phase phase) {
  return kPhases[static_cast<std::size_t>(phase)];
}

/** An answer: to a scale an int, to a choice or text a string; monostate: the question was
 skipped. */
using AnswerValue = std::variant<std::monostate, int, std::string>;

/** An event of a study's session. The state of the session is a function of its events in order; it
 is resumed by applying them again. */
struct StudyEvent {
  enum class Kind : std::uint8_t {
    kBegun,  ///< Begun, or begun again after the program had ended.
    kConsent,
    kTrainingBegun,
    kTrainingEnded,
    kTrialBegun,
    kTrialEnded,
    kAnswered,
    kNote,
    kAborted,
    kResumed,
  };

  Kind kind{Kind::kNote};
  std::int64_t unix_ms{0};  ///< Wall clock: Unix time [ms]; 0 in simulated sessions.
  bool agrees{false};       ///< kConsent
  std::string language;     ///< kConsent
  std::size_t trial{0};     ///< kTrialBegun, kTrialEnded, kAnswered: index into the schedule.
  TrialResult result;       ///< kTrialEnded
  std::string question;     ///< kAnswered
  AnswerValue value;        ///< kAnswered
  std::string text;         ///< kNote, kAborted: the reason
};

inline constexpr std::array<std::string_view, 10> kEventKinds{
    "begun",       "consent",  "training_begun", "training_ended", "trial_begun",
    "trial_ended", "answered", "note",           "aborted",        "resumed"};

/** Id of the question of identification, asked after a trial: which condition it was. */
inline constexpr std::string_view kIdentifyQuestion = "identify";

/** A completed trial. */
struct DoneTrial {
  std::size_t index{0};  ///< Index into the schedule.
  TrialResult result;
  std::string answer;  ///< Answer of identification; empty: none, or none yet.
};

struct GivenAnswer {
  std::string question;
  std::optional<std::size_t> trial;  ///< Trial after which it was asked.
  AnswerValue value;
};

struct Note {
  std::string text;
  std::size_t trial{0};     ///< Index of the current trial at that time.
  std::int64_t unix_ms{0};  ///< See StudyEvent [ms].
};

/** The question that waits for an answer. */
struct OpenQuestion {
  std::string id;
  const Question* question{nullptr};  ///< Null: identification.
  std::size_t trial{0};               ///< Index of the preceding trial.
};

/** State machine of one participant's session: consent, training, trials and questions in the order
 of the schedule. It has no input, output, threads or clocks: all that happens are events, which
 have their times. */
class StudySession {
 public:
  /** @param protocol  Outlives this. */
  StudySession(const Protocol* protocol, int participant, std::uint64_t seed);

  /** Applies an event. Errors: kInvalid for one that is impossible in this state, which stays
   as is. */
  [[nodiscard]] Result<void> Apply(const StudyEvent& event);

  /** Waits for kBegun again, after the program was started again. */
  void AwaitBeginning() { is_waiting_ = true; }

  [[nodiscard]] Phase phase() const;

  /** Index of the current trial: the one that is trained for, ready, running or asked about. None
   before the first and after the last. */
  [[nodiscard]] std::optional<std::size_t> trial() const;

  [[nodiscard]] std::optional<OpenQuestion> question() const;

  /** Whether a trial or the training is running. */
  [[nodiscard]] bool is_running() const { return is_running_; }

  [[nodiscard]] const Protocol& protocol() const { return *protocol_; }

  [[nodiscard]] const std::vector<PlannedTrial>& schedule() const { return schedule_; }

  [[nodiscard]] const Condition& ConditionOf(std::size_t trial_index) const {
    return protocol_->conditions[schedule_[trial_index].condition];
  }

  [[nodiscard]] const Block& BlockOf(std::size_t trial_index) const {
    return protocol_->blocks[schedule_[trial_index].block];
  }

  [[nodiscard]] int participant() const { return participant_; }

  [[nodiscard]] const std::string& language() const { return language_; }

  [[nodiscard]] const std::vector<DoneTrial>& done() const { return done_; }

  [[nodiscard]] const std::vector<GivenAnswer>& answers() const { return answers_; }

  [[nodiscard]] const std::vector<Note>& notes() const { return notes_; }

  /** Reasons of all interruptions: aborts, and ends of the program during the session. */
  [[nodiscard]] const std::vector<std::string>& interruptions() const { return interruptions_; }

 private:
  enum class ItemKind : std::uint8_t { kConsent, kTraining, kTrial, kIdentify, kQuestion };

  /** One item of the agenda. */
  struct Item {
    ItemKind kind{ItemKind::kConsent};
    std::size_t trial{0};
    std::size_t question{0};
  };

  void AddQuestions(Asked asked, std::size_t trial);
  [[nodiscard]] bool IsLastOfCondition(std::size_t trial) const;
  void Interrupt(std::string reason);
  [[nodiscard]] Unexpected Refuse(const char* what) const;
  [[nodiscard]] Result<void> ApplyBegun();
  [[nodiscard]] Result<void> ApplyTrial(const StudyEvent& event);
  [[nodiscard]] Result<void> ApplyAnswer(const StudyEvent& event);

  const Protocol* protocol_;
  int participant_;
  std::vector<PlannedTrial> schedule_;
  std::vector<Item> agenda_;
  std::size_t at_{0};
  bool has_begun_{false};
  bool is_waiting_{true};
  bool is_running_{false};
  bool is_paused_{false};
  bool has_declined_{false};
  std::string language_{"en"};
  std::vector<DoneTrial> done_;
  std::vector<GivenAnswer> answers_;
  std::vector<Note> notes_;
  std::vector<std::string> interruptions_;
};

/** Name of a condition as an answer in a block of identification. */
[[nodiscard]] const std::string& AnswerNameOf(const Condition& condition);

/** Checks an answer. Errors: kInvalid for a value that the question does not allow. */
[[nodiscard]] Result<void> CheckAnswer(const Question& question, const AnswerValue& value);

}  // namespace hvas::study
