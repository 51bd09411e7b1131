#include "orders/order_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "sequence/neighbours.h"

namespace hvas::orders {
namespace {

using product::OccurrenceId;

// A part comes from below where its way out points below the horizon by more than this: 6 degrees.
// A choice.
constexpr double kBelow = -0.1;
constexpr double kSameWay = 0.985;  // Cosine: 10 degrees, which a hand does not notice. A choice.
constexpr double kSameCost = 1e-9;  // Sums in another order are rounded otherwise.
constexpr std::size_t kWidest = 4096;  // Orders at once: some 100 MB for a product of 500 parts.
constexpr std::size_t kWidening = 4;   // A round is so much wider than the last: a choice.

/** A set of moves. */
class MoveSet {
 public:
  explicit MoveSet(std::size_t count) : words_((count + 63) / 64) {}

  void Set(std::size_t i) { words_[i / 64] |= 1ULL << (i % 64); }

  void Clear(std::size_t i) { words_[i / 64] &= ~(1ULL << (i % 64)); }

  [[nodiscard]] bool Has(std::size_t i) const { return (words_[i / 64] >> (i % 64) & 1U) != 0; }

  [[nodiscard]] bool Meets(const MoveSet& other) const {
    for (std::size_t k = 0; k < words_.size(); ++k) {
      if ((words_[k] & other.words_[k]) != 0) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] bool operator<(const MoveSet& other) const { return words_ < other.words_; }

 private:
  std::vector<std::uint64_t> words_;
};

constexpr unsigned kAllSides = (1U << kUpSides) - 1;  // One bit a side.

/** The sides that may be upwards when a part comes in by a way, one bit each. */
unsigned ListSides(const Vec3& extraction_W) {
  unsigned sides = 0;
  for (int side = 0; side < kUpSides; ++side) {
    sides |= UpSideAt(side).dot(extraction_W) > kBelow ? 1U << static_cast<unsigned>(side) : 0U;
  }
  return sides;
}

bool HasSide(unsigned sides, int side) {
  return (sides >> static_cast<unsigned>(side) & 1U) != 0;
}

/** The first side that may be upwards. @pre One may. */
int ChooseSide(const OrderRules& rules, unsigned sides) {
  return *std::find_if(rules.up_sides.begin(), rules.up_sides.end(),
                       [sides](int side) { return HasSide(sides, side); });
}

/** A move with what is there when it comes. */
struct MoveInOrder {
  const FreeMove& move;
  const OrderedWay& way;
  bool is_loose;
  bool is_cramped;
  Effort effort;

  [[nodiscard]] double CalcForce(const Vec3& up_W) const {
    return std::min(simulation::kMostHandForce, effort.against) +
           std::min(simulation::kMostHandForce,
                    CalcHandForce(effort.press, move.weight, way.step.extraction_W.dot(up_W)));
  }
};

/** Counts what makes an order worse, move by move: from its beginning or from its end. */
class OrderCounter {
 public:
  /** @param rules  They outlive this object. */
  explicit OrderCounter(const OrderRules& rules) : rules_(&rules) {}

  void Add(const MoveInOrder& added) {
    TurnFor(added);
    const Vec3& extraction_W = added.way.step.extraction_W;
    const bool is_other_way = last_W_ != Vec3::Zero() && extraction_W.dot(last_W_) < kSameWay;
    counts_.direction_changes += is_other_way ? 1 : 0;
    counts_.mods += is_other_way ? kOtherWayMods : 0;
    last_W_ = extraction_W;
    TakeTool(added.move.tool);
    counts_.loose += added.is_loose ? 1 : 0;
    counts_.cramped += added.is_cramped ? 1 : 0;
    counts_.reach += added.effort.reach;
    counts_.mods += added.move.mods + CalcReachMods(added.effort.reach) +
                    (added.effort.press > 0 ? kPressMods : 0) +
                    (added.is_loose || added.effort.against > 0 ? kHoldMods : 0);
  }

  [[nodiscard]] const OrderCounts& counts() const { return counts_; }

  /** What later moves count by, but for the counts so far. */
  [[nodiscard]] auto Key() const {
    return std::tuple(sides_, std::array{last_W_.x(), last_W_.y(), last_W_.z()}, tool_);
  }

 private:
  /** Turns the product where the part would come in from below, and counts the force. */
  void TurnFor(const MoveInOrder& added) {
    const unsigned own = ListSides(added.way.step.extraction_W);
    if ((sides_ & own) == 0) {
      ++counts_.turns;
      counts_.mods += kTurnMods;
      sides_ = kAllSides;
      force_before_ = counts_.force;
      forces_ = {};
    }
    sides_ &= own;
    for (int side = 0; side < kUpSides; ++side) {
      if (HasSide(sides_, side)) {
        forces_[static_cast<std::size_t>(side)] += added.CalcForce(UpSideAt(side));
      }
    }
    counts_.force = force_before_ + forces_[static_cast<std::size_t>(ChooseSide(*rules_, sides_))];
  }

  void TakeTool(std::string_view tool) {
    if (tool.empty() || tool == tool_) {
      return;
    }
    counts_.tool_changes += tool_.empty() ? 0 : 1;
    counts_.mods += tool_.empty() ? kToolGetMods : kToolChangeMods;
    tool_ = tool;
  }

  const OrderRules* rules_;
  unsigned sides_{kAllSides};  // That may be upwards since the product was last turned, a bit each.
  Vec3 last_W_{Vec3::Zero()};  // The way of the last move; zero: none.
  std::string_view tool_;      // The last one that was needed; empty: none.
  OrderCounts counts_;
  double force_before_{0};                 // Until the product was last turned [N].
  std::array<double, kUpSides> forces_{};  // Since then, for each side upwards [N].
};

/** All motions of the hand at a move.
 @param before,after  What was counted before it, and with it. @param tool  The last one needed. */
std::vector<HandMotion> ListMotions(const MoveInOrder& added, const OrderCounts& before,
                                    const OrderCounts& after, std::string_view tool) {
  std::vector<HandMotion> motions;
  const auto add = [&motions](bool is_there, MotionPurpose purpose, const char* code, int mods,
                              double amount) {
    if (is_there) {
      motions.push_back({purpose, code, mods, amount});
    }
  };
  add(after.turns > before.turns, MotionPurpose::kTurnProduct, "M4 E2 G3 M4 E2 P2", kTurnMods, 0);
  add(after.direction_changes > before.direction_changes, MotionPurpose::kOtherWay, "M3 J2",
      kOtherWayMods, 0);
  motions.insert(motions.end(), added.move.motions.begin(), added.move.motions.end());
  const bool is_other_tool = !added.move.tool.empty() && added.move.tool != tool;
  // A part is put to its place before the tool for it is fetched.
  const auto tool_on = std::find_if(motions.begin(), motions.end(), [](const HandMotion& motion) {
    return motion.purpose == MotionPurpose::kToolOn;
  });
  if (is_other_tool) {
    motions.insert(tool_on,
                   tool.empty()
                       ? HandMotion{MotionPurpose::kGetTool, "M4 G1", kToolGetMods, 0}
                       : HandMotion{MotionPurpose::kChangeTool, "M4 P0 M4 G1", kToolChangeMods, 0});
  }
  const Effort& effort = added.effort;
  const int reach_mods = CalcReachMods(effort.reach);
  if (reach_mods > 0) {
    motions.push_back(
        {MotionPurpose::kReachIn, fmt::format("2 M{}", reach_mods / 2), reach_mods, effort.reach});
  }
  add(added.is_loose || effort.against > 0, MotionPurpose::kHold, "M3 G1", kHoldMods, 0);
  add(effort.press > 0, MotionPurpose::kPress, "A4", kPressMods, effort.press);
  return motions;
}

/** Counts an order from its beginning.
 @param visit  Called with the counts after each move. */
template <typename Visit>
OrderCounts Walk(const OrderRules& rules, const FoundOrder& order, const Visit& visit) {
  OrderCounter counter(rules);
  std::vector<bool> is_there(rules.moves.size(), false);
  const auto has_come = [&is_there](std::size_t move) { return is_there[move]; };
  for (std::size_t i = 0; i < order.moves.size(); ++i) {
    const FreeMove& move = rules.moves[order.moves[i]];
    const OrderedWay& way = move.ways[order.ways[i]];
    const bool is_held = move.is_held_by_base ||
                         std::any_of(move.neighbours.begin(), move.neighbours.end(), has_come);
    const bool is_cramped =
        std::any_of(move.moves_in_tool_space.begin(), move.moves_in_tool_space.end(), has_come);
    const MoveInOrder added{move, way, !is_held, is_cramped, CalcEffort(way.effort, has_come)};
    counter.Add(added);
    is_there[order.moves[i]] = true;
    visit(added, counter.counts());
  }
  return counter.counts();
}

/** What an order costs, by what it costs for. */
std::array<double, 8> ListCosts(const OrderCounts& counts, const OrderWeights& weights) {
  return {weights.turn * counts.turns,
          weights.direction_change * counts.direction_changes,
          weights.tool_change * counts.tool_changes,
          weights.loose * counts.loose,
          weights.cramped * counts.cramped,
          weights.reach * counts.reach,
          weights.force * counts.force,
          weights.hand_time * counts.hand_time()};
}

/** A product that is partly taken apart. */
struct State {
  MoveSet present;
  std::vector<std::pair<std::size_t, std::size_t>> removed;  // Moves and their ways.
  OrderCounter counter;
};

struct Candidate {
  std::size_t state;
  std::size_t move;
  std::size_t way;
  OrderCounter counter;
  double cost;
};

class BeamSearch {
 public:
  BeamSearch(const OrderRules& rules, const OrderSearchOptions& options)
      : rules_(rules), options_(options), wanted_(rules.moves.size(), MoveSet(rules.moves.size())) {
    for (const FreeMove& move : rules.moves) {
      std::vector<MoveSet>& sets = obstacles_.emplace_back();
      for (const OrderedWay& way : move.ways) {
        MoveSet& set = sets.emplace_back(rules.moves.size());
        for (const std::size_t other : way.moves) {
          set.Set(other);
        }
      }
    }
    for (const FreeMove& move : rules.moves) {
      MoveSet& set = in_tool_space_.emplace_back(rules.moves.size());
      for (const std::size_t other : move.moves_in_tool_space) {
        set.Set(other);
      }
    }
    for (const OrderWish& wish : options.wishes) {
      wanted_[wish.first].Set(wish.then);  // What comes first goes last.
    }
    MakeGraph();
  }

  OrderSearch Find() {
    OrderSearch search;
    search.planned = MakePlanned();
    for (std::size_t width = 1; width <= kWidest && !IsOver(); width *= kWidening) {
      search.width = width;
      const std::uint64_t before = tries_;
      if (!Run(width, &search) || options_.most_tries - tries_ < kWidening * (tries_ - before)) {
        break;
      }
    }
    search.tries = tries_;
    search.is_ended_early = IsStopped();
    search.orders = TakeBest();
    return search;
  }

 private:
  /** Moves as a graph of what holds what, for ListCutParts: 0 is the base, then the moves. */
  void MakeGraph() {
    holders_.resize(rules_.moves.size() + 1);
    const auto join = [this](std::size_t a, std::size_t b) {
      holders_[a].emplace_back(b);
      holders_[b].emplace_back(a);
    };
    for (std::size_t m = 0; m < rules_.moves.size(); ++m) {
      if (rules_.moves[m].is_held_by_base) {
        join(0, m + 1);
      }
      for (const std::size_t other : rules_.moves[m].neighbours) {
        if (other > m) {
          join(other + 1, m + 1);
        }
      }
    }
    for (std::vector<OccurrenceId>& holders : holders_) {
      std::sort(holders.begin(), holders.end());
      holders.erase(std::unique(holders.begin(), holders.end()), holders.end());
    }
  }

  [[nodiscard]] bool IsStopped() const {
    return options_.stop.stop_requested() ||
           (options_.deadline && std::chrono::steady_clock::now() > *options_.deadline);
  }

  [[nodiscard]] bool IsOver() const { return tries_ >= options_.most_tries || IsStopped(); }

  FoundOrder MakePlanned() const {
    FoundOrder order;
    for (std::size_t m = 0; m < rules_.moves.size(); ++m) {
      order.moves.push_back(m);
    }
    order.ways.assign(order.moves.size(), 0);
    return Count(std::move(order));
  }

  FoundOrder Count(FoundOrder order) const {
    order.counts = CountOrder(rules_, order);
    order.cost = CalcCost(order.counts, options_.weights);
    return order;
  }

  /** Adds a move as the next one, by each of its free ways. */
  void AddCandidates(const State& state, std::size_t index, std::size_t m, bool is_carrying,
                     std::vector<Candidate>* candidates) const {
    if (state.present.Meets(wanted_[m])) {
      return;
    }
    const auto is_there = [&state](std::size_t other) { return state.present.Has(other); };
    const FreeMove& move = rules_.moves[m];
    const bool is_cramped = state.present.Meets(in_tool_space_[m]);
    for (std::size_t w = 0; w < move.ways.size(); ++w) {
      if (state.present.Meets(obstacles_[m][w])) {
        continue;
      }
      const OrderedWay& way = move.ways[w];
      OrderCounter counter = state.counter;
      counter.Add({move, way, is_carrying, is_cramped, CalcEffort(way.effort, is_there)});
      const double cost = CalcCost(counter.counts(), options_.weights);
      candidates->push_back({index, m, w, counter, cost});
    }
  }

  /** Moves without which others would hang in the air. */
  [[nodiscard]] std::vector<OccurrenceId> ListCarrying(const State& state) const {
    std::vector<OccurrenceId> nodes{OccurrenceId(0)};
    for (std::size_t m = 0; m < rules_.moves.size(); ++m) {
      if (state.present.Has(m)) {
        nodes.emplace_back(m + 1);
      }
    }
    return sequence::ListCutParts(nodes, holders_);
  }

  void ListCandidates(const State& state, std::size_t index, std::vector<Candidate>* candidates) {
    const std::vector<OccurrenceId> carrying = ListCarrying(state);
    for (std::size_t m = 0; m < rules_.moves.size(); ++m) {
      if (!state.present.Has(m)) {
        continue;
      }
      ++tries_;
      const bool is_carrying =
          std::binary_search(carrying.begin(), carrying.end(), OccurrenceId(m + 1));
      AddCandidates(state, index, m, is_carrying, candidates);
    }
  }

  [[nodiscard]] static State Remove(const State& state, const Candidate& candidate) {
    State next = state;
    next.present.Clear(candidate.move);
    next.removed.emplace_back(candidate.move, candidate.way);
    next.counter = candidate.counter;
    return next;
  }

  /** One round of the search. @returns false where it found no order, or was ended. */
  bool Run(std::size_t width, OrderSearch* search) {
    const std::size_t count = rules_.moves.size();
    State start{MoveSet(count), {}, OrderCounter(rules_)};
    for (std::size_t m = 0; m < count; ++m) {
      start.present.Set(m);
    }
    std::vector<State> beam{std::move(start)};
    for (std::size_t removed = 0; removed < count; ++removed) {
      if (IsOver() && !found_.empty()) {
        return false;
      }
      std::vector<Candidate> candidates;
      for (std::size_t i = 0; i < beam.size(); ++i) {
        ListCandidates(beam[i], i, &candidates);
      }
      if (candidates.empty()) {
        for (std::size_t m = 0; m < count; ++m) {
          if (beam.front().present.Has(m)) {
            search->stuck.push_back(m);
          }
        }
        return false;
      }
      // What was planned to come late goes first, where the cost is the same.
      std::stable_sort(candidates.begin(), candidates.end(),
                       [](const Candidate& a, const Candidate& b) {
                         return std::tuple(a.cost, b.move) < std::tuple(b.cost, a.move);
                       });
      std::vector<State> next;
      std::set<std::pair<MoveSet, decltype(std::declval<OrderCounter>().Key())>> known;
      for (const Candidate& candidate : candidates) {
        State state = Remove(beam[candidate.state], candidate);
        if (known.emplace(state.present, state.counter.Key()).second) {
          next.push_back(std::move(state));
        }
        if (next.size() == width) {
          break;
        }
      }
      beam = std::move(next);
      Report();
    }
    for (const State& state : beam) {
      Keep(state);
    }
    return true;
  }

  void Report() const {
    if (options_.progress) {
      options_.progress(static_cast<double>(std::min(tries_, options_.most_tries)) /
                        static_cast<double>(options_.most_tries));
    }
  }

  void Keep(const State& state) {
    FoundOrder order;
    for (auto removed = state.removed.rbegin(); removed != state.removed.rend(); ++removed) {
      order.moves.push_back(removed->first);
      order.ways.push_back(removed->second);
    }
    order = Count(std::move(order));
    auto key = std::pair(order.cost, order.moves);
    found_.emplace(std::move(key), std::move(order));
  }

  [[nodiscard]] std::vector<FoundOrder> TakeBest() {
    std::vector<FoundOrder> best;
    std::vector<std::array<double, 8>> kept;
    for (auto& [key, order] : found_) {
      const auto costs = ListCosts(order.counts, options_.weights);
      const bool is_beaten = std::any_of(kept.begin(), kept.end(), [&costs](const auto& other) {
        return std::equal(other.begin(), other.end(), costs.begin(),
                          [](double a, double b) { return a <= b + kSameCost; });
      });
      if (options_.gives_front ? !is_beaten : best.size() < options_.most_orders) {
        kept.push_back(costs);
        best.push_back(std::move(order));
      }
    }
    return best;
  }

  const OrderRules& rules_;
  const OrderSearchOptions& options_;
  std::vector<std::vector<MoveSet>> obstacles_;  // By move and way.
  std::vector<MoveSet> in_tool_space_;           // By move.
  std::vector<MoveSet> wanted_;                  // What has to be gone before each goes.
  sequence::Neighbours holders_;
  std::map<std::pair<double, std::vector<std::size_t>>, FoundOrder> found_;
  std::uint64_t tries_{0};
};

}  // namespace

double CalcCost(const OrderCounts& counts, const OrderWeights& weights) {
  const auto costs = ListCosts(counts, weights);
  return std::accumulate(costs.begin(), costs.end(), 0.0);
}

OrderSearch FindOrders(const OrderRules& rules, const OrderSearchOptions& options) {
  return BeamSearch(rules, options).Find();
}

OrderCounts CountOrder(const OrderRules& rules, const FoundOrder& order) {
  return Walk(rules, order, [](const MoveInOrder&, const OrderCounts&) {});
}

std::vector<Vec3> ListUpSides(const OrderRules& rules, const FoundOrder& order) {
  std::vector<Vec3> ups(order.moves.size());
  std::size_t first = 0;
  unsigned sides = kAllSides;
  const auto close = [&](std::size_t end) {
    std::fill(ups.begin() + static_cast<std::ptrdiff_t>(first),
              ups.begin() + static_cast<std::ptrdiff_t>(end), UpSideAt(ChooseSide(rules, sides)));
    first = end;
  };
  for (std::size_t i = 0; i < order.moves.size(); ++i) {
    const unsigned own =
        ListSides(rules.moves[order.moves[i]].ways[order.ways[i]].step.extraction_W);
    if ((sides & own) == 0) {
      close(i);
      sides = kAllSides;
    }
    sides &= own;
  }
  close(order.moves.size());
  return ups;
}

std::vector<HandWork> ListHandWork(const OrderRules& rules, const FoundOrder& order) {
  const std::vector<Vec3> ups = ListUpSides(rules, order);
  std::vector<HandWork> work;
  OrderCounts before;
  std::string_view tool;
  Walk(rules, order, [&](const MoveInOrder& added, const OrderCounts& counts) {
    work.push_back({added.effort.reach, added.CalcForce(ups[work.size()]), added.effort.press,
                    counts.mods - before.mods, ListMotions(added, before, counts, tool)});
    tool = added.move.tool.empty() ? tool : added.move.tool;
    before = counts;
  });
  return work;
}

std::vector<OccurrenceId> ListInToolSpace(const OrderRules& rules, const FoundOrder& order,
                                          std::size_t place) {
  std::vector<OccurrenceId> there = rules.moves[order.moves[place]].in_tool_space;
  for (std::size_t later = place + 1; later < order.moves.size(); ++later) {
    for (const OccurrenceId part : rules.moves[order.moves[later]].parts) {
      std::erase(there, part);
    }
  }
  return there;
}

std::vector<std::size_t> ListBlocking(const OrderRules& rules,
                                      const std::vector<std::size_t>& before, std::size_t move) {
  std::vector<std::size_t> least;
  bool is_first = true;
  for (const OrderedWay& way : rules.moves[move].ways) {
    std::vector<std::size_t> blocking;
    for (const std::size_t other : before) {
      if (std::binary_search(way.moves.begin(), way.moves.end(), other)) {
        blocking.push_back(other);
      }
    }
    if (is_first || blocking.size() < least.size()) {
      least = std::move(blocking);
    }
    is_first = false;
  }
  return least;
}

std::vector<sequence::SequenceStep> ListSteps(const OrderRules& rules, const FoundOrder& order) {
  std::vector<sequence::SequenceStep> steps = rules.first;
  for (std::size_t i = 0; i < order.moves.size(); ++i) {
    const FreeMove& move = rules.moves[order.moves[i]];
    if (move.aside) {
      steps.push_back(*move.aside);
    }
    steps.push_back(move.ways[order.ways[i]].step);
    if (move.back) {
      steps.push_back(*move.back);
    }
  }
  return steps;
}

}  // namespace hvas::orders
