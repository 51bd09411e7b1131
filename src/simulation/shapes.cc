#include "simulation/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <thread>

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

namespace {

// Parts in the order in which they are built: large ones first, so that none is left over for the
// end; each with the share of the cores that its triangles are of all that are left.
struct PlannedPart {
  std::size_t part;
  unsigned threads;
};

std::vector<PlannedPart> PlanParts(const product::Product& product,
                                   const std::vector<product::PartId>& parts, unsigned cores) {
  std::vector<PlannedPart> planned;
  for (const product::PartId id : parts) {
    planned.push_back({id.index(), 1});
  }
  const auto size_of = [&product](const PlannedPart& item) {
    return product.parts[item.part].mesh.triangles.size();
  };
  std::stable_sort(planned.begin(), planned.end(), [&](const PlannedPart& a, const PlannedPart& b) {
    return size_of(a) > size_of(b);
  });
  std::size_t left = 0;
  for (auto item = planned.rbegin(); item != planned.rend(); ++item) {
    const std::size_t size = size_of(*item);
    left += size;
    const double share =
        static_cast<double>(size) / static_cast<double>(std::max<std::size_t>(left, 1));
    item->threads = static_cast<unsigned>(std::max(1.0, std::ceil(share * cores)));
  }
  return planned;
}

}  // namespace

Result<void> AddShapes(const product::Product& product, const std::vector<product::PartId>& parts,
                       const ShapesControl& control, PartShapes* shapes) {
  std::vector<Error> errors(product.parts.size());
  const unsigned cores =
      control.threads > 0 ? control.threads : std::max(1U, std::thread::hardware_concurrency());
  const std::vector<PlannedPart> planned = PlanParts(product, parts, cores);
  const auto build = [&](std::size_t k) {
    const std::size_t i = planned[k].part;
    contact::ShapeOptions options = control.shape;
    options.threads = planned[k].threads;
    const contact::ShapeSource source = MakeShapeSource(product.parts[i]);
    auto shape = control.cache != nullptr ? control.cache->LoadOrBuild(source, options)
                                          : contact::Shape::Build(source, options);
    if (shape) {
      (*shapes)[i] = *shape;
    } else {
      errors[i] = shape.error();
    }
  };
  const std::size_t before = shapes->size() - ListWithoutShape(*shapes).size();
  ForEachIndex(planned.size(), cores, build, [&](std::size_t done) {
    if (control.progress) {
      control.progress(static_cast<double>(before + done) / static_cast<double>(shapes->size()));
    }
  });
  for (const product::PartId id : parts) {
    if ((*shapes)[id.index()] == nullptr) {
      Error error = errors[id.index()];
      error.where = fmt::format("{}, part '{}'", product.source, product.parts[id.index()].name);
      return Unexpected(error);
    }
  }
  return {};
}

Result<PartShapes> BuildShapes(const product::Product& product, const ShapesControl& control) {
  PartShapes shapes(product.parts.size());
  if (const auto added = AddShapes(product, ListWithoutShape(shapes), control, &shapes); !added) {
    return Unexpected(added.error());
  }
  return shapes;
}

std::vector<product::PartId> ListWithoutShape(const PartShapes& shapes) {
  std::vector<product::PartId> missing;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i] == nullptr) {
      missing.emplace_back(i);
    }
  }
  return missing;
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
