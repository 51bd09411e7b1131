#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/result.h"

/** Files of a few kilobytes can place more parts than fit into any memory: an assembly of two that
 are assemblies of two, and so on. They are counted before anything is made of them. */
namespace hvas::cad {

/** The definitions that each definition uses, as often as it uses them, by their numbers. */
using Uses = std::unordered_map<std::uint64_t, std::vector<std::uint64_t>>;

/** How many definitions stand in the tree below the roots, themselves included. What uses itself
 counts once; infinite where it is beyond all numbers. */
[[nodiscard]] double CountPlaced(const Uses& uses, const std::vector<std::uint64_t>& roots);

/** Whether a tree of so many parts and subassemblies may hold no more than `most` parts. Errors:
 kUnsupported. @param name  The file. */
[[nodiscard]] Result<void> CheckPlaced(double placed, std::size_t most, const std::string& name);

/** The error of a file that places more than `most` parts. */
[[nodiscard]] Unexpected FailTooManyParts(std::size_t most, const std::string& name);

/** The error of a file whose content takes more memory than a product, or one step on the way to
 it, may. @param what  "unpacked, it takes". */
[[nodiscard]] Unexpected FailTooManyBytes(const std::string& what, double bytes, std::uint64_t most,
                                          const std::string& name);

}  // namespace hvas::cad
