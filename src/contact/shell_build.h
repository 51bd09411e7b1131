#pragma once

#include "contact/shape_data.h"

namespace hvas::contact {

/** Spacing of samples on faces, from the part's size and area [m]. */
[[nodiscard]] double ChooseSpacing(const Mesh& mesh);

/** Samples faces, convex edges and corners of data->mesh, data->spacing apart, and builds both
 sphere trees. Two parts that touch do so where one of them has an edge or is convex: flat and
 hollow faces get few samples, and straight ones few along their lines. */
void BuildShells(Shape::Data* data);

}  // namespace hvas::contact
