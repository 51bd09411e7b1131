#include "sequence/sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sequence/extraction.h"
#include "sequence/mate_faces.h"
#include "sequence/test/small_products.h"

namespace hvas::sequence {
namespace {

using product::OccurrenceId;
using product::Product;
using spatial::Pose;
using ::testing::IsSubstring;

/** A product in a scene, as Compile prepares it. */
struct Planned {
  explicit Planned(Product the_product) : product(std::move(the_product)) {
    std::vector<std::shared_ptr<const contact::Shape>> shapes;
    for (const product::Part& part : product.parts) {
      contact::ShapeSource source{part.mesh.vertices, part.mesh.triangles, {}, {}};
      for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
        source.faces.push_back(part.faces[f].surface);
        source.triangle_face.insert(source.triangle_face.end(), part.faces[f].triangle_count, f);
      }
      shapes.push_back(contact::testing::Build(source));
    }
    for (const product::Occurrence& occurrence : product.occurrences) {
      (void)scene.Add(shapes[occurrence.part.index()], occurrence.X_WB);
    }
    SequenceInput input;
    input.product = &product;
    input.scene = &scene;
    const auto faces = [this](const product::Connector& side) {
      const product::Part& part = product.part_of(side.occurrence);
      return std::make_shared<const haptics::MateFaces>(
          CollectMateFaces(part, part.features[side.feature.index()].faces));
    };
    for (const product::Mate& mate : product.mates) {
      input.faces_a.push_back(faces(mate.a));
      input.faces_b.push_back(faces(mate.b));
    }
    sequence = PlanSequence(input);
  }

  /** Names of what the steps bring in; what is only assumed in its place is none of it. */
  [[nodiscard]] std::vector<std::string> order() const {
    std::vector<std::string> names;
    for (const SequenceStep& step : sequence.steps) {
      if (step.kind != SequenceStep::Kind::kAssume) {
        names.push_back(product.occurrences[step.occurrence.index()].name);
      }
    }
    return names;
  }

  Product product;
  contact::Scene scene;
  Sequence sequence;
};

using Names = std::vector<std::string>;

TEST(SequenceTest, X17PegComesOutAlongItsBoreHoweverTheProductLies) {
  for (const Vec3& turn : {Vec3(0, 0, 0), Vec3(0.4, -0.2, 1.1), Vec3(2.5, 0.3, 0)}) {
    const Pose X_WP(spatial::RotationFromVector(turn), Vec3(0.1, -0.05, 0.2));
    const Planned planned(testing::PegInBlock(X_WP));
    ASSERT_EQ(planned.order(), (Names{"block", "peg"}));
    EXPECT_TRUE(planned.sequence.gaps.empty());
    EXPECT_TRUE(planned.sequence.overlaps.empty());
    EXPECT_EQ(planned.sequence.steps[0].kind, SequenceStep::Kind::kBase);
    const SequenceStep& peg = planned.sequence.steps[1];
    EXPECT_EQ(peg.kind, SequenceStep::Kind::kInsert);
    // The bore is blind: the one way out is up, as the product has it.
    EXPECT_LT((peg.extraction_W - X_WP.q() * Vec3::UnitZ()).norm(), 1e-9);
    // Out until the peg's tip has passed the rim.
    EXPECT_NEAR(peg.engage_distance, testing::kBlockHeight - testing::kFloor, 1e-9);
  }
}

TEST(SequenceTest, X17PartUnderALidGoesInBeforeTheLid) {  // N10
  const Planned planned(testing::CoinUnderLid());
  EXPECT_EQ(planned.order(), (Names{"cup", "coin", "lid"}));
  EXPECT_TRUE(planned.sequence.gaps.empty());
  for (const SequenceStep& step : planned.sequence.steps) {
    EXPECT_TRUE(step.kind == SequenceStep::Kind::kBase || step.extraction_W.z() > 0.999);
  }
}

TEST(SequenceTest, X17EveryStepOfAnOrderIsFreeOfThePartsBeforeIt) {
  // Moved out again in the found order turned round, no part meets one that is still there.
  Planned planned(testing::CoinUnderLid());
  contact::QueryWorkspace workspace;
  for (std::size_t i = 0; i < planned.product.occurrences.size(); ++i) {
    planned.scene.SetEnabled(contact::BodyId(i), false);
  }
  for (const SequenceStep& step : planned.sequence.steps) {
    const contact::BodyId self(step.occurrence.index());
    contact::QueryOptions query;
    query.self = self;
    const Pose& X_WB = planned.product.occurrences[self.index()].X_WB;
    for (double s = 0; s < 60e-3; s += 0.1e-3) {
      const Pose X(X_WB.q(), X_WB.p() + s * step.extraction_W);
      EXPECT_TRUE(planned.scene.IsFree(planned.scene.shape(self), X, 50e-6, query, &workspace))
          << planned.product.occurrences[self.index()].name << " at " << s;
    }
    planned.scene.SetEnabled(self, true);
  }
}

TEST(SequenceTest, CaptivePartIsReportedWithWhatHoldsIt) {  // N10
  const Planned planned(testing::CaptiveRing());
  EXPECT_EQ(planned.order(), (Names{"spool"}));
  ASSERT_EQ(planned.sequence.gaps.size(), 1u);
  EXPECT_EQ(planned.sequence.gaps[0].occurrence, OccurrenceId(1));
  EXPECT_PRED_FORMAT2(IsSubstring, "captive/spool", planned.sequence.gaps[0].reason);
  // It goes as far as its play of 1 mm and is found to be stopped a sampled step beyond.
  double travelled_mm = 0;
  ASSERT_EQ(std::sscanf(planned.sequence.gaps[0].reason.c_str(),
                        "no free path: meets captive/spool after %lf mm", &travelled_mm),
            1)
      << planned.sequence.gaps[0].reason;
  EXPECT_GE(travelled_mm, 1.0);
  EXPECT_LE(travelled_mm, 1.5);
  EXPECT_PRED_FORMAT2(IsSubstring, "its hole of 10.000 mm does not pass the diameter of 20.000 mm",
                      planned.sequence.gaps[0].reason);
}

TEST(SequenceTest, ScrewWiderThanItsHoleIsReportedWithBothDiameters) {  // N10
  // Drawn where it ends: its thread beyond the plate, its neck in the hole, its head on top.
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  Product product;
  product.name = "tight";
  const auto plate =
      testing::AddPart(&product, "plate", contact::testing::Bushing(3e-3, 20e-3, 10e-3, 20e-6));
  const auto screw = testing::AddPart(
      &product, "screw",
      contact::testing::Lathe({{{{0, -8e-3}, {3.2e-3, -8e-3}}, PlaneAt(-8e-3, -1)},
                               {{{3.2e-3, -8e-3}, {3.2e-3, -1e-3}}, CylinderZ(3.2e-3, 1)},
                               {{{3.2e-3, -1e-3}, {2.8e-3, -1e-3}}, PlaneAt(-1e-3, 1)},
                               {{{2.8e-3, -1e-3}, {2.8e-3, 10e-3}}, CylinderZ(2.8e-3, 1)},
                               {{{2.8e-3, 10e-3}, {5e-3, 10e-3}}, PlaneAt(10e-3, -1)},
                               {{{5e-3, 10e-3}, {5e-3, 13e-3}}, CylinderZ(5e-3, 1)},
                               {{{5e-3, 13e-3}, {0, 13e-3}}, PlaneAt(13e-3, 1)}},
                              64));
  testing::Place(&product, plate, "plate");
  testing::Place(&product, screw, "screw");
  testing::Complete(&product);
  const Planned planned(product);
  ASSERT_EQ(planned.sequence.gaps.size(), 1U);
  EXPECT_PRED_FORMAT2(IsSubstring, "meets tight/plate", planned.sequence.gaps[0].reason);
  EXPECT_PRED_FORMAT2(IsSubstring, "its diameter of 6.400 mm does not pass the hole of 6.000 mm",
                      planned.sequence.gaps[0].reason);
}

/** An axis-hole mate between two occurrences along a direction of the world, by hand. */
void AddAxisMate(Product* product, OccurrenceId a, OccurrenceId b, const Vec3& axis_W) {
  product::Mate mate;
  mate.id = product::MateId(product->mates.size());
  mate.kind = product::MateKind::kAxisHole;
  const Pose X_WM(spatial::FrameFromZ(axis_W), Vec3::Zero());
  mate.a = {a, product::FeatureId(0), product->occurrences[a.index()].X_WB.Inverse() * X_WM};
  mate.b = {b, product::FeatureId(0), product->occurrences[b.index()].X_WB.Inverse() * X_WM};
  mate.hole_radius = mate.shaft_radius = 1e-3;
  mate.hole_low = mate.shaft_low = -1e-3;
  mate.hole_high = mate.shaft_high = 1e-3;
  product->mates.push_back(mate);
}

/** A product without mates of cubes that do not touch, of three sizes. */
struct Cubes {
  explicit Cubes(const std::string& name) {
    product.name = name;
    const auto add = [this](const std::string& part, double half_edge) {
      return testing::AddPart(&product, part, contact::testing::Block(Vec3::Constant(half_edge)));
    };
    small = add("small", 3e-3);
    middle = add("middle", 5e-3);
    large = add("large", 8e-3);
  }

  Product product;
  product::PartId small, middle, large;
};

/** A base, a key above it and a wall beside the key: `AddAxisMate` says what holds them. */
struct KeyAndWall : Cubes {
  explicit KeyAndWall(const std::string& name) : Cubes(name) {
    key = testing::Place(&product, small, "key", Pose(Vec3(0, 0, 30e-3)));
    wall = testing::Place(&product, middle, "wall", Pose(Vec3(30e-3, 0, 30e-3)));
    base = testing::Place(&product, large, "base");
    testing::Complete(&product);
  }

  OccurrenceId key, wall, base;
};

TEST(SequenceTest, PartHeldAlongTwoAxesHasNoWayOutAndTheReasonNamesWhatHoldsIt) {  // N10
  KeyAndWall parts("cross");
  Product& product = parts.product;
  const OccurrenceId key = parts.key, wall = parts.wall, base = parts.base;
  ASSERT_TRUE(product.mates.empty());
  AddAxisMate(&product, wall, key, Vec3::UnitX());
  AddAxisMate(&product, base, key, Vec3::UnitZ());
  AddAxisMate(&product, base, wall, Vec3::UnitY());
  const Planned planned(product);
  ASSERT_EQ(planned.sequence.gaps.size(), 1u);
  EXPECT_EQ(planned.sequence.gaps[0].occurrence, key);
  EXPECT_PRED_FORMAT2(IsSubstring, "cross/wall", planned.sequence.gaps[0].reason);
  EXPECT_PRED_FORMAT2(IsSubstring, "cross/base", planned.sequence.gaps[0].reason);
  // The rest of the product is still planned.
  EXPECT_EQ(planned.order(), (Names{"base", "wall"}));
}

TEST(SequenceTest, PartsThatHoldEachOtherComeOutTogether) {  // Wilson and Latombe 1994
  // The same, but the wall leaves the base along the axis of the key: both go in as one body.
  KeyAndWall parts("pair");
  Product& product = parts.product;
  const OccurrenceId key = parts.key, wall = parts.wall, base = parts.base;
  AddAxisMate(&product, wall, key, Vec3::UnitX());
  AddAxisMate(&product, base, key, Vec3::UnitZ());
  AddAxisMate(&product, base, wall, Vec3::UnitZ());
  const Planned planned(product);
  EXPECT_TRUE(planned.sequence.gaps.empty());
  EXPECT_EQ(planned.order(), (Names{"wall", "key", "wall", "base", "wall"}));
  ASSERT_EQ(planned.sequence.steps.size(), 5U);
  EXPECT_EQ(planned.sequence.steps[2].kind, SequenceStep::Kind::kPark);
  EXPECT_EQ(planned.sequence.steps[4].members, std::vector<OccurrenceId>{key});
}

TEST(SequenceTest, PartThatBlocksMostOthersIsGivenUp) {  // N10
  // The plug has no way out, and both pins have a mate with it that leaves them none.
  Cubes cubes("captive");
  Product& product = cubes.product;
  const auto base = testing::Place(&product, cubes.large, "base");
  const auto plug = testing::Place(&product, cubes.middle, "plug", Pose(Vec3(0, 0, 30e-3)));
  testing::Place(&product, cubes.small, "pin 1", Pose(Vec3(30e-3, 0, 30e-3)));
  testing::Place(&product, cubes.small, "pin 2", Pose(Vec3(-30e-3, 0, 30e-3)));
  testing::Complete(&product);
  AddAxisMate(&product, base, plug, Vec3::UnitX());
  AddAxisMate(&product, base, plug, Vec3::UnitZ());
  for (const std::size_t pin : {2, 3}) {
    AddAxisMate(&product, plug, OccurrenceId(pin), Vec3::UnitY());
    AddAxisMate(&product, base, OccurrenceId(pin), Vec3::UnitX());
  }
  const Planned planned(product);
  ASSERT_EQ(planned.sequence.gaps.size(), 1U);
  EXPECT_EQ(planned.sequence.gaps[0].occurrence, plug);
  EXPECT_EQ(planned.order(), (Names{"base", "pin 2", "pin 1"}));
}

TEST(SequenceTest, DrawnOverlapIsReportedOnceWithItsDepthAndDoesNotBlock) {
  for (const double depth : {0.2e-3, 0.7e-3}) {
    Product product;
    product.name = "sunk";
    const auto large =
        testing::AddPart(&product, "large", contact::testing::Block(Vec3::Constant(10e-3)));
    const auto small =
        testing::AddPart(&product, "small", contact::testing::Block(Vec3::Constant(4e-3)));
    testing::Place(&product, large, "large");
    testing::Place(&product, small, "small", Pose(Vec3(1e-3, 2e-3, 14e-3 - depth)));
    testing::Complete(&product);
    const Planned planned(product);
    ASSERT_EQ(planned.sequence.overlaps.size(), 1u) << depth;
    const DrawnOverlap& overlap = planned.sequence.overlaps[0];
    EXPECT_EQ(std::minmax(overlap.a, overlap.b), std::minmax(OccurrenceId(0), OccurrenceId(1)));
    EXPECT_NEAR(overlap.depth, depth, 2e-6);
    EXPECT_EQ(planned.order(), (Names{"large", "small"}));
    EXPECT_TRUE(planned.sequence.gaps.empty());
  }
}

TEST(SequenceTest, TouchingPartsAndPressFitsAreNoOverlap) {
  Product product;
  product.name = "press";
  const auto bush =
      testing::AddPart(&product, "bush", contact::testing::Bushing(5e-3, 12e-3, 20e-3, 20e-6));
  // Drawn 0.1 mm too thick, as some files draw a press fit: the mate explains it.
  const auto pin = testing::AddPart(&product, "pin", contact::testing::Shaft(5.1e-3, 30e-3, 20e-6));
  testing::Place(&product, bush, "bush");
  testing::Place(&product, pin, "pin", Pose(Vec3(0, 0, -5e-3)));
  testing::Complete(&product);
  ASSERT_EQ(product.mates.size(), 1u);
  const Planned planned(product);
  EXPECT_TRUE(planned.sequence.overlaps.empty());
  EXPECT_EQ(planned.order(), (Names{"bush", "pin"}));
}

/** A plate with equal pegs on top of it: every order would do. */
Product EqualPegs() {
  Product product;
  product.name = "board";
  const auto plate =
      testing::AddPart(&product, "plate", contact::testing::Block(Vec3(40e-3, 40e-3, 3e-3)));
  const auto peg = testing::AddPart(&product, "peg", contact::testing::Shaft(3e-3, 8e-3, 20e-6));
  for (int i = 0; i < 5; ++i) {
    testing::Place(&product, peg, "peg " + std::to_string(i + 1),
                   Pose(Vec3(-20e-3 + 10e-3 * i, 5e-3 * i, 3e-3)));
  }
  testing::Place(&product, plate, "plate");
  testing::Complete(&product);
  return product;
}

TEST(SequenceTest, EqualProductsGiveEqualOrders) {
  const Planned first(EqualPegs());
  const Planned second(EqualPegs());
  ASSERT_EQ(first.sequence.steps.size(), 6u);
  EXPECT_EQ(first.order(), second.order());
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(first.sequence.steps[i].extraction_W, second.sequence.steps[i].extraction_W);
    EXPECT_EQ(first.sequence.steps[i].engage_distance, second.sequence.steps[i].engage_distance);
  }
  // Among equals the one first in the file comes off first.
  EXPECT_EQ(first.order(), (Names{"plate", "peg 5", "peg 4", "peg 3", "peg 2", "peg 1"}));
}

/** A plate over a base, held by a small bracket alone that stands on the base. */
Product PlateOnBracket() {
  Product product;
  product.name = "shelf";
  const auto base =
      testing::AddPart(&product, "base", contact::testing::Block(Vec3(40e-3, 40e-3, 5e-3)));
  const auto bracket =
      testing::AddPart(&product, "bracket", contact::testing::Block(Vec3::Constant(4e-3)));
  const auto plate =
      testing::AddPart(&product, "plate", contact::testing::Block(Vec3(20e-3, 4e-3, 4e-3)));
  testing::Place(&product, base, "base");
  testing::Place(&product, bracket, "bracket", Pose(Vec3(30e-3, 0, 9e-3)));
  testing::Place(&product, plate, "plate", Pose(Vec3(6e-3, 0, 10e-3)));
  testing::Complete(&product);
  return product;
}

TEST(SequenceTest, PartThatHoldsAnotherOneGoesInBeforeIt) {  // connected assembly
  // The plate touches the bracket alone. By size alone the bracket would go in last.
  const Planned planned(PlateOnBracket());
  EXPECT_EQ(planned.order(), (Names{"base", "bracket", "plate"}));
  const Neighbours& neighbours = planned.sequence.neighbours;
  EXPECT_EQ(neighbours[0], std::vector<OccurrenceId>{OccurrenceId(1)});
  EXPECT_EQ(neighbours[1], (std::vector<OccurrenceId>{OccurrenceId(0), OccurrenceId(2)}));
  EXPECT_EQ(neighbours[2], std::vector<OccurrenceId>{OccurrenceId(1)});
}

TEST(SequenceTest, PartThatHangsOnAnotherOneAloneGoesInWithIt) {
  // The pendant cannot come out before the lid, and nothing but the lid holds it.
  const Planned planned(testing::PendantUnderLid());
  EXPECT_TRUE(planned.sequence.gaps.empty());
  ASSERT_EQ(planned.order(), (Names{"lid", "pendant", "lid", "cup", "lid"}));
  EXPECT_EQ(planned.sequence.steps[0].kind, SequenceStep::Kind::kBase);
  EXPECT_EQ(planned.sequence.steps[2].kind, SequenceStep::Kind::kPark);
  EXPECT_EQ(planned.sequence.steps[4].members, std::vector<OccurrenceId>{OccurrenceId(2)});
}

TEST(SequenceTest, PartThatTouchesNothingHasNoNeighbours) {
  Product product;
  product.name = "apart";
  const auto base =
      testing::AddPart(&product, "base", contact::testing::Block(Vec3::Constant(9e-3)));
  const auto cube =
      testing::AddPart(&product, "cube", contact::testing::Block(Vec3::Constant(3e-3)));
  testing::Place(&product, base, "base");
  testing::Place(&product, cube, "on it", Pose(Vec3(0, 0, 12.05e-3)));
  testing::Place(&product, cube, "above", Pose(Vec3(0, 0, 30e-3)));
  testing::Complete(&product);
  product.mates.clear();
  const Planned planned(product);
  EXPECT_EQ(planned.sequence.neighbours[1], std::vector<OccurrenceId>{OccurrenceId(0)});
  EXPECT_TRUE(planned.sequence.neighbours[2].empty());
  EXPECT_EQ(planned.sequence.steps.size(), 3U);
}

TEST(CutPartsTest, PartsBetweenOthersAreFound) {
  // 0 - 1 - 2, a triangle 2 3 4, and 5 by itself.
  const auto ids = [](std::initializer_list<std::size_t> list) {
    std::vector<OccurrenceId> result;
    for (const std::size_t i : list) {
      result.emplace_back(i);
    }
    return result;
  };
  const Neighbours neighbours{ids({1}), ids({0, 2}), ids({1, 3, 4}), ids({2, 4}), ids({2, 3}), {}};
  EXPECT_EQ(ListCutParts(ids({0, 1, 2, 3, 4, 5}), neighbours), ids({1, 2}));
  EXPECT_EQ(ListCutParts(ids({4, 3, 2, 1}), neighbours), ids({2}));
  EXPECT_EQ(ListCutParts(ids({3, 4, 2}), neighbours), ids({}));
  EXPECT_EQ(ListConnected(OccurrenceId(3), ids({4, 3, 1, 0, 5}), neighbours), ids({4, 3}));
  EXPECT_TRUE(AreConnected(ids({0, 1, 2}), neighbours));
  EXPECT_FALSE(AreConnected(ids({0, 2}), neighbours));
}

TEST(ReorderTest, NamedPartsComeFirstInTheOrderGiven) {
  const Planned planned(EqualPegs());
  const auto reordered = Reorder(planned.product, planned.sequence, {"o5", "peg 2", "board/peg 4"});
  ASSERT_TRUE(reordered.has_value()) << reordered.error().ToString();
  Names names;
  for (const SequenceStep& step : reordered->steps) {
    names.push_back(planned.product.occurrences[step.occurrence.index()].name);
  }
  EXPECT_EQ(names, (Names{"plate", "peg 2", "peg 4", "peg 5", "peg 3", "peg 1"}));
  // A step keeps its way in.
  EXPECT_EQ(reordered->steps[1].engage_distance, planned.sequence.steps[4].engage_distance);
}

TEST(ReorderTest, UnknownOrUsedUpNameIsAnErrorThatNamesIt) {
  const Planned planned(EqualPegs());
  for (const Names& names : {Names{"peg 9"}, Names{"o17"}, Names{"peg 1", "peg 1"}, Names{""}}) {
    const auto reordered = Reorder(planned.product, planned.sequence, names);
    ASSERT_FALSE(reordered.has_value());
    EXPECT_EQ(reordered.error().code, ErrorCode::kNotFound);
    EXPECT_PRED_FORMAT2(IsSubstring, "'" + names.back() + "'", reordered.error().message);
    EXPECT_PRED_FORMAT2(IsSubstring, "hvas inspect", reordered.error().remedy);
  }
}

}  // namespace
}  // namespace hvas::sequence
