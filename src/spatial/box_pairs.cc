#include "spatial/box_pairs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace hvas::spatial {
namespace {

/** Boxes in a binary tree, halved at the middle of their centres. */
class BoxTree {
 public:
  explicit BoxTree(std::span<const Box> boxes) : boxes_(boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!boxes[i].is_empty()) {
        order_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    if (!order_.empty()) {
      Build(0, order_.size());
    }
  }

  /** Lists the boxes from number `first` on that overlap another one, in ascending order. */
  void ListOverlapping(const Box& box, std::size_t first, std::vector<std::uint32_t>* list) const {
    list->clear();
    if (nodes_.empty()) {
      return;
    }
    std::array<std::uint32_t, kMostOpen> open{};
    std::size_t count = 1;
    while (count > 0) {
      const Node& node = nodes_[open[--count]];
      if (node.last < first || !node.box.Overlaps(box)) {
        continue;
      }
      if (node.second != 0) {
        open[count++] = node.second;
        open[count++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
        continue;
      }
      for (std::size_t at = node.begin; at < node.end; ++at) {
        if (order_[at] >= first && boxes_[order_[at]].Overlaps(box)) {
          list->push_back(order_[at]);
        }
      }
    }
    Sort(list);
  }

 private:
  static constexpr std::size_t kLeaf = 8;       // Boxes: a choice.
  static constexpr std::size_t kDense = 16;     // A list of a 16th of all is sorted by marks.
  static constexpr std::size_t kMostOpen = 80;  // Halves of 2^32 boxes, and their siblings.

  /** The first half of a node with halves follows it. */
  struct Node {
    Box box;
    std::uint32_t begin{0}, end{0};
    std::uint32_t second{0};  ///< The second half; 0: a leaf.
    std::uint32_t last{0};    ///< The highest number of a box.
  };

  /** Sorts numbers of boxes; those of most boxes in a time with the count of all. */
  void Sort(std::vector<std::uint32_t>* list) const {
    if (kDense * list->size() < boxes_.size()) {
      std::sort(list->begin(), list->end());
      return;
    }
    std::vector<char> is_listed(boxes_.size(), 0);
    for (const std::uint32_t i : *list) {
      is_listed[i] = 1;
    }
    list->clear();
    for (std::size_t i = 0; i < is_listed.size(); ++i) {
      if (is_listed[i] != 0) {
        list->push_back(static_cast<std::uint32_t>(i));
      }
    }
  }

  void Build(std::size_t begin, std::size_t end) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({{}, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)});
    Box box;
    Box centres;
    std::uint32_t last = 0;
    for (std::size_t at = begin; at < end; ++at) {
      box.Add(boxes_[order_[at]]);
      centres.Add(boxes_[order_[at]].centre());
      last = std::max(last, order_[at]);
    }
    nodes_[self].box = box;
    nodes_[self].last = last;
    if (end - begin <= kLeaf) {
      return;
    }
    Vec3::Index axis = 0;
    centres.size().maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::size_t i) {
      return order_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t i, std::uint32_t k) {
      const double x = boxes_[i].centre()[axis];
      const double y = boxes_[k].centre()[axis];
      return x < y || (x == y && i < k);
    });
    Build(begin, middle);
    nodes_[self].second = static_cast<std::uint32_t>(nodes_.size());
    Build(middle, end);
  }

  std::span<const Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

/** Visits what is near a box. @returns false when the visit is to end. */
bool VisitNear(const BoxTree& tree, const Box& box, std::size_t i, std::size_t first,
               WorkWatch* watch, const PairFn& visit, std::vector<std::uint32_t>* near) {
  if (!MayGoOn(watch)) {
    return false;
  }
  if (box.is_empty()) {
    return true;
  }
  tree.ListOverlapping(box, first, near);
  return std::all_of(near->begin(), near->end(), [&](std::uint32_t k) {
    return (watch == nullptr || watch->MayVisitPair()) && visit(i, k);
  });
}

/** Sets that grow together. */
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count), count_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void Join(std::size_t i, std::size_t k) {
    const std::size_t a = RootOf(i);
    const std::size_t b = RootOf(k);
    count_ -= a == b ? 0 : 1;
    parent_[b] = a;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::size_t RootOf(std::size_t i) {
    while (parent_[i] != i) {
      i = parent_[i] = parent_[parent_[i]];
    }
    return i;
  }

  std::vector<std::size_t> parent_;
  std::size_t count_;
};

}  // namespace

bool ForEachPair(std::span<const Box> boxes, double margin, WorkWatch* watch, const PairFn& visit) {
  const BoxTree tree(boxes);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box box = boxes[i].is_empty() ? Box() : boxes[i].Expanded(margin);
    if (!VisitNear(tree, box, i, i + 1, watch, visit, &near)) {
      return false;
    }
  }
  return true;
}

bool ForEachPair(std::span<const Box> first, std::span<const Box> second, double margin,
                 WorkWatch* watch, const PairFn& visit) {
  const BoxTree tree(second);
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Box box = first[i].is_empty() ? Box() : first[i].Expanded(margin);
    if (!VisitNear(tree, box, i, 0, watch, visit, &near)) {
      return false;
    }
  }
  return true;
}

bool AreConnected(std::span<const Box> boxes, double margin, WorkWatch* watch) {
  DisjointSets sets(boxes.size());
  ForEachPair(boxes, margin, watch, [&](std::size_t i, std::size_t k) {
    sets.Join(i, k);
    return sets.count() > 1;
  });
  return sets.count() <= 1;
}

}  // namespace hvas::spatial
