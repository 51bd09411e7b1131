#pragma once

#include <vector>

#include "contact/kernel.h"

namespace hvas::contact {

struct Mesh;
struct ExactTable;

/** Of every list of the table. */
[[nodiscard]] std::vector<ListFaces> MakeListFaces(const Mesh& mesh, const ExactTable& exact);

}  // namespace hvas::contact
