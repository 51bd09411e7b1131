// The equations of relations beside mates, the motions that they leave, and their inference.
#include "mates/relations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "mates/assignments.h"
#include "mates/side_file.h"

namespace hvas::mates {
namespace {

using product::ElementKind;
using product::OccurrenceId;
using product::Relation;
using product::RelationKind;

struct RelationCase {
  std::string name;
  RelationKind kind;
  ElementKind a, b;
  double radius_a, radius_b;
  double magnitude;
  Pose X_WB;  // Fulfils the relation; a stands at the origin with its axis along z.
  int translations, rotations;
};

const double kTestAngle = 0.6;

std::vector<RelationCase> ListRelationCases() {
  const auto turned = [](const Vec3& axis, double angle, const Vec3& p) {
    return Pose(spatial::RotationFromVector(angle * axis), p);
  };
  const double right = std::numbers::pi / 2;
  constexpr auto kPlane = ElementKind::kPlane;
  constexpr auto kCylinder = ElementKind::kCylinder;
  constexpr auto kSphere = ElementKind::kSphere;
  constexpr auto kEdge = ElementKind::kEdge;
  return {
      {"parallel", RelationKind::kParallel, kPlane, kCylinder, 0, 0.01, 0,
       turned(Vec3::UnitZ(), 0.3, Vec3(0.1, 0.2, 0.3)), 3, 1},
      {"perpendicular", RelationKind::kPerpendicular, kPlane, kPlane, 0, 0, 0,
       turned(Vec3::UnitX(), right, Vec3(0.1, 0.2, 0.3)), 3, 2},
      {"angle", RelationKind::kAngle, kCylinder, kCylinder, 0.01, 0.01, kTestAngle,
       turned(Vec3::UnitX(), kTestAngle, Vec3(0.1, 0.2, 0.3)), 3, 2},
      {"flush", RelationKind::kFlush, kPlane, kPlane, 0, 0, 0,
       turned(Vec3::UnitZ(), 0.3, Vec3(0.1, 0.2, 0)), 2, 1},
      {"planes at a distance", RelationKind::kDistance, kPlane, kPlane, 0, 0, 0.05,
       turned(Vec3::UnitX(), 2 * right, Vec3(0.1, 0.2, 0.05)), 2, 1},
      {"axes at a distance", RelationKind::kDistance, kCylinder, kCylinder, 0.01, 0.01, 0.05,
       turned(Vec3::UnitZ(), 0.3, Vec3(0.03, 0.04, 0.2)), 2, 1},
      {"cylinder on plane", RelationKind::kTangent, kPlane, kCylinder, 0, 0.02, 0,
       turned(Vec3::UnitX(), right, Vec3(0.1, 0.2, 0.02)), 2, 2},
      {"plane on cylinder", RelationKind::kTangent, kCylinder, kPlane, 0.02, 0, 0,
       turned(Vec3::UnitX(), -right, Vec3(0.1, -0.02, 0.2)), 2, 2},
      {"sphere on plane", RelationKind::kTangent, kPlane, kSphere, 0, 0.02, 0,
       turned(Vec3::UnitX(), 0.7, Vec3(0.1, 0.2, 0.02)), 2, 3},
      {"sphere on cylinder", RelationKind::kTangent, kCylinder, kSphere, 0.03, 0.02, 0,
       turned(Vec3::UnitX(), 0.7, Vec3(0.03, 0.04, 0.5)), 2, 3},
      {"cylinder on sphere", RelationKind::kTangent, kSphere, kCylinder, 0.03, 0.02, 0,
       turned(Vec3::UnitZ(), 0.7, Vec3(0.03, 0.04, 0.5)), 2, 3},
      {"sphere on sphere", RelationKind::kTangent, kSphere, kSphere, 0.03, 0.02, 0,
       turned(Vec3::UnitX(), 0.7, Vec3(0.03, 0, 0.04)), 2, 3},
      {"cylinder on cylinder", RelationKind::kTangent, kCylinder, kCylinder, 0.03, 0.02, 0,
       turned(Vec3::UnitZ(), 0.7, Vec3(0.03, 0.04, 0.5)), 2, 1},
      {"edge on edge", RelationKind::kEdgeOnEdge, kEdge, kEdge, 0, 0, 0,
       turned(Vec3::UnitZ(), 0.7, Vec3(0, 0, 0.1)), 1, 1},
      {"hole to hole", RelationKind::kHoleToHole, kCylinder, kCylinder, 0.01, 0.01, 0,
       turned(Vec3::UnitX(), 2 * right, Vec3(0, 0, 0.1)), 1, 1},
  };
}

Relation RelationOf(const RelationCase& item) {
  Relation relation;
  relation.kind = item.kind;
  relation.a.occurrence = OccurrenceId(0);
  relation.b.occurrence = OccurrenceId(1);
  relation.a.element = item.a;
  relation.b.element = item.b;
  relation.a.radius = item.radius_a;
  relation.b.radius = item.radius_b;
  relation.magnitude = item.magnitude;
  return relation;
}

RelationConstraint ConstrainTo(const RelationCase& item) {
  return MakeConstraint(RelationOf(item), OccurrenceId(1), Pose());
}

Pose MoveBy(const Pose& X_WB, const Vec6& step, double length) {
  return {(spatial::RotationFromVector(Vec3(step.head<3>() / length)) * X_WB.q()).normalized(),
          Vec3(X_WB.p() + step.tail<3>())};
}

constexpr double kTestLength = 0.1;  // [m]

TEST(Relations, X2TheEquationsAreZeroWhereTheRelationHolds) {
  for (const RelationCase& item : ListRelationCases()) {
    SCOPED_TRACE(item.name);
    EXPECT_TRUE(CanTie(item.kind, item.a, item.b));
    EXPECT_LT(CalcResidual(ConstrainTo(item), item.X_WB, kTestLength), 1e-12);
  }
}

TEST(Relations, X2TheRankOfTheJacobianLeavesTheFreeMotionsOfEachKind) {
  for (const RelationCase& item : ListRelationCases()) {
    SCOPED_TRACE(item.name);
    const RelationConstraint constraint = ConstrainTo(item);
    const auto rows = CalcJacobian(constraint, item.X_WB, kTestLength);
    Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), 6);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      matrix.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
    }
    Eigen::FullPivLU<Eigen::MatrixXd> lu(matrix);
    lu.setThreshold(1e-9);
    EXPECT_EQ(lu.rank(), 6 - item.translations - item.rotations);
    EXPECT_EQ(lu.rank(), static_cast<Eigen::Index>(rows.size())) << "an equation says nothing new";
    const FreeCount free = CountFree({}, std::span(&constraint, 1), item.X_WB);
    EXPECT_EQ(free.translations, item.translations);
    EXPECT_EQ(free.rotations, item.rotations);
  }
}

TEST(Relations, TheJacobianIsTheDerivativeOfTheEquations) {
  constexpr double kStep = 1e-7;
  for (const RelationCase& item : ListRelationCases()) {
    SCOPED_TRACE(item.name);
    const RelationConstraint constraint = ConstrainTo(item);
    const auto rows = CalcJacobian(constraint, item.X_WB, kTestLength);
    for (Eigen::Index k = 0; k < 6; ++k) {
      // From a pose that fulfils it the residual grows as the norm of the Jacobian's column.
      const Vec6 step = kStep * Vec6::Unit(k);
      double expected = 0;
      for (const Vec6& row : rows) {
        expected += row[k] * row[k];
      }
      const double residual =
          CalcResidual(constraint, MoveBy(item.X_WB, step, kTestLength), kTestLength) / kStep;
      EXPECT_NEAR(residual, std::sqrt(expected), 1e-4);
    }
  }
}

TEST(Relations, ResidualIsTheMissedLength) {
  RelationCase item = ListRelationCases()[3];  // Flush.
  item.X_WB = Pose(item.X_WB.q(), Vec3(0.1, 0.2, 0.003));
  EXPECT_NEAR(CalcResidual(ConstrainTo(item), item.X_WB, kTestLength), 0.003, 1e-12);
}

TEST(Relations, HoldEitherSideWithTheSameResidual) {
  for (const RelationCase& item : ListRelationCases()) {
    SCOPED_TRACE(item.name);
    const Relation relation = RelationOf(item);
    // a held in place, b placed.
    const RelationConstraint other = MakeConstraint(relation, OccurrenceId(0), item.X_WB);
    EXPECT_LT(CalcResidual(other, Pose(), kTestLength), 1e-12);
  }
}

TEST(Relations, X3AreResolvedFromADisturbedPose) {
  Vec6 disturbance;
  disturbance << 0.02, -0.01, 0.015, 0.01, 0.005, -0.008;
  for (const RelationCase& item : ListRelationCases()) {
    SCOPED_TRACE(item.name);
    const RelationConstraint constraint = ConstrainTo(item);
    const Resolution resolved =
        ResolveAll({}, std::span(&constraint, 1), MoveBy(item.X_WB, disturbance, kTestLength));
    EXPECT_TRUE(resolved.is_converged) << resolved.residual;
  }
}

TEST(Relations, X3AreResolvedTogetherWithMates) {
  // A part on a plane (2 translations, 1 rotation), flush with a wall and a ball's radius from
  // another one: nothing stays free but what the relations leave.
  MateConstraint plane;
  plane.kind = product::MateKind::kFaceFace;
  plane.X_BN = Pose(spatial::RotationFromVector(std::numbers::pi * Vec3::UnitX()), Vec3::Zero());
  RelationConstraint wall;
  wall.kind = RelationKind::kFlush;
  wall.p_W = Vec3(0.2, 0, 0);
  wall.axis_W = Vec3::UnitX();
  wall.p_B = Vec3(0.05, 0, 0);
  wall.axis_B = Vec3::UnitX();
  RelationConstraint stop = wall;
  stop.kind = RelationKind::kDistance;
  stop.magnitude = 0.01;
  stop.p_W = Vec3(0, 0.1, 0);
  stop.axis_W = Vec3::UnitY();
  stop.p_B = Vec3(0, 0.03, 0);
  stop.axis_B = Vec3::UnitY();
  const std::vector<MateConstraint> mates{plane};
  const std::vector<RelationConstraint> relations{wall, stop};
  const Pose start(spatial::RotationFromVector(Vec3(0.1, -0.1, 0.3)), Vec3(0.1, 0.02, 0.05));
  const Resolution resolved = ResolveAll(mates, relations, start);
  ASSERT_TRUE(resolved.is_converged) << resolved.residual;
  EXPECT_LT((resolved.X_WB.p() - Vec3(0.15, 0.08, 0)).norm(), 1e-9);
  const FreeCount free = CountFree(mates, relations, resolved.X_WB);
  EXPECT_EQ(free.translations, 0);
  EXPECT_EQ(free.rotations, 0);
}

TEST(Relations, ContradictionIsNotConverged) {
  RelationConstraint low;
  low.kind = RelationKind::kDistance;
  low.p_W = low.p_B = Vec3::Zero();
  low.axis_W = low.axis_B = Vec3::UnitZ();
  low.magnitude = 0.01;
  RelationConstraint high = low;
  high.magnitude = 0.02;
  const std::vector<RelationConstraint> relations{low, high};
  EXPECT_FALSE(ResolveAll({}, relations, Pose()).is_converged);
}

/** A box of planes with a corner at the part's origin. */
product::Part MakePlaneBox(std::uint32_t id, const Vec3& size) {
  product::Part part;
  part.id = product::PartId(id);
  part.box_B.Add(Vec3::Zero());
  part.box_B.Add(size);
  for (Eigen::Index k = 0; k < 3; ++k) {
    for (const bool is_high : {false, true}) {
      product::Face face;
      face.surface.kind = spatial::SurfaceKind::kPlane;
      Vec3 low = Vec3::Zero();
      Vec3 high = size;
      (is_high ? low : high)[k] = is_high ? size[k] : 0;
      face.box_B.Add(low);
      face.box_B.Add(high);
      product::Feature feature;
      feature.faces = {product::FaceId(part.faces.size())};
      feature.origin_B = 0.5 * (low + high);
      feature.axis_B = (is_high ? 1 : -1) * Vec3(Vec3::Unit(k));
      feature.area = size.prod() / size[k];
      face.area = feature.area;
      part.faces.push_back(face);
      part.features.push_back(feature);
    }
  }
  return part;
}

/** Two boxes beside each other on one floor, 0.5 mm apart. */
product::Product MakeTwoBoxes() {
  product::Product product;
  product.source = "boxes";
  product.parts = {MakePlaneBox(0, Vec3(0.04, 0.03, 0.02)),
                   MakePlaneBox(1, Vec3(0.05, 0.03, 0.01))};
  product.subassemblies.resize(1);
  for (std::uint32_t i = 0; i < 2; ++i) {
    product::Occurrence occurrence;
    occurrence.id = OccurrenceId(i);
    occurrence.part = product::PartId(i);
    occurrence.X_WB = Pose(Quat::Identity(), Vec3(i * 0.0405, 0, 0));
    product.occurrences.push_back(occurrence);
  }
  return product;
}

int CountRelations(const std::vector<Relation>& relations, RelationKind kind) {
  return static_cast<int>(
      std::count_if(relations.begin(), relations.end(),
                    [kind](const Relation& relation) { return relation.kind == kind; }));
}

TEST(ListRelations, X2FindsFlushParallelAndDistantPlanesOfNeighbours) {
  const product::Product product = MakeTwoBoxes();
  Diagnostics diagnostics;
  const auto relations = ListRelations(product, &diagnostics);
  EXPECT_EQ(CountRelations(relations, RelationKind::kParallel), 1);
  EXPECT_EQ(CountRelations(relations, RelationKind::kFlush), 3) << "floor and both sides";
  ASSERT_EQ(CountRelations(relations, RelationKind::kDistance), 1);
  for (const Relation& relation : relations) {
    EXPECT_LT(relation.residual, 1e-9);
    EXPECT_FALSE(relation.is_stated);
    if (relation.kind == RelationKind::kDistance) {
      EXPECT_NEAR(relation.magnitude, 0.5e-3, 1e-12);
      EXPECT_EQ(relation.free_translations, 2);
      EXPECT_EQ(relation.free_rotations, 1);
    }
  }
  EXPECT_TRUE(diagnostics.items().empty());
}

TEST(ListRelations, LooksOnlyAtPartsThatAreNear) {
  product::Product product = MakeTwoBoxes();
  product.occurrences[1].X_WB = Pose(Quat::Identity(), Vec3(0.2, 0, 0));
  Diagnostics diagnostics;
  EXPECT_TRUE(ListRelations(product, &diagnostics).empty());
}

TEST(ListRelations, ReportsWhatALimitLeavesOut) {
  RelationLimits limits;
  limits.per_pair = 2;
  Diagnostics diagnostics;
  EXPECT_EQ(ListRelations(MakeTwoBoxes(), &diagnostics, nullptr, limits).size(), 2u);
  ASSERT_EQ(diagnostics.items().size(), 1u);
  EXPECT_EQ(diagnostics.items()[0].code, "limit-relations");
}

Result<void> ApplyEntries(const std::string& entries, product::Product* product) {
  const auto file =
      ParseSideFile(R"({"format": "hvas-assignments-2", )" + entries + "}", "boxes.hvas.json");
  if (!file) {
    return Unexpected(file.error());
  }
  return ApplyRelations(*file, product);
}

product::Product MakeNamedBoxes() {
  product::Product product = MakeTwoBoxes();
  product.occurrences[0].name = product.occurrences[0].path = "left";
  product.occurrences[1].name = product.occurrences[1].path = "right";
  return product;
}

TEST(StatedRelations, X2ComeFromTheSideFileBeforeTheInferredOnes) {
  product::Product product = MakeNamedBoxes();
  // Feature 5 is the top of each box: 20 mm and 10 mm high.
  const auto applied = ApplyEntries(
      R"("relations": [{"kind": "distance", "distance_mm": -9,
          "a": {"occurrence": "left", "feature": 5}, "b": {"occurrence": "right", "face": 5}}])",
      &product);
  ASSERT_TRUE(applied.has_value()) << applied.error().ToString();
  Diagnostics diagnostics;
  const auto relations = ListRelations(product, &diagnostics);
  ASSERT_GT(relations.size(), 1u);
  EXPECT_TRUE(relations[0].is_stated);
  EXPECT_EQ(relations[0].kind, RelationKind::kDistance);
  EXPECT_NEAR(relations[0].residual, 1e-3, 1e-9) << "drawn 10 mm below";
  const RelationConstraint constraint =
      MakeConstraint(relations[0], OccurrenceId(1), product.occurrences[0].X_WB);
  const Resolution resolved =
      ResolveAll({}, std::span(&constraint, 1), product.occurrences[1].X_WB);
  ASSERT_TRUE(resolved.is_converged);
  EXPECT_NEAR(resolved.X_WB.p().z(), 1e-3, 1e-9);
}

TEST(StatedRelations, ErrorsNameTheLineTheEntryAndARemedy) {
  const auto refuse = [](const std::string& entries) {
    product::Product product = MakeNamedBoxes();
    const auto applied = ApplyEntries(entries, &product);
    EXPECT_FALSE(applied.has_value()) << entries;
    if (applied) {
      return std::string();
    }
    EXPECT_NE(applied.error().where.find("boxes.hvas.json:1"), std::string::npos);
    EXPECT_FALSE(applied.error().remedy.empty());
    EXPECT_TRUE(product.relations.empty());
    return applied.error().message;
  };
  const std::string sides =
      R"("a": {"occurrence": "left", "feature": 5}, "b": {"occurrence": "right", "feature": 5}})";
  EXPECT_NE(refuse(R"("relations": [{"kind": "distance", )" + sides + "]").find("distance_mm"),
            std::string::npos);
  EXPECT_NE(
      refuse(R"("relations": [{"kind": "flush", "angle_deg": 3, )" + sides + "]").find("neither"),
      std::string::npos);
  EXPECT_NE(refuse(R"("relations": [{"kind": "tangent", )" + sides + "]").find("tangent"),
            std::string::npos);
  EXPECT_NE(refuse(R"("relations": [{"kind": "flush", "a": {"occurrence": "left", "feature": 9},
                      "b": {"occurrence": "right", "feature": 5}}])")
                .find("left"),
            std::string::npos);
  refuse(R"("contacts": [{"a": "left", "b": "right"}])");
  refuse(R"("contacts": [{"a": "left", "b": "left", "friction": 0.2}])");
}

TEST(StatedContacts, X11ComplianceFollowsFromTheModuliOfThePair) {
  product::Product product = MakeNamedBoxes();
  product.parts[1].material.youngs_modulus = 70e9;
  product.parts[1].material.poisson_ratio = 0.33;
  const auto applied = ApplyEntries(
      R"("contacts": [{"a": "left", "b": "right", "compliance": "by_moduli", "friction": 0.2}])",
      &product);
  ASSERT_TRUE(applied.has_value()) << applied.error().ToString();
  ASSERT_EQ(product.contact_pairs.size(), 1u);
  const double steel = (1 - 0.3 * 0.3) / 210e9;
  const double aluminium = (1 - 0.33 * 0.33) / 70e9;
  EXPECT_NEAR(product.contact_pairs[0].compliance.value_or(0),
              5e-7 * (steel + aluminium) / (2 * steel), 1e-15);
  EXPECT_EQ(product.contact_pairs[0].friction, 0.2);
}

}  // namespace
}  // namespace hvas::mates
