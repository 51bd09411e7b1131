// What is left of a record after the process was killed or the file was damaged.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "record/ledger.h"
#include "record/reader.h"
#include "record/recorder.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

[[noreturn]] void WaitToBeKilled() {
  for (;;) {
    ::pause();
  }
}

// Runs a recording child, kills it once it has added `kill_after` ticks, and returns how many it
// had added by then. The child waits after `most` ticks: it is killed while it writes nothing.
std::int64_t RecordAndKill(const RecorderOptions& options, std::int64_t kill_after,
                           std::chrono::microseconds pause, std::int64_t most = kNoEnd) {
  using Counter = std::atomic<std::int64_t>;
  static_assert(Counter::is_always_lock_free);
  void* shared =
      ::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  EXPECT_NE(shared, MAP_FAILED);
  auto* added = new (shared) Counter(0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto recorder = Recorder::Create(options, {{"product", "victim"}});
    for (std::int64_t i = 0; recorder; ++i) {
      TickRecord tick = MakeTick(i);
      tick.commands = static_cast<std::uint32_t>(i / 10);
      if (i % 10 == 0) {
        (*recorder)->AddCommand(MakeCommand(i / 10));
      }
      if ((*recorder)->AddTick(tick)) {
        added->store(i + 1);
      }
      if (i + 1 >= most) {
        WaitToBeKilled();
      }
      if (pause.count() > 0) {
        std::this_thread::sleep_for(pause);
      }
    }
    ::_exit(1);
  }
  int status = 0;
  while (added->load() < kill_after && ::waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::yield();
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  const std::int64_t count = added->load();
  ::munmap(shared, sizeof(Counter));
  return count;
}

void ExpectAtMostOneSecondLost(const std::filesystem::path& path, std::int64_t added) {
  Result<Reader> reader = Reader::Open(path);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_FALSE(reader->is_complete());
  EXPECT_EQ(reader->meta().at("product"), "victim");
  ASSERT_TRUE(reader->Verify().has_value());
  const std::vector<TickRecord> ticks = reader->ReadTicks({}).value();
  EXPECT_GE(static_cast<std::int64_t>(ticks.size()) * kTickNs, added * kTickNs - 1'000'000'000);
  EXPECT_LE(static_cast<std::int64_t>(ticks.size()), added + 1);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    ASSERT_EQ(ticks[i].t_ns, static_cast<std::int64_t>(i) * kTickNs) << "no gap";
  }
  if (!ticks.empty()) {
    EXPECT_GT(reader->ReadCommands().value().size(), ticks.back().commands)
        << "what a tick obeyed is there when the tick is";
  }
}

TEST(KilledRecorder, LosesAtMostOneSecondAndNeverTheFile) {
  for (const std::int64_t kill_after : {1, 499, 1250, 3001, 7777, 20000}) {
    SCOPED_TRACE(kill_after);
    const TemporaryFile file("killed.hvas");
    const std::int64_t added = RecordAndKill({file.path()}, kill_after, {});
    ASSERT_GE(added, kill_after);
    ExpectAtMostOneSecondLost(file.path(), added);
  }
}

TEST(KilledRecorder, LosesAtMostOneSecondWhenThreadedInRealTime) {
  const TemporaryFile file("killed_threaded.hvas");
  // A millisecond of session a millisecond: sleeping takes a little longer than asked.
  const std::int64_t added =
      RecordAndKill({file.path(), true}, 1500, std::chrono::microseconds(900));
  ExpectAtMostOneSecondLost(file.path(), added);
  EXPECT_GT(Reader::Open(file.path())->tick_count(), 500);
}

// A power cut may leave any beginning of the journal, whose end was not on the disk yet.
TEST(KilledRecorder, OpensWithWhateverIsLeftOfItsJournal) {
  const TemporaryFile file("power.hvas");
  const std::int64_t added = RecordAndKill({file.path()}, 3000, {});
  const std::filesystem::path journal = file.path().string() + "-wal";
  const auto whole = static_cast<std::int64_t>(std::filesystem::file_size(journal));
  const TemporaryFile copy("copy.hvas");
  std::int64_t most = 0;
  constexpr int kPlaces = 40;
  for (int i = 0; i <= kPlaces; ++i) {
    SCOPED_TRACE(i);
    std::filesystem::remove(copy.path().string() + "-shm");
    constexpr auto kOver = std::filesystem::copy_options::overwrite_existing;
    std::filesystem::copy_file(file.path(), copy.path(), kOver);
    std::filesystem::copy_file(journal, copy.path().string() + "-wal", kOver);
    std::filesystem::resize_file(copy.path().string() + "-wal",
                                 static_cast<std::uintmax_t>(whole * i / kPlaces));
    Result<Reader> reader = Reader::Open(copy.path());
    if (!reader) {  // cut before the first transaction: an empty database
      EXPECT_EQ(reader.error().code, ErrorCode::kUnreadable);
      EXPECT_LT(i, kPlaces / 4);
      continue;
    }
    EXPECT_TRUE(reader->Verify().has_value());
    EXPECT_GE(reader->tick_count(), most) << "the more is left, the more is read";
    most = reader->tick_count();
  }
  EXPECT_GE(most, added - 1000);
}

// A disk that is full, as a limit on the size of files: what was written is whole.
TEST(KilledRecorder, LosesAtMostOneSecondWhenTheDiskIsFull) {
  const TemporaryFile file("full.hvas");
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1 << 20, 1 << 20};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    auto recorder = Recorder::Create({file.path()}, {{"product", "victim"}});
    std::int64_t i = 0;
    while (recorder && !(*recorder)->error() && i < 100'000) {
      (*recorder)->AddTick(MakeTick(i++));
    }
    const bool has_failed = recorder && !(*recorder)->Finish() &&
                            (*recorder)->error()->code == ErrorCode::kOutOfResource;
    ::_exit(has_failed && i > 1000 && i < 5000 ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0) << "the failure was not told, or came when there was room";
  Reader reader = Reader::Open(file.path()).value();
  EXPECT_TRUE(reader.Verify().has_value());
  EXPECT_GT(reader.tick_count(), 1000);
}

/** Does something as a user who may not write to the folder of a file. @returns its outcome. */
bool DoWithoutRights(const std::filesystem::path& file, const std::function<bool()>& act) {
  const std::filesystem::path folder = file.parent_path();
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::filesystem::permissions(entry.path(), std::filesystem::perms(0444));
  }
  const auto before = std::filesystem::status(folder).permissions();
  std::filesystem::permissions(folder, std::filesystem::perms(0555));
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    const bool is_without = ::geteuid() != 0 || ::setuid(kNobody) == 0;
    ::_exit(is_without && ::access(folder.c_str(), W_OK) != 0 && act() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  std::filesystem::permissions(folder, before);
  return status == 0;
}

TEST(KilledRecorder, LeavesWhatCanBeReadFromAFolderThatMayNotBeWritten) {
  for (const bool has_journal : {true, false}) {
    SCOPED_TRACE(has_journal);
    const TemporaryFile file("killed read-only %.hvas");
    // Without its journal, a file is whole only between two moves of the journal into it.
    const std::int64_t added =
        RecordAndKill({file.path()}, 2500, std::chrono::microseconds(500), 2500);
    if (!has_journal) {
      std::filesystem::remove(file.path().string() + "-wal");
    }
    std::filesystem::remove(file.path().string() + "-shm");
    EXPECT_TRUE(DoWithoutRights(file.path(), [&] {
      auto reader = Reader::Open(file.path());
      const std::int64_t least = has_journal ? added - 1000 : 1;
      return reader && reader->Verify() && reader->tick_count() >= least;
    }));
  }
}

TEST(RecorderFile, IsForItsOwnerOnly) {
  const TemporaryFile file("mine.hvas");
  const auto recorder = Recorder::Create({file.path()}, {});
  (*recorder)->AddTick(MakeTick(0));
  for (const auto& entry : std::filesystem::directory_iterator(file.path().parent_path())) {
    EXPECT_EQ(entry.status().permissions(), std::filesystem::perms(0600)) << entry.path();
  }
}

TEST(RecorderFile, IsNotReplacedUnlessAskedForAndNeverWhileItIsWritten) {
  const TemporaryFile file("taken.hvas");
  auto first = Recorder::Create({file.path()}, {{"product", "first"}});
  ASSERT_TRUE(first.has_value());
  for (const bool replaces : {false, true}) {
    const auto second = Recorder::Create({.path = file.path(), .replaces = replaces}, {});
    ASSERT_FALSE(second.has_value()) << replaces;
    EXPECT_EQ(second.error().code, ErrorCode::kInvalid);
    EXPECT_NE(second.error().message.find("is being recorded"), std::string::npos);
  }
  (*first)->AddTick(MakeTick(0));
  ASSERT_TRUE((*first)->Finish().has_value());
  EXPECT_EQ(Reader::Open(file.path())->meta().at("product"), "first");

  const auto unasked = Recorder::Create({.path = file.path()}, {});
  ASSERT_FALSE(unasked.has_value());
  EXPECT_EQ(unasked.error().code, ErrorCode::kInvalid);
  const auto asked = Recorder::Create({.path = file.path(), .replaces = true}, {});
  ASSERT_TRUE(asked.has_value()) << asked.error().ToString();
}

TEST(RecorderFile, ThatCannotBeReplacedIsKeptAndTheReasonIsTold) {
  namespace fs = std::filesystem;
  const TemporaryFile file("kept.hvas");
  {
    const auto first = Recorder::Create({file.path()}, {});
    (*first)->AddTick(MakeTick(0));
    ASSERT_TRUE((*first)->Finish().has_value());
  }
  const fs::path folder = file.path().parent_path();
  fs::permissions(folder, fs::perms(0555));
  fs::permissions(file.path(), fs::perms(0644));
  const auto replace = [&file] {
    if (::geteuid() == 0 && ::setuid(65534) != 0) {  // Everything is allowed to root.
      std::exit(2);
    }
    const auto second = Recorder::Create({.path = file.path(), .replaces = true}, {});
    std::fputs(second ? "replaced" : second.error().message.c_str(), stderr);
    std::exit(0);
  };
  EXPECT_EXIT(replace(), ::testing::ExitedWithCode(0), "cannot be made: Permission denied");
  fs::permissions(folder, fs::perms(0700));
  EXPECT_TRUE(Reader::Open(file.path())->Verify().has_value());
}

TEST(RecorderFile, OfTwoThatBeginAtOnceOnlyOneIsWritten) {
  for (int round = 0; round < 20; ++round) {
    const TemporaryFile file("both.hvas");
    std::array<std::unique_ptr<Recorder>, 2> recorders;
    std::array<std::thread, 2> threads;
    for (std::size_t i = 0; i < 2; ++i) {
      threads[i] = std::thread([&, i] {
        if (auto made = Recorder::Create({.path = file.path(), .replaces = round % 2 == 0}, {})) {
          recorders[i] = std::move(*made);
        }
      });
    }
    for (std::thread& thread : threads) {
      thread.join();
    }
    int finished = 0;
    for (const auto& recorder : recorders) {
      if (recorder != nullptr) {
        recorder->AddTick(MakeTick(0));
        finished += recorder->Finish() ? 1 : 0;
      }
    }
    EXPECT_EQ(finished, 1);
    EXPECT_TRUE(Reader::Open(file.path())->Verify().has_value());
  }
}

TEST(RecorderFile, ThatVanishesIsMissedWithinASecondAndTheDigestGoesOn) {
  for (const bool is_folder : {false, true}) {
    SCOPED_TRACE(is_folder);
    const TemporaryFile file("vanished.hvas");
    std::vector<std::string> told;
    RecorderOptions options;
    options.path = file.path();
    options.on_error = [&](const Error& error) { told.push_back(error.message); };
    const auto recorder = Recorder::Create(options, {});
    ASSERT_TRUE(recorder.has_value());
    std::int64_t i = 0;
    for (; i < 700; ++i) {
      (*recorder)->AddTick(MakeTick(i));
    }
    EXPECT_TRUE(told.empty());
    if (is_folder) {
      std::filesystem::remove_all(file.path().parent_path());
    } else {
      std::filesystem::remove(file.path());
    }
    for (; i < 1700; ++i) {
      (*recorder)->AddTick(MakeTick(i));
    }
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("removed"), std::string::npos) << told[0];
    EXPECT_FALSE((*recorder)->Finish().has_value());
    EXPECT_EQ((*recorder)->tick_count(), i);
  }
}

// Runs SQL on a record behind HVAS' back.
void Tamper(const std::filesystem::path& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_GE(sqlite3_changes(database), 1);
  sqlite3_close(database);
}

class DamagedRecord : public ::testing::Test {
 protected:
  DamagedRecord() : file_("damaged.hvas") {
    // Five chunks, of half a second each but the last.
    WriteSampleRecord(file_.path(), {{"seed", "7"}, {"condition", "hybrid"}}, 2300);
  }

  TemporaryFile file_;
};

TEST_F(DamagedRecord, ChunkIsFoundAndWhatIsBeforeItCanBeRead) {
  Tamper(file_.path(), "UPDATE chunk SET ticks = zeroblob(length(ticks)) WHERE id = 3");
  Reader reader = Reader::Open(file_.path()).value();
  int visited = 0;
  const Result<void> done =
      reader.ForEachTick({}, [&](const TickRecord&) { return ++visited > 0; });
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(done.error().message.find("Chunk 3"), std::string::npos);
  EXPECT_EQ(visited, 2 * 501) << "ticks of two chunks";
  EXPECT_FALSE(reader.Verify().has_value());
}

/** Flips a bit of a byte of a file. */
void FlipBit(const std::filesystem::path& path, std::streamoff at) {
  std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(at);
  const int byte = stream.get();
  stream.seekp(at);
  stream.put(static_cast<char>(byte ^ 0x10));
}

TEST_F(DamagedRecord, FlippedByteInTheFileIsFound) {
  // All over the tick data, past the first pages. A byte of a page that nothing is kept in does not
  // matter; there are few.
  constexpr int kPlaces = 40;
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file_.path()));
  int found = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const std::streamoff at = size / 4 + i * (size / 2) / kPlaces;
    FlipBit(file_.path(), at);
    auto reader = Reader::Open(file_.path());
    found += !reader || !reader->Verify() ? 1 : 0;
    FlipBit(file_.path(), at);
  }
  EXPECT_GE(found, kPlaces - kPlaces / 8) << "of " << kPlaces;
  EXPECT_TRUE(Reader::Open(file_.path())->Verify().has_value()) << "as it was before";
}

TEST_F(DamagedRecord, EventIsFound) {
  Tamper(file_.path(), "UPDATE event SET json = '{}' WHERE id = 2");
  const auto events = Reader::Open(file_.path())->ReadEvents();
  ASSERT_FALSE(events.has_value());
  EXPECT_NE(events.error().message.find("Event 2"), std::string::npos);
}

TEST_F(DamagedRecord, CommandFrameAndAttachmentAreFound) {
  Tamper(file_.path(), "UPDATE command SET number = 7 WHERE id = 3");
  Tamper(file_.path(), "UPDATE frame SET bytes = zeroblob(length(bytes)) WHERE id = 1");
  Tamper(file_.path(), "UPDATE attachment SET bytes = zeroblob(length(bytes))");
  Reader reader = Reader::Open(file_.path()).value();
  EXPECT_NE(reader.ReadCommands().error().message.find("Command 3"), std::string::npos);
  const auto frames = reader.ForEachFrame({}, [](const Frame&) { return true; });
  EXPECT_NE(frames.error().message.find("Frame 1"), std::string::npos);
  EXPECT_NE(reader.ReadAttachment("product").error().message.find("product"), std::string::npos);
  EXPECT_FALSE(reader.Verify().has_value());
}

TEST_F(DamagedRecord, WhateverIsGoneOrOtherwiseIsFoundAndNamed) {
  struct Case {
    const char* sql;
    const char* named;
  };

  constexpr std::array kCases{
      Case{"DELETE FROM chunk WHERE id = 2", "chunk 2, before the one at 1.002 s, is missing"},
      Case{"DELETE FROM chunk WHERE id = 5", "the last chunk"},
      Case{"DELETE FROM chunk WHERE id >= 3", "the last 3 of 5 chunks"},
      Case{"DELETE FROM chunk", "the last 5 of 5 chunks"},
      Case{"UPDATE chunk SET first_t_ns = 1 WHERE id = 2", "chunk 2 was changed"},
      Case{"UPDATE chunk SET id = id + 10", "chunk 1"},
      Case{"DELETE FROM event", "the last 3 of 3 events"},
      Case{"DELETE FROM event WHERE id = 1", "event 1"},
      Case{"DELETE FROM event WHERE id = 3", "the last event"},
      Case{"INSERT INTO event SELECT 4, t_ns, kind, occurrence, json, checksum FROM event "
           "WHERE id = 3",
           "event 4, at 0.002 s, was added"},
      Case{"DELETE FROM command WHERE id = 3", "the last command"},
      Case{"DELETE FROM frame", "frames"},
      Case{"UPDATE frame SET t_ns = t_ns + 1 WHERE id = 2", "frame 1 to 3"},
      Case{"DELETE FROM attachment", "attachment \"product\" is missing"},
      Case{"UPDATE attachment SET name = 'other'", "attachment \"product\" is missing"},
      Case{"UPDATE meta SET value = '8' WHERE key = 'seed'", "meta entry \"seed\" was changed"},
      Case{"UPDATE meta SET value = 'x' WHERE key = 'condition'", "\"condition\" was changed"},
      Case{"UPDATE meta SET value = 'x' WHERE key = 'digest'", "\"digest\" was changed"},
      Case{"DELETE FROM meta WHERE key = 'digest'", "\"digest\" is missing"},
      Case{"DELETE FROM meta", "is missing"},
      Case{"INSERT INTO meta VALUES ('a', 'b')", "meta entry \"a\" was added"},
      Case{"DELETE FROM seal", "all seals"},
      Case{"DELETE FROM seal WHERE id = 1", "seal 1"},
      Case{"DELETE FROM seal WHERE is_last = 1", "was added"},
      Case{"UPDATE seal SET t_ns = 0 WHERE is_last = 1", "was changed"},
  };
  const TemporaryFile copy("copy.hvas");
  for (const Case& tampered : kCases) {
    SCOPED_TRACE(tampered.sql);
    std::filesystem::copy_file(file_.path(), copy.path(),
                               std::filesystem::copy_options::overwrite_existing);
    ASSERT_TRUE(Reader::Open(copy.path())->Verify().has_value());
    Tamper(copy.path(), tampered.sql);
    const auto verified = Reader::Open(copy.path())->Verify();
    ASSERT_FALSE(verified.has_value());
    EXPECT_EQ(verified.error().code, ErrorCode::kUnreadable);
    EXPECT_NE(verified.error().message.find(tampered.named), std::string::npos)
        << verified.error().message;
  }
}

/** Adds a seal that is as valid as any, with the hash of its own, after the newest one. */
void AddSeal(const std::filesystem::path& path) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  sqlite3_stmt* newest = nullptr;
  ASSERT_EQ(
      sqlite3_prepare_v2(database,
                         "SELECT id, t_ns, hash, chunks, chunk_hash, events, event_hash, commands, "
                         "command_hash, frames, frame_hash FROM seal ORDER BY id DESC LIMIT 1",
                         -1, &newest, nullptr),
      SQLITE_OK);
  ASSERT_EQ(sqlite3_step(newest), SQLITE_ROW);
  Seal seal;
  seal.t_ns = sqlite3_column_int64(newest, 1);
  int column = 3;
  for (Ledger::Rows& rows : seal.rows) {
    rows.count = sqlite3_column_int64(newest, column++);
    rows.hash = sqlite3_column_int64(newest, column++);
  }
  const std::int64_t id = sqlite3_column_int64(newest, 0);
  const std::int64_t hash = CalcHash(seal, sqlite3_column_int64(newest, 2));
  sqlite3_finalize(newest);
  sqlite3_close(database);
  Tamper(path, ("INSERT INTO seal (id, t_ns, is_last, chunks, chunk_hash, events, event_hash, "
                "commands, command_hash, frames, frame_hash, entries, hash) SELECT id + 1, t_ns, "
                "0, chunks, chunk_hash, events, event_hash, commands, command_hash, frames, "
                "frame_hash, '', " +
                std::to_string(hash) + " FROM seal WHERE id = " + std::to_string(id))
                   .c_str());
}

TEST_F(DamagedRecord, ValidSealAfterTheLastOneIsFound) {
  AddSeal(file_.path());
  const auto verified = Reader::Open(file_.path())->Verify();
  ASSERT_FALSE(verified.has_value());
  EXPECT_NE(verified.error().message.find("was added after the last one"), std::string::npos)
      << verified.error().message;
}

// A record that ended by itself may be sealed on; there the seal is in the chain of the others.
TEST(KilledRecorder, LeavesARecordToWhichAValidSealBelongs) {
  const TemporaryFile file("sealed on.hvas");
  RecordAndKill({file.path()}, 2000, {});
  ASSERT_TRUE(Reader::Open(file.path())->Verify().has_value());
  AddSeal(file.path());
  const auto verified = Reader::Open(file.path())->Verify();
  EXPECT_TRUE(verified.has_value()) << verified.error().ToString();
}

TEST_F(DamagedRecord, NewerLayoutIsRefusedWithItsNumber) {
  Tamper(file_.path(), "UPDATE schema_version SET version = 99");
  const auto reader = Reader::Open(file_.path());
  ASSERT_FALSE(reader.has_value());
  EXPECT_EQ(reader.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(reader.error().message.find("99"), std::string::npos);
}

TEST(ReaderError, TellsAMissingFileFromAWrongOne) {
  const auto missing = Reader::Open("/nonexistent/session.hvas");
  ASSERT_FALSE(missing.has_value());
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);

  const TemporaryFile text("text.hvas");
  std::ofstream(text.path()) << std::string(5000, 'x');
  const auto wrong = Reader::Open(text.path());
  ASSERT_FALSE(wrong.has_value());
  EXPECT_EQ(wrong.error().code, ErrorCode::kUnreadable);

  const TemporaryFile other("other.sqlite");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(other.path().c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "CREATE TABLE t (x)", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  const auto foreign = Reader::Open(other.path());
  ASSERT_FALSE(foreign.has_value());
  EXPECT_EQ(foreign.error().code, ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace hvas::record
