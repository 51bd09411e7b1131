#include "exchange/urdf.h"

#include <cstring>
#include <set>

#include <mujoco/mujoco.h>

#include "exchange/test/exported.h"

namespace hvas::exchange {
namespace {

std::uint32_t TrianglesOf(const std::string& stl) {
  std::uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, sizeof(count));
  return count;
}

/** Volume of a closed binary STL file [m^3]. */
double VolumeOf(const std::string& stl) {
  double volume = 0;
  for (std::uint32_t i = 0; i < TrianglesOf(stl); ++i) {
    std::array<float, 12> numbers{};
    std::memcpy(numbers.data(), stl.data() + 84 + 50 * i, sizeof(numbers));
    const auto corner = [&](std::size_t k) {
      return Vec3(static_cast<double>(numbers[3 * k + 3]), static_cast<double>(numbers[3 * k + 4]),
                  static_cast<double>(numbers[3 * k + 5]));
    };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return volume;
}

TEST(UrdfTest, HasAMeshForEachPartWithItsVolumeAndEveryFileItNames) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const ExportedFiles files = MakeUrdf(exported, "peg");
  const std::string& urdf = files.at("peg.urdf");
  std::set<std::string> named;
  for (std::size_t at = urdf.find("filename=\""); at != std::string::npos;
       at = urdf.find("filename=\"", at + 1)) {
    const std::size_t begin = at + std::strlen("filename=\"");
    named.insert(urdf.substr(begin, urdf.find('"', begin) - begin));
  }
  EXPECT_EQ(named.size(), files.size() - 1);
  for (const std::string& name : named) {
    ASSERT_TRUE(files.contains(name)) << name;
    EXPECT_GT(VolumeOf(files.at(name)), 0) << name;
  }
  for (const product::Part& part : product.parts) {
    const double volume =
        VolumeOf(files.at("peg_meshes/part" + std::to_string(part.id.index()) + ".stl"));
    EXPECT_NEAR(volume / part.mass.volume, 1, 0.01);
  }
  EXPECT_NE(urdf.find("min_clearance=\"0.000"), std::string::npos);
}

TEST(UrdfTest, TheRobotIsReadByMuJoCoWithItsMasses) {
  const product::Product product = testing::OpenPeg(0.1);
  const ExportedProduct exported = MakeExported(product);
  const ExportedFiles files = MakeUrdf(exported, "peg");
  auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  for (const auto& [path, bytes] : files) {
    // It looks for meshes by their names without folders.
    const std::string name = path.substr(path.rfind('/') + 1);
    if (mj_makeEmptyFileVFS(vfs.get(), name.c_str(), static_cast<int>(bytes.size())) == 0) {
      std::memcpy(vfs->filedata[vfs->nfile - 1], bytes.data(), bytes.size());
    }
  }
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML("peg.urdf", vfs.get(), error.data(), static_cast<int>(error.size()));
  ASSERT_NE(model, nullptr) << error.data();
  const int peg = mj_name2id(model, mjOBJ_BODY, exported.bodies[1].name.c_str());
  ASSERT_GE(peg, 0);
  EXPECT_NEAR(model->body_mass[peg], product.part_of(product::OccurrenceId(1)).mass.mass, 1e-9);
  mj_deleteModel(model);
  mj_deleteVFS(vfs.get());
}

}  // namespace
}  // namespace hvas::exchange
