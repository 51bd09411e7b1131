// The same tests by R (Debian's r-base-core) on random tables with ties and zero differences.

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/random.h"
#include "base/test/temporary_folder.h"
#include "statistics/rank_tests.h"
#include "statistics/shares.h"
#include "statistics/summary.h"

namespace hvas::statistics {
namespace {

constexpr int kTables = 200;

using Rows = std::vector<std::vector<double>>;

/** Counts of right answers (many ties and zeros), ratings with few values, or times (none). */
Rows DrawTable(int draw, Random* random) {
  const auto n = static_cast<std::size_t>(random->Uniform(3, 21));
  const auto k = static_cast<std::size_t>(random->Uniform(2, 6));
  Rows rows(n, std::vector<double>(k));
  for (auto& row : rows) {
    for (std::size_t j = 0; j < k; ++j) {
      const auto shift = static_cast<double>(j);
      row[j] = draw % 4 == 0   ? 20 + 2 * shift + 5 * random->Normal()
               : draw % 4 == 1 ? std::floor(random->Uniform(1, 4))
                               : std::floor(random->Uniform(0, 16 - shift));
    }
  }
  return rows;
}

std::vector<double> ColumnOf(const Rows& rows, std::size_t column) {
  std::vector<double> values;
  for (const auto& row : rows) {
    values.push_back(row[column]);
  }
  return values;
}

double OrNan(const std::optional<double>& value) {
  return value.value_or(std::nan(""));
}

/** What reference.R prints of a table, by our functions; NaN is not defined. */
std::vector<double> CalcFigures(const Rows& rows) {
  const std::size_t k = rows[0].size();
  const auto friedman = TestFriedman(rows, Exact::kNo);  // R has no exact one.
  std::vector<double> figures{OrNan(friedman->chi_square), OrNan(friedman->p),
                              OrNan(friedman->iman_davenport_f), OrNan(friedman->iman_davenport_p)};
  std::vector<double> p;
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = i + 1; j < k; ++j) {
      const auto wilcoxon = TestWilcoxon(ColumnOf(rows, i), ColumnOf(rows, j));
      figures.insert(figures.end(), {wilcoxon->positive_rank_sum, OrNan(wilcoxon->p),
                                     OrNan(wilcoxon->continuity_p), OrNan(wilcoxon->exact_p)});
      p.push_back(wilcoxon->p.value_or(1));
    }
  }
  for (const std::vector<double>& adjusted : {AdjustBonferroni(p), AdjustHolm(p)}) {
    figures.insert(figures.end(), adjusted.begin(), adjusted.end());
  }
  for (std::size_t j = 0; j < k; ++j) {
    const auto s = Summarise(ColumnOf(rows, j));
    figures.insert(figures.end(), {s->mean, *s->sd, s->mean_ci->low, s->mean_ci->high,
                                   s->lower_quartile, s->median, s->upper_quartile});
  }
  std::vector<double> all;
  for (const auto& row : rows) {
    all.insert(all.end(), row.begin(), row.end());
  }
  std::sort(all.begin(), all.end());
  const double middle = CalcQuantile(all, 0.5);
  const std::vector<double> first = ColumnOf(rows, 0);
  const auto right =
      std::count_if(first.begin(), first.end(), [&](double v) { return v > middle; });
  const auto share =
      CalcShare(right, static_cast<std::int64_t>(rows.size()), 1 / static_cast<double>(k));
  figures.insert(figures.end(), {share->ci.low, share->ci.high, *share->chance_p});
  return figures;
}

/** Lines that R prints. */
std::vector<std::string> RunR(const std::string& tables) {
  const std::string command = fmt::format(
      "Rscript --vanilla '" HVAS_SOURCE_DIR "/src/statistics/test/reference.R' '{}'", tables);
  std::FILE* pipe = ::popen(command.c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  std::string text;
  std::array<char, 4096> buffer;
  for (std::size_t size = 0; (size = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    text.append(buffer.data(), size);
  }
  const int status = ::pclose(pipe);
  EXPECT_EQ(status, 0) << "Rscript of the package r-base-core compares with R";
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(AgainstR, TwoHundredTablesWithTiesAndZerosHaveTheSameFigures) {
  Random random(20260301);
  const hvas::testing::TemporaryFolder folder;
  const std::string file = (folder / "tables.txt").string();
  std::vector<Rows> tables;
  {
    std::ofstream stream(file);
    for (int draw = 0; draw < kTables; ++draw) {
      tables.push_back(DrawTable(draw, &random));
      stream << tables.back().size() << ' ' << tables.back()[0].size();
      for (const auto& row : tables.back()) {
        for (const double value : row) {
          stream << ' ' << fmt::format("{:.17g}", value);
        }
      }
      stream << '\n';
    }
  }
  const auto lines = RunR(file);
  ASSERT_EQ(lines.size(), tables.size());
  constexpr double kTolerance = 1e-10;  // Relative, and absolute of p; observed: see below.
  double worst = 0;
  int compared = 0;
  int skipped = 0;
  int undefined = 0;
  for (std::size_t i = 0; i < tables.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "draw " << i);
    const std::vector<double> ours = CalcFigures(tables[i]);
    std::istringstream words(lines[i]);
    std::size_t at = 0;
    for (std::string word; words >> word; ++at) {
      ASSERT_LT(at, ours.size());
      if (word == "skip") {
        ++skipped;
        continue;
      }
      ++compared;
      if (word == "NA") {
        ++undefined;
        EXPECT_TRUE(std::isnan(ours[at])) << "figure " << at;
        continue;
      }
      const double theirs = std::strtod(word.c_str(), nullptr);
      const double error = std::abs(ours[at] - theirs) / std::max(1.0, std::abs(theirs));
      EXPECT_LE(error, kTolerance) << "figure " << at << ": " << ours[at] << ", R " << word;
      worst = std::max(worst, error);
    }
    EXPECT_EQ(at, ours.size());
  }
  EXPECT_GT(compared, 9000);
  EXPECT_GT(undefined, 0);
  EXPECT_LT(skipped, 1000);
  RecordProperty("compared", compared);
  RecordProperty("worst", fmt::format("{:.3g}", worst));
  fmt::print(
      "{} figures compared, {} not defined to both, {} exact p not known to R, worst {:.2g}\n",
      compared, undefined, skipped, worst);
}

}  // namespace
}  // namespace hvas::statistics
