#include "studio/workbench_orders.h"

#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "studio/saved_work.h"
#include "studio/test/small_bench.h"
#include "studio/workbench.h"

namespace hvas::studio {
namespace {

namespace fs = std::filesystem;
using product::OccurrenceId;

/** Peg with a collar, clamp over it and cap on it, in a block. */
class WorkbenchOrdersTest : public ::testing::Test {
 protected:
  struct Bench : testing::LoggedBench {
    using LoggedBench::LoggedBench;

    void Open() {
      bench.opener().Open("cap.step", "cap");
      ASSERT_TRUE(log.Await("scene"));
    }

    [[nodiscard]] std::vector<OccurrenceId> Find(const std::vector<std::string>& names) {
      std::vector<OccurrenceId> found;
      for (const std::string& name : names) {
        for (const auto& occurrence : bench.live().scene()->model->product->occurrences) {
          if (occurrence.name == name) {
            found.push_back(occurrence.id);
          }
        }
      }
      return found;
    }

    /** Names of the parts that the steps of the scene insert. */
    [[nodiscard]] std::vector<std::string> Inserted() {
      const auto scene = bench.live().scene();
      std::vector<std::string> names;
      for (const sequence::SequenceStep& step : scene->model->sequence.steps) {
        if (step.kind == sequence::SequenceStep::Kind::kInsert) {
          names.push_back(scene->model->product->occurrences[step.occurrence.index()].name);
        }
      }
      return names;
    }
  };

  /** The two orders that are possible; the one that the scene does not have comes second. */
  static std::vector<std::vector<std::string>> ListOrders(Bench* one) {
    const std::vector<std::string> planned = one->Inserted();
    std::vector<std::string> other = planned;
    std::swap(other[1], other[2]);
    return {planned, other};
  }

  hvas::testing::TemporaryFolder folder_;
  const fs::path file_{folder_ / "work.json"};
};

TEST_F(WorkbenchOrdersTest, OrdersAreFoundAndChecked) {
  Bench one("");
  EXPECT_FALSE(one.bench.orders().Find([](const auto&) {}).has_value());  // Nothing is open.
  one.Open();
  std::promise<Result<assembly::OrderPlan>> found;
  ASSERT_TRUE(one.bench.orders().Find([&](const auto& plan) { found.set_value(plan); }));
  const auto plan = found.get_future().get();
  ASSERT_TRUE(plan.has_value()) << plan.error().ToString();
  EXPECT_FALSE(plan->search.orders.empty());
  EXPECT_TRUE(one.log.Await("order_progress"));
  std::promise<bool> is_possible;
  ASSERT_TRUE(one.bench.orders().Check(
      one.Find({"clamp", "peg", "cap"}),
      [&](const orders::OrderRules&, const Result<assembly::CheckedOrder>& checked) {
        is_possible.set_value(!checked || checked->order.has_value());
      }));
  EXPECT_FALSE(is_possible.get_future().get());
}

TEST_F(WorkbenchOrdersTest, AnOrderIsUsedAndUndone) {
  Bench one("");
  one.Open();
  const auto orders = ListOrders(&one);
  std::size_t start = one.log.size();
  ASSERT_TRUE(one.bench.orders().Set(one.Find(orders[1])));
  EXPECT_EQ((*one.log.Await("scene", start))["why"], "order of assembly");
  EXPECT_EQ(one.Inserted(), orders[1]);
  start = one.log.size();
  ASSERT_TRUE(one.bench.edits().Undo());
  ASSERT_TRUE(one.log.Await("scene", start));
  EXPECT_EQ(one.Inserted(), orders[0]);
  start = one.log.size();
  ASSERT_TRUE(one.bench.orders().Set(one.Find({"clamp", "peg", "cap"})));
  EXPECT_EQ((*one.log.Await("failed", start))["error"]["code"], "invalid");
  EXPECT_EQ(one.Inserted(), orders[0]);
}

TEST_F(WorkbenchOrdersTest, PartsAreExplained) {
  Bench one("");
  one.Open();
  for (const std::uint32_t id : {1U, 1000U}) {
    std::promise<Result<orders::GapReason>> explained;
    ASSERT_TRUE(one.bench.orders().Explain(
        OccurrenceId(id),
        [&](const simulation::Model&, const auto& reason) { explained.set_value(reason); }));
    EXPECT_EQ(explained.get_future().get().has_value(), id == 1U);
  }
}

TEST_F(WorkbenchOrdersTest, TheOrderIsPartOfTheWorkThatIsKept) {
  std::vector<std::vector<std::string>> orders;
  {
    Bench one(file_);
    one.Open();
    orders = ListOrders(&one);
    ASSERT_TRUE(one.bench.orders().Set(one.Find(orders[1])));
    ASSERT_TRUE(one.log.AwaitTrue(
        [this] { return LoadWork(file_) && LoadWork(file_)->edits.size() == 1; }));
  }
  const auto work = LoadWork(file_);
  ASSERT_TRUE(work.has_value()) << work.error().ToString();
  Bench next("");
  next.bench.opener().Resume(*work);
  EXPECT_EQ((*next.log.Await("resumed"))["is_resumed"], true);
  EXPECT_EQ(next.Inserted(), orders[1]);
  // What changes the product has its order found anew.
  const std::size_t start = next.log.size();
  ASSERT_TRUE(next.bench.edits().Change(
      {"nothing", {{"command", "none"}}, [](product::Product*) { return Result<void>(); }}));
  ASSERT_TRUE(next.log.Await("scene", start));
  EXPECT_EQ(next.Inserted(), orders[0]);
  EXPECT_EQ(next.bench.live().scene()->edits.size(), 1U);
}

}  // namespace
}  // namespace hvas::studio
