#include "cad/import_cache.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "base/digest.h"
#include "cad/input_file.h"
#include "cad/mesh_folder.h"
#include "product/product_io.h"

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;

// To be raised whenever entries are named or written differently.
constexpr std::int64_t kVersion = 5;
constexpr const char* kExtension = ".hvasproduct";
constexpr std::size_t kKeyLength = 32;  // Hex digits of 128 bits.

/** Tells builds of the worker apart. */
void AddWorker(const fs::path& worker, Digest* digest) {
  struct stat status {};

  if (::stat(worker.c_str(), &status) == 0) {
    digest->AddInt(status.st_size);
    digest->AddInt(status.st_mtim.tv_sec);
    digest->AddInt(status.st_mtim.tv_nsec);
  }
}

std::string KeyOf(const fs::path& worker, const fs::path& file, const ImportOptions& options) {
  // A new option has to be added here and to the arguments of the process (import_arguments.cc).
  const auto& [relative_deflection, min_deflection, max_angle, max_triangles, length_unit, encoding,
               with_tolerances, skipped_parts, max_parts, threads, max_bytes] = options;
  static_cast<void>(threads);    // The result does not depend on it.
  static_cast<void>(max_bytes);  // Nor on this one, where there is a result.
  Digest digest;
  digest.AddInt(kVersion);
  digest.AddInt(product::kProductFormat);
  AddWorker(worker, &digest);
  digest.AddDouble(relative_deflection);
  digest.AddDouble(min_deflection);
  digest.AddDouble(max_angle);
  digest.AddInt(static_cast<std::int64_t>(max_triangles));
  digest.AddInt(static_cast<std::int64_t>(max_parts));
  digest.AddInt(with_tolerances ? 1 : 0);
  digest.AddInt(static_cast<std::int64_t>(skipped_parts.size()));
  for (const std::uint32_t part : skipped_parts) {
    digest.AddInt(part);
  }
  digest.AddDouble(length_unit.value_or(0));
  digest.AddText(encoding);
  digest.AddText(file.filename().string());  // It is in the product.
  digest.AddText(fs::is_directory(file) ? DigestOfMeshes(file) : DigestOf(file));
  return digest.Hex();
}

}  // namespace

ImportCache::ImportCache(fs::path directory, const fs::path& worker, fs::path file,
                         const ImportOptions& options, std::uintmax_t capacity)
    : files_(std::move(directory), kExtension, capacity),
      file_(std::move(file)),
      key_(KeyOf(worker, file_, options)),
      path_(files_.PathOf(key_)) {}

std::optional<ImportResult> ImportCache::Load() const {
  const auto file = MappedFile::Open(path_);
  if (!file || file->bytes().size() < kKeyLength ||
      std::memcmp(file->bytes().data(), key_.data(), kKeyLength) != 0) {
    return std::nullopt;
  }
  const auto bytes = file->bytes().subspan(kKeyLength);
  auto result = DeserialiseImportResult(bytes);
  if (!result || !AreUnchanged(result->referred_files)) {
    return std::nullopt;
  }
  files_.Touch(key_);
  return result;
}

bool ImportCache::AreUnchanged(const std::vector<ReferredFile>& files) const {
  return std::all_of(files.begin(), files.end(), [this](const ReferredFile& file) {
    return DigestOf(file_.parent_path() / file.path) == file.digest;
  });
}

bool ImportCache::Store(std::span<const std::byte> result) const {
  return files_.Store(key_, {std::as_bytes(std::span(key_)), result});
}

}  // namespace hvas::cad
