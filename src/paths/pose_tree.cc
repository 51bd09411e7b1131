#include "paths/pose_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hvas::paths {

using spatial::Pose;

PoseTree::PoseTree(const Probe& probe, const Pose& root)
    : centre_B_(probe.centre_B()),
      turn_weight_(static_cast<float>(8 * probe.gyration() * probe.gyration())) {
  nodes_.push_back({root, kNone, {root}, 0, 0, false});
  AddKey(root);
}

void PoseTree::AddKey(const Pose& X_WB) {
  const Vec3 c = X_WB * centre_B_;
  x_.push_back(static_cast<float>(c.x()));
  y_.push_back(static_cast<float>(c.y()));
  z_.push_back(static_cast<float>(c.z()));
  qw_.push_back(static_cast<float>(X_WB.q().w()));
  qx_.push_back(static_cast<float>(X_WB.q().x()));
  qy_.push_back(static_cast<float>(X_WB.q().y()));
  qz_.push_back(static_cast<float>(X_WB.q().z()));
}

std::size_t PoseTree::Add(std::size_t parent, Path via) {
  Node node;
  node.X_WB = via.back();
  node.parent = parent;
  node.via = std::move(via);
  AddKey(node.X_WB);
  nodes_.push_back(std::move(node));
  return nodes_.size() - 1;
}

std::size_t PoseTree::FindNearest(const Pose& X_WB, double* distance) const {
  const Vec3 c = X_WB * centre_B_;
  const auto cx = static_cast<float>(c.x()), cy = static_cast<float>(c.y()),
             cz = static_cast<float>(c.z());
  const auto w = static_cast<float>(X_WB.q().w()), x = static_cast<float>(X_WB.q().x()),
             y = static_cast<float>(X_WB.q().y()), z = static_cast<float>(X_WB.q().z());
  // |c - c'|^2 + (gyration angle)^2, for small angles 8 (1 - |q . q'|) is the angle's square.
  constexpr std::size_t kBlock = 256;
  std::array<float, kBlock> squared;
  std::size_t best = kNone;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < x_.size(); first += kBlock) {
    const std::size_t n = std::min(kBlock, x_.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = first + i;
      const float dx = x_[k] - cx, dy = y_[k] - cy, dz = z_[k] - cz;
      const float dot = std::abs(qw_[k] * w + qx_[k] * x + qy_[k] * y + qz_[k] * z);
      squared[i] = dx * dx + dy * dy + dz * dz + turn_weight_ * (1.0F - dot);
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (squared[i] < least && !nodes_[first + i].is_dead) {
        least = squared[i];
        best = first + i;
      }
    }
  }
  *distance = std::sqrt(std::max(0.0F, least));
  return best;
}

Path PoseTree::ListPath(std::size_t node) const {
  std::vector<std::size_t> chain;
  for (std::size_t i = node; i != kNone; i = nodes_[i].parent) {
    chain.push_back(i);
  }
  Path path;
  for (auto i = chain.rbegin(); i != chain.rend(); ++i) {
    path.insert(path.end(), nodes_[*i].via.begin(), nodes_[*i].via.end());
  }
  return path;
}

std::size_t PoseTree::FindNodeOf(std::size_t node, std::size_t pose) const {
  std::vector<std::size_t> chain;
  for (std::size_t i = node; i != kNone; i = nodes_[i].parent) {
    chain.push_back(i);
  }
  std::size_t count = 0;
  for (auto i = chain.rbegin(); i != chain.rend(); ++i) {
    count += nodes_[*i].via.size();
    if (pose < count) {
      return *i;
    }
  }
  return node;
}

void PoseTree::Kill(std::size_t node) {
  nodes_[node].is_dead = true;
  for (std::size_t i = node + 1; i < nodes_.size(); ++i) {
    nodes_[i].is_dead = nodes_[i].is_dead || nodes_[nodes_[i].parent].is_dead;
  }
}

}  // namespace hvas::paths
