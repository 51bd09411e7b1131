#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

/** Rows of numbers under a header. */
std::vector<std::vector<double>> ReadNumbers(const std::string& csv) {
  std::istringstream in(csv);
  std::string line;
  std::getline(in, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) {
      rows.back().push_back(std::stod(cell));
    }
  }
  return rows;
}

// W8: 77,931.13 N at the end of the curve whatever its step; what comes out is what went in.
TEST(FitCommand, CurveEndsAtTheClosedFormWhateverTheStep) {
  const TemporaryFolder folder;
  for (const auto& [step, count] : {std::pair("0.01", 5001U), std::pair("1", 51U)}) {
    ASSERT_EQ(RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--mu", "0.15",
                       "--curve", folder / "curve.csv", "--step", step})
                  .status,
              0);
    const auto rows = ReadNumbers(ReadText(folder / "curve.csv"));
    ASSERT_EQ(rows.size(), count);
    EXPECT_EQ(rows.front()[0], 0);
    EXPECT_EQ(rows.back()[0], 50);
    EXPECT_NEAR(rows.back()[5], 77931.133, 0.01);
    EXPECT_NEAR(rows.back()[6], 77931.133, 0.01);
    for (const auto& row : rows) {
      EXPECT_NEAR(row[5], 77931.133 * row[0] / 50, 0.01);
      for (std::size_t q = 10; q + 1 < row.size(); ++q) {
        EXPECT_LE(row[q], row[q + 1]);  // Quantiles are in order.
      }
    }
  }
}

// N4: the same bytes with any number of threads: card, curve and plot.
// W1b: a shaft that tapers by 20 um has the force of the integral, 5 times 3711.01 N, and no more.
TEST(FitCommand, CurveOfAPairMeasuredAlongItsLength) {
  const TemporaryFolder folder;
  const std::string table = folder / "pair.csv";
  const auto run = [&](const char* text) {
    std::ofstream(table) << text;
    return RunHvas({"fit", "40 H7/p6", "--length", "50", "--hub", "80", "--mu", "0.15", "--rz", "0",
                    "--curve", folder / "curve.csv", "--along", table});
  };
  ASSERT_EQ(run("depth_mm,hole_mm,shaft_mm\n0,40.010,40.010\n50,,40.030\n").status, 0);
  const auto rows = ReadNumbers(ReadText(folder / "curve.csv"));
  EXPECT_NEAR(rows.back()[7], 5 * 3711.01, 0.1);
  EXPECT_NEAR(rows[rows.size() / 2][7], 5 * 3711.01 / 4, 0.1);
  const Ran refused = run("depth_mm,hole_mm,shaft_mm\n5,40,40\n4,40,40\n");
  EXPECT_EQ(refused.status, 1);
  EXPECT_NE(refused.err.find("line 3"), std::string::npos) << refused.err;
}

TEST(FitCommand, SameBytesWithAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto run = [&](const char* threads) {
    std::string all;
    for (const char* kind : {"curve.csv", "curve.svg"}) {
      const Ran ran = RunHvas({"fit",     "40 H7/k6",     "35 H7/p6",  "--length",      "30,20",
                               "--start", "0,40",         "--rz",      "6.3",           "--chamfer",
                               "5",       "--population", "50001",     "--press-limit", "9000",
                               "--curve", folder / kind,  "--threads", threads,         "--json"});
      EXPECT_EQ(ran.status, 0) << ran.err;
      all += ran.out + ReadText(folder / kind);
    }
    return all;
  };
  const std::string one = run("1");
  EXPECT_EQ(run("2"), one);
  EXPECT_EQ(run("3"), one);
}

// W10: paper W's ranges by its own factors, the true newtons beside them; one smooth curve, one
// stair.
TEST(FitCommand, PapersCurvesHaveItsRangesAndTheTrueNewtons) {
  const TemporaryFolder folder;
  ASSERT_EQ(RunHvas({"fit", "paper", "--curve", folder / "paper.csv"}).status, 0);
  std::istringstream in(ReadText(folder / "paper.csv"));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "experiment,fit,factor,depth_mm,time_s,true_n,shown_n");
  std::map<std::string, std::vector<std::pair<double, double>>> curves;
  while (std::getline(in, line)) {
    const std::string experiment = line.substr(0, 2);
    const std::size_t shown = line.rfind(',');
    const std::size_t real = line.rfind(',', shown - 1);
    curves[experiment].emplace_back(std::stod(line.substr(real + 1)),
                                    std::stod(line.substr(shown + 1)));
  }
  const auto largest = [](const auto& curve) {
    std::pair<double, double> most{0, 0};
    for (const auto& [real, shown] : curve) {
      most = {std::max(most.first, real), std::max(most.second, shown)};
    }
    return most;
  };
  const auto flat = [](const auto& curve) {
    int count = 0;
    for (std::size_t i = 1; i < curve.size(); ++i) {
      count += curve[i].first - curve[i - 1].first < 1e-9 ? 1 : 0;
    }
    return count;
  };
  ASSERT_EQ(curves.size(), 3U);
  EXPECT_NEAR(largest(curves["B1"]).second, 0.3, 0.005);
  EXPECT_EQ(largest(curves["B1"]).first, largest(curves["B1"]).second);
  EXPECT_NEAR(largest(curves["B2"]).second, 6, 1e-6);
  EXPECT_NEAR(largest(curves["B2"]).first, 39893, 3000);
  EXPECT_EQ(flat(curves["B2"]), 0);
  EXPECT_NEAR(largest(curves["B3"]).second, 4, 1e-6);
  EXPECT_GT(flat(curves["B3"]), 50);
}

/** A plot is XML that a browser reads, and has what its reader needs. */
void ExpectPlot(const std::string& svg, const std::vector<std::string>& texts) {
  EXPECT_TRUE(svg.starts_with("<svg xmlns=")) << svg.substr(0, 60);
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "prefers-color-scheme:dark", svg);
  EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "nan", svg);
  for (const std::string& text : texts) {
    EXPECT_PRED_FORMAT2(::testing::IsSubstring, text, svg);
  }
}

TEST(FitCommand, PlotsHaveAxesUnitsAndLegend) {
  const TemporaryFolder folder;
  ASSERT_EQ(RunHvas({"fit", "40 H7/k6", "--length", "50", "--rz", "6.3", "--press-limit", "9000",
                     "--curve", folder / "curve.svg", "--jamming", folder / "jam.svg"})
                .status,
            0);
  ASSERT_EQ(RunHvas({"fit", "paper", "--curve", folder / "paper.svg"}).status, 0);
  ExpectPlot(
      ReadText(folder / "curve.svg"),
      {"axial force, N", "depth of the shaft, mm", "5 to 95 %", "Tight pair (first quartile)",
       "force limit of the press", "diametral clearance, um"});
  ExpectPlot(ReadText(folder / "jam.svg"),
             {"F_x / F_z", "M / (r F_z)", "tilt, deg", "may wedge", "slides on"});
  ExpectPlot(ReadText(folder / "paper.svg"),
             {"H7/g6", "H7/p6", "H7/k6", "as shown, N", "true axial force, N", "k_r ="});
}

// N5: the working point's verdict is the library's, and the vertices are those of the worked case.
TEST(FitCommand, JammingHasTheVerdictOfTheLoad) {
  const TemporaryFolder folder;
  const auto jam = [&](const char* load) {
    return RunHvasJson({"fit", "20 H7/g6", "--length", "40", "--mu", "0.3", "--at", "20", "--load",
                        load, "--jamming", folder / "jam.svg"})["jamming"];
  };
  // mu 0.3, r 10, l 20: (0, 3.0) slides, (0, 3.6) jams, (2, -1) slides, (2, 1) jams.
  EXPECT_EQ(jam("0,1,30")["is_sliding"], true);
  EXPECT_EQ(jam("0,1,36")["is_sliding"], false);
  EXPECT_EQ(jam("2,1,-10")["is_sliding"], true);
  const json last = jam("2,1,10");
  EXPECT_EQ(last["is_sliding"], false);
  EXPECT_EQ(last["can_wedge"], false);
  EXPECT_NEAR(last["lambda"].get<double>(), 10.0 / 3, 1e-8);
}

TEST(FitCommand, WedgingLineOfADiagramIsThatOfTheLeastClearance) {
  const TemporaryFolder folder;
  const std::string svg = (folder / "jam.svg").string();
  const json jamming = RunHvasJson(
      {"fit", "40 H7/g6", "--length", "50", "--mu", "0.15", "--jamming", svg})["jamming"];
  const double t = jamming["wedging_tilt_deg"].get<double>() * 0.017453292519943295;
  EXPECT_NEAR(40 * std::cos(t) + 6 * std::sin(t), 40.009, 1e-6);
}

}  // namespace
}  // namespace hvas::app
