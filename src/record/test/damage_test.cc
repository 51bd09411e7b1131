// What is left of a record after the process was killed or the file was damaged.

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "record/reader.h"
#include "record/recorder.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

// Runs a recording child, kills it once it has added `kill_after` ticks, and returns how many it
// had added by then.
std::int64_t RecordAndKill(const RecorderOptions& options, std::int64_t kill_after,
                           std::chrono::microseconds pause) {
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

// Runs SQL on a record behind HVAS' back.
void Tamper(const std::filesystem::path& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(sqlite3_changes(database), 1);
  sqlite3_close(database);
}

class DamagedRecord : public ::testing::Test {
 protected:
  DamagedRecord() : file("damaged.hvas") {
    const auto recorder = Recorder::Create({file.path()}, {});
    for (int i = 0; i < 1000; ++i) {
      (*recorder)->AddTick(MakeTick(i));
    }
    for (int i = 0; i < 3; ++i) {
      (*recorder)->AddEvent(MakeEvent(i));
      (*recorder)->AddCommand(MakeCommand(i));
      (*recorder)->AddFrame(MakeFrame(i));
    }
    (*recorder)->AddAttachment({"product", MakeBytes(1, 1000)});
    EXPECT_TRUE((*recorder)->Finish().has_value());
  }

  TemporaryFile file;
};

TEST_F(DamagedRecord, ChunkIsFoundAndWhatIsBeforeItCanBeRead) {
  Tamper(file.path(), "UPDATE chunk SET ticks = zeroblob(length(ticks)) WHERE id = 3");
  Reader reader = Reader::Open(file.path()).value();
  int visited = 0;
  const Result<void> done =
      reader.ForEachTick({}, [&](const TickRecord&) { return ++visited > 0; });
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(done.error().message.find("Chunk 3"), std::string::npos);
  EXPECT_EQ(visited, 500);
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
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file.path()));
  int found = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const std::streamoff at = size / 4 + i * (size / 2) / kPlaces;
    FlipBit(file.path(), at);
    auto reader = Reader::Open(file.path());
    found += !reader || !reader->Verify() ? 1 : 0;
    FlipBit(file.path(), at);
  }
  EXPECT_GE(found, kPlaces - kPlaces / 8) << "of " << kPlaces;
  EXPECT_TRUE(Reader::Open(file.path())->Verify().has_value()) << "as it was before";
}

TEST_F(DamagedRecord, EventIsFound) {
  Tamper(file.path(), "UPDATE event SET json = '{}' WHERE id = 2");
  const auto events = Reader::Open(file.path())->ReadEvents();
  ASSERT_FALSE(events.has_value());
  EXPECT_NE(events.error().message.find("Event 2"), std::string::npos);
}

TEST_F(DamagedRecord, CommandFrameAndAttachmentAreFound) {
  Tamper(file.path(), "UPDATE command SET number = 7 WHERE id = 3");
  Tamper(file.path(), "UPDATE frame SET bytes = zeroblob(length(bytes)) WHERE id = 1");
  Tamper(file.path(), "UPDATE attachment SET bytes = zeroblob(length(bytes))");
  Reader reader = Reader::Open(file.path()).value();
  EXPECT_NE(reader.ReadCommands().error().message.find("Command 3"), std::string::npos);
  const auto frames = reader.ForEachFrame({}, [](const Frame&) { return true; });
  EXPECT_NE(frames.error().message.find("Frame 1"), std::string::npos);
  EXPECT_NE(reader.ReadAttachment("product").error().message.find("product"), std::string::npos);
  EXPECT_FALSE(reader.Verify().has_value());
}

TEST_F(DamagedRecord, MissingChunkIsFoundByTheDigest) {
  Tamper(file.path(), "DELETE FROM chunk WHERE id = 2");
  const auto verified = Reader::Open(file.path())->Verify();
  ASSERT_FALSE(verified.has_value());
  EXPECT_EQ(verified.error().code, ErrorCode::kUnreadable);
}

TEST_F(DamagedRecord, NewerLayoutIsRefusedWithItsNumber) {
  Tamper(file.path(), "UPDATE schema_version SET version = 99");
  const auto reader = Reader::Open(file.path());
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
