#include "app/output/number_range.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace hvas::app {
namespace {

/** The number that the whole text is; none where it is not one, or outside the range of T. */
template <typename T>
std::optional<T> ParseWhole(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') {
    text.remove_prefix(1);
  }
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::optional<double> ParseFinite(std::string_view text) {
  const auto value = ParseWhole<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/** A validator of what is a number; what is none is left to CheckNumbers(). */
template <typename Accepts>
CLI::Validator MakeRange(const Accepts& accepts, const std::string& complaint,
                         const std::string& description) {
  return CLI::Validator(
      [accepts, complaint](const std::string& text) {
        const auto value = ParseFinite(text);
        return !value || accepts(*value) ? std::string() : text + " " + complaint;
      },
      description);
}

/** Writes a whole number in the one way that CLI11 reads as it stands: "010" is 8 to it. */
template <typename T>
std::string TakeInteger(const char* what, std::string* text) {
  const auto value = ParseWhole<T>(*text);
  if (!value) {
    return fmt::format("needs {}, not \"{}\"", what, *text);
  }
  *text = fmt::format("{}", *value);
  return {};
}

std::string TakeUnsigned(std::string& text) {
  return TakeInteger<std::uint64_t>("a whole number of 0 or more", &text);
}

std::string TakeSigned(std::string& text) {
  return TakeInteger<std::int64_t>("a whole number", &text);
}

std::string TakeFinite(std::string& text) {
  return ParseFinite(text) ? std::string() : fmt::format("needs a number, not \"{}\"", text);
}

/** Adds a check that may change the text, behind all that the option has: transform() would put it
 before those that take a unit away. */
void AddLast(CLI::Option* option, std::string (*take)(std::string&)) {
  constexpr const char* kName = "form of a number";
  option->check(CLI::Validator(std::function<std::string(std::string&)>(take), "", kName));
  option->get_validator(kName)->non_modifying(false);
}

void CheckNumber(CLI::Option* option) {
  const std::string type = option->get_type_name();
  if (option->get_expected_max() == 0) {  // A flag.
    return;
  }
  if (type.starts_with("UINT")) {
    if (type == "UINT") {
      option->check(NotNegative());
    }
    AddLast(option, &TakeUnsigned);
  } else if (type.starts_with("INT")) {
    AddLast(option, &TakeSigned);
  } else if (type.starts_with("FLOAT")) {
    AddLast(option, &TakeFinite);
  }
}

}  // namespace

const CLI::Validator& Positive() {
  static const CLI::Validator validator =
      MakeRange([](double value) { return value > 0; }, "is not above 0", "OVER 0");
  return validator;
}

const CLI::Validator& NotNegative() {
  static const CLI::Validator validator =
      MakeRange([](double value) { return value >= 0; }, "is negative", "0 OR MORE");
  return validator;
}

const CLI::Validator& AnyNumber() {
  static const CLI::Validator validator =
      MakeRange([](double /*value*/) { return true; }, "", "ANY NUMBER");
  return validator;
}

CLI::Validator Between(double least, double most) {
  return MakeRange([least, most](double value) { return value > least && value < most; },
                   fmt::format("is not above {} and below {}", least, most),
                   fmt::format("OVER {}, BELOW {}", least, most));
}

CLI::Validator FromBelow(double least, double most) {
  return MakeRange([least, most](double value) { return value >= least && value < most; },
                   fmt::format("is not {} or more and below {}", least, most),
                   fmt::format("{} OR MORE, BELOW {}", least, most));
}

CLI::Validator Count(std::int64_t most) {
  return CLI::Validator(
      [most](std::string& text) {
        const auto value = ParseFinite(text);
        if (!value || *value != std::floor(*value) || !(*value >= 1)) {
          return text + " is not a positive whole number";
        }
        if (!(*value <= static_cast<double>(most))) {
          return fmt::format("{} is above the maximum, {}", text, most);
        }
        text = fmt::format("{}", static_cast<std::int64_t>(*value));
        return std::string();
      },
      fmt::format("1 TO {}", most));
}

const CLI::Validator& Bytes() {
  static const CLI::Validator validator(
      [](std::string& text) {
        constexpr std::string_view kPrefixes = "kmgtpe";
        const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
        const std::string unit = CLI::detail::to_lower(text.substr(digits));
        const std::size_t power = unit.empty() ? std::string_view::npos : kPrefixes.find(unit[0]);
        const std::string rest =
            power == std::string_view::npos ? unit : unit.substr(1);  // "b", "ib" or nothing.
        const bool is_unit = rest.empty() || rest == "b" ||
                             (power != std::string_view::npos && (rest == "i" || rest == "ib"));
        const auto value = ParseWhole<std::uint64_t>(std::string_view(text).substr(0, digits));
        const auto shift = power == std::string_view::npos ? 0 : 10 * (power + 1);
        if (!is_unit || !value || *value == 0 ||
            *value > std::numeric_limits<std::uint64_t>::max() >> shift) {
          return fmt::format("needs a number of bytes such as 8GB, not \"{}\"", text);
        }
        text = fmt::format("{}", *value << shift);
        return std::string();
      },
      "1 OR MORE");
  return validator;
}

void CheckNumbers(CLI::App* app) {
  for (CLI::Option* option : app->get_options()) {
    CheckNumber(option);
  }
  for (CLI::App* below : app->get_subcommands([](const CLI::App*) { return true; })) {
    CheckNumbers(below);
  }
}

}  // namespace hvas::app
