#pragma once

#include <filesystem>

#include "base/result.h"
#include "cad/import.h"
#include "cad/input_file.h"

namespace hvas::cad {

/** Writes a STEP file anew as AP214, in a process of its own like Import: structure, instances in
 their poses, names, colours, layers and materials; all files that it refers to in one. The bytes
 are the same whenever it is done. Errors: kUnreadable (no STEP file, or one that OpenCASCADE cannot
 read or write), kNotFound, kOutOfResource, kCancelled. */
[[nodiscard]] Result<MappedFile> ExportStep(const std::filesystem::path& file,
                                            const ImportControl& control);

}  // namespace hvas::cad
