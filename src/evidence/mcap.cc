// What of a record goes into an MCAP file: channels of Foxglove's schemas, and one of our own.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "evidence/demonstrations.h"
#include "evidence/mcap_writer.h"
#include "evidence/session_data.h"
#include "evidence/tables.h"
#include "haptics/constraint_solver.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;
using Json = nlohmann::ordered_json;

std::string Dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json NumberSchema(const char* description) {
  return {{"type", "number"}, {"description", description}};
}

Json MakeTickSchema() {
  return {{"type", "object"},
          {"title", "hvas.Tick"},
          {"properties",
           {{"part", {{"type", "string"}}},
            {"state", NumberSchema("0 empty .. 5 seated")},
            {"true_n", NumberSchema("true force [N]")},
            {"felt_n", NumberSchema("force rendered to the hand [N]")},
            {"felt_x_n", NumberSchema("[N]")},
            {"felt_y_n", NumberSchema("[N]")},
            {"felt_z_n", NumberSchema("[N]")},
            {"felt_nm", NumberSchema("torque rendered to the hand [N m]")},
            {"insertion_mm", NumberSchema("depth of insertion [mm]")},
            {"contacts", NumberSchema("that press")},
            {"status", NumberSchema("bit mask of the safety gate")}}}};
}

Json MakeTickMessage(const TickRecord& tick, const std::vector<std::string>& paths) {
  return {{"part", tick.held == record::kNoOccurrence ? "" : NameOf(paths, tick.held)},
          {"state", tick.state},
          {"true_n", tick.F_true_W.f.norm()},
          {"felt_n", tick.F_felt_W.f.norm()},
          {"felt_x_n", tick.F_felt_W.f.x()},
          {"felt_y_n", tick.F_felt_W.f.y()},
          {"felt_z_n", tick.F_felt_W.f.z()},
          {"felt_nm", tick.F_felt_W.t.norm()},
          {"insertion_mm", 1e3 * tick.depth},
          {"contacts", tick.contact_count},
          {"status", tick.status}};
}

Json MakeTimeJson(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;  // A definition.
  return {{"sec", t_ns / kSecond_ns}, {"nsec", t_ns % kSecond_ns}};
}

/** foxglove.FrameTransform */
Json MakeTransform(std::int64_t t_ns, const std::string& child, const spatial::Pose& X_WB) {
  const Quat& q = X_WB.q();
  return {{"timestamp", MakeTimeJson(t_ns)},
          {"parent_frame_id", "world"},
          {"child_frame_id", child},
          {"translation", {{"x", X_WB.p().x()}, {"y", X_WB.p().y()}, {"z", X_WB.p().z()}}},
          {"rotation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

Json MakeTransforms(const TickRecord& tick, const std::vector<std::string>& paths) {
  Json list = Json::array();
  list.push_back(MakeTransform(tick.t_ns, "hand" + std::to_string(tick.hand), tick.X_WH));
  if (tick.held != record::kNoOccurrence) {
    list.push_back(MakeTransform(tick.t_ns, NameOf(paths, tick.held), tick.X_WD));
  }
  return {{"transforms", std::move(list)}};
}

/** foxglove.Log */
Json MakeLog(const record::Event& event, const std::vector<std::string>& paths) {
  // Levels as the schema of foxglove.Log numbers them.
  constexpr int kInfo = 2;
  constexpr int kWarning = 3;
  const bool is_odd = event.kind == "safety" || event.kind == "device" || event.kind == "flight";
  const std::string part =
      event.occurrence == record::kNoOccurrence ? "" : NameOf(paths, event.occurrence) + " ";
  // The table of a flight is too long for a line of a log.
  return {{"timestamp", MakeTimeJson(event.t_ns)},
          {"level", is_odd ? kWarning : kInfo},
          {"name", event.kind},
          {"message", event.kind + " " + part + (event.kind == "flight" ? "" : event.json)},
          {"file", ""},
          {"line", 0}};
}

Json MakeSampleSchema() {
  return {{"type", "object"},
          {"title", "hvas.Demonstration"},
          {"properties",
           {{"demonstration", NumberSchema("counted from 0")},
            {"part", {{"type", "string"}}},
            {"source", {{"enum", {"record", "plan"}}}},
            {"seated", {{"type", "boolean"}, {"description", "it ends in its place"}}},
            {"t_s", NumberSchema("session time [s]")},
            {"to_goal_m", NumberSchema("distance of the part's origin from its place [m]")},
            {"felt_n", NumberSchema("force on the hand [N]")},
            {"insertion_mm", NumberSchema("depth of insertion [mm]")}}}};
}

}  // namespace

// One after the other, from time 0 on, with a pause between two.
Result<void> WriteMcap(const std::vector<Demonstration>& demonstrations,
                       const std::filesystem::path& file) {
  constexpr std::int64_t kPause_ns = 1'000'000'000;  // A choice.
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  McapWriter writer(&*output);
  const std::uint16_t samples =
      writer.AddChannel("/demonstration", "hvas.Demonstration", Dump(MakeSampleSchema()));
  const std::uint16_t transforms =
      writer.AddChannel("/tf", "foxglove.FrameTransforms", Dump({{"type", "object"}}));
  std::int64_t begin_ns = 0;
  std::int64_t t_ns = 0;
  for (std::size_t i = 0; i < demonstrations.size(); ++i) {
    const Demonstration& demonstration = demonstrations[i];
    for (const DemonstrationSample& sample : demonstration.samples) {
      t_ns = begin_ns + std::llround(1e9 * (sample.t - demonstration.samples.front().t));
      const Json message{{"demonstration", i},
                         {"part", demonstration.part},
                         {"source", demonstration.source},
                         {"seated", demonstration.is_seated},
                         {"t_s", sample.t},
                         {"to_goal_m", (sample.X_WB.p() - demonstration.X_WB_goal.p()).norm()},
                         {"felt_n", sample.F_felt_W.f.norm()},
                         {"insertion_mm", 1e3 * sample.insertion}};
      writer.Add(samples, t_ns, Dump(message));
      Json list = Json::array();
      list.push_back(MakeTransform(t_ns, "hand", sample.X_WH));
      list.push_back(MakeTransform(t_ns, demonstration.part, sample.X_WB));
      list.push_back(
          MakeTransform(t_ns, demonstration.part + " in its place", demonstration.X_WB_goal));
      writer.Add(transforms, t_ns, Dump({{"transforms", std::move(list)}}));
    }
    begin_ns = t_ns + kPause_ns;
  }
  writer.Finish();
  return output->Finish();
}

Result<void> WriteMcap(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file) {
  auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  // In the order of their times, as readers without an index expect it.
  std::stable_sort(events->begin(), events->end(),
                   [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  const std::vector<std::string> paths = ReadPaths(*reader);
  McapWriter writer(&*output);
  const std::string any = Dump({{"type", "object"}});
  const std::string tick_schema = Dump(MakeTickSchema());
  std::array<std::uint16_t, haptics::kMaxHands> hands{};  // Channels; 0: none yet.
  const auto channel_of = [&](std::size_t hand) {
    if (hands[hand] == 0) {
      hands[hand] = writer.AddChannel(fmt::format("/hand{}", hand), "hvas.Tick", tick_schema);
    }
    return hands[hand];
  };
  (void)channel_of(0);
  (void)channel_of(1);  // Readers may expect both, as records had two hands at most.
  const std::uint16_t transforms = writer.AddChannel("/tf", "foxglove.FrameTransforms", any);
  const std::uint16_t log = writer.AddChannel("/events", "foxglove.Log", any);
  std::size_t next = 0;
  const auto add_events_until = [&](std::int64_t t_ns) {
    for (; next < events->size() && (*events)[next].t_ns <= t_ns; ++next) {
      writer.Add(log, (*events)[next].t_ns, Dump(MakeLog((*events)[next], paths)));
    }
  };
  const Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    add_events_until(tick.t_ns);
    writer.Add(channel_of(HandOf(tick)), tick.t_ns, Dump(MakeTickMessage(tick, paths)));
    writer.Add(transforms, tick.t_ns, Dump(MakeTransforms(tick, paths)));
  });
  add_events_until(selection.span.last_ns);
  writer.Finish();
  return done ? output->Finish() : done;
}

}  // namespace hvas::evidence
