#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "cad/import.h"
#include "cad/input_file.h"
#include "spatial/pose.h"

namespace hvas::cad {

/** Where parts go from where they are drawn: paths of occurrences, and their motions in the world
 [m]. */
using PartMotions = std::vector<std::pair<std::string, spatial::Pose>>;

/** Writes a STEP or IGES file anew as AP214, in a process of its own like Import: structure,
 instances in their poses, names, colours, layers and materials; all files that it refers to in one.
 The bytes are the same whenever it is done, where the kernel lets addresses be (see
 worker_main.cc). Of `options`, unit and encoding count. Where parts are moved, each instance of a
 subassembly is written with a definition of its own. Errors: kUnreadable (no STEP or IGES file, or
 one that OpenCASCADE cannot read or write), kNotFound, kOutOfResource, kCancelled. */
[[nodiscard]] Result<MappedFile> ExportStep(const std::filesystem::path& file,
                                            const ImportOptions& options,
                                            const ImportControl& control,
                                            const PartMotions& motions = {});

}  // namespace hvas::cad
