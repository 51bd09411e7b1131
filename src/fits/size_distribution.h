#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "fits/iso286.h"

namespace hvas::fits {

/** How a diameter of a batch is distributed, as deviations from the nominal size [m]. Immutable. */
class SizeDistribution {
 public:
  /** Paper W's: normal over the whole micrometres of a zone, mean in its middle, sigma a sixth of
   it, cut off at the limits and normalised (W2). */
  [[nodiscard]] static SizeDistribution FromZone(const Limits& limits);

  /** Normal, of a process with these capabilities against the limits:
     sigma = T / (6 C_p),  |mean - middle| = T / 2 - 3 sigma C_pk,
   the mean above the middle when `is_shifted_up`. Nothing is cut off. ISO 22514-2.
   Errors: kInvalid unless 0 < C_pk <= C_p and the zone has a width. */
  [[nodiscard]] static Result<SizeDistribution> FromCapability(const Limits& limits, double cp,
                                                               double cpk, bool is_shifted_up);

  /** Anywhere between the limits alike. */
  [[nodiscard]] static SizeDistribution Uniform(const Limits& limits);

  /** Measured deviations, each as likely. Errors: kInvalid for none or what is not finite. */
  [[nodiscard]] static Result<SizeDistribution> FromMeasured(std::span<const double> deviations);

  /** The deviation below which a share u in (0, 1) of the batch lies. */
  [[nodiscard]] double Quantile(double u) const noexcept;

  /** The deviation that each 32 random bits stand for, less `origin` [m], in micrometres; of a
   normal distribution within 2e-4 sigma. @pre as many of both. */
  void ToDeviations(std::span<const std::uint32_t> bits, double origin,
                    std::span<float> deviations_um) const noexcept;

  [[nodiscard]] double mean() const noexcept { return mean_; }

  [[nodiscard]] double variance() const noexcept { return variance_; }

  /** Nothing is drawn outside of these; of a normal distribution 6.5 sigma either side. */
  [[nodiscard]] const Limits& bounds() const noexcept { return bounds_; }

 private:
  enum class Kind { kNormal, kUniform, kValues };

  SizeDistribution() = default;
  static SizeDistribution FromValues(std::vector<double> values,
                                     std::span<const double> probabilities);

  Kind kind_{Kind::kUniform};
  double mean_{0};
  double variance_{0};
  double sigma_{0};
  Limits bounds_;
  std::vector<double> values_;        // Increasing.
  std::vector<double> cumulative_;    // Of each value and those before it; the last is 1.
  std::vector<std::uint32_t> guide_;  // First value to look at, by the leading digits of u.
};

/** The inverse of the standard normal distribution, relative error below 1.2e-9 (P. J. Acklam's
 rational approximation); u in (0, 1). */
[[nodiscard]] double NormalQuantile(double u) noexcept;

}  // namespace hvas::fits
