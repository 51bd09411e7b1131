#include "studio/paths.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/digest.h"
#include "cad/glb.h"
#include "product/wall.h"
#include "simulation/shapes.h"

namespace hvas::studio {
namespace {

using product::OccurrenceId;
using spatial::Pose;

/** Whether a motion is large enough to be seen. */
bool HasMoved(const Pose& from, const Pose& to) {
  constexpr double kDistance = 20e-6;  // [m]: less is not seen. A choice.
  constexpr double kTurn = 2e-4;       // [rad]: less is not seen. A choice.
  return (to.p() - from.p()).norm() > kDistance ||
         spatial::RotationBetween(from.q(), to.q()).norm() > kTurn;
}

Result<std::shared_ptr<const SweptGlb>> Compute(const Sweeper::Task& task,
                                                const std::stop_token& stop) {
  const product::Occurrence& occurrence = task.model->product->occurrences[task.occurrence.index()];
  const product::Part& part = task.model->product->part_of(task.occurrence);
  paths::SweepOptions options;
  options.resolution = task.resolution;
  options.thinnest_wall = product::CalcThinnestWall(part).value_or(0);
  options.threads = 1;  // the other cores are left to the loops of the hand
  options.stop = stop;
  const auto swept = paths::Sweep(simulation::MakeShapeSource(part), task.path, options);
  if (!swept) {
    Error error = swept.error();
    error.where = occurrence.name;
    return Unexpected(std::move(error));
  }
  auto glb = MakeGlb(swept->mesh, occurrence.name);
  if (!glb) {
    return Unexpected(glb.error());
  }
  Digest digest;
  digest.AddText(*glb);
  return std::make_shared<const SweptGlb>(
      SweptGlb{digest.Hex(), std::move(*glb), swept->volume, swept->error});
}

}  // namespace

void PathLog::Add(const simulation::Frame& frame) {
  const std::lock_guard lock(mutex_);
  held_.resize(frame.ticks.size());
  for (std::size_t hand = 0; hand < frame.ticks.size(); ++hand) {
    const OccurrenceId id = frame.ticks[hand].occurrence;
    const bool is_new = std::exchange(held_[hand], id) != id;
    if (!id.is_valid() || id.index() >= frame.X_WB.size()) {
      continue;
    }
    std::vector<OccurrenceId> moved{id};
    if (hand < frame.members.size()) {
      moved.insert(moved.end(), frame.members[hand].begin(), frame.members[hand].end());
    }
    for (const OccurrenceId part : moved) {
      if (is_new) {
        holds_[part] = {};
      }
      Append(frame.X_WB[part.index()], &holds_[part]);
    }
  }
}

void PathLog::Append(const Pose& X_WB, Hold* hold) {
  hold->newest = X_WB;
  if (!hold->path.empty() && !HasMoved(hold->path.back(), X_WB)) {
    return;
  }
  if (!hold->path.empty() && ++hold->passed < hold->stride) {
    return;
  }
  hold->passed = 0;
  hold->path.push_back(X_WB);
  if (hold->path.size() < kMaxPoses) {
    return;
  }
  for (std::size_t i = 0; 2 * i < hold->path.size(); ++i) {
    hold->path[i] = hold->path[2 * i];
  }
  hold->path.resize((hold->path.size() + 1) / 2);
  hold->stride *= 2;
}

void PathLog::Clear() {
  const std::lock_guard lock(mutex_);
  holds_.clear();
  held_.clear();
}

PathLog::HeldPath PathLog::PathOf(OccurrenceId id) const {
  const std::lock_guard lock(mutex_);
  const auto found = holds_.find(id);
  if (found == holds_.end()) {
    return {};
  }
  HeldPath held = static_cast<const HeldPath&>(found->second);
  held.path.push_back(found->second.newest);
  return held;
}

Result<std::string> MakeGlb(const paths::SurfaceMesh& mesh, const std::string& name) {
  product::Part part;
  part.id = product::PartId(0);
  part.name = name;
  part.mesh = {mesh.vertices, mesh.triangles};
  product::Face face;
  face.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
  part.faces.push_back(face);
  product::Product product;
  product.name = name;
  product.parts.push_back(std::move(part));
  product::Subassembly root;
  root.id = product::SubassemblyId(0);
  root.name = name;
  root.occurrences.emplace_back(0);
  product.subassemblies.push_back(std::move(root));
  product.occurrences.push_back(
      {OccurrenceId(0), product::PartId(0), product::SubassemblyId(0), name, name, Pose()});
  return cad::MakeGlb(product, /*is_fine=*/true);
}

Result<void> Sweeper::Post(Task task) {
  const auto job = [this, task = std::move(task)](const std::stop_token& stop) { Do(task, stop); };
  if (!thread_.TryPost(job, kMaxWaiting)) {
    return Fail(ErrorCode::kOutOfResource,
                fmt::format("{} swept volumes are queued already", kMaxWaiting), "",
                "wait until one of them is done");
  }
  return {};
}

void Sweeper::Do(const Task& task, const std::stop_token& stop) {
  const auto swept = Compute(task, stop);
  if (stop.stop_requested()) {
    return;
  }
  if (swept) {
    const std::lock_guard lock(mutex_);
    kept_.push_back(*swept);
    if (kept_.size() > kMaxKept) {
      kept_.pop_front();
    }
  }
  task.done(swept);
}

std::shared_ptr<const SweptGlb> Sweeper::Find(std::string_view id) const {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [id](const auto& kept) { return kept->id == id; });
  return found != kept_.end() ? *found : nullptr;
}

}  // namespace hvas::studio
