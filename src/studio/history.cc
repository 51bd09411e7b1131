#include "studio/history.h"

#include <utility>

#include <fmt/format.h>

namespace hvas::studio {

void History::Remember(SceneSnapshot before, const std::string& what) {
  const std::lock_guard lock(mutex_);
  undo_.push_back({std::move(before), what});
  redo_.clear();
  if (undo_.size() > kMaxMoments) {
    undo_.erase(undo_.begin());
    ++forgotten_;
  }
}

Result<void> History::Check(Direction direction) const {
  const std::lock_guard lock(mutex_);
  const bool is_undo = direction == Direction::kUndo;
  if ((is_undo ? undo_ : redo_).empty()) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("there is nothing to {}", is_undo ? "undo" : "do again"), "", "");
  }
  return {};
}

std::optional<SceneSnapshot> History::Go(Direction direction, const SceneSnapshot& now) {
  const std::lock_guard lock(mutex_);
  auto& from = direction == Direction::kUndo ? undo_ : redo_;
  auto& to = direction == Direction::kUndo ? redo_ : undo_;
  if (from.empty()) {
    return std::nullopt;
  }
  Moment moment = std::move(from.back());
  from.pop_back();
  to.push_back({now, std::move(moment.what)});
  return std::move(moment.scene);
}

void History::Clear() {
  const std::lock_guard lock(mutex_);
  undo_.clear();
  redo_.clear();
  forgotten_ = 0;
}

Json History::Describe() const {
  const std::lock_guard lock(mutex_);
  const auto last = [](const std::vector<Moment>& moments) {
    return moments.empty() ? Json(nullptr) : Json(moments.back().what);
  };
  return {{"event", "history"},
          {"undo", last(undo_)},
          {"redo", last(redo_)},
          {"forgotten", forgotten_}};
}

}  // namespace hvas::studio
