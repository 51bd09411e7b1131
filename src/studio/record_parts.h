#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "base/result.h"

namespace hvas::studio {

/** What a page gets of a record. */
enum class RecordPart {
  kSummary,      ///< Its line in the list of recordings, as JSON.
  kDescription,  ///< That, with its events and the results of parts.
  kFrames,       ///< All frames as clients got them, one after the other.
  kScene,        ///< The scene, as JSON.
  kModel,        ///< The meshes, as GLB.
};

/** Words for them on the command line of hvas-record. */
inline constexpr std::array<const char*, 5> kRecordParts{"summary", "description", "frames",
                                                         "scene", "model"};

/** Attachments of a record from which a page can play it. */
inline constexpr const char* kSceneAttachment = "scene.json";
inline constexpr const char* kGlbAttachment = "model.glb";
inline constexpr const char* kClientEventKind =
    "told";                                       ///< Kind of events in the form that clients got.
inline constexpr const char* kNameMeta = "name";  ///< Metadata: display name.
/** Metadata: OpenScene::digest of the product. */
inline constexpr const char* kProductDigestMeta = "product_digest";

/** What a description says that is not in the record. */
struct RecordLabels {
  std::string name;  ///< Display name in place of the one in the record; empty: none.
  bool is_shared{false};
};

/** Reads a part of a record in this process.
 Errors: those of record::Reader; kUnsupported for more than a page can play. */
[[nodiscard]] Result<std::string> ReadRecordPart(const std::filesystem::path& file, RecordPart part,
                                                 const RecordLabels& labels = {});

}  // namespace hvas::studio
