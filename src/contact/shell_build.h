#pragma once

#include "contact/shape_data.h"

namespace hvas::contact {

/** Spacing of samples on faces, from the part's size and area [m]. */
[[nodiscard]] double ChooseSpacing(const Mesh& mesh);

/** Samples faces, convex edges and corners of data->mesh and builds both sphere trees. */
void BuildShells(double spacing, Shape::Data* data);

}  // namespace hvas::contact
