#include "studio/recent_files.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "base/atomic_file.h"
#include "base/parse_json.h"
#include "studio/json.h"
#include "studio/state_folder.h"

namespace hvas::studio {

std::vector<std::filesystem::path> LoadRecentFiles(const std::filesystem::path& list) {
  const auto text = ReadPrivateFile(list);
  const Json json = text ? ParseJson<Json>(*text) : Json();
  std::vector<std::filesystem::path> files;
  for (const Json& entry : json.is_array() ? json : Json::array()) {
    std::error_code failed;
    if (entry.is_string() && files.size() < kMaxRecentFiles &&
        std::filesystem::is_regular_file(entry.get<std::string>(), failed)) {
      files.emplace_back(entry.get<std::string>());
    }
  }
  return files;
}

void NoteRecentFile(const std::filesystem::path& list, const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files = LoadRecentFiles(list);
  std::erase(files, file);
  files.insert(files.begin(), file);
  files.resize(std::min(files.size(), kMaxRecentFiles));
  Json json = Json::array();
  for (const std::filesystem::path& each : files) {
    json.push_back(each.string());
  }
  (void)WriteAtomically(list, json.dump(-1, ' ', false, Json::error_handler_t::replace),
                        FileReaders::kOwner);
}

}  // namespace hvas::studio
