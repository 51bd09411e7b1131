#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "base/result.h"
#include "cad/export_step.h"
#include "product/product.h"
#include "record/session_file.h"
#include "spatial/pose.h"

namespace hvas::app {

/** Puts occurrences where a file says, in place of where they are drawn: a pose file
 ("hvas-poses-1", data/schemas/poses.schema.json) or a record of `hvas assemble --record`, in which
 each part stays where it was let go last. Occurrences that the file does not speak of stay.
 @returns the motions of those that moved, from where the file has them.
 Errors: kNotFound for no such file; kUnreadable, or kInvalid with line and remedy, for what is
 wrong in it; nothing is moved then. */
[[nodiscard]] Result<cad::PartMotions> ApplyPoses(const std::filesystem::path& file,
                                                  product::Product* product);

/** Reads where the parts of a product stood at a moment of a record, for the parts that were where
 they belong: let go before that moment, or never taken, which counts as in place. Parts that were
 taken for the first time after it lay on the table, and are left out; in a record of a disassembly
 they were in place. Errors: those of ApplyPoses for a record.
 @param t_ns  Session time. */
[[nodiscard]] Result<std::map<product::OccurrenceId, spatial::Pose>> ReadPosesBeside(
    const std::filesystem::path& file, const product::Product& product, std::int64_t t_ns);

/** The motions of the parts that mates of the user have put elsewhere than the file has them. */
[[nodiscard]] cad::PartMotions ListPlacedMotions(const product::Product& product);

/** The occurrences of a product by their numbers in a record, which knows their paths.
 @param name  Of the record's file.
 Errors (kInvalid): the record is of another product. */
[[nodiscard]] Result<std::map<std::uint32_t, product::OccurrenceId>> MatchParts(
    const record::Meta& meta, const std::string& name, const product::Product& product);

}  // namespace hvas::app
