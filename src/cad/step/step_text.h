#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/** The exchange structure of ISO 10303-21, as far as single entities: no schema, no geometry. */
namespace hvas::cad {

struct StepValue {
  enum class Kind { kNull, kNumber, kText, kEnum, kReference, kList, kTyped };
  Kind kind{Kind::kNull};  ///< kNull is '$' or '*'.
  double number{0};
  std::uint64_t reference{0};
  std::string text;              ///< The string, the enumeration without dots, or the type's name.
  std::vector<StepValue> items;  ///< Items of a list, or of a typed value.
};

struct StepRecord {
  std::string name;  ///< Name in capitals, as the file has it.
  std::vector<StepValue> values;
};

/** One record, or those of a complex instance in the file's order; none when it cannot be read. */
using StepEntity = std::vector<StepRecord>;

/** The record of that name; null where the entity has none. */
[[nodiscard]] const StepRecord* FindRecord(const StepEntity& entity, std::string_view name);

/** Whether a character separates the tokens of a text: space, tab, line feed, carriage return. */
[[nodiscard]] constexpr bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

[[nodiscard]] StepEntity ParseStepEntity(std::string_view body);

/** The entities of a STEP text by number. Takes any bytes: what is no entity is left out, and of
 two with one number the first counts. Parses an entity when it is asked for. */
class StepText {
 public:
  struct Statement {
    std::uint64_t id{0};
    std::string_view body;  ///< What stands between '=' and ';'.
  };

  explicit StepText(std::string text);
  StepText(const StepText&) = delete;
  StepText& operator=(const StepText&) = delete;

  [[nodiscard]] std::string_view text() const { return text_; }

  [[nodiscard]] const std::vector<Statement>& statements() const { return statements_; }

  /** How much longer lengths are than the units of the text say: not 1 where the user has given
   another unit. */
  [[nodiscard]] double length_scale() const { return length_scale_; }

  void set_length_scale(double scale) { length_scale_ = scale; }

  /** Empty where there is no such entity, or where it cannot be read. */
  [[nodiscard]] StepEntity Find(std::uint64_t id) const;

 private:
  std::string text_;
  std::vector<Statement> statements_;  // By id.
  double length_scale_{1};
};

}  // namespace hvas::cad
