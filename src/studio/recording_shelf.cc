#include "studio/recording_shelf.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/atomic_file.h"
#include "studio/state_folder.h"

namespace hvas::studio {
namespace {

constexpr const char* kSuffix = ".hvasrec";
constexpr const char* kNamesFile = "names.json";

/** Makes the stem of a file name from a product's name: letters, digits and dashes. */
std::string MakeStem(const std::string& name) {
  constexpr std::size_t kLongest = 40;  // Letters of a file's name: a choice.
  std::string stem;
  for (const char letter : name) {
    const bool is_plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                          (letter >= '0' && letter <= '9');
    if (is_plain && stem.size() < kLongest) {
      stem += letter;
    } else if (!stem.empty() && stem.back() != '-') {
      stem += '-';
    }
  }
  return stem.empty() ? "session" : stem;
}

/** Whether an entry of the folder may be a record: a regular file, because a link could lead to any
 file and opening a named pipe blocks. */
bool IsRecordFile(const std::filesystem::directory_entry& item) {
  std::error_code failed;
  return item.path().extension() == kSuffix &&
         item.symlink_status(failed).type() == std::filesystem::file_type::regular;
}

}  // namespace

Result<std::filesystem::path> RecordingShelf::MakePath(const std::string& product) const {
  if (folder_.empty()) {
    return Fail(ErrorCode::kUnsupported,
                "recording is switched off: there is no folder for recordings", "",
                "start the studio with --recordings FOLDER");
  }
  std::error_code failed;
  if (std::filesystem::create_directories(folder_, failed)) {
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all, failed);
  }
  if (failed) {
    return Fail(ErrorCode::kOutOfResource, failed.message(), folder_.string(),
                "start the studio with --recordings FOLDER");
  }
  const std::string stem =
      fmt::format("{}-{:%Y%m%d-%H%M%S}", MakeStem(product), fmt::localtime(std::time(nullptr)));
  std::filesystem::path file = folder_ / (stem + kSuffix);
  for (int i = 2; std::filesystem::exists(file, failed); ++i) {
    file = folder_ / fmt::format("{}-{}{}", stem, i, kSuffix);
  }
  return file;
}

Json RecordingShelf::List(const std::stop_token& stop) {
  std::map<std::string, Entry> entries;
  std::map<std::string, Entry> known;
  {
    const std::lock_guard lock(mutex_);
    known = entries_;
  }
  std::error_code failed;
  for (const auto& item : std::filesystem::directory_iterator(folder_, failed)) {
    if (!IsRecordFile(item)) {
      continue;
    }
    const std::string id = item.path().stem().string();
    Entry entry{item.last_write_time(failed), item.file_size(failed), nullptr};
    const auto before = known.find(id);
    const bool is_same = before != known.end() && before->second.written == entry.written &&
                         before->second.bytes == entry.bytes;
    entry.description = is_same ? before->second.description
                                : ReadSummary(item.path(), stop).value_or(Json(nullptr));
    if (stop.stop_requested()) {
      break;
    }
    entries[id] = std::move(entry);
  }
  const std::lock_guard lock(mutex_);
  entries_ = std::move(entries);
  const auto names = ReadNames();
  std::vector<Json> list;
  for (const auto& [id, entry] : entries_) {
    if (!entry.description.is_null()) {
      list.push_back(entry.description);
      const auto given = names.find(id);
      if (given != names.end()) {
        list.back()["name"] = given->second;
      }
    }
  }
  std::sort(list.begin(), list.end(), [](const Json& a, const Json& b) {
    return a["started_unix_ms"].get<std::int64_t>() > b["started_unix_ms"].get<std::int64_t>();
  });
  return {{"recordings", list}};
}

Result<std::filesystem::path> RecordingShelf::Find(const std::string& id) const {
  std::error_code failed;
  for (const auto& item : std::filesystem::directory_iterator(folder_, failed)) {
    if (IsRecordFile(item) && item.path().stem() == id) {
      return item.path();
    }
  }
  return Fail(ErrorCode::kNotFound, "there is no such recording", id, "reload the list");
}

Result<std::string> RecordingShelf::Read(const std::string& id, RecordPart part,
                                         const std::stop_token& stop) const {
  const auto file = Find(id);
  return file ? ReadInProcess(*file, part, stop) : Unexpected(file.error());
}

Result<std::string> RecordingShelf::Describe(const std::string& id,
                                             const std::stop_token& stop) const {
  const auto file = Find(id);
  if (!file) {
    return Unexpected(file.error());
  }
  const auto names = ReadNames();
  const auto given = names.find(id);
  return ReadInProcess(*file, RecordPart::kDescription, stop,
                       given != names.end() ? given->second : "");
}

Result<void> RecordingShelf::Delete(const std::string& id) {
  const auto file = Find(id);
  if (!file) {
    return Unexpected(file.error());
  }
  std::error_code failed;
  for (const char* suffix : {"-wal", "-shm", ""}) {
    std::filesystem::remove(file->string() + suffix, failed);
  }
  const std::lock_guard lock(mutex_);
  auto names = ReadNames();
  if (names.erase(id) > 0) {
    (void)WriteNames(names);  // a left-over name without a record does no harm
  }
  return failed ? Result<void>(Fail(ErrorCode::kOutOfResource, failed.message(), file->string(),
                                    "delete the file manually"))
                : Result<void>();
}

Result<void> RecordingShelf::Rename(const std::string& id, const std::string& name) {
  constexpr std::size_t kLongestName = 200;  // [bytes]: a line of text. A choice.
  if (name.find_first_not_of(' ') == std::string::npos || name.size() > kLongestName) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("a name needs 1 to {} bytes, and not only spaces", kLongestName), name,
                "choose another name");
  }
  if (const auto file = Find(id); !file) {
    return Unexpected(file.error());
  }
  const std::lock_guard lock(mutex_);
  auto names = ReadNames();
  names[id] = name;
  return WriteNames(names);
}

std::string RecordingShelf::MakeName(const std::string& product) {
  std::set<std::string> taken;
  const Json list = List();
  for (const Json& entry : list["recordings"]) {
    taken.insert(entry["name"].get<std::string>());
  }
  std::string name;
  for (int i = 1; name.empty() || taken.count(name) > 0; ++i) {
    name = fmt::format("{} {}", product, i);
  }
  return name;
}

std::map<std::string, std::string> RecordingShelf::ReadNames() const {
  std::map<std::string, std::string> names;
  const auto text = ReadPrivateFile(folder_ / kNamesFile);
  const Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (json.is_object()) {
    for (const auto& [id, name] : json.items()) {
      if (name.is_string()) {
        names[id] = name.get<std::string>();
      }
    }
  }
  return names;
}

Result<void> RecordingShelf::WriteNames(const std::map<std::string, std::string>& names) const {
  const Json json(names);
  return WriteAtomically(folder_ / kNamesFile,
                         json.dump(1, ' ', false, Json::error_handler_t::replace),
                         FileReaders::kOwner);
}

}  // namespace hvas::studio
