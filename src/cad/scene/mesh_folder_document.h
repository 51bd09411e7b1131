#pragma once

#include <filesystem>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/process/read_cad.h"
#include "product/product.h"

namespace hvas::cad {

/** Reads the mesh files of a folder (cad/mesh_folder.h) into one product: a file with one part
 becomes a part with the file's name, one with several a subassembly. All are in one frame. Files
 that cannot be read are left out with a warning. Errors: those of ReadMeshFile() for the first
 file, where none could be read; kUnsupported (too many parts).
 @param folder  Absolute. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> ReadMeshFolder(const std::filesystem::path& folder,
                                                      const ImportOptions& options,
                                                      const ReadWatch& watch,
                                                      Diagnostics* diagnostics);

}  // namespace hvas::cad
