#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "orders/hand_time.h"
#include "sequence/extraction.h"
#include "simulation/model.h"

namespace hvas::orders {

/** How far a hand reaches in among the parts of a move that stand beside a way. */
struct ReachBeside {
  std::size_t move{0};
  double reach{0};  ///< [m]
};

/** A fit that is pressed together on a way in. */
struct Press {
  std::optional<std::size_t> onto;   ///< The move that brings the other part; none: it never moves.
  double force{0};                   ///< F_in over the whole length, of the actual sizes [N].
  bool is_backed{true};              ///< What never moves stands behind the other part.
  std::vector<std::size_t> backing;  ///< Moves of which one part at least stands behind it; sorted.
};

/** What a way asks of the hand, for any order. */
struct WayEffort {
  double least_reach{0};             ///< Beside what never moves [m].
  std::vector<ReachBeside> reaches;  ///< What is more than that, the largest first.
  std::vector<Press> presses;
};

/** What a way asks of the hand when certain moves have come before. */
struct Effort {
  /** How far what is there rises above the outer end of what the hand holds, of all that is nearer
   to the way than the hand is thick: so far the hand goes in [m]. */
  double reach{0};
  double press{0};  ///< What the fits need, against the way in [N].
  /** The part of it that the other hand has to hold against, because nothing is behind what it is
   pressed onto [N]. */
  double against{0};
};

/** @param is_there  Says of the number of a move whether it has come before. */
template <typename IsThere>
[[nodiscard]] Effort CalcEffort(const WayEffort& way, const IsThere& is_there) {
  Effort effort;
  const auto deepest =
      std::find_if(way.reaches.begin(), way.reaches.end(),
                   [&is_there](const ReachBeside& beside) { return is_there(beside.move); });
  effort.reach = deepest == way.reaches.end() ? way.least_reach : deepest->reach;
  for (const Press& press : way.presses) {
    if (press.onto && !is_there(*press.onto)) {
      continue;
    }
    effort.press += press.force;
    const bool is_backed =
        press.is_backed || std::any_of(press.backing.begin(), press.backing.end(), is_there);
    effort.against += is_backed ? 0 : press.force;
  }
  return effort;
}

/** The force of a hand that moves a part steadily along its way in: with the way in d, gravity g
 and what resists along the way R, f = R d - m g. What only brakes the weight on its way down counts
 as nothing: sqrt(max(0, R - m g.d)^2 + |m g x d|^2) [N].
 @param press  R [N]. @param weight  m |g| [N].
 @param rise  Cosine between the way out, -d, and the side that is upwards. */
[[nodiscard]] double CalcHandForce(double press, double weight, double rise);

/** Finds what ways ask of the hand, with all parts that move in their place. */
class EffortFinder {
 public:
  /** @param model, extraction  They outlive this object. In the extraction all parts are present.
   @param move_of  Numbers of the moves that bring the parts; others never move. */
  EffortFinder(const simulation::Model& model, sequence::Extraction* extraction,
               std::map<product::OccurrenceId, std::size_t> move_of);

  /** What the way out of the parts of a move asks of the hand on the way in.
   @param units  Parts of all moves. */
  [[nodiscard]] WayEffort Find(const std::vector<sequence::Unit>& units, std::size_t move,
                               const Vec3& extraction_W);

  /** m |g| of the parts of a move [N]. */
  [[nodiscard]] double CalcWeight(const sequence::Unit& parts) const;

  /** Motions of the hand (hand_time.h) that a move takes in every order: to get the parts, to take
   them to their place and put them there, and to turn in what has a thread.
   @param has_tool  A tool turns it. */
  [[nodiscard]] std::vector<HandMotion> ListMotions(const sequence::Unit& parts,
                                                    bool has_tool) const;

 private:
  void FindReach(std::size_t move, const sequence::Unit& parts, const Vec3& extraction_W,
                 WayEffort* effort) const;
  void FindPresses(const std::vector<sequence::Unit>& units, std::size_t move,
                   const Vec3& extraction_W, WayEffort* effort);
  void FindBacking(const sequence::Unit& pushed, std::size_t pushing, const Vec3& push_W,
                   Press* press);
  [[nodiscard]] std::optional<std::size_t> FindMove(product::OccurrenceId id) const;

  const simulation::Model& model_;
  sequence::Extraction* extraction_;
  std::map<product::OccurrenceId, std::size_t> move_of_;
  std::vector<double> turns_;  // Turns of the threaded joints, by MateId; 0: none is known.
};

}  // namespace hvas::orders
