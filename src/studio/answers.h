#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** What a GET is answered with. */
struct Answer {
  std::string type;                   ///< Media type.
  std::string_view bytes;             ///< That `owner` keeps, or that the program has for ever.
  std::shared_ptr<const void> owner;  ///< May be null.
  std::string etag;                   ///< Empty: is not to be kept by anybody.
  bool is_immutable{false};           ///< What has this path never changes.
  std::string encoding;               ///< Content-Encoding, for what comes in several; or empty.
  std::optional<std::filesystem::path> file;  ///< In place of the bytes, for saving.
};

/** A file of the client, that anybody may have.
 @param accepted  Accept-Encoding. Errors: kNotFound. */
[[nodiscard]] Result<Answer> AnswerAsset(std::string_view path, std::string_view accepted);

/** What is under /api/, for those who may come in (docs/protocol.md).
 @param is_shielded  For whoever takes part in a study: the scene without its fits, the meshes, and
 nothing else. Errors: kNotFound for what is not there; those of a record. */
[[nodiscard]] Result<Answer> AnswerApi(Workbench* workbench, std::string_view path,
                                       bool is_shielded = false);

/** A path of a URL with %xx as the bytes that they stand for; what is no such sequence stays. */
[[nodiscard]] std::string DecodePercent(std::string_view path);

/** How an uploaded file is called here: the last part of the name that a request's target gives it,
 of harmless letters, with its extension, which tells the format. */
[[nodiscard]] std::string NameOfUpload(std::string_view target);

}  // namespace hvas::studio
