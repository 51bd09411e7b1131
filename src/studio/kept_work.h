#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studio/history.h"

namespace hvas::studio {

/** How far the work on a product has come: what a later start of the studio goes on from. */
struct KeptWork {
  std::filesystem::path file;                 ///< The product's.
  std::string name;                           ///< What people call it.
  std::string digest;                         ///< CalcProductDigest of what was opened.
  std::vector<nlohmann::ordered_json> edits;  ///< Commands, in the order in which they were given.
  LiveState state;
};

/** The digest of parts, meshes, mates and fits: of all that edits and places of parts refer to. */
[[nodiscard]] std::string CalcProductDigest(const product::Product& product);

/** @pre now.scene is not null. */
[[nodiscard]] KeptWork MakeKeptWork(const SceneNow& now);

/** Errors: those of ReadKeptFile; kUnreadable for what is not of SaveWork. */
[[nodiscard]] Result<KeptWork> LoadWork(const std::filesystem::path& file);

/** What another work is about to take the place of stays beside it, until the next one does. */
void SetWorkAside(const std::filesystem::path& file);

/** Into a file that nobody else can read. Errors: those of WriteAtomically. */
[[nodiscard]] Result<void> SaveWork(const std::filesystem::path& file, const KeptWork& work);

}  // namespace hvas::studio
