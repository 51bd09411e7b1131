#include "yaml/yaml_fields.h"

#include <algorithm>
#include <cmath>

#include "mates/side_file.h"

namespace hvas::yaml {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;  // [bytes], a thousand pages of text: a choice.

std::string FormatMark(const std::string& file, const YAML::Mark& mark) {
  return mark.is_null() ? file : fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1);
}

std::string Print(double x) {
  return fmt::format("{:g}", x);
}

}  // namespace

Result<YamlDocument> YamlDocument::Parse(const std::string& text, const std::string& file) {
  if (text.size() > kMaxBytes) {
    return Fail(ErrorCode::kInvalid, "the file is too long", file, "shorten it to less than 1 MB");
  }
  YamlDocument document;
  document.file_ = file;
  try {
    document.root_ = YAML::Load(text);
  } catch (const YAML::Exception& exception) {
    return Fail(ErrorCode::kUnreadable, "the file is not valid YAML: " + exception.msg,
                FormatMark(file, exception.mark),
                "correct the indentation or the quotes at this place");
  }
  return document;
}

void YamlDocument::Refuse(const YAML::Node& at, std::string message, std::string remedy) {
  if (!error_) {
    const YAML::Mark mark = at.IsDefined() ? at.Mark() : YAML::Mark::null_mark();
    error_ =
        Error{ErrorCode::kInvalid, std::move(message), FormatMark(file_, mark), std::move(remedy)};
  }
}

YamlFields::YamlFields(YamlDocument* document, YAML::Node node, std::string entity)
    : document_(document), node_(std::move(node)), entity_(std::move(entity)) {
  if (!node_.IsMap()) {
    document_->Refuse(node_, fmt::format("{} is not a mapping of keys to values", entity_),
                      "write it as `key: value` lines");
    node_ = YAML::Node(YAML::NodeType::Map);
  }
}

YAML::Node YamlFields::Get(const std::string& key) {
  asked_.push_back(key);
  const YAML::Node& here = node_;  // const, so that looking up a key does not insert it
  return here[key];
}

bool YamlFields::Has(const std::string& key) {
  return Get(key).IsDefined();
}

YAML::Node YamlFields::Require(const std::string& key) {
  YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    document_->Refuse(node_, fmt::format("{} has no \"{}\"", entity_, key),
                      fmt::format("add `{}:`", key));
  }
  return value;
}

std::string YamlFields::Text(const std::string& key) {
  return Require(key).IsDefined() ? TextOr(key, "") : "";
}

std::string YamlFields::TextOr(const std::string& key, const std::string& otherwise) {
  const YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    return otherwise;
  }
  if (!value.IsScalar() || value.Scalar().empty()) {
    document_->Refuse(value, fmt::format("\"{}\" of {} is not a text", key, entity_),
                      "write a text, in quotes where it has a colon");
    return otherwise;
  }
  return value.Scalar();
}

template <typename T>
T YamlFields::NumberIn(const std::string& key, Bounds bounds, T otherwise, std::string_view what) {
  const YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    return otherwise;
  }
  T number{};
  const bool is_quoted = value.Tag() == "!";
  if (!value.IsScalar() || is_quoted || !YAML::convert<T>::decode(value, number) ||
      !std::isfinite(static_cast<double>(number))) {
    document_->Refuse(
        value, fmt::format("\"{}\" of {} is not {}", key, entity_, what),
        fmt::format("write a number from {} to {}", Print(bounds.low), Print(bounds.high)));
    return otherwise;
  }
  if (static_cast<double>(number) < bounds.low || static_cast<double>(number) > bounds.high) {
    document_->Refuse(
        value,
        fmt::format("\"{}\" of {} is {}, which is out of its range", key, entity_,
                    Print(static_cast<double>(number))),
        fmt::format("write a number from {} to {}", Print(bounds.low), Print(bounds.high)));
    return otherwise;
  }
  return number;
}

double YamlFields::NumberOr(const std::string& key, Bounds bounds, double otherwise) {
  return NumberIn(key, bounds, otherwise, "a number");
}

int YamlFields::IntegerOr(const std::string& key, Bounds bounds, int otherwise) {
  return NumberIn(key, bounds, otherwise, "a whole number");
}

bool YamlFields::FlagOr(const std::string& key, bool otherwise) {
  const YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    return otherwise;
  }
  if (value.IsScalar() && (value.Scalar() == "true" || value.Scalar() == "false")) {
    return value.Scalar() == "true";
  }
  document_->Refuse(value, fmt::format("\"{}\" of {} is neither true nor false", key, entity_),
                    "write true or false");
  return otherwise;
}

std::vector<std::string> YamlFields::TextsOr(const std::string& key,
                                             std::vector<std::string> otherwise) {
  const YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    return otherwise;
  }
  std::vector<std::string> texts;
  for (const YAML::Node& item : ListOf(document_, value, fmt::format("\"{}\"", key))) {
    if (!item.IsScalar()) {
      document_->Refuse(item,
                        fmt::format("\"{}\" of {} has an element that is not a text", key, entity_),
                        "write it as [A, B, C]");
      return otherwise;
    }
    texts.push_back(item.Scalar());
  }
  return texts;
}

std::optional<std::size_t> YamlFields::FindWord(const std::string& key,
                                                std::span<const std::string_view> words) {
  const YAML::Node value = Get(key);
  if (!value.IsDefined()) {
    return std::nullopt;
  }
  const std::string text = value.IsScalar() ? value.Scalar() : "";
  const auto found = std::find(words.begin(), words.end(), text);
  if (found == words.end()) {
    document_->Refuse(value,
                      fmt::format("\"{}\" of {} is \"{}\", which is not known", key, entity_, text),
                      fmt::format("write one of: {}", fmt::join(words, ", ")));
    return std::nullopt;
  }
  return static_cast<std::size_t>(found - words.begin());
}

void YamlFields::Finish() {
  std::vector<std::string> seen;
  for (const auto& item : node_) {
    const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
      const std::string nearest = mates::FindNearest(key, asked_);
      document_->Refuse(
          item.first, fmt::format("{} has an unknown key: \"{}\"", entity_, key),
          nearest.empty() ? "remove it" : fmt::format("did you mean \"{}\"?", nearest));
    }
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      document_->Refuse(item.first, fmt::format("{} has \"{}\" twice", entity_, key),
                        "remove one of them");
    }
    seen.push_back(key);
  }
}

std::vector<YAML::Node> ListOf(YamlDocument* document, const YAML::Node& node,
                               const std::string& entity) {
  if (!node.IsSequence()) {
    document->Refuse(node, fmt::format("{} is not a list", entity),
                     "write each element on a line of its own, after `- `");
    return {};
  }
  return {node.begin(), node.end()};
}

std::vector<double> NumbersOf(const YAML::Node& node) {
  std::vector<double> numbers;
  for (std::size_t i = 0; node.IsSequence() && i < node.size(); ++i) {
    double number = 0;
    if (!node[i].IsScalar() || !YAML::convert<double>::decode(node[i], number) ||
        !std::isfinite(number)) {
      return {};
    }
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace hvas::yaml
