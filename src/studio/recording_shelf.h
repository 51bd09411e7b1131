#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include <nlohmann/json.hpp>

#include "record/reader.h"

namespace hvas::studio {

/** The recordings in a folder, by id: the stem of the file's name. What clients ask for is found by
 comparing with what is there, never by making a path of it. Any thread. */
class RecordingShelf {
 public:
  /** @param folder  Is made when something is recorded; empty: nothing can be. */
  explicit RecordingShelf(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /** Where a new one of a product goes. Errors: why nothing can be recorded. */
  [[nodiscard]] Result<std::filesystem::path> MakePath(const std::string& product) const;

  /** "recordings" of docs/protocol.md, the newest first. What is no record is passed over. */
  [[nodiscard]] nlohmann::ordered_json List();

  /** Errors: kNotFound. */
  [[nodiscard]] Result<std::filesystem::path> Find(const std::string& id) const;

  /** What a page needs to play it: docs/protocol.md. */
  [[nodiscard]] Result<nlohmann::ordered_json> Describe(const std::string& id) const;

  /** All that viewers were shown, frame after frame. */
  [[nodiscard]] Result<std::string> ReadFrames(const std::string& id) const;

  /** kSceneAttachment or kGlbAttachment. */
  [[nodiscard]] Result<std::string> ReadAttachment(const std::string& id,
                                                   const std::string& name) const;

  [[nodiscard]] Result<void> Delete(const std::string& id);

  /** What people call it from now on; the record itself, which may be evidence, stays as it was.
   Errors: kNotFound; kInvalid for an empty name; those of WriteAtomically. */
  [[nodiscard]] Result<void> Rename(const std::string& id, const std::string& name);

  /** For a new one of a product: its name, with the first number behind it that none has yet. */
  [[nodiscard]] std::string MakeName(const std::string& product);

 private:
  [[nodiscard]] Result<record::Reader> Open(const std::string& id) const;
  /** Those that Rename has given, by id. */
  [[nodiscard]] std::map<std::string, std::string> ReadNames() const;
  [[nodiscard]] Result<void> WriteNames(const std::map<std::string, std::string>& names) const;

  /** As of a file that has not changed since. */
  struct Entry {
    std::filesystem::file_time_type written;
    std::uintmax_t bytes{0};
    nlohmann::ordered_json description;  ///< Null for what is no record.
  };

  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;  ///< By id.
};

}  // namespace hvas::studio
