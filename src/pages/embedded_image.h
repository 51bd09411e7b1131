#pragma once

#include <string>
#include <string_view>

namespace hvas::pages {

/** Bytes as text, in base 64. */
[[nodiscard]] std::string EncodeBase64(std::string_view bytes);

/** Address of a PNG file that has the file in itself ("data:image/png;base64,..."), for pages that
 need nothing else. */
[[nodiscard]] std::string MakePngAddress(std::string_view png);

/** Element <img> of a PNG file. @param alt  What is to be seen, for who does not see it: plain
 text.
 @param width,height  Size on the page [px]. */
[[nodiscard]] std::string MakeImage(std::string_view png, std::string_view alt, int width,
                                    int height);

}  // namespace hvas::pages
