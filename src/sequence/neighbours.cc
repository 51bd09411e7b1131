#include "sequence/neighbours.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "mates/place_bodies.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;

constexpr double kTouch = 0.1e-3;  // [m]; parts closer than this as drawn touch: a choice

/** Bodies that the shape of one part touches at its drawn pose. */
std::vector<contact::BodyId> ListTouched(const contact::Scene& scene, contact::BodyId self,
                                         contact::QueryWorkspace* workspace) {
  std::vector<contact::BodyId> touched;
  contact::QueryOptions query;
  query.margin = kTouch;
  query.self = self;
  // A query reports a limited number of contacts: ask again without those found until none is left.
  for (bool is_complete = false; !is_complete;) {
    query.left_out[0] = touched;
    scene.Query(scene.shape(self), scene.pose(self), query, workspace);
    const std::size_t known = touched.size();
    for (const contact::Contact& contact : workspace->contacts()) {
      const bool is_new = contact.body.is_valid() &&
                          std::find(touched.begin(), touched.end(), contact.body) == touched.end();
      if (is_new) {
        touched.push_back(contact.body);
      }
    }
    is_complete = touched.size() == known;
  }
  return touched;
}

/** Depth-first search for cut vertices, without recursion. */
class CutSearch {
 public:
  CutSearch(const std::vector<OccurrenceId>& parts, const Neighbours& neighbours)
      : neighbours_(neighbours), nodes_(neighbours.size()) {
    for (const OccurrenceId id : parts) {
      nodes_[id.index()].is_in = true;
    }
    for (const OccurrenceId id : parts) {
      if (nodes_[id.index()].number == 0) {
        SearchFrom(id);
        ++trees_;
      }
    }
  }

  [[nodiscard]] bool is_cut(OccurrenceId id) const { return nodes_[id.index()].is_cut; }

  [[nodiscard]] int trees() const { return trees_; }

 private:
  struct Node {
    bool is_in{false};
    bool is_cut{false};
    int number{0};  // in the order of the search; 0: not found yet
    int lowest{0};  // number of the first part that it and those found through it lead back to
    std::size_t next{0};
    OccurrenceId parent;
    int children{0};
  };

  void SearchFrom(OccurrenceId root) {
    std::vector<OccurrenceId> path;
    const auto enter = [&](OccurrenceId id) {
      nodes_[id.index()].number = nodes_[id.index()].lowest = ++found_;
      path.push_back(id);
    };
    enter(root);
    while (!path.empty()) {
      const OccurrenceId id = path.back();
      Node& node = nodes_[id.index()];
      if (node.next < neighbours_[id.index()].size()) {
        const OccurrenceId other = neighbours_[id.index()][node.next++];
        Node& reached = nodes_[other.index()];
        if (reached.is_in && reached.number == 0) {
          reached.parent = id;
          ++node.children;
          enter(other);
        } else if (reached.is_in && other != node.parent) {
          node.lowest = std::min(node.lowest, reached.number);
        }
        continue;
      }
      path.pop_back();
      if (node.parent.is_valid()) {
        Node& parent = nodes_[node.parent.index()];
        parent.lowest = std::min(parent.lowest, node.lowest);
        parent.is_cut = parent.is_cut || (parent.parent.is_valid() && node.lowest >= parent.number);
      } else {
        node.is_cut = node.children > 1;
      }
    }
  }

  const Neighbours& neighbours_;
  std::vector<Node> nodes_;
  int found_{0};
  int trees_{0};
};

/** Joins parts, but for those that are absent. */
class NeighbourList {
 public:
  NeighbourList(std::size_t count, const std::vector<OccurrenceId>& absent)
      : is_absent_(count, false), neighbours_(count) {
    for (const OccurrenceId id : absent) {
      is_absent_[id.index()] = true;
    }
  }

  void Connect(OccurrenceId a, OccurrenceId b) {
    if (a != b && !is_absent_[a.index()] && !is_absent_[b.index()]) {
      neighbours_[a.index()].push_back(b);
      neighbours_[b.index()].push_back(a);
    }
  }

  void ConnectMated(const product::Product& product) {
    for (const product::Mate& mate : product.mates) {
      if (!mates::IsContradicted(product, mate)) {
        Connect(mate.a.occurrence, mate.b.occurrence);
      }
    }
  }

  /** Sorted, each one once. */
  Neighbours Take() {
    for (std::vector<OccurrenceId>& list : neighbours_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return std::move(neighbours_);
  }

 private:
  std::vector<bool> is_absent_;
  Neighbours neighbours_;
};

}  // namespace

Neighbours FindMated(const product::Product& product, const std::vector<OccurrenceId>& absent) {
  NeighbourList list(product.occurrences.size(), absent);
  list.ConnectMated(product);
  return list.Take();
}

Neighbours FindNeighbours(const product::Product& product, const contact::Scene& scene,
                          const std::vector<OccurrenceId>& absent, const std::stop_token& stop) {
  NeighbourList list(product.occurrences.size(), absent);
  list.ConnectMated(product);
  contact::QueryWorkspace workspace;
  for (const product::Occurrence& occurrence : product.occurrences) {
    if (stop.stop_requested()) {
      break;
    }
    const contact::BodyId self(occurrence.id.index());
    for (const contact::BodyId body : ListTouched(scene, self, &workspace)) {
      list.Connect(occurrence.id, OccurrenceId(body.index()));
    }
  }
  return list.Take();
}

std::vector<OccurrenceId> ListCutParts(const std::vector<OccurrenceId>& parts,
                                       const Neighbours& neighbours) {
  const CutSearch search(parts, neighbours);
  std::vector<OccurrenceId> cut;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(cut),
               [&search](OccurrenceId id) { return search.is_cut(id); });
  std::sort(cut.begin(), cut.end());
  return cut;
}

std::vector<OccurrenceId> ListConnected(OccurrenceId id, const std::vector<OccurrenceId>& parts,
                                        const Neighbours& neighbours) {
  std::vector<bool> is_open(neighbours.size(), false);
  for (const OccurrenceId part : parts) {
    is_open[part.index()] = true;
  }
  std::vector<bool> is_found(neighbours.size(), false);
  std::vector<OccurrenceId> next{id};
  is_found[id.index()] = true;
  while (!next.empty()) {
    const OccurrenceId from = next.back();
    next.pop_back();
    for (const OccurrenceId to : neighbours[from.index()]) {
      if (is_open[to.index()] && !is_found[to.index()]) {
        is_found[to.index()] = true;
        next.push_back(to);
      }
    }
  }
  std::vector<OccurrenceId> connected;
  std::copy_if(parts.begin(), parts.end(), std::back_inserter(connected),
               [&is_found](OccurrenceId part) { return is_found[part.index()]; });
  return connected;
}

bool AreConnected(const std::vector<OccurrenceId>& parts, const Neighbours& neighbours) {
  return CutSearch(parts, neighbours).trees() <= 1;
}

}  // namespace hvas::sequence
