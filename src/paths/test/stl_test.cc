#include "paths/stl.h"

#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

namespace hvas::paths {
namespace {

template <typename T>
T At(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

TEST(StlTest, HasEachTriangleInMillimetresWithItsNormal) {
  SurfaceMesh mesh;
  mesh.vertices = {Vec3(0, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.02, 0), Vec3(0, 0, 0.03)};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const std::string stl = MakeStl(mesh);
  ASSERT_EQ(stl.size(), 84U + 4 * 50);
  EXPECT_NE(stl.substr(0, 5), "solid");
  EXPECT_EQ(At<std::uint32_t>(stl, 80), 4U);
  EXPECT_EQ(At<float>(stl, 84 + 8), -1.0F);            // the first one looks down
  EXPECT_EQ(At<float>(stl, 84 + 12 + 12 + 4), 20.0F);  // its second corner, 20 mm along y
  EXPECT_EQ(At<std::uint16_t>(stl, 84 + 48), 0U);
}

}  // namespace
}  // namespace hvas::paths
