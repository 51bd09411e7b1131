#pragma once

#include <array>
#include <cstddef>

#include "spatial/pose.h"

namespace hvas::simulation {

/** Movements of a hand one after the other, along lines and around the product, each of minimum
 jerk in time (Flash and Hogan, J. Neuroscience 5(7), 1985). RT-safe. */
class Reaches {
 public:
  /** Begins again, from here. @param centre_W  About which arcs go. */
  void Start(const spatial::Pose& X_from, const Vec3& centre_W) noexcept;

  /** Adds a movement to a pose, from where the one before ends.
   @param speed  Its mean speed [m/s].
   @param is_arc  It goes along a great circle about the centre, with the radius interpolated. */
  void Add(const spatial::Pose& X_to, double speed, bool is_arc) noexcept;

  /** Moves on by `dt` [s]. @returns whether all are done. */
  bool Follow(double dt) noexcept;

  [[nodiscard]] bool is_done() const noexcept { return index_ >= count_; }

  /** Where the reference is now. */
  [[nodiscard]] const spatial::Pose& X_WR() const noexcept { return X_WR_; }

  /** Duration of the first movement [s]. */
  [[nodiscard]] double first_duration() const noexcept { return reaches_[0].duration_s; }

  /** Changes where the first movement ends. */
  void Redirect(const Vec3& p_to) noexcept { reaches_[0].p_to = p_to; }

 private:
  struct Reach {
    Vec3 p_from{Vec3::Zero()}, p_to{Vec3::Zero()};
    Quat q_from{Quat::Identity()}, q_to{Quat::Identity()};
    bool is_arc{false};
    double duration_s{0};
  };

  static constexpr std::size_t kMost = 6;  // The longest plan has four.
  std::array<Reach, kMost> reaches_;
  std::size_t count_{0};
  std::size_t index_{0};
  double time_s_{0};
  spatial::Pose X_WR_;
  Vec3 centre_W_{Vec3::Zero()};
};

}  // namespace hvas::simulation
