#pragma once

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/brep/cad_document.h"
#include "cad/process/read_cad.h"
#include "product/product.h"

namespace hvas::cad {

/** Fills a product (name, header, tree, occurrences, parts) from an XCAF document in millimetres.
 An instance that is mirrored or scaled becomes a part of its own with the mirror image or the
 scaled shape, at a rigid pose. A document of several products, or of one part, gets a root
 subassembly of its own. Errors: kUnreadable without any solid, kUnsupported for more than a million
 occurrences. May throw what OpenCASCADE throws.
 @pre product->name is the name to use where the document has none. */
[[nodiscard]] Result<void> BuildProduct(const CadDocument& document, const ImportOptions& options,
                                        const ReadWatch& watch, product::Product* product,
                                        Diagnostics* diagnostics);

}  // namespace hvas::cad
