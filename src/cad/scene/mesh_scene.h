#pragma once

#include <map>
#include <string>

#include "base/diagnostics.h"
#include "base/result.h"
#include "cad/process/read_cad.h"
#include "cad/scene/mesh_format.h"
#include "product/product.h"

struct aiScene;

namespace hvas::cad {

/** How to understand a scene that assimp has read. */
struct SceneConventions {
  MeshFormat format{MeshFormat::kStl};
  double length_unit{1};  ///< Metres in one unit of the scene.
  bool is_y_up{false};
  std::map<std::string, std::string> names;  ///< Better names, by those in the scene.
};

/** Fills a product, which has its name and source, from a scene. Errors: kUnsupported (more parts
 or triangles than options allow). */
[[nodiscard]] Result<void> BuildSceneProduct(const aiScene& scene,
                                             const SceneConventions& conventions,
                                             const ImportOptions& options, const ReadWatch& watch,
                                             product::Product* product, Diagnostics* diagnostics);

}  // namespace hvas::cad
