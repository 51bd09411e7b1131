#pragma once

#include <optional>
#include <vector>

#include "product/drive_forms.h"
#include "product/product.h"

namespace hvas::simulation {

/** A tool's drive on the drive of a fastener (X16; docs/algorithms/tools.md). */
struct ToolMate {
  product::DriveForm fastener;  ///< Drive in the fastener's frame.
  product::DriveForm tool;      ///< Drive in the tool's frame.
  double engaged{0};            ///< Length of the flats that are in one another [m].
  double play{0};               ///< Angle by which the tool turns without the fastener [rad].
  double pitch{0};              ///< Angle between two ways to put it on [rad].
};

/** The angle by which a bit turns in a recess of the same kind, from one stop to the other [rad];
 none where it does not go in, or would turn without taking the fastener with it. */
[[nodiscard]] std::optional<double> CalcDrivePlay(const product::DriveForm& recess,
                                                  const product::DriveForm& bit);

/** The mate of two drives; none where they do not fit one another. */
[[nodiscard]] std::optional<ToolMate> MakeToolMate(const product::DriveForm& fastener,
                                                   const product::DriveForm& tool);

/** All ways in which drives of a tool fit those of a fastener. */
[[nodiscard]] std::vector<ToolMate> ListToolMates(const std::vector<product::DriveForm>& fastener,
                                                  const std::vector<product::DriveForm>& tool);

/** Travel of a fastener's thread in a turn [m]; 0 where it is not known. */
[[nodiscard]] double FindLead(const product::Part& fastener);

}  // namespace hvas::simulation
