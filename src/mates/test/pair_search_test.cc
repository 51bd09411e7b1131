#include "mates/pair_search.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "base/random.h"
#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using spatial::Pose;
using testing::AddCone;
using testing::AddCylinder;
using testing::AddOccurrence;
using testing::AddPart;
using testing::AddRectangle;
using testing::AddSubassembly;

/** A servo of five parts: body, lid, horn on its shaft, and two screws of one part. */
void AddServoParts(Product* product) {
  product->parts.reserve(8);
  Part* body = AddPart(product, "body");
  AddCylinder(body, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 3e-3, 0, 12e-3);
  AddRectangle(body, Vec3::Zero(), Vec3::UnitZ(), 12e-3, 12e-3);
  Part* lid = AddPart(product, "lid");
  AddRectangle(lid, Vec3::Zero(), -Vec3::UnitZ(), 12e-3, 12e-3);
  AddRectangle(lid, Vec3(0, 0, 4e-3), Vec3::UnitZ(), 12e-3, 12e-3);
  AddCylinder(lid, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 3.05e-3, 0, 4e-3);
  for (const double x : {-8e-3, 8e-3}) {
    AddCylinder(body, FeatureKind::kHole, Vec3(x, 0, 0), Vec3::UnitZ(), 1.25e-3, -10e-3, 0);
    AddCylinder(lid, FeatureKind::kHole, Vec3(x, 0, 0), Vec3::UnitZ(), 1.7e-3, 0, 2.5e-3);
    AddCone(lid, FeatureKind::kConeSeat, Vec3(x, 0, 0.8e-3), Vec3::UnitZ(), 0.785, 1.7e-3, 3.2e-3);
  }
  Part* horn = AddPart(product, "horn");
  AddCylinder(horn, FeatureKind::kHole, Vec3::Zero(), Vec3::UnitZ(), 2.99e-3, 4e-3, 10e-3);
  AddRectangle(horn, Vec3(0, 0, 4e-3), -Vec3::UnitZ(), 6e-3, 6e-3);
  Part* screw = AddPart(product, "M3x12");
  AddCylinder(screw, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), 1.5e-3, -8e-3, 2.3e-3);
  AddCone(screw, FeatureKind::kTaper, Vec3(0, 0, 0.8e-3), Vec3::UnitZ(), 0.785, 1.5e-3, 3.1e-3);
}

void AddServo(Product* product, const Pose& X_WS) {
  const product::SubassemblyId node = AddSubassembly(product, "servo");
  for (std::size_t part = 0; part < 4; ++part) {
    for (const double x : part == 3 ? std::vector<double>{-8e-3, 8e-3} : std::vector<double>{0}) {
      AddOccurrence(product, PartId(part), X_WS * Pose(Vec3(x, 0, 0)), node);
    }
  }
}

/** Servos at random poses apart from each other, so that only their own parts meet. */
Product MakeServos(int count) {
  Product product;
  AddServoParts(&product);
  AddSubassembly(&product, "robot");
  Random random(3);
  for (int i = 0; i < count; ++i) {
    const Quat q(random.Normal(), random.Normal(), random.Normal(), random.Normal());
    AddServo(&product, Pose(q.normalized(), Vec3(0.1 * i, random.Uniform(-1, 1), 0)));
  }
  return product;
}

// Pitfall n: what is found once for a subassembly holds for all of its instances, exactly as if
// each were looked at.
TEST(PitfallN, EqualSubassembliesAreSearchedOnceWithTheResultOfSearchingEach) {
  Product once = MakeServos(12);
  Product each = once;
  Diagnostics diagnostics_once;
  Diagnostics diagnostics_each;
  InferenceLimits brute_force;
  brute_force.reuse_equal_pairs = false;
  Infer(&once, &diagnostics_once);
  Infer(&each, &diagnostics_each, brute_force);
  // A servo: body-lid face and axis, body-horn axis, lid-horn face, two screws: body, lid, seat.
  ASSERT_EQ(once.mates.size(), 12U * 10U);
  ASSERT_EQ(each.mates.size(), once.mates.size());
  for (std::size_t i = 0; i < once.mates.size(); ++i) {
    const product::Mate& a = once.mates[i];
    const product::Mate& b = each.mates[i];
    EXPECT_EQ(a.key, b.key);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.a.occurrence, b.a.occurrence);
    EXPECT_EQ(a.b.feature, b.b.feature);
    EXPECT_LT((a.a.X_BM.p() - b.a.X_BM.p()).norm(), 1e-12);
    EXPECT_LT((a.b.X_BM.p() - b.b.X_BM.p()).norm(), 1e-12);
    EXPECT_NEAR(a.overlap, b.overlap, 1e-12);
    EXPECT_EQ(a.surfaces.size(), b.surfaces.size());
    EXPECT_EQ(a.evidence, b.evidence);
    EXPECT_NEAR(a.confidence, b.confidence, 1e-9);
  }
  EXPECT_EQ(once.joints.size(), each.joints.size());
  EXPECT_EQ(diagnostics_once.items().size(), diagnostics_each.items().size());

  PairSearch search(once, {});
  for (std::size_t servo = 0; servo < 12; ++servo) {
    for (std::size_t i = 0; i < 5; ++i) {
      for (std::size_t j = i + 1; j < 5; ++j) {
        (void)search.Find(OccurrenceId(5 * servo + i), OccurrenceId(5 * servo + j));
      }
    }
  }
  EXPECT_EQ(search.searched(), 10U);  // The pairs of one servo.
}

TEST(PitfallN, AnInstanceWithOnePartMovedHasItsOwnMates) {
  Product product = MakeServos(3);
  product.occurrences[5].X_WB = product.occurrences[5].X_WB * Pose(Vec3(0, 0, 50e-3));
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  EXPECT_LT(product.mates.size(), 30U);
  EXPECT_EQ(std::count_if(product.mates.begin(), product.mates.end(),
                          [](const product::Mate& mate) {
                            return mate.a.occurrence.index() < 5 || mate.a.occurrence.index() >= 10;
                          }),
            20);
}

// Pitfall m.
TEST(PitfallM, FiveThousandPartsTakeAFractionOfASecond) {
  Product product = MakeServos(1000);
  ASSERT_EQ(product.occurrences.size(), 5000U);
  Diagnostics diagnostics;
  const auto start = std::chrono::steady_clock::now();
  Infer(&product, &diagnostics);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_EQ(product.mates.size(), 10000U);
  RecordProperty("milliseconds", static_cast<int>(1e3 * seconds));
  EXPECT_LT(seconds, 5.0);  // 0.2 s optimised; wide for sanitizers.
}

}  // namespace
}  // namespace hvas::mates
