#pragma once

#include <string>
#include <vector>

#include "app/product/load_product.h"
#include "base/result.h"
#include "study/protocol.h"
#include "study/simulated_study.h"

namespace hvas::app {

/** Reads a protocol: a file, or one that comes with the program, by its id. Errors: those of
 study::ReadProtocol; kNotFound names those that there are. */
[[nodiscard]] Result<study::Protocol> FindProtocol(const std::string& name_or_file);

/** The CAD file of a protocol: beside it, or an example by its name. Errors: kNotFound. */
[[nodiscard]] Result<std::filesystem::path> FindProductOf(const study::Protocol& protocol);

/** Compiles a product with a part's fit. @param load  All but the file and the fits.
 @param seed  Draws the actual sizes. */
[[nodiscard]] study::ModelSource MakeModelSource(const std::filesystem::path& product,
                                                 const LoadOptions& load, std::uint64_t seed);

}  // namespace hvas::app
