#include "cad/process/worker_import.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "cad/import_result.h"
#include "cad/input_file.h"
#include "cad/process/read_cad.h"
#include "cad/process/worker_io.h"
#include "cad/scene/placed_parts.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

template <typename T>
bool Parse(const std::string& text, T* value) {
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, *value);
  return parsed.ec == std::errc() && parsed.ptr == end;
}

/** The options that the words after the file's name stand for. */
std::optional<ImportOptions> ParseOptions(const std::vector<std::string>& words) {
  ImportOptions options;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--no-tolerances") {
      options.with_tolerances = false;
      continue;
    }
    if (i + 1 == words.size()) {
      return std::nullopt;
    }
    const std::string& name = words[i++];
    bool is_good = false;
    if (name == "--relative-deflection") {
      is_good = Parse(words[i], &options.relative_deflection);
    } else if (name == "--min-deflection") {
      is_good = Parse(words[i], &options.min_deflection);
    } else if (name == "--max-angle") {
      is_good = Parse(words[i], &options.max_angle);
    } else if (name == "--length-unit") {
      is_good = Parse(words[i], &options.length_unit);
    } else if (name == "--max-triangles") {
      is_good = Parse(words[i], &options.max_triangles);
    } else if (name == "--max-parts") {
      is_good = Parse(words[i], &options.max_parts);
    } else if (name == "--max-bytes") {
      is_good = Parse(words[i], &options.max_bytes);
    } else if (name == "--threads") {
      is_good = Parse(words[i], &options.threads);
    } else if (name == "--skip-part") {
      is_good = Parse(words[i], &options.skipped_parts.emplace_back());
    }
    if (!is_good) {
      return std::nullopt;
    }
  }
  return options;
}

}  // namespace

int WorkerImport(const std::vector<std::string>& arguments) {
  const auto options = arguments.empty() ? std::nullopt : ParseOptions(arguments);
  if (!options) {
    return kWorkerUsage;
  }
  const std::filesystem::path file = arguments.front();
  std::vector<std::filesystem::path> referred_files;
  ImportResult result;
  result.product =
      ReadCad(file, *options, &result.diagnostics, {SendStage, SendPart, &referred_files});
  if (!result.product && result.product.error().code == ErrorCode::kOutOfResource) {
    return kWorkerNoMemory;  // Another process may get on with less.
  }
  for (const std::filesystem::path& path : referred_files) {
    result.referred_files.push_back(
        {path.lexically_relative(file.parent_path()).string(), DigestOf(path)});
  }
  std::vector<std::byte> bytes = Serialise(result);
  if (bytes.size() > options->max_bytes) {
    result.product = FailTooManyBytes("the product takes", static_cast<double>(bytes.size()),
                                      options->max_bytes, file.filename().string());
    bytes = Serialise(result);
  }
  return HandOver(bytes);
}

}  // namespace hvas::cad
