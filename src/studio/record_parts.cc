#include "studio/record_parts.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/parse_json.h"
#include "record/reader.h"
#include "session/json_values.h"
#include "studio/json.h"

namespace hvas::studio {
namespace {

using session::FlagOr;
using session::IndexOr;
using session::NumberOr;
using session::TextOr;

constexpr std::int64_t kNsPerMs = 1'000'000;  // A definition.

std::string PrintPart(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string TextOf(const record::Meta& meta, const std::string& key) {
  const auto found = meta.find(key);
  return found == meta.end() ? "" : found->second;
}

/** A text for a line of a list: its beginning where it is longer. */
std::string LineOf(const record::Meta& meta, const std::string& key) {
  constexpr std::size_t kLongest = 1000;  // [bytes]: a choice.
  return TextOf(meta, key).substr(0, kLongest);
}

Json Summarise(record::Reader* reader) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(reader->path(), failed);
  const record::Meta& meta = reader->meta();
  const std::string name = LineOf(meta, kNameMeta);
  const std::string product = LineOf(meta, "product");
  const std::int64_t started_ns = std::atoll(TextOf(meta, record::kMetaStarted).c_str());
  return {{"id", reader->path().stem().string()},
          {"name", name.empty() ? product : name},
          {"product", product},
          {"started_unix_ms", started_ns / kNsPerMs},
          {"duration_s", 1e-9 * static_cast<double>(reader->ReadLength().value_or(0))},
          {"is_complete", reader->is_complete()},
          {"bytes", failed ? 0 : bytes}};
}

/** Accumulates the results of each part's holds from the events "dropped". */
class Results {
 public:
  /** @param paths  Of the parts, indexed by occurrence. */
  explicit Results(std::vector<std::string> paths) : paths_(std::move(paths)) {}

  void Add(const Json& dropped) {
    const auto occurrence = IndexOr(dropped, "occurrence", record::kNoOccurrence);
    Json& result = FindOrAdd(occurrence);
    const Json& metrics = dropped.at("metrics");
    const auto add = [&](const char* key, const char* from, double unit) {
      result[key] = result[key].get<double>() + unit * NumberOr(metrics, from, 0);
    };
    const auto keep_largest = [&](const char* key, const char* from) {
      result[key] = std::max(result[key].get<double>(), NumberOr(metrics, from, 0));
    };
    result["is_seated"] = FlagOr(dropped, "was_seated", false);
    add("time_s", "time_s", 1);
    add("path_m", "path_mm", 1e-3);
    add("collisions", "collisions", 1);
    keep_largest("peak_true_n", "peak_true_n");
    keep_largest("peak_felt_n", "peak_felt_n");
    keep_largest("insertion_mm", "insertion_mm");
  }

  [[nodiscard]] Json MakeList() const {
    Json list = Json::array();
    for (const std::uint32_t occurrence : order_) {
      list.push_back(results_.at(occurrence));
    }
    return list;
  }

 private:
  Json& FindOrAdd(std::uint32_t occurrence) {
    const auto found = results_.find(occurrence);
    if (found != results_.end()) {
      return found->second;
    }
    order_.push_back(occurrence);
    return results_[occurrence] = {{"occurrence", occurrence},
                                   {"path", occurrence < paths_.size() ? paths_[occurrence] : ""},
                                   {"is_seated", false},
                                   {"time_s", 0.0},
                                   {"path_m", 0.0},
                                   {"peak_true_n", 0.0},
                                   {"peak_felt_n", 0.0},
                                   {"collisions", 0.0},
                                   {"insertion_mm", 0.0}};
  }

  std::vector<std::string> paths_;
  std::map<std::uint32_t, Json> results_;  ///< By occurrence.
  std::vector<std::uint32_t> order_;       ///< In which parts were dropped first.
};

std::vector<std::string> PathsOf(const record::Meta& meta) {
  std::vector<std::string> paths;
  const Json parts = ParseJson<Json>(TextOf(meta, "model_json"));
  if (parts.is_array()) {
    for (const Json& part : parts) {
      paths.push_back(TextOr(part, "path", ""));
    }
  }
  return paths;
}

Result<std::string> Describe(record::Reader* reader, const RecordLabels& labels) {
  const auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  Json json = Summarise(reader);
  if (!labels.name.empty()) {
    json["name"] = labels.name;
  }
  json["is_shared"] = labels.is_shared;
  const std::string route = "/api/recording/" + json["id"].get<std::string>();
  json["scene"] = route + "/scene";
  json["glb"] = route + "/model.glb";
  json["frames"] = route + "/frames";
  Results results(PathsOf(reader->meta()));
  Json& shown = json["events"] = Json::array();
  for (const record::Event& event : *events) {
    Json one = event.kind == kClientEventKind ? ParseJson<Json>(event.json) : Json();
    if (!one.is_object()) {
      continue;
    }
    if (TextOr(one, "event", "") == "dropped" && one.contains("metrics")) {
      results.Add(one);
    }
    one["t_ns"] = event.t_ns;
    shown.push_back(std::move(one));
  }
  json["results"] = results.MakeList();
  return PrintPart(json);
}

Result<std::string> ReadFrames(record::Reader* reader) {
  constexpr std::size_t kMostBytes = std::size_t{512} << 20;  // Of hours for a page: a choice.
  std::string bytes;
  const auto read = reader->ForEachFrame({}, [&bytes](const record::Frame& frame) {
    bytes.append(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
    return bytes.size() <= kMostBytes;
  });
  if (!read) {
    return Unexpected(read.error());
  }
  if (bytes.size() > kMostBytes) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the frames of the recording have more than {} bytes, the most that a "
                            "page plays",
                            kMostBytes),
                reader->path().string(), "download the recording, and replay it with hvas replay");
  }
  return bytes;
}

Result<std::string> ReadAttachment(record::Reader* reader, const char* name) {
  const auto bytes = reader->ReadAttachment(name);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace

Result<std::string> ReadRecordPart(const std::filesystem::path& file, RecordPart part,
                                   const RecordLabels& labels) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return Unexpected(reader.error());
  }
  switch (part) {
    case RecordPart::kSummary: {
      Json summary = Summarise(&*reader);
      summary["product_digest"] = LineOf(reader->meta(), kProductDigestMeta);
      return PrintPart(summary);
    }
    case RecordPart::kDescription:
      return Describe(&*reader, labels);
    case RecordPart::kFrames:
      return ReadFrames(&*reader);
    case RecordPart::kScene:
      return ReadAttachment(&*reader, kSceneAttachment);
    case RecordPart::kModel:
      return ReadAttachment(&*reader, kGlbAttachment);
  }
  return Fail(ErrorCode::kInternal, "there is no such part of a record", file.string());
}

}  // namespace hvas::studio
