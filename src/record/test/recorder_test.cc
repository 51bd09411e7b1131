#include "record/recorder.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "record/packing.h"
#include "record/reader.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

constexpr int kTicks = 1234;  // Not a multiple of the chunk.

std::unique_ptr<Recorder> MakeRecorder(const RecorderOptions& options, const Meta& meta = {}) {
  Result<std::unique_ptr<Recorder>> recorder = Recorder::Create(options, meta);
  EXPECT_TRUE(recorder.has_value()) << recorder.error().ToString();
  return std::move(*recorder);
}

void Fill(Recorder* recorder, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    while (!recorder->AddTick(MakeTick(i))) {
      std::this_thread::yield();
    }
    if (i % 100 == 0) {
      recorder->AddEvent(MakeEvent(i));
      recorder->AddCommand(MakeCommand(i));
      recorder->AddFrame(MakeFrame(i));
    }
  }
}

std::string DigestOf(const std::function<void(Recorder*)>& fill) {
  const std::unique_ptr<Recorder> recorder = MakeRecorder({});
  fill(recorder.get());
  EXPECT_TRUE(recorder->Finish().has_value());
  return recorder->Digest();
}

bool IsSame(const TickRecord& a, const TickRecord& b) {
  std::array<std::byte, kPackedTickSize> bytes_a{};
  std::array<std::byte, kPackedTickSize> bytes_b{};
  Pack(a, bytes_a);
  Pack(b, bytes_b);
  return bytes_a == bytes_b;
}

class RecorderRoundTrip : public ::testing::TestWithParam<bool> {};

TEST_P(RecorderRoundTrip, ReadsBackWhatWasAdded) {
  const TemporaryFile file(GetParam() ? "threaded.hvas" : "plain.hvas");
  const Meta meta{{"product", "gear pump"}, {"seed", "7"}, {"model", R"({"a": [1, 2]})"}};
  const std::unique_ptr<Recorder> recorder = MakeRecorder({file.path(), GetParam()}, meta);
  Fill(recorder.get(), kTicks);
  ASSERT_TRUE(recorder->Finish().has_value());
  // The same ticks can only be refused when the ring was full, and then they were offered again.
  EXPECT_EQ(recorder->tick_count(), kTicks);

  Result<Reader> reader = Reader::Open(file.path());
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->tick_count(), kTicks);
  for (const auto& [key, value] : meta) {
    EXPECT_EQ(reader->meta().at(key), value);
  }
  EXPECT_GT(std::stoll(reader->meta().at(kMetaStarted)), 1'600'000'000'000'000'000);
  EXPECT_EQ(reader->meta().at(kMetaDigest), recorder->Digest());
  EXPECT_EQ(reader->Verify().value(), recorder->Digest());

  const std::vector<TickRecord> ticks = reader->ReadTicks({}).value();
  ASSERT_EQ(ticks.size(), static_cast<std::size_t>(kTicks));
  for (int i = 0; i < kTicks; ++i) {
    ASSERT_TRUE(IsSame(ticks[static_cast<std::size_t>(i)], MakeTick(i))) << i;
  }
  const std::vector<Event> events = reader->ReadEvents().value();
  ASSERT_EQ(events.size(), 13u);
  for (int i = 0; i < 13; ++i) {
    const Event& event = events[static_cast<std::size_t>(i)];
    const Event expected = MakeEvent(std::int64_t{100} * i);
    EXPECT_EQ(event.t_ns, expected.t_ns);
    EXPECT_EQ(event.kind, expected.kind);
    EXPECT_EQ(event.occurrence, expected.occurrence);
    EXPECT_EQ(event.json, expected.json);
  }
}

TEST_P(RecorderRoundTrip, ReadsBackWhatGoesWithTheTicks) {
  const TemporaryFile file("with.hvas");
  const std::unique_ptr<Recorder> recorder = MakeRecorder({file.path(), GetParam()});
  recorder->AddAttachment({"product", MakeBytes(1, 100)});
  recorder->AddAttachment({"model.glb", MakeBytes(2, 300'000)});
  Fill(recorder.get(), kTicks);
  recorder->AddAttachment({"product", MakeBytes(3, 50)});
  ASSERT_TRUE(recorder->Finish().has_value());

  Reader reader = Reader::Open(file.path()).value();
  EXPECT_EQ(reader.Verify().value(), recorder->Digest());
  const std::vector<Command> commands = reader.ReadCommands().value();
  ASSERT_EQ(commands.size(), 13u);
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const Command expected = MakeCommand(std::int64_t{100} * static_cast<std::int64_t>(i));
    EXPECT_EQ(commands[i].t_ns, expected.t_ns);
    EXPECT_EQ(commands[i].number, expected.number);
    EXPECT_EQ(commands[i].kind, expected.kind);
    EXPECT_EQ(commands[i].json, expected.json);
  }
  std::int64_t number = 200;
  const Result<void> done =
      reader.ForEachFrame({200 * kTickNs, 1100 * kTickNs}, [&](const Frame& frame) {
        EXPECT_EQ(frame.t_ns, number * kTickNs);
        EXPECT_EQ(frame.bytes, MakeFrame(number).bytes);
        number += 100;
        return number <= 900;
      });
  EXPECT_TRUE(done.has_value());
  EXPECT_EQ(number, 1000) << "from the span's beginning until the visitor has enough";
  EXPECT_EQ(reader.ListAttachments().value(), (std::vector<std::string>{"model.glb", "product"}));
  EXPECT_EQ(reader.ReadAttachment("product").value(), MakeBytes(3, 50));
  EXPECT_EQ(reader.ReadAttachment("model.glb").value(), MakeBytes(2, 300'000));
  EXPECT_EQ(reader.ReadAttachment("scene.json").error().code, ErrorCode::kNotFound);
}

INSTANTIATE_TEST_SUITE_P(Modes, RecorderRoundTrip, ::testing::Bool());

TEST(Recorder, LeavesASingleFile) {
  const TemporaryFile file("single.hvas");
  Fill(MakeRecorder({file.path()}).get(), 300);
  EXPECT_TRUE(std::filesystem::exists(file.path()));
  EXPECT_FALSE(std::filesystem::exists(file.path().string() + "-wal"));
  EXPECT_FALSE(std::filesystem::exists(file.path().string() + "-shm"));
}

TEST(Reader, GivesTheTicksOfASpanOfTime) {
  const TemporaryFile file("span.hvas");
  Fill(MakeRecorder({file.path()}).get(), kTicks);
  Reader reader = Reader::Open(file.path()).value();
  const std::vector<TickRecord> ticks = reader.ReadTicks({240 * kTickNs, 260 * kTickNs}).value();
  ASSERT_EQ(ticks.size(), 21u) << "both ends belong to the span";
  EXPECT_EQ(ticks.front().t_ns, 240 * kTickNs);
  EXPECT_EQ(ticks.back().t_ns, 260 * kTickNs);
  int visited = 0;
  ASSERT_TRUE(reader.ForEachTick({}, [&](const TickRecord&) { return ++visited < 5; }).has_value());
  EXPECT_EQ(visited, 5);
}

// A file that HVAS wrote when that was its schema, and its digest as it printed it then.
TEST(Reader, ReadsARecordOfSchemaOne) {
  Result<Reader> reader = Reader::Open(HVAS_RECORD_OF_SCHEMA_1);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->Verify().value(), "f856f6c28b07ec3ca372606ceaf4ddee");
  const std::vector<TickRecord> ticks = reader->ReadTicks({10 * kTickNs, 19 * kTickNs}).value();
  ASSERT_EQ(ticks.size(), 10u);
  for (const TickRecord& tick : ticks) {
    EXPECT_EQ(tick.hand, 0);
    EXPECT_EQ(tick.held, kNoOccurrence);
    EXPECT_NEAR(tick.device_pose.q().norm(), 1, 1e-12);
    EXPECT_TRUE(std::isnan(tick.device_grip));
  }
  EXPECT_EQ(reader->ReadEvents().value().front().kind, "energy");
}

// The same of schema 2: two hands, and all that their devices told.
TEST(Reader, ReadsARecordOfSchemaTwo) {
  Result<Reader> reader = Reader::Open(HVAS_RECORD_OF_SCHEMA_2);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->schema(), 2);
  EXPECT_EQ(reader->Verify().value(), "3d267eab06c5d8eca1e4b6827313ae5b");
  const std::vector<TickRecord> ticks = reader->ReadTicks({10 * kTickNs, 19 * kTickNs}).value();
  ASSERT_EQ(ticks.size(), 20u);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    EXPECT_EQ(ticks[i].hand, i % 2);
    EXPECT_GT(ticks[i].sample_ns, 0);
    EXPECT_EQ(ticks[i].commands, 0u);
  }
  EXPECT_TRUE(reader->ReadCommands().value().empty());
  EXPECT_TRUE(reader->ListAttachments().value().empty());
  EXPECT_TRUE(reader->ForEachFrame({}, [](const Frame&) { return true; }).has_value());
}

// Ticks that are compressed byte by byte, with commands and attachments.
TEST(Reader, ReadsARecordOfSchemaThree) {
  Result<Reader> reader = Reader::Open(HVAS_RECORD_OF_SCHEMA_3);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->schema(), 3);
  EXPECT_EQ(reader->Verify().value(), "c35f3f7da5b8d74220b70b324954ab13");
  EXPECT_EQ(reader->ReadCommands().value().front().kind, "begin");
  EXPECT_FALSE(reader->ReadAttachment("product").value().empty());
}

// With seals.
TEST(Reader, ReadsARecordOfSchemaFour) {
  Result<Reader> reader = Reader::Open(HVAS_RECORD_OF_SCHEMA_4);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_TRUE(reader->is_complete());
  EXPECT_EQ(reader->schema(), 4);
  EXPECT_EQ(reader->Verify().value(), "e9308775532cd94515ad627472e58d03");
  EXPECT_EQ(reader->ReadTicks({}).value().size(), 300u);
  EXPECT_EQ(reader->ReadCommands().value().front().kind, "begin");
}

// Its ticks are not in steps.
TEST(Reader, ReadsARecordOfSchemaFive) {
  Result<Reader> reader = Reader::Open(HVAS_RECORD_OF_SCHEMA_5);
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  EXPECT_EQ(reader->schema(), 5);
  EXPECT_EQ(reader->Verify().value(), "e9308775532cd94515ad627472e58d03");
  EXPECT_EQ(reader->ReadTicks({}).value().size(), 300u);
}

TEST(Reader, ReadsASessionWhileItIsRecorded) {
  const TemporaryFile file("live.hvas");
  const std::unique_ptr<Recorder> recorder = MakeRecorder({file.path(), true});
  std::atomic<bool> is_done{false};
  std::thread session([&] {
    for (int i = 0; !is_done; ++i) {
      recorder->AddTick(MakeTick(i));
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  });
  Reader reader = Reader::Open(file.path()).value();
  std::int64_t before = reader.tick_count();
  for (int seen = 0; seen < 3;) {
    ASSERT_TRUE(reader.Refresh().has_value());
    seen += reader.tick_count() > before ? 1 : 0;
    before = std::max(before, reader.tick_count());
    EXPECT_TRUE(reader.Verify().has_value());
    const std::vector<TickRecord> ticks = reader.ReadTicks({}).value();
    for (std::size_t i = 1; i < ticks.size(); ++i) {
      ASSERT_EQ(ticks[i].t_ns - ticks[i - 1].t_ns, kTickNs);
    }
  }
  EXPECT_FALSE(reader.is_complete());
  is_done = true;
  session.join();
  ASSERT_TRUE(recorder->Finish().has_value()) << "although somebody reads";
  EXPECT_EQ(reader.Verify().value(), recorder->Digest());
  EXPECT_TRUE(reader.is_complete());
  EXPECT_EQ(recorder->dropped_ticks(), 0u);
}

TEST(Recorder, CountsFramesThatFoundNoRoom) {
  const TemporaryFile file("frames.hvas");
  RecorderOptions options;
  options.path = file.path();
  options.is_threaded = true;
  options.waiting_frame_bytes = 1000;
  const std::unique_ptr<Recorder> recorder = MakeRecorder(options);
  std::uint64_t refused = 0;
  constexpr int kBurst = 2000;  // of 200 bytes and more, in far less than the writer's pause
  for (int i = 0; i < kBurst; ++i) {
    refused += recorder->AddFrame(MakeFrame(i)) ? 0 : 1;
  }
  ASSERT_TRUE(recorder->Finish().has_value());
  EXPECT_GT(refused, 0u);
  EXPECT_EQ(recorder->dropped_frames(), refused);
  Reader reader = Reader::Open(file.path()).value();
  EXPECT_EQ(reader.meta().at(kMetaDroppedFrames), std::to_string(refused));
  std::uint64_t kept = 0;
  ASSERT_TRUE(reader.ForEachFrame({}, [&](const Frame&) { return ++kept > 0; }).has_value());
  EXPECT_EQ(kept + refused, kBurst);
}

TEST(Recorder, KeepsAFrameThatJustFillsTheRoomAndNoLargerOne) {
  for (const bool is_larger : {false, true}) {
    RecorderOptions options;
    options.is_threaded = true;
    options.waiting_frame_bytes = 1000;
    const std::unique_ptr<Recorder> recorder = MakeRecorder(options);
    EXPECT_EQ(recorder->AddFrame({0, MakeBytes(1, is_larger ? 1001 : 1000)}), !is_larger);
    ASSERT_TRUE(recorder->Finish().has_value());
    EXPECT_EQ(recorder->dropped_frames(), is_larger ? 1U : 0U);
  }
}

// N7, and the digest by which two runs of one seed are compared.
TEST(RecorderDigest, IsEqualForEqualSessionsHoweverTheyAreRecorded) {
  const TemporaryFile file("digest.hvas");
  const TemporaryFile threaded_file("digest_threaded.hvas");
  const std::string digest = DigestOf([](Recorder* r) { Fill(r, kTicks); });
  EXPECT_EQ(digest, DigestOf([](Recorder* r) { Fill(r, kTicks); }));

  const std::unique_ptr<Recorder> plain = MakeRecorder({file.path()}, {{"seed", "1"}});
  Fill(plain.get(), kTicks);
  EXPECT_EQ(plain->Digest(), digest) << "before the end, too";
  ASSERT_TRUE(plain->Finish().has_value());
  EXPECT_EQ(plain->Digest(), digest);

  const std::unique_ptr<Recorder> threaded = MakeRecorder({threaded_file.path(), true});
  Fill(threaded.get(), kTicks);
  ASSERT_TRUE(threaded->Finish().has_value());
  EXPECT_EQ(threaded->Digest(), digest);
}

TEST(RecorderDigest, ChangesWithEveryTickAndEvent) {
  const std::string digest = DigestOf([](Recorder* r) { Fill(r, 50); });
  const auto with_last = [](TickRecord last) {
    return DigestOf([&last](Recorder* r) {
      Fill(r, 49);
      r->AddTick(last);
    });
  };
  TickRecord last = MakeTick(49);
  EXPECT_EQ(with_last(last), digest);
  last.depth = std::nextafter(last.depth, 1.0);
  EXPECT_NE(with_last(last), digest);
  EXPECT_NE(DigestOf([](Recorder* r) { Fill(r, 49); }), digest);
  EXPECT_NE(DigestOf([](Recorder* r) {
              Fill(r, 50);
              r->AddEvent(MakeEvent(1));
            }),
            digest);
  EXPECT_NE(DigestOf([](Recorder* r) {
              Fill(r, 50);
              r->AddCommand(MakeCommand(1));
            }),
            digest);
}

TEST(Recorder, CountsWhatAFullRingRefused) {
  RecorderOptions options;
  options.is_threaded = true;
  options.ring_ticks = 16;
  const std::unique_ptr<Recorder> recorder = MakeRecorder(options);
  const TickRecord tick = MakeTick(1);
  std::uint64_t refused = 0;
  constexpr int kBurst = 20000;  // In far less than the writer's pause.
  for (int i = 0; i < kBurst; ++i) {
    refused += recorder->AddTick(tick) ? 0 : 1;
  }
  ASSERT_TRUE(recorder->Finish().has_value());
  EXPECT_GT(refused, 0u);
  EXPECT_EQ(recorder->dropped_ticks(), refused);
  EXPECT_EQ(recorder->tick_count() + static_cast<std::int64_t>(refused), kBurst);
}

TEST(Recorder, TakesEventsFromOtherThreads) {
  const TemporaryFile file("events.hvas");
  const std::unique_ptr<Recorder> recorder = MakeRecorder({file.path(), true});
  std::thread physics([&] {
    for (int i = 0; i < 200; ++i) {
      recorder->AddEvent(MakeEvent(i));
    }
  });
  Fill(recorder.get(), 300);  // Adds 3 events of its own.
  physics.join();
  ASSERT_TRUE(recorder->Finish().has_value());
  EXPECT_EQ(Reader::Open(file.path())->ReadEvents()->size(), 203u);
}

TEST(RecorderError, NamesAFolderThatDoesNotExist) {
  RecorderOptions options;
  options.path = "/nonexistent/folder/session.hvas";
  const auto recorder = Recorder::Create(options, {});
  ASSERT_FALSE(recorder.has_value());
  EXPECT_EQ(recorder.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(recorder.error().where, options.path.string());
  EXPECT_FALSE(recorder.error().remedy.empty());
}

TEST(RecorderError, DoesNotOverwriteWhatIsNotARecord) {
  const TemporaryFile file("precious.step");
  std::ofstream(file.path()) << "ISO-10303-21; somebody's model, long enough to be one.";
  const auto recorder = Recorder::Create({file.path()}, {});
  ASSERT_FALSE(recorder.has_value());
  EXPECT_EQ(recorder.error().code, ErrorCode::kInvalid);
  std::string first;
  std::ifstream(file.path()) >> first;
  EXPECT_EQ(first, "ISO-10303-21;");
  EXPECT_FALSE(Recorder::Create({std::filesystem::temp_directory_path()}, {}).has_value());
}

TEST(Recorder, ReplacesAnOlderRecordWhenAskedTo) {
  const TemporaryFile file("replaced.hvas");
  Fill(MakeRecorder({.path = file.path()}).get(), 700);
  Fill(MakeRecorder({.path = file.path(), .replaces = true}).get(), 20);
  EXPECT_EQ(Reader::Open(file.path())->tick_count(), 20);
}

TEST(RecorderError, GoesOnWithoutTheFileWhenThereIsNoRoom) {
  const TemporaryFile file("full.hvas");
  RecorderOptions options;
  options.path = file.path();
  options.max_file_bytes = 1 << 20;
  const std::unique_ptr<Recorder> recorder = MakeRecorder(options);
  Fill(recorder.get(), 5000);  // 2 MB
  ASSERT_TRUE(recorder->error().has_value());
  const Result<void> finished = recorder->Finish();
  ASSERT_FALSE(finished.has_value());
  EXPECT_EQ(finished.error().code, ErrorCode::kOutOfResource);
  EXPECT_EQ(recorder->Digest(), DigestOf([](Recorder* r) { Fill(r, 5000); }));
  // What was written before is whole.
  Reader reader = Reader::Open(file.path()).value();
  EXPECT_FALSE(reader.is_complete());
  EXPECT_GT(reader.tick_count(), 1000);
  EXPECT_TRUE(reader.Verify().has_value());
  EXPECT_LE(std::filesystem::file_size(file.path()), 1u << 20);
}

}  // namespace
}  // namespace hvas::record
