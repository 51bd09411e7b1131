#include "cad/encoding.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>

#include <iconv.h>

namespace hvas::cad {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD.

/** A conversion to UTF-8 that is open; closed with the object. */
class Conversion {
 public:
  explicit Conversion(const std::string& encoding)
      : descriptor_(::iconv_open("UTF-8", encoding.c_str())) {}

  ~Conversion() {
    if (is_open()) {
      ::iconv_close(descriptor_);
    }
  }

  Conversion(const Conversion&) = delete;
  Conversion& operator=(const Conversion&) = delete;

  [[nodiscard]] bool is_open() const { return descriptor_ != kNone; }

  /** Appends what comes of the bytes up to the first one that is no character.
   @returns the bytes behind those. */
  std::string_view Convert(std::string_view bytes, std::string* text) {
    std::array<char, 4096> buffer;
    char* in = const_cast<char*>(bytes.data());  // iconv() reads it only.
    std::size_t in_left = bytes.size();
    std::size_t status = 0;
    do {
      char* out = buffer.data();
      std::size_t out_left = buffer.size();
      status = ::iconv(descriptor_, &in, &in_left, &out, &out_left);
      text->append(buffer.data(), buffer.size() - out_left);
    } while (status == kFailed && errno == E2BIG);
    return bytes.substr(bytes.size() - in_left);
  }

 private:
  // What iconv(3) returns where it fails.
  static constexpr auto kFailed = static_cast<std::size_t>(-1);
  // What iconv_open(3) returns where it fails.
  static inline const auto kNone = reinterpret_cast<iconv_t>(-1);

  iconv_t descriptor_;
};

}  // namespace

bool IsEncoding(const std::string& name) {
  return !name.empty() && Conversion(name).is_open();
}

std::string ToUtf8(std::string_view bytes, const std::string& encoding) {
  Conversion conversion(encoding);
  if (!conversion.is_open()) {
    return encoding == "ISO-8859-1" ? std::string(bytes) : ToUtf8(bytes, "ISO-8859-1");
  }
  std::string text;
  text.reserve(bytes.size());
  while (!bytes.empty()) {
    bytes = conversion.Convert(bytes, &text);
    if (!bytes.empty()) {
      text += kReplacement;
      bytes.remove_prefix(1);
    }
  }
  return text;
}

}  // namespace hvas::cad
