#include "studio/study_desk.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "mates/user_mate.h"
#include "studio/commands.h"
#include "study/simulated_participant.h"
#include "study/trial_pair.h"

namespace hvas::studio {
namespace {

using study::Condition;
using study::DoneTrial;
using study::Outcome;
using study::Phase;
using study::StudyEvent;

constexpr std::size_t kLongestNote = 4000;  // [bytes]: a page of text. A choice.

double Seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

Unexpected FailNotNow(const char* what, const char* remedy) {
  return Fail(ErrorCode::kInvalid, fmt::format("{} is not possible now", what), "study", remedy);
}

Json OrNull(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/** Roles that may do an action: the participant, or the experimenter, who has the operator's
 link. */
bool MayDo(Role role, const std::string& action) {
  const auto& rules = protocol::kStudyRules;
  const auto rule = std::find_if(rules.begin(), rules.end(), [&](const protocol::StudyRule& one) {
    return action == one.action;
  });
  if (rule == rules.end()) {
    return false;
  }
  switch (role) {
    case Role::kParticipant:
      return rule->is_for_participant;
    case Role::kOperator:
      return rule->is_for_experimenter;
    case Role::kViewer:
      break;
  }
  return rule->is_for_viewer;
}

}  // namespace

StudyDesk::StudyDesk(study::StudyFolder folder, Workbench* bench, Options options,
                     study::Journal journal, int number)
    : folder_(std::move(folder)),
      bench_(bench),
      options_(std::move(options)),
      journal_(std::move(journal)),
      session_(&folder_.protocol(), number, folder_.seed()),
      id_(options_.participant) {}

Result<std::unique_ptr<StudyDesk>> StudyDesk::Open(study::StudyFolder folder, Workbench* bench,
                                                   Options options) {
  const auto number = study::ParseParticipantId(options.participant);
  if (!number) {
    return Unexpected(number.error());
  }
  auto journal = folder.OpenJournal(options.participant, /*is_simulated=*/false);
  if (!journal) {
    return Unexpected(journal.error());
  }
  std::unique_ptr<StudyDesk> desk(
      new StudyDesk(std::move(folder), bench, std::move(options), std::move(*journal), *number));
  if (const auto applied = study::ApplyAll(desk->journal_.events(), &desk->session_); !applied) {
    return Unexpected(applied.error());
  }
  desk->is_resumed_ = !desk->journal_.events().empty();
  desk->session_.AwaitBeginning();
  return desk;
}

void StudyDesk::Start() {
  bench_->opener().Open(options_.product, folder_.protocol().title.en, SceneOpener::When::kWhole);
}

Result<void> StudyDesk::RecordEvent(StudyEvent event) {
  event.unix_ms = options_.unix_ms ? options_.unix_ms() : 0;
  study::StudySession before = session_;
  if (const auto applied = session_.Apply(event); !applied) {
    return applied;
  }
  const auto written = journal_.Append(event);
  if (!written) {
    session_ = std::move(before);  // an event that is not in the journal does not count
  }
  return written;
}

Result<Json> StudyDesk::Do(Role role, const Json& command, std::int64_t now_ns) {
  const auto action = TextAt(command, "action");
  if (!action) {
    return Unexpected(action.error());
  }
  if (!MayDo(role, *action)) {
    return Fail(ErrorCode::kInvalid, "there is no such action, or this link does not allow it",
                *action, "see docs/protocol.md for actions and roles");
  }
  if (*action == "pick") {
    return Pick(role, command, now_ns);
  }
  if (const auto done = Execute(role, *action, command, now_ns); !done) {
    return Unexpected(done.error());
  }
  return Json{{"state", MakeState(role, now_ns)}};
}

Result<void> StudyDesk::Execute(Role role, const std::string& action, const Json& command,
                                std::int64_t now_ns) {
  StudyEvent event;
  if (action == "begin") {
    if (!is_open_) {
      return FailNotNow("beginning", "wait until the product is open");
    }
    if (session_.phase() != Phase::kWaiting) {
      return FailNotNow("beginning", "the session has begun already");
    }
    event.kind = Kind::kBegun;
    return RecordEvent(event);
  }
  if (action == "consent") {
    return Consent(command);
  }
  if (action == "ready") {
    return BeginTrial(now_ns);
  }
  if (action == "next") {
    return Continue();
  }
  if (action == "answer") {
    return AnswerQuestion(command);
  }
  if (action == "note") {
    return AddNote(command);
  }
  if (action == "abort") {
    const auto fields = protocol::ReadFields<protocol::AbortAction>(command);
    return fields ? Abort(fields->reason) : Unexpected(fields.error());
  }
  if (action == "resume") {
    event.kind = Kind::kResumed;
    return RecordEvent(event);
  }
  static_cast<void>(role);
  return {};
}

Result<void> StudyDesk::Consent(const Json& command) {
  const auto fields = protocol::ReadFields<protocol::ConsentAction>(command);
  if (!fields) {
    return Unexpected(fields.error());
  }
  StudyEvent event;
  event.kind = Kind::kConsent;
  event.agrees = fields->agreed;
  event.language = fields->language.value_or(folder_.protocol().languages.front());
  return RecordEvent(event);
}

Result<void> StudyDesk::BeginTrial(std::int64_t now_ns) {
  if (trial_ != nullptr) {
    return FailNotNow("beginning", "the previous trial has to end first");
  }
  StudyEvent event;
  event.trial = session_.trial().value_or(0);
  event.kind = session_.phase() == Phase::kTraining ? Kind::kTrainingBegun : Kind::kTrialBegun;
  const auto recorded = RecordEvent(event);
  if (recorded) {
    training_since_ns_ = now_ns;
    BeginOnBench();
  }
  return recorded;
}

Result<void> StudyDesk::Continue() {
  const Phase phase = session_.phase();
  if (phase == Phase::kTraining && session_.is_running()) {
    StudyEvent event;
    event.kind = Kind::kTrainingEnded;
    const auto recorded = RecordEvent(event);
    if (recorded) {
      EndOnBench(Outcome::kNotDone);
    }
    return recorded;
  }
  if (phase == Phase::kRunning && trial_ != nullptr) {
    EndOnBench(Outcome::kNotDone);
    return {};
  }
  return FailNotNow("this action", "the action ends a training or trial in progress");
}

Result<void> StudyDesk::AnswerQuestion(const Json& command) {
  const auto fields = protocol::ReadFields<protocol::AnswerAction>(command);
  if (!fields) {
    return Unexpected(fields.error());
  }
  StudyEvent event;
  event.kind = Kind::kAnswered;
  event.question = fields->question;
  event.trial = session_.trial().value_or(0);
  event.value = fields->value;
  return RecordEvent(std::move(event));
}

Result<void> StudyDesk::AddNote(const Json& command) {
  const auto fields = protocol::ReadFields<protocol::NoteAction>(command);
  if (!fields || fields->text.empty()) {
    return Fail(ErrorCode::kInvalid, "the note is missing or too long", "text",
                fmt::format("write 1 to {} bytes", kLongestNote));
  }
  StudyEvent event;
  event.kind = Kind::kNote;
  event.text = fields->text;
  return RecordEvent(std::move(event));
}

Result<void> StudyDesk::Abort(const std::string& reason) {
  StudyEvent event;
  event.kind = Kind::kAborted;
  event.text = reason;
  const auto recorded = RecordEvent(event);
  if (recorded) {
    last_abort_ = event.text;
    EndOnBench(Outcome::kNotDone);
  }
  return recorded;
}

const Condition* StudyDesk::FindCurrentCondition() const {
  const study::Protocol& protocol = folder_.protocol();
  if (session_.phase() == Phase::kTraining) {
    return &protocol.conditions[protocol.training.condition.value_or(0)];
  }
  const auto trial = session_.trial();
  return trial ? &session_.ConditionOf(*trial) : nullptr;
}

bool StudyDesk::IsPicking() const {
  return trial_ != nullptr &&
         (trial_->plan().condition.method == study::Method::kPicking || !missing_.empty());
}

void StudyDesk::BeginOnBench() {
  LiveTrial::Plan plan;
  plan.condition = *FindCurrentCondition();
  const auto trial = session_.trial();
  plan.part = folder_.protocol().PartOf(plan.condition,
                                        trial && session_.BlockOf(*trial).is_identification);
  plan.mating_window = folder_.protocol().mating_window;
  // Pairs of the training are none of those of the trials.
  const std::size_t index = trial ? *trial : session_.schedule().size() + training_runs_++;
  plan.pair_seed = study::CalcPairSeed(folder_.seed(), session_.participant(), index);
  plan.has_person = options_.has_person;
  if (options_.keeps_records && session_.phase() == Phase::kRunning) {
    plan.record = folder_.RecordFile(id_, *session_.trial());
    std::error_code ignored;
    std::filesystem::remove(plan.record, ignored);  // record of an interrupted trial
  }
  ending_.reset();
  hold_.clear();
  bench_->trials().Begin(plan);
}

void StudyDesk::EndOnBench(Outcome outcome) {
  if (trial_ != nullptr && !ending_) {
    ending_ = outcome;
    bench_->trials().End();
  }
}

Result<void> StudyDesk::FinishTrial() {
  const std::shared_ptr<LiveTrial> over = std::exchange(trial_, nullptr);
  const Outcome outcome = ending_.value_or(Outcome::kNotDone);
  ending_.reset();
  missing_.clear();
  hold_.clear();
  if (session_.phase() == Phase::kTraining && session_.is_running()) {
    BeginOnBench();  // the training is repeated until the participant goes on
    return {};
  }
  if (over == nullptr || session_.phase() != Phase::kRunning) {
    return {};  // an aborted trial has no result
  }
  StudyEvent event;
  event.kind = Kind::kTrialEnded;
  event.trial = *session_.trial();
  event.result = over->watch().MakeResult();
  event.result.pair = over->pair();
  event.result.outcome = outcome;
  if (outcome == Outcome::kTimedOut && event.result.time) {
    event.result.time = std::min(*event.result.time, over->plan().condition.time_limit);
  }
  return RecordEvent(std::move(event));
}

bool StudyDesk::OnBenchEvent(const Json& event, std::int64_t /*now_ns*/) {
  const std::string name = event.value("event", "");
  if (name == "scene") {
    return !std::exchange(is_open_, true);
  }
  if (name == "trial_begun") {
    trial_ = bench_->trials().trial();
    part_ = bench_->trials().part();
    missing_ = bench_->trials().ListConstraints();
    if (!session_.is_running()) {
      EndOnBench(Outcome::kNotDone);  // aborted, or the training ended, before the run began
    }
    return true;
  }
  if (name == "trial_over") {
    if (const auto finished = FinishTrial(); !finished) {
      static_cast<void>(Abort(finished.error().ToString()));
    }
    return true;
  }
  if (name == "trial_failed") {
    trial_ = nullptr;
    static_cast<void>(Abort(event.value("reason", "the trial could not begin")));
    return true;
  }
  if (name == "state" || name == "taken" || name == "dropped") {
    const auto state = static_cast<haptics::HoldState>(event.value("state", 0));
    const bool is_part = part_ && event.value("occurrence", -1) == static_cast<int>(part_->value());
    hold_ = name == "dropped" ? "" : haptics::ToString(state);
    if (trial_ != nullptr && is_part && name != "dropped" && state == haptics::HoldState::kSeated) {
      EndOnBench(Outcome::kDone);
    }
    return true;
  }
  return false;
}

bool StudyDesk::Poll(std::int64_t now_ns) {
  const Phase phase = session_.phase();
  if (phase == Phase::kTraining && session_.is_running()) {
    if (Seconds(now_ns - training_since_ns_) >= folder_.protocol().training.duration) {
      static_cast<void>(Continue());
    }
    return true;
  }
  if (phase != Phase::kRunning || trial_ == nullptr) {
    return false;
  }
  if (trial_->watch().elapsed_s() >= trial_->plan().condition.time_limit) {
    EndOnBench(Outcome::kTimedOut);
  }
  return true;
}

Result<void> StudyDesk::CheckTake() const {
  if (trial_ == nullptr || ending_) {
    return FailNotNow("taking a part", "wait until the trial has begun");
  }
  return IsPicking()
             ? Result<void>(FailNotNow("taking a part", "pick the surfaces that belong together"))
             : Result<void>();
}

Result<Json> StudyDesk::Pick(Role role, const Json& command, std::int64_t now_ns) {
  const auto fields = protocol::ReadFields<protocol::PickAction>(command);
  if (!fields) {
    return Unexpected(fields.error());
  }
  const auto& [a, b] = *fields;
  if (!IsPicking() || ending_) {
    return FailNotNow("picking", "surfaces can be picked only in trials with that method");
  }
  const auto scene = bench_->live().scene();
  const auto mate = mates::MakeMate(*scene->model->product, {a.occurrence, a.face, {}},
                                    {b.occurrence, b.face, {}});
  const auto found = mate ? std::find(missing_.begin(), missing_.end(), mate->id) : missing_.end();
  const bool is_set = found != missing_.end();
  if (is_set) {
    missing_.erase(found);
  }
  if (is_set && missing_.empty() && trial_->plan().condition.method == study::Method::kPicking) {
    EndOnBench(Outcome::kDone);
  }
  return Json{{"is_set", is_set}, {"left", missing_.size()}, {"state", MakeState(role, now_ns)}};
}

Json StudyDesk::MakeEvent(Role role, std::int64_t now_ns) const {
  Json event{{"event", "study"}};
  event.update(MakeState(role, now_ns));
  return event;
}

Json StudyDesk::MakeState(Role role, std::int64_t now_ns) const {
  const study::Protocol& protocol = folder_.protocol();
  const bool is_experimenter = role == Role::kOperator;
  const bool sees_progress = is_experimenter || !protocol.hidden.progress;
  const std::string& language = session_.language();
  const auto trial = session_.trial();
  Json state{{"view", is_experimenter ? "experimenter" : "participant"},
             {"title", protocol.title.In(language)},
             {"language", language},
             {"has_end_sound", protocol.display.has_end_sound},
             {"stereo", study::kStereos[static_cast<std::size_t>(protocol.display.stereo)]},
             {"languages", protocol.languages},
             {"phase", study::ToString(session_.phase())},
             {"is_running", session_.is_running()},
             {"is_open", is_open_}};
  state["trial"] = trial && sees_progress ? Json(*trial + 1) : Json(nullptr);
  state["trials"] = sees_progress ? Json(session_.schedule().size()) : Json(nullptr);
  // The text is sent in every language: the participant chooses one with the consent.
  Json consent = nullptr;
  if (session_.phase() == Phase::kConsent) {
    consent = {{"en", protocol.consent.en}, {"de", protocol.consent.In("de")}};
  }
  state["consent"] = std::move(consent);
  AddTrialAtHand(now_ns, is_experimenter, &state);
  state["question"] = MakeQuestion();
  if (is_experimenter) {
    AddForExperimenter(&state);
  }
  return state;
}

void StudyDesk::AddTrialAtHand(std::int64_t now_ns, bool sees_all, Json* state) const {
  const study::Protocol& protocol = folder_.protocol();
  const Phase phase = session_.phase();
  const bool is_training = phase == Phase::kTraining;
  const bool is_at_hand = is_training || phase == Phase::kReady || phase == Phase::kRunning;
  const Condition* condition = is_at_hand ? FindCurrentCondition() : nullptr;
  Json& s = *state;
  for (const char* key : {"instruction", "method", "occurrence", "elapsed_s", "limit_s"}) {
    s[key] = nullptr;
  }
  if (condition == nullptr) {
    return;
  }
  const std::string& language = session_.language();
  s["instruction"] =
      OrNull(is_training && !protocol.training.text.empty() ? protocol.training.text.In(language)
                                                            : condition->instruction.In(language));
  // A part whose axis is picked first is taken by the hand after that.
  const bool begins_with_picking = condition->method == study::Method::kPicking ||
                                   condition->constraints == study::Constraints::kPicked;
  const bool is_picking = trial_ != nullptr ? IsPicking() : begins_with_picking;
  s["method"] = is_picking ? "picking" : "hand";
  s["occurrence"] = part_ ? Json(part_->value()) : Json(nullptr);
  const auto trial = session_.trial();
  const bool is_told =
      !protocol.hidden.condition || (trial && session_.BlockOf(*trial).tells_condition);
  if (is_told && !sees_all) {
    s["condition_name"] = condition->name.In(language);
  }
  if (!sees_all && protocol.hidden.time && !is_training) {
    return;
  }
  s["limit_s"] = is_training ? protocol.training.duration : condition->time_limit;
  if (is_training && session_.is_running()) {
    s["elapsed_s"] = Seconds(now_ns - training_since_ns_);
  } else if (trial_ != nullptr && phase == Phase::kRunning) {
    s["elapsed_s"] = trial_->watch().elapsed_s();
  }
}

Json StudyDesk::MakeQuestion() const {
  const auto open = session_.question();
  if (!open) {
    return nullptr;
  }
  const std::string& language = session_.language();
  Json json{{"id", open->id}};
  if (open->question == nullptr) {
    const study::Block& block = session_.BlockOf(open->trial);
    json["kind"] = "choice";
    json["text"] = block.question.In(language);
    json["choices"] = Json::array();  // in the protocol's order, which reveals nothing
    for (const std::size_t c : block.conditions) {
      const std::string& answer = study::AnswerNameOf(folder_.protocol().conditions[c]);
      json["choices"].push_back({{"id", answer}, {"text", answer}});
    }
    return json;
  }
  const study::Question& question = *open->question;
  json["kind"] = study::kQuestionKinds[static_cast<std::size_t>(question.kind)];
  json["text"] = question.text.In(language);
  switch (question.kind) {
    case study::QuestionKind::kScale:
      json["low"] = question.low;
      json["high"] = question.high;
      json["low_text"] = question.low_text.In(language);
      json["high_text"] = question.high_text.In(language);
      break;
    case study::QuestionKind::kChoice:
      json["choices"] = Json::array();
      for (const study::Choice& choice : question.choices) {
        json["choices"].push_back({{"id", choice.id}, {"text", choice.text.In(language)}});
      }
      break;
    case study::QuestionKind::kText:
      json["longest"] = question.longest;
      break;
  }
  return json;
}

Json StudyDesk::MakeDone() const {
  Json list = Json::array();
  for (const DoneTrial& done : session_.done()) {
    const Condition& condition = session_.ConditionOf(done.index);
    const bool is_answered = !done.answer.empty();
    list.push_back({{"trial", done.index + 1},
                    {"condition", condition.id},
                    {"repetition", session_.schedule()[done.index].repetition},
                    {"outcome", study::kOutcomes[static_cast<std::size_t>(done.result.outcome)]},
                    {"time_s", done.result.time ? Json(*done.result.time) : Json(nullptr)},
                    {"collisions", done.result.collisions},
                    {"peak_force_n", done.result.peak_felt},
                    {"answer", OrNull(done.answer)},
                    {"is_right", is_answered ? Json(done.answer == study::AnswerNameOf(condition))
                                             : Json(nullptr)}});
  }
  return list;
}

void StudyDesk::AddForExperimenter(Json* state) const {
  const study::Protocol& protocol = folder_.protocol();
  const auto trial = session_.trial();
  const Condition* condition = FindCurrentCondition();
  Json& s = *state;
  s["participant"] = id_;
  s["link"] = OrNull(participant_link_);
  s["is_resumed"] = is_resumed_;
  s["interruptions"] = session_.interruptions().size();
  s["protocol"] = protocol.id;
  s["digest"] = protocol.digest;
  s["folder"] = folder_.path().string();
  s["condition"] = condition != nullptr ? Json(condition->id) : Json(nullptr);
  s["condition_name"] = condition != nullptr ? OrNull(condition->name.en) : Json(nullptr);
  s["fit"] = condition != nullptr ? OrNull(condition->fit) : Json(nullptr);
  s["repetition"] = trial ? Json(session_.schedule()[*trial].repetition) : Json(nullptr);
  s["block"] = trial ? Json(session_.BlockOf(*trial).id) : Json(nullptr);
  s["is_identification"] = trial && session_.BlockOf(*trial).is_identification;
  s["next"] = nullptr;
  if (trial && *trial + 1 < session_.schedule().size()) {
    s["next"] = {{"condition", session_.ConditionOf(*trial + 1).id},
                 {"repetition", session_.schedule()[*trial + 1].repetition}};
  }
  s["hold"] = OrNull(hold_);
  s["done"] = MakeDone();
  s["answers"] = Json::array();
  for (const study::GivenAnswer& answer : session_.answers()) {
    const int* number = std::get_if<int>(&answer.value);
    const std::string* text = std::get_if<std::string>(&answer.value);
    s["answers"].push_back({{"question", answer.question},
                            {"value", number != nullptr ? Json(*number)
                                      : text != nullptr ? Json(*text)
                                                        : Json(nullptr)}});
  }
  s["notes"] = Json::array();
  for (const study::Note& note : session_.notes()) {
    s["notes"].push_back(
        {{"text", note.text}, {"trial", note.trial + 1}, {"unix_ms", note.unix_ms}});
  }
  s["reason"] = session_.phase() == Phase::kPaused ? OrNull(last_abort_) : Json(nullptr);
}

}  // namespace hvas::studio
