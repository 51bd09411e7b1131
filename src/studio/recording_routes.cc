#include "studio/recording_routes.h"

#include <algorithm>
#include <utility>

#include "studio/recording.h"

namespace hvas::studio {
namespace {

using Json = nlohmann::ordered_json;

Result<RecordingAnswer> Answer(const char* type, Result<std::string> bytes) {
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  return RecordingAnswer{type, std::move(*bytes), std::nullopt};
}

std::string TextOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Result<RecordingAnswer> AnswerRecording(RecordingShelf* shelf, std::string_view path) {
  constexpr const char* kJson = "application/json";
  constexpr std::string_view kOne = "/api/recording/";
  if (path == "/api/recordings") {
    return Answer(kJson, TextOf(shelf->List()));
  }
  if (path.starts_with(kOne)) {
    const std::string_view rest = path.substr(kOne.size());
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string id(rest.substr(0, slash));
    const std::string_view what = rest.substr(slash);
    if (what.empty()) {
      const auto description = shelf->Describe(id);
      return description ? Answer(kJson, TextOf(*description)) : Unexpected(description.error());
    }
    if (what == "/frames") {
      return Answer("application/octet-stream", shelf->ReadFrames(id));
    }
    if (what == "/scene") {
      return Answer(kJson, shelf->ReadAttachment(id, kSceneAttachment));
    }
    if (what == "/model.glb") {
      return Answer("model/gltf-binary", shelf->ReadAttachment(id, kGlbAttachment));
    }
    if (what == "/file") {
      const auto file = shelf->Find(id);
      return file ? Result<RecordingAnswer>({"application/vnd.sqlite3", "", *file})
                  : Unexpected(file.error());
    }
  }
  return Fail(ErrorCode::kNotFound, "there is nothing here", std::string(path), "");
}

}  // namespace hvas::studio
