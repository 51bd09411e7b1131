// CSV and JSON.

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "evidence/given_parts.h"
#include "evidence/output_file.h"
#include "evidence/tables.h"
#include "session/recorded_model.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;
using Json = nlohmann::ordered_json;

/** Meta without what is told elsewhere. */
Json MakeMetaJson(const record::Reader& reader) {
  Json json = Json::object();
  for (const auto& [key, value] : reader.meta()) {
    if (key != "model_json") {
      json[key] = value;
    }
  }
  return json;
}

/** Parts that gave in the span: how far at most; empty where none did, or the record has no
 * product.
 */
Result<Json> MakeGives(record::Reader* reader, const record::Reader::Span& span) {
  const auto product = session::FindProduct(reader);
  Json list = Json::array();
  if (!product || !*product) {
    return list;  // The export of the ticks needs none.
  }
  const auto given = FindGivenParts(reader, span, **product);
  if (!given) {
    return Unexpected(given.error());
  }
  for (const GivenPart& part : *given) {
    list.push_back({{"occurrence", part.occurrence},
                    {"moved", part.moved},
                    {"kind", simulation::ToString(part.kind)},
                    {"largest_m", part.largest},
                    {"text", Describe(part)}});
  }
  return list;
}

Result<std::string> MakeHead(record::Reader* reader, const record::Reader::Span& span) {
  auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  Json columns = Json::array();
  for (const Column& column : TickColumns()) {
    columns.push_back(
        {{"name", column.name}, {"unit", column.unit}, {"description", column.description}});
  }
  Json list = Json::array();
  for (const record::Event& event : *events) {
    Json item{{"time_s", 1e-9 * static_cast<double>(event.t_ns)}, {"kind", event.kind}};
    if (event.occurrence != record::kNoOccurrence) {
      item["occurrence"] = event.occurrence;
    }
    Json details = ParseJson<Json>(event.json.empty() ? "{}" : event.json);
    item["details"] = details.is_discarded() ? Json(event.json) : std::move(details);
    list.push_back(std::move(item));
  }
  auto gives = MakeGives(reader, span);
  if (!gives) {
    return Unexpected(gives.error());
  }
  Json head{{"format", "hvas-session-1"},    {"complete", reader->is_complete()},
            {"meta", MakeMetaJson(*reader)}, {"parts", ReadPaths(*reader)},
            {"events", std::move(list)},     {"columns", std::move(columns)}};
  if (!gives->empty()) {
    head["gives"] = std::move(*gives);
  }
  return head.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Result<void> WriteCsv(record::Reader* reader, const Selection& selection,
                      const std::filesystem::path& file) {
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  std::string line;
  for (const Column& column : TickColumns()) {
    line += (line.empty() ? "" : ",") + std::string(column.name);
  }
  output->Write(line + "\n");
  const Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    line.clear();
    for (const Column& column : TickColumns()) {
      const double value = column.get(tick);
      // What is not finite is an empty cell, which spreadsheets take for none.
      line += std::isfinite(value) ? fmt::format("{},", value) : ",";
    }
    line.back() = '\n';
    output->Write(line);
  });
  return done ? output->Finish() : done;
}

Result<void> WriteJson(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file) {
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  auto head = MakeHead(reader, selection.span);
  if (!head) {
    return Unexpected(head.error());
  }
  head->pop_back();  // the object goes on with the ticks, of which there are many
  output->Write(*head + ",\"ticks\":[");
  const char* separator = "\n";
  std::string row;
  const Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    row = separator;
    row += '[';
    for (const Column& column : TickColumns()) {
      const double value = column.get(tick);
      row += std::isfinite(value) ? fmt::format("{},", value) : "null,";
    }
    row.back() = ']';
    output->Write(row);
    separator = ",\n";
  });
  output->Write("\n]}\n");
  return done ? output->Finish() : done;
}

}  // namespace hvas::evidence
