// STEP text: our reader of its entities, measures and tolerances.
#include "cad/step/step_text.h"

#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "cad/step/identities.h"
#include "cad/step/step_measure.h"
#include "cad/step/tolerances.h"
#include "fuzz/target.h"

namespace hvas::fuzz {
namespace {

product::Product MakeProduct() {
  product::Product product;
  product.source = "fuzz.stp";
  product::Part part;
  part.id = product::PartId(0);
  for (std::uint64_t entity = 1; entity <= 2; ++entity) {
    product::Face face;
    face.surface.kind =
        entity == 1 ? spatial::SurfaceKind::kCylinder : spatial::SurfaceKind::kPlane;
    face.surface.radius = 5e-3;
    face.entity = entity;
    part.faces.push_back(face);
  }
  product.parts.push_back(std::move(part));
  return product;
}

}  // namespace

void TestOne(std::string_view bytes) {
  const std::string text(bytes);
  const cad::StepText entities{text};
  for (const auto& statement : entities.statements()) {
    if (const auto measure = cad::ReadMeasure(entities, statement.id, 0)) {
      Check(measure->name.size() <= 3 * text.size());  // A byte takes up to three in UTF-8.
    }
  }
  for (const auto& [id, identity] : cad::ReadIdentities(entities)) {
    Check(id != 0 && !identity.is_empty());
  }
  (void)cad::ReadStepHeader(text);
  product::Product product = MakeProduct();
  Diagnostics diagnostics;
  cad::ReadTolerances(entities, &product, &diagnostics);
  for (const product::Dimension& dimension : product.parts[0].dimensions) {
    Check(std::isfinite(dimension.nominal));
    for (const product::FaceId face : dimension.faces) {
      Check(face.index() < product.parts[0].faces.size());
    }
  }
}

}  // namespace hvas::fuzz
