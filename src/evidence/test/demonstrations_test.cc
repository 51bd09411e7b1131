#include "evidence/demonstrations.h"

#include <cmath>

#include <gtest/gtest.h>
#include <hdf5.h>

#include "evidence/test/evidence_fixture.h"
#include "simulation/test/small_models.h"

namespace hvas::evidence {
namespace {

using testing::EvidenceTest;

std::vector<double> Read(hid_t file, const std::string& name) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  EXPECT_GE(set, 0) << name;
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(set);
  return values;
}

std::int64_t ReadNumber(hid_t file, const char* object, const char* name) {
  std::int64_t number = 0;
  const hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(attribute, 0) << name;
  EXPECT_GE(H5Aread(attribute, H5T_NATIVE_INT64, &number), 0);
  H5Aclose(attribute);
  return number;
}

TEST(PlannedWaysTest, LeadToThePlaceInStepsOfTheRate) {
  constexpr double kRate = 50;
  const auto& model = simulation::testing::PegInBlockModel();
  const std::vector<Demonstration> ways = ListPlannedWays(*model, kRate);
  ASSERT_EQ(ways.size(), 1U);
  const Demonstration& way = ways.front();
  EXPECT_EQ(way.source, "plan");
  EXPECT_TRUE(way.is_seated);
  EXPECT_LT((way.samples.back().X_WB.p() - way.X_WB_goal.p()).norm(), 1e-12);
  // 20 mm before where it engages, at 40 mm/s.
  const double length = model->sequence.steps[1].engage_distance + 20e-3;
  EXPECT_NEAR(way.samples.front().X_WB.p().z() - way.X_WB_goal.p().z(), length, 1e-9);
  EXPECT_NEAR(static_cast<double>(way.samples.size() - 1) / kRate, length / 0.04, 1.5 / kRate);
}

TEST_F(EvidenceTest, DemonstrationsHaveTheLayoutOfRobomimic) {
  auto demonstrations = ListPlannedWays(*simulation::testing::PegInBlockModel(), 50);
  demonstrations.push_back(demonstrations.front());
  demonstrations.back().is_seated = false;
  const auto path = out / "demonstrations.h5";
  ASSERT_TRUE(WriteDemonstrations(demonstrations, "peg", path).has_value());
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const std::size_t count = demonstrations.front().samples.size();
  EXPECT_EQ(ReadNumber(file, "data", "total"), static_cast<std::int64_t>(2 * count));
  EXPECT_EQ(ReadNumber(file, "data/demo_1", "num_samples"), static_cast<std::int64_t>(count));
  const auto actions = Read(file, "data/demo_0/actions");
  const auto hand = Read(file, "data/demo_0/obs/hand_pos");
  ASSERT_EQ(actions.size(), 7 * count);
  ASSERT_EQ(hand.size(), 3 * count);
  double moved = 0;
  for (std::size_t i = 0; i < count; ++i) {  // Actions are the ways of the hand.
    moved += actions[7 * i + 2];
  }
  EXPECT_NEAR(moved, hand[3 * count - 1] - hand[2], 1e-12);
  EXPECT_EQ(actions.back(), -1);
  EXPECT_EQ(Read(file, "data/demo_0/rewards").back(), 1);
  EXPECT_EQ(Read(file, "data/demo_1/rewards").back(), 0);
  EXPECT_EQ(Read(file, "data/demo_0/dones").back(), 1);
  EXPECT_EQ(Read(file, "data/demo_0/obs/part_to_goal").size(), 6 * count);
  EXPECT_GT(H5Aexists_by_name(file, "data", "env_args", H5P_DEFAULT), 0);
  EXPECT_GT(H5Lexists(file, "mask/seated", H5P_DEFAULT), 0);
  H5Fclose(file);
}

TEST_F(EvidenceTest, NoDemonstrationIsAnError) {
  const auto done = WriteDemonstrations({}, "peg", out / "x.h5");
  ASSERT_FALSE(done.has_value());
  EXPECT_EQ(done.error().code, ErrorCode::kInvalid);
  EXPECT_TRUE(std::filesystem::is_empty(out.path()));
}

}  // namespace
}  // namespace hvas::evidence
