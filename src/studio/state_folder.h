#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::studio {

/** Reads a small state file that only this user may read.
 Errors: kNotFound when there is none; kInvalid when it is no regular file or other users can read
 it; and those of ReadRegularFile(). */
[[nodiscard]] Result<std::string> ReadPrivateFile(const std::filesystem::path& path);

/** Folder with the state that the next start of the studio resumes from: one for each subject, with
 access for this user only, locked by one process at a time. The lock ends with the process. */
class StateFolder {
 public:
  /** Locks the folder of a subject; makes it when there is none. When another process has it, a
   numbered second one is taken, and so on.
   @param parent  Parent folder, usually $XDG_STATE_HOME/hvas/studio; made when there is none.
   @param subject  File of the product or session of a study; "" for none.
   Errors: kOutOfResource when no folder can be made. */
  [[nodiscard]] static Result<StateFolder> Take(const std::filesystem::path& parent,
                                                std::string_view subject);

  [[nodiscard]] std::filesystem::path access_file() const { return path_ / "access.json"; }

  /** File of AuditLog. */
  [[nodiscard]] std::filesystem::path audit_file() const { return path_ / "audit.log"; }

  [[nodiscard]] std::filesystem::path work_file() const { return path_ / "work.json"; }

  /** Folder of uploaded files; each file has a subfolder of its own. */
  [[nodiscard]] std::filesystem::path uploads() const { return path_ / "uploads"; }

  /** Removes all uploads but `file`, which need not be an upload. */
  void RemoveUploadsBut(const std::filesystem::path& file) const;

 private:
  StateFolder(std::filesystem::path path, Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;
  Descriptor lock_;  ///< A locked file; the system unlocks it when the program ends.
};

}  // namespace hvas::studio
