#pragma once

#include <string>
#include <string_view>

#include "shopfloor/instruction_words.h"
#include "shopfloor/work_plan.h"

namespace hvas::shopfloor {

/** Makes the element of a page in which the product can be turned, and its steps be played:
 controls, data and script (web/src/instructions/viewer.ts). It is hidden until the script has
 begun, so that nothing is missing where there is no WebGL.
 @param glb  As MakeWorkAnimation() gives it. @param script  The viewer, one script. */
[[nodiscard]] std::string MakeViewerElement(const simulation::Model& model, const WorkPlan& plan,
                                            std::string_view glb, std::string_view script,
                                            Language language);

}  // namespace hvas::shopfloor
