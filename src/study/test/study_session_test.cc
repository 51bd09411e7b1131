// A participant's session: what comes after what, what is refused, interruptions (N9, X14, W11,
// W12).

#include "study/study_session.h"

#include <memory>
#include <string>
#include <vector>

#include "study/study_folder.h"
#include "study/test/tiny_study.h"

namespace hvas::study {
namespace {

using Kind = StudyEvent::Kind;

StudyEvent Make(Kind kind) {
  StudyEvent event;
  event.kind = kind;
  return event;
}

StudyEvent Agree(bool agrees = true) {
  StudyEvent event = Make(Kind::kConsent);
  event.agrees = agrees;
  event.language = "de";
  return event;
}

StudyEvent OfTrial(Kind kind, std::size_t trial) {
  StudyEvent event = Make(kind);
  event.trial = trial;
  event.result.outcome = Outcome::kDone;
  event.result.time = 1.0 + static_cast<double>(trial);
  return event;
}

StudyEvent Give(const std::string& question, AnswerValue value) {
  StudyEvent event = Make(Kind::kAnswered);
  event.question = question;
  event.value = std::move(value);
  return event;
}

class StudySessionTest : public ::testing::Test {
 protected:
  void Do(const StudyEvent& event) {
    const auto applied = session_.Apply(event);
    ASSERT_TRUE(applied) << applied.error().ToString();
  }

  void BeginTrials() {
    for (const StudyEvent& event :
         {Make(Kind::kBegun), Agree(), Make(Kind::kTrainingBegun), Make(Kind::kTrainingEnded)}) {
      Do(event);
    }
  }

  void DoTrial(std::size_t trial) {
    Do(OfTrial(Kind::kTrialBegun, trial));
    Do(OfTrial(Kind::kTrialEnded, trial));
  }

  Protocol protocol_ = testing::MakeTinyProtocol();
  StudySession session_{&protocol_, 1, 1};
};

TEST_F(StudySessionTest, W11GoesFromConsentToTheLastAnswer) {
  EXPECT_EQ(session_.phase(), Phase::kWaiting);
  BeginTrials();
  EXPECT_EQ(session_.language(), "de");
  for (std::size_t trial = 0; trial < 3; ++trial) {
    EXPECT_EQ(session_.phase(), Phase::kReady);
    EXPECT_EQ(session_.trial(), trial);
    DoTrial(trial);
  }
  ASSERT_EQ(session_.phase(), Phase::kQuestion);
  EXPECT_EQ(session_.question()->id, "hand");  // after the block of timed trials
  Do(Give("hand", "left"));
  for (std::size_t trial = 3; trial < 7; ++trial) {
    DoTrial(trial);
    ASSERT_EQ(session_.phase(), Phase::kQuestion);
    EXPECT_EQ(session_.question()->id, kIdentifyQuestion);
    Do(Give(std::string(kIdentifyQuestion), "H7/p6"));
    EXPECT_EQ(session_.done().back().answer, "H7/p6");
  }
  Do(Give("calm", 7));
  Do(Give("easy", AnswerValue()));  // nobody has to answer
  Do(Give("remarks", "gut"));
  EXPECT_EQ(session_.phase(), Phase::kDone);
  EXPECT_EQ(session_.done().size(), 7U);
  EXPECT_EQ(std::get<int>(session_.answers()[1].value), 7);
  EXPECT_FALSE(session_.Apply(Make(Kind::kBegun)));
}

TEST_F(StudySessionTest, AnAnswerThatIsAFormulaIsATextInTheTable) {
  BeginTrials();
  for (std::size_t trial = 0; trial < 3; ++trial) {
    DoTrial(trial);
  }
  Do(Give("hand", "left"));
  for (std::size_t trial = 3; trial < 7; ++trial) {
    DoTrial(trial);
    Do(Give(std::string(kIdentifyQuestion), "H7/p6"));
  }
  Do(Give("calm", 7));
  Do(Give("easy", AnswerValue()));
  Do(Give("remarks", "=1+\"2,3\""));
  std::vector<Participant> participants(1);
  participants[0].id = "P01";
  participants[0].session = std::make_unique<StudySession>(session_);
  const std::string answers = MakeAnswersCsv(participants);
  EXPECT_NE(answers.find("P01,0,remarks,7,\"'=1+\"\"2,3\"\"\"\r\n"), std::string::npos) << answers;
  EXPECT_NE(answers.find("P01,0,calm,7,7\r\n"), std::string::npos) << answers;
  EXPECT_EQ(MakeTrialsCsv(participants).find("'"), std::string::npos);
}

TEST_F(StudySessionTest, NothingIsAskedOfWhoDoesNotAgree) {
  Do(Make(Kind::kBegun));
  Do(Agree(false));
  EXPECT_EQ(session_.phase(), Phase::kDeclined);
  for (const StudyEvent& event :
       {Make(Kind::kBegun), Agree(), Make(Kind::kTrainingBegun), OfTrial(Kind::kTrialBegun, 0)}) {
    EXPECT_FALSE(session_.Apply(event));
  }
}

TEST_F(StudySessionTest, RefusesWhatIsNotItsTurnAndSaysWhatIs) {
  Do(Make(Kind::kBegun));
  const auto early = session_.Apply(OfTrial(Kind::kTrialBegun, 0));
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().remedy.find("consent"), std::string::npos) << early.error().ToString();
  Do(Agree());
  EXPECT_FALSE(session_.Apply(Make(Kind::kTrainingEnded)));  // has not begun
  Do(Make(Kind::kTrainingBegun));
  Do(Make(Kind::kTrainingEnded));
  EXPECT_FALSE(session_.Apply(OfTrial(Kind::kTrialBegun, 1)));
  EXPECT_FALSE(session_.Apply(OfTrial(Kind::kTrialEnded, 0)));
  EXPECT_FALSE(session_.Apply(Give("calm", 7)));
  EXPECT_EQ(session_.phase(), Phase::kReady);
}

TEST_F(StudySessionTest, AbortedTrialCountsForNothingAndIsRepeated) {
  BeginTrials();
  Do(OfTrial(Kind::kTrialBegun, 0));
  StudyEvent abort = Make(Kind::kAborted);
  abort.text = "fire alarm";
  Do(abort);
  EXPECT_EQ(session_.phase(), Phase::kPaused);
  EXPECT_FALSE(session_.Apply(OfTrial(Kind::kTrialEnded, 0)));
  Do(Make(Kind::kResumed));
  EXPECT_EQ(session_.phase(), Phase::kReady);
  EXPECT_EQ(session_.trial(), 0U);
  EXPECT_TRUE(session_.done().empty());
  EXPECT_EQ(session_.interruptions(), std::vector<std::string>{"fire alarm"});
}

TEST_F(StudySessionTest, BegunAgainGoesOnWithTheFirstTrialThatIsNotDone) {
  BeginTrials();
  DoTrial(0);
  Do(OfTrial(Kind::kTrialBegun, 1));
  Do(Make(Kind::kBegun));  // the program had ended
  EXPECT_EQ(session_.phase(), Phase::kReady);
  EXPECT_EQ(session_.trial(), 1U);
  EXPECT_EQ(session_.interruptions().size(), 1U);
}

TEST_F(StudySessionTest, RefusesAnswersThatAQuestionDoesNotHave) {
  for (const AnswerValue& value : {AnswerValue(0), AnswerValue(11), AnswerValue("seven")}) {
    EXPECT_FALSE(CheckAnswer(protocol_.questions[0], value));
  }
  EXPECT_TRUE(CheckAnswer(protocol_.questions[0], 10));
  EXPECT_FALSE(CheckAnswer(protocol_.questions[2], "both"));
  EXPECT_TRUE(CheckAnswer(protocol_.questions[2], "right"));
  EXPECT_TRUE(CheckAnswer(protocol_.questions[3], "zehn äöüäö"));  // ten characters, not bytes
  EXPECT_FALSE(CheckAnswer(protocol_.questions[3], "elf is more"));
}

}  // namespace
}  // namespace hvas::study
