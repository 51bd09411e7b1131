#pragma once

#include <filesystem>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/brep/cad_document.h"
#include "cad/process/read_cad.h"
#include "cad/step/step_text.h"

namespace hvas::cad {

/** The text of a STEP file in UTF-8, from the encoding that `options` give or GuessEncoding()
 finds: note `assumed-encoding` where that is not certain. Empty where the file cannot be read. */
[[nodiscard]] std::string ReadStepFile(const std::filesystem::path& file,
                                       const ImportOptions& options, Diagnostics* diagnostics);

/** Gives a text the unit of length of `options`, if they have one: its first unit is taken for
 that, and others keep their ratio to it. */
void OverrideLengthUnit(const ImportOptions& options, StepText* text);

/** Reads a STEP file, given by its text and an absolute path, into an XCAF document in millimetres,
 with names, colours, layers, materials and identities but without tolerances (OpenCASCADE 7.6
 crashes on some). StepText::length_scale() is applied, also to the files that it refers to.
 References to files that cannot be had become warnings; identities of products in them are not
 read. `entity_of` knows the faces of this file, though not of those that it refers to, and is there
 where `with_entities`. Refuses (kUnsupported) what places far more than `options.max_parts`. May
 throw what OpenCASCADE throws. */
[[nodiscard]] Result<CadDocument> ReadStepDocument(const std::filesystem::path& file,
                                                   const StepText& text,
                                                   const ImportOptions& options,
                                                   const ReadWatch& watch, Diagnostics* diagnostics,
                                                   bool with_entities = false);

}  // namespace hvas::cad
