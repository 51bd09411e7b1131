#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::studio {

/** A small file of this user's that a studio has kept.
 Errors: kNotFound when there is none; kInvalid when it is no plain file or others can read it; and
 as ReadRegularFile(). */
[[nodiscard]] Result<std::string> ReadKeptFile(const std::filesystem::path& path);

/** Where a studio keeps what the next start goes on with: one folder for each subject, that nobody
 else can enter, and that one program has at a time, however it ends. */
class KeptFolder {
 public:
  /** @param parent  Is made; $XDG_STATE_HOME/hvas/studio.
   @param subject  Of what it is: the product's file, a study's session; "" for none. Where another
   program has the folder, there is a second one, and so on.
   Errors (kOutOfResource): it cannot be made. */
  [[nodiscard]] static Result<KeptFolder> Take(const std::filesystem::path& parent,
                                               std::string_view subject);

  [[nodiscard]] std::filesystem::path access_file() const { return path_ / "access.json"; }

  [[nodiscard]] std::filesystem::path work_file() const { return path_ / "work.json"; }

  /** The folder of files that were sent to it; each lies in a folder of its own. */
  [[nodiscard]] std::filesystem::path uploads() const { return path_ / "uploads"; }

  /** Removes all uploads but one, which may be none of them. */
  void RemoveUploadsBut(const std::filesystem::path& file) const;

 private:
  KeptFolder(std::filesystem::path path, Descriptor lock)
      : path_(std::move(path)), lock_(std::move(lock)) {}

  std::filesystem::path path_;
  Descriptor lock_;  ///< A locked file; the system unlocks it when the program ends.
};

}  // namespace hvas::studio
