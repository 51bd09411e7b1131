#include "studio/saved_work.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/check.h"
#include "base/digest.h"
#include "base/parse_json.h"
#include "session/command_json.h"
#include "studio/json_fields.h"
#include "studio/state_folder.h"

namespace hvas::studio {
namespace {

using simulation::PartState;
using simulation::Placement;

constexpr std::uint32_t kWorkVersion = 2;  // The file's format.

Unexpected FailNoSavedWork(const std::filesystem::path& file) {
  return Fail(ErrorCode::kUnreadable, "the file does not contain saved work of the studio",
              file.string(), "delete the file, or start the studio with --fresh");
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

SavedWork MakeSavedWork(const SceneSnapshot& now) {
  HVAS_DEMAND(now.scene != nullptr);
  return {now.scene->file, now.scene->name, now.scene->digest, now.scene->edits, now.state, {}};
}

Result<SavedWork> LoadWork(const std::filesystem::path& file) {
  const auto text = ReadPrivateFile(file);
  if (!text) {
    return Unexpected(text.error());
  }
  const Json json = ParseJson<Json>(*text);
  const auto list_at = [&json](const char* name) {
    return json.contains(name) && json[name].is_array() ? json[name] : Json();
  };
  if (!json.is_object() || IndexOr(json, "version", 0) != kWorkVersion ||
      list_at("edits").is_null() || list_at("parts").is_null()) {
    return FailNoSavedWork(file);
  }
  SavedWork work;
  work.file = TextOr(json, "file", "");
  work.name = TextOr(json, "name", "");
  work.digest = TextOr(json, "digest", "");
  work.state.next_step = IndexOr(json, "next_step", 0);
  work.edits = list_at("edits").get<std::vector<Json>>();
  if (const Json notes = list_at("notes"); !notes.is_null()) {
    work.notes = notes.get<std::vector<Json>>();
  }
  auto parts = session::ParseParts(list_at("parts"));
  const auto is_held = [](const PartState& part) { return part.placement == Placement::kHeld; };
  if (!parts || std::any_of(parts->begin(), parts->end(), is_held)) {
    return FailNoSavedWork(file);
  }
  work.state.parts = std::move(*parts);
  return work;
}

void BackUpWork(const std::filesystem::path& file) {
  std::error_code ignored;  // there may be no file
  std::filesystem::rename(file, file.string() + ".before", ignored);
}

Result<void> SaveWork(const std::filesystem::path& file, const SavedWork& work) {
  const Json json{{"version", kWorkVersion},
                  {"file", work.file.string()},
                  {"name", work.name},
                  {"digest", work.digest},
                  {"next_step", work.state.next_step},
                  {"edits", work.edits},
                  {"parts", session::MakePartsJson(work.state.parts)},
                  {"notes", work.notes}};
  return WriteAtomically(file, json.dump(-1, ' ', false, Json::error_handler_t::replace),
                         FileReaders::kOwner);
}

}  // namespace hvas::studio
