#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "base/result.h"

namespace hvas::studio {

/** Files that clients have sent. The users of a link send one file at a time, and one file of
 theirs is kept besides that of the open product: the next one takes its place. For one thread. */
class UploadShelf {
 public:
  struct Upload {
    std::filesystem::path file;
    std::string name;  ///< Name that its sender has given.
  };

  /** Makes the folder for a file that is about to come. @param link  Visitor::link().
   Errors: kOutOfResource while another file of this link comes, or where the folder cannot be made.
   */
  [[nodiscard]] Result<std::filesystem::path> Begin(const std::filesystem::path& parent,
                                                    std::uint32_t link);

  /** Removes what has come of a file that was refused or broke off. */
  void GiveUp(std::uint32_t link);

  /** Registers a file that has come whole, and removes the ones before it of the same link.
   @param is_in_use  Whether a file is still needed: that of the product that is open, or is being
   opened. @returns the id by which a client can open it. */
  [[nodiscard]] std::string Finish(
      std::uint32_t link, Upload upload,
      const std::function<bool(const std::filesystem::path&)>& is_in_use);

  [[nodiscard]] std::optional<Upload> Find(const std::string& id) const;

 private:
  struct Kept {
    std::uint32_t link;
    Upload upload;
  };

  std::map<std::string, Kept> kept_;                       ///< Files that have come, by id.
  std::map<std::uint32_t, std::filesystem::path> coming_;  ///< Folder of the file, by link.
};

}  // namespace hvas::studio
