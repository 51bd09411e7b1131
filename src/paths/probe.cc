#include "paths/probe.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hvas::paths {

using spatial::Box;
using spatial::Pose;

namespace {

constexpr std::uint64_t kQueriesPerReport = 1024;  // A tenth of a second or less: a choice.

}  // namespace

Probe::Probe(const WayProblem& problem, const WayOptions& options)
    : problem_(problem), options_(options), budget_(options.budget) {
  const Box& box_B = problem.part->box_B();
  centre_B_ = box_B.centre();
  size_ = box_B.size().norm();
  reach_ = 0.5 * size_;
  // Of a solid box; its thinnest direction counts, too, as turns are felt at its ends.
  gyration_ = size_ / std::sqrt(12.0);
  grain_ = std::max(0.5 * std::abs(problem.tolerance), 1e-5 * size_);
  const contact::Scene& scene = *problem.scene;
  const auto is_among = [](std::span<const contact::BodyId> list, contact::BodyId body) {
    return std::find(list.begin(), list.end(), body) != list.end();
  };
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const contact::BodyId body(i);
    if (body == problem.self || !scene.is_enabled(body) || is_among(problem.left_out[0], body) ||
        is_among(problem.left_out[1], body)) {
      continue;
    }
    bodies_.push_back(body);
    boxes_W_.push_back(spatial::Transform(scene.pose(body), scene.shape(body).box_B()));
    around_W_.Add(boxes_W_.back());
  }
}

contact::QueryOptions Probe::MakeOptions() const {
  contact::QueryOptions options;
  options.ignored = problem_.ignored;
  options.allowances = problem_.allowances;
  std::copy(problem_.left_out.begin(), problem_.left_out.end(), options.left_out.begin());
  options.self = problem_.self;
  // No point is left out: a way that is free at some of its points is no way.
  options.point_budget = std::numeric_limits<std::uint32_t>::max() / 2;
  return options;
}

void Probe::CountQuery() {
  ++queries_;
  if (options_.progress && queries_ % kQueriesPerReport == 0) {
    options_.progress(
        std::min(1.0, static_cast<double>(queries_) / static_cast<double>(options_.budget)));
  }
}

bool Probe::IsFree(const Pose& X_WB) {
  if (problem_.tolerance < 0) {
    return Query(X_WB, -problem_.tolerance) >= -problem_.tolerance;
  }
  CountQuery();
  const bool is_free =
      problem_.scene->IsFree(*problem_.part, X_WB, problem_.tolerance, MakeOptions(), &workspace_);
  points_ += workspace_.stats().points_tested;
  return is_free;
}

double Probe::Query(const Pose& X_WB, double margin) {
  CountQuery();
  contact::QueryOptions options = MakeOptions();
  options.margin = margin;
  problem_.scene->Query(*problem_.part, X_WB, options, &workspace_);
  points_ += workspace_.stats().points_tested;
  return std::min(workspace_.deepest(), margin);
}

double Probe::CalcOverlap(const Pose& X_WB) const {
  const Box box = spatial::Transform(X_WB, problem_.part->box_B());
  double most = 0;
  for (const Box& other : boxes_W_) {
    const Vec3 overlap = (box.high - other.low).cwiseMin(other.high - box.low);
    most = std::max(most, overlap.minCoeff());
  }
  return most;
}

double Probe::CalcExit(const Pose& X_WB, const Vec3& direction_W) const {
  const Box box = spatial::Transform(X_WB, problem_.part->box_B());
  double exit = 0;
  for (const Box& other : boxes_W_) {
    double enter = 0;
    double leave = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const double d = direction_W[i];
      const double a = other.low[i] - box.high[i];  // Overlap where a < s d < b.
      const double b = other.high[i] - box.low[i];
      if (std::abs(d) < 1e-12) {
        leave = a < 0 && b > 0 ? leave : -1.0;
        continue;
      }
      enter = std::max(enter, std::min(a / d, b / d));
      leave = std::min(leave, std::max(a / d, b / d));
    }
    if (leave > enter) {
      exit = std::max(exit, leave);
    }
  }
  return exit;
}

Pose Probe::Move(const Pose& X_WB, const Displacement& d) const {
  const Vec3 centre_W = X_WB * centre_B_ + d.v_W;
  const Quat q = (spatial::RotationFromVector(d.w_W) * X_WB.q()).normalized();
  return {q, Vec3(centre_W - q * centre_B_)};
}

Displacement Probe::CalcDisplacement(const Pose& from, const Pose& to) const {
  return {spatial::RotationBetween(from.q(), to.q()), to * centre_B_ - from * centre_B_};
}

Vec6 Probe::RowOf(const Vec3& nhat_W, const Vec3& p_WC, const Vec3& centre_W) const {
  Vec6 row;
  row << nhat_W, (p_WC - centre_W).cross(nhat_W) / gyration_;
  return row;
}

double Probe::CalcLength(const Displacement& d) const {
  return std::sqrt(d.v_W.squaredNorm() + gyration_ * gyration_ * d.w_W.squaredNorm());
}

}  // namespace hvas::paths
