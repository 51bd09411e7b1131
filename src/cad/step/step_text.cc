#include "cad/step/step_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

namespace hvas::cad {
namespace {

using Kind = StepValue::Kind;

constexpr int kMaxListDepth = 32;  // Of lists in lists; files have five at most.

bool IsDigit(char c) {
  return c >= '0' && c <= '9';
}

bool IsNameCharacter(char c) {
  return IsDigit(c) || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '!';
}

/** Reads values from a text; every function fails at its end. */
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  [[nodiscard]] char Peek() {
    SkipBlanks();
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool Take(char c) {
    if (Peek() != c || at_ >= text_.size()) {
      return false;
    }
    ++at_;
    return true;
  }

  std::string TakeName() {
    SkipBlanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && IsNameCharacter(text_[at_])) {
      ++at_;
    }
    return std::string(text_.substr(begin, at_ - begin));
  }

  std::optional<std::uint64_t> TakeInteger() {
    SkipBlanks();
    std::uint64_t value = 0;
    const char* begin = text_.data() + at_;
    const auto [end, code] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (code != std::errc()) {
      return std::nullopt;
    }
    at_ += static_cast<std::size_t>(end - begin);
    return value;
  }

  /** "(a, b, c)". */
  bool TakeList(int depth, std::vector<StepValue>* values) {
    if (depth > kMaxListDepth || !Take('(')) {
      return false;
    }
    if (Take(')')) {
      return true;
    }
    do {
      values->emplace_back();
      if (!TakeValue(depth, &values->back())) {
        return false;
      }
    } while (Take(','));
    return Take(')');
  }

  bool TakeRecord(StepRecord* record) {
    record->name = TakeName();
    return !record->name.empty() && TakeList(0, &record->values);
  }

  bool TakeValue(int depth, StepValue* value);

  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  void SkipBlanks() {
    while (at_ < text_.size()) {
      if (IsBlank(text_[at_])) {
        ++at_;
      } else if (text_.compare(at_, 2, "/*") == 0) {
        const std::size_t end = text_.find("*/", at_ + 2);
        at_ = end == std::string_view::npos ? text_.size() : end + 2;
      } else {
        return;
      }
    }
  }

  bool TakeQuoted(char quote, std::string* text) {
    ++at_;
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c != quote) {
        text->push_back(c);
      } else if (at_ < text_.size() && text_[at_] == quote) {
        text->push_back(text_[at_++]);  // A doubled quote is one.
      } else {
        return true;
      }
    }
    return false;
  }

  bool TakeNumber(double* number) {
    if (text_[at_] == '+') {
      ++at_;
    }
    const char* begin = text_.data() + at_;
    const auto [end, code] = std::from_chars(begin, text_.data() + text_.size(), *number);
    at_ += static_cast<std::size_t>(end - begin);
    return code == std::errc() && std::isfinite(*number);
  }

  std::string_view text_;
  std::size_t at_{0};
};

bool Cursor::TakeValue(int depth, StepValue* value) {
  switch (const char c = Peek(); c) {
    case '$':
    case '*':
      ++at_;
      return true;
    case '\'':
    case '"':
      value->kind = Kind::kText;
      return TakeQuoted(c, &value->text);
    case '.':
      value->kind = Kind::kEnum;
      ++at_;
      value->text = TakeName();
      return Take('.');
    case '(':
      value->kind = Kind::kList;
      return TakeList(depth + 1, &value->items);
    case '#': {
      ++at_;
      const auto id = TakeInteger();
      value->kind = Kind::kReference;
      value->reference = id.value_or(0);
      return id.has_value();
    }
    default:
      break;
  }
  const char c = Peek();
  if (IsDigit(c) || c == '-' || c == '+') {
    value->kind = Kind::kNumber;
    return TakeNumber(&value->number);
  }
  value->kind = Kind::kTyped;
  value->text = TakeName();
  return !value->text.empty() && TakeList(depth + 1, &value->items);
}

/** The place after the statement that begins at `begin`: behind its ';', or the end. */
std::size_t FindEnd(std::string_view text, std::size_t begin) {
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == ';') {
      return i + 1;
    }
    if (text[i] == '\'' || text[i] == '"') {
      i = text.find(text[i], i + 1);
    } else if (text[i] == '/' && i + 1 < text.size() && text[i + 1] == '*') {
      i = text.find("*/", i + 2);
      i += i == std::string_view::npos ? 0 : 1;
    }
    if (i == std::string_view::npos) {
      break;
    }
  }
  return std::string_view::npos;
}

}  // namespace

const StepRecord* FindRecord(const StepEntity& entity, std::string_view name) {
  const auto record = std::find_if(entity.begin(), entity.end(),
                                   [name](const StepRecord& r) { return r.name == name; });
  return record == entity.end() ? nullptr : &*record;
}

StepEntity ParseStepEntity(std::string_view body) {
  Cursor cursor(body);
  StepEntity entity;
  if (!cursor.Take('(')) {
    entity.emplace_back();
    return cursor.TakeRecord(&entity.back()) ? entity : StepEntity();
  }
  while (!cursor.Take(')')) {
    entity.emplace_back();
    if (!cursor.TakeRecord(&entity.back())) {
      return {};
    }
  }
  return entity;
}

StepText::StepText(std::string text) : text_(std::move(text)) {
  const std::string_view all = text_;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = FindEnd(all, begin);
    if (end == std::string_view::npos) {
      break;  // Cut off.
    }
    const std::string_view statement = all.substr(begin, end - 1 - begin);
    Cursor cursor(statement);
    if (cursor.Take('#')) {
      const auto id = cursor.TakeInteger();
      if (id && cursor.Take('=')) {
        statements_.push_back({*id, statement.substr(cursor.at())});
      }
    }
    begin = end;
  }
  std::stable_sort(statements_.begin(), statements_.end(),
                   [](const Statement& a, const Statement& b) { return a.id < b.id; });
  statements_.erase(
      std::unique(statements_.begin(), statements_.end(),
                  [](const Statement& a, const Statement& b) { return a.id == b.id; }),
      statements_.end());
}

StepEntity StepText::Find(std::uint64_t id) const {
  const auto it = std::lower_bound(
      statements_.begin(), statements_.end(), id,
      [](const Statement& statement, std::uint64_t i) { return statement.id < i; });
  return it != statements_.end() && it->id == id ? ParseStepEntity(it->body) : StepEntity();
}

}  // namespace hvas::cad
