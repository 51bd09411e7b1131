#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "product/product.h"
#include "studio/json.h"
#include "studio/record_process.h"

namespace hvas::studio {

/** The recordings in a folder, by id: the stem of the file's name. An id from a client is looked up
 among the files that are there, and never made part of a path. Anybody may have made the files:
 another process reads them (record_process.h). Any thread may call any function, except that the
 network thread calls none, as all access the disk. */
class RecordingShelf {
 public:
  /** @param folder  Made with the first recording; empty: recording is switched off. */
  explicit RecordingShelf(std::filesystem::path folder);

  /** Makes the path of a new recording of a product, and its folder. Errors: kUnsupported when
   recording is switched off; kOutOfResource when the folder cannot be made. */
  [[nodiscard]] Result<std::filesystem::path> MakePath(const std::string& product) const;

  /** Makes the field "recordings" of docs/protocol.md, newest first. Other files are skipped.
   @param shared_of  Digest of a product: those of it alone that are shared; none: all.
   @param stop  Leaves out what is not read by then. */
  [[nodiscard]] Json List(const std::optional<std::string>& shared_of = std::nullopt,
                          const std::stop_token& stop = {});

  /** Whether the owner has shared a recording of the product with this digest. Reads no file. */
  [[nodiscard]] bool IsShared(const std::string& id, const std::string& digest) const;

  /** Shares a recording with all who have a link while its product is open, or no more.
   Errors: kNotFound; kInvalid where the recording is of another product; those of WriteAtomically.
   */
  [[nodiscard]] Result<void> Share(const std::string& id, const product::Product& product,
                                   const std::string& digest, bool is_shared);

  /** Path of a recording. Errors: kNotFound. */
  [[nodiscard]] Result<std::filesystem::path> Find(const std::string& id) const;

  /** Makes the description from which a page plays a recording (docs/protocol.md), as JSON. Errors:
   kNotFound; those of ReadInProcess(). */
  [[nodiscard]] Result<std::string> Describe(const std::string& id,
                                             const std::stop_token& stop = {}) const;

  /** Reads what a page plays of a recording. Errors: as Describe(). */
  [[nodiscard]] Result<std::string> Read(const std::string& id, RecordPart part,
                                         const std::stop_token& stop = {}) const;

  [[nodiscard]] Result<void> Delete(const std::string& id);

  /** Changes the display name, in a file beside the records; the record itself, which may be
   evidence, is not modified. Errors: kNotFound; kInvalid for an empty name; those of
   WriteAtomically. */
  [[nodiscard]] Result<void> Rename(const std::string& id, const std::string& name);

  /** Makes a display name for a new recording: the product's, with the first number not in use. */
  [[nodiscard]] std::string MakeName(const std::string& product);

 private:
  /** Names given by Rename, by id. */
  [[nodiscard]] std::map<std::string, std::string> ReadNames() const;
  [[nodiscard]] Result<void> WriteNames(const std::map<std::string, std::string>& names) const;

  /** Whether a recording is on the list of those shared. @pre the mutex is locked. */
  [[nodiscard]] bool HasShared(const std::string& id) const { return shared_.count(id) > 0; }

  /** Cached description of a file; valid while the file's time and size are these. */
  struct Entry {
    std::filesystem::file_time_type written;
    std::uintmax_t bytes{0};
    Json description;  ///< Null for what is no record.
  };

  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;       ///< Cache, by id.
  std::map<std::string, std::string> shared_;  ///< Digest of the product, by id of those shared.
};

}  // namespace hvas::studio
