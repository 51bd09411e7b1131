#pragma once

namespace hvas::haptics {

/** The one map from true to felt magnitudes (N4, W9), the same for every fit:

     felt(F) = F                       for F <= F_lin
     felt(F) = F_lin (1 + ln(F/F_lin)) above,

 continuous with a continuous slope, strictly increasing, hence invertible: the hand can tell any
 two forces apart that differ enough, and the true force is known from the felt one. F_lin follows
 from one statement about the device: the largest true force of interest is felt at its full
 force. */
class ForceMap {
 public:
  /** @param largest_true  True magnitude to be felt as `largest_felt` [N or N m]; greater than it.
   @param largest_felt  What the device can give [N or N m], > 0. */
  ForceMap(double largest_true, double largest_felt);

  /** Felt magnitude of a true magnitude >= 0. RT-safe. */
  [[nodiscard]] double Felt(double true_magnitude) const noexcept;
  /** Inverse of Felt. RT-safe. */
  [[nodiscard]] double True(double felt_magnitude) const noexcept;

  /** End of the linear part [N or N m]. */
  [[nodiscard]] double linear_limit() const noexcept { return linear_limit_; }

 private:
  double linear_limit_;
};

}  // namespace hvas::haptics
