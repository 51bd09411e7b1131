#include "simulation/shapes.h"

#include <algorithm>
#include <cstdint>
#include <thread>

#include <fmt/format.h>

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
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < shapes.size(); i = next++) {
      const contact::ShapeSource source = MakeShapeSource(product.parts[i]);
      auto shape = control.cache != nullptr ? control.cache->LoadOrBuild(source, control.shape)
                                            : contact::Shape::Build(source, control.shape);
      if (shape) {
        shapes[i] = *shape;
      } else {
        errors[i] = shape.error();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < control.threads; ++i) {
    threads.emplace_back(work);
  }
  work();
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i] == nullptr) {
      Error error = errors[i];
      error.where = fmt::format("{}, part '{}'", product.source, product.parts[i].name);
      return Unexpected(error);
    }
  }
  return shapes;
}

}  // namespace hvas::simulation
