#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"

namespace hvas::studio {

/** A small file of this user's that a studio has kept.
 Errors: kNotFound when there is none; kInvalid when it is no plain file or others can read it. */
[[nodiscard]] Result<std::string> ReadKeptFile(const std::filesystem::path& file);

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

  KeptFolder(KeptFolder&& other) noexcept;
  KeptFolder& operator=(KeptFolder&& other) noexcept;
  KeptFolder(const KeptFolder&) = delete;
  KeptFolder& operator=(const KeptFolder&) = delete;
  ~KeptFolder();

  [[nodiscard]] std::filesystem::path access_file() const { return path_ / "access.json"; }

  [[nodiscard]] std::filesystem::path work_file() const { return path_ / "work.json"; }

  /** Of files that were sent to it; each lies in a folder of its own. */
  [[nodiscard]] std::filesystem::path uploads() const { return path_ / "uploads"; }

  /** Removes all uploads but one, which may be none of them. */
  void RemoveUploadsBut(const std::filesystem::path& file) const;

 private:
  KeptFolder(std::filesystem::path path, int lock) : path_(std::move(path)), lock_(lock) {}

  std::filesystem::path path_;
  int lock_{-1};  ///< Descriptor of a locked file; the system lets go of it with the program.
};

}  // namespace hvas::studio
