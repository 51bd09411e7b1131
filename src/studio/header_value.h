#pragma once

#include <string>
#include <string_view>

namespace hvas::studio {

/** Makes the value of Content-Disposition with which a browser saves a file under this name, by RFC
 6266 and RFC 8187: in ASCII, and in UTF-8 where the name has more. All texts of others that become
 part of a header's value go through here: no name ends the value, or the line. */
[[nodiscard]] std::string MakeAttachmentValue(std::string_view name);

/** Whether a text can be the value of a header as it stands: it has no control characters, of which
 a line break would begin another header. */
[[nodiscard]] bool IsHeaderValue(std::string_view text);

}  // namespace hvas::studio
