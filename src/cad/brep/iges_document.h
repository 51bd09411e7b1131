#pragma once

#include <filesystem>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/brep/cad_document.h"
#include "cad/process/read_cad.h"

namespace hvas::cad {

/** Reads an IGES file (fixed ASCII form), given by an absolute path, into an XCAF document in
 millimetres: groups and subfigures that hold several bodies as assemblies, solids as parts, and the
 trimmed surfaces of a group, which IGES files mostly have instead of solids, sewn into solids where
 they close (note `sewn-faces`). Names, colours of entities and the header come along; curves do
 not. Entities that cannot be read become warnings (`iges-entity`) with their number in the
 directory.

 Errors: those of CheckIgesText(); kUnreadable where OpenCASCADE can read nothing; kUnsupported for
 far more than `options.max_parts`, and for an `options.length_unit` that IGES does not have. May
 throw what OpenCASCADE throws. */
[[nodiscard]] Result<CadDocument> ReadIgesDocument(const std::filesystem::path& file,
                                                   const ImportOptions& options,
                                                   const ReadWatch& watch,
                                                   Diagnostics* diagnostics);

}  // namespace hvas::cad
