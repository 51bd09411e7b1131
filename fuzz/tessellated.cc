// STEP text with triangles instead of surfaces.
#include "cad/triangles/tessellated.h"

#include <string>

#include "cad/process/read_cad.h"
#include "fuzz/target.h"

namespace hvas::fuzz {

void TestOne(std::string_view bytes) {
  product::Product product;
  product.name = "fuzz";
  product.source = "fuzz.stp";
  Diagnostics diagnostics;
  const auto read =
      cad::ReadTessellated(cad::StepText(std::string(bytes)), {}, {}, &product, &diagnostics);
  if (!read) {
    Check(!read.error().message.empty());
    return;
  }
  for (const product::Part& part : product.parts) {
    for (const auto& triangle : part.mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        Check(vertex < part.mesh.vertices.size() && part.mesh.vertices[vertex].allFinite());
      }
    }
  }
}

}  // namespace hvas::fuzz
