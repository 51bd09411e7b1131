#include "cad/import_arguments.h"

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>

namespace hvas::cad {
namespace {

template <typename T>
bool Parse(const std::string& text, T* value) {
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, *value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

/** Sets the option of a name to what a word says. */
bool Set(const std::string& name, const std::string& word, ImportOptions* options) {
  if (name == "--relative-deflection") {
    return Parse(word, &options->relative_deflection);
  }
  if (name == "--min-deflection") {
    return Parse(word, &options->min_deflection);
  }
  if (name == "--max-angle") {
    return Parse(word, &options->max_angle);
  }
  if (name == "--length-unit") {
    return Parse(word, &options->length_unit.emplace());
  }
  if (name == "--encoding") {
    options->encoding = word;
    return true;
  }
  if (name == "--max-triangles") {
    return Parse(word, &options->max_triangles);
  }
  if (name == "--max-parts") {
    return Parse(word, &options->max_parts);
  }
  if (name == "--max-bytes") {
    return Parse(word, &options->max_bytes);
  }
  if (name == "--threads") {
    return Parse(word, &options->threads);
  }
  return name == "--skip-part" && Parse(word, &options->skipped_parts.emplace_back());
}

}  // namespace

std::vector<std::string> MakeArguments(const ImportOptions& options) {
  std::vector<std::string> arguments;
  const auto add = [&arguments](const char* option, const auto& value) {
    arguments.insert(arguments.end(), {option, fmt::format("{}", value)});
  };
  add("--relative-deflection", options.relative_deflection);
  add("--min-deflection", options.min_deflection);
  add("--max-angle", options.max_angle);
  if (options.length_unit) {
    add("--length-unit", *options.length_unit);
  }
  if (!options.encoding.empty()) {
    add("--encoding", options.encoding);
  }
  add("--max-triangles", options.max_triangles);
  add("--max-parts", options.max_parts);
  add("--max-bytes", options.max_bytes);
  add("--threads", options.threads);
  if (!options.with_tolerances) {
    arguments.emplace_back("--no-tolerances");
  }
  for (const std::uint32_t part : options.skipped_parts) {
    add("--skip-part", part);
  }
  return arguments;
}

std::optional<ImportOptions> ParseArguments(std::span<const std::string> words) {
  ImportOptions options;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--no-tolerances") {
      options.with_tolerances = false;
      continue;
    }
    if (i + 1 == words.size() || !Set(words[i], words[i + 1], &options)) {
      return std::nullopt;
    }
    ++i;
  }
  return options;
}

}  // namespace hvas::cad
