#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "product/product.h"

namespace hvas::cad {

/** A file that the imported one refers to. */
struct ReferredFile {
  std::string path;    ///< Path from the folder of the imported file.
  std::string digest;  ///< Digest of its bytes; empty where it cannot be read.
};

/** What the reading process hands over. */
struct ImportResult {
  Result<product::Product> product;
  Diagnostics diagnostics;
  std::vector<ReferredFile> referred_files;
};

/** The result as bytes with a checksum. */
[[nodiscard]] std::vector<std::byte> Serialise(const ImportResult& result);

/** Takes any bytes; none for those that Serialise did not make, or another version of it. */
[[nodiscard]] std::optional<ImportResult> DeserialiseImportResult(std::span<const std::byte> bytes);

/** The files alone, without the product. */
[[nodiscard]] std::optional<std::vector<ReferredFile>> DeserialiseReferredFiles(
    std::span<const std::byte> bytes);

}  // namespace hvas::cad
