#pragma once

#include <span>

namespace hvas::device {

/** A file of data/devices, as the build found it. */
struct KnownProfileFile {
  const char* name;
  const char* json;
};

extern const std::span<const KnownProfileFile> kKnownProfileFiles;

}  // namespace hvas::device
