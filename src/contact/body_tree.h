#pragma once

#include <cstdint>
#include <vector>

#include "spatial/box.h"

namespace hvas::contact {

/** Dynamic tree of boxes: each leaf is an item with a box somewhat larger than its own, so that
 small moves touch nothing. Reserve allocates; all else is RT-safe. */
class BodyTree {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;  ///< No node.

  /** Makes room for so many items. */
  void Reserve(std::size_t items);
  void Insert(std::uint32_t item, const spatial::Box& box) noexcept;
  void Remove(std::uint32_t item) noexcept;
  /** Sets the box of an inserted item. */
  void Move(std::uint32_t item, const spatial::Box& box) noexcept;

  /** Calls visit(item) for each item whose enlarged box overlaps; stops when it returns false. */
  template <typename Visit>
  void Query(const spatial::Box& box, Visit visit) const noexcept {
    std::uint32_t n = root_;
    while (n != kNone) {
      const Node& node = nodes_[n];
      if (node.box.Overlaps(box)) {
        if (node.child[0] != kNone) {
          n = node.child[0];
          continue;
        }
        if (!visit(node.item)) {
          return;
        }
      }
      while (nodes_[n].parent != kNone && nodes_[nodes_[n].parent].child[1] == n) {
        n = nodes_[n].parent;
      }
      n = nodes_[n].parent == kNone ? kNone : nodes_[nodes_[n].parent].child[1];
    }
  }

 private:
  struct Node {
    spatial::Box box;
    std::uint32_t parent{kNone};
    std::uint32_t child[2]{kNone, kNone};
    std::uint32_t item{kNone};
  };

  std::uint32_t Take() noexcept;
  void InsertLeaf(std::uint32_t leaf) noexcept;
  void Refit(std::uint32_t n) noexcept;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;     // Stack of unused nodes, capacity never exceeded.
  std::vector<std::uint32_t> leaf_of_;  // Of each item.
  std::uint32_t root_{kNone};
};

}  // namespace hvas::contact
