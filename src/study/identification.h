#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/result.h"
#include "fits/fit_force.h"
#include "fits/iso286.h"
#include "fits/pair_choice.h"
#include "haptics/options.h"

/** Blind identification of fits (W12) by a simulated observer, to compare ways of showing forces
 before people do. It stands for nobody: a study with people is what paper W did. */
namespace hvas::study {

/** Experiments B1, B2 and B3 of paper W: 40 mm, hub 80 mm, 50 mm long, steel. */
inline constexpr int kShownFits = 3;
inline constexpr std::array<const char*, kShownFits> kShownFitNames{"H7/g6", "H7/p6", "H7/k6"};

/** Right answers of paper W's fifteen participants, of 225 for each fit (its table 2). */
inline constexpr std::array<int, kShownFits> kPaperRight{205, 181, 174};
inline constexpr int kPaperTrials = 225;

/** What limits the observer. Noise of one look at a force f has the standard deviation
 sqrt((weber f)^2 + threshold^2); the whole of a trial is off by another factor of 1 + weber N(0,
 1), for people do not average a bias away.

 Pang, Tan and Durlach, Perception & Psychophysics 49(6), 1991: a just noticeable difference of 7 %
 from 2.5 to 10 N; with d' = 1 that is the deviation of one look. Jones, in Human and Machine
 Haptics, 2000: 7 to 10 %, more below 0.5 N. Here the upper end, and 0.1 N for what is weak. */
struct Observer {
  double weber{0.10};
  double threshold{0.1};  ///< [N]
  int looks{10};  ///< Looks at the force of one insertion, evenly over the depth, 1 to 1000.
};

/** What limits and moves the hand of an observer, and how forces are shown to it. */
struct ObserverOptions {
  int training{500};      ///< Insertions of each alternative, told which, for the templates.
  std::uint64_t seed{1};  ///< Any number.
  haptics::ForceMapKind map{haptics::ForceMapKind::kPublished};
  haptics::PaperFactors paper_factors;  ///< Used with the paper's map.
  device::DeviceProfile device;
  Observer observer;
  double aim_error{0.7e-3};         ///< Error of the hand beside the axis, each way [m].
  double coupling_stiffness{1000};  ///< [N/m]; presses the shaft aside, W(5).
  double friction{0.15};            ///< Force of its side on the hole [N].
};

/** A pair of parts that is shown. */
struct ShownPair {
  std::shared_ptr<const fits::FitForce> fit;
  fits::FitKind kind{fits::FitKind::kClearance};
};

/** Draws a pair of one alternative by a seed. */
using PairSource = std::function<ShownPair(std::uint64_t seed)>;

struct IdentificationOptions : ObserverOptions {
  int trials{1000};                                    ///< Trials of each fit, 1 to 1,000,000.
  fits::PairChoice pairs{fits::PairChoice::kOnePair};  ///< Surfaces are drawn anew every time.
};

/** What an observer answered to the fits shown. */
struct ObserverResult {
  /** [shown][answered], in the order of kShownFitNames. */
  std::array<std::array<int, kShownFits>, kShownFits> counts{};
  /** Felt force at full depth, mean and standard deviation of the trials [N]. */
  std::array<double, kShownFits> mean_felt{};
  std::array<double, kShownFits> sigma_felt{};

  [[nodiscard]] double CalcShare(int fit) const noexcept;
};

/** Lower and upper end of the 95 % interval of a share (Wilson, J. Am. Stat. Assoc. 22, 1927). */
struct ShareInterval {
  double low{0};
  double high{1};
};

[[nodiscard]] ShareInterval CalcShareInterval(int right, int trials) noexcept;

/** What the hand feels of a fit that is pressed in: the map of its force and the friction of its
 side [N]. The same as in the tick while it slides (HapticTick). */
[[nodiscard]] double CalcFeltForce(const fits::FitForce& fit, fits::FitKind kind, double depth,
                                   double side_friction, haptics::ForceMapKind map,
                                   const device::DeviceProfile& device,
                                   const haptics::PaperFactors& factors = {});

/** The observer, trained, to be shown pairs in any order. Repeats exactly. */
class FitObserver {
 public:
  /** Trains an observer with pairs of each alternative. Errors: kInvalid for options out of their
   ranges. @pre at least one alternative. */
  [[nodiscard]] static Result<FitObserver> Train(const ObserverOptions& options,
                                                 const std::vector<PairSource>& alternatives);

  FitObserver(FitObserver&&) noexcept;
  FitObserver& operator=(FitObserver&&) noexcept;
  ~FitObserver();

  /** Shows a pair, and has the observer say which alternative it is: an index.
   @param felt_end  Receives the force at full depth [N]; may be null. */
  std::size_t Answer(const ShownPair& pair, double* felt_end = nullptr);

 private:
  struct State;
  explicit FitObserver(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/** Shows every fit `trials` times; the observer answers with the nearest of three templates of felt
 force over depth. A template is the mean of the curves of a training, and at every look how far
 they strayed; nearest is the likeliest, were the looks independent and normal. Repeats exactly.
 Errors: kInvalid for options out of their ranges. */
[[nodiscard]] Result<ObserverResult> Identify(const IdentificationOptions& options);

}  // namespace hvas::study
