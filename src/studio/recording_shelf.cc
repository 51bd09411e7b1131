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
#include "record/reader.h"
#include "studio/json_fields.h"
#include "studio/recording.h"
#include "studio/state_folder.h"

namespace hvas::studio {
namespace {

constexpr const char* kSuffix = ".hvasrec";
constexpr const char* kNamesFile = "names.json";
constexpr const char* kSharedFile = "shared.json";  // Digest of the product, by id.
constexpr std::int64_t kNsPerMs = 1'000'000;        // A definition.

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

std::string TextOf(const record::Meta& meta, const std::string& key) {
  const auto found = meta.find(key);
  return found == meta.end() ? "" : found->second;
}

Json DescribeFile(const std::string& id, const std::filesystem::path& file, std::uintmax_t bytes) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return nullptr;
  }
  const record::Meta& meta = reader->meta();
  const std::string name = TextOf(meta, kNameMeta);
  const std::string product = TextOf(meta, "product");
  const std::int64_t started_ns = std::atoll(TextOf(meta, record::kMetaStarted).c_str());
  return {{"id", id},
          {"name", name.empty() ? product : name},
          {"product", product},
          {"started_unix_ms", started_ns / kNsPerMs},
          {"duration_s", 1e-9 * static_cast<double>(reader->ReadLength().value_or(0))},
          {"is_complete", reader->is_complete()},
          {"bytes", bytes}};
}

/** Accumulates the results of each part's holds from the events "dropped". */
class Results {
 public:
  void Add(const Json& dropped, const std::vector<std::string>& paths) {
    const auto occurrence = IndexOr(dropped, "occurrence", record::kNoOccurrence);
    Json& result = FindOrAdd(occurrence, paths);
    const Json& metrics = dropped.at("metrics");
    const auto add = [&](const char* key, const char* from, double unit) {
      result[key] = result[key].get<double>() + unit * NumberOr(metrics, from, 0);
    };
    const auto keep_largest = [&](const char* key, const char* from) {
      result[key] = std::max(result[key].get<double>(), NumberOr(metrics, from, 0));
    };
    result["is_seated"] = FlagOr(dropped, "was_seated", false);
    add("time_s", "time_s", 1);
    add("path_m", "path_mm", 1e-3);
    add("collisions", "collisions", 1);
    keep_largest("peak_true_n", "peak_true_n");
    keep_largest("peak_felt_n", "peak_felt_n");
    keep_largest("insertion_mm", "insertion_mm");
  }

  [[nodiscard]] const Json& list() const { return list_; }

 private:
  Json& FindOrAdd(std::uint32_t occurrence, const std::vector<std::string>& paths) {
    for (Json& result : list_) {
      if (result["occurrence"] == occurrence) {
        return result;
      }
    }
    list_.push_back({{"occurrence", occurrence},
                     {"path", occurrence < paths.size() ? paths[occurrence] : ""},
                     {"is_seated", false},
                     {"time_s", 0.0},
                     {"path_m", 0.0},
                     {"peak_true_n", 0.0},
                     {"peak_felt_n", 0.0},
                     {"collisions", 0.0},
                     {"insertion_mm", 0.0}});
    return list_.back();
  }

  Json list_ = Json::array();
};

std::vector<std::string> PathsOf(const record::Meta& meta) {
  std::vector<std::string> paths;
  const Json parts = ParseJson<Json>(TextOf(meta, "model_json"));
  if (parts.is_array()) {
    for (const Json& part : parts) {
      paths.push_back(TextOr(part, "path", ""));
    }
  }
  return paths;
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

Json RecordingShelf::List(const std::optional<std::string>& shared_of) {
  const std::lock_guard lock(mutex_);
  std::map<std::string, Entry> entries;
  std::error_code failed;
  for (const auto& item : std::filesystem::directory_iterator(folder_, failed)) {
    if (!IsRecordFile(item)) {
      continue;
    }
    const std::string id = item.path().stem().string();
    Entry entry{item.last_write_time(failed), item.file_size(failed), nullptr};
    const auto known = entries_.find(id);
    const bool is_same = known != entries_.end() && known->second.written == entry.written &&
                         known->second.bytes == entry.bytes;
    entry.description =
        is_same ? known->second.description : DescribeFile(id, item.path(), entry.bytes);
    entries[id] = std::move(entry);
  }
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
  return Fail(ErrorCode::kNotFound, "there is no such recording", id, "reload the list");
}

Result<record::Reader> RecordingShelf::Open(const std::string& id) const {
  const auto file = Find(id);
  return file ? record::Reader::Open(*file) : Unexpected(file.error());
}

Result<Json> RecordingShelf::Describe(const std::string& id) const {
  auto reader = Open(id);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto told = reader->ReadEvents();
  if (!told) {
    return Unexpected(told.error());
  }
  std::error_code failed;
  Json json = DescribeFile(id, reader->path(), std::filesystem::file_size(reader->path(), failed));
  const auto names = ReadNames();
  if (const auto given = names.find(id); given != names.end()) {
    json["name"] = given->second;
  }
  {
    const std::lock_guard lock(mutex_);
    json["is_shared"] = HasShared(id);
  }
  const std::string route = "/api/recording/" + id;
  json["scene"] = route + "/scene";
  json["glb"] = route + "/model.glb";
  json["frames"] = route + "/frames";
  Results results;
  Json& events = json["events"] = Json::array();
  for (const record::Event& event : *told) {
    Json one = event.kind == kClientEventKind ? ParseJson<Json>(event.json) : Json();
    if (!one.is_object()) {
      continue;
    }
    if (TextOr(one, "event", "") == "dropped" && one.contains("metrics")) {
      results.Add(one, PathsOf(reader->meta()));
    }
    one["t_ns"] = event.t_ns;
    events.push_back(std::move(one));
  }
  json["results"] = results.list();
  return json;
}

Result<std::string> RecordingShelf::ReadFrames(const std::string& id) const {
  auto reader = Open(id);
  if (!reader) {
    return Unexpected(reader.error());
  }
  std::string bytes;
  const auto read = reader->ForEachFrame({}, [&bytes](const record::Frame& frame) {
    bytes.append(reinterpret_cast<const char*>(frame.bytes.data()), frame.bytes.size());
    return true;
  });
  return read ? Result<std::string>(std::move(bytes)) : Unexpected(read.error());
}

Result<std::string> RecordingShelf::ReadAttachment(const std::string& id,
                                                   const std::string& name) const {
  auto reader = Open(id);
  if (!reader) {
    return Unexpected(reader.error());
  }
  const auto bytes = reader->ReadAttachment(name);
  if (!bytes) {
    return Unexpected(bytes.error());
  }
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
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
  const auto reader = Open(id);
  if (!reader) {
    return Unexpected(reader.error());
  }
  // Records of before this metadata name the product only.
  const std::string recorded = TextOf(reader->meta(), kProductDigestMeta);
  const bool is_of_product =
      recorded.empty() ? TextOf(reader->meta(), "product") == product.name : recorded == digest;
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
