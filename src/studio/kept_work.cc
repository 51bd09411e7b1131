#include "studio/kept_work.h"

#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/digest.h"
#include "studio/event_json.h"
#include "studio/json_fields.h"
#include "studio/kept_folder.h"

namespace hvas::studio {
namespace {

using simulation::PartState;
using simulation::Placement;

constexpr std::uint32_t kWorkVersion = 1;
/** Of a quaternion that was written to the last digit. */
constexpr double kUnitTolerance = 1e-9;

Unexpected NotKeptWork(const std::filesystem::path& file) {
  return Fail(ErrorCode::kUnreadable, "this is not what a studio keeps of its work", file.string(),
              "delete the file, or start the studio with --fresh");
}

template <std::size_t kCount>
std::optional<std::array<double, kCount>> NumbersAt(const Json& object, const char* name) {
  if (!object.is_object() || !object.contains(name) || !object[name].is_array() ||
      object[name].size() != kCount) {
    return std::nullopt;
  }
  std::array<double, kCount> numbers{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const Json& number = object[name][i];
    numbers[i] = number.is_number() ? number.get<double>() : std::nan("");
    if (!std::isfinite(numbers[i])) {
      return std::nullopt;
    }
  }
  return numbers;
}

std::optional<PartState> ParsePart(const Json& json) {
  const auto p = NumbersAt<3>(json, "p");
  const auto q = NumbersAt<4>(json, "q");
  const std::string placement = TextOr(json, "placement", "");
  if (!p || !q) {
    return std::nullopt;
  }
  const Quat q_WB((*q)[0], (*q)[1], (*q)[2], (*q)[3]);
  if (!(std::abs(q_WB.norm() - 1) < kUnitTolerance)) {
    return std::nullopt;
  }
  const spatial::Pose X_WB(q_WB, Vec3((*p)[0], (*p)[1], (*p)[2]));
  for (const Placement one : {Placement::kLoose, Placement::kPlaced, Placement::kParked}) {
    if (placement == ToString(one)) {
      return PartState{one, X_WB};
    }
  }
  return std::nullopt;
}

}  // namespace

std::string CalcProductDigest(const product::Product& product) {
  Digest digest;
  for (const product::Occurrence& occurrence : product.occurrences) {
    const product::Part& part = product.part_of(occurrence.id);
    digest.AddText(occurrence.path);
    digest.AddInt(static_cast<std::int64_t>(part.mesh.vertices.size()));
    digest.AddDouble(part.mass.mass);
    for (const Vec3& p : {occurrence.X_WB.p(), part.box_B.low, part.box_B.high}) {
      for (const double number : p) {
        digest.AddDouble(number);
      }
    }
  }
  for (const product::Mate& mate : product.mates) {
    digest.AddText(mate.key);
    digest.AddText(mate.fit ? mate.fit->code : "");
  }
  return digest.Hex();
}

KeptWork MakeKeptWork(const SceneNow& now) {
  return {now.scene->file, now.scene->name, now.scene->digest, now.scene->edits, now.state};
}

Result<KeptWork> LoadWork(const std::filesystem::path& file) {
  const auto text = ReadKeptFile(file);
  if (!text) {
    return Unexpected(text.error());
  }
  const Json json = Json::parse(*text, nullptr, false);
  const auto list_at = [&json](const char* name) {
    return json.contains(name) && json[name].is_array() ? json[name] : Json();
  };
  if (!json.is_object() || IndexOr(json, "version", 0) != kWorkVersion ||
      list_at("edits").is_null() || list_at("parts").is_null()) {
    return NotKeptWork(file);
  }
  KeptWork work;
  work.file = TextOr(json, "file", "");
  work.name = TextOr(json, "name", "");
  work.digest = TextOr(json, "digest", "");
  work.state.next_step = IndexOr(json, "next_step", 0);
  work.edits = list_at("edits").get<std::vector<Json>>();
  for (const Json& one : list_at("parts")) {
    const auto part = ParsePart(one);
    if (!part) {
      return NotKeptWork(file);
    }
    work.state.parts.push_back(*part);
  }
  return work;
}

void SetWorkAside(const std::filesystem::path& file) {
  std::error_code ignored;  // there may be none
  std::filesystem::rename(file, file.string() + ".before", ignored);
}

Result<void> SaveWork(const std::filesystem::path& file, const KeptWork& work) {
  Json parts = Json::array();
  for (const PartState& part : work.state.parts) {
    Json json = ToJson(part.X_WB);
    json["placement"] = ToString(part.placement);
    parts.push_back(std::move(json));
  }
  const Json json{
      {"version", kWorkVersion},  {"file", work.file.string()},        {"name", work.name},
      {"digest", work.digest},    {"next_step", work.state.next_step}, {"edits", work.edits},
      {"parts", std::move(parts)}};
  return WriteAtomically(file, json.dump(-1, ' ', false, Json::error_handler_t::replace),
                         FileReaders::kOwner);
}

}  // namespace hvas::studio
