#include "study/study_session.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace hvas::study {
namespace {

using Kind = StudyEvent::Kind;

const char* DescribeNextAction(Phase phase) {
  switch (phase) {
    case Phase::kWaiting:
      return "begin the session first";
    case Phase::kConsent:
      return "the participant has to give or refuse consent first";
    case Phase::kTraining:
      return "the training comes next";
    case Phase::kReady:
      return "the trial has to begin first";
    case Phase::kRunning:
      return "wait until the trial ends, or abort it";
    case Phase::kQuestion:
      return "the question has to be answered or skipped first";
    case Phase::kPaused:
      return "resume the session first";
    case Phase::kDeclined:
    case Phase::kDone:
      break;
  }
  return "the session is over";
}

/** Counts the code points of a UTF-8 text. */
std::size_t CountCharacters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

}  // namespace

const std::string& AnswerNameOf(const Condition& condition) {
  return condition.answer.empty() ? condition.fit : condition.answer;
}

Result<void> CheckAnswer(const Question& question, const AnswerValue& value) {
  const auto refuse = [&](std::string remedy) {
    return Fail(ErrorCode::kInvalid, "the answer does not suit the question", question.id,
                std::move(remedy));
  };
  if (std::holds_alternative<std::monostate>(value)) {
    return {};
  }
  if (question.kind == QuestionKind::kScale) {
    const int* number = std::get_if<int>(&value);
    if (number == nullptr || *number < question.low || *number > question.high) {
      return refuse(fmt::format("give a whole number from {} to {}", question.low, question.high));
    }
    return {};
  }
  const std::string* text = std::get_if<std::string>(&value);
  if (text == nullptr) {
    return refuse("give a text");
  }
  if (question.kind == QuestionKind::kText) {
    if (CountCharacters(*text) > static_cast<std::size_t>(question.longest)) {
      return refuse(fmt::format("give at most {} characters", question.longest));
    }
    return {};
  }
  const bool is_choice = std::any_of(question.choices.begin(), question.choices.end(),
                                     [&](const Choice& choice) { return choice.id == *text; });
  return is_choice ? Result<void>() : refuse("give the id of one of its choices");
}

StudySession::StudySession(const Protocol* protocol, int participant, std::uint64_t seed)
    : protocol_(protocol),
      participant_(participant),
      schedule_(MakeSchedule(*protocol, participant, seed)) {
  agenda_.push_back({ItemKind::kConsent, 0, 0});
  if (protocol->training.duration > 0) {
    agenda_.push_back({ItemKind::kTraining, 0, 0});
  }
  for (std::size_t i = 0; i < schedule_.size(); ++i) {
    agenda_.push_back({ItemKind::kTrial, i, 0});
    if (BlockOf(i).is_identification) {
      agenda_.push_back({ItemKind::kIdentify, i, 0});
    }
    AddQuestions(Asked::kAfterTrial, i);
    if (IsLastOfCondition(i)) {
      AddQuestions(Asked::kAfterCondition, i);
    }
    if (i + 1 == schedule_.size() || schedule_[i + 1].block != schedule_[i].block) {
      AddQuestions(Asked::kAfterBlock, i);
    }
  }
  AddQuestions(Asked::kAtEnd, schedule_.size() - 1);
}

void StudySession::AddQuestions(Asked asked, std::size_t trial) {
  for (std::size_t q = 0; q < protocol_->questions.size(); ++q) {
    const Question& question = protocol_->questions[q];
    const bool is_here =
        asked == Asked::kAtEnd || question.block.empty() || question.block == BlockOf(trial).id;
    if (question.asked == asked && is_here) {
      agenda_.push_back({ItemKind::kQuestion, trial, q});
    }
  }
}

bool StudySession::IsLastOfCondition(std::size_t trial) const {
  return schedule_[trial].repetition == BlockOf(trial).repetitions;
}

Phase StudySession::phase() const {
  if (has_declined_) {
    return Phase::kDeclined;
  }
  if (at_ == agenda_.size()) {
    return Phase::kDone;
  }
  if (is_waiting_) {
    return Phase::kWaiting;
  }
  if (is_paused_) {
    return Phase::kPaused;
  }
  switch (agenda_[at_].kind) {
    case ItemKind::kConsent:
      return Phase::kConsent;
    case ItemKind::kTraining:
      return Phase::kTraining;
    case ItemKind::kTrial:
      return is_running_ ? Phase::kRunning : Phase::kReady;
    case ItemKind::kIdentify:
    case ItemKind::kQuestion:
      break;
  }
  return Phase::kQuestion;
}

std::optional<std::size_t> StudySession::trial() const {
  if (at_ == agenda_.size() || agenda_[at_].kind == ItemKind::kConsent) {
    return std::nullopt;
  }
  return agenda_[at_].trial;
}

std::optional<OpenQuestion> StudySession::question() const {
  if (phase() != Phase::kQuestion) {
    return std::nullopt;
  }
  const Item& item = agenda_[at_];
  if (item.kind == ItemKind::kIdentify) {
    return OpenQuestion{std::string(kIdentifyQuestion), nullptr, item.trial};
  }
  const Question& question = protocol_->questions[item.question];
  return OpenQuestion{question.id, &question, item.trial};
}

Unexpected StudySession::Refuse(const char* what) const {
  return Fail(ErrorCode::kInvalid, fmt::format("{} is not possible now", what),
              fmt::format("phase \"{}\"", ToString(phase())), DescribeNextAction(phase()));
}

void StudySession::Interrupt(std::string reason) {
  is_running_ = false;
  interruptions_.push_back(std::move(reason));
}

Result<void> StudySession::ApplyBegun() {
  if (has_declined_ || at_ == agenda_.size()) {
    return Refuse("beginning");
  }
  if (has_begun_ && !is_paused_) {
    Interrupt("the program ended");
  }
  has_begun_ = true;
  is_waiting_ = false;
  is_paused_ = false;
  return {};
}

Result<void> StudySession::ApplyTrial(const StudyEvent& event) {
  if (event.kind == Kind::kTrialBegun) {
    if (phase() != Phase::kReady || event.trial != agenda_[at_].trial) {
      return Refuse("this trial");
    }
    is_running_ = true;
    return {};
  }
  if (phase() != Phase::kRunning || event.trial != agenda_[at_].trial) {
    return Refuse("the end of this trial");
  }
  is_running_ = false;
  done_.push_back({event.trial, event.result, ""});
  ++at_;
  return {};
}

Result<void> StudySession::ApplyAnswer(const StudyEvent& event) {
  const std::optional<OpenQuestion> open = question();
  if (!open || open->id != event.question) {
    return Refuse("this answer");
  }
  if (open->question != nullptr) {
    if (const auto checked = CheckAnswer(*open->question, event.value); !checked) {
      return checked;
    }
    answers_.push_back({open->id, open->trial, event.value});
  } else {
    const std::string* answer = std::get_if<std::string>(&event.value);
    const auto& conditions = BlockOf(open->trial).conditions;
    const bool is_known =
        answer != nullptr && std::any_of(conditions.begin(), conditions.end(), [&](std::size_t c) {
          return AnswerNameOf(protocol_->conditions[c]) == *answer;
        });
    if (!is_known) {
      return Fail(ErrorCode::kInvalid, "the answer does not suit the question", open->id,
                  "give the id of one of its choices");
    }
    done_.back().answer = *answer;
  }
  ++at_;
  return {};
}

Result<void> StudySession::Apply(const StudyEvent& event) {
  const Phase now = phase();
  switch (event.kind) {
    case Kind::kBegun:
      return ApplyBegun();
    case Kind::kConsent: {
      const auto& known = protocol_->languages;
      if (now != Phase::kConsent || std::count(known.begin(), known.end(), event.language) == 0) {
        return Refuse("consent in this language");
      }
      language_ = event.language;
      has_declined_ = !event.agrees;
      at_ += event.agrees ? 1 : 0;
      return {};
    }
    case Kind::kTrainingBegun:
      if (now != Phase::kTraining || is_running_) {
        return Refuse("beginning the training");
      }
      is_running_ = true;
      return {};
    case Kind::kTrainingEnded:
      if (now != Phase::kTraining || !is_running_) {
        return Refuse("ending the training");
      }
      is_running_ = false;
      ++at_;
      return {};
    case Kind::kTrialBegun:
    case Kind::kTrialEnded:
      return ApplyTrial(event);
    case Kind::kAnswered:
      return ApplyAnswer(event);
    case Kind::kNote:
      notes_.push_back({event.text, trial().value_or(0), event.unix_ms});
      return {};
    case Kind::kAborted:
      if (now == Phase::kWaiting || now == Phase::kPaused || now == Phase::kDeclined ||
          now == Phase::kDone) {
        return Refuse("to abort");
      }
      Interrupt(event.text);
      is_paused_ = true;
      return {};
    case Kind::kResumed:
      if (now != Phase::kPaused) {
        return Refuse("to resume");
      }
      is_paused_ = false;
      return {};
  }
  return {};
}

}  // namespace hvas::study
