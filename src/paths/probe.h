#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "paths/way.h"
#include "spatial/box.h"

namespace hvas::paths {

/** A displacement of the part: it turns by w_W about its centre, which goes along v_W. */
struct Displacement {
  Vec3 w_W{Vec3::Zero()};  ///< Rotation vector [rad].
  Vec3 v_W{Vec3::Zero()};  ///< [m]
};

/** The part among the bodies of a problem: answers contact queries, and counts them. */
class Probe {
 public:
  /** @param options  Budget of queries, after which is_over() is true; stop and progress. */
  Probe(const WayProblem& problem, const WayOptions& options);

  /** True where the part is no deeper in others than the tolerance. */
  [[nodiscard]] bool IsFree(const spatial::Pose& X_WB);
  /** The least distance to others, no more than `margin` [m]; what is near is in contacts(). */
  double Query(const spatial::Pose& X_WB, double margin);

  [[nodiscard]] std::span<const contact::Contact> contacts() const { return workspace_.contacts(); }

  /** How many points the last Query() found within its margin. */
  [[nodiscard]] std::uint32_t candidates() const { return workspace_.stats().candidates; }

  /** How far the boxes of part and bodies overlap [m]: what a straight move in the best direction
   needs; 0 where they are clear. */
  [[nodiscard]] double CalcOverlap(const spatial::Pose& X_WB) const;
  /** How far the part has to go straight along a unit direction until the boxes are clear [m]. */
  [[nodiscard]] double CalcExit(const spatial::Pose& X_WB, const Vec3& direction_W) const;

  [[nodiscard]] spatial::Pose Move(const spatial::Pose& X_WB, const Displacement& d) const;
  [[nodiscard]] Displacement CalcDisplacement(const spatial::Pose& from,
                                              const spatial::Pose& to) const;

  /** The most that a point of the part moves, at most [m]. */
  [[nodiscard]] double CalcReachOf(const Displacement& d) const {
    return d.v_W.norm() + reach_ * d.w_W.norm();
  }

  /** A contact at a point with a normal as a row for displacements (v_W, gyration w_W) about the
   part's centre: the product is by how much they separate it [m]. */
  [[nodiscard]] Vec6 RowOf(const Vec3& nhat_W, const Vec3& p_WC, const Vec3& centre_W) const;

  /** Length of a displacement in the metric of the search: turns count by the radius of gyration.
   */
  [[nodiscard]] double CalcLength(const Displacement& d) const;

  [[nodiscard]] const WayProblem& problem() const { return problem_; }

  [[nodiscard]] const Vec3& centre_B() const { return centre_B_; }

  [[nodiscard]] double size() const { return size_; }  ///< Diagonal of the part's box [m].

  /** Farther than this from others is clear [m]: a fiftieth of the part's size, a choice. */
  [[nodiscard]] double clear_distance() const { return 0.02 * size(); }

  [[nodiscard]] double reach() const { return reach_; }  ///< Farthest corner from the centre [m].

  [[nodiscard]] double gyration() const {
    return gyration_;
  }  ///< Radius of gyration of the box's corners and sides [m].

  [[nodiscard]] double tolerance() const { return problem_.tolerance; }

  /** The smallest length that steps are divided to [m]. */
  [[nodiscard]] double grain() const { return grain_; }

  /** Box around all bodies in W. */
  [[nodiscard]] const spatial::Box& around_W() const { return around_W_; }

  /** Gives those bodies that are there, without the part itself. */
  [[nodiscard]] std::span<const contact::BodyId> bodies() const { return bodies_; }

  [[nodiscard]] std::uint64_t queries() const { return queries_; }

  [[nodiscard]] std::uint64_t points() const { return points_; }

  [[nodiscard]] bool is_over() const {
    return queries_ >= budget_ || points_ >= options_.point_budget ||
           options_.stop.stop_requested();
  }

  void Extend(std::uint64_t queries) { budget_ = queries_ + queries; }

 private:
  [[nodiscard]] contact::QueryOptions MakeOptions() const;
  void CountQuery();

  const WayProblem& problem_;
  const WayOptions& options_;
  contact::QueryWorkspace workspace_;
  std::vector<contact::BodyId> bodies_;
  std::vector<spatial::Box> boxes_W_;
  spatial::Box around_W_;
  Vec3 centre_B_;
  double size_{0}, reach_{0}, gyration_{0}, grain_{0};
  std::uint64_t queries_{0};
  std::uint64_t points_{0};
  std::uint64_t budget_;
};

}  // namespace hvas::paths
