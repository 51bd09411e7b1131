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
#include "base/parse_json.h"
#include "studio/json_fields.h"
#include "studio/state_folder.h"

namespace hvas::studio {
namespace {

constexpr const char* kSuffix = ".hvasrec";
constexpr const char* kNamesFile = "names.json";
constexpr const char* kSharedFile = "shared.json";  // Digest of the product, by id.

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

/** Reads a file with an object of texts; empty where there is none. */
std::map<std::string, std::string> ReadTexts(const std::filesystem::path& file) {
  std::map<std::string, std::string> texts;
  const auto text = ReadPrivateFile(file);
  const Json json = text ? ParseJson<Json>(*text) : Json();
  if (json.is_object()) {
    for (const auto& [id, told] : json.items()) {
      if (told.is_string()) {
        texts[id] = told.get<std::string>();
      }
    }
  }
  return texts;
}

Result<void> WriteTexts(const std::filesystem::path& file,
                        const std::map<std::string, std::string>& texts) {
  const Json json(texts);
  return WriteAtomically(file, json.dump(1, ' ', false, Json::error_handler_t::replace),
                         FileReaders::kOwner);
}

}  // namespace

RecordingShelf::RecordingShelf(std::filesystem::path folder)
    : folder_(std::move(folder)), shared_(ReadTexts(folder_ / kSharedFile)) {}

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

Json RecordingShelf::List(const std::optional<std::string>& shared_of,
                          const std::stop_token& stop) {
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
    if (is_same) {
      entry.description = before->second.description;
    } else if (auto summary = ReadSummary(item.path(), stop)) {
      summary->erase("product_digest");
      entry.description = *std::move(summary);
    }
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
    const auto shared = shared_.find(id);
    const bool is_shown = !shared_of || (shared != shared_.end() && shared->second == *shared_of);
    if (!entry.description.is_null() && is_shown) {
      list.push_back(entry.description);
      list.back()["is_shared"] = shared != shared_.end();
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
  return Fail(ErrorCode::kNotFound, "there is no such recording", "recording", "reload the list");
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
  RecordLabels labels{given != names.end() ? given->second : "", false};
  {
    const std::lock_guard lock(mutex_);
    labels.is_shared = HasShared(id);
  }
  return ReadInProcess(*file, RecordPart::kDescription, stop, labels);
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
  if (shared_.erase(id) > 0) {
    (void)WriteTexts(folder_ / kSharedFile, shared_);
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
  return ReadTexts(folder_ / kNamesFile);
}

Result<void> RecordingShelf::WriteNames(const std::map<std::string, std::string>& names) const {
  return WriteTexts(folder_ / kNamesFile, names);
}

bool RecordingShelf::IsShared(const std::string& id, const std::string& digest) const {
  const std::lock_guard lock(mutex_);
  const auto found = shared_.find(id);
  return found != shared_.end() && found->second == digest;
}

Result<void> RecordingShelf::Share(const std::string& id, const product::Product& product,
                                   const std::string& digest, bool is_shared) {
  const auto file = Find(id);
  const auto summary = file ? ReadSummary(*file, {}) : Unexpected(file.error());
  if (!summary) {
    return Unexpected(summary.error());
  }
  // Records of before this metadata name the product only.
  const std::string recorded = TextOr(*summary, "product_digest", "");
  const bool is_of_product =
      recorded.empty() ? TextOr(*summary, "product", "") == product.name : recorded == digest;
  if (is_shared && !is_of_product) {
    return Fail(ErrorCode::kInvalid, "this recording is of another product", id,
                "open the product of the recording, then share it");
  }
  const std::lock_guard lock(mutex_);
  auto shared = shared_;
  if (is_shared) {
    shared[id] = digest;
  } else {
    shared.erase(id);
  }
  auto written = WriteTexts(folder_ / kSharedFile, shared);
  if (written) {
    shared_ = std::move(shared);
  }
  return written;
}

}  // namespace hvas::studio
