#include "studio/responses.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "studio/assets.h"
#include "studio/gzip.h"
#include "studio/record_parts.h"
#include "studio/scene_json.h"

namespace hvas::studio {
namespace {

constexpr const char* kJsonType = "application/json";
constexpr const char* kGlbType = "model/gltf-binary";
constexpr const char* kGzip = "gzip";

Unexpected FailNotFound(std::string_view path) {
  return Fail(ErrorCode::kNotFound, "there is no such resource", std::string(path), "");
}

/** Makes a response that owns its bytes. */
Result<Response> MakeOwnedResponse(const char* type, Result<std::string> bytes) {
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  auto kept = std::make_shared<const std::string>(std::move(*bytes));
  Response response;
  response.type = type;
  response.bytes = *kept;
  response.owner = std::move(kept);
  return response;
}

Result<Response> MakeOwnedResponse(const Json& json) {
  return MakeOwnedResponse(kJsonType, json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

/** Makes the response for a mesh whose path contains its digest. */
Response MakeGlbResponse(std::string_view bytes, const std::string& digest,
                         std::shared_ptr<const void> owner) {
  Response response;
  response.type = kGlbType;
  response.bytes = bytes;
  response.owner = std::move(owner);
  response.etag = digest;
  response.is_immutable = true;
  return response;
}

/** What is written for this request alone goes compressed to whoever takes it so. */
Result<Response> Compress(Result<Response> made, std::string_view accepted) {
  constexpr std::size_t kLeast = 1024;  // Less fits into one packet of a network: a choice.
  if (made && AcceptsCoding(accepted, kGzip) && made->bytes.size() >= kLeast) {
    const auto packed = std::make_shared<const std::string>(Gzip(made->bytes));
    made->bytes = *packed;
    made->owner = packed;
    made->encoding = kGzip;
  }
  return made;
}

Result<Response> MakeSceneResponse(const LiveScene& live, bool is_shielded,
                                   std::string_view accepted) {
  const SceneSnapshot now = live.MakeSnapshot();
  if (now.scene == nullptr) {
    return Fail(ErrorCode::kNotFound, "no product is open", "", "open a file or an example");
  }
  return Compress(MakeOwnedResponse(is_shielded ? MakeShieldedSceneJson(*now.scene, now.state)
                                                : MakeSceneJson(*now.scene, now.state)),
                  accepted);
}

Result<Response> MakeModelResponse(const LiveScene& live, std::string_view name,
                                   std::string_view accepted) {
  const auto scene = live.scene();
  if (scene == nullptr || name != scene->glb_hash + ".glb") {
    return Fail(ErrorCode::kNotFound, "this model is no longer open", std::string(name),
                "request /api/scene again");
  }
  if (AcceptsCoding(accepted, kGzip)) {
    Response response = MakeGlbResponse(*scene->glb_gzip, scene->glb_hash, scene);
    response.encoding = kGzip;
    return response;
  }
  return MakeGlbResponse(*scene->glb, scene->glb_hash, scene);
}

Result<Response> MakePathResponse(const Sweeper& sweeper, std::string_view name) {
  const auto swept = sweeper.Find(name.substr(0, name.find(".glb")));
  if (swept == nullptr || name != swept->id + ".glb") {
    return Fail(ErrorCode::kNotFound, "this swept volume is no longer available", std::string(name),
                "compute it again");
  }
  return MakeGlbResponse(swept->glb, swept->id, swept);
}

/** @param rest  Path below /api/recordings/: id, and the resource of it. */
Result<Response> MakeRecordingResponse(WorkbenchRecordings* recordings, std::string_view rest,
                                       bool is_owner, const std::stop_token& stop) {
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string id(rest.substr(0, slash));
  RecordingShelf* shelf = &recordings->shelf();
  if (!is_owner && !shelf->IsShared(id, recordings->FindDigest())) {
    return Fail(ErrorCode::kNotFound, "there is no such recording", "", "reload the list");
  }
  const std::string_view what = rest.substr(slash);
  if (what.empty()) {
    return MakeOwnedResponse(kJsonType, shelf->Describe(id, stop));
  }
  if (what == "/frames") {
    return MakeOwnedResponse("application/octet-stream",
                             shelf->Read(id, RecordPart::kFrames, stop));
  }
  if (what == "/scene") {
    return MakeOwnedResponse(kJsonType, shelf->Read(id, RecordPart::kScene, stop));
  }
  if (what == "/model.glb") {
    return MakeOwnedResponse(kGlbType, shelf->Read(id, RecordPart::kModel, stop));
  }
  if (what == "/file") {
    auto file = shelf->Find(id);
    if (!file) {
      return Unexpected(file.error());
    }
    Response response;
    response.type = "application/vnd.sqlite3";
    response.file = std::move(*file);
    return response;
  }
  return FailNotFound(what);
}

}  // namespace

Result<Response> MakeAssetResponse(std::string_view path, std::string_view accepted) {
  const Asset* asset = FindAsset(path == "/" ? "/index.html" : path);
  if (asset == nullptr) {
    return FailNotFound(path);
  }
  Response response;
  response.type = asset->type;
  response.bytes = asset->plain;
  response.etag = asset->etag;
  response.is_immutable = asset->is_immutable;
  const auto takes = [accepted](std::string_view coding, std::string_view bytes) {
    return AcceptsCoding(accepted, coding) && !bytes.empty();
  };
  if (takes("br", asset->brotli)) {
    response.bytes = asset->brotli;
    response.encoding = "br";
  } else if (takes(kGzip, asset->gzip)) {
    response.bytes = asset->gzip;
    response.encoding = kGzip;
  }
  return response;
}

Result<Response> MakeApiResponse(Workbench* workbench, std::string_view path,
                                 const Visitor& visitor, bool is_shielded,
                                 std::string_view accepted, const std::stop_token& stop) {
  constexpr std::string_view kModel = "/api/model/";
  constexpr std::string_view kPath = "/api/path/";
  constexpr std::string_view kRecording = "/api/recording/";
  if (path == "/api/scene") {
    return MakeSceneResponse(workbench->live(), is_shielded, accepted);
  }
  if (is_shielded && !path.starts_with(kModel)) {
    return FailNotFound(path);
  }
  if (path == "/api/recordings") {
    return MakeOwnedResponse(workbench->recordings().shelf().List(
        visitor.is_owner ? std::nullopt : std::optional(workbench->recordings().FindDigest()),
        stop));
  }
  if (path.starts_with(kModel)) {
    return MakeModelResponse(workbench->live(), path.substr(kModel.size()), accepted);
  }
  if (path.starts_with(kPath)) {
    return MakePathResponse(workbench->sweeper(), path.substr(kPath.size()));
  }
  if (path.starts_with(kRecording)) {
    return MakeRecordingResponse(&workbench->recordings(), path.substr(kRecording.size()),
                                 visitor.is_owner, stop);
  }
  return FailNotFound(path);
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
  constexpr std::size_t kLongestName = 80;  // Characters of a file's name: a choice.
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
