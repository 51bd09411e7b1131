#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/work_watch.h"
#include "mates/place_by_mates.h"
#include "mates/side_file.h"
#include "product/product.h"

/** What people say about mates, over what inference proposes: CAD files rarely carry fits. */
namespace hvas::mates {

/** True for an occurrence's name, its path, and the end of its path ("tier 1/post 1"), and for
 those of the bodies that it is welded of. */
[[nodiscard]] bool IsCalled(const product::Product& product, product::OccurrenceId id,
                            std::string_view name);

/** The one occurrence that is called so. Fails where there is none, or more than one. */
[[nodiscard]] Result<product::OccurrenceId> FindOccurrence(const product::Product& product,
                                                           std::string_view name);

/** What a side file did. */
struct MateChanges {
  std::vector<product::Mate> removed;             ///< Mates as they were, with the ids they had.
  std::vector<product::MateId> added;             ///< Ordered as SideFile::added.
  int fits{0};                                    ///< Mates that got a fit or conditions.
  std::vector<MateContradiction> contradictions;  ///< Mates of the user that exclude each other.
};

/** Takes out the mates that a side file removes, adds those that it adds, and places the parts by
 them (PlaceByMates); ids and joints follow. A removed mate is one of the drawn or of the assembled
 poses.
 A mate to be added that is there already becomes the user's. Errors name the file, the line, the
 entry and a remedy; then nothing is changed. @pre product has its inferred mates. */
[[nodiscard]] Result<MateChanges> ApplyMates(const SideFile& file, product::Product* product,
                                             WorkWatch* watch = nullptr);

/** Sets the fits and conditions that a side file states. An entry by names applies to all axis-hole
 mates between occurrences of these names whose hole or shaft has the diameter within 1 % (any, when
 it is left out); several entries may speak about one mate, later ones over earlier ones. Entries
 about removed mates wait for these to be restored. Errors as those of ApplyMates; refused are also
 conditions out of sense: sizes more than 5 % off both the drawn and the nominal diameter.

 A fit of one class, "H7" or "g6", is about the hole or the shaft alone. The other keeps the class
 that it has from the file or a proposal; where there is none (threads, sizes without a code) it is
 as drawn, and the code is that one class.
 @returns how many mates got a fit or conditions. */
[[nodiscard]] Result<int> ApplyFits(const SideFile& file, const MateChanges& changes,
                                    product::Product* product, WorkWatch* watch = nullptr);

/** Sets the relations and contact pairs that a side file states, instead of those there were.
 Errors as those of ApplyMates; refused are also relations that the two elements cannot have. */
[[nodiscard]] Result<void> ApplyRelations(const SideFile& file, product::Product* product);

/** All that a product gets from its files: mates removed and added, the fits that the CAD file
 states (see AssignStatedFits), and over them those of the side file. All of it, or an error and
 nothing; an error also when the watch ends it. */
[[nodiscard]] Result<MateChanges> ApplySideFile(const SideFile& file, product::Product* product,
                                                WorkWatch* watch = nullptr);

/** Reads a side file, and the same. */
[[nodiscard]] Result<MateChanges> ApplyAssignments(const std::filesystem::path& file,
                                                   product::Product* product,
                                                   WorkWatch* watch = nullptr);

/** Sets fits from the command line: "AXIS=H7/p6", with AXIS a mate ("m12" or its key), "all", or
 the name or path of an occurrence with the hole or the shaft. "all" and names leave threads as they
 are. The nominal diameter stays. Fails where AXIS names no axis-hole mate, or the size has no such
 fit. */
[[nodiscard]] Result<void> AssignFit(product::Product* product, std::string_view assignment);

}  // namespace hvas::mates
