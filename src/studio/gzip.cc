#include "studio/gzip.h"

#include <zlib.h>

#include "base/check.h"

namespace hvas::studio {

std::string Gzip(std::string_view bytes) {
  constexpr int kGzipWindow = 15 + 16;  // The largest window, with gzip's header (zlib's manual).
  constexpr int kMemory = 8;            // zlib's own default
  z_stream stream{};
  const int begun = deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemory,
                                 Z_DEFAULT_STRATEGY);
  HVAS_DEMAND(begun == Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  // zlib's older interface takes what it only reads as if it could be written.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int ended = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  HVAS_DEMAND(ended == Z_STREAM_END);
  return packed;
}

bool AcceptsCoding(std::string_view accepted, std::string_view coding) {
  return accepted.find(coding) != std::string_view::npos;
}

}  // namespace hvas::studio
