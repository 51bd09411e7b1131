#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "sequence/extraction.h"

namespace hvas::sequence {

/** Directional blocking graphs (Wilson and Latombe, Artificial Intelligence 71(2), 1994) of parts
 of which none can be drawn out alone: along each candidate direction, which part stands in the way
 of which. It finds bodies of several parts that come out together, and the part that blocks most
 others. */
class BlockingGraph {
 public:
  /** Parts that come out as one body along a direction; one part alone where this direction is none
   of its own. */
  struct Body {
    Unit parts;  ///< Parts in the order of the graph.
    Vec3 direction{Vec3::Zero()};
  };

  /** Largest number of ways that are looked at; FindBody() finds nothing more after it, or when a
   quarter of what is left of the search is spent. */
  static constexpr std::size_t kMostWays = 6000;

  /** @param extraction  Outlives this object.
   @param parts  Parts that are present; the last one is the base, which stays. */
  BlockingGraph(Extraction* extraction, const Unit& parts);

  /** Leaves only these of its parts: the others have come out or were given up. */
  void Keep(const Unit& parts) { parts_ = parts; }

  /** Finds the body with the fewest parts without the base that all hang together and that nothing
   outside stands in the way of. Bodies that were excluded are not found again. */
  [[nodiscard]] std::optional<Body> FindBody(const Neighbours& neighbours);

  /** Leaves a body out of what FindBody() finds. */
  void Exclude(const Body& body) { excluded_.push_back(body.parts); }

  /** Finds the part whose removal lets most others come out one after the other, each along its own
   directions; the first one of those that let as many come out. Invalid where no single part lets
   another come out. */
  [[nodiscard]] product::OccurrenceId FindGreatestBlocker();

  /** Whether the limit of ways was reached. */
  [[nodiscard]] bool is_limited() const { return is_limited_; }

 private:
  struct Way {
    std::vector<product::OccurrenceId> obstacles;  // in its way when the graph was made
    bool is_closed{false};                         // the base or the table stands in it
  };

  using Key = std::pair<product::OccurrenceId, std::size_t>;  // part and index of the direction

  [[nodiscard]] const Way* FindWay(product::OccurrenceId id, std::size_t direction);
  /** Finds the parts that have to come out with a part along a direction; empty where the base is
   one of them, or more than `most` are. */
  [[nodiscard]] Unit FindClosure(product::OccurrenceId id, std::size_t direction, std::size_t most);
  [[nodiscard]] std::size_t CountFreed(product::OccurrenceId gone);
  [[nodiscard]] bool IsThere(product::OccurrenceId id) const;
  [[nodiscard]] std::size_t AddDirection(const Vec3& direction);

  Extraction& extraction_;
  Unit parts_;
  std::vector<Vec3> directions_;
  std::map<product::OccurrenceId, std::vector<std::size_t>> own_directions_;
  std::map<Key, Way> ways_;
  std::vector<Unit> excluded_;
  std::uint64_t limit_;  // Of the budget: a quarter of what was left. A choice.
  std::uint64_t spent_{0};
  bool is_limited_{false};
};

}  // namespace hvas::sequence
