// Where faces meet, what the surfaces alone say against a search of the triangles (X7).

#include <algorithm>

#include <gtest/gtest.h>

#include "base/random.h"
#include "contact/refine.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

using testing::Build;

// The same shape without what is said of its lists; its field still belongs to `shape`.
Shape::Data WithoutListFaces(const Shape& shape) {
  Shape::Data plain = shape.data();
  plain.exact.list_faces.clear();
  ExactTable& exact = plain.exact;
  const std::uint32_t distance = (1U << exact.distance_bits) - 1U;
  for (std::size_t list = 0; list + 1 < exact.list_begin.size(); ++list) {
    std::sort(exact.listed.begin() + exact.list_begin[list],
              exact.listed.begin() + exact.list_begin[list + 1],
              [&](std::uint32_t a, std::uint32_t b) { return (a & distance) < (b & distance); });
  }
  return plain;
}

TEST(ListFaces, SurfacesAndTrianglesAgreeNearEdges) {
  std::size_t by_surfaces = 0;
  for (const auto& source :
       {testing::Cup(3e-3, 10e-3, 5e-3, 20e-3), testing::Bushing(6e-3, 8e-3, 10e-3),
        testing::Block({8e-3, 6e-3, 1e-3}), testing::Cone(8e-3, 4e-3, 10e-3)}) {
    const auto shape = Build(source);
    const Shape::Data plain = WithoutListFaces(*shape);
    Random random(23);
    for (std::uint32_t v = 0; v < plain.mesh.vertices.size(); v += 3) {
      const double reach = 0.8 * plain.voxel;
      const Vec3 p = plain.mesh.vertices[v] + Vec3(random.Uniform(-reach, reach),
                                                   random.Uniform(-reach, reach),
                                                   random.Uniform(-reach, reach));
      const ZoneAt at = FindZone(plain, p);
      if (!at.is_known || (at.code & ~zone::kPayload) != zone::kList) {
        continue;
      }
      const ListFaces& faces = shape->data().exact.list_faces[at.code & zone::kPayload];
      by_surfaces += faces.kind != ListFaces::Kind::kMixed ? 1 : 0;
      const Hit nowhere{0, 1.0F, {0.0F, 0.0F, 1.0F}};
      const Refined fast = Refine(shape->data(), p, nowhere, {});
      const Refined slow = Refine(plain, p, nowhere, {});
      ASSERT_NEAR(fast.distance, slow.distance, 2e-6) << "vertex " << v << " at " << p.transpose();
      FaceFilter near;
      near.limit = 50e-6;
      const Hit known{0, static_cast<float>(slow.distance), {0.0F, 0.0F, 1.0F}};
      const Refined limited = Refine(shape->data(), p, known, near);
      if (slow.distance < near.limit - 2e-6) {
        EXPECT_NEAR(limited.distance, slow.distance, 2e-6);
      } else if (limited.is_valid) {
        EXPECT_GT(limited.distance, near.limit - 4e-6);
      }
      if (fast.is_exact && slow.is_exact && fast.face == slow.face) {
        EXPECT_LT((fast.gradient - slow.gradient).norm(), 0.05) << "vertex " << v;
      }
    }
  }
  EXPECT_GT(by_surfaces, 200U);
}

}  // namespace
}  // namespace hvas::contact
