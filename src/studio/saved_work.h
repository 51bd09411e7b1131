#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studio/history.h"
#include "studio/json.h"

namespace hvas::studio {

/** Saved work on a product: edits and state of assembly, from which a later start resumes. */
struct SavedWork {
  std::filesystem::path file;  ///< CAD file of the product.
  std::string name;            ///< Display name of the product.
  std::string digest;          ///< CalcProductDigest of the product as opened.
  std::vector<Json> edits;     ///< Commands of edits, in order.
  LiveState state;
  std::vector<Json> notes;  ///< Notes of WorkbenchNotes::List().
};

/** Computes the digest of parts, meshes, mates and fits: all that edits and poses refer to. */
[[nodiscard]] std::string CalcProductDigest(const product::Product& product);

/** Makes the saved work of a snapshot. @pre now.scene != nullptr. */
[[nodiscard]] SavedWork MakeSavedWork(const SceneSnapshot& now);

/** Reads a file of SaveWork. Errors: those of ReadPrivateFile; kUnreadable for any other content.
 */
[[nodiscard]] Result<SavedWork> LoadWork(const std::filesystem::path& file);

/** Moves saved work that is about to be replaced to a backup file beside it; one backup is kept. */
void BackUpWork(const std::filesystem::path& file);

/** Writes a file that only this user can read. Errors: those of WriteAtomically. */
[[nodiscard]] Result<void> SaveWork(const std::filesystem::path& file, const SavedWork& work);

}  // namespace hvas::studio
