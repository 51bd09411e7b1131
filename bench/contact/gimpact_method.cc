#include <map>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include "method.h"

namespace hvas::bench {
namespace {

btVector3 ToBullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 FromBullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

btTransform ToBullet(const spatial::Pose& X) {
  const btQuaternion q(X.q().x(), X.q().y(), X.q().z(), X.q().w());
  return btTransform(q, ToBullet(Vec3(1e3 * X.p())));
}

/** A mesh in Bullet's own arrays, which the shape refers to. */
struct GImpactMesh {
  std::vector<int> indices;
  std::vector<btScalar> vertices;
  btTriangleIndexVertexArray array;
  std::unique_ptr<btGImpactMeshShape> shape;

  explicit GImpactMesh(const PeerMesh& mesh) {
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t v : t) {
        indices.push_back(static_cast<int>(v));
      }
    }
    for (const Vec3& v : mesh.vertices_mm) {
      vertices.insert(vertices.end(), {v.x(), v.y(), v.z()});
    }
    btIndexedMesh part;
    part.m_numTriangles = static_cast<int>(mesh.triangles.size());
    part.m_triangleIndexBase = reinterpret_cast<const unsigned char*>(indices.data());
    part.m_triangleIndexStride = 3 * sizeof(int);
    part.m_numVertices = static_cast<int>(mesh.vertices_mm.size());
    part.m_vertexBase = reinterpret_cast<const unsigned char*>(vertices.data());
    part.m_vertexStride = 3 * sizeof(btScalar);
    part.m_vertexType = PHY_DOUBLE;
    array.addIndexedMesh(part, PHY_INTEGER);
    shape = std::make_unique<btGImpactMeshShape>(&array);
    shape->setMargin(0);
    shape->updateBound();
  }
};

class GImpact : public Method, private btCollisionWorld::ContactResultCallback {
 public:
  explicit GImpact(MeshOf mesh_of) : mesh_of_(std::move(mesh_of)), dispatcher_(&configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    // contactTest asks for algorithms of the other table, which the call above leaves empty.
    for (int type = 0; type < MAX_BROADPHASE_COLLISION_TYPES; ++type) {
      dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, type, &create_);
      dispatcher_.registerClosestPointsCreateFunc(type, GIMPACT_SHAPE_PROXYTYPE, &create_);
    }
  }

  void Load(std::size_t held, const std::vector<PlacedPart>& scene) override {
    Clear();
    broadphase_ = std::make_unique<btDbvtBroadphase>();
    world_ = std::make_unique<btCollisionWorld>(&dispatcher_, broadphase_.get(), &configuration_);
    for (const PlacedPart& part : scene) {
      objects_.push_back(std::make_unique<btCollisionObject>());
      objects_.back()->setCollisionShape(ShapeOf(part.part));
      objects_.back()->setWorldTransform(ToBullet(part.X_WB));
      world_->addCollisionObject(objects_.back().get());
    }
    held_ = std::make_unique<btCollisionObject>();
    held_->setCollisionShape(ShapeOf(held));
  }

  ~GImpact() override { Clear(); }

  std::size_t Query(const spatial::Pose& X_WH) override {
    found_.clear();
    held_->setWorldTransform(ToBullet(X_WH));
    world_->contactTest(held_.get(), *this);
    return found_.size();
  }

  std::span<const FoundContact> contacts() override { return found_; }

 private:
  void Clear() {
    if (world_ != nullptr) {
      for (const auto& object : objects_) {
        world_->removeCollisionObject(object.get());
      }
    }
    objects_.clear();
    world_.reset();
  }

  btCollisionShape* ShapeOf(std::size_t part) {
    std::unique_ptr<GImpactMesh>& mesh = meshes_[part];
    if (mesh == nullptr) {
      mesh = std::make_unique<GImpactMesh>(mesh_of_(part));
    }
    return mesh->shape.get();
  }

  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    const double sign = a->getCollisionObject() == held_.get() ? 1 : -1;
    found_.push_back({1e-3 * FromBullet(point.getPositionWorldOnA()),
                      sign * FromBullet(point.m_normalWorldOnB), -1e-3 * point.getDistance()});
    return 0;
  }

  MeshOf mesh_of_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btGImpactCollisionAlgorithm::CreateFunc create_;
  std::unique_ptr<btDbvtBroadphase> broadphase_;
  std::unique_ptr<btCollisionWorld> world_;
  std::map<std::size_t, std::unique_ptr<GImpactMesh>> meshes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::unique_ptr<btCollisionObject> held_;
  std::vector<FoundContact> found_;
};

}  // namespace

std::unique_ptr<Method> MakeGImpact(MeshOf mesh_of) {
  return std::make_unique<GImpact>(std::move(mesh_of));
}

}  // namespace hvas::bench
