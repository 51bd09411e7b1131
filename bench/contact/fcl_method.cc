#include <map>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include "method.h"

namespace hvas::bench {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> MakeModel(const PeerMesh& mesh) {
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    triangles.emplace_back(t[0], t[1], t[2]);
  }
  std::vector<fcl::Vector3d> vertices(mesh.vertices_mm.begin(), mesh.vertices_mm.end());
  auto model = std::make_shared<Model>();
  model->beginModel();
  model->addSubModel(vertices, triangles);
  model->endModel();
  return model;
}

fcl::Transform3d ToFcl(const spatial::Pose& X) {
  fcl::Transform3d out = fcl::Transform3d::Identity();
  out.linear() = X.R();
  out.translation() = 1e3 * X.p();
  return out;
}

class Fcl : public Method {
 public:
  Fcl(MeshOf mesh_of, std::size_t max_contacts)
      : mesh_of_(std::move(mesh_of)), max_contacts_(max_contacts) {}

  void Load(std::size_t held, const std::vector<PlacedPart>& scene) override {
    objects_.clear();
    manager_ = std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
    for (const PlacedPart& part : scene) {
      objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(ModelOf(part.part), ToFcl(part.X_WB)));
      manager_->registerObject(objects_.back().get());
    }
    manager_->setup();
    held_ = std::make_unique<fcl::CollisionObjectd>(ModelOf(held));
  }

  std::size_t Query(const spatial::Pose& X_WH) override {
    found_.clear();
    count_ = 0;
    held_->setTransform(ToFcl(X_WH));
    held_->computeAABB();
    manager_->collide(held_.get(), this, &Fcl::OnPair);
    return count_;
  }

  std::span<const FoundContact> contacts() override { return found_; }

 private:
  std::shared_ptr<Model> ModelOf(std::size_t part) {
    std::shared_ptr<Model>& model = models_[part];
    if (model == nullptr) {
      model = MakeModel(mesh_of_(part));
    }
    return model;
  }

  // Of a pair whose boxes overlap; true ends the query.
  static bool OnPair(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    auto* self = static_cast<Fcl*>(data);
    const bool is_yes_or_no = self->max_contacts_ == 0;
    const fcl::CollisionRequestd request(is_yes_or_no ? 1 : self->max_contacts_, !is_yes_or_no);
    fcl::CollisionResultd result;
    self->count_ += fcl::collide(a, b, request, result);
    if (is_yes_or_no) {
      return result.isCollision();
    }
    const double sign = a == self->held_.get() ? -1 : 1;  // Normals point from a to b.
    for (std::size_t i = 0; i < result.numContacts(); ++i) {
      const fcl::Contactd& c = result.getContact(i);
      self->found_.push_back({1e-3 * c.pos, sign * c.normal, 1e-3 * c.penetration_depth});
    }
    return false;
  }

  MeshOf mesh_of_;
  std::size_t max_contacts_;
  std::map<std::size_t, std::shared_ptr<Model>> models_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::unique_ptr<fcl::CollisionObjectd> held_;
  std::unique_ptr<fcl::DynamicAABBTreeCollisionManagerd> manager_;
  std::vector<FoundContact> found_;
  std::size_t count_{0};
};

}  // namespace

std::unique_ptr<Method> MakeFcl(MeshOf mesh_of, std::size_t max_contacts) {
  return std::make_unique<Fcl>(std::move(mesh_of), max_contacts);
}

}  // namespace hvas::bench
