#include "simulation/identification.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/random.h"
#include "fits/actual_size.h"
#include "fits/paper_scales.h"
#include "haptics/force_map.h"

namespace hvas::simulation {
namespace {

using Curve = std::vector<double>;  // Felt force at the looks [N].

/** What training taught of a fit: the mean of its curves, and how far they stray from it. */
struct Template {
  Curve mean;
  Curve variance;  // [N^2]
};

/** True where the pair is what its class is called. */
bool IsOfKind(const fits::FitForce& fit, fits::FitKind kind) {
  const auto [least, most] = std::minmax_element(fit.clearances().begin(), fit.clearances().end());
  switch (kind) {
    case fits::FitKind::kClearance:
      return *least > 0;
    case fits::FitKind::kInterference:
      return *most < 0;
    case fits::FitKind::kTransition:
      break;
  }
  return *least < 0 && *most > 0;
}

/** Draws what is shown, and what is perceived of it. */
class Experiment {
 public:
  explicit Experiment(const IdentificationOptions& options)
      : options_(options), random_(options.seed) {
    for (const char* name : kShownFitNames) {
      // Both are constants of this file's.
      limits_.push_back(*fits::CalcFitLimits(*fits::ParseFit(name), fits::kPaperRig.diameter));
      kinds_.push_back(limits_.back().kind);
    }
  }

  /** What the observer perceives of one insertion; `felt_end` is what is shown at full depth. */
  Curve Perceive(int shown, double* felt_end) {
    const fits::FitForce fit = DrawFit(static_cast<std::size_t>(shown));
    const fits::FitKind kind = kinds_[static_cast<std::size_t>(shown)];
    const double beside = std::hypot(random_.Normal(), random_.Normal()) * options_.aim_error;
    const double bias = 1 + options_.observer.weber * random_.Normal();
    const auto felt = [&](double depth) {
      const double side = options_.friction * options_.coupling_stiffness *
                          std::max(0.0, beside - fit.CalcRadialPlay(depth));
      return CalcFeltForce(fit, kind, depth, side, options_.map, options_.device);
    };
    Curve curve;
    for (int i = 0; i < options_.observer.looks; ++i) {
      const double f = felt(fits::kPaperRig.length * (i + 0.5) / options_.observer.looks);
      curve.push_back(bias * f + std::sqrt(CalcVariance(f * f)) * random_.Normal());
    }
    *felt_end = felt(fits::kPaperRig.length);
    return curve;
  }

  std::array<Template, kShownFits> Train() {
    std::array<Template, kShownFits> templates;
    double ignored = 0;
    for (int shown = 0; shown < kShownFits; ++shown) {
      Template& t = templates[static_cast<std::size_t>(shown)];
      t.mean.assign(static_cast<std::size_t>(options_.observer.looks), 0.0);
      t.variance = t.mean;
      for (int i = 0; i < options_.training; ++i) {
        const Curve curve = Perceive(shown, &ignored);
        for (std::size_t k = 0; k < curve.size(); ++k) {
          t.mean[k] += curve[k] / options_.training;
          t.variance[k] += curve[k] * curve[k] / options_.training;
        }
      }
      for (std::size_t k = 0; k < t.mean.size(); ++k) {
        t.variance[k] = std::max(CalcVariance(0), t.variance[k] - t.mean[k] * t.mean[k]);
      }
    }
    return templates;
  }

  /** Of the nearest template, in units of how far its curves stray. */
  [[nodiscard]] std::size_t Answer(const Curve& curve,
                                   const std::array<Template, kShownFits>& templates) const {
    std::array<double, kShownFits> distance{};
    for (std::size_t j = 0; j < templates.size(); ++j) {
      const Template& t = templates[j];
      for (std::size_t k = 0; k < curve.size(); ++k) {
        const double d = curve[k] - t.mean[k];
        distance[j] += d * d / t.variance[k] + std::log(t.variance[k]);
      }
    }
    return static_cast<std::size_t>(std::min_element(distance.begin(), distance.end()) -
                                    distance.begin());
  }

 private:
  /** Of a look at a force, from the force's square. */
  [[nodiscard]] double CalcVariance(double square) const {
    const Observer& o = options_.observer;
    return o.weber * o.weber * square + o.threshold * o.threshold;
  }

  fits::FitForce DrawFit(std::size_t shown) {
    const fits::FitLimits& limits = limits_[shown];
    for (;;) {
      fits::FitForceParameters p;
      p.nominal_diameter = fits::kPaperRig.diameter;
      p.length = fits::kPaperRig.length;
      p.hole_diameter = p.shaft_diameter = fits::kPaperRig.diameter;
      if (options_.sizes != ShownSizes::kOnePair) {
        p.hole_diameter += fits::DrawDeviation(limits.hole, &random_);
        p.shaft_diameter += fits::DrawDeviation(limits.shaft, &random_);
      } else if (kinds_[shown] != fits::FitKind::kTransition) {
        p.hole_diameter += 0.5 * (limits.hole.lower + limits.hole.upper);
        p.shaft_diameter += 0.5 * (limits.shaft.lower + limits.shaft.upper);
      }
      p.seed = random_.NextBits();
      // Sizes of standard classes are in the range of every parameter.
      fits::FitForce fit = *fits::FitForce::Make(p);
      if (options_.sizes != ShownSizes::kOfKind || IsOfKind(fit, kinds_[shown])) {
        return fit;
      }
    }
  }

  IdentificationOptions options_;
  Random random_;
  std::vector<fits::FitLimits> limits_;
  std::vector<fits::FitKind> kinds_;
};

Result<void> Check(const IdentificationOptions& o) {
  const auto fail = [](const char* what, double value, const char* range) {
    return Fail(ErrorCode::kInvalid, fmt::format("{} is {:g}, but must be {}", what, value, range),
                "identification", "give a number in that range");
  };
  if (o.trials < 1 || o.trials > 1'000'000) {
    return fail("the number of trials", o.trials, "1 to 1,000,000");
  }
  if (o.training < 1 || o.training > 1'000'000) {
    return fail("the number of insertions in training", o.training, "1 to 1,000,000");
  }
  if (o.observer.looks < 1 || o.observer.looks > 1000) {
    return fail("the number of looks", o.observer.looks, "1 to 1000");
  }
  if (!(o.observer.weber >= 0 && o.observer.weber < 1)) {
    return fail("the observer's Weber fraction", o.observer.weber, "at least 0 and below 1");
  }
  if (!(o.observer.threshold > 0 && std::isfinite(o.observer.threshold))) {
    return fail("the observer's threshold [N]", o.observer.threshold, "over 0");
  }
  return {};
}

}  // namespace

double Identification::CalcShare(int fit) const noexcept {
  const auto& row = counts[static_cast<std::size_t>(fit)];
  const int sum = row[0] + row[1] + row[2];
  return sum > 0 ? static_cast<double>(row[static_cast<std::size_t>(fit)]) / sum : 0;
}

ShareInterval CalcShareInterval(int right, int trials) noexcept {
  constexpr double kZ = 1.959963984540054;  // 97.5 % of the normal distribution lie below.
  if (trials <= 0) {
    return {};
  }
  const double n = trials;
  const double p = right / n;
  const double middle = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return {middle - half, middle + half};
}

double CalcFeltForce(const fits::FitForce& fit, fits::FitKind kind, double depth,
                     double side_friction, haptics::ForceMapKind map,
                     const device::DeviceProfile& device) {
  const double force = fit.CalcAxialResistance(depth);
  if (map == haptics::ForceMapKind::kPaper) {
    return std::min(fits::FindPaperScale(kind).factor * force + side_friction,
                    haptics::kLargestFeltShare * device.max_force);
  }
  return haptics::MakeForceMap(device).Felt(force + side_friction);
}

struct FitObserver::State {
  explicit State(const IdentificationOptions& options)
      : experiment(options), templates(experiment.Train()) {}

  Experiment experiment;
  std::array<Template, kShownFits> templates;
};

FitObserver::FitObserver(std::unique_ptr<State> state) : state_(std::move(state)) {}

FitObserver::FitObserver(FitObserver&&) noexcept = default;
FitObserver& FitObserver::operator=(FitObserver&&) noexcept = default;
FitObserver::~FitObserver() = default;

Result<FitObserver> FitObserver::Train(const IdentificationOptions& options) {
  if (Result<void> check = Check(options); !check) {
    return Unexpected(check.error());
  }
  return FitObserver(std::make_unique<State>(options));
}

int FitObserver::Answer(int shown, double* felt_end) {
  double end = 0;
  const Curve curve = state_->experiment.Perceive(shown, &end);
  if (felt_end != nullptr) {
    *felt_end = end;
  }
  return static_cast<int>(state_->experiment.Answer(curve, state_->templates));
}

Result<Identification> Identify(const IdentificationOptions& options) {
  auto observer = FitObserver::Train(options);
  if (!observer) {
    return Unexpected(observer.error());
  }
  Identification result;
  for (int shown = 0; shown < kShownFits; ++shown) {
    const auto i = static_cast<std::size_t>(shown);
    double sum = 0;
    double squares = 0;
    for (int trial = 0; trial < options.trials; ++trial) {
      double felt_end = 0;
      const int answered = observer->Answer(shown, &felt_end);
      ++result.counts[i][static_cast<std::size_t>(answered)];
      sum += felt_end;
      squares += felt_end * felt_end;
    }
    result.mean_felt[i] = sum / options.trials;
    result.sigma_felt[i] = std::sqrt(
        std::max(0.0, squares / options.trials - result.mean_felt[i] * result.mean_felt[i]));
  }
  return result;
}

}  // namespace hvas::simulation
