#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "assembly/open_product.h"
#include "base/test/temporary_folder.h"
#include "exchange/exported_product.h"

namespace hvas::exchange::testing {

inline const std::filesystem::path kProducts = std::filesystem::path(HVAS_SOURCE_DIR) / "products";

inline product::Product Open(const std::filesystem::path& file) {
  Diagnostics diagnostics;
  assembly::OpenOptions options;
  options.file = file;
  auto product = assembly::OpenProduct(options, &diagnostics);
  EXPECT_TRUE(product.has_value()) << product.error().ToString();
  return std::move(*product);
}

/** The peg of 20 mm in a bore that is measured with this clearance in the diameter [mm]. */
product::Product OpenPeg(double clearance_mm);

}  // namespace hvas::exchange::testing
