// Shapes on disk: prepared once, the same to the last bit; whatever is wrong with a file or a
// directory costs time, never a result.

#include "contact/shape_cache.h"

#include <array>
#include <chrono>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "contact/scene.h"
#include "contact/shape_io.h"
#include "contact/test/parts.h"

namespace hvas::contact {
namespace {

namespace fs = std::filesystem;

class ShapeCacheTest : public ::testing::Test {
 protected:
  // Fills a fresh cache's file for the bushing and hands it to `damage`; the next one must build.
  template <typename Damage>
  void ExpectRebuilt(Damage damage) const {
    ASSERT_TRUE(ShapeCache(directory_).LoadOrBuild(bushing_, {}));
    const fs::path path = ShapeCache(directory_).PathOf(bushing_, {});
    const auto size = fs::file_size(path);
    damage(path);
    for (const std::uint32_t built : {1U, 0U}) {
      ShapeCache cache(directory_);
      const auto shape = cache.LoadOrBuild(bushing_, {});
      ASSERT_TRUE(shape);
      EXPECT_EQ(cache.built_count(), built);
      EXPECT_EQ(cache.loaded_count(), 1 - built);
      EXPECT_EQ(SerialiseShape(**shape), built_bytes_);
      EXPECT_EQ(fs::file_size(path), size);
      EXPECT_FALSE(cache.TakeProblem());
    }
  }

  static void Flip(const fs::path& path, std::uintmax_t at) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(static_cast<std::streamoff>(at));
    const int byte = file.get();
    file.seekp(static_cast<std::streamoff>(at));
    file.put(static_cast<char>(byte ^ 0x10));
  }

  hvas::testing::TemporaryFolder folder_;
  const fs::path& directory_{folder_.path()};
  ShapeSource bushing_{testing::Bushing(5e-3, 9e-3, 12e-3, 50e-6)};
  std::vector<std::byte> built_bytes_{SerialiseShape(*testing::Build(bushing_))};
};

TEST_F(ShapeCacheTest, LoadedShapeEqualsTheBuiltOneBitForBit) {
  ShapeCache cold(directory_);
  const auto built = cold.LoadOrBuild(bushing_, {});
  ShapeCache warm(directory_);
  const auto loaded = warm.LoadOrBuild(bushing_, {});
  ASSERT_TRUE(built && loaded);
  EXPECT_EQ(cold.built_count(), 1U);
  EXPECT_EQ(warm.loaded_count(), 1U);
  EXPECT_EQ(warm.built_count(), 0U);
  EXPECT_EQ(SerialiseShape(**built), built_bytes_);
  EXPECT_EQ(SerialiseShape(**loaded), built_bytes_);
  EXPECT_GT(built_bytes_.size(), 100'000U);
}

TEST_F(ShapeCacheTest, LoadedShapeAnswersQueriesAsTheBuiltOne) {
  const auto shaft = testing::Build(testing::Shaft(4.99e-3, 15e-3, 50e-6));
  (void)ShapeCache(directory_).LoadOrBuild(bushing_, {});
  const auto loaded = ShapeCache(directory_).LoadOrBuild(bushing_, {});
  ASSERT_TRUE(loaded);
  const auto built = testing::Build(bushing_);
  std::array<QueryWorkspace, 2> work;
  int contacts = 0;
  for (int i = 0; i < 100; ++i) {
    const spatial::Pose X_WH(
        Quat(Eigen::AngleAxisd(2e-3 * (i % 7 - 3), Vec3(1, 0.2 * i, 0).normalized())),
        Vec3(4e-6 * (i % 11 - 5), 4e-6 * (i % 13 - 6), 1e-4 * (i - 50)));
    std::size_t k = 0;
    for (const auto& shape : {built, *loaded}) {
      Scene scene;
      (void)scene.Add(shape, spatial::Pose());
      scene.Query(*shaft, X_WH, {}, &work[k++]);
    }
    ASSERT_EQ(work[0].contacts().size(), work[1].contacts().size());
    EXPECT_EQ(work[0].deepest(), work[1].deepest());
    for (std::size_t c = 0; c < work[0].contacts().size(); ++c) {
      EXPECT_EQ(work[0].contacts()[c].p_WC, work[1].contacts()[c].p_WC);
      EXPECT_EQ(work[0].contacts()[c].nhat_W, work[1].contacts()[c].nhat_W);
      EXPECT_EQ(work[0].contacts()[c].distance, work[1].contacts()[c].distance);
      ++contacts;
    }
  }
  EXPECT_GT(contacts, 100);
}

TEST_F(ShapeCacheTest, EachSourceAndEachOptionHasItsOwnFile) {
  const ShapeCache cache(directory_);
  const fs::path path = cache.PathOf(bushing_, {});
  ShapeOptions options;
  options.voxel = 1e-3;
  EXPECT_NE(cache.PathOf(bushing_, options), path);
  ShapeSource moved = bushing_;
  moved.vertices[7].x() += 1e-12;
  EXPECT_NE(cache.PathOf(moved, {}), path);
  ShapeSource other = bushing_;
  other.faces[1].outward = -1;
  EXPECT_NE(cache.PathOf(other, {}), path);
  other = bushing_;
  std::swap(other.triangles[0], other.triangles[1]);
  EXPECT_NE(cache.PathOf(other, {}), path);
  EXPECT_EQ(cache.PathOf(testing::Bushing(5e-3, 9e-3, 12e-3, 50e-6), {}), path);
}

TEST_F(ShapeCacheTest, AChangedByteAnywhereIsNoticed) {
  const auto size = sizeof(std::uint64_t) * 8 + built_bytes_.size();
  for (const std::uintmax_t at : {std::uintmax_t{0}, std::uintmax_t{20}, std::uintmax_t{44},
                                  std::uintmax_t{60}, std::uintmax_t{64}, size / 2, size - 1}) {
    ExpectRebuilt([at](const fs::path& path) { Flip(path, at); });
  }
}

TEST_F(ShapeCacheTest, ATruncatedFileIsBuiltAgain) {
  for (const double part : {0.0, 1e-4, 0.5, 0.999999}) {
    ExpectRebuilt([part](const fs::path& path) {
      const auto size = static_cast<double>(fs::file_size(path));
      fs::resize_file(path, static_cast<std::uintmax_t>(part * size));
    });
  }
}

TEST_F(ShapeCacheTest, AFileOfAnOlderVersionIsBuiltAgain) {
  constexpr std::uintmax_t kVersionAt = 8;
  ExpectRebuilt([](const fs::path& path) { Flip(path, kVersionAt); });
}

TEST_F(ShapeCacheTest, AnotherPartsFileUnderThisNameIsBuiltAgain) {
  const ShapeSource cup = testing::Cup(3e-3, 5e-3, 2e-3, 9e-3);
  ShapeOptions coarse;
  coarse.voxel = 0.4e-3;
  ExpectRebuilt([&](const fs::path& path) {
    ShapeCache cache(directory_);
    ASSERT_TRUE(cache.LoadOrBuild(cup, coarse));
    fs::copy_file(cache.PathOf(cup, coarse), path, fs::copy_options::overwrite_existing);
  });
}

TEST_F(ShapeCacheTest, ADirectoryThatCannotBeMadeIsReportedOnceAndCostsNoResult) {
  std::ofstream(directory_ / "file") << "not a directory";
  ShapeCache cache(directory_ / "file" / "shapes");
  for (int i = 0; i < 2; ++i) {
    const auto shape = cache.LoadOrBuild(bushing_, {});
    ASSERT_TRUE(shape);
    EXPECT_EQ(SerialiseShape(**shape), built_bytes_);
  }
  EXPECT_EQ(cache.built_count(), 2U);
  const auto problem = cache.TakeProblem();
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->where.find("shapes"), std::string::npos);
  EXPECT_FALSE(cache.TakeProblem());
}

TEST_F(ShapeCacheTest, ShapesNotUsedForLongestGoFirst) {
  const ShapeCache look(directory_);
  std::array<ShapeOptions, 3> options;
  for (std::size_t i = 0; i < 3; ++i) {
    options[i].voxel = 0.4e-3 + 1e-6 * static_cast<double>(i);
  }
  std::uintmax_t size = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(ShapeCache(directory_).LoadOrBuild(bushing_, options[i]));
    size += fs::file_size(look.PathOf(bushing_, options[i]));
    fs::last_write_time(look.PathOf(bushing_, options[i]),
                        fs::file_time_type::clock::now() - std::chrono::hours(2 - i));
  }
  ASSERT_TRUE(ShapeCache(directory_).LoadOrBuild(bushing_, options[0]));  // Used: now the newer.
  ASSERT_TRUE(ShapeCache(directory_, size + size / 4).LoadOrBuild(bushing_, options[2]));
  EXPECT_TRUE(fs::exists(look.PathOf(bushing_, options[0])));
  EXPECT_FALSE(fs::exists(look.PathOf(bushing_, options[1])));
  EXPECT_TRUE(fs::exists(look.PathOf(bushing_, options[2])));
}

TEST_F(ShapeCacheTest, LeavesNothingUnfinishedBehind) {
  ASSERT_TRUE(ShapeCache(directory_).LoadOrBuild(bushing_, {}));
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()), 1);
}

TEST_F(ShapeCacheTest, AnErrorOfTheSourceIsNotHiddenNorKept) {
  ShapeCache cache(directory_);
  EXPECT_FALSE(cache.LoadOrBuild({}, {}));
  EXPECT_TRUE(fs::is_empty(directory_));
}

}  // namespace
}  // namespace hvas::contact
