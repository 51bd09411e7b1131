#include "studio/workbench_notes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "studio/event_json.h"
#include "studio/json_fields.h"

namespace hvas::studio {

namespace {

Json MakeNote(const std::string& id, const WorkbenchNotes::Remark& remark) {
  return {{"id", id},
          {"by", remark.by},
          {"text", remark.text},
          {"occurrence", remark.occurrence.index()},
          {"p_B_m", ToJson(remark.p_B)}};
}

}  // namespace

namespace {

/** Removes the characters that turn the direction of writing (U+200E, U+200F, U+202A to U+202E,
 U+2066 to U+2069), with which a name could look like another one. */
std::string RemoveDirections(std::string_view text) {
  const auto is_direction = [](std::string_view three) {
    const auto last = static_cast<unsigned char>(three[2]);
    const bool is_first_block = three.starts_with("\xE2\x80") &&
                                (last == 0x8E || last == 0x8F || (last >= 0xAA && last <= 0xAE));
    return is_first_block || (three.starts_with("\xE2\x81") && last >= 0xA6 && last <= 0xA9);
  };
  std::string kept;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.size() - i >= 3 && is_direction(text.substr(i, 3))) {
      i += 2;
    } else {
      kept += text[i];
    }
  }
  return kept;
}

}  // namespace

std::string MakeOneLine(std::string_view text) {
  constexpr char kDelete = 0x7F;
  std::string line = RemoveDirections(text);
  std::replace_if(
      line.begin(), line.end(),
      [](char c) { return (static_cast<unsigned char>(c) < ' ') || c == kDelete; }, ' ');
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : line.substr(first, line.find_last_not_of(' ') - first + 1);
}

Result<std::string> WorkbenchNotes::Add(const Remark& remark) {
  const auto scene = live_->FindScene();
  if (!scene) {
    return Unexpected(scene.error());
  }
  if (remark.occurrence.index() >= (*scene)->model->bodies.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such part",
                fmt::format("occurrence {}", remark.occurrence.index()), "reload the page");
  }
  const std::string text = MakeOneLine(remark.text);
  if (text.empty()) {
    return Fail(ErrorCode::kInvalid, "a note needs a text", "text", "write something");
  }
  std::string id;
  {
    const std::lock_guard lock(mutex_);
    if (notes_.size() >= kMaxNotes) {
      return Fail(ErrorCode::kOutOfResource,
                  fmt::format("there are {} notes, the maximum", kMaxNotes), "",
                  "remove a note first");
    }
    id = fmt::format("n{}", ++last_id_);
    notes_.push_back(MakeNote(id, {remark.by, text, remark.occurrence, remark.p_B}));
  }
  events_->Publish(MakeEvent());
  return id;
}

Result<void> WorkbenchNotes::Remove(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(notes_.begin(), notes_.end(),
                                    [&id](const Json& note) { return note["id"] == id; });
    if (found == notes_.end()) {
      return Fail(ErrorCode::kNotFound, "there is no such note", "note", "it may be gone already");
    }
    notes_.erase(found);
  }
  events_->Publish(MakeEvent());
  return {};
}

Json WorkbenchNotes::MakeEvent() const {
  return {{"event", "notes"}, {"notes", List()}};
}

std::vector<Json> WorkbenchNotes::List() const {
  const std::lock_guard lock(mutex_);
  return notes_;
}

void WorkbenchNotes::Restore(const std::vector<Json>& notes) {
  const auto scene = live_->scene();
  if (scene == nullptr) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    notes_.clear();
    for (const Json& note : notes) {
      const auto text = TextAt(note, "text");
      const auto by = TextAt(note, "by");
      const auto occurrence = IndexAt(note, "occurrence");
      const auto p_B = Vec3At(note, "p_B_m");
      if (text && by && occurrence && p_B && *occurrence < scene->model->bodies.size() &&
          notes_.size() < kMaxNotes) {
        notes_.push_back(MakeNote(fmt::format("n{}", ++last_id_),
                                  {*by, *text, product::OccurrenceId(*occurrence), *p_B}));
      }
    }
  }
  events_->Publish(MakeEvent());
}

void WorkbenchNotes::ConfigureRun(const OpenScene& scene, LiveOptions* /*live*/) {
  const std::lock_guard lock(mutex_);
  if (std::exchange(digest_, scene.digest) != scene.digest) {
    notes_.clear();
  }
}

// A recording begins with a run.
void WorkbenchNotes::OnRunBegun() {
  events_->Publish(MakeEvent());
}

}  // namespace hvas::studio
