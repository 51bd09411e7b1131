// MCAP (https://mcap.dev/spec): records of an opcode, their length and their content, one after the
// other, without chunks; everything little-endian, texts behind their length.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

#include "base/bytes.h"
#include "evidence/output_file.h"
#include "evidence/tables.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;
using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kDataEnd = 0x0f,
};

/** Content of a record. */
class Content {
 public:
  template <typename T>
  Content& Number(T value) {
    writer_.Plain(&value, 1);
    return *this;
  }

  Content& Text(std::string_view text) {
    Number(static_cast<std::uint32_t>(text.size()));
    return Raw(text);
  }

  Content& Raw(std::string_view text) {
    writer_.Plain(text.data(), text.size());
    return *this;
  }

  [[nodiscard]] std::string_view bytes() {
    const auto& bytes = writer_.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

 private:
  ByteWriter writer_;
};

class McapWriter {
 public:
  explicit McapWriter(OutputFile* output) : output_(output) {
    output_->Write(kMagic);
    Write(Opcode::kHeader, Content().Text("").Text("hvas"));
  }

  /** Returns the channel's number. */
  std::uint16_t AddChannel(std::string_view topic, std::string_view schema_name,
                           const Json& schema) {
    const std::uint16_t number = ++channels_;  // of both: 0 is no schema
    Write(Opcode::kSchema,
          Content().Number(number).Text(schema_name).Text("jsonschema").Text(schema.dump()));
    Write(Opcode::kChannel, Content().Number(number).Number(number).Text(topic).Text("json").Number(
                                std::uint32_t{0}));
    return number;
  }

  void Add(std::uint16_t channel, std::int64_t t_ns, const Json& message) {
    const auto t = static_cast<std::uint64_t>(t_ns);
    Write(Opcode::kMessage, Content()
                                .Number(channel)
                                .Number(sequence_++)
                                .Number(t)
                                .Number(t)
                                .Raw(message.dump(-1, ' ', false, Json::error_handler_t::replace)));
  }

  void Finish() {
    Write(Opcode::kDataEnd, Content().Number(std::uint32_t{0}));  // without a checksum
    Write(Opcode::kFooter,
          Content().Number(std::uint64_t{0}).Number(std::uint64_t{0}).Number(std::uint32_t{0}));
    output_->Write(kMagic);
  }

 private:
  void Write(Opcode opcode, Content& content) {
    Content head;
    head.Number(opcode).Number(static_cast<std::uint64_t>(content.bytes().size()));
    output_->Write(head.bytes());
    output_->Write(content.bytes());
  }

  OutputFile* output_;
  std::uint16_t channels_{0};
  std::uint32_t sequence_{0};
};

Json NumberSchema(const char* description) {
  return {{"type", "number"}, {"description", description}};
}

Json MakeTickSchema() {
  return {{"type", "object"},
          {"title", "hvas.Tick"},
          {"properties",
           {{"part", {{"type", "string"}}},
            {"state", NumberSchema("0 empty .. 5 seated")},
            {"true_n", NumberSchema("force as physics has it [N]")},
            {"felt_n", NumberSchema("force given to the hand [N]")},
            {"felt_x_n", NumberSchema("[N]")},
            {"felt_y_n", NumberSchema("[N]")},
            {"felt_z_n", NumberSchema("[N]")},
            {"felt_nm", NumberSchema("torque given to the hand [N m]")},
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
  constexpr std::int64_t kSecond = 1'000'000'000;
  return {{"sec", t_ns / kSecond}, {"nsec", t_ns % kSecond}};
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

}  // namespace

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
  const Json any{{"type", "object"}};
  const std::array<std::uint16_t, 2> hands{
      writer.AddChannel("/hand0", "hvas.Tick", MakeTickSchema()),
      writer.AddChannel("/hand1", "hvas.Tick", MakeTickSchema())};
  const std::uint16_t transforms = writer.AddChannel("/tf", "foxglove.FrameTransforms", any);
  const std::uint16_t log = writer.AddChannel("/events", "foxglove.Log", any);
  std::size_t next = 0;
  const auto add_events_until = [&](std::int64_t t_ns) {
    for (; next < events->size() && (*events)[next].t_ns <= t_ns; ++next) {
      writer.Add(log, (*events)[next].t_ns, MakeLog((*events)[next], paths));
    }
  };
  const Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    add_events_until(tick.t_ns);
    writer.Add(hands[tick.hand == 0 ? 0 : 1], tick.t_ns, MakeTickMessage(tick, paths));
    writer.Add(transforms, tick.t_ns, MakeTransforms(tick, paths));
  });
  add_events_until(selection.span.last_ns);
  writer.Finish();
  return done ? output->Finish() : done;
}

}  // namespace hvas::evidence
