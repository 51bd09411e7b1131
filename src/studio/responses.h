#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "base/result.h"
#include "studio/access.h"
#include "studio/workbench.h"

namespace hvas::studio {

/** Content of the response to a GET request. */
struct Response {
  std::string type;                   ///< Media type.
  std::string_view bytes;             ///< Body; `owner` or static storage keeps it alive.
  std::shared_ptr<const void> owner;  ///< May be null.
  std::string etag;                   ///< Entity tag; empty: the response must not be cached.
  bool is_immutable{false};           ///< The content of this path never changes.
  std::string encoding;               ///< Content-Encoding; empty: identity.
  std::optional<std::filesystem::path> file;  ///< Sent instead of `bytes`, as a download.
};

/** Serves a file of the client, for which no session is needed.
 @param accepted  Value of Accept-Encoding. Errors: kNotFound. */
[[nodiscard]] Result<Response> MakeAssetResponse(std::string_view path, std::string_view accepted);

/** Serves a resource below /api/ to a client with a session (docs/protocol.md). The owner gets all
 recordings, all others those of the open product that are shared. May take long: not for the
 network thread.
 @param is_shielded  The client is a participant of a study: it gets the scene without its fits, the
 meshes, and nothing else.
 @param accepted  Value of Accept-Encoding: scene and meshes go compressed to whoever takes gzip.
 Errors: kNotFound for unknown resources; those of reading a record.
 @param stop  Ends the reading of a record. */
[[nodiscard]] Result<Response> MakeApiResponse(Workbench* workbench, std::string_view path,
                                               const Visitor& visitor, bool is_shielded = false,
                                               std::string_view accepted = {},
                                               const std::stop_token& stop = {});

/** Decodes the percent-encoding (%xx) of a URL's path; malformed sequences stay as they are. */
[[nodiscard]] std::string DecodePercent(std::string_view path);

/** Makes a safe file name for an upload: the last component of the name in the request's target,
 reduced to harmless characters, with its extension, which determines the format. */
[[nodiscard]] std::string NameOfUpload(std::string_view target);

}  // namespace hvas::studio
