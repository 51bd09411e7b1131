#pragma once

#include <string_view>

namespace hvas::studio {

/** A file of the client as it is served; compiled into the program. */
struct Asset {
  std::string_view path;  ///< Path in the URL: "/assets/index-1f0c.js".
  std::string_view type;  ///< Content-Type.
  std::string_view etag;
  std::string_view plain, gzip, brotli;
  bool is_immutable{false};  ///< Its name has a hash in it.
};

/** Finds the file at a path; null where there is none. The set is fixed when the program is
 built. */
[[nodiscard]] const Asset* FindAsset(std::string_view path);

}  // namespace hvas::studio
