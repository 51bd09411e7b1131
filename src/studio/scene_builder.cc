#include "studio/scene_builder.h"

#include <optional>
#include <system_error>
#include <utility>

#include "assembly/plan_order.h"
#include "base/digest.h"
#include "cad/glb.h"
#include "orders/order_rules.h"
#include "orders/order_search.h"
#include "studio/commands.h"
#include "studio/event_json.h"
#include "studio/gzip.h"
#include "studio/json_fields.h"
#include "studio/saved_work.h"

namespace hvas::studio {

using SharedScene = std::shared_ptr<const OpenScene>;

namespace {

/** Whether an edit of a scene is its order, and no change of its product. */
bool IsOrder(const Json& edit) {
  return TextOr(edit, "command", "") == protocol::SetOrderCommand::kName;
}

/** Replaces what mates of the user have made of the poses before by what they make of them now. */
Diagnostics ReplacePlacement(const Diagnostics& before, const product::Product& product) {
  Diagnostics now;
  for (const Diagnostic& item : before.items()) {
    if (!item.code.starts_with("mate-")) {
      now.Add(item);
    }
  }
  for (const Diagnostic& item : product.placement.diagnostics.items()) {
    if (item.code.starts_with("mate-")) {
      now.Add(item);
    }
  }
  return now;
}

/** Makes the meshes that clients show. Errors: those of cad::MakeGlb. */
Result<void> GiveMeshes(const product::Product& product, OpenScene* scene) {
  auto glb = cad::MakeGlb(product, false);
  if (!glb) {
    return Unexpected(glb.error());
  }
  Digest digest;
  digest.AddText(*glb);
  scene->glb_hash = digest.Hex();
  scene->glb_gzip = std::make_shared<const std::string>(Gzip(*glb));
  scene->glb = std::make_shared<const std::string>(std::move(*glb));
  return {};
}

}  // namespace

Result<SharedScene> SceneBuilder::Open(const std::filesystem::path& file, const std::string& name,
                                       const cad::ProgressFn& progress, const std::stop_token& stop,
                                       const SceneFn& on_first_parts) {
  OpenScene scene;
  auto product = options_.load(file, progress, stop, &scene.diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  std::error_code failed;
  scene.file = std::filesystem::absolute(file, failed);
  scene.name = name;
  scene.digest = CalcProductDigest(*product);
  if (auto given = GiveMeshes(*product, &scene); !given) {
    return Unexpected(given.error());
  }
  assembly::PrepareOptions prepare = MakeOptions(name, progress);
  prepare.stop = stop;
  if (on_first_parts) {
    prepare.least_gain = options_.least_gain;
    prepare.on_first_parts = [&](const std::shared_ptr<const simulation::Model>& model) {
      on_first_parts(MakeCopy(scene, model));
    };
  }
  auto model = assembly::PrepareModel(std::move(*product), prepare, &scene.diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  if (stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "opening the file was cancelled", name, "");
  }
  return MakeCopy(scene, std::move(*model));
}

SharedScene SceneBuilder::MakeCopy(const OpenScene& before,
                                   std::shared_ptr<const simulation::Model> model) {
  auto scene = std::make_shared<OpenScene>(before);
  scene->model = std::move(model);
  scene->epoch = ++last_epoch_;
  return scene;
}

Result<SharedScene> SceneBuilder::ApplyEdits(const OpenScene& opened,
                                             const std::vector<Json>& edits,
                                             const cad::ProgressFn& progress) {
  std::vector<Json> changes = edits;
  std::optional<Json> order;
  if (!changes.empty() && IsOrder(changes.back())) {
    order = std::move(changes.back());
    changes.pop_back();
  }
  auto change = CombineEdits(changes);
  if (!change) {
    return Unexpected(change.error());
  }
  auto scene = std::make_shared<const OpenScene>(opened);
  if (!changes.empty()) {
    const auto made = Change(opened, {"edits", nullptr, std::move(*change)}, progress);
    if (!made) {
      return made;
    }
    auto changed = std::make_shared<OpenScene>(**made);
    changed->edits = std::move(changes);
    scene = std::move(changed);
  }
  if (!order) {
    return scene;
  }
  const auto wanted = protocol::ReadFields<protocol::SetOrderCommand>(*order);
  if (!wanted) {
    return Unexpected(wanted.error());
  }
  return ChangeOrder(*scene, orders::FindOrderRules(*scene->model, {}), wanted->occurrences, {});
}

Result<SharedScene> SceneBuilder::ChangeOrder(const OpenScene& before,
                                              const orders::OrderRules& rules,
                                              const std::vector<product::OccurrenceId>& occurrences,
                                              const std::stop_token& stop) {
  assembly::PlanOptions options;
  options.stop = stop;
  const auto checked = assembly::CheckOrder(*before.model, rules, occurrences, options);
  if (!checked) {
    return Unexpected(checked.error());
  }
  if (!checked->order) {
    return Fail(ErrorCode::kInvalid, "some part cannot come where it is in this order", before.name,
                "check the order, and move that part");
  }
  auto scene = std::make_shared<OpenScene>(before);
  scene->model = simulation::ChangeOrder(*before.model, orders::ListSteps(rules, *checked->order),
                                         stop, &scene->diagnostics);
  std::erase_if(scene->edits, IsOrder);
  scene->edits.push_back(
      {{"command", protocol::SetOrderCommand::kName}, {"occurrences", ToJson(occurrences)}});
  scene->epoch = ++last_epoch_;
  return scene;
}

Result<SharedScene> SceneBuilder::Change(const OpenScene& before, const Edit& edit,
                                         const cad::ProgressFn& progress) {
  product::Product product = *before.model->product;
  if (auto changed = edit.change(&product); !changed) {
    return Unexpected(changed.error());
  }
  auto scene = std::make_shared<OpenScene>(before);
  scene->diagnostics = ReplacePlacement(before.diagnostics, product);
  auto model = assembly::PrepareModel(std::move(product), MakeOptions(edit.what, progress),
                                      &scene->diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  std::erase_if(scene->edits, IsOrder);
  if (!edit.command.is_null()) {
    scene->edits.push_back(edit.command);
  }
  scene->model = *model;
  scene->epoch = ++last_epoch_;
  return scene;
}

assembly::PrepareOptions SceneBuilder::MakeOptions(const std::string& name,
                                                   const cad::ProgressFn& progress) const {
  assembly::PrepareOptions prepare;
  prepare.seed = options_.seed;
  prepare.shape_cache = options_.shape_cache;
  prepare.progress = progress;
  prepare.name = name;
  return prepare;
}

}  // namespace hvas::studio
