#include "mates/assignments.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
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
  }

  Result<int> ApplyText(const std::string& text) {
    std::ofstream(file_) << text;
    return ApplyAssignments(file_, &product_).map([](const MateChanges& changes) {
      return changes.fits;
    });
  }

  Result<int> ApplyEntries(const std::string& entries) {
    return ApplyText(R"({"format": "hvas-assignments-1", "fits": [)" + entries + "]}");
  }

  Product product_;
  hvas::testing::TemporaryFolder folder_;
  std::filesystem::path file_{folder_ / "product.hvas.json"};
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

TEST_F(Assignments, ErrorsNameFileLineEntryAndRemedyAndChangeNothing) {
  for (const std::string& bad : std::vector<std::string>{
           R"({"hole": "plate", "shaft": "pin 9", "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "diameter_mm": 8, "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "diameter_mm": -6, "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "diameter_mm": 1e999, "fit": "H7/p6"})",
           R"({"hole": "pin 2", "shaft": "plate", "fit": "H7/p6"})",
           R"({"hole": "plate", "shaft": "pin 2", "fit": "p6/H7"})",
           R"({"hole": "plate", "shaft": "pin 2", "fit": "H7/t6"})",
           R"({"hole": "plate", "shaft": "pin 2"})",
           R"({"hole": 1, "shaft": 2, "fit": 3})",
           R"({"mate": "m9", "fit": "H7/g6"})",
           R"({"mate": "", "fit": "H7/g6"})",
           R"({"mate": "m1", "hole": "plate", "fit": "H7/g6"})",
           R"({"hole": "plate", "fit": "H7"})",
           R"({"mate": "m1", "note": "says nothing"})",
           R"({"mate": "m1", "friction": 7})",
           R"({"mate": "m1", "friction": "low"})",
           R"({"mate": "m1", "hole_diameter_mm": 6.7})",
           R"({"mate": "m1", "shaft_diameter_mm": 0.006})",
           R"({"mate": "m1", "hole_temperature_c": -300})",
           R"({"mate": "m1", "hole_rz_um": -1})",
           R"({"mate": "m1", "fit": "H7/g6", "fit": "H7/g6"})",
           R"({"mate": "m1", "fitt": "H7/g6"})",
           "7"}) {
    const Result<int> count = ApplyText(
        "{\"format\": \"hvas-assignments-2\",\n \"fits\": [\n  {\"hole\": \"plate\", \"shaft\": "
        "\"pin "
        "1\",\n   \"fit\": \"H7/p6\"},\n" +
        bad + "]}");
    ASSERT_FALSE(count.has_value()) << bad;
    EXPECT_TRUE(count.error().where == file_.string() + ":5, fit 2" ||
                count.error().where == file_.string() + ":5" ||
                bad.find("1e999") != std::string::npos)
        << bad << count.error().ToString();
    EXPECT_FALSE(count.error().remedy.empty()) << bad;
    EXPECT_EQ(product_.mates[0].fit->code, "H7/g6") << bad;
    EXPECT_FALSE(product_.mates[1].conditions.friction.has_value());
  }
  for (const char* text :
       {"", "{", "[]", "{}", R"({"format": "hvas-assignments-3", "fits": []})",
        R"({"format": "hvas-assignments-1", "fits": {}})", R"({"format": 1})", "null"}) {
    const Result<int> count = ApplyText(text);
    ASSERT_FALSE(count.has_value()) << text;
    EXPECT_EQ(count.error().where, file_.string() + ":1") << text;
    EXPECT_FALSE(count.error().remedy.empty()) << text;
  }
  std::filesystem::remove(file_);
  EXPECT_EQ(ApplyAssignments(file_, &product_).error().code, ErrorCode::kNotFound);
}

TEST_F(Assignments, SlipsAreAnsweredWithTheNearestWord) {
  const auto remedy = [this](const std::string& entry) {
    return ApplyEntries(entry).error().remedy;
  };
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "write \"friction\"",
                      remedy(R"({"mate": "m1", "fricton": 0.1})"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "write \"hole_temperature_c\"",
                      remedy(R"({"mate": "m1", "hole_temprature": 20})"));
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "\"pin2\" may be \"pin 2\"",
                      remedy(R"({"hole": "plate", "shaft": "pin2", "fit": "H7/g6"})"));
}

TEST_F(Assignments, ConditionsAreSetInSiByKeyNumberAndNames) {
  const std::string key = product_.mates[1].key;
  ASSERT_EQ(key.size(), 10U);
  const Result<int> count = ApplyEntries(R"({"mate": ")" + key +
                                         R"(", "hole_diameter_mm": 6.01, "shaft_diameter_mm": 5.995,
          "hole_rz_um": 3.2, "shaft_rz_um": 1.6, "note": "gauge 4"},
         {"mate": "m0", "hole_temperature_c": 150, "shaft_temperature_c": -40, "friction": 0.1},
         {"hole": "plate", "shaft": "pin 1", "friction": 0.2})");
  ASSERT_TRUE(count.has_value()) << count.error().ToString();
  EXPECT_EQ(*count, 2);
  const product::FitConditions& first = product_.mates[0].conditions;
  const product::FitConditions& second = product_.mates[1].conditions;
  ASSERT_EQ(second.hole_diameters.size(), 1U);
  EXPECT_DOUBLE_EQ(second.hole_diameters[0].diameter, 6.01e-3);
  ASSERT_EQ(second.shaft_diameters.size(), 1U);
  EXPECT_DOUBLE_EQ(second.shaft_diameters[0].diameter, 5.995e-3);
  EXPECT_DOUBLE_EQ(*second.hole_roughness, 3.2e-6);
  EXPECT_DOUBLE_EQ(*second.shaft_roughness, 1.6e-6);
  EXPECT_FALSE(second.friction.has_value());
  EXPECT_EQ(first.hole_temperature_c, 150);
  EXPECT_EQ(first.shaft_temperature_c, -40);
  EXPECT_EQ(first.friction, 0.2);  // Later entries go over earlier ones.
  EXPECT_EQ(product_.mates[0].fit->code, "H7/g6");
  EXPECT_TRUE(product_.mates[0].fit->is_proposed);
}

TEST_F(Assignments, ClassOfOneSideLeavesTheOtherAsItIs) {
  // Proposed H7/g6: the other class stays.
  ASSERT_TRUE(ApplyEntries(R"({"mate": "m0", "fit": "p6"}, {"mate": "m1", "fit": "F8"})"));
  EXPECT_EQ(product_.mates[0].fit->code, "H7/p6");
  EXPECT_EQ(product_.mates[0].fit->kind, FitKind::kInterference);
  EXPECT_FALSE(product_.mates[0].fit->is_proposed);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "the hole as proposed",
                      product_.mates[0].fit->reason);
  EXPECT_EQ(product_.mates[1].fit->code, "F8/g6");
  // A thread has none: the screw is as drawn, exactly 5 mm, so H7 can only have clearance.
  ASSERT_TRUE(ApplyEntries(R"({"mate": "m2", "fit": "H7"})"));
  EXPECT_EQ(product_.mates[2].fit->code, "H7");
  EXPECT_EQ(product_.mates[2].fit->kind, FitKind::kClearance);
  EXPECT_DOUBLE_EQ(product_.mates[2].fit->nominal_diameter, 5e-3);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "the shaft as drawn", product_.mates[2].fit->reason);
  // And when the other side is stated after it, both stand.
  ASSERT_TRUE(ApplyEntries(R"({"mate": "m2", "fit": "H7"}, {"mate": "m2", "fit": "k6"})"));
  EXPECT_EQ(product_.mates[2].fit->code, "H7/k6");
  EXPECT_EQ(product_.mates[2].fit->kind, FitKind::kTransition);
}

TEST_F(Assignments, RemovedMatesGoAndTheirEntriesWait) {
  const std::string key = product_.mates[0].key;
  const std::string last = product_.mates[2].key;
  const Result<int> count =
      ApplyText(R"({"format": "hvas-assignments-2", "removed": [{"mate": ")" + key +
                R"("}], "fits": [{"mate": ")" + key +
                R"(", "fit": "H7/p6"}, {"hole": "plate", "shaft": "pin 1", "friction": 0.3}]})");
  ASSERT_TRUE(count.has_value()) << count.error().ToString();
  EXPECT_EQ(*count, 0);
  ASSERT_EQ(product_.mates.size(), 2U);
  EXPECT_EQ(product_.mates[1].key, last);
  EXPECT_EQ(product_.mates[1].id.value(), 1U);
  EXPECT_EQ(product_.joints.size(), 2U);
  // Not there any more, or twice: an error, and nothing has happened.
  for (const std::string& removed : {key, last + "\"}, {\"mate\": \"" + last}) {
    const Result<int> again = ApplyText(
        "{\"format\": \"hvas-assignments-2\",\n\"removed\": [{\"mate\": \"" + removed + "\"}]}");
    ASSERT_FALSE(again.has_value());
    EXPECT_FALSE(again.error().remedy.empty());
    EXPECT_EQ(product_.mates.size(), 2U);
  }
}

TEST_F(Assignments, AddedMatesComeFromTwoSurfaces) {
  const product::Mate drawn = product_.mates[1];
  const auto file = [&](const std::string& mates) {
    return R"({"format": "hvas-assignments-2", "removed": [{"mate": ")" + drawn.key +
           R"("}], "mates": [)" + mates + "]}";
  };
  const std::string pin = R"({"occurrence": "pin 2", "feature": 0})";
  const std::string good = R"({"kind": "axis_hole", "a": )" + pin +
                           R"(, "b": {"occurrence": "plate", "feature": 1}, "fit": "H7/k6"})";
  const Result<int> count = ApplyText(file(good));
  ASSERT_TRUE(count.has_value()) << count.error().ToString();
  ASSERT_EQ(product_.mates.size(), 3U);
  const product::Mate& added = product_.mates[2];
  EXPECT_EQ(added.id.value(), 2U);
  EXPECT_EQ(added.key, drawn.key);  // It ties the same.
  EXPECT_EQ(added.origin, product::MateOrigin::kUser);
  EXPECT_EQ(added.a.feature, drawn.a.feature);
  EXPECT_EQ(added.fit->code, "H7/k6");
  EXPECT_FALSE(added.fit->is_proposed);
  for (const std::string& bad : std::vector<std::string>{
           R"({"kind": "face_face", "a": )" + pin +
               R"(, "b": {"occurrence": "plate", "feature": 1}})",
           R"({"a": )" + pin + R"(, "b": {"occurrence": "plat", "feature": 1}})",
           R"({"a": )" + pin + R"(, "b": {"occurrence": "plate", "feature": 77}})",
           R"({"a": )" + pin + R"(, "b": {"occurrence": "plate"}})",
           R"({"a": )" + pin + R"(, "b": {"occurrence": "plate", "face": 0, "feature": 1}})",
           R"({"a": )" + pin + R"(, "b": {"occurrence": "plate", "feature": -1}})",
           R"({"a": )" + pin + R"(, "b": "plate"})", R"({"a": )" + pin + "}",
           R"({"kind": "weld", "a": )" + pin +
               R"(, "b": {"occurrence": "plate", "feature": 1}})"}) {
    Product product = MakeProduct();
    std::ofstream(file_) << file(bad);
    const Result<MateChanges> failed = ApplyAssignments(file_, &product);
    ASSERT_FALSE(failed.has_value()) << bad;
    EXPECT_EQ(failed.error().where, file_.string() + ":1, mate 1") << bad;
    EXPECT_FALSE(failed.error().remedy.empty()) << bad;
    EXPECT_EQ(product.mates.size(), 3U) << bad;
  }
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
                           "m1=", "m1=H77", "m1x=H7/p6", "all=p6/H7"}) {
    const Result<void> result = AssignFit(&product_, text);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_FALSE(result.error().remedy.empty()) << text;
  }
}

TEST(FindAssignmentFile, StandsBesideTheProduct) {
  EXPECT_EQ(FindAssignmentFile("a/pump.step"), "a/pump.hvas.json");
  EXPECT_EQ(FindAssignmentFile("a/pump.v2.stp"), "a/pump.v2.hvas.json");
}

/** A bed with a slot of 12 mm, a slide in it, and a pin of the bed's in the slide. */
Product MakeSlide() {
  Product product;
  product::Part* bed = testing::AddPart(&product, "bed");
  testing::AddRectangle(bed, Vec3(0, -6e-3, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(bed, Vec3(0, 6e-3, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddCylinder(bed, FeatureKind::kHole, Vec3(0.1, 0, 0), Vec3::UnitZ(), 3e-3, 0, 0.01);
  product::Part* slide = testing::AddPart(&product, "slide");
  testing::AddRectangle(slide, Vec3(0, -6e-3, 0), -Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddRectangle(slide, Vec3(0, 6e-3, 0), Vec3::UnitY(), 4e-3, 20e-3);
  testing::AddCylinder(slide, FeatureKind::kShaft, Vec3(0.1, 0, 0), Vec3::UnitZ(), 3e-3, 0, 0.01);
  testing::AddOccurrence(&product, product::PartId(0), Pose());
  testing::AddOccurrence(&product, product::PartId(1), Pose());
  Diagnostics diagnostics;
  Infer(&product, &diagnostics);
  return product;
}

const product::Mate& SlotOf(const Product& product) {
  return *std::find_if(product.mates.begin(), product.mates.end(), [](const product::Mate& mate) {
    return mate.kind == product::MateKind::kPrismatic;
  });
}

TEST_F(Assignments, PrismaticFitIsSelectedByItsKeyOrByNamesWithItsWidth) {
  const std::string key = SlotOf(MakeSlide()).key;
  for (const std::string& which :
       {R"("mate": ")" + key + R"(")",
        std::string(R"("hole": "bed", "shaft": "slide", "width_mm": 12)")}) {
    product_ = MakeSlide();
    ASSERT_EQ(product_.mates.size(), 2U);
    const Result<int> count =
        ApplyEntries("{" + which +
                     R"(, "fit": "H7/p6", "hole_width_mm": 12.004, "shaft_rz_um": 1.6,
                        "friction": 0.1})");
    ASSERT_TRUE(count.has_value()) << count.error().ToString();
    EXPECT_EQ(*count, 1) << "the pin keeps its fit";
    const product::Mate& mate = SlotOf(product_);
    EXPECT_EQ(mate.fit->code, "H7/p6");
    EXPECT_EQ(mate.fit->kind, FitKind::kInterference);
    EXPECT_NEAR(mate.fit->nominal_diameter, 12e-3, 1e-12);
    EXPECT_FALSE(mate.fit->is_proposed);
    ASSERT_EQ(mate.conditions.hole_diameters.size(), 1U);
    EXPECT_NEAR(mate.conditions.hole_diameters[0].diameter, 12.004e-3, 1e-12);
    EXPECT_EQ(mate.conditions.friction, 0.1);
  }
}

TEST_F(Assignments, WrongEntriesOfPrismaticFitsAreRefusedWithLineAndRemedy) {
  product_ = MakeSlide();
  const std::string slot = R"("mate": ")" + SlotOf(product_).key + R"(")";
  for (const auto& [bad, remedy] : std::vector<std::pair<std::string, std::string>>{
           {slot + R"(, "hole_diameter_mm": 12)", "hole_width_mm"},
           {slot + R"(, "fit": "thread")", "fit of widths"},
           {slot + R"(, "hole_width_mm": 13)", "in mm"},
           {slot + R"(, "width_mm": 12, "fit": "H7/g6")", "\"mate\": \"KEY\" alone"},
           {R"("hole": "bed", "shaft": "slide", "diameter_mm": 6, "hole_width_mm": 12)", "widths"},
           {R"("hole": "bed", "shaft": "slide", "width_mm": 20, "fit": "H7/g6")", "hvas inspect"},
           {R"("hole": "bed", "shaft": "slide", "width_mm": 0, "fit": "H7/g6")", "write"}}) {
    const Result<int> count =
        ApplyText("{\"format\": \"hvas-assignments-2\", \"fits\": [\n{" + bad + "}]}");
    ASSERT_FALSE(count.has_value()) << bad;
    EXPECT_NE(count.error().where.find("product.hvas.json:2"), std::string::npos)
        << count.error().ToString();
    EXPECT_NE(count.error().remedy.find(remedy), std::string::npos) << count.error().ToString();
  }
}

TEST_F(Assignments, TheOptionSetsPrismaticFitsLikeOthers) {
  product_ = MakeSlide();
  ASSERT_TRUE(AssignFit(&product_, "slide=H7/h6").has_value());
  EXPECT_EQ(SlotOf(product_).fit->code, "H7/h6");
  EXPECT_EQ(product_.mates[0].fit->code, "H7/h6");
  const auto thread =
      AssignFit(&product_, "m" + std::to_string(SlotOf(product_).id.value()) + "=thread");
  ASSERT_FALSE(thread.has_value());
  EXPECT_NE(thread.error().where.find("--fit"), std::string::npos);
}

}  // namespace
}  // namespace hvas::mates
