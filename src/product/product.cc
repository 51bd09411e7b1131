#include "product/product.h"

#include <algorithm>

namespace hvas::product {

int Product::depth() const {
  int deepest = 0;
  for (const Occurrence& occurrence : occurrences) {
    int levels = 0;
    for (SubassemblyId id = occurrence.parent; id.is_valid();
         id = subassemblies[id.index()].parent) {
      ++levels;
    }
    deepest = std::max(deepest, levels);
  }
  return deepest;
}

double Product::volume() const {
  double sum = 0;
  for (const Occurrence& occurrence : occurrences) {
    sum += part_of(occurrence.id).mass.volume;
  }
  return sum;
}

double Product::mass() const {
  double sum = 0;
  for (const Occurrence& occurrence : occurrences) {
    sum += part_of(occurrence.id).mass.mass;
  }
  return sum;
}

std::vector<FaceId> FacesOf(const Product& product, const Connector& side) {
  const std::vector<Feature>& features = product.part_of(side.occurrence).features;
  std::vector<FaceId> faces = features[side.feature.index()].faces;
  if (side.opposite.is_valid()) {
    const std::vector<FaceId>& more = features[side.opposite.index()].faces;
    faces.insert(faces.end(), more.begin(), more.end());
  }
  return faces;
}

const DrawingError* FindDrawingError(const Product& product, OccurrenceId a, OccurrenceId b) {
  const auto found =
      std::find_if(product.drawing_errors.begin(), product.drawing_errors.end(),
                   [a, b](const DrawingError& error) {
                     return (error.a == a && error.b == b) || (error.a == b && error.b == a);
                   });
  return found == product.drawing_errors.end() ? nullptr : &*found;
}

}  // namespace hvas::product
