#include "base/utf8.h"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace hvas {
namespace {

/** A code point in UTF-8, by the table of RFC 3629. */
std::string Encode(std::uint32_t code) {
  const auto tail = [code](int shift) {
    return static_cast<char>(0x80 | ((code >> shift) & 0x3F));
  };
  if (code < 0x80) {
    return {static_cast<char>(code)};
  }
  if (code < 0x800) {
    return {static_cast<char>(0xC0 | (code >> 6)), tail(0)};
  }
  if (code < 0x10000) {
    return {static_cast<char>(0xE0 | (code >> 12)), tail(6), tail(0)};
  }
  return {static_cast<char>(0xF0 | (code >> 18)), tail(12), tail(6), tail(0)};
}

TEST(Utf8, EveryCodePointButSurrogatesHasALength) {
  for (std::uint32_t code = 0; code <= 0x110010; code += code < 0x11000 ? 1 : 0x101) {
    const std::string bytes = Encode(code);
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    const bool is_beyond = code > 0x10FFFF;
    ASSERT_EQ(MeasureUtf8(bytes), is_surrogate || is_beyond ? 0 : bytes.size()) << code;
    ASSERT_EQ(MeasureUtf8("ab" + bytes, 2), is_surrogate || is_beyond ? 0 : bytes.size()) << code;
  }
}

TEST(Utf8, WhatIsCutOrOverlongOrNoLeadHasNone) {
  for (const char* bytes :
       {"\x80", "\xC0\x80", "\xC1\xBF", "\xC2", "\xC2z", "\xE0\x9F\xBF", "\xE2\x82",
        "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    EXPECT_EQ(MeasureUtf8(bytes), 0u);
  }
}

}  // namespace
}  // namespace hvas
