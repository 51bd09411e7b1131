#pragma once

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "base/work_watch.h"
#include "cad/import.h"
#include "product/product.h"

/** HVAS for programs that build on it: from a CAD file to the account of each part.

   hvas::Diagnostics diagnostics;
   hvas::assembly::OpenOptions open;
   open.file = "products/gear_pump.step";
   auto product = hvas::assembly::OpenProduct(open, &diagnostics);
   if (!product) { ... product.error().ToString() ... }
   auto model = hvas::assembly::PrepareModel(*std::move(product), {}, &diagnostics);
   if (!model) { ... }
   const auto outcome = hvas::assembly::RunAssembly(*model, {});
   if (outcome && outcome->is_complete()) { ... outcome->digest ... }

 The whole of it, with what becomes of the errors, is examples/assemble_product.cc. */
namespace hvas::assembly {

/** Which file is opened, and what that may take. */
struct OpenOptions {
  std::filesystem::path file;     ///< STEP, STL, OBJ, glTF or 3MF.
  std::vector<std::string> fits;  ///< "AXIS=FIT", as mates::AssignFit takes them.
  double length_unit{1e-3};       ///< The unit of files that state none (OBJ, STL) [m], > 0.
  WorkLimits limits;              ///< What opening the file with all that belongs to it may take.
  int max_parts{cad::kDefaultMaxParts};  ///< That the file may place, 1 to cad::kLargestMaxParts.
  /** Keeps what was read, for the next time; FileCache::DefaultDirectory() is the user's own. None:
   nothing is kept. */
  std::optional<std::filesystem::path> cache_directory;
  cad::ProgressFn progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;      ///< Ends the opening at once when a stop is asked for.
};

/** Opens a CAD file: imported, mates inferred, and nothing yet of what its files state about mates.
 All lengths are in metres, poses in the world frame W of the file.
 Errors: kInvalid for options out of range; those of cad::Import; kOutOfResource where a limit is
 reached, and kCancelled after a stop. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> OpenInferred(const OpenOptions& options,
                                                    Diagnostics* diagnostics);

/** Opens a CAD file ready to assemble: as OpenInferred, with the mates and fits that its side file
 NAME.hvas.json states (mates::ApplyAssignments), or the fits that it states itself where there is
 no side file, and over them `fits`.
 Errors: those of OpenInferred, mates::ApplyAssignments and mates::AssignFit.
 @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> OpenProduct(const OpenOptions& options,
                                                   Diagnostics* diagnostics);

}  // namespace hvas::assembly
