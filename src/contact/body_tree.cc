#include "contact/body_tree.h"

namespace hvas::contact {
namespace {

constexpr double kEnlargement = 0.05;  // Of the box's diagonal.

double HalfArea(const spatial::Box& box) {
  const Vec3 s = box.size();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

spatial::Box Union(spatial::Box a, const spatial::Box& b) {
  a.Add(b);
  return a;
}

}  // namespace

void BodyTree::Reserve(std::size_t items) {
  const std::size_t wanted = 2 * items;
  free_.reserve(wanted);
  while (nodes_.size() < wanted) {
    free_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    nodes_.emplace_back();
  }
  if (leaf_of_.size() < items) {
    leaf_of_.resize(items, kNone);
  }
}

std::uint32_t BodyTree::Take() noexcept {
  const std::uint32_t n = free_.back();
  free_.pop_back();
  nodes_[n] = Node{};
  return n;
}

void BodyTree::Insert(std::uint32_t item, const spatial::Box& box) noexcept {
  const std::uint32_t leaf = Take();
  nodes_[leaf].item = item;
  nodes_[leaf].box = box.Expanded(kEnlargement * box.size().norm());
  leaf_of_[item] = leaf;
  InsertLeaf(leaf);
}

void BodyTree::InsertLeaf(std::uint32_t leaf) noexcept {
  if (root_ == kNone) {
    root_ = leaf;
    return;
  }
  // Down to where the tree's surface grows least; Catto, "Dynamic bounding volume hierarchies",
  // 2019.
  const spatial::Box box = nodes_[leaf].box;
  std::uint32_t n = root_;
  while (nodes_[n].child[0] != kNone) {
    const double grown = HalfArea(Union(nodes_[n].box, box));
    const double here = 2 * grown;
    const double inherited = 2 * (grown - HalfArea(nodes_[n].box));
    double cost[2];
    for (int k = 0; k < 2; ++k) {
      const Node& child = nodes_[nodes_[n].child[k]];
      cost[k] = inherited + HalfArea(Union(child.box, box)) -
                (child.child[0] != kNone ? HalfArea(child.box) : 0.0);
    }
    if (here < cost[0] && here < cost[1]) {
      break;
    }
    n = nodes_[n].child[cost[1] < cost[0] ? 1 : 0];
  }
  const std::uint32_t sibling = n;
  const std::uint32_t parent = Take();
  const std::uint32_t above = nodes_[sibling].parent;
  nodes_[parent].parent = above;
  nodes_[parent].child[0] = sibling;
  nodes_[parent].child[1] = leaf;
  nodes_[sibling].parent = parent;
  nodes_[leaf].parent = parent;
  if (above == kNone) {
    root_ = parent;
  } else {
    nodes_[above].child[nodes_[above].child[0] == sibling ? 0 : 1] = parent;
  }
  Refit(parent);
}

void BodyTree::Refit(std::uint32_t n) noexcept {
  for (; n != kNone; n = nodes_[n].parent) {
    nodes_[n].box = Union(nodes_[nodes_[n].child[0]].box, nodes_[nodes_[n].child[1]].box);
  }
}

void BodyTree::Remove(std::uint32_t item) noexcept {
  const std::uint32_t leaf = leaf_of_[item];
  if (leaf == kNone) {
    return;
  }
  leaf_of_[item] = kNone;
  const std::uint32_t parent = nodes_[leaf].parent;
  free_.push_back(leaf);
  if (parent == kNone) {
    root_ = kNone;
    return;
  }
  const std::uint32_t sibling = nodes_[parent].child[nodes_[parent].child[0] == leaf ? 1 : 0];
  const std::uint32_t above = nodes_[parent].parent;
  nodes_[sibling].parent = above;
  free_.push_back(parent);
  if (above == kNone) {
    root_ = sibling;
    return;
  }
  nodes_[above].child[nodes_[above].child[0] == parent ? 0 : 1] = sibling;
  Refit(above);
}

void BodyTree::Move(std::uint32_t item, const spatial::Box& box) noexcept {
  const spatial::Box& large = nodes_[leaf_of_[item]].box;
  if (large.Contains(box.low) && large.Contains(box.high)) {
    return;
  }
  Remove(item);
  Insert(item, box);
}

}  // namespace hvas::contact
