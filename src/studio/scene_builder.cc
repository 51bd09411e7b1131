#include "studio/scene_builder.h"

#include <utility>

#include "base/digest.h"
#include "cad/glb.h"

namespace hvas::studio {

using SharedScene = std::shared_ptr<const OpenScene>;

Result<SharedScene> SceneBuilder::Open(const std::filesystem::path& file, const std::string& name,
                                       const cad::ProgressFn& progress,
                                       const std::stop_token& stop) {
  auto scene = std::make_shared<OpenScene>();
  auto product = options_.load(file, progress, stop, &scene->diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  auto model = Compile(std::move(*product), name, progress, &scene->diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  if (stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "opening was stopped", name, "");
  }
  auto glb = cad::MakeGlb(*(*model)->product, false);
  if (!glb) {
    return Unexpected(glb.error());
  }
  Digest digest;
  digest.AddText(*glb);
  scene->model = *model;
  scene->glb_hash = digest.Hex();
  scene->glb = std::make_shared<const std::string>(std::move(*glb));
  scene->epoch = ++last_epoch_;
  return scene;
}

SharedScene SceneBuilder::Again(const OpenScene& before) {
  auto scene = std::make_shared<OpenScene>(before);
  scene->epoch = ++last_epoch_;
  return scene;
}

Result<SharedScene> SceneBuilder::Change(const OpenScene& before, const std::string& what,
                                         const ChangeFn& change, const cad::ProgressFn& progress) {
  product::Product product = *before.model->product;
  if (auto changed = change(&product); !changed) {
    return Unexpected(changed.error());
  }
  auto scene = std::make_shared<OpenScene>(before);
  auto model = Compile(std::move(product), what, progress, &scene->diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  scene->model = *model;
  scene->epoch = ++last_epoch_;
  return scene;
}

Result<std::shared_ptr<const simulation::Model>> SceneBuilder::Compile(
    product::Product product, const std::string& name, const cad::ProgressFn& progress,
    Diagnostics* diagnostics) const {
  if (!(product.mass() > 0)) {
    return Fail(ErrorCode::kUnsupported,
                "no part of it has a mass, so there is nothing to assemble", name,
                "export it with its solids, not as surfaces");
  }
  simulation::CompileOptions compile;
  compile.seed = options_.seed;
  compile.shape_cache = options_.shape_cache;
  compile.progress = progress;
  return simulation::Compile(std::make_shared<product::Product>(std::move(product)), compile,
                             diagnostics);
}

}  // namespace hvas::studio
