#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/process/read_cad.h"

class TDocStd_Document;
class TopoDS_Face;

namespace opencascade {
template <class T>
class handle;
}

namespace hvas::cad {

/** The number of the STEP entity that a face comes from; 0 where that is not known. */
using FaceEntityFn = std::function<std::uint64_t(const TopoDS_Face&)>;

/** Reads a STEP file, given by an absolute path, into an XCAF document in millimetres, with names,
 colours, layers and materials but without tolerances (OpenCASCADE 7.6 crashes on some). References
 to files that cannot be had become warnings. Where `entity_of` is given it becomes a function that
 knows the faces of this file, though not of those that it refers to. Refuses (kUnsupported) what
 places far more than `max_parts`. May throw what OpenCASCADE throws. */
[[nodiscard]] Result<opencascade::handle<TDocStd_Document>> ReadStepDocument(
    const std::filesystem::path& file, std::size_t max_parts, const ReadWatch& watch,
    Diagnostics* diagnostics, FaceEntityFn* entity_of = nullptr);

/** Forgets a document; the application of OpenCASCADE would keep it for ever. */
void CloseDocument(const opencascade::handle<TDocStd_Document>& document);

}  // namespace hvas::cad
