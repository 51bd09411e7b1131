#include "cad/process/worker_import.h"

#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "cad/import_arguments.h"
#include "cad/import_result.h"
#include "cad/input_file.h"
#include "cad/process/read_cad.h"
#include "cad/process/worker_io.h"
#include "cad/scene/placed_parts.h"
#include "cad/worker.h"

namespace hvas::cad {
int WorkerImport(const std::vector<std::string>& arguments) {
  const auto options =
      arguments.empty() ? std::nullopt : ParseArguments(std::span(arguments).subspan(1));
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
