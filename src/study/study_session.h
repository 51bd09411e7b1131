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
  kWaiting,  ///< Nobody has begun, or begun again.
  kConsent,
  kTraining,
  kReady,  ///< For the trial at hand.
  kRunning,
  kQuestion,
  kPaused,    ///< By the experimenter.
  kDeclined,  ///< The participant did not agree. For good.
  kDone,
};

inline constexpr std::array<std::string_view, 9> kPhases{
    "waiting", "consent", "training", "ready", "running", "question", "paused", "declined", "done"};

[[nodiscard]] constexpr std::string_view ToString(Phase phase) {
  return kPhases[static_cast<std::size_t>(phase)];
}

/** An answer: of a scale, of a choice or a text; none where somebody would not answer. */
using AnswerValue = std::variant<std::monostate, int, std::string>;

/** Something that happened to a session of a study. The session is all that follows from its
 events, in their order: to resume it is to apply them again. */
struct StudyEvent {
  enum class Kind : std::uint8_t {
    kBegun,  ///< Also again, after the program had ended.
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
  std::int64_t unix_ms{0};  ///< Of the wall clock; 0 in simulated sessions, which have none.
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

/** The question of identification: after a trial, which condition it was. */
inline constexpr std::string_view kIdentifyQuestion = "identify";

/** A trial that is over. */
struct DoneTrial {
  std::size_t index{0};  ///< Into the schedule.
  TrialResult result;
  std::string answer;  ///< Of identification; empty: none, or not yet.
};

struct GivenAnswer {
  std::string question;
  std::optional<std::size_t> trial;  ///< That it was asked after.
  AnswerValue value;
};

struct Note {
  std::string text;
  std::size_t trial{0};     ///< Index of the trial that was at hand.
  std::int64_t unix_ms{0};  ///< As StudyEvent's.
};

/** What is asked now. */
struct OpenQuestion {
  std::string id;
  const Question* question{nullptr};  ///< Null: identification.
  std::size_t trial{0};               ///< Index of the trial before.
};

/** The session of one participant: consent, training, trials, questions, in the order of the
 schedule. No input, output, threads or clocks: what happens comes as events, times are in them. */
class StudySession {
 public:
  /** @param protocol  Outlives this. */
  StudySession(const Protocol* protocol, int participant, std::uint64_t seed);

  /** Errors: kInvalid for what cannot happen now, with what can. Nothing has changed then. */
  [[nodiscard]] Result<void> Apply(const StudyEvent& event);

  /** The program was begun again: waits for kBegun, as at first. */
  void AwaitBeginning() { is_waiting_ = true; }

  [[nodiscard]] Phase phase() const;

  /** The trial at hand: that is trained for, waited for, run or asked about. None before the first
   and after the last. */
  [[nodiscard]] std::optional<std::size_t> trial() const;

  [[nodiscard]] std::optional<OpenQuestion> question() const;

  /** A trial, or the training, has begun. */
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

  /** Of all aborts and ends of the program in between, why. */
  [[nodiscard]] const std::vector<std::string>& interruptions() const { return interruptions_; }

 private:
  enum class ItemKind : std::uint8_t { kConsent, kTraining, kTrial, kIdentify, kQuestion };

  /** One thing to do. */
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

/** The names that a participant may answer with in an identification block, and of which condition
 each is. */
[[nodiscard]] const std::string& AnswerOf(const Condition& condition);

/** Errors: kInvalid for a value that the question does not have. */
[[nodiscard]] Result<void> CheckAnswer(const Question& question, const AnswerValue& value);

}  // namespace hvas::study
