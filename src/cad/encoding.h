#pragma once

#include <string>
#include <string_view>

namespace hvas::cad {

/** Whether iconv(3) knows an encoding by this name, as CP1251, GBK or ISO-8859-2. */
[[nodiscard]] bool IsEncoding(const std::string& name);

/** Bytes in an encoding as UTF-8; what is no character in it becomes U+FFFD. Bytes of an encoding
 that is not known here are taken for ISO 8859-1. */
[[nodiscard]] std::string ToUtf8(std::string_view bytes, const std::string& encoding);

}  // namespace hvas::cad
