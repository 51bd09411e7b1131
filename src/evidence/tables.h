#pragma once

#include <filesystem>

#include "base/result.h"
#include "evidence/session_data.h"

/** A session as files that other programs read. Each replaces what is there, and leaves nothing
 behind when it fails. Errors: those of the reader, and kOutOfResource or kNotFound of the file. */
namespace hvas::evidence {

/** A row for each tick under the names of TickColumns(). */
Result<void> WriteCsv(record::Reader* reader, const Selection& selection,
                      const std::filesystem::path& file);

/** `meta`, `parts` (paths by id), `columns` with units, `ticks` as rows (null where a number is not
 finite), `events`; `gives`, where parts gave in the span: how far each did at most. */
Result<void> WriteJson(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file);

/** HDF5: `/ticks/NAME`, one data set for each column, with `unit` and `description`; `/events`;
 `/parts`; the record's meta as attributes of the root. */
Result<void> WriteHdf5(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file);

/** MCAP for Foxglove and Rerun, all as JSON: `/hand0` (and `/hand1`) with forces, depth and state,
 `/tf` with the poses of hand and part, `/events` as log. */
Result<void> WriteMcap(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file);

/** glTF 2.0: the way of each part through each hold as a line of its own, in metres, Y up. */
Result<void> WritePathGlb(record::Reader* reader, const Selection& selection,
                          const std::filesystem::path& file);

}  // namespace hvas::evidence
