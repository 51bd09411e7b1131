#include "dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <LinearMath/btConvexHullComputer.h>
#include <btBulletDynamicsCommon.h>

#include "dynamics/hull.h"
#include "spatial/decompose.h"

namespace hvas::dynamics {
namespace {

// Bullet's tolerances are made for bodies of about 1 unit. A unit of 10 mm puts parts of 1 mm to 1
// m at 0.1 to 100 units.
constexpr double kUnitsPerMetre = 100;
constexpr double kMargin = 0.02;           // Rounding of the hulls' edges, at most [unit].
constexpr double kMarginOfInradius = 0.2;  // The same, of small and thin bodies.
constexpr std::size_t kHullPoints = 64;
constexpr double kSleepSpeed = 0.5;    // [unit/s], 5 mm/s.
constexpr double kSleepRate = 0.3;     // [rad/s]
constexpr double kSleepTime = 0.5;     // Slower than both for this long: asleep [s].
constexpr int kSolverIterations = 60;  // With 10, heaps go on shaking for tens of seconds.
constexpr double kSettleStep = 0.01;   // [s]

btVector3 ToUnits(const Vec3& v) {
  return {kUnitsPerMetre * v.x(), kUnitsPerMetre * v.y(), kUnitsPerMetre * v.z()};
}

Vec3 ToVec3(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 ToMetres(const btVector3& v) {
  return ToVec3(v) / kUnitsPerMetre;
}

btTransform ToUnits(const spatial::Pose& pose) {
  const Quat& q = pose.q();
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), ToUnits(pose.p()));
}

spatial::Pose ToMetres(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  return {Quat(q.w(), q.x(), q.y(), q.z()).normalized(), ToMetres(transform.getOrigin())};
}

// The principal axes P of a body, at its centre of mass.
struct PrincipalFrame {
  spatial::Pose X_BP;
  Vec3 moments{Vec3::Zero()};
};

PrincipalFrame CalcPrincipalFrame(const MassProperties& properties) {
  const spatial::Eigensystem inertia = spatial::CalcEigensystem(properties.I_BBcm_B);
  Mat3 R_BP = inertia.vectors;
  if (R_BP.determinant() < 0) {
    R_BP.col(2) = -R_BP.col(2);
  }
  return {{Quat(R_BP).normalized(), properties.p_BoBcm_B}, inertia.values};
}

// The hull of the points, moved inwards by its margin, so that with the margin around it the faces
// are where they should be.
std::unique_ptr<btConvexHullShape> MakeHull(std::span<const Vec3> vertices_B,
                                            const spatial::Pose& X_BP) {
  const std::vector<Vec3> points_B = SelectSpread(vertices_B, kHullPoints);
  std::vector<btVector3> points;
  points.reserve(points_B.size());
  const spatial::Pose X_PB = X_BP.Inverse();
  for (const Vec3& p_B : points_B) {
    points.push_back(ToUnits(X_PB * p_B));
  }
  btConvexHullComputer computer;
  const double shrink =
      computer.compute(&points[0].x(), sizeof(btVector3), static_cast<int>(points.size()), kMargin,
                       kMarginOfInradius);
  auto hull = std::make_unique<btConvexHullShape>();
  const bool is_solid = shrink > 0 && computer.vertices.size() >= 4;
  if (is_solid) {
    for (int i = 0; i < computer.vertices.size(); ++i) {
      hull->addPoint(computer.vertices[i], false);
    }
  } else {
    for (const btVector3& point : points) {  // A point, a line or a flat thing.
      hull->addPoint(point, false);
    }
  }
  hull->setMargin(is_solid ? shrink : kMargin / 100);
  hull->recalcLocalAabb();
  return hull;
}

bool IsValid(std::span<const Vec3> vertices_B, const MassProperties& properties,
             const PrincipalFrame& frame, const spatial::Pose& X_WB) {
  const auto is_finite = [](const Vec3& p) { return p.allFinite(); };
  return !vertices_B.empty() && std::all_of(vertices_B.begin(), vertices_B.end(), is_finite) &&
         spatial::IsFinite(X_WB) && std::isfinite(properties.mass) && properties.mass > 0 &&
         properties.p_BoBcm_B.allFinite() && frame.moments.allFinite() &&
         frame.moments.minCoeff() > 0;
}

struct Body {
  spatial::Pose X_WB;
  spatial::Pose X_BP;
  spatial::Pose X_PB;
  double mass{0};
  btVector3 inertia{0, 0, 0};  // Principal [kg unit2].
  std::unique_ptr<btConvexHullShape> shape;
  std::unique_ptr<btRigidBody> rigid;
  bool is_kinematic{false};
  std::optional<spatial::Pose> target;  // Of a kinematic body, for the next step.
};

}  // namespace

struct World::Impl {
  explicit Impl(const WorldOptions& world_options);
  ~Impl();

  [[nodiscard]] Body& At(BodyId id) { return *bodies[id.index()]; }

  void Place(Body* body, const spatial::Pose& X_WB);
  void WakeNeighbours(const Body& body);
  void Substep(double dt, double share_done);
  void ReadPoses();
  [[nodiscard]] bool is_at_rest() const;

  WorldOptions options;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape table_shape;
  btCollisionObject table;
  std::vector<std::unique_ptr<Body>> bodies;  // By id; null when removed.
};

World::Impl::Impl(const WorldOptions& world_options)
    : options(world_options), table_shape({0, 0, 1}, kUnitsPerMetre * world_options.table_z) {
  // The one way that Bullet offers to set this: a global, the same for all worlds.
  gDeactivationTime = kSleepTime;
  // A plane gives one contact a query unless it is asked again with slightly turned bodies.
  configuration.setPlaneConvexMultipointIterations(4, 4);
  world.setForceUpdateAllAabbs(false);  // Place() does it for those asleep.
  world.setGravity({0, 0, -kUnitsPerMetre * options.gravity});
  btContactSolverInfo& info = world.getSolverInfo();
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  // Correct penetration by moving, not by speed, however shallow: else resting bodies hop.
  info.m_splitImpulsePenetrationThreshold = 0;
  info.m_restitution = 0;
  info.m_numIterations = kSolverIterations;
  table_shape.setMargin(0);
  table.setCollisionShape(&table_shape);
  table.setFriction(std::sqrt(options.friction));
  world.addCollisionObject(&table, btBroadphaseProxy::StaticFilter,
                           btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter);
}

World::Impl::~Impl() {
  for (const std::unique_ptr<Body>& body : bodies) {
    if (body != nullptr) {
      world.removeRigidBody(body->rigid.get());
    }
  }
  world.removeCollisionObject(&table);
}

void World::Impl::Place(Body* body, const spatial::Pose& X_WB) {
  body->X_WB = X_WB;
  const btTransform X_WP = ToUnits(X_WB * body->X_BP);
  btRigidBody& rigid = *body->rigid;
  rigid.setWorldTransform(X_WP);
  rigid.setInterpolationWorldTransform(X_WP);
  rigid.setLinearVelocity({0, 0, 0});
  rigid.setAngularVelocity({0, 0, 0});
  rigid.clearForces();
  rigid.updateInertiaTensor();
  if (rigid.getBroadphaseHandle() != nullptr) {
    world.updateSingleAabb(&rigid);
  }
}

void World::Impl::WakeNeighbours(const Body& body) {
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = dispatcher.getManifoldByIndexInternal(i);
    const btCollisionObject* a = manifold->getBody0();
    const btCollisionObject* b = manifold->getBody1();
    if (a != body.rigid.get() && b != body.rigid.get()) {
      continue;
    }
    for (const btCollisionObject* object : {a, b}) {
      if (!object->isStaticOrKinematicObject()) {
        object->activate(true);
      }
    }
  }
}

void World::Impl::Substep(double dt, double share_done) {
  for (const std::unique_ptr<Body>& body : bodies) {
    if (body != nullptr && body->target.has_value()) {
      const spatial::Pose X_WB(body->X_WB.q().slerp(share_done, body->target->q()),
                               body->X_WB.p() + share_done * (body->target->p() - body->X_WB.p()));
      // Bullet takes the velocity with which it pushes from this and the last transform.
      body->rigid->setWorldTransform(ToUnits(X_WB * body->X_BP));
    }
  }
  world.stepSimulation(dt, 0);
}

void World::Impl::ReadPoses() {
  for (const std::unique_ptr<Body>& body : bodies) {
    if (body == nullptr) {
      continue;
    }
    if (body->target.has_value()) {
      Place(body.get(), *body->target);
      body->rigid->forceActivationState(ISLAND_SLEEPING);
      body->target.reset();
    } else if (!body->is_kinematic && body->rigid->isActive()) {
      body->X_WB = ToMetres(body->rigid->getWorldTransform()) * body->X_PB;
    }
  }
}

bool World::Impl::is_at_rest() const {
  return std::all_of(bodies.begin(), bodies.end(), [](const std::unique_ptr<Body>& body) {
    return body == nullptr || !body->rigid->isActive();
  });
}

World::World(const WorldOptions& options) : impl_(std::make_unique<Impl>(options)) {}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

Result<BodyId> World::AddBody(std::span<const Vec3> vertices_B, const MassProperties& properties,
                              const spatial::Pose& X_WB) {
  const PrincipalFrame frame = CalcPrincipalFrame(properties);
  if (!IsValid(vertices_B, properties, frame, X_WB)) {
    return Fail(ErrorCode::kInvalid,
                "a free body needs vertices, a finite pose, a positive mass "
                "and a positive definite inertia");
  }
  auto body = std::make_unique<Body>();
  body->X_BP = frame.X_BP;
  body->X_PB = frame.X_BP.Inverse();
  body->mass = properties.mass;
  const Vec3 inertia = kUnitsPerMetre * frame.moments;  // ToUnits() brings the other factor.
  body->inertia = ToUnits(inertia);
  body->shape = MakeHull(vertices_B, frame.X_BP);
  btRigidBody::btRigidBodyConstructionInfo info(body->mass, nullptr, body->shape.get(),
                                                body->inertia);
  info.m_friction = std::sqrt(impl_->options.friction);  // Bullet multiplies those of a pair.
  info.m_rollingFriction =
      0.5 * kUnitsPerMetre * impl_->options.rolling_resistance / std::max(info.m_friction, 1e-9);
  info.m_spinningFriction = info.m_rollingFriction;
  info.m_restitution = 0;
  info.m_linearSleepingThreshold = kSleepSpeed;
  info.m_angularSleepingThreshold = kSleepRate;
  body->rigid = std::make_unique<btRigidBody>(info);
  impl_->Place(body.get(), X_WB);
  impl_->world.addRigidBody(body->rigid.get());
  impl_->bodies.push_back(std::move(body));
  return BodyId(impl_->bodies.size() - 1);
}

void World::Remove(BodyId body) {
  impl_->WakeNeighbours(impl_->At(body));
  impl_->world.removeRigidBody(impl_->At(body).rigid.get());
  impl_->bodies[body.index()].reset();
}

void World::SetKinematic(BodyId id, bool is_kinematic) {
  Body& body = impl_->At(id);
  if (body.is_kinematic == is_kinematic) {
    return;
  }
  body.is_kinematic = is_kinematic;
  body.target.reset();
  impl_->WakeNeighbours(body);
  btRigidBody& rigid = *body.rigid;
  // Bullet sorts bodies into lists by their kind when they are added.
  impl_->world.removeRigidBody(&rigid);
  const int kinds = btCollisionObject::CF_STATIC_OBJECT | btCollisionObject::CF_KINEMATIC_OBJECT;
  if (is_kinematic) {
    rigid.setMassProps(0, {0, 0, 0});
    rigid.setCollisionFlags((rigid.getCollisionFlags() & ~kinds) |
                            btCollisionObject::CF_KINEMATIC_OBJECT);
  } else {
    rigid.setCollisionFlags(rigid.getCollisionFlags() & ~kinds);
    rigid.setMassProps(body.mass, body.inertia);
  }
  impl_->Place(&body, body.X_WB);
  impl_->world.addRigidBody(&rigid);
  rigid.setDeactivationTime(0);
  // An awake kinematic body would keep all that touches it awake.
  rigid.forceActivationState(is_kinematic ? ISLAND_SLEEPING : ACTIVE_TAG);
}

void World::SetPose(BodyId id, const spatial::Pose& X_WB) {
  Body& body = impl_->At(id);
  impl_->WakeNeighbours(body);
  impl_->Place(&body, X_WB);
  body.target.reset();
  if (!body.is_kinematic) {
    body.rigid->activate(true);
  }
}

void World::MoveTo(BodyId id, const spatial::Pose& X_WB) {
  Body& body = impl_->At(id);
  if (body.is_kinematic) {
    body.target = X_WB;
    body.rigid->forceActivationState(ACTIVE_TAG);
    body.rigid->setDeactivationTime(0);
  }
}

void World::ApplyImpulse(BodyId id, const Vec3& impulse_W, const Vec3& p_WQ) {
  Body& body = impl_->At(id);
  if (!body.is_kinematic) {
    body.rigid->activate(true);
    body.rigid->applyImpulse(ToUnits(impulse_W),
                             ToUnits(p_WQ) - body.rigid->getCenterOfMassPosition());
  }
}

void World::Step(double dt) {
  if (impl_->is_at_rest()) {
    return;
  }
  const int count =
      std::max(1, static_cast<int>(std::ceil(dt / impl_->options.max_substep - 1e-9)));
  for (int i = 1; i <= count; ++i) {
    impl_->Substep(dt / count, static_cast<double>(i) / count);
  }
  impl_->ReadPoses();
}

bool World::Settle(double max_time) {
  const auto steps = static_cast<std::int64_t>(std::ceil(max_time / kSettleStep));
  for (std::int64_t i = 0; i < steps && !impl_->is_at_rest(); ++i) {
    Step(kSettleStep);
  }
  return impl_->is_at_rest();
}

const spatial::Pose& World::pose(BodyId body) const {
  return impl_->At(body).X_WB;
}

spatial::Twist World::CalcVelocity(BodyId id) const {
  const Body& body = impl_->At(id);
  const Vec3 w_WB = ToVec3(body.rigid->getAngularVelocity());
  const Vec3 p_BcmBo_W = -(body.X_WB.q() * body.X_BP.p());
  return {w_WB, ToMetres(body.rigid->getLinearVelocity()) + w_WB.cross(p_BcmBo_W)};
}

bool World::is_kinematic(BodyId body) const {
  return impl_->At(body).is_kinematic;
}

bool World::is_asleep(BodyId body) const {
  return !impl_->At(body).rigid->isActive();
}

double World::CalcEnergy() const {
  double energy = 0;
  for (const std::unique_ptr<Body>& body : impl_->bodies) {
    if (body == nullptr || body->is_kinematic) {
      continue;
    }
    const btRigidBody& rigid = *body->rigid;
    const Vec3 v = ToMetres(rigid.getLinearVelocity());
    const Vec3 w_P =
        ToVec3(rigid.getWorldTransform().getBasis().transpose() * rigid.getAngularVelocity());
    const Vec3 moments = ToMetres(body->inertia) / kUnitsPerMetre;
    const double height = ToMetres(rigid.getCenterOfMassPosition()).z() - impl_->options.table_z;
    energy += body->mass * (0.5 * v.squaredNorm() + impl_->options.gravity * height) +
              0.5 * w_P.dot(moments.cwiseProduct(w_P));
  }
  return energy;
}

std::size_t World::size() const {
  return static_cast<std::size_t>(
      std::count_if(impl_->bodies.begin(), impl_->bodies.end(),
                    [](const std::unique_ptr<Body>& body) { return body != nullptr; }));
}

}  // namespace hvas::dynamics
