#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "base/result.h"

namespace hvas::yaml {

/** A YAML document that is being read; JSON documents are YAML, too. It keeps the first error, with
 file, line and column. */
class YamlDocument {
 public:
  /** Parses a text. Errors: kUnreadable for malformed YAML, with line and column. */
  [[nodiscard]] static Result<YamlDocument> Parse(const std::string& text, const std::string& file);

  [[nodiscard]] const YAML::Node& root() const { return root_; }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  /** Keeps an error, unless there is one already. */
  void Refuse(const YAML::Node& at, std::string message, std::string remedy);

 private:
  std::string file_;
  YAML::Node root_;
  std::optional<Error> error_;
};

/** Bounds of a number, both allowed. */
struct Bounds {
  double low{0};
  double high{0};
};

/** The fields of one mapping. Each getter declares its key as known, and Finish() refuses all
 others. A value of another type or out of its range, or a required key that is missing, is refused
 in the document, and the getter returns its default. */
class YamlFields {
 public:
  /** @param entity  Name of the mapping in messages: "condition B1". */
  YamlFields(YamlDocument* document, YAML::Node node, std::string entity);

  [[nodiscard]] bool Has(const std::string& key);
  /** The node of a key; undefined where it is missing. */
  [[nodiscard]] YAML::Node Get(const std::string& key);
  /** The node of a required key. */
  [[nodiscard]] YAML::Node Require(const std::string& key);

  [[nodiscard]] std::string Text(const std::string& key);
  [[nodiscard]] std::string TextOr(const std::string& key, const std::string& otherwise);
  [[nodiscard]] double NumberOr(const std::string& key, Bounds bounds, double otherwise);
  [[nodiscard]] int IntegerOr(const std::string& key, Bounds bounds, int otherwise);
  [[nodiscard]] bool FlagOr(const std::string& key, bool otherwise);
  [[nodiscard]] std::vector<std::string> TextsOr(const std::string& key,
                                                 std::vector<std::string> otherwise);

  /** Reads one of some words as the enumerator with its index. */
  template <typename E>
  [[nodiscard]] E WordOr(const std::string& key, std::span<const std::string_view> words,
                         E otherwise) {
    const std::optional<std::size_t> index = FindWord(key, words);
    return index ? static_cast<E>(*index) : otherwise;
  }

  /** Refuses unknown keys and duplicate keys. */
  void Finish();

  [[nodiscard]] const YAML::Node& node() const { return node_; }

  [[nodiscard]] const std::string& entity() const { return entity_; }

 private:
  [[nodiscard]] std::optional<std::size_t> FindWord(const std::string& key,
                                                    std::span<const std::string_view> words);
  template <typename T>
  [[nodiscard]] T NumberIn(const std::string& key, Bounds bounds, T otherwise,
                           std::string_view what);

  YamlDocument* document_;
  YAML::Node node_;
  std::string entity_;
  std::vector<std::string> asked_;
};

/** Elements of a sequence; refuses a node of another type. */
[[nodiscard]] std::vector<YAML::Node> ListOf(YamlDocument* document, const YAML::Node& node,
                                             const std::string& entity);

/** Numbers of a sequence; none where the node is anything else. */
[[nodiscard]] std::vector<double> NumbersOf(const YAML::Node& node);

}  // namespace hvas::yaml
