#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas {

/** A regular file that is open for reading; closed with the object. */
class RegularFile {
 public:
  /** Opens what a user names as a file. A folder, pipe, socket or device is refused and never
   waited for, nor touched: opening one can hang the program, or do something to the machine.
   Errors: kNotFound, kUnreadable; each says which file, why not, and what to do. */
  [[nodiscard]] static Result<RegularFile> Open(const std::filesystem::path& path);

  /** Takes a file that the caller has opened for reading; `path` is for the messages. Errors as
   Open(). */
  [[nodiscard]] static Result<RegularFile> Take(Descriptor file, const std::filesystem::path& path);

  [[nodiscard]] int descriptor() const { return file_.value(); }

  /** When it was opened [bytes]. */
  [[nodiscard]] std::uintmax_t size() const { return size_; }

 private:
  RegularFile(Descriptor file, std::uintmax_t size) : file_(std::move(file)), size_(size) {}

  Descriptor file_;
  std::uintmax_t size_{0};
};

/** Whether what other libraries are to open by its name is a regular file that can be read. Errors
 as RegularFile::Open(). */
[[nodiscard]] Result<void> CheckRegularFile(const std::filesystem::path& path);

/** The bytes of a regular file from its beginning, `most` of them where there are more. Errors as
 RegularFile::Open(), and kUnreadable when the disk fails. */
[[nodiscard]] Result<std::string> ReadFileHead(const std::filesystem::path& path, std::size_t most);

/** All bytes of a regular file. Errors as ReadFileHead(), and kUnsupported when there are more than
 `largest`. */
[[nodiscard]] Result<std::string> ReadRegularFile(
    const std::filesystem::path& path,
    std::size_t largest = std::numeric_limits<std::size_t>::max() / 2);

/** All bytes of one that is open; `path` is for the messages. */
[[nodiscard]] Result<std::string> ReadRegularFile(const RegularFile& file,
                                                  const std::filesystem::path& path,
                                                  std::size_t largest);

}  // namespace hvas
