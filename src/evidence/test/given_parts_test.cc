// Parts that gave in a session, by its record alone.

#include "evidence/given_parts.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/test/temporary_folder.h"
#include "evidence/picture.h"
#include "session/deformable_json.h"
#include "session/test/recorded_session.h"

namespace hvas::evidence {
namespace {

using product::OccurrenceId;
using simulation::Deformable;

constexpr double kCapOutside = 11.6e-3;  // [m]
constexpr OccurrenceId kCap(1);

std::shared_ptr<const simulation::Model> CompileCap() {
  Diagnostics diagnostics;
  auto model = simulation::Compile(
      std::make_shared<product::Product>(simulation::testing::CapOnBead(kCapOutside)),
      simulation::testing::FastOptions(), &diagnostics);
  EXPECT_TRUE(model.has_value());
  return *model;
}

std::vector<spatial::Pose> PosesOf(const product::Product& product) {
  std::vector<spatial::Pose> poses;
  for (const product::Occurrence& occurrence : product.occurrences) {
    poses.push_back(occurrence.X_WB);
  }
  return poses;
}

TEST(GivenParts, AreInTheRecordWithTheSameAmountsToTheBit) {
  const auto model = CompileCap();
  const hvas::testing::TemporaryFolder folder;
  const auto file = folder / "cap.hvasrec";
  const auto recorder = session::testing::MakeRecorder(file);
  session::SessionRecorder sink(recorder.get(), *model);
  session::testing::Stretch stretch(model, 1, &sink);
  sink.Begin(stretch.simulation.get());
  (void)RunLockstep(stretch.MakeExecution(60));
  ASSERT_TRUE(recorder->Finish().has_value());

  auto reader = record::Reader::Open(file);
  ASSERT_TRUE(reader.has_value());
  const auto product = session::FindProduct(&*reader);
  ASSERT_TRUE(product.has_value() && *product);
  const auto read = session::ReadDeformables(**product, &*reader);
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->size(), model->deformables.size());
  ASSERT_EQ(read->size(), 1U);
  // What the record has gives what the model gives, at every tick of the session.
  std::vector<spatial::Pose> poses = PosesOf(**product);
  double most = 0;
  const auto done = reader->ForEachTick({}, [&](const record::TickRecord& tick) {
    if (tick.held == kCap.value()) {
      poses[kCap.index()] = tick.X_WD;
      const auto here = simulation::CalcDeformations(**product, *read, poses);
      EXPECT_EQ(here, simulation::CalcDeformations(*model->product, model->deformables, poses));
      most = std::max(most, here[0]);
      const Vec3 rim(10.05e-3, 0, 10e-3);
      EXPECT_EQ(Deform((*read)[0].form, here[0], rim),
                Deform(model->deformables[0].form, here[0], rim));
    }
    return true;
  });
  ASSERT_TRUE(done.has_value());

  const auto given = FindGivenParts(&*reader, {}, **product);
  ASSERT_TRUE(given.has_value());
  ASSERT_EQ(given->size(), 1U);
  EXPECT_EQ((*given)[0].occurrence, kCap.value());
  EXPECT_EQ((*given)[0].moved, kCap.value());
  EXPECT_EQ((*given)[0].largest, most);
  const double width = model->sequence.gives[0].width;
  EXPECT_NEAR(most, width, 0.15 * width);
  EXPECT_EQ(Describe((*given)[0]).rfind("bends all around by 0.", 0), 0U);
}

TEST(GivenParts, ADamagedListIsLeftOutOrHasNumbers) {
  const auto model = CompileCap();
  const hvas::testing::TemporaryFolder folder;
  const auto write = [&folder](const session::Json& list, const std::string& name) {
    const auto file = folder / name;
    const auto recorder = session::testing::MakeRecorder(file);
    const std::string text = list.dump();
    const auto bytes = std::as_bytes(std::span(text));
    recorder->AddAttachment({"deformed_parts.json", {bytes.begin(), bytes.end()}});
    EXPECT_TRUE(recorder->Finish().has_value());
    return file;
  };
  const auto sound_file = folder / "sound";
  const auto recorder = session::testing::MakeRecorder(sound_file);
  session::AttachDeformables(model->deformables, recorder.get());
  ASSERT_TRUE(recorder->Finish().has_value());
  const auto bytes = record::Reader::Open(sound_file)->ReadAttachment("deformed_parts.json");
  ASSERT_TRUE(bytes.has_value());
  const auto* text = reinterpret_cast<const char*>(bytes->data());
  const session::Json sound = session::Json::parse(text, text + bytes->size());
  const std::vector<session::Json> values{
      nullptr, "inf", -1, 1e300, session::Json::array({1}), session::Json::object()};
  const std::vector<spatial::Pose> poses = PosesOf(*model->product);
  int tried = 0;
  int left_out = 0;
  for (const auto& [key, unused] : sound[0].items()) {
    for (const session::Json& value : values) {
      SCOPED_TRACE(key + " = " + value.dump());
      session::Json damaged = sound;
      damaged[0][key] = value;
      auto reader = record::Reader::Open(write(damaged, std::to_string(tried++)));
      ASSERT_TRUE(reader.has_value());
      const auto read = session::ReadDeformables(*model->product, &*reader);
      ASSERT_TRUE(read.has_value());
      left_out += read->empty() ? 1 : 0;
      const auto amounts = simulation::CalcDeformations(*model->product, *read, poses);
      for (std::size_t i = 0; i < read->size(); ++i) {
        EXPECT_TRUE(std::isfinite(amounts[i]));
      }
    }
  }
  EXPECT_GT(left_out, 3 * tried / 4);
}

TEST(GivenParts, APictureShowsThePartDeformed) {
  const auto model = CompileCap();
  const product::Product& product = *model->product;
  const Projection projection(product.box_W, 160, 120);
  const auto draw = [&](double amount) {
    std::vector<PictureBody> bodies{{&product.part_of(kCap), spatial::Pose(), std::nullopt, {}}};
    bodies[0].deform = simulation::MakePointMap(model->deformables, {amount}, kCap);
    return DrawPixels(bodies, projection);
  };
  const auto rigid = draw(0);
  EXPECT_FALSE(simulation::MakePointMap(model->deformables, {0}, kCap));
  // Drawn with a map that moves nothing, it is as drawn without one.
  std::vector<PictureBody> bodies{{&product.part_of(kCap), spatial::Pose(), std::nullopt, {}}};
  EXPECT_EQ(DrawPixels(bodies, projection), rigid);
  bodies[0].deform = [](const Vec3& p_B) { return p_B; };
  EXPECT_EQ(DrawPixels(bodies, projection), rigid);
  const auto count = [](const std::vector<std::uint8_t>& pixels) {
    int filled = 0;
    for (std::size_t i = 3; i < pixels.size(); i += 4) {
      filled += pixels[i] > 127 ? 1 : 0;
    }
    return filled;
  };
  const auto wide = draw(2e-3);
  EXPECT_GT(count(wide), count(rigid) + 20);
}

}  // namespace
}  // namespace hvas::evidence
