#include "app/product/side_document.h"

#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/parse_json.h"

namespace hvas::app {

using nlohmann::ordered_json;

Result<SideDocument> SideDocument::Open(const std::filesystem::path& file) {
  SideDocument document;
  document.contents_.path = file;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file))) {
    document.json_["format"] = mates::kSideFileFormat;
    return document;
  }
  const Result<std::string> text = mates::ReadSideText(file);
  Result<mates::SideFile> contents =
      text ? mates::ParseSideFile(*text, file) : Unexpected(text.error());
  if (!contents) {
    return Unexpected(contents.error());
  }
  document.contents_ = *std::move(contents);
  document.json_ = ParseJson<ordered_json>(*text);
  document.json_["format"] = mates::kSideFileFormat;
  return document;
}

void SideDocument::Append(const char* list, ordered_json entry) {
  json_[list].push_back(std::move(entry));
  Refresh();
}

ordered_json SideDocument::Take(const char* list, std::size_t index) {
  ordered_json entry = std::move(json_[list][index]);
  json_[list].erase(index);
  if (json_[list].empty()) {
    json_.erase(list);
  }
  Refresh();
  return entry;
}

Result<void> SideDocument::Write() const {
  return WriteAtomically(contents_.path, mates::FormatSideFile(json_));
}

void SideDocument::Refresh() {
  if (auto contents = mates::ParseSideFile(mates::FormatSideFile(json_), contents_.path)) {
    contents_ = *std::move(contents);
  }
}

}  // namespace hvas::app
