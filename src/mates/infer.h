#pragma once

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "mates/limits.h"
#include "product/product.h"

/** Which faces of an assembled product belong together: paper X's external constraints (X2), found
 instead of authored (N1). */
namespace hvas::mates {

/** Fills product->mates (replacing what is there) from the poses as drawn.

 Axis-hole: hole and shaft on one axis that engage; one mate for each pair of parts and axis, on the
 features that fit tightest among the long engagements; none where a third part (a bushing) lies
 between, nor for a wide passage around a shaft that another part guides. Face-face: opposing planes
 that touch over an area; one mate for each pair of parts and plane. Both connectors of a mate
 coincide exactly in the drawn pose, whatever play the drawing has, so the drawn pose fulfils all
 mates at once. Nothing is moved. Copies of a part at the very same place get no mates, nor has a
 shaft in a hole that is smaller by more than any joint has (IsBeyondAnyFit).

 Tells parts without a mate ("no-mate"), copies ("duplicate-part") and drawn interference
 ("drawn-interference"). */
void Infer(product::Product* product, Diagnostics* diagnostics, const InferenceLimits& limits = {});

/** Infers the mates of files that may be hostile. Fails (kOutOfResource, kCancelled) when the watch
 ends it; what the product has for mates then is of no use. */
[[nodiscard]] Result<void> Infer(product::Product* product, Diagnostics* diagnostics,
                                 WorkWatch* watch, const InferenceLimits& limits = {});

/** How the mates tie a product together. */
struct Linkage {
  int linked_parts{0};       ///< Occurrences with at least one mate.
  int components{0};         ///< Connected groups among them.
  int largest_component{0};  ///< Occurrences in the largest group.
};

[[nodiscard]] Linkage CalcLinkage(const product::Product& product);

/** Occurrences with at least one mate. */
[[nodiscard]] int CountLinkedParts(const product::Product& product);

}  // namespace hvas::mates
