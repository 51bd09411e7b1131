#pragma once

#include <string>
#include <vector>

namespace hvas::cad {

/** `hvas-cad export-step FILE [--motions FILE]`: reads a STEP or IGES file and writes it to
 kOutputDescriptor as one STEP file, with parts moved if so told, or one line that says why not.
 @returns The exit status. */
[[nodiscard]] int WorkerExportStep(const std::vector<std::string>& arguments);

}  // namespace hvas::cad
