#include "study/identification.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/random.h"
#include "fits/actual_size.h"
#include "fits/paper_scales.h"
#include "haptics/force_map.h"

namespace hvas::study {
namespace {

using Curve = std::vector<double>;  // Felt force at the looks [N].

/** What training taught of a fit: the mean of its curves, and how far they stray from it. */
struct Template {
  Curve mean;
  Curve variance;  // [N^2]
};

/** Draws pairs of a fit with the size and length of paper W's rig. */
PairSource MakeRigSource(const char* name, fits::PairChoice choice) {
  // Names of this file, at a size that the standard has.
  const fits::FitLimits limits =
      *fits::CalcFitLimits(*fits::ParseFit(name), fits::kPaperRig.diameter);
  fits::PairToDraw pair;
  pair.hole.zone = limits.hole;
  pair.shaft.zone = limits.shaft;
  pair.kind = limits.kind;
  pair.choice = choice;
  return [pair](std::uint64_t seed) {
    Random random(seed);
    fits::FitForceParameters parameters;
    parameters.nominal_diameter = fits::kPaperRig.diameter;
    parameters.length = fits::kPaperRig.length;
    static_cast<void>(fits::DrawPair(pair, &random, &parameters));
    // Sizes of standard classes are in the range of every parameter.
    return ShownPair{std::make_shared<fits::FitForce>(*fits::FitForce::Make(parameters)),
                     pair.kind};
  };
}

/** What is perceived of a pair, and what training leaves of it. */
class Perception {
 public:
  explicit Perception(const ObserverOptions& options) : options_(options), random_(options.seed) {}

  /** What the observer perceives of one insertion; `felt_end` is what is shown at full depth. */
  Curve Perceive(const ShownPair& pair, double* felt_end) {
    const fits::FitForce& fit = *pair.fit;
    const double beside = std::hypot(random_.Normal(), random_.Normal()) * options_.aim_error;
    const double bias = 1 + options_.observer.weber * random_.Normal();
    const auto felt = [&](double depth) {
      const double side = options_.friction * options_.coupling_stiffness *
                          std::max(0.0, beside - fit.CalcRadialPlay(depth));
      return CalcFeltForce(fit, pair.kind, depth, side, options_.map, options_.device,
                           options_.paper_factors);
    };
    Curve curve;
    for (int i = 0; i < options_.observer.looks; ++i) {
      const double f = felt(fit.length() * (i + 0.5) / options_.observer.looks);
      curve.push_back(bias * f + std::sqrt(CalcVariance(f * f)) * random_.Normal());
    }
    *felt_end = felt(fit.length());
    return curve;
  }

  Template Learn(const PairSource& source) {
    Template t;
    double ignored = 0;
    t.mean.assign(static_cast<std::size_t>(options_.observer.looks), 0.0);
    t.variance = t.mean;
    for (int i = 0; i < options_.training; ++i) {
      const Curve curve = Perceive(source(random_.NextBits()), &ignored);
      for (std::size_t k = 0; k < curve.size(); ++k) {
        t.mean[k] += curve[k] / options_.training;
        t.variance[k] += curve[k] * curve[k] / options_.training;
      }
    }
    for (std::size_t k = 0; k < t.mean.size(); ++k) {
      t.variance[k] = std::max(CalcVariance(0), t.variance[k] - t.mean[k] * t.mean[k]);
    }
    return t;
  }

 private:
  /** Of a look at a force, from the force's square. */
  [[nodiscard]] double CalcVariance(double square) const {
    const Observer& o = options_.observer;
    return o.weber * o.weber * square + o.threshold * o.threshold;
  }

  ObserverOptions options_;
  Random random_;
};

/** Distance of a curve to a template, in units of how far the template's curves stray. */
double CalcDistance(const Curve& curve, const Template& t) {
  double distance = 0;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const double d = curve[k] - t.mean[k];
    distance += d * d / t.variance[k] + std::log(t.variance[k]);
  }
  return distance;
}

Result<void> FailRange(const char* what, double value, const char* range) {
  return Fail(ErrorCode::kInvalid, fmt::format("{} is {:g}, but must be {}", what, value, range),
              "identification", "give a number in that range");
}

Result<void> Check(const ObserverOptions& o) {
  if (o.training < 1 || o.training > 1'000'000) {
    return FailRange("the number of insertions in training", o.training, "1 to 1,000,000");
  }
  if (o.observer.looks < 1 || o.observer.looks > 1000) {
    return FailRange("the number of looks", o.observer.looks, "1 to 1000");
  }
  if (!(o.observer.weber >= 0 && o.observer.weber < 1)) {
    return FailRange("the observer's Weber fraction", o.observer.weber, "at least 0 and below 1");
  }
  if (!(o.observer.threshold > 0 && std::isfinite(o.observer.threshold))) {
    return FailRange("the observer's threshold [N]", o.observer.threshold, "over 0");
  }
  return {};
}

}  // namespace

double ObserverResult::CalcShare(int fit) const noexcept {
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
                     const device::DeviceProfile& device, const haptics::PaperFactors& factors) {
  const double force = fit.CalcAxialResistance(depth);
  if (map == haptics::ForceMapKind::kPaper) {
    return std::min(factors.Of(kind) * force + side_friction,
                    haptics::kLargestFeltShare * device.max_force);
  }
  return haptics::MakeForceMap(device).Felt(force + side_friction);
}

struct FitObserver::State {
  State(const ObserverOptions& options, const std::vector<PairSource>& alternatives)
      : perception(options) {
    for (const PairSource& source : alternatives) {
      templates.push_back(perception.Learn(source));
    }
  }

  Perception perception;
  std::vector<Template> templates;
};

FitObserver::FitObserver(std::unique_ptr<State> state) : state_(std::move(state)) {}

FitObserver::FitObserver(FitObserver&&) noexcept = default;
FitObserver& FitObserver::operator=(FitObserver&&) noexcept = default;
FitObserver::~FitObserver() = default;

Result<FitObserver> FitObserver::Train(const ObserverOptions& options,
                                       const std::vector<PairSource>& alternatives) {
  if (Result<void> check = Check(options); !check) {
    return Unexpected(check.error());
  }
  return FitObserver(std::make_unique<State>(options, alternatives));
}

std::size_t FitObserver::Answer(const ShownPair& pair, double* felt_end) {
  double end = 0;
  const Curve curve = state_->perception.Perceive(pair, &end);
  if (felt_end != nullptr) {
    *felt_end = end;
  }
  const auto& templates = state_->templates;
  const auto nearest =
      std::min_element(templates.begin(), templates.end(), [&](const auto& a, const auto& b) {
        return CalcDistance(curve, a) < CalcDistance(curve, b);
      });
  return static_cast<std::size_t>(nearest - templates.begin());
}

Result<ObserverResult> Identify(const IdentificationOptions& options) {
  if (options.trials < 1 || options.trials > 1'000'000) {
    return Unexpected(FailRange("the number of trials", options.trials, "1 to 1,000,000").error());
  }
  std::vector<PairSource> sources;
  sources.reserve(kShownFitNames.size());
  for (const char* name : kShownFitNames) {
    sources.push_back(MakeRigSource(name, options.pairs));
  }
  auto observer = FitObserver::Train(options, sources);
  if (!observer) {
    return Unexpected(observer.error());
  }
  Random random(~options.seed);  // not the stream of the observer
  ObserverResult result;
  for (int shown = 0; shown < kShownFits; ++shown) {
    const auto i = static_cast<std::size_t>(shown);
    double sum = 0;
    double squares = 0;
    for (int trial = 0; trial < options.trials; ++trial) {
      double felt_end = 0;
      const std::size_t answered = observer->Answer(sources[i](random.NextBits()), &felt_end);
      ++result.counts[i][answered];
      sum += felt_end;
      squares += felt_end * felt_end;
    }
    result.mean_felt[i] = sum / options.trials;
    result.sigma_felt[i] = std::sqrt(
        std::max(0.0, squares / options.trials - result.mean_felt[i] * result.mean_felt[i]));
  }
  return result;
}

}  // namespace hvas::study
