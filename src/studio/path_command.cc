// Handler of the command "path" in docs/protocol.md.
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "studio/event_json.h"
#include "studio/hub.h"
#include "studio/json_fields.h"

namespace hvas::studio {
namespace {

Json MakePoints(const PathLog::HeldPath& held, const Vec3& p_BoBcm_B) {
  Json points = Json::array();
  Json poses = Json::array();
  for (const spatial::Pose& X_WB : held.path) {
    points.push_back(ToJson(Vec3(X_WB * p_BoBcm_B)));
    poses.push_back(ToJson(X_WB));
  }
  return {{"points_m", std::move(points)},
          {"poses", std::move(poses)},
          {"frames_per_pose", held.stride}};
}

Result<Json> Describe(const Result<std::shared_ptr<const SweptGlb>>& swept) {
  if (!swept) {
    return Unexpected(swept.error());
  }
  return Json{{"glb", fmt::format("/api/path/{}.glb", (*swept)->id)},
              {"volume_mm3", units::ToMm3((*swept)->volume)},
              {"error_mm", units::ToMm((*swept)->error)}};
}

}  // namespace

Result<Json> Hub::DoPath(const Caller& caller, const protocol::PathCommand& command) {
  const auto open = workbench_->live().FindScene();
  if (!open) {
    return Unexpected(open.error());
  }
  const std::shared_ptr<const OpenScene>& scene = *open;
  const product::OccurrenceId id(command.occurrence);
  const product::Product& product = *scene->model->product;
  if (id.index() >= product.occurrences.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such part",
                fmt::format("o{}", command.occurrence), "");
  }
  PathLog::HeldPath held = workbench_->paths().PathOf(id);
  if (held.path.empty()) {
    return Fail(ErrorCode::kNotFound, "this part has not been held yet",
                product.occurrences[id.index()].name, "move it, or let the simulated person do so");
  }
  if (command.as == protocol::PathForm::kPoints) {
    return MakePoints(held, product.part_of(id).mass.p_BoBcm_B);
  }
  const auto done =
      [events = &workbench_->events(), to = caller.id,
       reply_to = IdOf(caller.command)](const Result<std::shared_ptr<const SweptGlb>>& swept) {
        events->Publish(MakeDeferredReply(to, reply_to, Describe(swept)));
      };
  const auto posted = workbench_->sweeper().Post(
      {scene->model, id, std::move(held.path), units::FromMm(command.resolution_mm), done});
  return posted ? Result<Json>(MakeDeferredResult()) : Unexpected(posted.error());
}

}  // namespace hvas::studio
