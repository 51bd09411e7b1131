#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using nlohmann::json;
using testing::ProductFile;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

class PathCommandTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string In(const std::string& name) const { return folder_ / name; }

  /** Arguments for the shaft of the bushing rig. */
  [[nodiscard]] std::vector<std::string> ForShaft(std::vector<std::string> more,
                                                  const std::string& output) const {
    std::vector<std::string> all{"path", ProductFile("bushing"), "--part", "shaft", "-q"};
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {"-o", In(output)});
    return all;
  }

  void Record() const {
    ASSERT_EQ(
        RunHvas({"assemble", ProductFile("bushing"), "-q", "--record", In("run.hvasrec")}).status,
        0);
  }

  hvas::testing::TemporaryFolder folder_;
};

std::vector<std::vector<double>> ReadTable(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "t_s,centre_x_m,centre_y_m,centre_z_m,x_m,y_m,z_m,q_w,q_x,q_y,q_z");
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) {
      rows.back().push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN()
                                         : std::stod(cell));
    }
  }
  return rows;
}

/** Of a binary STL file. */
struct Stl {
  explicit Stl(const std::string& bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof(count));
    EXPECT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(count));
    using Corner = std::array<float, 3>;
    std::map<std::pair<Corner, Corner>, int> edges;
    for (std::uint32_t i = 0; i < count; ++i) {
      std::array<Corner, 3> t{};
      std::memcpy(t.data(), bytes.data() + 84 + 50 * i + 12, sizeof(t));
      for (std::size_t k = 0; k < 3; ++k) {
        ++edges[{t[k], t[(k + 1) % 3]}];
        --edges[{t[(k + 1) % 3], t[k]}];
      }
      const auto at = [&](std::size_t a, std::size_t b) { return static_cast<double>(t[a][b]); };
      six_volumes += at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) +
                     at(0, 1) * (at(1, 2) * at(2, 0) - at(1, 0) * at(2, 2)) +
                     at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0));
    }
    for (const auto& [edge, balance] : edges) {
      is_closed = is_closed && balance == 0;
    }
  }

  [[nodiscard]] double volume_mm3() const { return six_volumes / 6; }

  double six_volumes{0};
  bool is_closed{true};
};

TEST_F(PathCommandTest, X13RecordedPathIsWrittenAsPoints) {  // discrete points
  Record();
  const json summary = RunHvasJson(ForShaft({"--record", In("run.hvasrec")}, "way.csv"));
  const auto rows = ReadTable(ReadText(In("way.csv")));
  ASSERT_EQ(rows.size(), summary["poses"]);
  ASSERT_GT(rows.size(), 1000u);
  double length = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 11u);
    EXPECT_NEAR(rows[i][0] - rows[i - 1][0], 1e-3, 1e-9);  // every tick
    length += std::hypot(rows[i][1] - rows[i - 1][1], rows[i][2] - rows[i - 1][2],
                         rows[i][3] - rows[i - 1][3]);
  }
  EXPECT_NEAR(1e3 * length, summary["length_mm"], 1e-6);
  ASSERT_EQ(RunHvas(ForShaft({"--record", In("run.hvasrec")}, "way.json")).status, 0);
  const json path = json::parse(ReadText(In("way.json")));
  EXPECT_EQ(path["poses"].size(), rows.size());
  EXPECT_EQ(path["times_s"].size(), rows.size());
  EXPECT_NEAR(path["points_m"].back()[2], rows.back()[3], 1e-12);
}

TEST_F(PathCommandTest, X13SweptVolumeOfARecordHoldsThePart) {  // swept volume
  Record();
  const json summary = RunHvasJson(
      ForShaft({"--record", In("run.hvasrec"), "--swept", "--resolution-mm", "6"}, "way.stl"));
  const Stl stl(ReadText(In("way.stl")));
  EXPECT_TRUE(stl.is_closed);
  EXPECT_NEAR(stl.volume_mm3() / summary["volume_mm3"].get<double>(), 1, 1e-5);
  EXPECT_GT(stl.volume_mm3(), 142'528);  // of the shaft alone
  EXPECT_EQ(summary["resolution_mm"], 6.0);
}

TEST_F(PathCommandTest, X13TurnOfTheRoundShaftAboutItsAxisSweepsTheShaft) {  // rotation
  const json summary = RunHvasJson(
      ForShaft({"--rotate", "0,0,1,270", "--swept", "--resolution-mm", "1.5"}, "turn.glb"));
  EXPECT_NEAR(summary["volume_mm3"].get<double>() / 142'528.8, 1, 0.005);
  EXPECT_EQ(ReadText(In("turn.glb")).substr(0, 4), "glTF");
}

using PathCommandReleaseTest = PathCommandTest;

TEST_F(PathCommandReleaseTest, X13StraightWaySweepsItsSectionTimesTheWay) {  // translation
  const auto volume_after = [&](const std::string& way_mm) {
    return RunHvasJson(ForShaft(
        {"--translate", "0,0," + way_mm, "--swept", "--resolution-mm", "1.5", "--force"},
        "up.stl"))["volume_mm3"]
        .get<double>();
  };
  // Once it has left its place, by the largest section: the collar of 60 mm.
  const double more = volume_after("150") - volume_after("130");
  EXPECT_NEAR(more / (std::numbers::pi * 30 * 30 * 20), 1, 0.01);
  EXPECT_TRUE(Stl(ReadText(In("up.stl"))).is_closed);
}

TEST_F(PathCommandTest, WhatCannotBeDoneIsSaidBeforeAnythingIsWritten) {
  constexpr int kMisuse = 64;
  const auto fails = [&](const std::vector<std::string>& more, const std::string& output,
                         const std::string& says, int status = 1) {
    const Ran ran = RunHvas(ForShaft(more, output));
    return ran.status == status && ran.err.find(says) != std::string::npos &&
           !std::filesystem::exists(In(output));
  };
  EXPECT_TRUE(fails({"--translate", "0,0,1"}, "a.stl", "--swept"));
  EXPECT_TRUE(fails({"--translate", "0,0,1", "--swept"}, "a.csv", ".stl or .glb"));
  EXPECT_TRUE(
      fails({"--rotate", "0,0,0,90"}, "a.csv", "the direction of the axis has length zero"));
  EXPECT_TRUE(fails({}, "a.csv", "--translate", kMisuse));
  EXPECT_TRUE(
      fails({"--translate", "0,0,1", "--rotate", "0,0,1,1"}, "a.csv", "--translate", kMisuse));
  EXPECT_TRUE(fails({"--translate", "0,0,90", "--swept", "--resolution-mm", "0.01"}, "a.stl",
                    "mm or more"));
  EXPECT_TRUE(fails({"--record", In("missing.hvasrec")}, "a.csv", "missing.hvasrec"));
  Record();
  EXPECT_TRUE(fails({"--record", In("run.hvasrec"), "--hold", "9"}, "a.csv", "--hold"));
  const Ran other = RunHvas({"path", ProductFile("gear_pump"), "--part", "cover screw 1",
                             "--record", In("run.hvasrec"), "-q", "-o", In("a.csv")});
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("another product"), std::string::npos);
}

}  // namespace
}  // namespace hvas::app
