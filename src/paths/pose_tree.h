#pragma once

#include <cstdint>
#include <vector>

#include "paths/probe.h"

namespace hvas::paths {

/** Poses that are reached one from the other. */
class PoseTree {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);  // No node: a choice.

  struct Node {
    spatial::Pose X_WB;
    std::size_t parent{kNone};
    Path via;          ///< Poses from the parent on, this one the last.
    double domain{0};  ///< Samples further away are not reached from here; 0: no limit.
    std::uint32_t tries{0};
    bool is_dead{false};
  };

  PoseTree(const Probe& probe, const spatial::Pose& root);

  std::size_t Add(std::size_t parent, Path via);
  /** The nearest node that is not dead, by the metric of Probe::CalcLength(), where turns of more
   than a quarter count a little less. */
  [[nodiscard]] std::size_t FindNearest(const spatial::Pose& X_WB, double* distance) const;
  /** Poses from the root to a node. */
  [[nodiscard]] Path ListPath(std::size_t node) const;
  /** The node to which the i-th pose of ListPath(node) leads. */
  [[nodiscard]] std::size_t FindNodeOf(std::size_t node, std::size_t pose) const;
  /** Takes out a node and all that came of it. */
  void Kill(std::size_t node);

  [[nodiscard]] Node& node(std::size_t i) { return nodes_[i]; }

  [[nodiscard]] const Node& node(std::size_t i) const { return nodes_[i]; }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

 private:
  void AddKey(const spatial::Pose& X_WB);

  Vec3 centre_B_;
  float turn_weight_;
  std::vector<Node> nodes_;
  // Centre and quaternion of each node, for the search of the nearest.
  std::vector<float> x_, y_, z_, qw_, qx_, qy_, qz_;
};

}  // namespace hvas::paths
