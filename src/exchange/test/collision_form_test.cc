#include "exchange/collision_form.h"

#include <cmath>
#include <numbers>

#include "exchange/test/exported.h"

namespace hvas::exchange {
namespace {

/** How far a point is outside of a box-like piece with its first four corners on one side: the
 distance to the plane of these, positive on the side that has no other corner. */
double DistanceToFirstSide(const std::vector<Vec3>& piece, const Vec3& p) {
  Vec3 normal = (piece[1] - piece[0]).cross(piece[2] - piece[0]).normalized();
  if ((piece[4] - piece[0]).dot(normal) > 0) {
    normal = -normal;
  }
  return (p - piece[0]).dot(normal);
}

TEST(CollisionFormTest, AConvexPartIsOnePieceWithItsShaftAtItsSize) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const CollisionForm& peg = exported.bodies[1].form;
  ASSERT_EQ(peg.pieces.size(), 1U);
  ASSERT_EQ(peg.cylinders.size(), 1U);
  EXPECT_NEAR(peg.cylinders[0].radius, 10e-3, 1e-12);
  for (const Vec3& p : peg.pieces[0]) {
    EXPECT_LE(std::hypot(p.x(), p.y()), 10e-3 + 1e-9);
  }
}

TEST(CollisionFormTest, WallsOfABoreTouchItsCircleFromOutside) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const CollisionForm& block = exported.bodies[0].form;
  EXPECT_FALSE(block.is_hull_only);
  constexpr double kRadius = 10.05e-3;
  int walls = 0;
  for (const auto& piece : block.pieces) {
    const Vec3 middle_of_side = 0.25 * (piece[0] + piece[1] + piece[2] + piece[3]);
    const bool is_wall = piece.size() == 8 && std::abs(piece[0].z() - piece[1].z()) > 40e-3 &&
                         std::hypot(middle_of_side.x(), middle_of_side.y()) < 12e-3;
    if (!is_wall) {
      continue;
    }
    ++walls;
    const Vec3 middle = 0.25 * (piece[0] + piece[1] + piece[2] + piece[3]);
    EXPECT_NEAR(std::hypot(middle.x(), middle.y()), kRadius, 1e-9);
    for (int i = 0; i < 360; ++i) {  // No point of the circle is inside of it.
      const double angle = i * std::numbers::pi / 180;
      const Vec3 on_circle(kRadius * std::cos(angle), kRadius * std::sin(angle), middle.z());
      EXPECT_GE(DistanceToFirstSide(piece, on_circle), -1e-12);
    }
  }
  EXPECT_EQ(walls, kWalls);
}

TEST(CollisionFormTest, ATubeIsNotFilled) {
  const product::Product product = testing::Open(testing::kProducts / "bushing.step");
  const ExportedProduct exported = MakeExported(product);
  const CollisionForm& bushing = exported.bodies[1].form;
  EXPECT_TRUE(bushing.cylinders.empty());
  for (const auto& piece : bushing.pieces) {
    for (const Vec3& p : piece) {
      EXPECT_GE(std::hypot(p.x(), p.y()), 20e-3 - 0.1e-3);
    }
  }
  EXPECT_FALSE(exported.bodies[2].form.cylinders.empty());  // The shaft.
}

TEST(CollisionFormTest, NoPieceOfAFaceComesOutOfThePart) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const product::Part& part = product.parts[0];
  const spatial::Box box = part.box_B;
  for (const auto& piece : exported.bodies[0].form.pieces) {
    for (const Vec3& p : piece) {
      EXPECT_TRUE(((p - box.low).array() >= -1e-9).all() &&
                  ((box.high - p).array() >= -1e-9).all());
      // Nor into the bore, which is 5 to 50 mm high; the faces of its chamfer are wider.
      if (p.z() > 5.1e-3 && p.z() < 48.9e-3) {
        EXPECT_GE(std::hypot(p.x(), p.y()), 10e-3 - 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace hvas::exchange
