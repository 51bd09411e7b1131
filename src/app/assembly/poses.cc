#include "app/assembly/poses.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "base/units.h"
#include "mates/assignments.h"
#include "mates/located_json.h"
#include "record/reader.h"

namespace hvas::app {
namespace {

using Json = nlohmann::ordered_json;
using product::OccurrenceId;
using product::Product;
using spatial::Pose;

constexpr const char* kFormat = "hvas-poses-1";
constexpr const char* kRemedy = "see data/schemas/poses.schema.json";
constexpr double kFarthest = 1e4;        // [m]; further away is a slip of the unit: a choice.
constexpr double kNormTolerance = 1e-6;  // Of a quaternion that people wrote.

using Poses = std::map<OccurrenceId, Pose>;

/** N numbers within limits; nothing where there is something else. */
template <std::size_t N>
std::optional<std::array<double, N>> ReadNumbers(const Json& json, double most) {
  if (!json.is_array() || json.size() != N) {
    return std::nullopt;
  }
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!json[i].is_number() || !(std::abs(json[i].get<double>()) <= most)) {
      return std::nullopt;
    }
    numbers[i] = json[i].get<double>();
  }
  return numbers;
}

std::optional<Vec3> ReadPosition(const Json& json, double unit) {
  const auto p = ReadNumbers<3>(json, kFarthest / unit);
  return p ? std::optional<Vec3>(unit * Vec3((*p)[0], (*p)[1], (*p)[2])) : std::nullopt;
}

std::optional<Quat> ReadRotation(const Json& json) {
  const auto q = ReadNumbers<4>(json, 1 + kNormTolerance);
  if (!q) {
    return std::nullopt;
  }
  const Quat rotation((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  return std::abs(rotation.norm() - 1) <= kNormTolerance ? std::optional(rotation.normalized())
                                                         : std::nullopt;
}

/** By name, path, end of path, or number as in "o12". */
Result<OccurrenceId> Find(const Product& product, const std::string& name) {
  std::uint32_t number = 0;
  const char* end = name.data() + name.size();
  if (name.size() > 1 && name.front() == 'o') {
    const auto [stop, error] = std::from_chars(name.data() + 1, end, number);
    if (error == std::errc() && stop == end && number < product.occurrences.size()) {
      return OccurrenceId(number);
    }
  }
  return mates::FindOccurrence(product, name);
}

/** One entry of a pose file. @returns what is wrong with it and with which key, if anything. */
std::optional<std::pair<std::string, std::string>> ReadEntry(const Json& entry,
                                                             const Product& product, Poses* poses) {
  using FailEntry = std::pair<std::string, std::string>;
  if (!entry.is_object() || !entry.contains("occurrence") || !entry["occurrence"].is_string()) {
    return FailEntry("", "an entry needs \"occurrence\", with a text");
  }
  for (const auto& [key, value] : entry.items()) {
    if (key != "occurrence" && key != "position_mm" && key != "rotation_wxyz" && key != "note") {
      return FailEntry("/" + key, fmt::format("an entry has no key \"{}\"", key));
    }
  }
  const auto id = Find(product, entry["occurrence"].get<std::string>());
  if (!id) {
    return FailEntry("/occurrence", id.error().message);
  }
  const Pose& drawn = product.occurrences[id->index()].X_WB;
  std::optional<Vec3> p = drawn.p();
  std::optional<Quat> q = drawn.q();
  if (entry.contains("position_mm") &&
      !(p = ReadPosition(entry["position_mm"], units::kMetresPerMillimetre))) {
    return FailEntry("/position_mm", "\"position_mm\" needs three numbers of at most 1e7");
  }
  if (entry.contains("rotation_wxyz") && !(q = ReadRotation(entry["rotation_wxyz"]))) {
    return FailEntry("/rotation_wxyz", "\"rotation_wxyz\" needs a quaternion of length 1");
  }
  if (!poses->emplace(*id, Pose(*q, *p)).second) {
    return FailEntry("/occurrence",
                     fmt::format("\"{}\" occurs twice", product.occurrences[id->index()].path));
  }
  return std::nullopt;
}

Result<Poses> ReadPoseFile(std::string_view text, const std::string& name, const Product& product) {
  const auto document = mates::ParseLocatedJson(text, name);
  if (!document) {
    return Unexpected(document.error());
  }
  const auto fail = [&](const std::string& pointer, const std::string& message) {
    return Fail(ErrorCode::kInvalid, message, fmt::format("{}:{}", name, document->LineOf(pointer)),
                kRemedy);
  };
  const Json& root = document->root;
  if (!root.is_object() || !root.contains("format") || root["format"] != kFormat) {
    return fail("/format",
                fmt::format("the file is not a pose file: its \"format\" is not \"{}\"", kFormat));
  }
  if (!root.contains("poses") || !root["poses"].is_array()) {
    return fail("/poses", "\"poses\" needs a list");
  }
  Poses poses;
  for (std::size_t i = 0; i < root["poses"].size(); ++i) {
    if (const auto wrong = ReadEntry(root["poses"][i], product, &poses)) {
      return fail(fmt::format("/poses/{}{}", i, wrong->first), wrong->second);
    }
  }
  return poses;
}

/** The events of a record, and the parts that it speaks of. */
struct RecordedEvents {
  std::vector<record::Event> events;
  std::map<std::uint32_t, OccurrenceId> ids;  // By their numbers in the record.
  bool is_disassembly{false};
};

Result<RecordedEvents> ReadRecordedEvents(const std::filesystem::path& file,
                                          const Product& product) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const record::Meta& meta = reader->meta();
  auto ids = MatchParts(meta, file.filename().string(), product);
  if (!ids) {
    return Unexpected(ids.error());
  }
  auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  const auto task = meta.find("task");
  return RecordedEvents{std::move(*events), std::move(*ids),
                        task != meta.end() && task->second == "disassembly"};
}

/** Where a part was let go, by its event. */
Result<Pose> ReadDrop(const record::Event& event, const std::string& name) {
  const Json details = ParseJson<Json>(event.json);
  const auto read = [&](const char* key) {
    return details.is_object() && details.contains(key) ? details[key] : Json();
  };
  const auto p = ReadPosition(read("position_m"), 1);
  const auto q = ReadRotation(read("rotation_wxyz"));
  if (!p || !q) {
    return Fail(ErrorCode::kUnreadable, "the record does not contain where parts were released",
                name, "record the session again");
  }
  return Pose(*q, *p);
}

Result<Poses> ReadRecord(const std::filesystem::path& file, const Product& product) {
  const auto record = ReadRecordedEvents(file, product);
  if (!record) {
    return Unexpected(record.error());
  }
  Poses poses;
  for (const record::Event& event : record->events) {
    const auto id = record->ids.find(event.occurrence);
    if (event.kind != "dropped" || id == record->ids.end()) {
      continue;
    }
    const auto pose = ReadDrop(event, file.filename().string());
    if (!pose) {
      return Unexpected(pose.error());
    }
    poses[id->second] = *pose;
  }
  return poses;
}

/** Where the file has an occurrence. */
const Pose& DrawnPose(const Product& product, OccurrenceId id) {
  const std::vector<Pose>& drawn = product.placement.drawn_poses;
  return drawn.empty() ? product.occurrences[id.index()].X_WB : drawn[id.index()];
}

/** Moves all bodies of the file that an occurrence is made of. */
void AddMotion(const product::Occurrence& occurrence, const Pose& motion,
               cad::PartMotions* motions) {
  if (occurrence.bodies.empty()) {
    motions->emplace_back(occurrence.path, motion);
  }
  for (const std::string& path : occurrence.bodies) {
    motions->emplace_back(path, motion);
  }
}

}  // namespace

cad::PartMotions ListPlacedMotions(const Product& product) {
  cad::PartMotions motions;
  for (const product::Occurrence& occurrence : product.occurrences) {
    const Pose motion = occurrence.X_WB * DrawnPose(product, occurrence.id).Inverse();
    constexpr double kMoved = 1e-12;  // [m], and [rad]: rounding.
    if (motion.p().norm() > kMoved || spatial::RotationVector(motion.q()).norm() > kMoved) {
      AddMotion(occurrence, motion, &motions);
    }
  }
  return motions;
}

Result<std::map<std::uint32_t, OccurrenceId>> MatchParts(const record::Meta& meta,
                                                         const std::string& name,
                                                         const Product& product) {
  const auto found = meta.find("model_json");
  const Json parts = ParseJson<Json>(found != meta.end() ? found->second : "");
  std::map<std::string_view, OccurrenceId> by_path;
  for (const product::Occurrence& occurrence : product.occurrences) {
    by_path.emplace(occurrence.path, occurrence.id);
  }
  std::map<std::uint32_t, OccurrenceId> ids;
  for (const Json& part : parts.is_array() ? parts : Json::array()) {
    const bool is_known = part.is_object() && part.contains("path") && part["path"].is_string() &&
                          part.contains("id") && part["id"].is_number_unsigned();
    const std::string path = is_known ? part["path"].get<std::string>() : std::string();
    const auto at = by_path.find(path);
    if (!is_known || at == by_path.end() || !part.contains("shape_hash") ||
        part["shape_hash"] != product.part_of(at->second).shape_hash) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("the record belongs to another product: {} has no part \"{}\"",
                              product.source, path),
                  name, "export the file that was assembled in the session");
    }
    ids[part["id"].get<std::uint32_t>()] = at->second;
  }
  return ids;
}

Result<cad::PartMotions> ApplyPoses(const std::filesystem::path& file, Product* product) {
  const Result<cad::MappedFile> bytes = cad::MappedFile::Open(file);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  const std::string_view text(reinterpret_cast<const char*>(bytes->bytes().data()),
                              bytes->bytes().size());
  const auto poses = text.starts_with("SQLite format 3")
                         ? ReadRecord(file, *product)
                         : ReadPoseFile(text, file.filename().string(), *product);
  if (!poses) {
    return Unexpected(poses.error());
  }
  cad::PartMotions motions;
  for (const auto& [id, X_WB] : *poses) {
    product::Occurrence& occurrence = product->occurrences[id.index()];
    AddMotion(occurrence, X_WB * DrawnPose(*product, id).Inverse(), &motions);
    occurrence.X_WB = X_WB;
  }
  product->box_W = {};
  for (const product::Occurrence& occurrence : product->occurrences) {
    for (const Vec3& vertex : product->part_of(occurrence.id).mesh.vertices) {
      product->box_W.Add(occurrence.X_WB * vertex);
    }
  }
  return motions;
}

Result<std::map<OccurrenceId, Pose>> ReadPosesBeside(const std::filesystem::path& file,
                                                     const Product& product, std::int64_t t_ns) {
  const auto record = ReadRecordedEvents(file, product);
  if (!record) {
    return Unexpected(record.error());
  }
  Poses poses;
  for (const auto& [number, id] : record->ids) {
    poses[id] = product.occurrences[id.index()].X_WB;
  }
  // The first event of a part says where it was before.
  std::set<OccurrenceId> moved;
  for (const record::Event& event : record->events) {
    const auto id = record->ids.find(event.occurrence);
    if (id == record->ids.end()) {
      continue;
    }
    const bool is_later = event.t_ns >= t_ns;
    if (event.kind == "taken" && moved.insert(id->second).second && is_later &&
        !record->is_disassembly) {
      poses.erase(id->second);  // it is on the table until then
    }
    if (event.kind == "dropped" && !is_later) {
      const auto pose = ReadDrop(event, file.filename().string());
      if (!pose) {
        return Unexpected(pose.error());
      }
      poses[id->second] = *pose;
    }
  }
  return poses;
}

}  // namespace hvas::app
