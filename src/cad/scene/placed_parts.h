#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.h"

/** Files of a few kilobytes can place more parts than fit into any memory: an assembly of two that
 are assemblies of two, and so on. They are counted before anything is made of them. */
namespace hvas::cad {

/** Levels of assemblies in assemblies that the libraries that read files go through by recursion: a
 choice; files have ten, and a stack of 8 MiB is full at some thousand. */
inline constexpr std::size_t kMostLevels = 1000;

/** The definitions that each definition uses, as often as it uses them, by their numbers. */
using Uses = std::unordered_map<std::uint64_t, std::vector<std::uint64_t>>;

/** What stands below the roots of definitions that use each other. */
struct PlacedTree {
  double count{0};        ///< Definitions in the tree, roots included; may be infinite.
  std::size_t levels{0};  ///< Definitions on the longest way down.
  /** Definitions that contain themselves, each followed by one that it uses, the first once more at
   the end; empty: none does. */
  std::vector<std::uint64_t> circle;
};

/** Examines the tree below the roots, without recursion; circles among all definitions. */
[[nodiscard]] PlacedTree ExamineTree(const Uses& uses, const std::vector<std::uint64_t>& roots);

/** Checks a tree that a stranger's file has, before anything goes through it by recursion: whether
 it is a tree, no deeper than kMostLevels, with no more than `most` parts. Errors: kUnsupported;
 kUnreadable (a circle). @param name  The file. @param kind  What a definition is: "object". */
[[nodiscard]] Result<void> CheckTree(const PlacedTree& tree, std::size_t most,
                                     const std::string& name, std::string_view kind);

/** The error of a file that places more than `most` parts. */
[[nodiscard]] Unexpected FailTooManyParts(std::size_t most, const std::string& name);

/** The error of a file whose content takes more memory than a product, or one step on the way to
 it, may. @param what  "unpacked, it takes". */
[[nodiscard]] Unexpected FailTooManyBytes(const std::string& what, double bytes, std::uint64_t most,
                                          const std::string& name);

}  // namespace hvas::cad
