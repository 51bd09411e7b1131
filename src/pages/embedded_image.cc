#include "pages/embedded_image.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include "pages/html_page.h"

namespace hvas::pages {

std::string MakePngAddress(std::string_view png) {
  std::string text(4 * ((png.size() + 2) / 3) + 1, '\0');  // With the zero that it ends by.
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(png.data()),
                                     static_cast<int>(png.size()));
  text.resize(static_cast<std::size_t>(length));
  return "data:image/png;base64," + text;
}

std::string MakeImage(std::string_view png, std::string_view alt, int width, int height) {
  return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"{}\">", Escape(alt), width,
                     height, MakePngAddress(png));
}

}  // namespace hvas::pages
