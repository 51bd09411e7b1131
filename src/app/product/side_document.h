#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "base/result.h"
#include "mates/side_file.h"

namespace hvas::app {

/** A side file that is being edited: all that is in it stays, in its order. */
class SideDocument {
 public:
  /** Reads a side file; a file that is not there yet is an empty one. Errors: those of
   * ReadSideFile.
   */
  [[nodiscard]] static Result<SideDocument> Open(const std::filesystem::path& file);

  /** What it says now. */
  [[nodiscard]] const mates::SideFile& contents() const { return contents_; }

  /** Appends an entry to "mates" or "removed". */
  void Append(const char* list, nlohmann::ordered_json entry);

  /** Takes an entry out; a list that becomes empty goes with it. @returns the entry. */
  nlohmann::ordered_json Take(const char* list, std::size_t index);

  /** Writes it, whole or not at all. */
  [[nodiscard]] Result<void> Write() const;

 private:
  /** Reads again what has been edited: it cannot be wrong. */
  void Refresh();

  nlohmann::ordered_json json_;
  mates::SideFile contents_;
};

}  // namespace hvas::app
