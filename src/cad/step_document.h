#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/import.h"

class TDocStd_Document;
class TopoDS_Face;

namespace opencascade {
template <class T>
class handle;
}

namespace hvas::cad {

/** Checks that a file exists and says that it is STEP. @returns its absolute path, without which
 OpenCASCADE does not find the files that it refers to. */
[[nodiscard]] Result<std::filesystem::path> CheckStepFile(const std::filesystem::path& file);

/** The number of the STEP entity that a face comes from; 0 where that is not known. */
using FaceEntityFn = std::function<std::uint64_t(const TopoDS_Face&)>;

/** Reads a checked STEP file into an XCAF document in millimetres, with names, colours, layers and
 materials but without tolerances (OpenCASCADE 7.6 crashes on some). References to files that
 cannot be had become warnings. Where `entity_of` is
 given it becomes a function that knows the faces of this file, though not of those that it refers
 to. May throw what OpenCASCADE throws. */
[[nodiscard]] Result<opencascade::handle<TDocStd_Document>> ReadStepDocument(
    const std::filesystem::path& file, const ProgressFn& progress, Diagnostics* diagnostics,
    FaceEntityFn* entity_of = nullptr);

/** Forgets a document; the application of OpenCASCADE would keep it for ever. */
void CloseDocument(const opencascade::handle<TDocStd_Document>& document);

}  // namespace hvas::cad
