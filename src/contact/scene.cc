#include "contact/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/body_tree.h"
#include "contact/reduce.h"
#include "contact/refine.h"
#include "contact/shape_data.h"

namespace hvas::contact {

namespace {

constexpr std::size_t kMaxHits = 32768;
constexpr std::size_t kMaxFaces = 65536;
constexpr std::size_t kMaxPairsPerBody = 8;  // Bits of a face mask; further pairs share the last.

}  // namespace

struct QueryWorkspace::Data {
  std::vector<Hit> hits = std::vector<Hit>(kMaxHits);
  ContactReducer reducer;
  std::array<Contact, kMaxContacts> contacts;
  std::size_t contact_count{0};
  QueryStats stats;
  double deepest{std::numeric_limits<double>::infinity()};
  // For each face, bit i when it is in the i-th ignored pair of the body at hand; else all zero.
  std::vector<std::uint8_t> held_mask = std::vector<std::uint8_t>(kMaxFaces);
  std::vector<std::uint8_t> scene_mask = std::vector<std::uint8_t>(kMaxFaces);

  void Clear() noexcept {
    reducer.Clear();
    contact_count = 0;
    stats = {};
    deepest = std::numeric_limits<double>::infinity();
  }
};

QueryWorkspace::QueryWorkspace() : data_(std::make_unique<Data>()) {
  data_->Clear();
}

QueryWorkspace::~QueryWorkspace() = default;
QueryWorkspace::QueryWorkspace(QueryWorkspace&&) noexcept = default;
QueryWorkspace& QueryWorkspace::operator=(QueryWorkspace&&) noexcept = default;

std::span<const Contact> QueryWorkspace::contacts() const noexcept {
  return {data_->contacts.data(), data_->contact_count};
}

const QueryStats& QueryWorkspace::stats() const noexcept {
  return data_->stats;
}

double QueryWorkspace::deepest() const noexcept {
  return data_->deepest;
}

namespace {

// Where a shape's centred frame is in the world.
struct Placed {
  const Shape::Data* shape;
  Mat3 R_WC;
  Vec3 p_WC;

  Placed(const Shape& s, const spatial::Pose& X_WB)
      : shape(&s.data()), R_WC(X_WB.R()), p_WC(X_WB.p() + R_WC * s.data().p_BC) {}

  [[nodiscard]] Vec3 half() const { return 0.5 * shape->box_B.size(); }
};

struct RelativePose {
  Mat3 R;
  Vec3 p;

  // Coordinates of b's frame to those of a's.
  RelativePose(const Placed& a, const Placed& b)
      : R(a.R_WC.transpose() * b.R_WC), p(a.R_WC.transpose() * (b.p_WC - a.p_WC)) {}

  [[nodiscard]] FloatPose Single() const {
    FloatPose out{};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        out.R[3 * i + j] = static_cast<float>(R(i, j));
      }
      out.p[i] = static_cast<float>(p[i]);
    }
    return out;
  }
};

// A query of one held shape: collects contacts body by body. With a stop depth it ends at the first
// contact deeper than that.
class PairQuery {
 public:
  PairQuery(const Placed& held, const QueryOptions& options, double margin, double stop_distance,
            TraverseFunction traverse, QueryWorkspace::Data* work)
      : held_(held),
        options_(options),
        margin_(margin),
        stop_distance_(stop_distance),
        traverse_(traverse),
        work_(work) {}

  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

  void Body(BodyId id, const Placed& scene) noexcept {
    const RelativePose X_SH(scene, held_);
    const RelativePose X_HS(held_, scene);
    if (!BoxesTouch(X_SH, scene) || is_stopped_) {
      return;
    }
    ++work_->stats.bodies_tested;
    body_ = id;
    const bool has_ignored = SetMasks(id, 0xff);
    Forward(scene, X_SH, has_ignored);
    if (!is_stopped_) {
      Reverse(scene, X_HS, has_ignored);
    }
    if (has_ignored) {
      SetMasks(id, 0);
    }
  }

  void Ground(double z_W) noexcept {
    const Shell& shell = held_.shape->shell;
    if (shell.nodes.empty() || is_stopped_) {
      return;
    }
    std::array<std::int32_t, 256> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    const Eigen::RowVector3d up_H = held_.R_WC.row(2);
    const double limit = z_W + margin_ - held_.p_WC.z();
    while (size > 0 && !is_stopped_) {
      const SphereNode& node = shell.nodes[static_cast<std::size_t>(stack[--size])];
      for (int k = 0; k < 8; ++k) {
        const Vec3 centre = Vec3f(node.x[k], node.y[k], node.z[k]);
        if (node.child[k] == -1 ||
            up_H.dot(centre) - static_cast<double>(node.radius[k]) >= limit) {
          continue;
        }
        if (node.child[k] < -1) {
          GroundLeaf(z_W, static_cast<std::size_t>(-2 - node.child[k]));
        } else if (size < stack.size()) {
          stack[size++] = node.child[k];
        }
      }
    }
  }

 private:
  static Vec3 Vec3f(float x, float y, float z) {
    return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
  }

  static Vec3 PointOf(const Shell& shell, std::uint32_t i) {
    return Vec3f(shell.x[i], shell.y[i], shell.z[i]);
  }

  // Unit gradient; where the field has none (on a medial axis), away from the part's centre.
  static Vec3 DirectionOf(const Hit& hit, const Vec3& p) {
    const Vec3 g = Vec3f(hit.gradient[0], hit.gradient[1], hit.gradient[2]);
    const double norm = g.norm();
    if (norm > 1e-3) {
      return g / norm;
    }
    return p.norm() > 0 ? Vec3(p.normalized()) : Vec3::UnitZ();
  }

  bool BoxesTouch(const RelativePose& X_SH, const Placed& scene) const {
    const Vec3 half_S = scene.half() + Vec3::Constant(margin_);
    const Vec3 half_H = held_.half();
    const Vec3 reach_S = half_S + X_SH.R.cwiseAbs() * half_H;
    const Vec3 reach_H = half_H + X_SH.R.transpose().cwiseAbs() * half_S;
    const Vec3 p_H = X_SH.R.transpose() * X_SH.p;
    return (X_SH.p.cwiseAbs().array() <= reach_S.array()).all() &&
           (p_H.cwiseAbs().array() <= reach_H.array()).all();
  }

  // Marks (keep = 0xff) or clears (keep = 0) the faces of this body's ignored pairs.
  bool SetMasks(BodyId id, std::uint8_t keep) noexcept {
    std::size_t pair = 0;
    for (const IgnoredPair& ignored : options_.ignored) {
      if (ignored.body != id) {
        continue;
      }
      const auto bit =
          static_cast<std::uint8_t>(1U << std::min<std::size_t>(pair++, kMaxPairsPerBody - 1));
      const auto mark = [&](std::span<const std::uint32_t> faces, std::vector<std::uint8_t>* mask) {
        for (const std::uint32_t f : faces) {
          if (f < kMaxFaces) {
            (*mask)[f] = static_cast<std::uint8_t>(((*mask)[f] | bit) & keep);
          }
        }
      };
      mark(ignored.held_faces, &work_->held_mask);
      mark(ignored.scene_faces, &work_->scene_mask);
    }
    return pair > 0;
  }

  static std::uint8_t BitsOf(const std::array<std::uint32_t, kMaxPointFaces>& faces,
                             const std::vector<std::uint8_t>& mask) {
    std::uint8_t bits = 0;
    for (const std::uint32_t f : faces) {
      if (f != kNoFace) {
        bits = static_cast<std::uint8_t>(bits | mask[f]);
      }
    }
    return bits;
  }

  HitBuffer Traverse(const Shell& shell, const Placed& field, const RelativePose& X) noexcept {
    HitBuffer hits;
    hits.hits = work_->hits.data();
    hits.capacity = static_cast<std::uint32_t>(work_->hits.size());
    // Room for the rounding of single precision coordinates.
    const double rounding = 4e-7 * (X.p.norm() + held_.half().norm() + field.half().norm());
    traverse_(shell.view, field.shape->field.view, X.Single(),
              static_cast<float>(margin_ + rounding), &hits);
    work_->stats.points_tested += hits.points_tested;
    work_->stats.is_truncated = work_->stats.is_truncated || hits.is_truncated;
    return hits;
  }

  void Forward(const Placed& scene, const RelativePose& X_SH, bool has_ignored) noexcept {
    const Shell& shell = held_.shape->shell;
    const HitBuffer hits = Traverse(shell, scene, X_SH);
    for (std::uint32_t i = 0; i < hits.count && !is_stopped_; ++i) {
      const Hit& hit = hits.hits[i];
      const Vec3 p_H = PointOf(shell, hit.point);
      const Vec3 p_S = X_SH.R * p_H + X_SH.p;
      const auto& faces = shell.faces[hit.point];
      FaceFilter filter;
      if (has_ignored) {
        filter = {work_->scene_mask.data(), BitsOf(faces, work_->held_mask)};
      }
      const Refined r = Refine(*scene.shape, p_S, static_cast<double>(hit.distance),
                               DirectionOf(hit, p_S), filter);
      if (!r.is_valid || r.distance >= margin_) {
        continue;
      }
      Contact contact;
      contact.p_WC = held_.R_WC * p_H + held_.p_WC;
      contact.nhat_W = scene.R_WC * r.gradient;
      contact.held_face = faces[0];
      contact.scene_face = r.face;
      Add(contact, r, r.gradient, p_S);
    }
  }

  void Reverse(const Placed& scene, const RelativePose& X_HS, bool has_ignored) noexcept {
    const Shell& shell = scene.shape->edges;
    const HitBuffer hits = Traverse(shell, held_, X_HS);
    for (std::uint32_t i = 0; i < hits.count && !is_stopped_; ++i) {
      const Hit& hit = hits.hits[i];
      const Vec3 p_S = PointOf(shell, hit.point);
      const Vec3 p_H = X_HS.R * p_S + X_HS.p;
      const auto& faces = shell.faces[hit.point];
      FaceFilter filter;
      if (has_ignored) {
        filter = {work_->held_mask.data(), BitsOf(faces, work_->scene_mask)};
      }
      const Refined r = Refine(*held_.shape, p_H, static_cast<double>(hit.distance),
                               DirectionOf(hit, p_H), filter);
      if (!r.is_valid || r.distance >= margin_) {
        continue;
      }
      const Vec3 gradient_W = held_.R_WC * r.gradient;
      Contact contact;
      contact.p_WC = held_.R_WC * p_H + held_.p_WC - r.distance * gradient_W;
      contact.nhat_W = -gradient_W;
      contact.held_face = r.face;
      contact.scene_face = faces[0];
      Add(contact, r, X_HS.R.transpose() * -r.gradient, p_S);
    }
  }

  void GroundLeaf(double z_W, std::size_t leaf) noexcept {
    const Shell& shell = held_.shape->shell;
    work_->stats.points_tested += shell.leaf_count[leaf];
    for (std::uint32_t i = 0; i < shell.leaf_count[leaf] && !is_stopped_; ++i) {
      const auto index = static_cast<std::uint32_t>(8 * leaf) + i;
      Contact contact;
      contact.p_WC = held_.R_WC * PointOf(shell, index) + held_.p_WC;
      Refined r;
      r.distance = contact.p_WC.z() - z_W;
      if (r.distance >= margin_) {
        continue;
      }
      r.is_exact = true;
      contact.held_face = shell.faces[index][0];
      body_ = {};
      Add(contact, r, Vec3::UnitZ(), contact.p_WC);
    }
  }

  void Add(Contact contact, const Refined& r, const Vec3& nhat_S, const Vec3& p_S) noexcept {
    contact.distance = r.distance;
    contact.body = body_;
    contact.is_exact = r.is_exact;
    work_->reducer.Add(contact, nhat_S, p_S);
    is_stopped_ = r.distance < stop_distance_;
  }

  const Placed& held_;
  const QueryOptions& options_;
  double margin_;
  double stop_distance_;
  TraverseFunction traverse_;
  QueryWorkspace::Data* work_;
  BodyId body_;
  bool is_stopped_{false};
};

}  // namespace

struct Scene::Data {
  struct Body {
    std::shared_ptr<const Shape> shape;
    spatial::Pose X_WB;
    bool is_enabled{true};
  };

  std::vector<Body> bodies;
  BodyTree tree;
  double ground_z_W{std::numeric_limits<double>::quiet_NaN()};
  TraverseFunction traverse{ChooseTraverse()};

  static spatial::Box BoxOf(const Body& body) {
    return spatial::Transform(body.X_WB, body.shape->box_B());
  }

  void Run(const spatial::Box& box_W, const QueryOptions& options,
           PairQuery* query) const noexcept {
    tree.Query(box_W, [&](std::uint32_t item) {
      const BodyId id{item};
      if (id != options.self) {
        query->Body(id, Placed(*bodies[item].shape, bodies[item].X_WB));
      }
      return !query->is_stopped();
    });
    if (!std::isnan(ground_z_W) && box_W.low.z() < ground_z_W) {
      query->Ground(ground_z_W);
    }
  }
};

Scene::Scene() : data_(std::make_unique<Data>()) {}

Scene::~Scene() = default;

BodyId Scene::Add(std::shared_ptr<const Shape> shape, const spatial::Pose& X_WB) {
  const BodyId id{data_->bodies.size()};
  data_->bodies.push_back({std::move(shape), X_WB, true});
  data_->tree.Reserve(std::max<std::size_t>(16, data_->bodies.capacity()));
  data_->tree.Insert(id.value(), Data::BoxOf(data_->bodies.back()));
  return id;
}

void Scene::SetPose(BodyId body, const spatial::Pose& X_WB) noexcept {
  Data::Body& b = data_->bodies[body.index()];
  b.X_WB = X_WB;
  if (b.is_enabled) {
    data_->tree.Move(body.value(), Data::BoxOf(b));
  }
}

void Scene::SetEnabled(BodyId body, bool is_enabled) noexcept {
  Data::Body& b = data_->bodies[body.index()];
  if (b.is_enabled == is_enabled) {
    return;
  }
  b.is_enabled = is_enabled;
  if (is_enabled) {
    data_->tree.Insert(body.value(), Data::BoxOf(b));
  } else {
    data_->tree.Remove(body.value());
  }
}

bool Scene::is_enabled(BodyId body) const noexcept {
  return data_->bodies[body.index()].is_enabled;
}

const spatial::Pose& Scene::pose(BodyId body) const noexcept {
  return data_->bodies[body.index()].X_WB;
}

const Shape& Scene::shape(BodyId body) const noexcept {
  return *data_->bodies[body.index()].shape;
}

std::size_t Scene::size() const noexcept {
  return data_->bodies.size();
}

void Scene::SetGround(double z_W) noexcept {
  data_->ground_z_W = z_W;
}

void Scene::Query(const Shape& held, const spatial::Pose& X_WH, const QueryOptions& options,
                  QueryWorkspace* workspace) const noexcept {
  QueryWorkspace::Data& work = workspace->data();
  work.Clear();
  const Placed placed(held, X_WH);
  PairQuery query(placed, options, options.margin, -std::numeric_limits<double>::infinity(),
                  data_->traverse, &work);
  data_->Run(spatial::Transform(X_WH, held.box_B()).Expanded(options.margin), options, &query);
  work.stats.candidates = work.reducer.count();
  work.stats.is_truncated = work.stats.is_truncated || work.reducer.is_full();
  work.deepest = work.reducer.deepest();
  work.contact_count = work.reducer.Select(work.contacts);
}

bool Scene::IsFree(const Shape& held, const spatial::Pose& X_WH, double tolerance,
                   const QueryOptions& options, QueryWorkspace* workspace) const noexcept {
  QueryWorkspace::Data& work = workspace->data();
  work.Clear();
  const Placed placed(held, X_WH);
  PairQuery query(placed, options, -tolerance, -tolerance, data_->traverse, &work);
  data_->Run(spatial::Transform(X_WH, held.box_B()), options, &query);
  work.stats.candidates = work.reducer.count();
  work.deepest = work.reducer.deepest();
  work.contact_count = work.reducer.Select(work.contacts);
  return !query.is_stopped();
}

}  // namespace hvas::contact
