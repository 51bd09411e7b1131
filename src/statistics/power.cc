#include "statistics/power.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "base/random.h"
#include "statistics/rank_tests.h"

namespace hvas::statistics {
namespace {

// Fewer have no variance to speak of; more conditions nobody stands. Choices.
constexpr int kLeastParticipants = 3;
constexpr std::size_t kMostConditions = 20;

Unexpected Refuse(std::string what, std::string where, std::string remedy) {
  return Fail(ErrorCode::kInvalid, std::move(what), std::move(where), std::move(remedy));
}

Result<void> CheckSpread(const std::vector<double>& centers, const std::vector<double>& spreads,
                         double correlation) {
  if (spreads.size() != centers.size()) {
    return Refuse(
        fmt::format("{} standard deviations for {} conditions", spreads.size(), centers.size()),
        "design", "give one, or one for each condition");
  }
  for (std::size_t i = 0; i < centers.size(); ++i) {
    if (!std::isfinite(centers[i]) || !(spreads[i] > 0) || !std::isfinite(spreads[i])) {
      return Refuse(fmt::format("{} with a standard deviation of {}", centers[i], spreads[i]),
                    fmt::format("design, condition {}", i + 1),
                    "give finite values and standard deviations above zero");
    }
  }
  if (!(correlation >= 0 && correlation < 1)) {
    return Refuse(fmt::format("{} is not a valid correlation", correlation), "design",
                  "give a number of at least 0 and below 1");
  }
  return {};
}

struct CheckDesign {
  Result<void> operator()(const NormalDesign& d) const {
    return CheckSpread(d.means, d.sds, d.correlation);
  }

  Result<void> operator()(const LogNormalDesign& d) const {
    for (const double median : d.medians) {
      if (!(median > 0)) {
        return Refuse(fmt::format("a median of {}", median), "design", "give medians above zero");
      }
    }
    return CheckSpread(d.medians, d.log_sds, d.correlation);
  }

  Result<void> operator()(const CountDesign& d) const {
    constexpr int kMostTrials = 10'000;  // More than a person can do: a choice.
    if (d.of < 1 || d.of > kMostTrials) {
      return Refuse(fmt::format("counts of {} trials", d.of), "design",
                    fmt::format("give from 1 to {}", kMostTrials));
    }
    for (const double share : d.shares) {
      if (!(share >= 0 && share <= 1)) {
        return Refuse(fmt::format("{} is not a share of correct answers", share), "design",
                      "give numbers from 0 to 1");
      }
    }
    return {};
  }

  Result<void> operator()(const PilotDesign& d) const {
    if (d.rows.size() < 2) {
      return Refuse(fmt::format("a pilot of {} complete participants", d.rows.size()), "design",
                    "give at least two who have all conditions");
    }
    for (const std::vector<double>& row : d.rows) {
      if (row.size() != d.rows[0].size() ||
          !std::all_of(row.begin(), row.end(), [](double v) { return std::isfinite(v); })) {
        return Refuse("rows of the pilot are not complete", "design", "omit those rows");
      }
    }
    return {};
  }
};

/** One participant more. */
struct DrawRow {
  Random* random;

  std::vector<double> operator()(const NormalDesign& d) const {
    std::vector<double> row(d.means.size());
    const double own = random->Normal();
    for (std::size_t j = 0; j < row.size(); ++j) {
      row[j] = d.means[j] + d.sds[j] * (std::sqrt(d.correlation) * own +
                                        std::sqrt(1 - d.correlation) * random->Normal());
    }
    return row;
  }

  std::vector<double> operator()(const LogNormalDesign& d) const {
    // Not of the logarithm: Wilcoxon's ranks are those of differences of the times themselves.
    std::vector<double> row =
        (*this)(NormalDesign{std::vector<double>(d.medians.size(), 0.0), d.log_sds, d.correlation});
    for (std::size_t j = 0; j < row.size(); ++j) {
      row[j] = d.medians[j] * std::exp(row[j]);
    }
    return row;
  }

  std::vector<double> operator()(const CountDesign& d) const {
    std::vector<double> row;
    for (const double share : d.shares) {
      int right = 0;
      for (int i = 0; i < d.of; ++i) {
        right += random->Uniform() < share ? 1 : 0;
      }
      row.push_back(right);
    }
    return row;
  }

  std::vector<double> operator()(const PilotDesign& d) const {
    return d.rows[static_cast<std::size_t>(random->Uniform() * static_cast<double>(d.rows.size()))];
  }
};

/** Did a study of so many participants find a difference? */
Result<bool> RunStudy(const Design& design, const PowerOptions& options, int participants,
                      std::uint64_t run) {
  Random random(options.seed * 0xD1342543DE82EF95U + run);  // Every run has its own people.
  std::vector<std::vector<double>> rows;
  rows.reserve(static_cast<std::size_t>(participants));
  for (int i = 0; i < participants; ++i) {
    rows.push_back(std::visit(DrawRow{&random}, design));
  }
  std::optional<double> p;
  if (options.test == PowerTest::kFriedman) {
    const auto friedman = TestFriedman(rows, Exact::kNo);
    if (!friedman) {
      return Unexpected(friedman.error());
    }
    p = friedman->p;
  } else {
    std::vector<double> first;
    std::vector<double> second;
    for (const std::vector<double>& row : rows) {
      first.push_back(row[0]);
      second.push_back(row[1]);
    }
    const auto wilcoxon = TestWilcoxon(first, second, Exact::kNo);
    if (!wilcoxon) {
      return Unexpected(wilcoxon.error());
    }
    p = wilcoxon->p;
  }
  return p.value_or(1) <= options.alpha;  // What is not defined finds nothing.
}

Result<void> Check(const Design& design, const PowerOptions& options) {
  const std::size_t conditions = CountConditions(design);
  if (options.test == PowerTest::kWilcoxon && conditions != 2) {
    return Refuse(fmt::format("{} conditions", conditions), "Wilcoxon test",
                  "give two, or use the Friedman test");
  }
  if (conditions < 2 || conditions > kMostConditions) {
    return Refuse(fmt::format("{} conditions", conditions), "design",
                  fmt::format("give from 2 to {}", kMostConditions));
  }
  if (!(options.alpha > 0 && options.alpha < 0.5)) {
    return Refuse(fmt::format("{} is not a significance level", options.alpha), "alpha",
                  "give a number above 0 and below 0.5");
  }
  if (!(options.target > 0 && options.target < 1)) {
    return Refuse(fmt::format("{} is not a power", options.target), "power",
                  "give a number between 0 and 1");
  }
  if (options.runs < 100 || options.runs > 1'000'000) {
    return Refuse(fmt::format("{} runs", options.runs), "runs", "give from 100 to 1000000");
  }
  if (options.most < kLeastParticipants || options.most > 10'000) {
    return Refuse(fmt::format("{} participants at most", options.most), "participants",
                  fmt::format("give from {} to 10000", kLeastParticipants));
  }
  return std::visit(CheckDesign(), design);
}

}  // namespace

std::size_t CountConditions(const Design& design) {
  struct Count {
    std::size_t operator()(const NormalDesign& d) const { return d.means.size(); }

    std::size_t operator()(const LogNormalDesign& d) const { return d.medians.size(); }

    std::size_t operator()(const CountDesign& d) const { return d.shares.size(); }

    std::size_t operator()(const PilotDesign& d) const {
      return d.rows.empty() ? 0 : d.rows[0].size();
    }
  };

  return std::visit(Count(), design);
}

Result<PowerPoint> EstimatePower(const Design& design, const PowerOptions& options,
                                 int participants, const PowerProgress& progress) {
  if (const auto checked = Check(design, options); !checked) {
    return Unexpected(checked.error());
  }
  if (participants < kLeastParticipants || participants > options.most) {
    return Refuse(fmt::format("{} participants", participants), "participants",
                  fmt::format("give from {} to {}", kLeastParticipants, options.most));
  }
  constexpr int kSteps = 50;  // In which progress is told.
  int found = 0;
  for (int run = 0; run < options.runs; ++run) {
    const auto is_found = RunStudy(design, options, participants, static_cast<std::uint64_t>(run));
    if (!is_found) {
      return Unexpected(is_found.error());
    }
    found += *is_found ? 1 : 0;
    if (progress && run % std::max(1, options.runs / kSteps) == 0) {
      progress(participants, static_cast<double>(run) / options.runs);
    }
  }
  const auto power = CalcShare(found, options.runs);
  if (!power) {
    return Unexpected(power.error());
  }
  return PowerPoint{participants, *power,
                    std::sqrt(power->share * (1 - power->share) / options.runs)};
}

Result<PowerResult> FindSampleSize(const Design& design, const PowerOptions& options,
                                   const PowerProgress& progress) {
  PowerResult result;
  int below = kLeastParticipants - 1;  // Too few.
  int enough = 0;                      // Zero: not found yet.
  for (int n = std::min(4, options.most); enough == 0 || enough - below > 1;) {
    const auto point = EstimatePower(design, options, n, progress);
    if (!point) {
      return Unexpected(point.error());
    }
    result.points.push_back(*point);
    if (point->power.share >= options.target) {
      enough = n;
    } else if (n == options.most) {
      break;
    } else {
      below = n;
    }
    n = enough == 0 ? std::min(2 * n, options.most) : (below + enough) / 2;
  }
  if (enough > 0) {
    result.participants = enough;
  }
  std::sort(
      result.points.begin(), result.points.end(),
      [](const PowerPoint& a, const PowerPoint& b) { return a.participants < b.participants; });
  return result;
}

}  // namespace hvas::statistics
