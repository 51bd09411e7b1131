#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "app/test/run_hvas.h"
#include "base/test/temporary_folder.h"

namespace hvas::app {
namespace {

using hvas::testing::TemporaryFolder;
using nlohmann::json;
using testing::ExpectAllSeated;
using testing::ProductFile;
using testing::Ran;
using testing::ReadText;
using testing::RunHvas;
using testing::RunHvasJson;

constexpr std::size_t kParts = 12;

/** Twelve parts in arbitrary poses, with a side file that tests may change. */
class LooseParts : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy_file(ProductFile("loose_twelve"), file_);
    const std::filesystem::path drawn = std::filesystem::path(ProductFile("loose_twelve"));
    mates_ = json::parse(ReadText(drawn.parent_path() / "loose_twelve.hvas.json"))["mates"];
    truth_ = json::parse(ReadText(drawn.parent_path() / "loose_twelve.truth.json"));
    WriteMates(mates_);
  }

  void WriteMates(const json& mates) const {
    std::ofstream(folder_ / "loose.hvas.json")
        << json{{"format", "hvas-assignments-2"}, {"mates", mates}}.dump(1);
  }

  /** The place of a mate in the side file, by its parts and whether it is the one with a fit. */
  [[nodiscard]] std::size_t FindMateOf(const std::string& a, const std::string& b,
                                       bool has_fit) const {
    for (std::size_t i = 0; i < mates_.size(); ++i) {
      if (mates_[i]["a"]["occurrence"] == a && mates_[i]["b"]["occurrence"] == b &&
          mates_[i].contains("fit") == has_fit) {
        return i;
      }
    }
    ADD_FAILURE() << "no mate of " << a << " and " << b;
    return 0;
  }

  /** Expects that parts have the poses that the design has. */
  void ExpectAssembledAsDesigned(const std::string& file) const {
    const json tree = RunHvasJson({"inspect", file, "--only", "tree"});
    ASSERT_EQ(tree["occurrences"].size(), kParts);
    for (const json& expected : truth_["assembled"]) {
      const auto found =
          std::find_if(tree["occurrences"].begin(), tree["occurrences"].end(),
                       [&expected](const json& o) { return o["name"] == expected["occurrence"]; });
      ASSERT_NE(found, tree["occurrences"].end()) << expected;
      const json& q = (*found)["rotation_wxyz"];
      const double w = q[0], x = q[1], y = q[2], z = q[3];
      const double axis[3] = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR((*found)["position_mm"][k].get<double>(),
                    expected["position_mm"][k].get<double>(), 1e-4)
            << expected;
        EXPECT_NEAR(axis[k], expected["z"][k].get<double>(), 1e-6) << expected;
      }
    }
  }

  [[nodiscard]] static std::string MessageOf(const json& diagnostics, const std::string& code,
                                             const std::string& part = "") {
    for (const json& item : diagnostics) {
      if (item["code"] == code && item["entity"].get<std::string>().ends_with(part)) {
        return item["message"];
      }
    }
    return "";
  }

  TemporaryFolder folder_;
  std::string file_{(folder_ / "loose.step").string()};
  json mates_;
  json truth_;
};

TEST_F(LooseParts, X12AssembledPosesAreThoseOfTheDesign) {
  ExpectAssembledAsDesigned(file_);
  const json all = RunHvasJson({"inspect", file_});
  EXPECT_EQ(MessageOf(all["diagnostics"], "mate-contradiction"), "");
  EXPECT_EQ(MessageOf(all["diagnostics"], "no-mate"), "") << "each part has a mate there";
  // What is inferred there is what the design has, the mates of the user among it.
  EXPECT_EQ(all["summary"]["mates"]["axis_hole"], truth_["mate_counts"]["axis_hole"]);
  EXPECT_EQ(all["summary"]["mates"]["face_face"], truth_["mate_counts"]["face_face"]);
}

TEST_F(LooseParts, X12TwelvePartsInAnyPosesGoTogetherFromUserMatesAlone) {
  for (const int seed : {1, 2, 3, 4, 5}) {
    SCOPED_TRACE(seed);
    const auto ran =
        testing::RunHvas({"assemble", file_, "--seed", std::to_string(seed), "--json"});
    EXPECT_EQ(ran.status, 0);
    EXPECT_NE(ran.err.find("11 of 12 parts are assembled where the user's mates"),
              std::string::npos);
    ExpectAllSeated(json::parse(ran.out), kParts);
  }
}

TEST_F(LooseParts, X12WithoutTheirMatesTheyAreWhereTheyAreDrawn) {
  std::filesystem::remove(folder_ / "loose.hvas.json");
  const json all = RunHvasJson({"inspect", file_});
  EXPECT_EQ(all["mates"].size(), 0U);
  EXPECT_NE(MessageOf(all["diagnostics"], "no-mate", "shaft"), "");
}

// The shoulder of the shaft on the plate as well, although 4 mm of flange are in between.
TEST_F(LooseParts, X12AContradictionIsNamedWithItsDistance) {
  json mates = mates_;
  const json& plate = mates_[FindMateOf("plate", "bushing", false)]["a"];
  const json& shaft = mates_[FindMateOf("bushing", "shaft", false)]["b"];
  mates.push_back({{"a", plate}, {"b", shaft}});
  WriteMates(mates);
  const json all = RunHvasJson({"inspect", file_});
  const std::string message = MessageOf(all["diagnostics"], "mate-contradiction");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "off by 4.000 mm and 0.00 deg", message);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "(plate <- bushing)", message);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "(bushing <- shaft)", message);
  ExpectAssembledAsDesigned(file_);  // The later one does not count.
  testing::ExpectRefusal({"inspect", file_, "--strict"}, {"mate-contradiction", "4.000 mm"});
  const Ran ran = RunHvas({"assemble", file_, "-q", "--json"});
  ExpectAllSeated(json::parse(ran.out), kParts);
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "4.000 mm", ran.err);
  EXPECT_EQ(MessageOf(json::parse(ran.out)["diagnostics"], "mate-contradiction"), message);
}

TEST_F(LooseParts, X12AddingAMateThatContradictsIsRefused) {
  const json& plate = mates_[FindMateOf("plate", "bushing", false)]["a"];
  const json& shaft = mates_[FindMateOf("bushing", "shaft", false)]["b"];
  const std::string before = ReadText(folder_ / "loose.hvas.json");
  testing::ExpectRefusal(
      {"mate", "add", file_, "--a", fmt::format("plate:{}", plate["face"].get<int>()), "--b",
       fmt::format("shaft:{}", shaft["face"].get<int>())},
      {"contradicts", "4.000 mm"});
  EXPECT_EQ(ReadText(folder_ / "loose.hvas.json"), before);
}

TEST_F(LooseParts, X12WhatTheMatesLeaveFreeIsTold) {
  json mates = mates_;
  mates.erase(FindMateOf("bushing", "shaft", false));
  WriteMates(mates);
  const std::string free =
      MessageOf(RunHvasJson({"inspect", file_})["diagnostics"], "mate-freedom", "shaft");
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, "shifted along (0.00, 0.00, 1.00)", free);
  EXPECT_PRED_FORMAT2(::testing::IsNotSubstring, "turned", free);  // It is round.
}

TEST_F(LooseParts, X12StepExportHasTheAssembledPoses) {
  const std::string out = (folder_ / "assembled.step").string();
  const Ran ran = RunHvas({"export", file_, "-o", out, "-q"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  ExpectAssembledAsDesigned(out);
}

}  // namespace
}  // namespace hvas::app
