#include "pages/embedded_image.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include "pages/html_page.h"

namespace hvas::pages {

std::string EncodeBase64(std::string_view bytes) {
  constexpr std::size_t kPiece = 3
                                 << 20;  // The library counts in int; multiples of 3 can be joined.
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  std::string piece;
  for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
    const std::string_view part = bytes.substr(at, kPiece);
    piece.resize(4 * ((part.size() + 2) / 3) + 1);  // With the zero that it ends by.
    const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(piece.data()),
                                       reinterpret_cast<const unsigned char*>(part.data()),
                                       static_cast<int>(part.size()));
    text.append(piece, 0, static_cast<std::size_t>(length));
  }
  return text;
}

std::string MakePngAddress(std::string_view png) {
  return "data:image/png;base64," + EncodeBase64(png);
}

std::string MakeImage(std::string_view png, std::string_view alt, int width, int height) {
  return fmt::format("<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"{}\">", Escape(alt), width,
                     height, MakePngAddress(png));
}

}  // namespace hvas::pages
