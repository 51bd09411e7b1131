#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <Standard_Handle.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Shape.hxx>

#include "product/identity.h"

class TDF_Label;
class TopoDS_Face;

namespace hvas::cad {

/** The number of the STEP entity that a face comes from; 0 where that is not known. */
using FaceEntityFn = std::function<std::uint64_t(const TopoDS_Face&)>;

/** What the file states of a definition of the document besides its shape. */
using IdentityFn = std::function<product::Identity(const TDF_Label&)>;

/** Faces of one shell of the file that OpenCASCADE made nothing of. */
struct LostFaces {
  std::uint64_t entity{0};  ///< Number of the shell in the STEP file.
  int lost{0};
  int total{0};
  TopoDS_Shape sibling;  ///< A face of the shell that was read; null where none was.
};

/** A CAD file as OpenCASCADE has read it: an XCAF document in millimetres. CloseDocument() ends it.
 */
struct CadDocument {
  opencascade::handle<TDocStd_Document> document;
  product::FileHeader header;
  IdentityFn identity_of;  ///< Empty where the file has none.
  FaceEntityFn entity_of;  ///< Empty where it was not asked for.
  std::vector<LostFaces> lost_faces{};
};

}  // namespace hvas::cad
