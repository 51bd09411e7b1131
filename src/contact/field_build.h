#pragma once

#include "contact/shape_data.h"

namespace hvas::contact {

/** Voxel that resolves the part's radii within the memory that a part may take. */
[[nodiscard]] double ChooseVoxel(const Mesh& mesh, const std::vector<spatial::Surface>& faces);

/** Fills data->field and data->exact's zones from data->mesh, data->exact.faces and data->voxel, on
 options.threads; the same for any number of them. When a stop is asked for, what it leaves behind
 is no use. */
void BuildField(const ShapeOptions& options, Shape::Data* data);

/** Finds for each face the largest distance between its mesh and its surface; faces whose surface
 does not fit the mesh become freeform, faces oriented the wrong way are turned round. */
void CheckFaces(const Mesh& mesh, ExactTable* exact);

}  // namespace hvas::contact
