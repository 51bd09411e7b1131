#pragma once

#include <string_view>

namespace hvas::studio {

/** A file of the client, as it is served. */
struct Asset {
  std::string_view path;  ///< As in the URL, "/assets/index-1f0c.js".
  std::string_view type;  ///< Content-Type.
  std::string_view etag;
  std::string_view plain, gzip, brotli;
  bool is_immutable{false};  ///< Its name has a hash in it.
};

/** The file at a path; null where there is none: the set is fixed when the program is built. */
[[nodiscard]] const Asset* FindAsset(std::string_view path);

}  // namespace hvas::studio
