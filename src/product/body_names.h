#pragma once

#include "product/product.h"

namespace hvas::product {

/** Gives parts that their file calls by the kind of their shape only ("SOLID", "COMPOUND") the name
 of the subassembly whose sole part they are: exporters write a named product as an assembly of one
 nameless body. A part in several subassemblies gets their name where it is the same. Names and
 paths of occurrences stay. */
void NameSoleBodies(Product* product);

}  // namespace hvas::product
