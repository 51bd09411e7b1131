#pragma once

#include <string>
#include <vector>

namespace hvas::cad {

/** `hvas-cad import FILE ...`: reads a CAD file and writes an ImportResult to kOutputDescriptor.
 @param arguments  Those of ImportArguments, in cad/import.cc.
 @returns The exit status. */
[[nodiscard]] int WorkerImport(const std::vector<std::string>& arguments);

}  // namespace hvas::cad
