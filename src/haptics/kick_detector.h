#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "spatial/pose.h"

namespace hvas::haptics {

/** What a hand and a force can do to a handle, at most. SI. */
struct KickThresholds {
  double resolution{23e-6};  ///< Resolution of the encoders [m].
  double mass{0.1};          ///< Mass of the mechanism at the handle [kg].
  double min_force{0.3};     ///< Below this a force tells nothing of its direction [N].
  double jerk{200};          ///< A hand that works changes its acceleration no faster [m/s^3].
  double blow{80};           ///< Hands change the acceleration by less, whatever they do [m/s^2].
};

enum class Kick : std::uint8_t {
  kNone,
  kAgainst,  ///< It speeds up against the force that it is given: the force has the wrong sign.
  kRunaway,  ///< It speeds up more than hand and motors together explain.
};

/** Compares where the handle is with where it would be, had nothing that acts on it changed. The
 deviation

     e = x_k - 3 x_(k-h) + 3 x_(k-2h) - x_(k-3h)

 is zero under any constant force of the hand, whatever its size, and h^2 (change of force) / mass
 after a change. A hand changes its force slowly, and a motor's force is known; what changes fast
 and against that force is a force of the wrong sign. h is 4 to 12 ms: the shorter, the larger e has
 to be to stand out of the encoders' steps; the longer, the more a hand explains. A position between
 two samples that are further apart than h is not known, so that h tells nothing. RT-safe. */
class KickDetector {
 public:
  explicit KickDetector(const KickThresholds& thresholds) noexcept : thresholds_(thresholds) {}

  /** One tick: the hand's position, and the force that acts on it since the last one, both in one
   frame that does not turn [m, N]. */
  Kick Update(const Vec3& p, const Vec3& f, double dt) noexcept;

  void Reset() noexcept { *this = KickDetector(thresholds_); }

 private:
  static constexpr std::size_t kSize = 320;  // 36 ms at 8 kHz.

  struct Sample {
    double time{0};
    Vec3 p{Vec3::Zero()};
    double force{0};  ///< Norm.
  };

  /** What happened within three spans. */
  struct Window {
    Vec3 deviation{Vec3::Zero()};  ///< e
    Vec3 moved{Vec3::Zero()};      ///< Values of the last span.
    Vec3 moved_before{Vec3::Zero()};
    double most_force{0};
    double least_force{0};
  };

  [[nodiscard]] const Sample& FindBack(std::size_t ticks) const noexcept;
  [[nodiscard]] bool FindWindow(double span, Window* window) const noexcept;
  [[nodiscard]] Kick Judge(const Window& window, double span, const Vec3& f) const noexcept;

  KickThresholds thresholds_;
  double time_{0};
  std::array<Sample, kSize> samples_{};  ///< Ring.
  std::size_t newest_{0};
  std::size_t count_{0};
};

}  // namespace hvas::haptics
