// Parts that lie in one another as drawn, and parts that give: what lets them pass one another, and
// what does not. X17, N10.

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "base/random.h"
#include "mates/drawing_errors.h"
#include "person/test/session.h"
#include "simulation/test/small_models.h"

namespace hvas::person {
namespace {

using sequence::testing::OccurrenceId;
using sequence::testing::Pose;
using sequence::testing::Product;
using ::testing::IsSubstring;
using Answer = sequence::DrawnOverlap::Answer;

/** A part of flat faces. */
class FlatPart {
 public:
  /** Adds a face of quads, each counterclockwise as seen from outside. Quads may be triangles. */
  void AddFace(const std::vector<std::array<Vec3, 4>>& quads) {
    constexpr double kLeast = 1e-12;  // [m^2]: less is no triangle.
    const auto face = static_cast<std::uint32_t>(source_.faces.size());
    Vec3 normal = Vec3::Zero();
    for (const std::array<Vec3, 4>& p : quads) {
      const auto first = static_cast<std::uint32_t>(source_.vertices.size());
      source_.vertices.insert(source_.vertices.end(), p.begin(), p.end());
      for (const std::uint32_t i : {1U, 2U}) {
        const Vec3 n = (p[i] - p[0]).cross(p[i + 1] - p[0]);
        if (n.norm() > kLeast) {
          normal += n;
          source_.triangles.push_back({first, first + i, first + i + 1});
          source_.triangle_face.push_back(face);
        }
      }
    }
    source_.faces.push_back(
        {spatial::SurfaceKind::kPlane, quads[0][0], normal.normalized(), 0, 0, 1});
  }

  /** Adds the sides between two rectangles, `from` to `to`, which go round counterclockwise about
   the way from one to the other. */
  void AddSides(const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = (i + 1) % 4;
      AddFace({{from[i], from[k], to[k], to[i]}});
    }
  }

  /** Adds a plane ring between two rectangles that go round counterclockwise as seen from outside.
   */
  void AddRing(const std::array<Vec3, 4>& outer, const std::array<Vec3, 4>& inner) {
    std::vector<std::array<Vec3, 4>> quads;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = (i + 1) % 4;
      quads.push_back({outer[i], outer[k], inner[k], inner[i]});
    }
    AddFace(quads);
  }

  [[nodiscard]] const contact::ShapeSource& source() const { return source_; }

 private:
  contact::ShapeSource source_;
};

/** A square part about z: half widths over heights, the material on the left as in Lathe. Each
 flat is a face of its own. */
contact::ShapeSource Square(const std::vector<Eigen::Vector2d>& profile) {
  const auto corners = [](const Eigen::Vector2d& wz) {
    const double w = wz.x();
    return std::array<Vec3, 4>{Vec3(w, -w, wz.y()), Vec3(w, w, wz.y()), Vec3(-w, w, wz.y()),
                               Vec3(-w, -w, wz.y())};
  };
  FlatPart part;
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    part.AddSides(corners(profile[k]), corners(profile[k + 1]));
  }
  return part.source();
}

constexpr double kHalf = 10e-3;  // Half width of the pocket.

/** A pocket, and a block in it that is wider than kHalf by `overlap` on each side.
 @param profile  The pocket's, up to its inner wall; its floor is 5 mm high. */
Product PocketWithBlock(std::vector<Eigen::Vector2d> profile, double overlap) {
  Product product;
  product.name = "pocket";
  profile.insert(profile.end(), {{kHalf, 5e-3}, {0, 5e-3}});
  const auto pocket = sequence::testing::AddPart(&product, "pocket", Square(profile));
  const double half = kHalf + overlap;
  const auto block = sequence::testing::AddPart(
      &product, "block", Square({{0, 0}, {half, 0}, {half, 8e-3}, {0, 8e-3}}));
  sequence::testing::Place(&product, pocket, "pocket");
  sequence::testing::Place(&product, block, "block", Pose(Vec3(0, 0, 5e-3)));
  sequence::testing::Complete(&product);
  return product;
}

/** @param lip  How far a lip reaches over the pocket's opening [m]; 0: none. */
Product BlockInPocket(double overlap, double lip) {
  const double open = kHalf - lip;
  std::vector<Eigen::Vector2d> profile{{0, 0}, {15e-3, 0}, {15e-3, 25e-3}, {open, 25e-3}};
  if (lip > 0) {
    profile.insert(profile.end(), {{open, 20e-3}, {kHalf, 20e-3}});
  }
  return PocketWithBlock(profile, overlap);
}

/** @param narrowing  How far the pocket's walls lean in to its opening [m]. */
Product TaperedPocket(double overlap, double narrowing) {
  return PocketWithBlock(
      {{0, 0}, {15e-3, 0}, {15e-3, 25e-3}, {kHalf - narrowing, 25e-3}, {kHalf, 13e-3}}, overlap);
}

std::shared_ptr<const simulation::Model> CompileProduct(Product product) {
  Diagnostics diagnostics;
  auto model = simulation::Compile(std::make_shared<Product>(std::move(product)),
                                   simulation::testing::FastOptions(), &diagnostics);
  EXPECT_TRUE(model.has_value());
  return model ? *model : nullptr;
}

simulation::PartResult Assemble(const std::shared_ptr<const simulation::Model>& model,
                                std::uint64_t seed = 1) {
  testing::Session session(model, seed);
  (void)simulation::RunLockstep(session.MakeExecution(60));
  return session.run.results().back();
}

TEST(OverlapTest, SmallPartsThatCrossHaveFacesThatAreThere) {
  // Contact knows no face further inside than some cells of its field, which are small here.
  Random random(20);
  int overlapping = 0;
  for (int draw = 0; draw < 25; ++draw) {
    SCOPED_TRACE(draw);
    Product product;
    product.name = "crossing";
    for (const char* name : {"first", "second", "third"}) {
      const Vec3 half(random.Uniform(0.3e-3, 3e-3), random.Uniform(0.3e-3, 3e-3),
                      random.Uniform(0.3e-3, 3e-3));
      const auto part = sequence::testing::AddPart(&product, name, contact::testing::Block(half));
      const Vec3 turn(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
      const Vec3 p(random.Uniform(-2e-3, 2e-3), random.Uniform(-2e-3, 2e-3), 0);
      sequence::testing::Place(&product, part, name, Pose(spatial::RotationFromVector(turn), p));
    }
    sequence::testing::Complete(&product);
    const auto model = CompileProduct(std::move(product));
    ASSERT_NE(model, nullptr);
    for (const sequence::DrawnOverlap& overlap : model->sequence.overlaps) {
      ++overlapping;
      for (const auto& [id, faces] :
           {std::pair(overlap.a, overlap.faces_a), std::pair(overlap.b, overlap.faces_b)}) {
        for (const std::uint32_t face : faces) {
          EXPECT_LT(face, model->product->part_of(id).faces.size());
        }
      }
    }
  }
  EXPECT_GT(overlapping, 20);
}

TEST(OverlapTest, BlockThatOverlapsItsPocketGoesInByAnAllowanceOfTheDrawnDepth) {
  // Faces can give way by half a millimetre; what is deeper is allowed where the two overlap.
  for (const double depth : {0.1e-3, 0.8e-3}) {
    const auto model = CompileProduct(BlockInPocket(depth, 0));
    const sequence::Sequence& sequence = model->sequence;
    ASSERT_EQ(sequence.overlaps.size(), 1U) << depth;
    const sequence::DrawnOverlap& overlap = sequence.overlaps[0];
    EXPECT_EQ(overlap.answer, depth < 0.5e-3 ? Answer::kRelief : Answer::kAllowance);
    EXPECT_NEAR(overlap.depth, depth, 5e-6);
    EXPECT_TRUE(sequence.gaps.empty()) << sequence.gaps[0].reason;
    // The walls of the pocket, in the profile's order four faces each, and the block's sides.
    const bool is_pocket_a = overlap.a == OccurrenceId(0);
    const auto& of_pocket = is_pocket_a ? overlap.faces_a : overlap.faces_b;
    const auto& of_block = is_pocket_a ? overlap.faces_b : overlap.faces_a;
    for (std::uint32_t i = 0; i < 4; ++i) {
      EXPECT_TRUE(std::binary_search(of_pocket.begin(), of_pocket.end(), 12 + i)) << i;
      EXPECT_TRUE(std::binary_search(of_block.begin(), of_block.end(), 4 + i)) << i;
    }
    EXPECT_FALSE(std::binary_search(of_pocket.begin(), of_pocket.end(), 8U));  // Its top.
    const simulation::PartResult block = Assemble(model);
    EXPECT_TRUE(block.is_seated) << block.reason;
    ASSERT_EQ(block.allowances.size(), 1U);
    EXPECT_EQ(block.allowances[0].kind, simulation::PartAllowance::Kind::kDrawn);
    EXPECT_EQ(block.allowances[0].other, OccurrenceId(0));
    EXPECT_NEAR(block.allowances[0].depth, depth, 5e-6);
    EXPECT_PRED_FORMAT2(IsSubstring, "only by an allowance", block.note);
  }
}

TEST(OverlapTest, OverlapAsDrawnDoesNotLetAPartThroughALipThatNeedsMore) {
  const auto model = CompileProduct(BlockInPocket(0.1e-3, 3e-3));
  ASSERT_EQ(model->sequence.gaps.size(), 1U);
  EXPECT_EQ(model->sequence.gaps[0].occurrence, OccurrenceId(1));
  EXPECT_PRED_FORMAT2(IsSubstring, "meets pocket/pocket", model->sequence.gaps[0].reason);
  EXPECT_PRED_FORMAT2(IsSubstring, "overlap by 0.100 mm, and the way would need more",
                      model->sequence.gaps[0].reason);
}

TEST(OverlapTest, LipThatNeedsNoMoreThanTheDrawnDepthIsNotWhereItIsDrawn) {
  // A lip of 0.4 mm beside an overlap of 0.4 mm: nowhere else than drawn.
  const auto model = CompileProduct(BlockInPocket(0.4e-3, 0.4e-3));
  ASSERT_EQ(model->sequence.gaps.size(), 1U);
}

TEST(OverlapTest, WayThatNeedsALittleMoreThanTheDrawnDepthIsTakenAndThatIsSaid) {
  const auto model = CompileProduct(TaperedPocket(0.6e-3, 0.4e-3));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->sequence.overlaps.size(), 1U);
  EXPECT_TRUE(model->sequence.overlaps[0].is_beyond);
  const simulation::PartResult block = Assemble(model);
  EXPECT_TRUE(block.is_seated) << block.reason;
  ASSERT_EQ(block.allowances.size(), 1U);
  EXPECT_TRUE(block.allowances[0].is_beyond);
  EXPECT_PRED_FORMAT2(IsSubstring, "0.5 mm more than drawn", block.note);
  EXPECT_FALSE(CompileProduct(BlockInPocket(0.6e-3, 0))->sequence.overlaps[0].is_beyond);
  // Half a millimetre more, and not 0.6, where the walls do not bend.
  EXPECT_EQ(CompileProduct(sequence::testing::StateRigid(TaperedPocket(0.1e-3, 0.6e-3)))
                ->sequence.gaps.size(),
            1U);
}

TEST(OverlapTest, PartOfAnErrorOfTheDrawingIsLeftOutWithoutASearchAndTheOthersGoIn) {
  for (const int count : {2, 5}) {
    Product product = sequence::testing::BlocksOnPlate(count + 1);
    for (int i = 1; i <= count; ++i) {  // All but the last one are 5 mm deep in the plate.
      spatial::Pose& X_WB = product.occurrences[static_cast<std::size_t>(i)].X_WB;
      X_WB = {X_WB.q(), X_WB.p() - 5e-3 * Vec3::UnitZ()};
    }
    sequence::testing::Complete(&product);
    product.drawing_errors = mates::ListDrawingErrors(product);
    EXPECT_EQ(product.drawing_errors.size(), static_cast<std::size_t>(count));
    const auto model = CompileProduct(std::move(product));
    ASSERT_EQ(model->sequence.gaps.size(), static_cast<std::size_t>(count));
    for (const sequence::SequenceGap& gap : model->sequence.gaps) {
      EXPECT_PRED_FORMAT2(IsSubstring, "an error of the drawing", gap.reason);
      EXPECT_PRED_FORMAT2(IsSubstring, "5.000 mm deep", gap.reason);
    }
    EXPECT_NE(
        sequence::FindInsertion(model->sequence, OccurrenceId(static_cast<std::size_t>(count + 1))),
        nullptr);
  }
}

TEST(OverlapTest, NoAllowanceIsMoreThanAFitOfTheSizeHas) {
  // A pocket that leans in by 0.5 mm beyond an overlap of 1.4 mm: 1.65 mm is the most at this size.
  const auto model = CompileProduct(sequence::testing::StateRigid(TaperedPocket(1.4e-3, 0.5e-3)));
  EXPECT_EQ(model->sequence.gaps.size(), 1U);
  ASSERT_EQ(model->sequence.overlaps.size(), 1U);
  EXPECT_NEAR(model->sequence.overlaps[0].largest, 1.65e-3, 1e-9);
  EXPECT_LE(model->sequence.overlaps[0].allowed, 1.65e-3 + 10e-6);
}

std::array<Vec3, 4> Reversed(const std::array<Vec3, 4>& p) {
  return {p[3], p[2], p[1], p[0]};
}

TEST(OverlapTest, OpenBoxThatFillsItsCaseDoesNotOverlapIt) {
  // A drawer 92 mm wide and 32 mm high, with walls of 3 mm, in a case open at both ends along y.
  const auto at_z = [](double x, double y, double z) {
    return std::array<Vec3, 4>{Vec3(-x, -y, z), Vec3(x, -y, z), Vec3(x, y, z), Vec3(-x, y, z)};
  };
  const auto at_y = [](double x, double y, double z) {  // Counterclockwise as seen from -y.
    return std::array<Vec3, 4>{Vec3(-x, y, -z), Vec3(x, y, -z), Vec3(x, y, z), Vec3(-x, y, z)};
  };
  FlatPart drawer;
  drawer.AddFace({Reversed(at_z(46e-3, 38e-3, -16e-3))});
  drawer.AddSides(at_z(46e-3, 38e-3, -16e-3), at_z(46e-3, 38e-3, 16e-3));
  drawer.AddRing(at_z(46e-3, 38e-3, 16e-3), at_z(43e-3, 35e-3, 16e-3));
  drawer.AddSides(Reversed(at_z(43e-3, 35e-3, -13e-3)), Reversed(at_z(43e-3, 35e-3, 16e-3)));
  drawer.AddFace({at_z(43e-3, 35e-3, -13e-3)});
  FlatPart around;
  around.AddSides(Reversed(at_y(50e-3, -40e-3, 20e-3)), Reversed(at_y(50e-3, 40e-3, 20e-3)));
  around.AddRing(at_y(50e-3, -40e-3, 20e-3), at_y(46e-3, -40e-3, 16e-3));
  around.AddSides(at_y(46e-3, -40e-3, 16e-3), at_y(46e-3, 40e-3, 16e-3));
  around.AddRing(Reversed(at_y(50e-3, 40e-3, 20e-3)), Reversed(at_y(46e-3, 40e-3, 16e-3)));
  Product product;
  product.name = "cabinet";
  sequence::testing::Place(&product, sequence::testing::AddPart(&product, "case", around.source()),
                           "case");
  sequence::testing::Place(
      &product, sequence::testing::AddPart(&product, "drawer", drawer.source()), "drawer");
  sequence::testing::Complete(&product);
  const auto model = CompileProduct(std::move(product));
  EXPECT_TRUE(model->sequence.overlaps.empty());
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  const simulation::PartResult inserted = Assemble(model);
  EXPECT_TRUE(inserted.is_seated) << inserted.reason;
}

TEST(OverlapTest, PegThroughAClosedWallIsRefused) {
  for (const double thickness : {0.6e-3, 2e-3, 5e-3}) {
    Product product;
    product.name = "closed";
    const auto wall = sequence::testing::AddPart(
        &product, "wall", contact::testing::Block(Vec3(30e-3, 30e-3, 0.5 * thickness)));
    const auto peg =
        sequence::testing::AddPart(&product, "peg", contact::testing::Shaft(3e-3, 20e-3, 20e-6));
    sequence::testing::Place(&product, wall, "wall");
    sequence::testing::Place(&product, peg, "peg", Pose(Vec3(0, 0, -10e-3)));
    sequence::testing::Complete(&product);
    ASSERT_TRUE(product.mates.empty());
    const auto model = CompileProduct(std::move(product));
    ASSERT_EQ(model->sequence.overlaps.size(), 1U) << thickness;
    EXPECT_EQ(model->sequence.overlaps[0].answer, Answer::kNone);
    ASSERT_EQ(model->sequence.gaps.size(), 1U) << thickness;
    EXPECT_PRED_FORMAT2(IsSubstring, "with no opening for it", model->sequence.gaps[0].reason);
  }
}

TEST(OverlapTest, PressFitIsNoAllowance) {
  Product product;
  product.name = "press";
  const auto bush = sequence::testing::AddPart(
      &product, "bush", contact::testing::Bushing(5e-3, 12e-3, 20e-3, 20e-6));
  const auto pin =
      sequence::testing::AddPart(&product, "pin", contact::testing::Shaft(5.025e-3, 30e-3, 20e-6));
  sequence::testing::Place(&product, bush, "bush");
  sequence::testing::Place(&product, pin, "pin", Pose(Vec3(0, 0, -5e-3)));
  sequence::testing::Complete(&product);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(product.mates[0].fit->kind, product::FitKind::kInterference);
  const auto model = CompileProduct(std::move(product));
  EXPECT_TRUE(model->sequence.overlaps.empty());
  EXPECT_TRUE(model->sequence.gaps.empty());
}

constexpr double kGroove = 4.5e-3;  // Radius of the groove, and of the ring's hole.
constexpr double kLand = 5e-3;      // Radius of the shaft beside the groove.

/** Adds a shaft with a groove between its end and a flange. */
product::PartId AddGroovedShaft(Product* product) {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  return sequence::testing::AddPart(
      product, "shaft",
      contact::testing::Lathe({{{{0, 0}, {10e-3, 0}}, PlaneAt(0, -1)},
                               {{{10e-3, 0}, {10e-3, 8e-3}}, CylinderZ(10e-3, 1)},
                               {{{10e-3, 8e-3}, {kLand, 8e-3}}, PlaneAt(8e-3, 1)},
                               {{{kLand, 8e-3}, {kLand, 12e-3}}, CylinderZ(kLand, 1)},
                               {{{kLand, 12e-3}, {kGroove, 12e-3}}, PlaneAt(12e-3, 1)},
                               {{{kGroove, 12e-3}, {kGroove, 13.2e-3}}, CylinderZ(kGroove, 1)},
                               {{{kGroove, 13.2e-3}, {kLand, 13.2e-3}}, PlaneAt(13.2e-3, -1)},
                               {{{kLand, 13.2e-3}, {kLand, 16e-3}}, CylinderZ(kLand, 1)},
                               {{{kLand, 16e-3}, {0, 16e-3}}, PlaneAt(16e-3, 1)}},
                              64));
}

/** The shaft, and a ring in its groove. */
Product RingInGroove(double limit) {
  Product product;
  product.name = "axle";
  const auto shaft = AddGroovedShaft(&product);
  const auto ring = sequence::testing::AddPart(
      &product, "ring", contact::testing::Bushing(kGroove, 7e-3, 1e-3, 20e-6));
  sequence::testing::Place(&product, shaft, "shaft");
  sequence::testing::Place(&product, ring, "ring", Pose(Vec3(0, 0, 12.1e-3)));
  sequence::testing::Complete(&product);
  if (limit > 0) {
    product.flexible.push_back(
        {OccurrenceId(1), product::FlexibleKind::kRetainingRing, limit, "a test"});
  }
  return product;
}

TEST(GiveTest, RingGoesOverALandByGivingAsMuchAsItHasTo) {
  const auto model = CompileProduct(RingInGroove(0.6e-3));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->sequence.gives.size(), 1U);
  const sequence::GivingPair& give = model->sequence.gives[0];
  EXPECT_EQ(give.flexible, OccurrenceId(1));
  EXPECT_EQ(give.other, OccurrenceId(0));
  EXPECT_NEAR(give.depth, kLand - kGroove, 50e-6);
  const simulation::PartResult ring = Assemble(model);
  EXPECT_TRUE(ring.is_seated) << ring.reason;
  ASSERT_EQ(ring.allowances.size(), 1U);
  EXPECT_EQ(ring.allowances[0].kind, simulation::PartAllowance::Kind::kGive);
  EXPECT_NEAR(ring.allowances[0].depth, 0.5e-3, 50e-6);
  EXPECT_PRED_FORMAT2(IsSubstring, "goes in by giving 0.", ring.note);
  EXPECT_PRED_FORMAT2(IsSubstring, " mm (retaining ring, ", ring.note);
  // A ring of these dimensions over an edge that is drawn square, hence of 60 degrees. As the ring
  // has no gap, its width is estimated a seventh too large from its volume.
  const double across = fits::CalcSpreadStiffness({5.75e-3, 2.5e-3, 1e-3, 206e9}) * 0.5e-3;
  const double along = across * fits::CalcSlidingRatio(0.15, std::sqrt(3.0));
  EXPECT_GT(ring.allowances[0].force.in, along);
  EXPECT_LT(ring.allowances[0].force.in, 1.7 * along);
  // The edge is so short that a tick may pass over its largest force: of ten persons one meets it.
  double most = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const simulation::PartResult other = Assemble(model, seed);
    EXPECT_TRUE(other.is_seated) << seed << ": " << other.reason;
    EXPECT_LT(other.fit_true, 1.01 * ring.allowances[0].force.in) << seed;
    most = std::max(most, other.fit_true);
  }
  EXPECT_GT(most, 0.9 * ring.allowances[0].force.in);
}

TEST(GiveTest, RingThatMayGiveTooLittleOrNotAtAllStaysOut) {
  for (const double limit : {0.0, 0.4e-3}) {
    const auto model = CompileProduct(RingInGroove(limit));
    ASSERT_EQ(model->sequence.gaps.size(), 1U) << limit;
    EXPECT_EQ(model->sequence.gaps[0].occurrence, OccurrenceId(1));
    EXPECT_TRUE(model->sequence.gives.empty());
  }
}

/** The order in which the parts go in. */
std::vector<OccurrenceId> OrderOf(const simulation::Model& model) {
  std::vector<OccurrenceId> order;
  for (const sequence::SequenceStep& step : model.sequence.steps) {
    order.push_back(step.occurrence);
  }
  return order;
}

// Stretched over the land, the O-ring gives 0.5 mm of its section of 0.8 mm; drawn in between land
// and sleeve it would have to get flatter by as much and more.
TEST(GiveTest, AnORingIsPutOnBeforeTheSleeveThatSqueezesIt) {
  Product product;
  product.name = "seal";
  constexpr double kOuter = kGroove + 0.8e-3;
  const auto shaft = AddGroovedShaft(&product);
  const auto seal = sequence::testing::AddPart(
      &product, "o-ring", contact::testing::Bushing(kGroove, kOuter, 0.8e-3, 20e-6));
  sequence::testing::Place(&product, shaft, "shaft");
  sequence::testing::Place(&product, seal, "o-ring", Pose(Vec3(0, 0, 12.2e-3)));
  const auto sleeve = sequence::testing::AddPart(
      &product, "sleeve", contact::testing::Bushing(kOuter - 0.1e-3, 9e-3, 10e-3, 20e-6));
  sequence::testing::Place(&product, sleeve, "sleeve", Pose(Vec3(0, 0, 8e-3)));
  sequence::testing::Complete(&product);
  product.flexible.push_back({OccurrenceId(1), product::FlexibleKind::kORing, 0.8e-3, "a test"});
  const auto model = CompileProduct(std::move(product));
  EXPECT_TRUE(model->sequence.gaps.empty());
  EXPECT_EQ(OrderOf(*model), (std::vector{OccurrenceId(0), OccurrenceId(1), OccurrenceId(2)}));
  ASSERT_EQ(model->sequence.gives.size(), 2U);
  for (const sequence::GivingPair& give : model->sequence.gives) {
    EXPECT_EQ(give.flexible, OccurrenceId(1));
    ASSERT_TRUE(give.curve != nullptr);
    // It is stretched over the land, and squeezed by the sleeve.
    EXPECT_EQ(give.curve->squeezed.has_value(), give.moved == OccurrenceId(2));
  }
}

TEST(GiveTest, AWallThatBendsSnapsOverABeadWithoutANameThatTellsOfIt) {
  const auto model = CompileProduct(sequence::testing::CapOnBead(11.6e-3));
  ASSERT_TRUE(model->sequence.gaps.empty()) << model->sequence.gaps[0].reason;
  ASSERT_EQ(model->sequence.gives.size(), 1U);
  EXPECT_EQ(model->sequence.gives[0].kind, product::FlexibleKind::kForm);
  EXPECT_EQ(model->sequence.gives[0].flexible, OccurrenceId(1));
  EXPECT_NEAR(model->sequence.gives[0].width, 0.25e-3, 0.1e-3);
  const simulation::PartResult cap = Assemble(model);
  EXPECT_TRUE(cap.is_seated) << cap.reason;
  EXPECT_EQ(cap.allowances.size(), 1U);
  EXPECT_PRED_FORMAT2(IsSubstring, " mm (a wall that bends, ", cap.note);
  EXPECT_GT(cap.allowances[0].force.in, 1);
  EXPECT_NEAR(cap.fit_true, cap.allowances[0].force.in, 0.1 * cap.allowances[0].force.in);
}

TEST(GiveTest, AWallThatIsThickOrStatedToBeRigidDoesNotBend) {
  const auto thick = CompileProduct(sequence::testing::CapOnBead(16e-3));
  EXPECT_EQ(thick->sequence.gaps.size(), 1U);
  EXPECT_TRUE(thick->sequence.gives.empty());
  const auto rigid =
      CompileProduct(sequence::testing::StateRigid(sequence::testing::CapOnBead(11.6e-3)));
  EXPECT_EQ(rigid->sequence.gaps.size(), 1U);
  EXPECT_TRUE(rigid->sequence.gives.empty());
}

TEST(GiveTest, PartThatNeedsNoGiveHasNone) {
  Product product = sequence::testing::PegInBlock();
  product.flexible.push_back({OccurrenceId(1), product::FlexibleKind::kSnapHook, 1e-3, "a test"});
  const auto model = CompileProduct(std::move(product));
  EXPECT_TRUE(model->sequence.gaps.empty());
  EXPECT_TRUE(model->sequence.gives.empty());
}

}  // namespace
}  // namespace hvas::person
