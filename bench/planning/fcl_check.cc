#include "fcl_check.h"

#include <algorithm>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

namespace hvas::bench {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> MakeModel(const TriangleMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    triangles.emplace_back(t[0], t[1], t[2]);
  }
  std::vector<fcl::Vector3d> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    vertices.emplace_back(1e3 * v);  // In millimetres, as in bench/contact.
  }
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

}  // namespace

struct FclPair::Data {
  std::shared_ptr<Model> part, around;
};

FclPair::FclPair(const Puzzle& puzzle)
    : data_(new Data{MakeModel(puzzle.part), MakeModel(puzzle.around)}) {}

FclPair::~FclPair() = default;

bool FclPair::Collides(const spatial::Pose& X_WB) const {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = X_WB.R();
  X.translation() = 1e3 * X_WB.p();
  const fcl::CollisionRequestd request(1, false);
  fcl::CollisionResultd result;
  return fcl::collide(data_->part.get(), X, data_->around.get(), fcl::Transform3d::Identity(),
                      request, result) > 0;
}

FclFinding CheckByFcl(const Puzzle& puzzle, const paths::Path& path, double step,
                      std::size_t most) {
  const FclPair pair(puzzle);
  const spatial::Box& box_B = puzzle.part_shape->box_B();
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += paths::CalcLongestWay(path[i - 1], path[i], box_B);
  }
  const paths::Path samples =
      paths::Resample(path, box_B, std::max(step, length / static_cast<double>(most)));
  FclFinding finding;
  for (const spatial::Pose& X_WB : samples) {
    ++finding.samples;
    finding.colliding += pair.Collides(X_WB) ? 1 : 0;
  }
  return finding;
}

}  // namespace hvas::bench
