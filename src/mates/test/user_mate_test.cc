#include "mates/user_mate.h"

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/resolve.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FaceId;
using product::FeatureId;
using product::FeatureKind;
using product::Mate;
using product::MateKind;
using product::MateOrigin;
using product::OccurrenceId;
using product::Part;
using product::Product;
using spatial::Pose;
using testing::AddCone;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;

/** Features: 0 hole of 10 mm, 1 top, 2 countersink beside it. */
void AddPlate(Product* product) {
  Part* plate = AddPart(product, "plate");
  AddCylinder(plate, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -10e-3, 0);
  AddRectangle(plate, Vec3::Zero(), Vec3::UnitZ(), 50e-3, 30e-3);
  AddCone(plate, FeatureKind::kConeSeat, Vec3(30e-3, 0, -3e-3), Vec3::UnitZ(), 0.7, 1e-3, 3e-3);
}

/** Features: 0 shaft, 1 shoulder, 2 hole in its end, 3 tip. */
void AddPin(Product* product) {
  Part* pin = AddPart(product, "pin");
  AddCylinder(pin, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 4.99e-3, 0, 30e-3);
  AddRectangle(pin, Vec3(0, 0, 8e-3), -Vec3::UnitZ(), 8e-3, 8e-3);
  AddCylinder(pin, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 2e-3, 20e-3, 30e-3);
  AddCone(pin, FeatureKind::kTaper, Vec3(0, 0, -3e-3), Vec3::UnitZ(), 0.7, 1e-3, 3e-3);
}

Product MakeApart(const Pose& X_WB) {
  Product product;
  AddPlate(&product);
  AddPin(&product);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), X_WB);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

Pick PickFeature(std::size_t occurrence, std::size_t feature) {
  return {OccurrenceId(occurrence), FaceId(), FeatureId(feature)};
}

Pick PickFace(std::size_t occurrence, std::size_t face) {
  return {OccurrenceId(occurrence), FaceId(face), FeatureId()};
}

// X12. What the user picks where the parts are drawn mated is what inference finds there.
TEST(MakeMate, IsTheInferredOneWhereThePartsAreDrawnMated) {
  Product product = MakeApart(Pose(Vec3(0, 0, -8e-3)));
  ASSERT_EQ(product.mates.size(), 2U);
  const std::vector<Mate> inferred = product.mates;
  for (const Mate& expected : inferred) {
    const Product bare = [&] {
      Product copy = product;
      copy.mates.clear();
      return copy;
    }();
    const auto mate = MakeMate(bare, PickFeature(1, expected.b.feature.index()),
                               PickFeature(0, expected.a.feature.index()));
    ASSERT_TRUE(mate.has_value()) << mate.error().ToString();
    EXPECT_EQ(mate->key, expected.key);
    EXPECT_EQ(mate->kind, expected.kind);
    EXPECT_EQ(mate->a.occurrence, expected.a.occurrence);
    EXPECT_LT((mate->a.X_BM.p() - expected.a.X_BM.p()).norm(), 1e-12);
    EXPECT_LT((mate->b.X_BM.p() - expected.b.X_BM.p()).norm(), 1e-12);
    EXPECT_NEAR(mate->overlap, expected.overlap, 1e-12);
    EXPECT_EQ(mate->surfaces.size(), expected.surfaces.size());
    EXPECT_EQ(mate->fit.has_value(), expected.fit.has_value());
    EXPECT_EQ(mate->origin, MateOrigin::kUser);
    EXPECT_DOUBLE_EQ(mate->confidence, 1);
  }
  // With the inferred mates there, picking the same is no new mate.
  const auto again = MakeMate(product, PickFace(0, 0), PickFace(1, 0));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->id.index(), 0U);
  EXPECT_EQ(again->origin, MateOrigin::kInferred);
}

TEST(MakeMate, PartsDrawnApartAreMatedByTheShortestWay) {
  Product product =
      MakeApart(Pose(spatial::RotationFromVector(Vec3(0.3, 0.2, 0.1)), Vec3(0.2, 0.1, 0.4)));
  ASSERT_TRUE(product.mates.empty());
  for (const auto& [a, b, kind] :
       {std::tuple(0, 0, MateKind::kAxisHole), std::tuple(1, 1, MateKind::kFaceFace),
        std::tuple(2, 3, MateKind::kConeSeat)}) {
    const auto mate = MakeMate(product, PickFeature(0, static_cast<std::size_t>(a)),
                               PickFeature(1, static_cast<std::size_t>(b)));
    ASSERT_TRUE(mate.has_value()) << mate.error().ToString();
    EXPECT_EQ(mate->kind, kind);
    EXPECT_FALSE(mate->surfaces.empty());
    // Resolving it fulfils it, and then axes and faces lie on each other.
    const std::vector<MateConstraint> constraints{
        MakeConstraint(*mate, OccurrenceId(1), product.occurrences[0].X_WB)};
    const Resolution resolution = Resolve(constraints, product.occurrences[1].X_WB);
    EXPECT_TRUE(resolution.is_converged);
    const Vec3 axis_W = resolution.X_WB.R().col(2);
    EXPECT_NEAR(std::abs(axis_W.z()), 1.0, 1e-9);
    if (kind == MateKind::kConeSeat) {
      EXPECT_LT((resolution.X_WB.p() - Vec3(30e-3, 0, 0)).norm(), 1e-9);
    } else if (kind == MateKind::kAxisHole) {
      EXPECT_LT(resolution.X_WB.p().head<2>().norm(), 1e-9);
    } else {
      EXPECT_NEAR(resolution.X_WB.p().z(), -8e-3, 1e-9);
    }
  }
}

struct Refused {
  const char* what;
  Pick a, b;
  const char* says;
};

class MakeMateRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(MakeMateRefuses, SayingWhyAndWhatToDo) {
  const Product product = MakeApart(Pose(Vec3(0, 0, -8e-3)));
  const auto mate = MakeMate(product, GetParam().a, GetParam().b);
  ASSERT_FALSE(mate.has_value()) << GetParam().what;
  EXPECT_NE(mate.error().message.find(GetParam().says), std::string::npos)
      << mate.error().ToString();
  EXPECT_FALSE(mate.error().remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, MakeMateRefuses,
    ::testing::Values(
        Refused{"two holes", PickFeature(0, 0), PickFeature(1, 2), "a hole and a hole"},
        Refused{"a plane and a shaft", PickFeature(0, 1), PickFeature(1, 0), "a plane and a shaft"},
        Refused{"a part with itself", PickFeature(1, 0), PickFeature(1, 2), "itself"},
        Refused{"no such occurrence", PickFeature(7, 0), PickFeature(1, 2), "no such occurrence"},
        Refused{"no such face", PickFace(0, 99), PickFeature(1, 2), "no face 99"},
        Refused{"no such feature", PickFeature(0, 99), PickFeature(1, 2), "no such feature"},
        Refused{"neither face nor feature", Pick{OccurrenceId(0), {}, {}}, PickFeature(1, 0),
                "no such feature"},
        Refused{"against the mates that are there", PickFeature(0, 2), PickFeature(1, 3),
                "contradicts m0, m1"}));

TEST(MakeMate, RefusesAShaftFarTooThickAndAFaceOfNoFeature) {
  Product product = MakeApart(Pose(Vec3(0.5, 0, 0)));
  product.parts[1].features[0].radius = 7e-3;
  const auto thick = MakeMate(product, PickFeature(0, 0), PickFeature(1, 0));
  ASSERT_FALSE(thick.has_value());
  EXPECT_NE(thick.error().message.find("5.000 and 7.000 mm"), std::string::npos);
  product.parts[1].features[0].faces.clear();
  EXPECT_EQ(MakeMate(product, PickFeature(0, 0), PickFace(1, 0)).error().code,
            ErrorCode::kUnsupported);
}

TEST(FindMate, ByIdKeyOrBeginningOfAKey) {
  Product product = MakeApart(Pose(Vec3(0, 0, -8e-3)));
  product.mates[0].key = "0123456789";
  product.mates[1].key = "0129876543";
  EXPECT_EQ(FindMate(product, "m1")->index(), 1U);
  EXPECT_EQ(FindMate(product, "0129876543")->index(), 1U);
  EXPECT_EQ(FindMate(product, "0123")->index(), 0U);
  for (const char* text : {"012", "m2", "m", "", "f", "m1x", "01234567890"}) {
    EXPECT_FALSE(FindMate(product, text).has_value()) << text;
  }
}

TEST(AddMate, AndRemoveMateKeepIdsKeysAndJointsTrue) {
  Product product = MakeApart(Pose(Vec3(0, 0, -8e-3)));
  const std::string face_key = product.mates[1].key;
  ASSERT_EQ(product.joints[0].free_rotations + product.joints[0].free_translations, 1);
  const auto removed = RemoveMate(&product, "m0");
  ASSERT_TRUE(removed.has_value());
  EXPECT_EQ(removed->kind, MateKind::kAxisHole);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(product.mates[0].id.index(), 0U);
  EXPECT_EQ(product.mates[0].key, face_key);
  EXPECT_EQ(product.joints[0].free_translations, 2);
  const auto made = MakeMate(product, PickFeature(0, 0), PickFeature(1, 0));
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(made->key, removed->key);
  EXPECT_EQ(AddMate(&product, *made).index(), 1U);
  EXPECT_EQ(product.joints[0].mates.size(), 2U);
  EXPECT_EQ(product.joints[0].free_translations, 0);
  EXPECT_FALSE(RemoveMate(&product, "m9").has_value());
}

}  // namespace
}  // namespace hvas::mates
