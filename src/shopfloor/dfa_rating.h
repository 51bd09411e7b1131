#pragma once

#include <optional>
#include <string>
#include <vector>

#include "assembly/plan_order.h"
#include "shopfloor/dfa_sheet.h"
#include "shopfloor/part_symmetry.h"
#include "simulation/model.h"

namespace hvas::shopfloor {

/** Why a part may be needed. They are proposals: what has to move, and what has to be of another
 material, only the engineer knows. */
struct NeedOfPart {
  std::optional<std::string> moves;     ///< What says that it moves against its neighbours.
  std::optional<std::string> material;  ///< What says that it has to be of another material.
  std::optional<std::string> apart;     ///< What could not be put in if it were one with others.
  bool is_first{false};                 ///< The first part of the product, which is needed.
  bool is_fastener{false};              ///< It only holds others together.

  [[nodiscard]] bool is_needed() const {
    return is_first || (!is_fastener && (moves || material || apart));
  }
};

/** Equal parts that come in the same way, with what their codes were chosen by. */
struct RatedParts {
  std::vector<product::OccurrenceId> parts;  ///< They stand in the order of assembly.
  PartSymmetry symmetry;
  double size{0};           ///< Largest extent [m].
  double thickness{0};      ///< Smallest extent; half of it where the part is round and long [m].
  std::string handling;     ///< Code of two digits.
  std::string insertion;    ///< Code of two digits.
  std::string handled_as;   ///< What its handling was chosen by, in words.
  std::string inserted_as;  ///< What its insertion was chosen by.
  bool is_hard_to_align{false};
  bool is_held{false};  ///< A hand has to hold it until something secures it.
  NeedOfPart need;
};

/** Something that would make the assembly shorter, tried by reckoning the worksheet without it. */
struct DfaAdvice {
  std::string text;
  double seconds{0};  ///< What it saves [s].
};

/** A product by Boothroyd and Dewhurst. */
struct DfaRating {
  std::vector<RatedParts> groups;  ///< They stand in the order of assembly.
  DfaSheet sheet;                  ///< Its rows are the groups.
  std::vector<DfaAdvice> advice;   ///< What saves most comes first.
};

/** Rates a product by the best order of a plan. Tools and fixtures are not rated.
 Errors: those of MakeDfaSheet. @param plan  As PlanOrder makes it for the model. */
[[nodiscard]] Result<DfaRating> RateAssembly(const simulation::Model& model,
                                             const assembly::OrderPlan& plan);

}  // namespace hvas::shopfloor
