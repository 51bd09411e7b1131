#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "base/result.h"
#include "cad/export_step.h"
#include "product/product.h"
#include "record/session_file.h"

namespace hvas::app {

/** Puts occurrences where a file says, in place of where they are drawn: a pose file
 ("hvas-poses-1", data/schemas/poses.schema.json) or a record of `hvas assemble --record`, in which
 each part stays where it was let go last. Occurrences that the file does not speak of stay.
 @returns the motions of those that moved.
 Errors: kNotFound for no such file; kUnreadable, or kInvalid with line and remedy, for what is
 wrong in it; nothing is moved then. */
[[nodiscard]] Result<cad::PartMotions> ApplyPoses(const std::filesystem::path& file,
                                                  product::Product* product);

/** The occurrences of a product by their numbers in a record, which knows their paths.
 @param name  Of the record's file.
 Errors (kInvalid): the record is of another product. */
[[nodiscard]] Result<std::map<std::uint32_t, product::OccurrenceId>> MatchParts(
    const record::Meta& meta, const std::string& name, const product::Product& product);

}  // namespace hvas::app
