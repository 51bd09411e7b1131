#pragma once

#include <nlohmann/json_fwd.hpp>

#include "app/product/selection.h"
#include "product/product.h"

/** Joints of several features in `hvas inspect`: threads, prismatic fits and fastened joints
 (section `fits`). */
namespace hvas::app {

/** Adds "threads", "prismatic_fits" and "fastened_joints". */
void AddJointForms(const product::Product& product, const Selection& selection,
                   nlohmann::ordered_json* json);

/** Prints them for people, as far as there are any. */
void PrintJointForms(const product::Product& product, const Selection& selection, bool is_all);

}  // namespace hvas::app
