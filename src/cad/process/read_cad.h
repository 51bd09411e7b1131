#pragma once

#include <filesystem>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/import.h"
#include "product/product.h"

namespace hvas::cad {

/** Who wants to know how the reading goes. */
struct ReadWatch {
  ProgressFn progress;
  PartFn part;
  /** Receives the files that the read one refers to, read or missing, as absolute paths. */
  std::vector<std::filesystem::path>* referred_files{nullptr};
};

/** Reads a CAD file with the files that it refers to, in this process: a crash of the library that
 reads the format is one of the program. cad::Import does this in a process of its own.

 The result has structure, names (UTF-8), colours (sRGB), materials, mass, faces as analytic
 surfaces, the mesh and the features of every part, in SI, and no mates. What is odd about the file
 goes to `diagnostics` and does not stop the import. Parts without a face are left out, but where
 the file has no faces at all: then curves are shown. Parts without a solid have no mass. The
 density of a part that states none, or an absurd one, is assumed.

 Formats, told apart by content: STEP (AP203, AP214, AP242); IGES 5.3; OBJ, STL, glTF 2, GLB and 3MF
 as cad/mesh_document.h has it; a folder of such meshes (cad/mesh_folder_document.h).

 Errors: kNotFound (no such file), kUnreadable (no format that is known, damaged, or without a
 solid), kOutOfResource. Not re-entrant inside: concurrent calls wait for each other.
 Deterministic. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> ReadCad(const std::filesystem::path& file,
                                               const ImportOptions& options,
                                               Diagnostics* diagnostics,
                                               const ReadWatch& watch = {});

}  // namespace hvas::cad
