// What gives follows from forms and materials: with all names taken away, the same parts give, and
// the same verdict comes of it.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "base/test/temporary_folder.h"

namespace hvas::assembly {
namespace {

using hvas::testing::TemporaryFolder;

std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/** Copies an example product, without its side file. */
std::filesystem::path Copy(const std::string& name, const TemporaryFolder& folder) {
  std::filesystem::path copy = folder / (name + ".step");
  std::filesystem::copy_file(std::filesystem::path(HVAS_SOURCE_DIR) / "products" / (name + ".step"),
                             copy, std::filesystem::copy_options::overwrite_existing);
  return copy;
}

/** Copies one with numbers in the place of the names of its products and occurrences. */
std::filesystem::path CopyWithoutNames(const std::string& name, const TemporaryFolder& folder) {
  const std::string text = ReadText(Copy(name, folder));
  const std::regex named(
      R"re((=\s*(?:PRODUCT\(|NEXT_ASSEMBLY_USAGE_OCCURRENCE\('[^']*',))'[^']*'(,'[^']*')?)re");
  std::string neutral;
  std::size_t at = 0;
  int count = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), named), end; match != end; ++match) {
    const auto begin = static_cast<std::size_t>(match->position());
    neutral += text.substr(at, begin - at) + (*match)[1].str() + "'n" + std::to_string(++count) +
               "'" + ((*match)[2].matched ? ",''" : "");
    at = begin + static_cast<std::size_t>(match->length());
  }
  EXPECT_GT(count, 0);
  std::filesystem::path copy = folder / (name + "_neutral.step");
  std::ofstream(copy) << neutral << text.substr(at);
  return copy;
}

product::Product Open(const std::filesystem::path& file) {
  OpenOptions options;
  options.file = file;
  Diagnostics diagnostics;
  auto product = OpenProduct(options, &diagnostics);
  EXPECT_TRUE(product) << product.error().ToString();
  return std::move(*product);
}

class NeutralPartsTest : public ::testing::TestWithParam<std::string> {};

TEST_P(NeutralPartsTest, TheSamePartsGiveByTheSame) {
  const TemporaryFolder folder;
  const product::Product named = Open(Copy(GetParam(), folder));
  const product::Product neutral = Open(CopyWithoutNames(GetParam(), folder));
  ASSERT_EQ(named.occurrences.size(), neutral.occurrences.size());
  ASSERT_NE(named.occurrences[0].name, neutral.occurrences[0].name);
  ASSERT_EQ(named.flexible.size(), neutral.flexible.size());
  for (std::size_t i = 0; i < named.flexible.size(); ++i) {
    EXPECT_EQ(named.flexible[i].occurrence, neutral.flexible[i].occurrence);
    // What its material alone says is no gasket and no lip seal, but something of rubber.
    if (neutral.flexible[i].kind != product::FlexibleKind::kRubber) {
      EXPECT_EQ(named.flexible[i].kind, neutral.flexible[i].kind);
      EXPECT_EQ(named.flexible[i].allowance, neutral.flexible[i].allowance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Products, NeutralPartsTest,
                         ::testing::Values("bushing", "fit_rig", "gear_pump", "nut_bolt",
                                           "peg_hole", "snap_joint"),
                         [](const auto& named) { return named.param; });

TEST(NeutralNamesTest, TheVerdictOnTheSnapJointIsTheSame) {
  const TemporaryFolder folder;
  std::vector<sequence::Sequence> sequences;
  for (const auto& file : {Copy("snap_joint", folder), CopyWithoutNames("snap_joint", folder)}) {
    Diagnostics diagnostics;
    const auto model = PrepareModel(Open(file), {}, &diagnostics);
    ASSERT_TRUE(model) << model.error().ToString();
    sequences.push_back((*model)->sequence);
  }
  const sequence::Sequence& named = sequences[0];
  const sequence::Sequence& neutral = sequences[1];
  EXPECT_TRUE(named.gaps.empty());
  EXPECT_TRUE(neutral.gaps.empty());
  ASSERT_EQ(named.steps.size(), neutral.steps.size());
  for (std::size_t i = 0; i < named.steps.size(); ++i) {
    EXPECT_EQ(named.steps[i].occurrence, neutral.steps[i].occurrence) << i;
    EXPECT_EQ(named.steps[i].extraction_W, neutral.steps[i].extraction_W) << i;
  }
  ASSERT_EQ(named.gives.size(), neutral.gives.size());
  EXPECT_FALSE(named.gives.empty());
  for (std::size_t i = 0; i < named.gives.size(); ++i) {
    EXPECT_EQ(named.gives[i].flexible, neutral.gives[i].flexible) << i;
    EXPECT_EQ(named.gives[i].kind, neutral.gives[i].kind) << i;
    EXPECT_EQ(named.gives[i].width, neutral.gives[i].width) << i;
    EXPECT_EQ(named.gives[i].strain, neutral.gives[i].strain) << i;
  }
}

}  // namespace
}  // namespace hvas::assembly
