#include "mates/located_json.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace hvas::mates {
namespace {

using nlohmann::json;

constexpr std::size_t kDeepest = 32;       // Levels, far above what a side file has.
constexpr std::size_t kLongestShown = 40;  // Letters of a value in a message: a choice.
constexpr std::size_t kMostKeys = 1000;    // Ordered objects are searched key by key.

int CountLines(std::string_view text, std::size_t byte) {
  return 1 + static_cast<int>(std::count(
                 text.begin(),
                 text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size())), '\n'));
}

/** Walks over the tokens of a text that may or may not be JSON (nlohmann says later) and notes
 where values begin. Stops at the first thing that cannot be JSON. */
class LineScanner {
 public:
  LineScanner(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

  Result<std::map<std::string, int>> Scan() {
    while (at_ < text_.size() && !is_over_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
      }
      if (c == '{' || c == '[') {
        if (const auto opened = Open(c == '{'); !opened) {
          return Unexpected(opened.error());
        }
      } else if (c == '"') {
        if (const auto text = ReadString(); !text) {
          return Unexpected(text.error());
        }
      } else if (c == '}' || c == ']') {
        Close();
      } else if (c == ',') {
        Next();
      } else if (c == ':') {
        is_value_next_ = true;
      } else if (is_value_next_ && c > ' ') {
        if (const auto number = CheckNumber(); !number) {
          return Unexpected(number.error());
        }
        Note();
      }
      ++at_;
    }
    return std::move(lines_);
  }

 private:
  struct Level {
    bool is_object;
    std::string pointer;
    std::size_t index{0};
    std::string key;
    std::set<std::string> keys;
  };

  [[nodiscard]] std::string MakePointer() const {
    if (levels_.empty()) {
      return "";
    }
    const Level& level = levels_.back();
    return level.pointer + "/" + (level.is_object ? level.key : std::to_string(level.index));
  }

  /** What begins here, if it is a number, is one that a double can hold. */
  [[nodiscard]] Result<void> CheckNumber() const {
    constexpr std::string_view kOfNumbers = "+-.0123456789eE";
    const std::string_view rest = text_.substr(at_);
    const std::string word(rest.substr(0, rest.find_first_not_of(kOfNumbers)));
    if (!std::isfinite(std::strtod(word.c_str(), nullptr))) {
      return Fail(
          ErrorCode::kInvalid,
          fmt::format("\"{}\" is {}, which is out of the range of numbers", MakePointer(),
                      word.size() > kLongestShown ? word.substr(0, kLongestShown) + "..." : word),
          fmt::format("{}:{}", file_, line_), "write a number of plausible size");
    }
    return {};
  }

  void Note() {
    lines_.emplace(MakePointer(), line_);
    is_value_next_ = false;
  }

  Result<void> Open(bool is_object) {
    if (levels_.size() == kDeepest) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("the file is nested deeper than {} levels", kDeepest),
                  fmt::format("{}:{}", file_, line_), "remove the inner levels");
    }
    std::string pointer = MakePointer();
    Note();
    levels_.push_back({is_object, std::move(pointer), 0, "", {}});
    is_value_next_ = !is_object;
    return {};
  }

  void Close() {
    is_over_ = levels_.size() <= 1;
    if (!levels_.empty()) {
      levels_.pop_back();
    }
    is_value_next_ = false;
  }

  void Next() {
    if (!levels_.empty()) {
      ++levels_.back().index;
      is_value_next_ = !levels_.back().is_object;
    }
  }

  /** A value, or a key, which must not have been there before. */
  Result<void> ReadString() {
    const std::size_t first = at_++;
    while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') {
      at_ += text_[at_] == '\\' ? 2U : 1U;
    }
    if (at_ >= text_.size() || text_[at_] == '\n') {
      is_over_ = true;
      return {};
    }
    if (is_value_next_) {
      Note();
      return {};
    }
    const json key = json::parse(text_.substr(first, at_ + 1 - first), nullptr, false);
    if (levels_.empty() || !key.is_string()) {
      is_over_ = true;
      return {};
    }
    Level& level = levels_.back();
    level.key = key.get<std::string>();
    if (!level.keys.insert(level.key).second) {
      return Fail(ErrorCode::kInvalid, fmt::format("\"{}\" occurs twice", level.key),
                  fmt::format("{}:{}", file_, line_), "keep one of the two");
    }
    if (level.keys.size() > kMostKeys) {
      return Fail(ErrorCode::kInvalid, fmt::format("an object has more than {} keys", kMostKeys),
                  fmt::format("{}:{}", file_, line_), "remove the keys that do not belong there");
    }
    return {};
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_{0};
  int line_{1};
  bool is_value_next_{true};
  bool is_over_{false};
  std::vector<Level> levels_;
  std::map<std::string, int> lines_;
};

}  // namespace

int LocatedJson::LineOf(std::string pointer) const {
  while (true) {
    if (const auto found = lines.find(pointer); found != lines.end()) {
      return found->second;
    }
    if (pointer.empty()) {
      return 1;
    }
    const std::size_t slash = pointer.rfind('/');
    pointer.resize(slash == std::string::npos ? 0 : slash);
  }
}

Result<LocatedJson> ParseLocatedJson(std::string_view text, const std::string& file) {
  auto lines = LineScanner(text, file).Scan();
  if (!lines) {
    return Unexpected(lines.error());
  }
  try {
    return LocatedJson{nlohmann::ordered_json::parse(text), *std::move(lines)};
  } catch (const json::parse_error& error) {
    const std::string_view what = error.what();
    const std::size_t said = what.find(": ");  // After "[json...] parse error at line 1, column 2".
    return Fail(
        ErrorCode::kUnreadable,
        fmt::format("the file is not JSON: {}",
                    said == std::string_view::npos ? what : what.substr(said + 2)),
        fmt::format("{}:{}", file, CountLines(text, std::max<std::size_t>(error.byte, 1) - 1)),
        "correct this place; often a quote, comma or bracket is missing");
  } catch (const json::exception& error) {
    return Fail(ErrorCode::kUnreadable, fmt::format("the file is not JSON: {}", error.what()), file,
                "check it with a JSON validator");
  }
}

}  // namespace hvas::mates
