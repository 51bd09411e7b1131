#include "product/threads.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/units.h"

namespace hvas::product {
namespace {

/** A shaft of 8 mm along `axis` with one flank of a thread: three turns of a strip with a pitch
 of 1.25 mm. A negative sense makes it left-handed. */
Part MakeThreadedShaft(double sense, const Vec3& axis) {
  constexpr double kPitch = 1.25e-3;
  constexpr int kSteps = 48;  // Of a turn.
  const Mat3 R = spatial::FrameFromZ(axis).toRotationMatrix();
  Part part;
  Face face;
  for (int i = 0; i <= 3 * kSteps; ++i) {
    const double angle = units::kTurn * i / kSteps;
    for (const double radius : {3.4e-3, 4.0e-3}) {
      const double z = sense * kPitch * i / kSteps + (radius - 3.4e-3) * 0.577;
      part.mesh.vertices.push_back(R * Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
      face.box_B.Add(part.mesh.vertices.back());
    }
    if (i > 0) {
      const auto v = static_cast<std::uint32_t>(part.mesh.vertices.size());
      part.mesh.triangles.push_back({v - 4, v - 3, v - 2});
      part.mesh.triangles.push_back({v - 2, v - 3, v - 1});
    }
  }
  face.surface.kind = SurfaceKind::kFreeform;
  face.triangle_count = static_cast<std::uint32_t>(part.mesh.triangles.size());
  part.faces.push_back(face);
  Feature shaft;
  shaft.kind = FeatureKind::kShaft;
  shaft.axis_B = axis;
  shaft.radius = 4e-3;
  part.features.push_back(shaft);
  return part;
}

TEST(ThreadHand, IsThatOfTheHelicalFacesHoweverTheAxisPoints) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0.6, 0, 0.8)}) {
    const Part right = MakeThreadedShaft(1, axis);
    EXPECT_FALSE(IsLeftHanded(right, right.features[0]));
    const Part left = MakeThreadedShaft(-1, axis);
    EXPECT_TRUE(IsLeftHanded(left, left.features[0]));
  }
}

TEST(ThreadHand, AShaftWithoutHelicalFacesIsNotLeftHanded) {
  Part part;
  part.features.emplace_back();
  part.features[0].radius = 4e-3;
  EXPECT_FALSE(IsLeftHanded(part, part.features[0]));
}

}  // namespace
}  // namespace hvas::product
