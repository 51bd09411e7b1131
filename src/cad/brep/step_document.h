#pragma once

#include <filesystem>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/brep/cad_document.h"
#include "cad/process/read_cad.h"

namespace hvas::cad {

/** Reads a STEP file, given by an absolute path, into an XCAF document in millimetres, with names,
 colours, layers, materials and identities but without tolerances (OpenCASCADE 7.6 crashes on some).
 References to files that cannot be had become warnings; identities of products in them are not
 read. `entity_of` knows the faces of this file, though not of those that it refers to, and is there
 where `with_entities`. Refuses (kUnsupported) what places far more than `max_parts`. May throw what
 OpenCASCADE throws. */
[[nodiscard]] Result<CadDocument> ReadStepDocument(const std::filesystem::path& file,
                                                   std::size_t max_parts, const ReadWatch& watch,
                                                   Diagnostics* diagnostics,
                                                   bool with_entities = false);

}  // namespace hvas::cad
