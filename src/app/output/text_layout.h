#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/** Text in columns, of names in any script. */
namespace hvas::app {

/** Columns that a UTF-8 text takes on a terminal: East Asian wide letters take two. */
[[nodiscard]] std::size_t CalcWidth(std::string_view text);

/** The end of a text, after "..", where it is wider than that; control characters become '?'. */
[[nodiscard]] std::string Shorten(std::string_view text, std::size_t width);

/** Shortens as Shorten() does, and fills up with spaces. */
[[nodiscard]] std::string PadTo(std::string_view text, std::size_t width);

/** Words in lines of CountColumns(), each begun with `indent` spaces; ends with a newline. */
[[nodiscard]] std::string Wrap(std::string_view text, std::size_t indent);

/** The text with each line that is wider than CountColumns() broken between words; what follows is
 indented by two more than the line. */
[[nodiscard]] std::string Fold(std::string_view text);

/** A long list that says when it does not show everything. */
class ListLimit {
 public:
  explicit ListLimit(bool is_all) : is_all_(is_all) {}

  /** Counts one more. @returns false where it is not to be shown. */
  [[nodiscard]] bool Next() { return ++count_ <= kMost || is_all_; }

  /** "  ... and 12 more (--all shows them)", where there are more. */
  void PrintRest() const;

 private:
  /** Lines of a list before the rest is only counted: a choice. */
  static constexpr std::size_t kMost = 60;
  bool is_all_;
  std::size_t count_{0};
};

}  // namespace hvas::app
