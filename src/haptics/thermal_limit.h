#pragma once

namespace hvas::haptics {

/** How hard motors may push without growing hot: the mean square of what they gave, over about
 `time`, stays below the continuous force's. With the load q = mean square / continuous^2

     limit^2 = continuous^2 + (peak^2 - continuous^2) max(0, 1 - q)

 A cold motor gives its peak; as it warms the limit falls smoothly to what it stands for ever, and
 q never passes 1, as at q = 1 no more heat comes in than goes out. RT-safe. */
class ThermalLimit {
 public:
  /** @param continuous  Not below the peak, or not above zero (unknown): there is no limit but the
   peak.
   @param time  Over which the mean square is taken [s]. */
  ThermalLimit(double peak, double continuous, double time) noexcept;

  /** The most that may be given now, between the continuous and the peak force. */
  [[nodiscard]] double limit() const noexcept;

  /** So much was given for dt. */
  void Heat(double force, double dt) noexcept;

  /** Root of the mean square of what was given. */
  [[nodiscard]] double rms() const noexcept;

 private:
  [[nodiscard]] bool is_limited() const noexcept { return continuous_ > 0 && continuous_ < peak_; }

  double peak_;
  double continuous_;
  double time_;
  double mean_square_{0};
};

}  // namespace hvas::haptics
