#include "paths/near_points.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "contact/refine.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

// Samples of one shape that are looked at: a thread of ten turns has a hundred to each. A choice.
constexpr std::size_t kMostSamples = 1500;

}  // namespace

NearPoints::NearPoints(const Probe& probe) : part_(MakeSamples(*probe.problem().part)) {
  const contact::Scene& scene = *probe.problem().scene;
  for (const contact::BodyId body : probe.bodies()) {
    bodies_.push_back(MakeSamples(scene.shape(body)));
    bodies_.back().body = body;
    bodies_.back().X_WS = scene.pose(body);
  }
}

NearPoints::Samples NearPoints::MakeSamples(const contact::Shape& shape) {
  constexpr std::size_t kLanes = 8;  // Of a leaf.
  const contact::Shape::Data& data = shape.data();
  Samples samples;
  samples.shape = &shape;
  const std::size_t stride = std::max<std::size_t>(1, data.shell.point_count / kMostSamples);
  std::size_t count = 0;
  for (std::size_t leaf = 0; leaf < data.shell.leaf_count.size(); ++leaf) {
    for (std::size_t lane = 0; lane < data.shell.leaf_count[leaf]; ++lane) {
      const std::size_t i = kLanes * leaf + lane;
      if (count++ % stride == 0) {
        samples.p_SQ.push_back(data.p_BC + Vec3(static_cast<double>(data.shell.x[i]),
                                                static_cast<double>(data.shell.y[i]),
                                                static_cast<double>(data.shell.z[i])));
      }
    }
  }
  return samples;
}

void NearPoints::AddNear(const Samples& of, const Pose& X_WO, const Samples& to, const Pose& X_WF,
                         double near) {
  const contact::Shape::Data& data = to.shape->data();
  const spatial::Box around_F = data.box_B.Expanded(near);
  const Pose X_FO = X_WF.Inverse() * X_WO;
  const bool is_of_part = &of == &part_;
  contact::FaceFilter filter;
  filter.limit = near;
  for (const Vec3& p_OQ : of.p_SQ) {
    const Vec3 p_FQ = X_FO * p_OQ;
    if (!around_F.Contains(p_FQ)) {
      continue;
    }
    const contact::Refined refined =
        contact::RefineAlone(data, nullptr, Vec3(p_FQ - data.p_BC), filter);
    if (!refined.is_valid || refined.distance >= near) {
      continue;
    }
    NearPoint point;
    point.p_W = X_WO * p_OQ;
    point.nhat_W = (is_of_part ? 1 : -1) * (X_WF.q() * refined.gradient);
    point.distance = refined.distance;
    point.body = is_of_part ? to.body : of.body;
    point.is_of_part = is_of_part;
    point.face = refined.face;
    list_.push_back(point);
  }
}

double NearPoints::CalcLeast() const {
  double least = std::numeric_limits<double>::infinity();
  for (const NearPoint& point : list_) {
    least = std::min(least, point.distance);
  }
  return least;
}

void NearPoints::Find(const Pose& X_WB, double near) {
  list_.clear();
  for (const Samples& body : bodies_) {
    const spatial::Box part_W = spatial::Transform(X_WB, part_.shape->box_B()).Expanded(near);
    if (!part_W.Overlaps(spatial::Transform(body.X_WS, body.shape->box_B()))) {
      continue;
    }
    AddNear(part_, X_WB, body, body.X_WS, near);
    AddNear(body, body.X_WS, part_, X_WB, near);
  }
}

}  // namespace hvas::paths
