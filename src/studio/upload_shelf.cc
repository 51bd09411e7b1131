#include "studio/upload_shelf.h"

#include <system_error>
#include <utility>

#include "studio/access.h"

namespace hvas::studio {

Result<std::filesystem::path> UploadShelf::Begin(const std::filesystem::path& parent,
                                                 std::uint32_t link) {
  if (coming_.count(link) > 0) {
    return Fail(ErrorCode::kOutOfResource, "another file is still being sent by this link", "",
                "wait until it has arrived");
  }
  const std::filesystem::path folder = parent / MakeToken();
  std::error_code failed;
  if (!std::filesystem::create_directory(folder, failed)) {
    return Fail(ErrorCode::kOutOfResource, "the file cannot be saved", "", "free disk space");
  }
  coming_[link] = folder;
  return folder;
}

void UploadShelf::GiveUp(std::uint32_t link) {
  if (const auto found = coming_.find(link); found != coming_.end()) {
    std::error_code ignored;
    std::filesystem::remove_all(found->second, ignored);
    coming_.erase(found);
  }
}

std::string UploadShelf::Finish(
    std::uint32_t link, Upload upload,
    const std::function<bool(const std::filesystem::path&)>& is_in_use) {
  coming_.erase(link);
  std::erase_if(kept_, [&](const auto& each) {
    const Kept& kept = each.second;
    if (kept.link != link || is_in_use(kept.upload.file)) {
      return false;
    }
    std::error_code ignored;
    std::filesystem::remove_all(kept.upload.file.parent_path(), ignored);
    return true;
  });
  std::string id = MakeToken();
  kept_[id] = {link, std::move(upload)};
  return id;
}

std::optional<UploadShelf::Upload> UploadShelf::Find(const std::string& id) const {
  const auto found = kept_.find(id);
  return found == kept_.end() ? std::nullopt : std::optional(found->second.upload);
}

}  // namespace hvas::studio
