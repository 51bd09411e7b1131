#pragma once

#include <filesystem>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/process/read_cad.h"
#include "cad/scene/mesh_format.h"
#include "product/product.h"

namespace hvas::cad {

/** Reads an OBJ, STL, glTF 2 (also GLB) or 3MF file into parts without B-rep: their faces are
 fitted to the triangles (cad/segment.h).

 Nodes become subassemblies and occurrences, meshes used twice one part; scales and mirrors of a
 node are worked into the part. Objects of an OBJ and solids of an STL are parts when each of them
 is closed, else faces of one part. glTF is in metres with y up and is turned to z up; 3MF states
 its unit, but for `options.length_unit`; OBJ and STL have none: note `assumed-unit`. Files
 that it names are read only from its own folder and below.

 Errors: kUnreadable (damaged, or without a triangle), kNotFound (a buffer in another file is
 missing). @param file  Absolute. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> ReadMeshFile(const std::filesystem::path& file,
                                                    MeshFormat format, const ImportOptions& options,
                                                    const ReadWatch& watch,
                                                    Diagnostics* diagnostics);

}  // namespace hvas::cad
