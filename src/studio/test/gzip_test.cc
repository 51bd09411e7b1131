#include "studio/gzip.h"

#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

namespace hvas::studio {
namespace {

/** Unpacks by zlib's reader, which also checks the sum at the end. */
std::string Unpack(std::string packed, std::size_t size) {
  std::string bytes(size, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_EQ(stream.total_out, size);
  inflateEnd(&stream);
  return bytes;
}

TEST(GzipTest, BytesComeBackAsTheyWere) {
  std::string bytes;
  for (int k = 0; k < 100'000; ++k) {
    bytes += static_cast<char>(k * k % 251);
  }
  for (const std::string& each : {std::string("a"), std::string(5000, 'x'), bytes}) {
    EXPECT_EQ(Unpack(Gzip(each), each.size()), each);
  }
  EXPECT_LT(Gzip(std::string(5000, 'x')).size(), 100U);
}

TEST(GzipTest, WhatABrowserAcceptsIsReadFromItsHeader) {
  EXPECT_TRUE(AcceptsCoding("gzip, deflate, br", "gzip"));
  EXPECT_FALSE(AcceptsCoding("br", "gzip"));
  EXPECT_FALSE(AcceptsCoding("", "gzip"));
}

}  // namespace
}  // namespace hvas::studio
