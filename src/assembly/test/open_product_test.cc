#include "assembly/open_product.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "mates/stated_fits.h"

namespace hvas::assembly {
namespace {

using hvas::testing::TemporaryFolder;
using product::Mate;
using product::Product;

std::filesystem::path ProductFile(const std::string& name) {
  return std::filesystem::path(HVAS_SOURCE_DIR) / "products" / name;
}

/** A copy of the bushing rig in a folder of its own, without its side file. */
std::filesystem::path CopyBushing(const TemporaryFolder& folder) {
  const std::filesystem::path file = folder / "bushing.step";
  std::filesystem::copy_file(ProductFile("bushing.step"), file);
  return file;
}

Result<Product> Open(const OpenOptions& options) {
  Diagnostics diagnostics;
  return OpenProduct(options, &diagnostics);
}

OpenOptions OptionsFor(const std::filesystem::path& file) {
  OpenOptions options;
  options.file = file;
  return options;
}

/** The codes of the fits that somebody stated, in the order of the mates. */
std::vector<std::string> StatedFits(const Product& product) {
  std::vector<std::string> fits;
  for (const Mate& mate : product.mates) {
    if (mate.fit && !mate.fit->is_proposed) {
      fits.push_back(mate.fit->code);
    }
  }
  return fits;
}

void ExpectRefused(const Result<Product>& product, ErrorCode code, const std::string& words) {
  ASSERT_FALSE(product.has_value());
  EXPECT_EQ(product.error().code, code) << product.error().ToString();
  EXPECT_PRED_FORMAT2(::testing::IsSubstring, words, product.error().ToString());
}

TEST(OpenProductTest, GivesTheFitsOfTheSideFile) {
  const auto product = Open(OptionsFor(ProductFile("bushing.step")));
  ASSERT_TRUE(product.has_value()) << product.error().ToString();
  EXPECT_EQ(product->occurrences.size(), 3u);
  EXPECT_EQ(StatedFits(*product), (std::vector<std::string>{"H7/h6", "H7/g6"}));
}

TEST(OpenProductTest, GivesTheFitsOfTheFileItselfWithoutASideFile) {
  const TemporaryFolder folder;
  const OpenOptions options = OptionsFor(CopyBushing(folder));
  Diagnostics diagnostics;
  auto inferred = OpenInferred(options, &diagnostics);
  ASSERT_TRUE(inferred.has_value()) << inferred.error().ToString();
  EXPECT_TRUE(StatedFits(*inferred).empty());
  mates::AssignStatedFits(&*inferred);
  const auto product = Open(options);
  ASSERT_TRUE(product.has_value()) << product.error().ToString();
  EXPECT_EQ(StatedFits(*product), StatedFits(*inferred));
}

TEST(OpenProductTest, PutsTheFitsGivenOverThoseOfTheFiles) {
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.fits = {"shaft=H7/p6"};
  const auto product = Open(options);
  ASSERT_TRUE(product.has_value()) << product.error().ToString();
  EXPECT_EQ(StatedFits(*product), (std::vector<std::string>{"H7/h6", "H7/p6"}));
}

TEST(OpenProductTest, RefusesAFitOfNoPart) {
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.fits = {"handle=H7/p6"};
  ExpectRefused(Open(options), ErrorCode::kNotFound, "handle");
}

TEST(OpenProductTest, RefusesAFileThatIsNotThere) {
  const TemporaryFolder folder;
  ExpectRefused(Open(OptionsFor(folder / "none.step")), ErrorCode::kNotFound, "none.step");
}

TEST(OpenProductTest, RefusesAFileOfAnotherKind) {
  const TemporaryFolder folder;
  ExpectRefused(Open(OptionsFor(folder.Write("letter.step", "Dear reader"))),
                ErrorCode::kUnreadable, "letter.step");
}

TEST(OpenProductTest, RefusesASideFileThatLeadsNowhere) {
  const TemporaryFolder folder;
  const OpenOptions options = OptionsFor(CopyBushing(folder));
  std::filesystem::create_symlink(folder / "nowhere", folder / "bushing.hvas.json");
  ExpectRefused(Open(options), ErrorCode::kNotFound, "bushing.hvas.json");
}

TEST(OpenProductTest, EndsAtALimitOfParts) {
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.max_parts = 2;
  EXPECT_FALSE(Open(options).has_value());
  options.max_parts = 3;
  EXPECT_TRUE(Open(options).has_value());
}

TEST(OpenProductTest, EndsAtALimitOfTime) {
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.limits.time = 1e-4;
  ExpectRefused(Open(options), ErrorCode::kOutOfResource, "bushing.step");
}

TEST(OpenProductTest, EndsAfterAStop) {
  std::stop_source stop;
  stop.request_stop();
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.stop = stop.get_token();
  ExpectRefused(Open(options), ErrorCode::kCancelled, "bushing.step");
}

TEST(OpenProductTest, RefusesOptionsOutOfRange) {
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.length_unit = 0;
  ExpectRefused(Open(options), ErrorCode::kInvalid, "length unit");
  options = OptionsFor(ProductFile("bushing.step"));
  options.max_parts = -1;
  ExpectRefused(Open(options), ErrorCode::kInvalid, "parts");
  options = OptionsFor(ProductFile("bushing.step"));
  options.encoding = "CP125l";
  ExpectRefused(Open(options), ErrorCode::kInvalid, "CP125l");
}

TEST(OpenProductTest, KeepsWhatWasReadInItsCacheOnly) {
  const TemporaryFolder folder;
  OpenOptions options = OptionsFor(ProductFile("bushing.step"));
  options.cache_directory = folder / "cache";
  ASSERT_TRUE(Open(options).has_value());
  EXPECT_FALSE(std::filesystem::is_empty(folder / "cache"));
  bool has_read = false;  // What comes from the cache is told as done, and nothing else.
  options.progress = [&has_read](std::string_view stage, double) {
    has_read = has_read || stage != "done";
  };
  ASSERT_TRUE(Open(options).has_value());
  EXPECT_FALSE(has_read);
}

}  // namespace
}  // namespace hvas::assembly
