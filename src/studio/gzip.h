#pragma once

#include <string>
#include <string_view>

namespace hvas::studio {

/** Compresses bytes in the gzip format (RFC 1952), as browsers accept it. The same bytes give the
 same result. */
[[nodiscard]] std::string Gzip(std::string_view bytes);

/** Whether a value of Accept-Encoding (RFC 9110, section 12.5.3) names a coding: "gzip", "br". */
[[nodiscard]] bool AcceptsCoding(std::string_view accepted, std::string_view coding);

}  // namespace hvas::studio
