#include "sequence/strategies.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sequence/mate_faces.h"
#include "sequence/search_budget.h"
#include "sequence/test/small_products.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;
using product::Product;

/** A product whose parts are all there, as one level. */
struct Whole {
  explicit Whole(Product the_product) : product(std::move(the_product)) {
    input.product = &product;
    input.scene = &scene;
    for (const product::Occurrence& occurrence : product.occurrences) {
      const product::Part& part = product.part_of(occurrence.id);
      contact::ShapeSource source{part.mesh.vertices, part.mesh.triangles, {}, {}};
      for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
        source.faces.push_back(part.faces[f].surface);
        source.triangle_face.insert(source.triangle_face.end(), part.faces[f].triangle_count, f);
      }
      input.shapes.push_back(contact::testing::Build(source));
      (void)scene.Add(input.shapes.back(), occurrence.X_WB);
    }
    const auto faces = [this](const product::Connector& side) {
      const product::Part& part = product.part_of(side.occurrence);
      return std::make_shared<const haptics::MateFaces>(
          CollectMateFaces(part, part.features[side.feature.index()].faces));
    };
    for (const product::Mate& mate : product.mates) {
      input.faces_a.push_back(faces(mate.a));
      input.faces_b.push_back(faces(mate.b));
    }
    extraction = std::make_unique<Extraction>(input, nullptr);
    neighbours = FindNeighbours(product, scene, {}, {});
    level.product = &product;
    level.extraction = extraction.get();
    level.neighbours = &neighbours;
    level.fixtures = &fixtures;
    for (const product::Occurrence& occurrence : product.occurrences) {
      level.rest.push_back(occurrence.id);
    }
    std::stable_sort(level.rest.begin(), level.rest.end(), [this](OccurrenceId x, OccurrenceId y) {
      return extraction->SizeOf(x) < extraction->SizeOf(y);
    });
    level.connecting = ListCutParts(level.rest, neighbours);
  }

  /** Names of what a strategy takes out, the leading part first. */
  [[nodiscard]] std::vector<std::string> TakeOut(const Strategy& strategy) {
    std::vector<std::string> names;
    if (const std::optional<TakenOut> out = strategy.TryTakeOut(&level)) {
      for (const OccurrenceId id : out->unit) {
        names.push_back(product.occurrences[id.index()].name);
        EXPECT_EQ(std::count(level.rest.begin(), level.rest.end(), id), 0);
      }
    }
    return names;
  }

  Product product;
  contact::Scene scene;
  SequenceInput input;
  std::unique_ptr<Extraction> extraction;
  Neighbours neighbours;
  Unit fixtures;
  Level level;
};

using Names = std::vector<std::string>;

TEST(StraightStrategyTest, APegComesOutOfItsBlockAndTheBaseStays) {
  Whole whole(testing::PegInBlock());
  const StraightStrategy straight(false);
  EXPECT_EQ(whole.TakeOut(straight), Names{"peg"});
  EXPECT_EQ(whole.TakeOut(straight), Names{});
}

TEST(HangingStrategyTest, ALidTakesThePendantThatHangsOnItAlong) {
  Whole whole(testing::PendantUnderLid());
  EXPECT_EQ(whole.TakeOut(StraightStrategy(false)), Names{});
  EXPECT_EQ(whole.TakeOut(HangingStrategy()), (Names{"pendant", "lid"}));
}

TEST(SubassemblyStrategyTest, AProductWithoutSubassembliesGivesNone) {
  Whole whole(testing::PegInBlock());
  EXPECT_EQ(whole.TakeOut(SubassemblyStrategy()), Names{});
}

TEST(BodyStrategyTest, APartThatComesOutAloneIsTheSmallestBody) {
  Whole whole(testing::PegInBlock());
  EXPECT_EQ(whole.TakeOut(BodyStrategy()), Names{"peg"});
}

TEST(AllowanceStrategyTest, PartsThatDoNotOverlapAsDrawnAreAllowedNoMore) {
  Whole whole(testing::PegInBlock());
  EXPECT_FALSE(AllowanceStrategy().TryTakeOut(&whole.level).has_value());
}

TEST(YieldingStrategyTest, ALipBendsOverItsBeadUnlessItIsStatedToBeRigid) {
  const YieldingStrategy by_form(YieldingStrategy::By::kForm);
  Whole cap(testing::CapOnBead(11.6e-3));
  EXPECT_EQ(cap.TakeOut(StraightStrategy(true)), Names{});
  EXPECT_EQ(cap.TakeOut(by_form).size(), 1U);
  Whole rigid(testing::StateRigid(testing::CapOnBead(11.6e-3)));
  EXPECT_EQ(rigid.TakeOut(by_form), Names{});
}

TEST(TurningStrategyTest, ASearchSpendsTheBudgetAndIsNotMadeTwice) {
  Whole whole(testing::CaptiveRing());
  const TurningStrategy brief(TurningStrategy::Effort::kBrief);
  EXPECT_EQ(whole.TakeOut(brief), Names{});
  const std::uint64_t spent = whole.extraction->budget().spent();
  EXPECT_GT(spent, 0U);
  EXPECT_EQ(whole.TakeOut(brief), Names{});
  EXPECT_EQ(whole.extraction->budget().spent(), spent);
}

TEST(SidestepStrategyTest, NothingIsMovedAsideForAPartThatNoOtherBlocks) {
  Whole whole(testing::PegInBlock());
  EXPECT_EQ(whole.TakeOut(SidestepStrategy()), Names{});
}

TEST(SearchBudgetTest, PointsCountAsQueriesAndMoreThanAllIsNeverLeft) {
  SearchBudget budget(10);
  budget.Spend(3, 2 * SearchBudget::kPointsOfQuery);
  EXPECT_EQ(budget.spent(), 5U);
  EXPECT_EQ(budget.left(), 5U);
  budget.Spend(100, 0);
  EXPECT_EQ(budget.left(), 0U);
  EXPECT_TRUE(budget.is_over());
}

}  // namespace
}  // namespace hvas::sequence
