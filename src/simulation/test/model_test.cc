#include "simulation/model.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sequence/extraction.h"
#include "sequence/mate_faces.h"
#include "simulation/test/small_models.h"

namespace hvas::simulation {
namespace {

using product::FaceId;
using product::FeatureKind;
using product::OccurrenceId;
using product::Product;
using Faces = std::vector<std::uint32_t>;

haptics::MateFaces CollectOfHole(const contact::ShapeSource& source) {
  Product product;
  const auto id = testing::AddPart(&product, "part", source);
  const product::Part& part = product.parts[id.index()];
  for (const product::Feature& feature : part.features) {
    if (feature.kind == FeatureKind::kHole) {
      return sequence::CollectMateFaces(part, feature.faces);
    }
  }
  ADD_FAILURE() << "no hole";
  return {};
}

TEST(CollectMateFacesTest, X9NeighboursOfABoreAreTheFacesThatShareItsEdges) {
  // Bushing: 0 bottom, 1 outside, 2 top, 3 bore. Cup: 4 floor.
  const haptics::MateFaces through =
      CollectOfHole(contact::testing::Bushing(5e-3, 10e-3, 20e-3, 20e-6));
  EXPECT_EQ(through.mating, (Faces{3}));
  EXPECT_EQ(through.with_neighbours, (Faces{0, 2, 3}));
  const haptics::MateFaces blind = CollectOfHole(contact::testing::Cup(5e-3, 10e-3, 4e-3, 20e-3));
  EXPECT_EQ(blind.mating, (Faces{3}));
  EXPECT_EQ(blind.with_neighbours, (Faces{2, 3, 4}));
}

TEST(CollectMateFacesTest, BoreInTwoPiecesMatesWithBoth) {
  using contact::testing::CylinderZ;
  using contact::testing::PlaneAt;
  const haptics::MateFaces faces =
      CollectOfHole(contact::testing::Lathe({{{{5e-3, 20e-3}, {5e-3, 8e-3}}, CylinderZ(5e-3, -1)},
                                             {{{5e-3, 0}, {10e-3, 0}}, PlaneAt(0, -1)},
                                             {{{10e-3, 0}, {10e-3, 20e-3}}, CylinderZ(10e-3, 1)},
                                             {{{10e-3, 20e-3}, {5e-3, 20e-3}}, PlaneAt(20e-3, 1)},
                                             {{{5e-3, 8e-3}, {5e-3, 0}}, CylinderZ(5e-3, -1)}},
                                            40));
  EXPECT_EQ(faces.mating, (Faces{0, 4}));
  EXPECT_EQ(faces.with_neighbours, (Faces{0, 1, 3, 4}));
}

TEST(CollectMateFacesTest, NeighboursOfABoxFaceAreTheFourAroundIt) {
  Product product;
  const auto id =
      testing::AddPart(&product, "box", contact::testing::Block(Vec3(5e-3, 6e-3, 7e-3)));
  for (const product::Feature& feature : product.parts[id.index()].features) {
    const haptics::MateFaces faces =
        sequence::CollectMateFaces(product.parts[id.index()], feature.faces);
    ASSERT_EQ(faces.mating.size(), 1u);
    EXPECT_EQ(faces.with_neighbours.size(), 5u);
    const std::uint32_t opposite = faces.mating[0] ^ 1u;
    EXPECT_FALSE(
        std::binary_search(faces.with_neighbours.begin(), faces.with_neighbours.end(), opposite));
  }
}

TEST(CollectMateFacesTest, FlankThatReachesAPlaneInOnePointIsItsNeighbour) {
  const auto neighbours_of_top = [](double gap) {
    constexpr double kTop = 7e-3;
    contact::ShapeSource source = contact::testing::Block(Vec3(5e-3, 6e-3, kTop));
    const auto first = static_cast<std::uint32_t>(source.vertices.size());
    const auto flank = static_cast<std::uint32_t>(source.faces.size());
    source.vertices.insert(
        source.vertices.end(),
        {Vec3(5e-3, 0, kTop - gap), Vec3(5e-3, -1e-3, 1e-3), Vec3(5e-3, 1e-3, 1e-3)});
    source.triangles.push_back({first, first + 1, first + 2});
    source.triangle_face.push_back(flank);
    source.faces.push_back(
        {spatial::SurfaceKind::kPlane, Vec3(5e-3, 0, 0), Vec3::UnitX(), 0, 0, 1});
    Product product;
    const auto id = testing::AddPart(&product, "tooth", source);
    const product::Part& part = product.parts[id.index()];
    for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
      if (part.faces[f].surface.axis.z() > 0.9) {
        const Faces faces = sequence::CollectMateFaces(part, {FaceId(f)}).with_neighbours;
        return std::binary_search(faces.begin(), faces.end(), flank);
      }
    }
    ADD_FAILURE() << "no top";
    return false;
  };
  EXPECT_TRUE(neighbours_of_top(0));
  EXPECT_TRUE(neighbours_of_top(3e-6));
  EXPECT_FALSE(neighbours_of_top(50e-6));
}

TEST(CompileTest, PartsLieApartOnTheTableBelowTheProduct) {
  const Model& model = *testing::PegInBlockModel();
  ASSERT_EQ(model.bodies.size(), 2u);
  ASSERT_EQ(model.mates.size(), model.product->mates.size());
  std::vector<spatial::Box> boxes;
  for (const Body& body : model.bodies) {
    double lowest = 1;
    spatial::Box box;
    for (const Vec3& p_B : model.product->part_of(body.occurrence).mesh.vertices) {
      const Vec3 p_W = body.X_WB_start * p_B;
      box.Add(p_W);
      lowest = std::min(lowest, p_W.z());
    }
    // Bullet keeps its bodies a hair above or below what they lie on.
    EXPECT_NEAR(lowest, model.table_z, 0.5e-3);
    boxes.push_back(box);
    // Neither in the product nor where parts are carried around it.
    EXPECT_GT((box.centre() - model.centre_W).norm(), model.transfer_radius);
    EXPECT_FALSE(box.Overlaps(model.product->box_W));
  }
  EXPECT_FALSE(boxes[0].Overlaps(boxes[1]));
}

TEST(CompileTest, TheTableIsAsNearAsTheWaysOfThePartsAllow) {
  const auto height_below = [](const Model& model) {
    return (model.product->box_W.low.z() - model.table_z) / model.product->box_W.size().norm();
  };
  // The peg comes from above: nothing but the fixture is between product and table.
  EXPECT_LT(height_below(*testing::PegInBlockModel()), 0.5);
  for (const sequence::SequenceStep& step : testing::PegInBlockModel()->sequence.steps) {
    EXPECT_GT(step.extraction_W.z(), 0.99);
  }
}

TEST(CompileTest, MatesAreListedForBothOfTheirParts) {
  const Model& model = *testing::PegInBlockModel();
  ASSERT_GE(model.mates.size(), 2u);  // bore and floor
  EXPECT_EQ(model.mates_of[0], model.mates_of[1]);
  EXPECT_EQ(model.mates_of[0].size(), model.mates.size());
  for (const ModelMate& mate : model.mates) {
    const bool is_axis = model.product->mates[mate.id.index()].kind == product::MateKind::kAxisHole;
    EXPECT_EQ(mate.fit != nullptr, is_axis);
  }
}

TEST(CompileTest, EmptyProductIsAnError) {
  Diagnostics diagnostics;
  auto product = std::make_shared<Product>();
  product->source = "nothing.step";
  const auto model = Compile(product, testing::FastOptions(), &diagnostics);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kInvalid);
  EXPECT_EQ(model.error().where, "nothing.step");
}

TEST(CompileTest, ShapeThatCannotBeBuiltIsAnErrorThatNamesThePart) {
  Diagnostics diagnostics;
  Product product = testing::PegInBlock();
  product.source = "rig.step";
  product.parts[1].mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  const auto model =
      Compile(std::make_shared<Product>(product), testing::FastOptions(), &diagnostics);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kInvalid);
  EXPECT_EQ(model.error().where, "rig.step, part 'peg'");
}

TEST(CompileTest, PartWithoutAMassCanStillBeHeld) {
  Diagnostics diagnostics;
  Product product = testing::PegInBlock();
  product.parts[1].mass = {};
  const auto model =
      Compile(std::make_shared<Product>(product), testing::FastOptions(), &diagnostics);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  const dynamics::MassProperties& mass = (*model)->bodies[1].mass;
  EXPECT_GT(mass.mass, 0);
  EXPECT_GT(mass.I_BBcm_B.determinant(), 0);
  EXPECT_TRUE(product.parts[1].box_B.Contains(mass.p_BoBcm_B));
}

TEST(CompileTest, NumberOfThreadsDoesNotChangeTheModel) {
  Diagnostics diagnostics;
  CompileOptions options = testing::FastOptions();
  options.threads = 1;
  const auto one =
      *Compile(std::make_shared<Product>(testing::PegInBlock()), options, &diagnostics);
  const Model& two = *testing::PegInBlockModel();
  for (std::size_t i = 0; i < two.bodies.size(); ++i) {
    EXPECT_EQ(one->bodies[i].X_WB_start.p(), two.bodies[i].X_WB_start.p());
    EXPECT_EQ(one->bodies[i].X_WB_start.q().coeffs(), two.bodies[i].X_WB_start.q().coeffs());
    EXPECT_EQ(one->bodies[i].shape->point_count(), two.bodies[i].shape->point_count());
  }
}

TEST(ModelSequenceTest, AWayThatEndsBehindAPartFarAwayTakesNoMoreThanFiveThousandLooks) {
  Product product;
  product.name = "far";
  const auto block = testing::AddPart(&product, "block", contact::testing::Block({0.1, 0.1, 0.1}));
  testing::Place(&product, block, "here");
  testing::Place(&product, block, "there", spatial::Pose(Vec3(1e7, 0, 0)));
  testing::Complete(&product);
  const auto model = testing::CompileFast(std::move(product));
  contact::Scene scene;
  const sequence::SequenceInput input = MakeSequenceInput(*model, &scene);
  sequence::Extraction extraction(input, &model->sequence);
  EXPECT_GT(extraction.CalcWayLength({OccurrenceId(0)}, Vec3::UnitX()), 0.99e7);
  (void)extraction.TryRemoveAlong({OccurrenceId(0)}, Vec3::UnitX());
  EXPECT_GT(extraction.looks(), 100u);
  EXPECT_LE(extraction.looks(), 5001u);
}

}  // namespace
}  // namespace hvas::simulation
