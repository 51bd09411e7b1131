#include "simulation/shapes.h"

#include <algorithm>
#include <cstdint>
#include <set>

#include <fmt/format.h>

#include "base/parallel.h"
#include "simulation/model.h"

namespace hvas::simulation {

contact::ShapeSource MakeShapeSource(const product::Part& part) {
  contact::ShapeSource source;
  source.vertices = part.mesh.vertices;
  source.triangles = part.mesh.triangles;
  source.triangle_face.resize(part.mesh.triangles.size());
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    const product::Face& face = part.faces[f];
    source.faces.push_back(face.surface);
    std::fill_n(source.triangle_face.begin() + face.first_triangle, face.triangle_count,
                static_cast<std::uint32_t>(f));
  }
  return source;
}

Result<std::vector<std::shared_ptr<const contact::Shape>>> BuildShapes(
    const product::Product& product, const ShapesControl& control) {
  std::vector<std::shared_ptr<const contact::Shape>> shapes(product.parts.size());
  std::vector<Error> errors(product.parts.size());
  const auto build = [&](std::size_t i) {
    const contact::ShapeSource source = MakeShapeSource(product.parts[i]);
    auto shape = control.cache != nullptr ? control.cache->LoadOrBuild(source, control.shape)
                                          : contact::Shape::Build(source, control.shape);
    if (shape) {
      shapes[i] = *shape;
    } else {
      errors[i] = shape.error();
    }
  };
  ForEachIndex(shapes.size(), static_cast<unsigned>(std::max(1, control.threads)), build,
               [&](std::size_t done) {
                 if (control.progress) {
                   control.progress(static_cast<double>(done) / static_cast<double>(shapes.size()));
                 }
               });
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i] == nullptr) {
      Error error = errors[i];
      error.where = fmt::format("{}, part '{}'", product.source, product.parts[i].name);
      return Unexpected(error);
    }
  }
  return shapes;
}

contact::ShapeMemory CalcShapeMemory(const Model& model) {
  std::set<const contact::Shape*> seen;
  contact::ShapeMemory sum;
  for (const Body& body : model.bodies) {
    if (seen.insert(body.shape.get()).second) {
      sum += body.shape->CalcMemory();
    }
  }
  return sum;
}

}  // namespace hvas::simulation
