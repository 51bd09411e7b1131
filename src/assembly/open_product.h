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

/** HVAS for programs that build on it: from a CAD file to the results of each part.

   hvas::Diagnostics diagnostics;
   hvas::assembly::OpenOptions open;
   open.file = "products/gear_pump.step";
   auto product = hvas::assembly::OpenProduct(open, &diagnostics);
   if (!product) { ... product.error().ToString() ... }
   auto model = hvas::assembly::PrepareModel(*std::move(product), {}, &diagnostics);
   if (!model) { ... }
   const auto outcome = hvas::assembly::RunAssembly(*model, {});
   if (outcome && outcome->is_complete()) { ... outcome->digest ... }

 examples/assemble_product.cc is a complete program with its errors. */
namespace hvas::assembly {

/** The file to open, and limits of the work on it. */
struct OpenOptions {
  std::filesystem::path file;      ///< STEP, IGES, a mesh file or a folder of meshes.
  std::vector<std::string> fits;   ///< "AXIS=FIT", as mates::AssignFit takes them.
  std::vector<std::string> apart;  ///< What is not to be welded (product::KeptApart); "all".
  std::vector<std::string> rigid;  ///< What may not give (mates::SetFlexibleParts); "all".
  std::vector<std::string> tools;  ///< CAD files of tools that lie on the table (X16).
  /** CAD files of fixtures: "FILE" as drawn, or "FILE@X,Y,Z" or "FILE@X,Y,Z,ANGLE" [mm, deg], which
   moves them in W and turns them about z before. */
  std::vector<std::string> fixtures;
  std::vector<std::string> bench;  ///< CAD files of fixtures that stand on the table.
  /** The unit of length of the file, whatever it states [m], > 0 (cad::ImportOptions). */
  std::optional<double> length_unit;
  std::string encoding;                  ///< Encoding of names in STEP files; empty: it is guessed.
  WorkLimits limits;                     ///< Limits for opening the file, mates included.
  int max_parts{cad::kDefaultMaxParts};  ///< Largest number of parts, 1 to cad::kLargestMaxParts.
  /** Directory of the cache; FileCache::DefaultDirectory() is the user's. None: nothing is cached.
   */
  std::optional<std::filesystem::path> cache_directory;
  cad::ProgressFn progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;      ///< Ends the opening at once when a stop is asked for.
};

/** What of these options concerns the import. */
[[nodiscard]] cad::ImportOptions MakeImportOptions(const OpenOptions& options);

/** Imports a CAD file, welds what cannot come apart (product::WeldUnits) but for `apart` and what
 the side file names so, and infers its mates, without what its files state about mates. All lengths
 are in metres, poses in the world frame W of the file. Errors: kInvalid for options out of range;
 those of cad::Import, product::WeldUnits and mates::ReadSideFile; kOutOfResource where a limit is
 reached, and kCancelled after a stop. @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> OpenInferred(const OpenOptions& options,
                                                    Diagnostics* diagnostics);

/** Opens a CAD file ready to assemble. On top of OpenInferred it applies the mates and fits of the
 side file NAME.hvas.json (mates::ApplyAssignments), which also places the parts where mates of the
 user say (mates::PlaceByMates), or, where there is no side file, the fits
 stated in the CAD file; then `fits`, which take precedence; then tools and fixtures as accessories
 of the product (product/accessories.h), without mates. Errors: those of OpenInferred,
 mates::ApplyAssignments and mates::AssignFit; those of cad::Import for tools and fixtures.
 @pre diagnostics != nullptr. */
[[nodiscard]] Result<product::Product> OpenProduct(const OpenOptions& options,
                                                   Diagnostics* diagnostics);

/** Does what OpenProduct does after the import, with a product that has been imported or was made
 in memory. Only the side file of `options.file` is read. Errors: those of OpenProduct but
 cad::Import's for the product. @pre diagnostics != nullptr. @param imported  Valid
 (product::Validate). */
[[nodiscard]] Result<product::Product> OpenImported(product::Product imported,
                                                    const OpenOptions& options,
                                                    Diagnostics* diagnostics);

}  // namespace hvas::assembly
