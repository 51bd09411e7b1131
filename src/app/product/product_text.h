#pragma once

#include "app/product/selection.h"
#include "base/diagnostics.h"
#include "base/work_watch.h"
#include "product/product.h"

namespace hvas::app {

/** Prints a product on stdout for people, section by section in 100 columns, and ends with a
 summary of the whole. Faces are listed only where they are asked for by name; equal things are
 counted.
 @param is_all  Long lists are not cut short.
 @param watch  What it ends is incomplete. */
void PrintText(const product::Product& product, const Diagnostics& diagnostics,
               const Selection& selection, bool is_all, WorkWatch* watch);

/** Prints one mate as in the section "mates". */
void PrintMate(const product::Product& product, const product::Mate& mate, bool with_evidence);

}  // namespace hvas::app
