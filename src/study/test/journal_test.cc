// Journals survive whatever ends the program (N9).

#include "study/journal.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "base/random.h"
#include "study/study_folder.h"
#include "study/test/tiny_study.h"

namespace hvas::study {
namespace {

using Kind = StudyEvent::Kind;
using testing::ReadAll;

const JournalHead kJournalHead{"P01", "0123", 7, false};

StudyEvent MakeNote(int i) {
  StudyEvent event;
  event.kind = Kind::kNote;
  event.unix_ms = 1'700'000'000'000 + i;
  event.text = "note " + std::to_string(i) + "\twith tab, \"quotes\" and ü\n";
  return event;
}

StudyEvent MakeEnd() {
  StudyEvent event;
  event.kind = Kind::kTrialEnded;
  event.trial = 3;
  event.result.outcome = Outcome::kTimedOut;
  event.result.time = 12.345678901234567;
  event.result.collisions = 4;
  event.result.peak_felt = 3.3;
  event.result.mating = {{-0.01, Vec3(1, 2, 1.0 / 3), Vec3(0, 1e-300, 3)}, {0, {}, {}}};
  return event;
}

void Fill(const std::filesystem::path& file) {
  auto journal = Journal::Open(file, kJournalHead);
  ASSERT_TRUE(journal) << journal.error().ToString();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(journal->Append(MakeNote(i)));
  }
  ASSERT_TRUE(journal->Append(MakeEnd()));
}

void WriteAll(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

class JournalTest : public ::testing::Test {
 protected:
  ScratchFolder folder_ = *ScratchFolder::Make();
  std::filesystem::path file_ = folder_.path() / "P01.jsonl";
};

TEST_F(JournalTest, BringsEverythingBackToTheLastBit) {
  Fill(file_);
  const auto journal = ReadJournal(file_);
  ASSERT_TRUE(journal) << journal.error().ToString();
  EXPECT_EQ(journal->head.seed, 7U);
  ASSERT_EQ(journal->events.size(), 4U);
  EXPECT_EQ(journal->events[1].text, MakeNote(1).text);
  EXPECT_EQ(journal->events[1].unix_ms, MakeNote(1).unix_ms);
  const TrialResult& back = journal->events[3].result;
  const TrialResult want = MakeEnd().result;
  EXPECT_EQ(back.outcome, want.outcome);
  EXPECT_EQ(back.time, want.time);
  EXPECT_EQ(back.collisions, want.collisions);
  ASSERT_EQ(back.mating.size(), 2U);
  EXPECT_EQ(back.mating[0].f, want.mating[0].f);
  EXPECT_EQ(back.mating[0].torque, want.mating[0].torque);
}

TEST_F(JournalTest, CutAnywhereItKeepsAllWholeLinesAndGoesOn) {
  Fill(file_);
  const std::string whole = ReadAll(file_);
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    SCOPED_TRACE(size);
    const std::string cut = whole.substr(0, size);
    WriteAll(file_, cut);
    const auto lines = static_cast<std::size_t>(std::count(cut.begin(), cut.end(), '\n'));
    {
      auto journal = Journal::Open(file_, kJournalHead, /*is_synced=*/false);
      ASSERT_TRUE(journal) << journal.error().ToString();
      ASSERT_EQ(journal->events().size(), lines == 0 ? 0 : lines - 1);
      ASSERT_TRUE(journal->Append(MakeNote(9)));
    }
    const auto again = ReadJournal(file_);
    ASSERT_TRUE(again) << again.error().ToString();
    ASSERT_EQ(again->events.size(), lines == 0 ? 1 : lines);
    ASSERT_EQ(again->events.back().text, MakeNote(9).text);
  }
}

TEST_F(JournalTest, DamagedLineInTheMiddleIsNamed) {
  Fill(file_);
  std::string bytes = ReadAll(file_);
  bytes[bytes.find("note 1")] = 'N';
  WriteAll(file_, bytes);
  const auto journal = ReadJournal(file_);
  ASSERT_FALSE(journal);
  EXPECT_EQ(journal.error().where, file_.string() + ":3");
}

TEST_F(JournalTest, IsOnePersonsAndOneProgramsAtATime) {
  Fill(file_);
  JournalHead other = kJournalHead;
  other.seed = 8;
  EXPECT_FALSE(Journal::Open(file_, other));
  const auto first = Journal::Open(file_, kJournalHead);
  ASSERT_TRUE(first);
  const auto second = Journal::Open(file_, kJournalHead);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("another program"), std::string::npos);
}

TEST_F(JournalTest, KilledAtRandomMomentsItLosesNothingThatWasAppended) {
  Random random(5);
  std::size_t before = 0;
  for (int round = 0; round < 20; ++round) {
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      auto journal = Journal::Open(file_, kJournalHead);
      for (int i = 0; journal && i < 100000; ++i) {
        const char done = 1;
        if (!journal->Append(MakeNote(i)) || ::write(pipe_ends[1], &done, 1) != 1) {
          break;
        }
      }
      ::_exit(0);
    }
    ::close(pipe_ends[1]);
    ::usleep(static_cast<useconds_t>(random.Uniform(1000, 20000)));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    std::size_t told = 0;
    char byte = 0;
    while (::read(pipe_ends[0], &byte, 1) == 1) {
      ++told;
    }
    ::close(pipe_ends[0]);
    const auto journal = Journal::Open(file_, kJournalHead);
    ASSERT_TRUE(journal) << journal.error().ToString();
    ASSERT_GE(journal->events().size(), before + told) << "round " << round;
    ASSERT_LE(journal->events().size(), before + told + 1) << "round " << round;
    before = journal->events().size();
  }
}

}  // namespace
}  // namespace hvas::study
