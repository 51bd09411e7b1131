#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/test/await_true.h"
#include "base/test/temporary_folder.h"
#include "cad/import.h"
#include "cad/import_cache.h"
#include "cad/process/read_cad.h"
#include "cad/test/step_fixture.h"
#include "cad/worker.h"
#include "product/product_io.h"

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;
using hvas::testing::TemporaryFolder;
using product::Product;
using testing::DocumentBuilder;
using testing::MakePlate;
using testing::Translation;

/** A plate and two of one pin, in a folder with a stand-in for the worker. */
class ProcessTest : public ::testing::Test {
 protected:
  ProcessTest() {
    DocumentBuilder builder;
    const TDF_Label plate = builder.AddPart(MakePlate(), "plate");
    const TDF_Label pin = builder.AddPart(BRepPrimAPI_MakeCylinder(5, 20).Shape(), "pin");
    const TDF_Label root = builder.AddAssembly("rig");
    builder.AddComponent(root, plate, Translation(0, 0, 0), "plate");
    builder.AddComponent(root, pin, Translation(20, 20, -5), "pin");
    builder.AddComponent(root, pin, Translation(80, 20, -5), "pin");
    builder.Write(file_);
    ::setenv("HVAS_CAD_WORKER", HVAS_STAND_IN_WORKER, 1);
    ::setenv("HVAS_TEST_LOG", log_.c_str(), 1);
    Behave("");
  }

  ~ProcessTest() override {
    for (const char* name : {"HVAS_CAD_WORKER", "HVAS_TEST_LOG", "HVAS_TEST_WORKER"}) {
      ::unsetenv(name);
    }
  }

  static void Behave(const char* how) { ::setenv("HVAS_TEST_WORKER", how, 1); }

  Result<Product> Open(const ImportControl& control = {}) {
    diagnostics_ = {};
    return Import(file_, {}, &diagnostics_, control);
  }

  /** The processes that were started so far. */
  [[nodiscard]] std::vector<pid_t> Started() const {
    std::ifstream log(log_);
    std::vector<pid_t> pids;
    for (pid_t pid = 0; log >> pid;) {
      pids.push_back(pid);
    }
    return pids;
  }

  [[nodiscard]] bool AreGone() const {
    const std::vector<pid_t> pids = Started();
    // A killed process that nobody waits for may take a moment, and stay as a zombie.
    return !pids.empty() && std::all_of(pids.begin(), pids.end(), [](pid_t pid) {
      return hvas::testing::AwaitTrue([&] { return !IsAlive(pid); });
    });
  }

  static bool IsAlive(pid_t pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string word;
    std::string state;
    return stat >> word >> word >> state && state != "Z" && state != "X";
  }

  /** The only warning, if there is just one. */
  [[nodiscard]] Diagnostic OnlyWarning() const {
    std::vector<Diagnostic> warnings;
    for (const Diagnostic& item : diagnostics_.items()) {
      if (item.severity == Severity::kWarning) {
        warnings.push_back(item);
      }
    }
    EXPECT_EQ(warnings.size(), 1u);
    return warnings.size() == 1 ? warnings.front() : Diagnostic{};
  }

  static void ExpectHas(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "no \"" << part << "\" in: " << text;
  }

  [[nodiscard]] ImportControl Cached() const {
    ImportControl control;
    control.cache_directory = folder_ / "cache";
    return control;
  }

  static ImportControl InTime(double time, double part_time = 0) {
    ImportControl control;
    control.limits.time = time;
    control.limits.part_time = part_time;
    return control;
  }

  TemporaryFolder folder_;
  fs::path file_{folder_ / "rig.step"};
  fs::path log_{folder_ / "log"};
  Diagnostics diagnostics_;
};

TEST_F(ProcessTest, GivesTheSameBytesAsReadingInThisProcess) {
  Diagnostics diagnostics;
  const auto here = ReadCad(file_, {}, &diagnostics);
  const auto there = Open();
  ASSERT_TRUE(here && there);
  EXPECT_EQ(product::SerialiseProduct(*here), product::SerialiseProduct(*there));
  ASSERT_EQ(diagnostics.items().size(), diagnostics_.items().size());
  EXPECT_FALSE(diagnostics.items().empty());
  for (std::size_t i = 0; i < diagnostics.items().size(); ++i) {
    EXPECT_EQ(diagnostics.items()[i].message, diagnostics_.items()[i].message);
  }
}

TEST_F(ProcessTest, EveryOptionReachesTheReader) {
  using Change = void (*)(ImportOptions*);
  const Change changes[] = {[](ImportOptions* o) { o->relative_deflection = 1.0 / 300; },
                            [](ImportOptions* o) { o->min_deflection = 1e-3 / 3; },
                            [](ImportOptions* o) { o->max_angle = 0.02; },
                            [](ImportOptions* o) { o->max_triangles = 20; },
                            [](ImportOptions* o) { o->skipped_parts = {1}; }};
  Diagnostics diagnostics;
  const auto plain = ReadCad(file_, {}, &diagnostics);
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    ImportOptions options;
    options.relative_deflection = i == 0 || i == 1 ? 0 : options.relative_deflection;
    options.max_angle = i < 2 ? 3 : options.max_angle;
    changes[i](&options);
    const auto here = ReadCad(file_, options, &diagnostics);
    const auto there = Import(file_, options, &diagnostics);
    ASSERT_TRUE(here && there) << i;
    EXPECT_EQ(product::SerialiseProduct(*here), product::SerialiseProduct(*there)) << i;
    EXPECT_NE(product::SerialiseProduct(*here), product::SerialiseProduct(*plain)) << i;
  }
}

TEST_F(ProcessTest, FindsAFileByARelativePath) {
  const fs::path before = fs::current_path();
  fs::current_path(file_.parent_path());
  diagnostics_ = {};
  EXPECT_TRUE(Import("rig.step", {}, &diagnostics_).has_value());
  fs::current_path(before);
}

TEST_F(ProcessTest, TellsStagesAndEndsWithDone) {
  ImportControl control;
  std::vector<std::string> stages;
  double last = 0;
  control.progress = [&](std::string_view stage, double fraction) {
    if (stages.empty() || stages.back() != stage) {
      stages.emplace_back(stage);
    }
    last = fraction;
  };
  ASSERT_TRUE(Open(control).has_value());
  ASSERT_GE(stages.size(), 3u);
  EXPECT_EQ(stages.front(), "read");
  EXPECT_EQ(stages.back(), "done");
  EXPECT_EQ(last, 1);
}

TEST_F(ProcessTest, ErrorsOfTheReaderComeThrough) {
  std::ofstream(file_) << "ISO-10303-21;\nHEADER;\n";
  const auto product = Open();
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kUnreadable);
  ExpectHas(product.error().ToString(), "rig.step");
  EXPECT_EQ(Started().size(), 1u);
}

TEST_F(ProcessTest, DoesWithoutTheTolerancesThatItDiesOver) {
  for (const char* how : {"crash tolerances", "killed tolerances", "exit tolerances"}) {
    Behave(how);
    const auto product = Open();
    ASSERT_TRUE(product.has_value()) << how;
    EXPECT_EQ(product->parts.size(), 2u);
    const Diagnostic warning = OnlyWarning();
    EXPECT_EQ(warning.code, "tolerances-skipped");
    EXPECT_EQ(warning.entity, "rig.step");
    EXPECT_FALSE(warning.remedy.empty());
  }
}

TEST_F(ProcessTest, LeavesOutThePartThatItCrashesOver) {
  Behave("crash part 1");
  const auto product = Open();
  ASSERT_TRUE(product.has_value());
  ASSERT_EQ(product->parts.size(), 1u);
  EXPECT_EQ(product->parts[0].name, "plate");
  EXPECT_EQ(product->occurrences.size(), 1u);
  const Diagnostic warning = OnlyWarning();
  EXPECT_EQ(warning.code, "part-skipped");
  EXPECT_EQ(warning.entity, "pin");
  ExpectHas(warning.message, "rig.step");
  ExpectHas(warning.message, "crashed (signal 11)");
  ExpectHas(warning.remedy, "heal the part");
  EXPECT_EQ(Started().size(), 3u);  // Once more part after part, to know which one it was.
}

TEST_F(ProcessTest, WhatDiesOverSeveralPartsAtOnceMayGetOnPartAfterPart) {
  Behave("crash crowd");
  const auto product = Open();
  ASSERT_TRUE(product.has_value());
  EXPECT_EQ(product->parts.size(), 2u);
  EXPECT_EQ(diagnostics_.Count(Severity::kWarning), 0);
  EXPECT_EQ(Started().size(), 2u);
}

TEST_F(ProcessTest, LeavesOutThePartThatTakesTooLong) {
  Behave("hang part 0");
  const std::int64_t start_ns = MonotonicNs();
  const auto product = Open(InTime(60, 0.3));
  ASSERT_TRUE(product.has_value());
  ASSERT_EQ(product->parts.size(), 1u);
  EXPECT_EQ(product->parts[0].name, "pin");
  const Diagnostic warning = OnlyWarning();
  EXPECT_EQ(warning.code, "part-skipped");
  ExpectHas(warning.message, "time");
  ExpectHas(warning.remedy, "--time-limit");
  EXPECT_LT(MonotonicNs() - start_ns, 30 * kNsPerSecond);
  EXPECT_TRUE(AreGone());
}

TEST_F(ProcessTest, LeavesOutThePartThatTakesTooMuchMemory) {
  for (const char* how : {"memory part 1", "killed part 1"}) {
    Behave(how);
    const auto product = Open();
    ASSERT_TRUE(product.has_value()) << how;
    EXPECT_EQ(product->parts.size(), 1u);
    const Diagnostic warning = OnlyWarning();
    EXPECT_EQ(warning.code, "part-skipped");
    ExpectHas(warning.message, "memory");
    ExpectHas(warning.remedy, "--memory-limit");
  }
}

TEST_F(ProcessTest, GivesUpAfterAFewParts) {
  Behave("crash every part");
  const auto product = Open();
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(product.error().where, "rig.step");
  ExpectHas(product.error().message, "crashed");
  ExpectHas(product.error().message, "\"any\"");
  EXPECT_FALSE(product.error().remedy.empty());
  EXPECT_EQ(Started().size(), 10u);
  EXPECT_EQ(diagnostics_.Count(Severity::kWarning), 8);
}

TEST_F(ProcessTest, DeathBeforeAnyPartIsAnError) {
  struct Case {
    const char* how;
    ErrorCode code;
    const char* message;
  };

  for (const Case& c :
       {Case{"crash start", ErrorCode::kUnreadable,
             "the reader of CAD files crashed on this file (signal 11) while it was "
             "at the stage \"read\""},
        Case{"exit start", ErrorCode::kUnreadable, "exit status 3"},
        Case{"memory start", ErrorCode::kOutOfResource, "memory"},
        Case{"silent", ErrorCode::kInternal, "no product"},
        Case{"garbage", ErrorCode::kInternal, "no product"},
        Case{"truncate", ErrorCode::kInternal, "no product"}}) {
    Behave(c.how);
    const auto product = Open();
    ASSERT_FALSE(product.has_value()) << c.how;
    EXPECT_EQ(product.error().code, c.code) << c.how;
    EXPECT_EQ(product.error().where, "rig.step") << c.how;
    ExpectHas(product.error().message, c.message);
    EXPECT_FALSE(product.error().remedy.empty()) << c.how;
  }
}

TEST_F(ProcessTest, TimeLimitEndsWhateverItDoes) {
  for (const char* how : {"hang start", "chatter"}) {
    Behave(how);
    const std::int64_t start_ns = MonotonicNs();
    const auto product = Open(InTime(0.4));
    EXPECT_LT(MonotonicNs() - start_ns, 3 * kNsPerSecond) << how;
    ASSERT_FALSE(product.has_value()) << how;
    EXPECT_EQ(product.error().code, ErrorCode::kOutOfResource);
    ExpectHas(product.error().message, "the time limit of 0.4 s");
    ExpectHas(product.error().remedy, "--time-limit");
  }
  EXPECT_TRUE(AreGone());
}

TEST_F(ProcessTest, MemoryLimitHoldsForTheRealReader) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const std::uint64_t memory = 0;  // The sanitizers reserve terabytes: there is no limit.
#else
  const std::uint64_t memory = 60'000'000;  // Less than its libraries take.
#endif
  ImportControl control;
  control.limits.memory = memory;
  EXPECT_EQ(Open(control).has_value(), memory == 0);
  EXPECT_TRUE(Open().has_value());
}

TEST_F(ProcessTest, StopEndsItAtOnce) {
  Behave("hang start");
  std::stop_source source;
  ImportControl control;
  control.stop = source.get_token();
  std::jthread stopper([&source] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    source.request_stop();
  });
  const std::int64_t start_ns = MonotonicNs();
  const auto product = Open(control);
  EXPECT_LT(MonotonicNs() - start_ns, 2 * kNsPerSecond);
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(AreGone());
}

TEST_F(ProcessTest, NothingThatItStartedOutlivesIt) {
  Behave("child");
  EXPECT_FALSE(Open(InTime(5)).has_value());
  EXPECT_EQ(Started().size(), 2u);
  EXPECT_TRUE(AreGone());
}

TEST_F(ProcessTest, MissingWorkerIsNamedWithTheRemedy) {
  ::setenv("HVAS_CAD_WORKER", "/nowhere/hvas-cad", 1);
  const auto product = Open();
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kNotFound);
  ExpectHas(product.error().ToString(), "/nowhere/hvas-cad");
  ExpectHas(product.error().ToString(), "HVAS_CAD_WORKER");
}

TEST_F(ProcessTest, WorkerThatIsNoProgramIsAnError) {
  std::ofstream(folder_ / "text") << "no program";
  fs::permissions(folder_ / "text", fs::perms::owner_all);
  ::setenv("HVAS_CAD_WORKER", (folder_ / "text").c_str(), 1);
  const auto product = Open();
  ASSERT_FALSE(product.has_value());
  ExpectHas(product.error().message, "could not be started");
}

TEST_F(ProcessTest, SecondOpeningStartsNoProcess) {
  const auto first = Open(Cached());
  const Diagnostics first_diagnostics = diagnostics_;
  const auto second = Open(Cached());
  ASSERT_TRUE(first && second);
  EXPECT_EQ(Started().size(), 1u);
  EXPECT_EQ(product::SerialiseProduct(*first), product::SerialiseProduct(*second));
  ASSERT_EQ(first_diagnostics.items().size(), diagnostics_.items().size());
  for (std::size_t i = 0; i < diagnostics_.items().size(); ++i) {
    EXPECT_EQ(first_diagnostics.items()[i].message, diagnostics_.items()[i].message);
  }
}

TEST_F(ProcessTest, ChangedFileNameOrOptionsAreReadAnew) {
  ASSERT_TRUE(Open(Cached()).has_value());
  std::ofstream(file_, std::ios::app) << "\n";
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(Started().size(), 2u);
  ImportOptions coarser;
  coarser.max_angle = 0.5;
  ASSERT_TRUE(Import(file_, coarser, &diagnostics_, Cached()).has_value());
  EXPECT_EQ(Started().size(), 3u);
  fs::rename(file_, folder_ / "other.step");
  const auto other = Import(folder_ / "other.step", {}, &diagnostics_, Cached());
  ASSERT_TRUE(other.has_value());
  EXPECT_EQ(other->source, "other.step");
  EXPECT_EQ(Started().size(), 4u);
}

TEST_F(ProcessTest, DamagedEntryIsReadAnewAndReplaced) {
  ASSERT_TRUE(Open(Cached()).has_value());
  const fs::path entry = ImportCache(folder_ / "cache", HVAS_STAND_IN_WORKER, file_, {}).path();
  const auto size = fs::file_size(entry);
  {
    std::fstream stream(entry, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size / 2));
    stream.put('\x7b');
    stream.put('\x7c');
  }
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(Started().size(), 2u);
  fs::resize_file(entry, size / 3);
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(Started().size(), 3u);
  EXPECT_EQ(fs::file_size(entry), size);
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(Started().size(), 3u);
}

TEST_F(ProcessTest, CrashesAreRememberedWithTheirWarningAndLimitsAreNot) {
  Behave("crash part 1");
  ASSERT_TRUE(Open(Cached()).has_value());
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(OnlyWarning().code, "part-skipped");
  EXPECT_EQ(Started().size(), 3u);
  fs::remove_all(folder_ / "cache");
  Behave("memory part 1");
  ASSERT_TRUE(Open(Cached()).has_value());
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(Started().size(), 9u);
}

TEST_F(ProcessTest, CacheThatCannotBeWrittenCostsNoMoreThanANote) {
  std::ofstream(folder_ / "cache") << "a file where the directory should be";
  ASSERT_TRUE(Open(Cached()).has_value());
  EXPECT_EQ(diagnostics_.items().back().code, "cache-unwritable");
  EXPECT_EQ(diagnostics_.Count(Severity::kWarning), 0);
}

TEST_F(ProcessTest, CacheKeepsToItsSizeAndLeavesNothingUnfinished) {
  const fs::path directory = folder_ / "cache";
  const std::vector<std::byte> result(1000, std::byte{1});
  for (int i = 0; i < 5; ++i) {
    ImportOptions options;
    options.max_triangles = static_cast<std::size_t>(i);
    EXPECT_TRUE(ImportCache(directory, "worker", file_, options, 2500).Store(result));
  }
  std::size_t size = 0;
  for (const auto& entry : fs::directory_iterator(directory)) {
    EXPECT_EQ(entry.path().extension(), ".hvasproduct");
    size += entry.file_size();
  }
  EXPECT_EQ(size, 2 * 1032u);
}

TEST_F(ProcessTest, FilesThatAreReferredToCountAlsoWhenTheyWereMissing) {
  const ImportOptions options;
  const ImportCache cache(folder_ / "cache", "worker", file_, options);
  Diagnostics diagnostics;
  ImportResult result;
  result.product = *ReadCad(file_, options, &diagnostics);
  std::ofstream(folder_ / "bolt.step") << "bolt";
  result.referred_files = {{"bolt.step", DigestOf(folder_ / "bolt.step")}, {"nut.step", ""}};
  ASSERT_TRUE(cache.Store(Serialise(result)));
  EXPECT_TRUE(cache.Load().has_value());
  std::ofstream(folder_ / "nut.step") << "nut";
  EXPECT_FALSE(cache.Load().has_value()) << "a missing file that is there now";
  fs::remove(folder_ / "nut.step");
  EXPECT_TRUE(cache.Load().has_value());
  std::ofstream(folder_ / "bolt.step") << "another bolt";
  EXPECT_FALSE(cache.Load().has_value()) << "a file that has changed";
}

}  // namespace
}  // namespace hvas::cad
