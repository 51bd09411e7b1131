// Orders of assembly of low cost: rules made by hand against a search through all orders, and the
// rules of small products.

#include "simulation/order_search.h"

#include <algorithm>
#include <array>
#include <numeric>

#include <gtest/gtest.h>

#include "base/random.h"
#include "simulation/order_rules.h"
#include "simulation/test/small_products.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;

constexpr std::array kSides{0, 1, 2, 3, 4, 5};

Vec3 SideOf(int side) {
  Vec3 direction = Vec3::Zero();
  direction[side / 2] = side % 2 == 0 ? 1 : -1;
  return direction;
}

/** Moves that stand in each other's ways by chance, never in a circle along the first ways. */
OrderRules MakeRandomRules(std::size_t count, Random* random) {
  OrderRules rules;
  const auto pick = [random](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(random->Uniform() * static_cast<double>(n)));
  };
  for (std::size_t m = 0; m < count; ++m) {
    FreeMove& move = rules.moves.emplace_back();
    move.parts = {OccurrenceId(m + 1)};
    move.is_held_by_base = m == 0 || random->Uniform() < 0.4;
    if (m > 0) {
      move.neighbours.push_back(pick(m));
    }
    const std::size_t ways = 1 + pick(3);
    for (std::size_t w = 0; w < ways; ++w) {
      OrderedWay& way = move.ways.emplace_back();
      way.step.occurrence = OccurrenceId(m + 1);
      way.step.extraction_W = SideOf(kSides[pick(kSides.size())]);
      for (std::size_t other = w == 0 ? m + 1 : 0; other < count; ++other) {
        if (other != m && random->Uniform() < 0.3) {
          way.moves.push_back(other);
        }
      }
    }
  }
  for (std::size_t m = 0; m < count; ++m) {
    for (const std::size_t other : rules.moves[m].neighbours) {
      std::vector<std::size_t>& back = rules.moves[other].neighbours;
      if (std::find(back.begin(), back.end(), m) == back.end()) {
        back.push_back(m);
      }
    }
  }
  for (FreeMove& move : rules.moves) {
    std::sort(move.neighbours.begin(), move.neighbours.end());
  }
  return rules;
}

bool IsPossible(const OrderRules& rules, const FoundOrder& order) {
  std::vector<bool> is_there(rules.moves.size(), false);
  for (std::size_t i = 0; i < order.moves.size(); ++i) {
    const OrderedWay& way = rules.moves[order.moves[i]].ways[order.ways[i]];
    if (std::any_of(way.moves.begin(), way.moves.end(),
                    [&](std::size_t other) { return is_there[other]; })) {
      return false;
    }
    is_there[order.moves[i]] = true;
  }
  return order.moves.size() == rules.moves.size();
}

/** The least cost of all orders with all choices of ways. */
void SearchAll(const OrderRules& rules, const OrderWeights& weights, std::size_t depth,
               FoundOrder* order, double* least) {
  if (depth == rules.moves.size()) {
    if (IsPossible(rules, *order)) {
      *least = std::min(*least, CalcCost(CountOrder(rules, *order), weights));
    }
    return;
  }
  for (std::size_t w = 0; w < rules.moves[order->moves[depth]].ways.size(); ++w) {
    order->ways[depth] = w;
    SearchAll(rules, weights, depth + 1, order, least);
  }
}

TEST(OrderSearchTest, FindsTheLeastCostOfAllOrdersOfAFewMoves) {
  int best = 0;
  constexpr int kCases = 40;
  for (int seed = 1; seed <= kCases; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const OrderRules rules = MakeRandomRules(5, &random);
    const OrderSearchOptions options;
    const OrderSearch search = FindOrders(rules, options);
    ASSERT_FALSE(search.orders.empty()) << seed;
    FoundOrder all;
    all.moves.resize(rules.moves.size());
    all.ways.resize(rules.moves.size());
    std::iota(all.moves.begin(), all.moves.end(), std::size_t{0});
    double least = 1e9;
    do {
      SearchAll(rules, options.weights, 0, &all, &least);
    } while (std::next_permutation(all.moves.begin(), all.moves.end()));
    for (const FoundOrder& order : search.orders) {
      EXPECT_TRUE(IsPossible(rules, order)) << seed;
      EXPECT_GE(order.cost, least - 1e-9) << seed;
    }
    EXPECT_LE(search.orders.front().cost, search.planned.cost) << seed;
    best += search.orders.front().cost < least + 1e-9 ? 1 : 0;
  }
  // Of two ways that are both free the search takes the first, so that it misses some.
  EXPECT_GE(best, kCases * 8 / 10);
}

TEST(OrderSearchTest, SidesUpwardsChangeAsOftenAsTurnsAreCounted) {
  for (int seed = 1; seed <= 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const OrderRules rules = MakeRandomRules(8, &random);
    const FoundOrder best = FindOrders(rules, {}).orders.front();
    const auto ups = ListUpSides(rules, best);
    int turns = 0;
    for (std::size_t i = 0; i < best.moves.size(); ++i) {
      ASSERT_FALSE(ups[i].empty());
      turns += i > 0 && ups[i] != ups[i - 1] ? 1 : 0;
      const Vec3& out_W = rules.moves[best.moves[i]].ways[best.ways[i]].step.extraction_W;
      for (const Vec3& up_W : ups[i]) {
        EXPECT_GE(up_W.dot(out_W), -0.1) << "it comes from below";
      }
    }
    EXPECT_EQ(turns, best.counts.turns) << seed;
  }
}

TEST(OrderSearchTest, WishesAreObeyedOrSaidToContradict) {
  for (int seed = 1; seed <= 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const OrderRules rules = MakeRandomRules(7, &random);
    OrderSearchOptions options;
    options.wishes = {{5, 1}, {6, 0}};
    const OrderSearch search = FindOrders(rules, options);
    EXPECT_EQ(search.orders.empty(), !search.stuck.empty());
    for (const FoundOrder& order : search.orders) {
      const auto at = [&order](std::size_t move) {
        return std::find(order.moves.begin(), order.moves.end(), move);
      };
      EXPECT_TRUE(IsPossible(rules, order));
      EXPECT_LT(at(5), at(1));
      EXPECT_LT(at(6), at(0));
    }
  }
}

TEST(OrderSearchTest, TheFrontHasNoOrderThatAnotherBeats) {
  Random random(3);
  const OrderRules rules = MakeRandomRules(9, &random);
  OrderSearchOptions options;
  options.gives_front = true;
  const OrderSearch search = FindOrders(rules, options);
  ASSERT_FALSE(search.orders.empty());
  for (const FoundOrder& a : search.orders) {
    for (const FoundOrder& b : search.orders) {
      const bool beats = b.counts.turns <= a.counts.turns &&
                         b.counts.direction_changes <= a.counts.direction_changes &&
                         b.counts.tool_changes <= a.counts.tool_changes &&
                         b.counts.loose <= a.counts.loose && !(a.counts == b.counts);
      EXPECT_FALSE(beats);
    }
  }
}

TEST(OrderRulesTest, APegInACarrierInACupWaitsForTheCarrier) {
  const Model& model = *testing::PegInCarrierInCupModel();
  const OrderRules rules = FindOrderRules(model, {});
  ASSERT_EQ(rules.moves.size() + rules.first.size(), model.sequence.steps.size());
  OrderSearchOptions options;
  const OrderSearch search = FindOrders(rules, options);
  ASSERT_FALSE(search.orders.empty());
  EXPECT_TRUE(IsPossible(rules, search.orders.front()));
  EXPECT_EQ(ListSteps(rules, search.planned).size(), model.sequence.steps.size());
}

TEST(OrderRulesTest, TheBaseIsTheOneThatWasAskedFor) {
  CompileOptions options = testing::FastOptions();
  options.base = "peg";
  Diagnostics diagnostics;
  const auto model =
      Compile(std::make_shared<product::Product>(testing::PegInBlock()), options, &diagnostics);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  EXPECT_EQ((*model)->product->occurrences[FindBase((*model)->sequence).index()].name, "peg");
  options.base = "no such part";
  const auto none =
      Compile(std::make_shared<product::Product>(testing::PegInBlock()), options, &diagnostics);
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace hvas::simulation
