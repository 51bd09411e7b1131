// Whole studies with simulated participants, and what is kept of them (N9, X14, X15, W8, W12).

#include "study/simulated_study.h"

#include <cmath>
#include <fstream>
#include <string>

#include "base/random.h"
#include "record/reader.h"
#include "study/simulated_participant.h"
#include "study/study_page.h"
#include "study/study_results.h"
#include "study/test/tiny_study.h"

namespace hvas::study {
namespace {

using testing::MakeTinyProtocol;
using testing::PegModel;
using testing::ReadFolder;

class SimulatedStudyTest : public ::testing::Test {
 protected:
  StudyFolder Run(const std::string& name, unsigned threads,
                  KeptRecords records = KeptRecords::kNone) {
    auto folder = StudyFolder::Create(scratch_.path() / name, MakeTinyProtocol(), 3);
    EXPECT_TRUE(folder) << folder.error().ToString();
    SimulatedStudyOptions options;
    options.participants = 2;
    options.records = records;
    options.threads = threads;
    const auto done = RunSimulatedStudy(*folder, PegModel, options);
    EXPECT_TRUE(done) << done.error().ToString();
    return std::move(*folder);
  }

  ScratchFolder scratch_ = *ScratchFolder::Make();
};

TEST_F(SimulatedStudyTest, RunsToTheEndTheSameOnAnyNumberOfThreads) {
  const StudyFolder one = Run("one", 1);
  const StudyFolder two = Run("two", 2);
  EXPECT_EQ(ReadFolder(one.path()), ReadFolder(two.path()));
  const auto participants = one.ReadParticipants();
  ASSERT_TRUE(participants) << participants.error().ToString();
  ASSERT_EQ(participants->size(), 2U);
  for (const Participant& participant : *participants) {
    EXPECT_EQ(participant.session->phase(), Phase::kDone);
    EXPECT_TRUE(participant.is_simulated);
    EXPECT_EQ(participant.session->done().size(), 7U);
    for (const DoneTrial& done : participant.session->done()) {
      EXPECT_EQ(done.result.outcome, Outcome::kDone);
      const bool is_blind = participant.session->BlockOf(done.index).is_identification;
      EXPECT_NE(done.result.time.has_value(), is_blind);
      EXPECT_NE(done.answer.empty(), is_blind);
    }
    for (const GivenAnswer& answer : participant.session->answers()) {
      EXPECT_TRUE(std::holds_alternative<std::monostate>(answer.value)) << "has no opinions";
    }
  }
  const auto page = MakeStudyPage(one, *participants);
  const auto others = two.ReadParticipants();
  ASSERT_TRUE(page && others) << page.error().ToString();
  EXPECT_EQ(*page, *MakeStudyPage(two, *others));
  for (const char* part : {"Simulated.", "12.6", "Order published", "F_z", "answer no questions",
                           "digest", "seed 3"}) {
    EXPECT_NE(page->find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page->find("http://"), page->find("http://www.w3.org")) << "needs a network";
}

TEST_F(SimulatedStudyTest, InterruptedItGoesOnWithTheSameTrials) {
  const StudyFolder whole = Run("whole", 1);
  const StudyFolder cut = Run("cut", 1);
  const auto journal = cut.path() / "participants" / "P02.jsonl";
  const std::string bytes = testing::ReadAll(journal);
  std::ofstream(journal, std::ios::binary | std::ios::trunc) << bytes.substr(0, bytes.size() / 2);
  ASSERT_LT(cut.ReadParticipant("P02")->session->done().size(), 7U);
  const StudyFolder resumed = Run("cut", 1);
  EXPECT_EQ(ReadFolder(resumed.path()), ReadFolder(whole.path()));
  const auto a = whole.ReadParticipant("P02");
  const auto b = resumed.ReadParticipant("P02");
  ASSERT_TRUE(a && b);
  EXPECT_EQ(b->session->phase(), Phase::kDone);
  ASSERT_EQ(a->session->done().size(), b->session->done().size());
  for (std::size_t i = 0; i < a->session->done().size(); ++i) {
    EXPECT_EQ(a->session->done()[i].result.time, b->session->done()[i].result.time);
    EXPECT_EQ(a->session->done()[i].answer, b->session->done()[i].answer);
  }
}

TEST_F(SimulatedStudyTest, DeletedParticipantLeavesNothing) {
  const StudyFolder folder = Run("study", 1, KeptRecords::kAll);
  const auto participants = folder.ReadParticipants();
  ASSERT_TRUE(participants);
  std::ofstream(folder.path() / "trials.csv") << MakeTrialsCsv(*participants);
  std::ofstream(folder.path() / "report.html") << *MakeStudyPage(folder, *participants);
  const auto before = ReadFolder(folder.path());
  {
    const auto running = folder.OpenJournal("P02", true);
    ASSERT_TRUE(running) << running.error().ToString();
    const auto refused = folder.Delete("P02");
    ASSERT_FALSE(refused) << "its session runs";
    EXPECT_NE(refused.error().ToString().find("runs the session of this participant"),
              std::string::npos);
    EXPECT_NE(refused.error().where.find("P02.jsonl"), std::string::npos);
    EXPECT_EQ(ReadFolder(folder.path()), before);
  }
  const auto removed = folder.Delete("P02");
  ASSERT_TRUE(removed) << removed.error().ToString();
  EXPECT_EQ(removed->size(), 1 + 2 + 2U);  // journal, records of two trials with sessions, tables
  for (const auto& [name, bytes] : ReadFolder(folder.path())) {
    EXPECT_EQ(name.find("P02"), std::string::npos) << name;
    EXPECT_EQ(bytes.find("P02"), std::string::npos) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "records" / "P02"));
  EXPECT_EQ(folder.ListParticipants(), std::vector<std::string>{"P01"});
  EXPECT_FALSE(folder.Delete("P02"));
  EXPECT_FALSE(folder.Delete("../P01"));
}

TEST_F(SimulatedStudyTest, KeepsRecordsThatCanBeRead) {
  const StudyFolder folder = Run("records", 1, KeptRecords::kLast);
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "records" / "P01")) {
    auto reader = record::Reader::Open(entry.path());
    ASSERT_TRUE(reader) << reader.error().ToString();
    EXPECT_TRUE(reader->is_complete());
    ++count;
  }
  EXPECT_EQ(count, 2);  // nothing moves where constraints are picked
}

TEST_F(SimulatedStudyTest, FolderOfAnotherStudyIsNotTouched) {
  const StudyFolder folder = Run("study", 1);
  EXPECT_FALSE(StudyFolder::Create(folder.path(), MakeTinyProtocol(), 4)) << "another seed";
  std::ofstream(folder.path() / "protocol.yaml", std::ios::app) << "# changed\n";
  const auto changed = StudyFolder::Open(folder.path());
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().remedy.find("another study"), std::string::npos);
}

TEST_F(SimulatedStudyTest, TablesHaveARowATrial) {
  const StudyFolder folder = Run("study", 1);
  const auto participants = folder.ReadParticipants();
  ASSERT_TRUE(participants);
  const std::string csv = MakeTrialsCsv(*participants);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 7);
  const Protocol& protocol = folder.protocol();
  const Table times = MakeTimesTable(protocol, 0, *participants);
  ASSERT_EQ(times.rows.size(), 2U);
  EXPECT_EQ(times.conditions, (std::vector<std::string>{"free", "guided", "mouse"}));
  const auto summary = SummariseTimes(protocol, *participants);
  ASSERT_EQ(summary.size(), 3U);  // not those of identification alone
  EXPECT_NEAR(summary[1].mean, 0.5 * (*times.rows[0].values[1] + *times.rows[1].values[1]), 1e-12);
  EXPECT_EQ(CollectAnswers(protocol, 1, *participants).size(), 8U);
}

TEST(PickingTime, W8HasTheMeanOfTheKeystrokeLevelModel) {  // A1
  // Of two constraints: H + 2 (2 M + 3 P + 3 K), each time lognormal about its median.
  const double sum = 0.4 + 2 * (2 * 1.35 + 3 * 1.1 + 3 * 0.2);
  const double expected = sum * std::exp(0.5 * 0.2 * 0.2);
  Skill skill;
  skill.reaction_s = 0;
  Random random(1);
  constexpr int kDraws = 20000;
  double mean = 0;
  for (int i = 0; i < kDraws; ++i) {
    mean += DrawPickingTime(2, skill, &random) / kDraws;
  }
  EXPECT_NEAR(mean, expected, 0.03);  // five times its standard error, 0.9 s over sqrt(20000)
}

TEST(Skill, DiffersBetweenParticipantsAndIsTheSameAgain) {
  EXPECT_EQ(DrawSkill(3, 1).speed, DrawSkill(3, 1).speed);
  EXPECT_NE(DrawSkill(3, 1).speed, DrawSkill(4, 1).speed);
  EXPECT_NE(DrawSkill(3, 1).speed, DrawSkill(3, 2).speed);
  double mean = 0;
  for (int i = 1; i <= 999; ++i) {
    EXPECT_LE(DrawSkill(i, 1).speed, 1);
    mean += std::log(DrawSkill(i, 1).mouse) / 999;
  }
  EXPECT_NEAR(mean, 0, 0.03);  // of a standard error of 0.2 / sqrt(999)
}

}  // namespace
}  // namespace hvas::study
