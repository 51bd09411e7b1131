#include "mates/infer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/random.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::FitKind;
using product::Mate;
using product::MateKind;
using product::Part;
using product::Product;
using spatial::Pose;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;
using testing::CountMates;

Pose X_WM(const Product& product, const product::Connector& connector) {
  return product.occurrences[connector.occurrence.index()].X_WB * connector.X_BM;
}

/** Both connectors of every mate stand at one point, axes alike and normals opposed. */
void ExpectConnectorsCoincide(const Product& product) {
  for (const Mate& mate : product.mates) {
    const Pose X_WA = X_WM(product, mate.a);
    const Pose X_WB = X_WM(product, mate.b);
    EXPECT_LT((X_WA.p() - X_WB.p()).norm(), 1e-14);
    const double cosine = X_WA.R().col(2).dot(X_WB.R().col(2));
    EXPECT_NEAR(cosine, mate.kind == MateKind::kAxisHole ? 1.0 : -1.0, 1e-14);
  }
}

/** A plate 100 x 60 x 10 mm, top at z = 0, with a hole of 10 mm through its middle. */
Part* AddPlate(Product* product) {
  Part* plate = AddPart(product, "plate");
  AddCylinder(plate, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -10e-3, 0);
  AddRectangle(plate, Vec3::Zero(), Vec3::UnitZ(), 50e-3, 30e-3);
  AddRectangle(plate, Vec3(0, 0, -10e-3), -Vec3::UnitZ(), 50e-3, 30e-3);
  return plate;
}

/** A pin of the given radius, 30 mm long, with a flat collar 8 mm above its lower end. */
Part* AddPin(Product* product, double radius, const std::string& name = "pin") {
  Part* pin = AddPart(product, name);
  AddCylinder(pin, FeatureKind::kShaft, Vec3(0, 0, 40e-3), -Vec3::UnitZ(), radius, 32e-3, 40e-3);
  AddCylinder(pin, FeatureKind::kShaft, Vec3(0, 0, 8e-3), Vec3::UnitZ(), 3 * radius, 0, 22e-3);
  AddRectangle(pin, Vec3(0, 0, 8e-3), -Vec3::UnitZ(), 8e-3, 8e-3);
  return pin;
}

TEST(Infer, FindsAxisHoleAndFaceFaceOfAPinWithCollarInAnyFrame) {
  Random random(11);
  for (int draw = 0; draw < 50; ++draw) {
    const Pose X_WA(
        Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal()).normalized(),
        Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)));
    Product product;
    AddPlate(&product);
    AddPin(&product, 4.995e-3);
    AddOccurrence(&product, product::PartId(0), X_WA);
    AddOccurrence(&product, product::PartId(1), X_WA * Pose(Vec3(0, 0, -8e-3)));
    Diagnostics diagnostics;
    Infer(&product, &diagnostics);
    ASSERT_EQ(product.mates.size(), 2U);
    const Mate& axis = product.mates[0];
    EXPECT_EQ(axis.kind, MateKind::kAxisHole);
    EXPECT_EQ(axis.a.occurrence.index(), 0U);
    EXPECT_EQ(axis.b.occurrence.index(), 1U);
    EXPECT_NEAR(axis.overlap, 8e-3, 1e-12);
    // Engaged from z = -8 mm to 0, so the origin is at -4 mm.
    EXPECT_NEAR(axis.hole_low, -6e-3, 1e-12);
    EXPECT_NEAR(axis.hole_high, 4e-3, 1e-12);
    EXPECT_NEAR(axis.shaft_low, -4e-3, 1e-12);
    EXPECT_NEAR(axis.shaft_high, 4e-3, 1e-12);
    EXPECT_LT((X_WM(product, axis.a).p() - X_WA * Vec3(0, 0, -4e-3)).norm(), 1e-12);
    ASSERT_TRUE(axis.fit.has_value());
    EXPECT_EQ(axis.fit->kind, FitKind::kClearance);
    EXPECT_EQ(axis.fit->code, "H7/g6");
    const Mate& face = product.mates[1];
    EXPECT_EQ(face.kind, MateKind::kFaceFace);
    EXPECT_NEAR(face.overlap, 256e-6, 1e-12);
    EXPECT_LT((X_WM(product, face.a).p() - X_WA.p()).norm(), 1e-12);
    EXPECT_FALSE(face.fit.has_value());
    ExpectConnectorsCoincide(product);
    EXPECT_EQ(CountLinkedParts(product), 2);
    EXPECT_TRUE(diagnostics.items().empty());
  }
}

TEST(Infer, DrawnPlayStillGivesConnectorsThatCoincideInTheDrawnPose) {
  Product product;
  AddPlate(&product);
  AddPin(&product, 4.9e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  // 15 um beside the axis, tilted by 0.02 deg and 4 um above the face.
  AddOccurrence(&product, product::PartId(1),
                Pose(spatial::RotationFromVector(Vec3(3.5e-4, 0, 0)), Vec3(15e-6, 0, -7.996e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 1);
  EXPECT_EQ(CountMates(product, MateKind::kFaceFace), 1);
  ExpectConnectorsCoincide(product);
}

struct Misfit {
  const char* what;
  Pose X_WB;
  double radius;
};

class InferRejects : public ::testing::TestWithParam<Misfit> {};

TEST_P(InferRejects, NoMate) {
  Product product;
  AddPlate(&product);
  AddPin(&product, GetParam().radius);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), GetParam().X_WB);
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_TRUE(product.mates.empty()) << GetParam().what;
  EXPECT_EQ(diagnostics.Count(Severity::kWarning), 2);  // Both are without a mate.
  EXPECT_EQ(CountLinkedParts(product), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Limits, InferRejects,
    ::testing::Values(
        Misfit{"beside the axis", Pose(Vec3(25e-6, 0, -7.9e-3)), 5e-3},
        Misfit{"tilted", Pose(spatial::RotationFromVector(Vec3(2.2e-3, 0, 0)), Vec3(0, 0, -7.9e-3)),
               5e-3},
        Misfit{"too thin", Pose(Vec3(0, 0, -7.9e-3)), 3.4e-3},
        Misfit{"not engaged, gap of 20 um to the face", Pose(Vec3(0, 0, 20e-6)), 5e-3},
        Misfit{"far away", Pose(Vec3(0.5, 0, 0)), 5e-3}));

TEST(Infer, FilletsAndSlotEndsAreNoHoles) {
  Product product;
  Part* slot = AddPart(&product, "slot");
  AddCylinder(slot, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -10e-3, 0,
              std::numbers::pi);
  AddPin(&product, 5e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, -8e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_TRUE(product.mates.empty());
}

TEST(Infer, OneMateForAPairAndAxisOnTheTightestLongEngagement) {
  Product product;
  Part* housing = AddPart(&product, "housing");
  AddCylinder(housing, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 3e-3, -20e-3, -4e-3);
  AddCylinder(housing, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -4e-3, 0);
  Part* stepped = AddPart(&product, "stepped shaft");
  AddCylinder(stepped, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 2.9e-3, -18e-3, -4e-3);
  AddCylinder(stepped, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -4e-3, 10e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_DOUBLE_EQ(product.mates[0].hole_radius, 3e-3);  // 14 mm long; the exact one is 4 mm.
  EXPECT_NEAR(product.mates[0].overlap, 14e-3, 1e-15);
}

TEST(Infer, ABushingBetweenShaftAndHousingLeavesTwoMates) {
  Product product;
  Part* housing = AddPart(&product, "housing");
  AddCylinder(housing, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 10e-3, 0, 40e-3);
  Part* bushing = AddPart(&product, "bushing");
  AddCylinder(bushing, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 10e-3, 0, 20e-3);
  AddCylinder(bushing, FeatureKind::kHole, Vec3::Zero(), -Vec3::UnitZ(), 8e-3, -20e-3, 0);
  Part* shaft = AddPart(&product, "shaft");
  AddCylinder(shaft, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 8e-3, -10e-3, 50e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, 5e-3)));
  AddOccurrence(&product, product::PartId(2), Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 2U);
  EXPECT_EQ(product.mates[0].b.occurrence.index(), 1U);
  EXPECT_EQ(product.mates[1].a.occurrence.index(), 1U);
  // Without the bushing the shaft has nothing nearer than the housing: the ratio lets it pair.
  product.occurrences.erase(product.occurrences.begin() + 1);
  product.occurrences[1].id = product::OccurrenceId(1);
  product.subassemblies[0].occurrences.pop_back();
  Infer(&product, &diagnostics);
  EXPECT_EQ(product.mates.size(), 1U);
}

TEST(Infer, AWidePassageAroundAGuidedShaftIsNoMate) {
  Product product;
  Part* bearing = AddPart(&product, "bearing");
  AddCylinder(bearing, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 10e-3, 0, 20e-3);
  Part* cover = AddPart(&product, "cover");
  AddCylinder(cover, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 11e-3, 20e-3, 26e-3);
  Part* shaft = AddPart(&product, "shaft");
  AddCylinder(shaft, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 10e-3, -10e-3, 50e-3);
  for (std::size_t i = 0; i < 3; ++i) {
    AddOccurrence(&product, product::PartId(i), Pose());
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_EQ(product.mates[0].a.occurrence.index(), 0U);
}

TEST(Infer, CoplanarFacesOfAPairMakeOneMate) {
  Product product;
  Part* rail = AddPart(&product, "rail");
  for (int i = 0; i < 4; ++i) {
    AddRectangle(rail, Vec3(i * 20e-3, 0, 0), Vec3::UnitZ(), 5e-3, 5e-3);
  }
  Part* cover = AddPart(&product, "cover");
  AddRectangle(cover, Vec3(30e-3, 0, 0), -Vec3::UnitZ(), 60e-3, 4e-3);
  AddOccurrence(&product, product::PartId(0), Pose());
  AddOccurrence(&product, product::PartId(1), Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(product.mates.size(), 1U);
  EXPECT_NEAR(product.mates[0].overlap, 4 * 10e-3 * 8e-3, 1e-12);
  EXPECT_LT((X_WM(product, product.mates[0].a).p() - Vec3(30e-3, 0, 0)).norm(), 1e-12);
}

TEST(Infer, SameGeometryAThousandTimesLargerOrSmallerHasTheSameMates) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    Product product;
    Part* plate = AddPart(&product, "plate");
    AddCylinder(plate, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), scale * 5e-3,
                scale * -10e-3, 0);
    AddRectangle(plate, Vec3::Zero(), Vec3::UnitZ(), scale * 50e-3, scale * 30e-3);
    Part* pin = AddPart(&product, "pin");
    AddCylinder(pin, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), scale * 4.99e-3,
                scale * -8e-3, 0);
    AddRectangle(pin, Vec3::Zero(), -Vec3::UnitZ(), scale * 8e-3, scale * 8e-3);
    AddOccurrence(&product, product::PartId(0), Pose());
    AddOccurrence(&product, product::PartId(1), Pose());
    Diagnostics diagnostics;
    Infer(&product, &diagnostics);
    EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 1) << scale;
    EXPECT_EQ(CountMates(product, MateKind::kFaceFace), 1) << scale;
  }
}

TEST(Infer, BoltThroughAPlateIntoItsNutIsAThreadOnlyInTheNut) {
  Product product;
  AddPlate(&product);
  AddPin(&product, 5e-3, "Hex bolt M10");
  Part* nut = AddPart(&product, "NUT M10");
  AddCylinder(nut, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 5e-3, -5e-3, 0);
  AddOccurrence(&product, product::PartId(0), Pose());
  // Through the plate from above; the shank reaches 20 mm down and the nut sits below the plate.
  product.parts[1].features[0].span_high = 52e-3;
  product.parts[1].box_B.Add(Vec3(0, 0, -12e-3));
  AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, -8e-3)));
  AddOccurrence(&product, product::PartId(2), Pose(Vec3(0, 0, -10e-3)));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  ASSERT_EQ(CountMates(product, MateKind::kAxisHole), 2);
  for (const Mate& mate : product.mates) {
    if (mate.kind == MateKind::kAxisHole) {
      const bool in_nut = mate.a.occurrence.index() == 2;
      EXPECT_EQ(mate.fit->kind, in_nut ? FitKind::kThread : FitKind::kPassage);
    }
  }
}

TEST(Infer, GridOfAThousandPlatesAndPinsIsCompleteAndFast) {
  Product product;
  AddPlate(&product);
  AddPin(&product, 5e-3);
  constexpr int kSide = 22;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec3 p_W(0.1 * i, 0.06 * j, 0);  // The boxes of neighbours touch.
      AddOccurrence(&product, product::PartId(0), Pose(p_W));
      AddOccurrence(&product, product::PartId(1), Pose(Vec3(p_W + Vec3(0, 0, -8e-3))));
    }
  }
  Diagnostics diagnostics;
  const auto start = std::chrono::steady_clock::now();
  Infer(&product, &diagnostics);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(CountMates(product, MateKind::kAxisHole), kSide * kSide);
  EXPECT_EQ(CountMates(product, MateKind::kFaceFace), kSide * kSide);
  const Linkage linkage = CalcLinkage(product);
  EXPECT_EQ(linkage.linked_parts, 2 * kSide * kSide);
  EXPECT_EQ(linkage.components, kSide * kSide);
  EXPECT_EQ(linkage.largest_component, 2);
  EXPECT_LT(seconds, 5.0);  // 0.02 s optimised; wide for sanitizers.
}

std::vector<std::string> KeysOf(const Product& product) {
  std::vector<std::string> keys;
  for (const Mate& mate : product.mates) {
    keys.push_back(mate.key);
  }
  return keys;
}

TEST(Infer, CopiesAtOnePlaceAreToldOnceAndCostNoPairs) {
  const auto build = [](int copies, bool are_parts) {
    Product product;
    AddPlate(&product);
    AddPin(&product, 4.995e-3)->shape_hash = "pin";
    AddOccurrence(&product, product::PartId(0), Pose());
    const Pose X_WB(Vec3(0, 0, -8e-3));
    AddOccurrence(&product, product::PartId(1), X_WB);
    for (int i = 0; i < copies; ++i) {
      if (are_parts) {
        AddPin(&product, 4.995e-3)->shape_hash = "pin";
      }
      AddOccurrence(&product, product::PartId(product.parts.size() - 1), X_WB);
    }
    return product;
  };
  Product alone = build(0, false);
  Diagnostics diagnostics;
  Infer(&alone, &diagnostics);
  // So many pairs take gigabytes.
  for (const auto& [copies, are_parts] : {std::pair(20000, false), std::pair(300, true)}) {
    Product product = build(copies, are_parts);
    Diagnostics told;
    Infer(&product, &told);
    EXPECT_EQ(KeysOf(product), KeysOf(alone));
    ASSERT_EQ(told.items().size(), diagnostics.items().size() + 1);
    const auto item = std::find_if(told.items().begin(), told.items().end(),
                                   [](const auto& d) { return d.code == "duplicate-part"; });
    ASSERT_NE(item, told.items().end());
    EXPECT_EQ(item->entity, "pin#2");
    EXPECT_NE(item->message.find(std::to_string(copies) + " copies"), std::string::npos);
    EXPECT_EQ(item->severity, Severity::kWarning);
  }
}

TEST(Infer, CopiesThatDifferInPlaceTurnOrShapeAreNone) {
  const Quat turned = spatial::RotationFromVector(Vec3(0, 0, 1e-6));
  for (int k = 0; k < 3; ++k) {
    Product product;
    AddPlate(&product);
    AddPin(&product, 4.995e-3);
    AddPin(&product, 4.994e-3);
    AddOccurrence(&product, product::PartId(0), Pose());
    AddOccurrence(&product, product::PartId(1), Pose(Vec3(0, 0, -8e-3)));
    AddOccurrence(&product, product::PartId(k == 2 ? 2 : 1),
                  Pose(k == 1 ? turned : Quat::Identity(), Vec3(k == 0 ? 1e-7 : 0, 0, -8e-3)));
    Diagnostics diagnostics;
    Infer(&product, &diagnostics);
    EXPECT_EQ(CountMates(product, MateKind::kAxisHole), 2) << k;
    for (const Diagnostic& item : diagnostics.items()) {
      EXPECT_NE(item.code, "duplicate-part") << k;
    }
  }
}

TEST(Infer, WatchThatEndsItNamesTheFileTheWorkAndTheOption) {
  // Each pair of these lies otherwise, so that nothing is known from another pair.
  Product product;
  product.source = "many.gltf";
  AddPlate(&product);
  Random random(5);
  for (int i = 0; i < 3000; ++i) {
    AddOccurrence(&product, product::PartId(0),
                  Pose(Vec3(1e-3 * random.Uniform(-1, 1), 1e-3 * random.Uniform(-1, 1), 0)));
  }
  for (const WorkLimits& limits : {WorkLimits{0.05, 0}, WorkLimits{1e6, 50'000'000}}) {
    WorkWatch watch(limits);
    Diagnostics diagnostics;
    const auto inferred = Infer(&product, &diagnostics, &watch);
    ASSERT_FALSE(inferred.has_value());
    EXPECT_EQ(inferred.error().code, ErrorCode::kOutOfResource);
    EXPECT_EQ(inferred.error().where, "many.gltf");
    EXPECT_NE(inferred.error().message.find("finding the mates"), std::string::npos);
    EXPECT_NE(inferred.error().remedy.find(limits.memory == 0 ? "--time-limit" : "--memory-limit"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace hvas::mates
