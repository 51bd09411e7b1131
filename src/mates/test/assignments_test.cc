#include "mates/assignments.h"

#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>

#include "mates/infer.h"
#include "mates/test/test_product.h"

namespace hvas::mates {
namespace {

using product::FeatureKind;
using product::FitKind;
using product::Product;
using spatial::Pose;

/** A plate with two pins of 6 mm and a bolt of 5 mm in it: mates m0, m1 and, a thread, m2. */
Product MakeProduct() {
  Product product;
  product::Part* plate = testing::AddPart(&product, "plate");
  const double xs[] = {0, 0.02, 0.04};
  const double radii[] = {3e-3, 3e-3, 2.5e-3};
  for (int i = 0; i < 3; ++i) {
    testing::AddCylinder(plate, FeatureKind::kHole, Vec3(xs[i], 0, 0), Vec3::UnitZ(), radii[i], 0,
                         0.01);
  }
  testing::AddOccurrence(&product, product::PartId(0), Pose());
  const char* names[] = {"pin 1", "pin 2", "bolt"};
  for (int i = 0; i < 3; ++i) {
    product::Part* pin = testing::AddPart(&product, names[i]);
    testing::AddCylinder(pin, FeatureKind::kShaft, Vec3::Zero(), Vec3::UnitZ(), radii[i], 0, 0.02);
    testing::AddOccurrence(&product, pin->id, Pose(Vec3(xs[i], 0, 0)));
  }
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

class Assignments : public ::testing::Test {
 protected:
  void SetUp() override {
    product_ = MakeProduct();
    ASSERT_EQ(product_.mates.size(), 3U);
    ASSERT_EQ(product_.mates[2].fit->kind, FitKind::kThread);
    // One file for each test: they run in parallel.
    file_ = std::filesystem::path(::testing::TempDir()) /
            (std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
             ".hvas.json");
  }

  void TearDown() override { std::filesystem::remove(file_); }

  Result<int> ApplyText(const std::string& text) {
    std::ofstream(file_) << text;
    return ApplyAssignments(file_, &product_);
  }

  Result<int> ApplyEntries(const std::string& entries) {
    return ApplyText(R"({"format": "hvas-assignments-1", "fits": [)" + entries + "]}");
  }

  Product product_;
  std::filesystem::path file_;
};

TEST_F(Assignments, SideFileSetsKindCodeAndNominal) {
  const Result<int> count = ApplyEntries(
      R"({"hole": "plate", "shaft": "pin 1", "diameter_mm": 6, "fit": "H7/p6"},
         {"hole": "plate", "shaft": "pin 2", "diameter_mm": 6.0, "fit": "H7/k6"},
         {"hole": "plate", "shaft": "bolt#4", "fit": "thread"})");
  ASSERT_TRUE(count.has_value()) << count.error().ToString();
  EXPECT_EQ(*count, 3);
  EXPECT_EQ(product_.mates[0].fit->kind, FitKind::kInterference);
  EXPECT_EQ(product_.mates[0].fit->code, "H7/p6");
  EXPECT_DOUBLE_EQ(product_.mates[0].fit->nominal_diameter, 6e-3);
  EXPECT_FALSE(product_.mates[0].fit->is_proposed);
  EXPECT_EQ(product_.mates[1].fit->kind, FitKind::kTransition);
  EXPECT_EQ(product_.mates[2].fit->kind, FitKind::kThread);
  EXPECT_FALSE(product_.mates[2].fit->is_proposed);
}

TEST_F(Assignments, ErrorsNameFileEntryAndRemedyAndChangeNothing) {
  const std::string good = R"({"hole": "plate", "shaft": "pin 1", "fit": "H7/p6"},)";
  for (const std::string& bad : std::vector<std::string>{
           R"({"hole": "plate", "shaft": "pin 9", "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "diameter_mm": 8, "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "diameter_mm": -6, "fit": "H7/p6"})",
           R"({"hole": "pin 2", "shaft": "plate", "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "fit": "p6/H7"})",
           R"({"hole": "plate", "shaft": "pin 2", "fit": "H7/t6"})",
           R"({"hole": "plate", "shaft": "pin 2"})", R"({"hole": 1, "shaft": 2, "fit": 3})", "7"}) {
    const Result<int> count = ApplyEntries(good + bad);
    ASSERT_FALSE(count.has_value()) << bad;
    EXPECT_NE(count.error().where.find(file_.string() + ", fit 2"), std::string::npos) << bad;
    EXPECT_FALSE(count.error().remedy.empty()) << bad;
    EXPECT_EQ(product_.mates[0].fit->code, "H7/g6") << bad;
  }
  for (const char* text : {"", "{", "[]", "{}", R"({"format": "hvas-assignments-2", "fits": []})",
                           R"({"format": "hvas-assignments-1", "fits": {}})"}) {
    const Result<int> count = ApplyText(text);
    ASSERT_FALSE(count.has_value()) << text;
    EXPECT_EQ(count.error().where, file_.string());
  }
  std::filesystem::remove(file_);
  EXPECT_EQ(ApplyAssignments(file_, &product_).error().code, ErrorCode::kNotFound);
}

TEST_F(Assignments, CommandLineTakesAMateANameOrAll) {
  ASSERT_TRUE(AssignFit(&product_, "m1=H7/p6").has_value());
  EXPECT_EQ(product_.mates[0].fit->code, "H7/g6");
  EXPECT_EQ(product_.mates[1].fit->code, "H7/p6");
  ASSERT_TRUE(AssignFit(&product_, "pin 1=H7/k6").has_value());
  EXPECT_EQ(product_.mates[0].fit->kind, FitKind::kTransition);
  EXPECT_EQ(product_.mates[1].fit->code, "H7/p6");
  ASSERT_TRUE(AssignFit(&product_, "all=H8/f7").has_value());
  EXPECT_EQ(product_.mates[0].fit->code, "H8/f7");
  EXPECT_EQ(product_.mates[1].fit->code, "H8/f7");
  EXPECT_EQ(product_.mates[2].fit->kind, FitKind::kThread);
  ASSERT_TRUE(AssignFit(&product_, "m2=H7/g6").has_value());
  EXPECT_EQ(product_.mates[2].fit->code, "H7/g6");
  product_.occurrences[1].path = "top/tier 2/pin 1";
  ASSERT_TRUE(AssignFit(&product_, "tier 2/pin 1=H7/h6").has_value());
  EXPECT_EQ(product_.mates[0].fit->code, "H7/h6");
  EXPECT_EQ(product_.mates[1].fit->code, "H8/f7");
  for (const char* text : {"", "H7/p6", "=H7/p6", "ier 2/pin 1=H7/h6", "m9=H7/p6", "nobody=H7/p6",
                           "m1=", "m1=H7", "m1x=H7/p6", "all=p6/H7"}) {
    const Result<void> result = AssignFit(&product_, text);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_FALSE(result.error().remedy.empty()) << text;
  }
}

TEST(FindAssignmentFile, StandsBesideTheProduct) {
  EXPECT_EQ(FindAssignmentFile("a/pump.step"), "a/pump.hvas.json");
  EXPECT_EQ(FindAssignmentFile("a/pump.v2.stp"), "a/pump.v2.hvas.json");
}

}  // namespace
}  // namespace hvas::mates
