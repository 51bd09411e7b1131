#include "studio/saved_work.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "studio/test/protocol_schema.h"
#include "studio/test/small_bench.h"
#include "studio/workbench.h"

namespace hvas::studio {
namespace {

namespace fs = std::filesystem;
using simulation::Placement;

constexpr product::OccurrenceId kKeptPeg(1);

/** A workbench that keeps its work, and one that takes it up. */
class KeptWorkTest : public ::testing::Test {
 protected:
  using Bench = testing::LoggedBench;

  static void Open(Bench* one) {
    one->bench.opener().Open("peg.step", "peg");
    ASSERT_TRUE(one->log.Await("scene"));
    ASSERT_TRUE(one->log.AwaitTrue(
        [&] { return one->bench.live().state().next_step > 0; }));  // the base is placed
  }

  static void AssignFit(Bench* one, const char* fit) {
    const std::size_t start = one->log.size();
    const auto edit = MakeEdit({{"command", "assign_fit"}, {"mate", 0U}, {"fit", fit}});
    ASSERT_TRUE(edit.has_value());
    ASSERT_TRUE(one->bench.edits().Change(*edit));
    ASSERT_TRUE(one->log.Await("scene", start));
  }

  [[nodiscard]] Placement KeptPlacement() const {
    const auto work = LoadWork(file_);
    return work && work->state.parts.size() > kKeptPeg.index()
               ? work->state.parts[kKeptPeg.index()].placement
               : Placement::kHeld;
  }

  /** What a program that is killed now leaves behind. */
  [[nodiscard]] fs::path CopyAsAfterKill() const {
    const fs::path copy = folder_ / "killed.json";
    fs::copy_file(file_, copy, fs::copy_options::overwrite_existing);
    return copy;
  }

  hvas::testing::TemporaryFolder folder_;
  const fs::path file_{folder_ / "work.json"};
};

TEST_F(KeptWorkTest, GoesOnWhereAProgramWasThatWasKilled) {
  Bench killed(file_);
  Open(&killed);
  AssignFit(&killed, "H7/h6");
  ASSERT_TRUE(killed.bench.notes().Add({"Ada", "Deburr", kKeptPeg, Vec3(0, 0, 0.01)}));
  ASSERT_TRUE(killed.log.AwaitTrue([this] {
    return LoadWork(file_) && LoadWork(file_)->notes.size() == 1;
  })) << "without any other change";
  ASSERT_TRUE(killed.bench.demo().DoNext());
  ASSERT_TRUE(killed.log.AwaitTrue([this] { return KeptPlacement() == Placement::kPlaced; }));
  ASSERT_TRUE(killed.log.AwaitTrue([&] { return !killed.bench.live().is_demo(); }));
  ASSERT_TRUE(killed.log.AwaitTrue([&] {
    const auto work = LoadWork(file_);
    return work && work->state.next_step == killed.bench.live().state().next_step;
  }));
  const auto work = LoadWork(CopyAsAfterKill());
  ASSERT_TRUE(work.has_value()) << work.error().ToString();

  Bench next(folder_ / "next.json");
  next.bench.opener().Resume(*work);
  const auto resumed = next.log.Await("resumed");
  ASSERT_TRUE(resumed);
  EXPECT_EQ(testing::FindEventFault(*resumed), "");
  EXPECT_EQ((*resumed)["is_resumed"], true);
  EXPECT_EQ((*resumed)["edits"], 1);
  const LiveState before = killed.bench.live().state();
  const LiveState after = next.bench.live().state();
  ASSERT_EQ(after.parts.size(), before.parts.size());
  for (std::size_t i = 0; i < before.parts.size(); ++i) {
    EXPECT_EQ(after.parts[i].placement, before.parts[i].placement) << i;
    EXPECT_EQ(after.parts[i].X_WB.p(), before.parts[i].X_WB.p()) << i;
    EXPECT_EQ(after.parts[i].X_WB.q().coeffs(), before.parts[i].X_WB.q().coeffs()) << i;
  }
  EXPECT_EQ(after.next_step, before.next_step);
  const auto& mate = next.bench.live().scene()->model->product->mates[0];
  ASSERT_TRUE(mate.fit.has_value());
  EXPECT_EQ(mate.fit->code, "H7/h6");
  ASSERT_EQ(next.bench.notes().List().size(), 1u);
  EXPECT_EQ(next.bench.notes().List()[0]["text"], "Deburr");
  EXPECT_EQ(next.bench.notes().List()[0]["occurrence"], kKeptPeg.index());
  EXPECT_EQ(next.bench.MakeCatchUpEvents().back()["event"], "resumed");
  ASSERT_TRUE(next.log.AwaitTrue([this] { return LoadWork(folder_ / "next.json").has_value(); }));
  EXPECT_EQ(LoadWork(folder_ / "next.json")->edits, work->edits);
}

TEST_F(KeptWorkTest, WhatWasUndoneIsNotDoneAgain) {
  Bench one(file_);
  Open(&one);
  AssignFit(&one, "H7/h6");
  ASSERT_TRUE(
      one.log.AwaitTrue([this] { return LoadWork(file_) && LoadWork(file_)->edits.size() == 1; }));
  ASSERT_TRUE(one.bench.edits().Undo());
  EXPECT_TRUE(one.log.AwaitTrue([this] { return LoadWork(file_)->edits.empty(); }));
}

TEST_F(KeptWorkTest, PartInTheHandIsWhereItWasBefore) {
  Bench one(file_);
  Open(&one);
  const spatial::Pose X_WB = one.bench.live().state().parts[kKeptPeg.index()].X_WB;
  const auto taken = one.bench.hands().Take(0, kKeptPeg);
  ASSERT_TRUE(taken.has_value());
  ASSERT_TRUE(one.log.AwaitTrue([&] {
    one.bench.hands().Move(0, taken->X_WH, true);
    return one.bench.live().state().parts[kKeptPeg.index()].placement == Placement::kHeld;
  }));
  ASSERT_TRUE(one.log.Await("taken"));
  one.bench.Stop();
  const auto work = LoadWork(file_);
  ASSERT_TRUE(work.has_value());
  EXPECT_EQ(work->state.parts[kKeptPeg.index()].placement, Placement::kLoose);
  EXPECT_EQ(work->state.parts[kKeptPeg.index()].X_WB.p(), X_WB.p());
}

TEST_F(KeptWorkTest, WorkOnAnotherProductIsSetAside) {
  Bench one(file_);
  Open(&one);
  one.bench.Stop();
  auto work = LoadWork(file_);
  ASSERT_TRUE(work.has_value());
  work->digest = "of another";
  ASSERT_TRUE(SaveWork(file_, *work));
  Bench next(file_);
  next.bench.opener().Resume(*work);
  const auto resumed = next.log.Await("resumed");
  ASSERT_TRUE(resumed);
  EXPECT_EQ((*resumed)["is_resumed"], false);
  EXPECT_EQ(LoadWork(file_.string() + ".before")->digest, "of another");
  EXPECT_NE(next.bench.live().scene(), nullptr);
}

TEST_F(KeptWorkTest, DamagedFilesAreRefused) {
  SavedWork work{"/a/peg.step", "peg", "d", {{{"command", "remove_mate"}, {"mate", 0}}}, {}, {}};
  work.state.parts = {{Placement::kPlaced, spatial::Pose()}, {Placement::kParked, spatial::Pose()}};
  ASSERT_TRUE(SaveWork(file_, work));
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  ASSERT_TRUE(LoadWork(file_).has_value());
  const nlohmann::json good = nlohmann::json::parse(std::ifstream(file_));
  const auto with = [&good](const char* pointer, const nlohmann::json& value) {
    nlohmann::json bad = good;
    bad[nlohmann::json::json_pointer(pointer)] = value;
    return bad.dump();
  };
  for (const std::string& bad :
       {std::string(), std::string("x"), std::string("[]"), std::string("{}"), with("/version", 1),
        with("/parts", 5), with("/parts/0", nullptr), with("/parts/0/X_WB", "here"),
        with("/parts/0/X_WB/1", nullptr), with("/parts/0/X_WB/3", 2),
        with("/parts/0/placement", "held"), with("/parts/0/placement", 5), with("/edits", "none"),
        good.dump().substr(0, good.dump().size() / 2)}) {
    std::ofstream(file_) << bad;
    EXPECT_FALSE(LoadWork(file_).has_value()) << bad;
  }
  // Notes that are damaged are left out.
  for (const nlohmann::json& notes :
       {nlohmann::json(5), nlohmann::json::array({5}), nlohmann::json::array({{{"text", 1}}}),
        nlohmann::json::array({{{"text", "x"}, {"by", "y"}, {"occurrence", 1e9}}})}) {
    std::ofstream(file_) << with("/notes", notes);
    const auto loaded = LoadWork(file_);
    ASSERT_TRUE(loaded.has_value()) << notes;
    Bench one(folder_ / "notes.json");
    Open(&one);
    one.bench.notes().Restore(loaded->notes);
    EXPECT_TRUE(one.bench.notes().List().empty()) << notes;
  }
  for (const nlohmann::json& command :
       {nlohmann::json(), nlohmann::json(5), nlohmann::json{{"command", "open"}},
        nlohmann::json{{"command", "assign_fit"}, {"mate", -1}, {"fit", "H7/h6"}},
        nlohmann::json{{"command", "remove_mate"}}}) {
    EXPECT_FALSE(CombineEdits({Json(command)}).has_value()) << command;
  }
}

}  // namespace
}  // namespace hvas::studio
