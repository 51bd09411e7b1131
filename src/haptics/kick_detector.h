#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "spatial/pose.h"

namespace hvas::haptics {

/** What a hand and a force can do to a handle, at most. SI. */
struct KickThresholds {
  double resolution{23e-6};  ///< Of the encoders [m].
  double max_force{7.9};     ///< Of the motors [N].
  double mass{0.1};          ///< Of the mechanism at the handle [kg].
  double min_force{0.4};     ///< Below this a force tells nothing of its direction [N].
  double hand{3};            ///< A hand that presses changes its acceleration by less [m/s^2].
  double blow{80};           ///< A hand changes its acceleration by less, whatever it does [m/s^2].
};

enum class Kick : std::uint8_t {
  kNone,
  kAgainst,  ///< It speeds up against the force that it is given: the force has the wrong sign.
  kRunaway,  ///< It speeds up more than hand and motors together explain.
};

/** Compares where the handle is with where it would be, had it gone on as before. The deviation

     e = (x_k - x_{k-h}) - (x_{k-h} - x_{k-2h})

 is what forces have changed meanwhile. A hand that pushes against a force is held back by it, and
 what the hand itself adds comes slowly; a handle that speeds up against its force is driven by it.
 h is 4, 8 and 16 ms: the shorter, the larger a deviation has to be to stand out of the encoders'
 steps. RT-safe. */
class KickDetector {
 public:
  explicit KickDetector(const KickThresholds& thresholds) noexcept : thresholds_(thresholds) {}

  /** One tick: the hand's position, and the force that acts on it since the last one, both in one
   frame that does not turn [m, N]. */
  Kick Update(const Vec3& p, const Vec3& f, double dt) noexcept;

  void Reset() noexcept { *this = KickDetector(thresholds_); }

 private:
  static constexpr std::size_t kSize = 256;  // 32 ms at 8 kHz

  struct Sample {
    double time{0};
    Vec3 p{Vec3::Zero()};
    double force{0};  ///< Norm.
  };

  [[nodiscard]] const Sample* FindBefore(double age) const noexcept;
  [[nodiscard]] Kick Judge(double span, const Vec3& f) const noexcept;

  KickThresholds thresholds_;
  double time_{0};
  std::array<Sample, kSize> samples_{};  ///< Ring.
  std::size_t newest_{0};
  std::size_t count_{0};
};

}  // namespace hvas::haptics
