#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "product/product.h"

namespace hvas::app {

/** Opens a CAD file ready to assemble: imported, mates inferred, the fits of the side file
 NAME.hvas.json (if there is one) and then those of the command line assigned.

 @param fits  Texts "AXIS=FIT" as given to --fit.
 Errors: those of cad::Import and of the assignments. */
Result<product::Product> LoadProduct(const std::filesystem::path& file,
                                     const std::vector<std::string>& fits, Diagnostics* diagnostics,
                                     const std::function<void(std::string_view, double)>& progress);

}  // namespace hvas::app
