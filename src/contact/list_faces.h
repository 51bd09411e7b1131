#pragma once

#include <vector>

#include "contact/kernel.h"

namespace hvas::contact {

struct Mesh;
struct ExactTable;

/** Finds the faces of every list of the table, and puts the entries of each face together, by
 increasing distance as before. */
void GroupLists(const Mesh& mesh, ExactTable* exact);

}  // namespace hvas::contact
