#include "cad/limits.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "base/regular_file.h"
#include "base/test/temporary_folder.h"
#include "cad/import.h"
#include "cad/import_result.h"
#include "cad/process/read_cad.h"
#include "cad/scene/placed_parts.h"
#include "cad/test/greedy_files.h"
#include "cad/test/step_fixture.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

using hvas::testing::TemporaryFolder;
using product::Product;

std::string MakeBoxStep(const TemporaryFolder& folder) {
  testing::DocumentBuilder builder;
  (void)builder.AddPart(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), "box");
  builder.Write(folder / "box.step");
  return ReadRegularFile(folder / "box.step").value();
}

/** What came of a file, and what its reading took: in a process of its own, whose children count.
 */
struct Reading {
  std::size_t parts{0};  ///< Occurrences; 0 where it was refused.
  std::string error;     ///< What a user sees of it.
  double reader_mib{0};
  double own_mib{0};
};

Reading Read(const std::filesystem::path& file, const ImportOptions& options = {},
             const ImportControl& control = {}) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    Diagnostics diagnostics;
    const auto product = Import(file, options, &diagnostics, control);
    rusage own{};
    rusage children{};
    ::getrusage(RUSAGE_SELF, &own);
    ::getrusage(RUSAGE_CHILDREN, &children);
    const std::string text = fmt::format("{} {} {} {}", product ? product->occurrences.size() : 0,
                                         children.ru_maxrss / 1024, own.ru_maxrss / 1024,
                                         product ? std::string() : product.error().ToString());
    ::_exit(::write(ends[1], text.data(), text.size()) > 0 ? 0 : 1);
  }
  ::close(ends[1]);
  Reading reading;
  std::string text;
  char buffer[4096];
  for (ssize_t size = 0; (size = ::read(ends[0], buffer, sizeof(buffer))) > 0;) {
    text.append(buffer, static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  std::istringstream stream(text);
  stream >> reading.parts >> reading.reader_mib >> reading.own_mib;
  std::getline(stream >> std::ws, reading.error);
  return reading;
}

void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no \"" << part << "\" in: " << text;
}

using Circle = std::vector<std::uint64_t>;

TEST(PlacedTreeTest, CountsDefinitionsAsOftenAsTheyArePlaced) {
  EXPECT_EQ(ExamineTree({}, {}).count, 0);
  EXPECT_EQ(ExamineTree({}, {5, 5}).count, 2);
  EXPECT_EQ(ExamineTree({{1, {2, 2, 3}}, {2, {3}}}, {1}).count, 6);
  EXPECT_EQ(ExamineTree({{1, {2, 2, 3}}, {2, {3}}}, {1}).levels, 3U);
  EXPECT_EQ(ExamineTree({{1, {2, 2, 3}}, {2, {3}}}, {1}).circle, Circle());
  Uses doubling;
  for (std::uint64_t i = 0; i < 50; ++i) {
    doubling[i] = {i + 1, i + 1};
  }
  EXPECT_EQ(ExamineTree(doubling, {0}).count, std::pow(2, 51) - 1);
  for (std::uint64_t i = 50; i < 2000; ++i) {
    doubling[i] = {i + 1, i + 1};
  }
  EXPECT_TRUE(std::isinf(ExamineTree(doubling, {0}).count));
}

TEST(PlacedTreeTest, CirclesAreFoundAlsoWhereNoRootLeadsToThem) {
  EXPECT_EQ(ExamineTree({{1, {1}}}, {1}).circle, Circle({1, 1}));
  EXPECT_EQ(ExamineTree({{1, {2}}, {2, {1}}}, {1}).circle, Circle({1, 2, 1}));
  EXPECT_EQ(ExamineTree({{5, {6}}, {1, {2}}, {2, {3}}, {3, {2}}}, {5}).circle, Circle({2, 3, 2}));
}

TEST(PlacedTreeTest, LongChainsHaveAnEnd) {
  Uses chain;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    chain[i] = {i + 1};
  }
  EXPECT_EQ(ExamineTree(chain, {0}).count, 200'001);
  EXPECT_EQ(ExamineTree(chain, {0}).levels, 200'001U);
  EXPECT_EQ(ExamineTree(chain, {}).circle, Circle());
}

TEST(GreedyFileTest, SmallOnesAreWholeProducts) {
  const TemporaryFolder folder;
  const std::string box = MakeBoxStep(folder);
  for (const auto& [file, parts] : std::vector<std::pair<std::filesystem::path, std::size_t>>{
           {folder.Write("items.3mf", testing::MakeManyItems3mf(5)), 5},
           {folder.Write("doubling.3mf", testing::MakeDoubling3mf(3)), 8},
           {folder.Write("bomb.3mf", testing::MakeBomb3mf(1000)), 1},
           {folder.Write("nodes.gltf", testing::MakeManyNodesGltf(5)), 5},
           {folder.Write("doubling.gltf", testing::MakeDoublingGltf(3)), 8},
           {folder.Write("stretched.gltf", testing::MakeStretchedGltf(5)), 5},
           {folder.Write("objects.obj", testing::MakeManyObjectsObj(5)), 5},
           {folder.Write("solids.stl", testing::MakeManySolidsStl(5)), 5},
           {folder.Write("doubling.step", testing::MakeDoublingStep(box, 3)), 8}}) {
    const Reading reading = Read(file);
    EXPECT_EQ(reading.parts, parts) << file << " " << reading.error;
  }
}

TEST(GreedyFileTest, FilesThatPlaceTooManyPartsAreRefusedBeforeTheyCostMuch) {
  const TemporaryFolder folder;
  const std::string box = MakeBoxStep(folder);
  for (const auto& file : {folder.Write("items.3mf", testing::MakeManyItems3mf(100'000)),
                           folder.Write("doubling_18.3mf", testing::MakeDoubling3mf(18)),
                           folder.Write("doubling_40.3mf", testing::MakeDoubling3mf(40)),
                           folder.Write("nodes.gltf", testing::MakeManyNodesGltf(20'000)),
                           folder.Write("doubling.gltf", testing::MakeDoublingGltf(30)),
                           folder.Write("doubling.step", testing::MakeDoublingStep(box, 30)),
                           folder.Write("long.step", testing::MakeDoublingStep(box, 1500)),
                           folder.Write("objects.obj", testing::MakeManyObjectsObj(20'000)),
                           folder.Write("solids.stl", testing::MakeManySolidsStl(20'000))}) {
    const Reading reading = Read(file);
    const std::string name = file.filename().string();
    EXPECT_EQ(reading.parts, 0U) << name;
    ExpectHas(reading.error, name);
    ExpectHas(reading.error, "places");
    ExpectHas(reading.error, "16384 parts");
    ExpectHas(reading.error, "--max-parts");
    EXPECT_LT(reading.reader_mib, 600) << name;
    EXPECT_LT(reading.own_mib, 300) << name;
  }
}

/** Reads a file that is no tree of parts, or has no unit, and expects to be told what is wrong. */
void ExpectToldWhatIsWrong(const std::filesystem::path& file,
                           const std::vector<std::string>& texts) {
  SCOPED_TRACE(file);
  const Reading reading = Read(file);
  EXPECT_EQ(reading.parts, 0U);
  ExpectHas(reading.error, file.filename().string() + ": ");
  for (const std::string& text : texts) {
    ExpectHas(reading.error, text);
  }
  EXPECT_EQ(reading.error.find("crash"), std::string::npos) << reading.error;
}

TEST(GreedyFileTest, AssembliesThatContainThemselvesAreNamed) {
  const TemporaryFolder folder;
  ExpectToldWhatIsWrong(folder.Write("circle.3mf", testing::MakeCircle3mf(true)),
                        {"object 2 contains itself (2 > 3 > 2)"});
  ExpectToldWhatIsWrong(folder.Write("aside.3mf", testing::MakeCircle3mf(false)),
                        {"object 2 contains itself (2 > 3 > 2)"});
  ExpectToldWhatIsWrong(folder.Write("circle.gltf", testing::MakeCircleGltf()),
                        {"node 1 contains itself (1 > 2 > 1)"});
  ExpectToldWhatIsWrong(folder.Write("circle.step", testing::MakeCircleStep(MakeBoxStep(folder))),
                        {"product definition #", " contains itself"});
}

TEST(GreedyFileTest, AssembliesThatAreNestedTooDeepForTheLibrariesAreRefused) {
  const TemporaryFolder folder;
  constexpr std::size_t kLevels = 50'000;
  ExpectToldWhatIsWrong(folder.Write("deep.3mf", testing::MakeNested3mf(kLevels)),
                        {"50001 levels deep; the limit is 1000"});
  ExpectToldWhatIsWrong(folder.Write("deep.gltf", testing::MakeNestedGltf(12'000)),
                        {"12001 levels deep; the limit is 1000"});
}

TEST(GreedyFileTest, UnitsInWhichNothingCanBeDrawnAreRefusedWithTheirEntity) {
  const TemporaryFolder folder;
  const std::string box = MakeBoxStep(folder);
  const std::string unit = "SI_UNIT(.MILLI.,.METRE.)";
  ASSERT_NE(box.find(unit), std::string::npos);
  const auto write = [&](const std::string& name, const std::string& other) {
    std::string text = box;
    for (std::size_t at = text.find(unit); at != std::string::npos; at = text.find(unit)) {
      text.replace(at, unit.size(), other);
    }
    return folder.Write(name, text);
  };
  for (const char* prefix : {"EXA", "PETA", "TERA", "GIGA", "MEGA", "ATTO", "FEMTO", "PICO"}) {
    ExpectToldWhatIsWrong(
        write(std::string(prefix) + ".step", fmt::format("SI_UNIT(.{}.,.METRE.)", prefix)),
        {"entity #", " has a unit of length of 1e", " m, which is not between"});
  }
  ExpectToldWhatIsWrong(write("unknown.step", "SI_UNIT(.ZETTA.,.METRE.)"),
                        {"entity #", " has a unit of length that is not defined"});
  for (const char* prefix : {".MICRO.", ".CENTI.", ".KILO.", "$"}) {
    EXPECT_EQ(Read(write("usual.step", fmt::format("SI_UNIT({},.METRE.)", prefix))).parts, 1U)
        << prefix;
  }
}

TEST(GreedyFileTest, MorePartsMayBeAllowed) {
  const TemporaryFolder folder;
  ImportOptions options;
  options.max_parts = 20'000;
  EXPECT_EQ(Read(folder.Write("nodes.gltf", testing::MakeManyNodesGltf(20'000)), options).parts,
            20'000U);
  options.max_parts = 7;
  const Reading reading = Read(folder.Write("nodes8.gltf", testing::MakeManyNodesGltf(8)), options);
  ExpectHas(reading.error, "more than 7 parts");
}

TEST(GreedyFileTest, ArchivesThatUnpackToTooMuchAreRefused) {
  const TemporaryFolder folder;
  constexpr std::size_t kBytes = std::size_t{129} << 20U;
  ImportControl control;
  control.limits.memory = std::uint64_t{1} << 30U;  // An eighth of it is for what is unpacked.
  for (const auto& file : {folder.Write("bomb.3mf", testing::MakeBomb3mf(kBytes)),
                           folder.Write("bomb_model.3mf", testing::MakeBombModel3mf(kBytes))}) {
    const Reading reading = Read(file, {}, control);
    const std::string name = file.filename().string();
    EXPECT_EQ(reading.parts, 0U) << name;
    ExpectHas(reading.error, name + ": the unpacked file takes 129 MiB; the limit is 128 MiB");
    ExpectHas(reading.error, "--memory-limit");
    EXPECT_LT(reading.reader_mib, 200) << name;
  }
}

TEST(GreedyFileTest, TrianglesThatTakeTooMuchAreRefusedBeforePartsAreMade) {
  const TemporaryFolder folder;
  const auto file = folder.Write("many.gltf", testing::MakeStretchedGltf(16'000));
  ImportOptions options;
  options.max_bytes = std::uint64_t{1} << 20U;
  Diagnostics diagnostics;
  const auto product = ReadCad(file, options, &diagnostics);
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, ErrorCode::kUnsupported);
  ExpectHas(product.error().ToString(), "many.gltf: the triangles of its parts take");
  ExpectHas(product.error().remedy, "--memory-limit");
}

TEST(GreedyFileTest, ProductThatTakesTooMuchIsNotHandedOver) {
  const TemporaryFolder folder;
  const auto file = folder.Write("x.gltf", testing::MakeStretchedGltf(50));
  WorkerCall call;
  call.program = FindWorker().value();
  call.arguments = {"import", file.string(), "--max-bytes", "100000"};
  call.part_limit_ns = 100 * kNsPerSecond;
  call.deadline_ns = MonotonicNs() + call.part_limit_ns;
  call.memory = std::uint64_t{3} << 30U;
  const WorkerRun run = RunWorker(call);
  const auto result = DeserialiseImportResult(run.output.bytes());
  ASSERT_TRUE(result.has_value()) << run.Describe();
  ASSERT_FALSE(result->product.has_value());
  ExpectHas(result->product.error().ToString(), "x.gltf: the product takes");
  ExpectHas(result->product.error().remedy, "--memory-limit");
}

TEST(ImportLimitsTest, WhatIsNestedTooDeepInGltfIsLeftOutAndReported) {
  const TemporaryFolder folder;
  for (const std::size_t levels : {400, 600}) {
    SCOPED_TRACE(levels);
    const bool is_deep = levels > 500;
    Diagnostics diagnostics;
    const auto product =
        Import(folder.Write("nested.gltf", testing::MakeNestedGltf(levels)), {}, &diagnostics, {});
    ASSERT_TRUE(product) << product.error().ToString();
    EXPECT_EQ(product->occurrences.size(), is_deep ? 1u : 2u);
    EXPECT_EQ(testing::CountCode(diagnostics, "limit-depth"), is_deep ? 1 : 0);
  }
}

}  // namespace
}  // namespace hvas::cad
