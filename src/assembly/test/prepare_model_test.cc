#include "assembly/prepare_model.h"

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "simulation/test/small_models.h"

namespace hvas::assembly {
namespace {

using product::Product;
using sequence::SequenceStep;
using simulation::Model;

/** The first part that a hand takes up. */
std::string FirstTaken(const Model& model) {
  for (const SequenceStep& step : model.sequence.steps) {
    if (step.kind == SequenceStep::Kind::kInsert) {
      return model.product->occurrences[step.occurrence.index()].name;
    }
  }
  return {};
}

Result<std::shared_ptr<const Model>> Prepare(const Product& product,
                                             const PrepareOptions& options = {}) {
  Diagnostics diagnostics;
  return PrepareModel(product, options, &diagnostics);
}

TEST(PrepareModelTest, GivesTheOrderThatIsAskedFor) {
  const Product product = simulation::testing::CollarUnderClamp();
  const auto found = Prepare(product);
  ASSERT_TRUE(found.has_value()) << found.error().ToString();
  ASSERT_NE(FirstTaken(**found), "clamp");
  PrepareOptions options;
  options.first_parts = {"clamp"};
  const auto asked = Prepare(product, options);
  ASSERT_TRUE(asked.has_value()) << asked.error().ToString();
  EXPECT_EQ(FirstTaken(**asked), "clamp");
}

TEST(PrepareModelTest, RefusesAnOrderWithAPartThatIsNotThere) {
  PrepareOptions options;
  options.first_parts = {"handle"};
  const auto model = Prepare(simulation::testing::PegInBlock(), options);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kNotFound);
}

TEST(PrepareModelTest, RefusesAProductWithoutMass) {
  Product product = simulation::testing::PegInBlock();
  product.source = "peg.obj";
  for (product::Part& part : product.parts) {
    part.mass = {};
  }
  const auto model = Prepare(product);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(model.error().where, "peg.obj");
  PrepareOptions options;
  options.name = "my peg";
  EXPECT_EQ(Prepare(product, options).error().where, "my peg");
}

TEST(PrepareModelTest, TakesShapesFromTheCacheTheSecondTime) {
  const hvas::testing::TemporaryFolder folder;
  const Product product = simulation::testing::PegInBlock();
  PrepareOptions options;
  options.shape_cache = MakeShapeCache(folder / "shapes");
  ASSERT_TRUE(Prepare(product, options).has_value());
  EXPECT_EQ(options.shape_cache->built_count(), 2u);
  options.shape_cache = MakeShapeCache(folder / "shapes");
  ASSERT_TRUE(Prepare(product, options).has_value());
  EXPECT_EQ(options.shape_cache->built_count(), 0u);
  EXPECT_EQ(options.shape_cache->loaded_count(), 2u);
  EXPECT_EQ(MakeShapeCache(std::nullopt), nullptr);
}

TEST(PrepareModelTest, EndsAfterAStop) {
  std::stop_source stop;
  stop.request_stop();
  PrepareOptions options;
  options.stop = stop.get_token();
  const auto model = Prepare(simulation::testing::PegInBlock(), options);
  ASSERT_FALSE(model.has_value());
  EXPECT_EQ(model.error().code, ErrorCode::kCancelled) << model.error().ToString();
}

TEST(PrepareModelTest, KeepsTheSeedAndTellsOfProgress) {
  PrepareOptions options;
  options.seed = 7;
  double last = -1;
  options.progress = [&last](std::string_view, double fraction) { last = fraction; };
  const auto model = Prepare(simulation::testing::PegInBlock(), options);
  ASSERT_TRUE(model.has_value()) << model.error().ToString();
  EXPECT_EQ((*model)->seed, 7u);
  EXPECT_GE(last, 0);
}

}  // namespace
}  // namespace hvas::assembly
