#pragma once

#include <functional>
#include <map>
#include <stop_token>
#include <string>

#include "base/result.h"
#include "shopfloor/instruction_words.h"
#include "shopfloor/work_plan.h"

namespace hvas::shopfloor {

struct InstructionOptions {
  Language language{Language::kEnglish};
  std::string head;  ///< HTML of the company's head, above the title; empty: none.
  /** Script of a viewer and its data, as a whole element of HTML; empty: no third dimension. */
  std::string viewer;
  std::string record;  ///< Name of a record whose times stand beside the plan's; empty: none.
  std::map<product::OccurrenceId, double> recorded_s;  ///< How long each part was in a hand there.
  std::function<void(double fraction)> progress;  ///< Called by the calling thread; may be null.
  std::stop_token stop;
};

/** Makes the page of the work instructions: bill of parts, and for each step a picture, its way,
 fit, tool, torque, force, what to hold, why the order matters, and its time. It needs nothing else,
 is light and dark by what the reader prefers, and prints. Same plan, same bytes. Errors: kCancelled
 after a stop. */
[[nodiscard]] Result<std::string> MakeInstructionPage(const simulation::Model& model,
                                                      const WorkPlan& plan,
                                                      const InstructionOptions& options);

}  // namespace hvas::shopfloor
