#include "app/study/study_protocol.h"

#include <algorithm>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "app/shipped_files.h"
#include "assembly/prepare_model.h"
#include "study/trial_pair.h"

namespace hvas::app {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> ListShipped() {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(FindStudiesFolder(), failed)) {
    if (entry.path().extension() == ".yaml") {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

Result<study::Protocol> FindProtocol(const std::string& name_or_file) {
  std::error_code failed;
  if (fs::is_regular_file(name_or_file, failed)) {
    return study::ReadProtocol(name_or_file);
  }
  const fs::path shipped = FindStudiesFolder() / (name_or_file + ".yaml");
  const bool is_name = fs::path(name_or_file).filename() == name_or_file;
  if (is_name && fs::is_regular_file(shipped, failed)) {
    return study::ReadProtocol(shipped);
  }
  if (fs::exists(name_or_file, failed)) {
    return study::ReadProtocol(name_or_file);  // Says what it is instead of a file.
  }
  return Fail(ErrorCode::kNotFound, "there is no such protocol", name_or_file,
              fmt::format("give a file, or one of: {}", fmt::join(ListShipped(), ", ")));
}

Result<fs::path> FindProductOf(const study::Protocol& protocol) {
  const fs::path named(protocol.product);
  const fs::path file = named.has_extension() ? protocol.file.parent_path() / named
                                              : FindProductsFolder() / (protocol.product + ".step");
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) {
    return Fail(ErrorCode::kNotFound,
                fmt::format("the product \"{}\" of the protocol does not exist", protocol.product),
                file.string(),
                "correct \"product\": a file relative to the protocol, or the name of an example");
  }
  return file;
}

study::ModelSource MakeModelSource(const fs::path& product, const LoadOptions& load,
                                   std::uint64_t seed) {
  LoadOptions options = load;
  options.file = product;
  return
      [options, seed](const study::Condition& condition,
                      const std::string& part) -> Result<std::shared_ptr<const simulation::Model>> {
        Diagnostics diagnostics;
        auto loaded = LoadProduct(options, &diagnostics);
        if (!loaded) {
          return Unexpected(loaded.error());
        }
        if (const auto applied = study::ApplyFit(condition, part, &*loaded); !applied) {
          return Unexpected(applied.error());
        }
        assembly::PrepareOptions prepare;
        prepare.seed = seed;
        prepare.shape_cache = assembly::MakeShapeCache(CacheDirectory(options));
        return assembly::PrepareModel(std::move(*loaded), prepare, &diagnostics);
      };
}

}  // namespace hvas::app
