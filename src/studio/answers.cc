#include "studio/answers.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "studio/assets.h"
#include "studio/recording.h"
#include "studio/scene_json.h"

namespace hvas::studio {
namespace {

constexpr const char* kJsonType = "application/json";
constexpr const char* kGlbType = "model/gltf-binary";

Unexpected NothingHere(std::string_view path) {
  return Fail(ErrorCode::kNotFound, "there is nothing here", std::string(path), "");
}

/** Of bytes that nobody else keeps. */
Result<Answer> Own(const char* type, Result<std::string> bytes) {
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  auto kept = std::make_shared<const std::string>(std::move(*bytes));
  Answer answer;
  answer.type = type;
  answer.bytes = *kept;
  answer.owner = std::move(kept);
  return answer;
}

Result<Answer> Own(const Json& json) {
  return Own(kJsonType, json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/** Of a mesh whose path holds its digest. */
Answer MakeGlbAnswer(std::string_view bytes, const std::string& digest,
                     std::shared_ptr<const void> owner) {
  Answer answer;
  answer.type = kGlbType;
  answer.bytes = bytes;
  answer.owner = std::move(owner);
  answer.etag = digest;
  answer.is_immutable = true;
  return answer;
}

Result<Answer> AnswerScene(const Workbench& workbench, bool is_shielded) {
  const SceneNow now = workbench.Look();
  if (now.scene == nullptr) {
    return Fail(ErrorCode::kNotFound, "no product is open", "", "open a file or an example");
  }
  return Own(is_shielded ? MakeShieldedSceneJson(*now.scene, now.state)
                         : MakeSceneJson(*now.scene, now.state));
}

Result<Answer> AnswerModel(const Workbench& workbench, std::string_view name) {
  const auto scene = workbench.scene();
  if (scene == nullptr || name != scene->glb_hash + ".glb") {
    return Fail(ErrorCode::kNotFound, "this model is not open", std::string(name),
                "ask for /api/scene again");
  }
  return MakeGlbAnswer(*scene->glb, scene->glb_hash, scene);
}

Result<Answer> AnswerPath(Workbench* workbench, std::string_view name) {
  const auto swept = workbench->sweeper().Find(name.substr(0, name.find(".glb")));
  if (swept == nullptr || name != swept->id + ".glb") {
    return Fail(ErrorCode::kNotFound, "this swept volume is not kept any more", std::string(name),
                "ask for it again");
  }
  return MakeGlbAnswer(swept->glb, swept->id, swept);
}

/** @param rest  Its id, and what of it. */
Result<Answer> AnswerRecording(RecordingShelf* shelf, std::string_view rest) {
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string id(rest.substr(0, slash));
  const std::string_view what = rest.substr(slash);
  if (what.empty()) {
    const auto description = shelf->Describe(id);
    return description ? Own(*description) : Unexpected(description.error());
  }
  if (what == "/frames") {
    return Own("application/octet-stream", shelf->ReadFrames(id));
  }
  if (what == "/scene") {
    return Own(kJsonType, shelf->ReadAttachment(id, kSceneAttachment));
  }
  if (what == "/model.glb") {
    return Own(kGlbType, shelf->ReadAttachment(id, kGlbAttachment));
  }
  if (what == "/file") {
    auto file = shelf->Find(id);
    if (!file) {
      return Unexpected(file.error());
    }
    Answer answer;
    answer.type = "application/vnd.sqlite3";
    answer.file = std::move(*file);
    return answer;
  }
  return NothingHere(what);
}

}  // namespace

Result<Answer> AnswerAsset(std::string_view path, std::string_view accepted) {
  const Asset* asset = FindAsset(path == "/" ? "/index.html" : path);
  if (asset == nullptr) {
    return NothingHere(path);
  }
  Answer answer;
  answer.type = asset->type;
  answer.bytes = asset->plain;
  answer.etag = asset->etag;
  answer.is_immutable = asset->is_immutable;
  const auto takes = [accepted](std::string_view coding, std::string_view bytes) {
    return accepted.find(coding) != std::string_view::npos && !bytes.empty();
  };
  if (takes("br", asset->brotli)) {
    answer.bytes = asset->brotli;
    answer.encoding = "br";
  } else if (takes("gzip", asset->gzip)) {
    answer.bytes = asset->gzip;
    answer.encoding = "gzip";
  }
  return answer;
}

Result<Answer> AnswerApi(Workbench* workbench, std::string_view path, bool is_shielded) {
  constexpr std::string_view kModel = "/api/model/";
  constexpr std::string_view kPath = "/api/path/";
  constexpr std::string_view kRecording = "/api/recording/";
  if (path == "/api/scene") {
    return AnswerScene(*workbench, is_shielded);
  }
  if (is_shielded && !path.starts_with(kModel)) {
    return NothingHere(path);
  }
  if (path == "/api/recordings") {
    return Own(workbench->shelf().List());
  }
  if (path.starts_with(kModel)) {
    return AnswerModel(*workbench, path.substr(kModel.size()));
  }
  if (path.starts_with(kPath)) {
    return AnswerPath(workbench, path.substr(kPath.size()));
  }
  if (path.starts_with(kRecording)) {
    return AnswerRecording(&workbench->shelf(), path.substr(kRecording.size()));
  }
  return NothingHere(path);
}

std::string DecodePercent(std::string_view path) {
  std::string decoded;
  for (std::size_t i = 0; i < path.size(); ++i) {
    unsigned value = 0;
    const char* begin = path.data() + i + 1;
    if (path[i] == '%' && i + 2 < path.size() &&
        std::from_chars(begin, begin + 2, value, 16).ptr == begin + 2) {
      decoded += static_cast<char>(value);
      i += 2;
    } else {
      decoded += path[i];
    }
  }
  return decoded;
}

std::string NameOfUpload(std::string_view target) {
  constexpr std::string_view kName = "name=";
  constexpr std::size_t kLongestName = 80;  // Letters of a file's name: a choice.
  const std::size_t at = target.find(kName);
  std::string_view given = at == std::string_view::npos ? "" : target.substr(at + kName.size());
  given = given.substr(0, given.find('&'));
  std::string name;
  for (std::size_t i = 0; i < given.size(); ++i) {
    char c = given[i];
    if (c == '%' && i + 2 < given.size()) {
      c = ' ';
      i += 2;
    }
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                          (c >= 'a' && c <= 'z') || c == '.' || c == '-';
    name += is_plain ? c : '_';
  }
  name = name.size() > kLongestName ? name.substr(name.size() - kLongestName) : name;
  return name.empty() || name.front() == '.' ? "upload" + name : name;
}

}  // namespace hvas::studio
