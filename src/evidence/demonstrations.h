#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "evidence/session_data.h"
#include "simulation/model.h"

namespace hvas::evidence {

/** One moment of a demonstration, in W. */
struct DemonstrationSample {
  double t{0};               ///< Session time [s].
  spatial::Pose X_WB;        ///< The part.
  spatial::Pose X_WH;        ///< The hand.
  spatial::Wrench F_felt_W;  ///< Wrench that the hand was given, about the part's origin.
  double insertion{0};       ///< [m]
};

/** How a part was brought to its place. */
struct Demonstration {
  std::string part;    ///< Path of the occurrence.
  std::string source;  ///< "record" or "plan".
  spatial::Pose X_WB_goal;
  bool is_seated{false};
  std::vector<DemonstrationSample> samples;  ///< Two or more.
};

/** Lists what the hands did in a record: each hold of a part is one demonstration.
 Errors: the reader's; kUnsupported for a record without its product (before schema 3). */
[[nodiscard]] Result<std::vector<Demonstration>> ListDemonstrations(record::Reader* reader,
                                                                    const Selection& selection);

/** Lists the ways in that a model's plan has, each the reverse of a way out: at a steady speed,
 with the hand at the centre of mass and without a force. @param rate  Samples in a second [Hz]. */
[[nodiscard]] std::vector<Demonstration> ListPlannedWays(const simulation::Model& model,
                                                         double rate);

/** Writes demonstrations as HDF5 in the layout of robomimic or, where the name of the file ends in
 .mcap, as MCAP (docs/record.md). Errors: kInvalid for none; kNotFound and kOutOfResource of the
 file.
 @param environment  Name of what they are of; HDF5 only. */
Result<void> WriteDemonstrations(const std::vector<Demonstration>& demonstrations,
                                 const std::string& environment, const std::filesystem::path& file);

/** MCAP for Foxglove and Rerun: `/demonstration` with what each sample is of, and `/tf` with the
 poses. Errors: of the file. */
Result<void> WriteMcap(const std::vector<Demonstration>& demonstrations,
                       const std::filesystem::path& file);

}  // namespace hvas::evidence
