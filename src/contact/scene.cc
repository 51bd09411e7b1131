#include "contact/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/body_tree.h"
#include "contact/query.h"

namespace hvas::contact {

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

const ContactLayer& QueryWorkspace::layer() const noexcept {
  return data_->layer;
}

namespace {

constexpr std::size_t kMostSlides = 24;  // Of the deepest groups; the others stay at their samples.

}  // namespace

struct Scene::Data {
  struct Body {
    std::shared_ptr<const Shape> shape;
    spatial::Pose X_WB;
    bool is_enabled{true};
    std::shared_ptr<const FaceOffsets> offsets;
  };

  std::vector<Body> bodies;
  BodyTree tree;
  double growth{0};  // Of all bodies' offsets, the most; the tree has their boxes as drawn.
  double ground_z_W{std::numeric_limits<double>::quiet_NaN()};
  Kernel kernel{ChooseKernel()};

  static spatial::Box BoxOf(const Body& body) {
    return spatial::Transform(body.X_WB, body.shape->box_B());
  }

  [[nodiscard]] const FaceOffsets* OffsetsOfHeld(const QueryOptions& options) const noexcept {
    const bool is_in_scene = options.self.is_valid() && options.self.index() < bodies.size();
    return options.held_offsets != nullptr || !is_in_scene
               ? options.held_offsets
               : bodies[options.self.index()].offsets.get();
  }

  // Where the held part as made may meet bodies as made.
  [[nodiscard]] spatial::Box BoxOf(const Placed& held, const spatial::Pose& X_WH,
                                   double margin) const noexcept {
    return spatial::Transform(X_WH, held.shape->box_B).Expanded(margin + held.growth() + growth);
  }

  [[nodiscard]] Placed Place(std::uint32_t item) const noexcept {
    return {*bodies[item].shape, bodies[item].X_WB, bodies[item].offsets.get()};
  }

  void Run(const spatial::Box& box_W, const QueryOptions& options, const QueryWorkspace::Data& work,
           BodyQuery* query) const noexcept {
    tree.Query(box_W, [&](std::uint32_t item) {
      if (BodyId{item} != options.self &&
          std::find(options.left_out.begin(), options.left_out.end(), BodyId{item}) ==
              options.left_out.end()) {
        query->Collect(BodyId{item}, Place(item));
      }
      return true;
    });
    query->Share();
    for (std::size_t i = 0; i < work.body_count && !query->is_stopped(); ++i) {
      query->Body(i, Place(work.bodies[i].body.value()));
    }
    if (!std::isnan(ground_z_W) && box_W.low.z() < ground_z_W) {
      query->Ground(ground_z_W);
    }
  }

  // Turns the reducer's choice into contacts, the deepest of each group at its very lowest point.
  void Finish(const Placed& held, QueryWorkspace::Data* work) const noexcept {
    work->contact_count = work->reducer.Select(work->raw);
    work->deepest = work->reducer.deepest();
    work->stats.candidates = work->reducer.count();
    work->stats.is_truncated = work->stats.is_truncated || work->reducer.is_full();
    const std::size_t lowest =
        std::min({work->reducer.group_count(), work->contact_count, kMostSlides});
    for (std::size_t i = 0; i < work->contact_count; ++i) {
      work->contacts[i] = MakeContact(held, i < lowest, &work->raw[i]);
      work->deepest = std::min(work->deepest, work->contacts[i].distance);
    }
  }

  [[nodiscard]] Contact MakeContact(const Placed& held, bool is_lowest,
                                    RawContact* raw) const noexcept {
    Contact contact;
    contact.held_face = raw->held_face;
    contact.scene_face = raw->scene_face;
    contact.is_exact = raw->is_exact;
    if (raw->body == BodyId{}.value()) {
      if (is_lowest) {
        spatial::Surface plane;
        plane.kind = spatial::SurfaceKind::kPlane;
        plane.axis = held.R_WC.row(2);
        plane.origin = held.R_WC.transpose() * (Vec3(0, 0, ground_z_W) - held.p_WC);
        SlideOnPlane(held, held.shape->shell, plane, raw);
      }
      contact.p_WC = held.R_WC * raw->p + held.p_WC;
      contact.nhat_W = Vec3::UnitZ();
      contact.distance = raw->distance;
      return contact;
    }
    contact.body = BodyId{raw->body};
    const Placed scene = Place(raw->body);
    const Placed& sampled = raw->is_reverse ? scene : held;
    const Placed& field = raw->is_reverse ? held : scene;
    if (is_lowest) {
      const Shell& shell = raw->is_reverse ? scene.shape->features : held.shape->shell;
      Slide(sampled, shell, field, raw);
    }
    contact.distance = raw->distance;
    contact.p_WC = sampled.R_WC * raw->p + sampled.p_WC;
    contact.nhat_W = field.R_WC * raw->gradient;
    if (raw->is_reverse) {
      contact.p_WC -= raw->distance * contact.nhat_W;  // From the scene's edge to the held surface.
      contact.nhat_W = -contact.nhat_W;
    }
    return contact;
  }
};

Scene::Scene() : data_(std::make_unique<Data>()) {}

Scene::~Scene() = default;

BodyId Scene::Add(std::shared_ptr<const Shape> shape, const spatial::Pose& X_WB) {
  const BodyId id{data_->bodies.size()};
  data_->bodies.push_back({std::move(shape), X_WB, true, nullptr});
  data_->tree.Reserve(data_->bodies.capacity());
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

void Scene::SetOffsets(BodyId body, std::shared_ptr<const FaceOffsets> offsets) {
  data_->bodies[body.index()].offsets = std::move(offsets);
  data_->growth = 0;
  for (const Data::Body& b : data_->bodies) {
    data_->growth = std::max(data_->growth, b.offsets != nullptr ? b.offsets->growth() : 0);
  }
}

const FaceOffsets* Scene::offsets(BodyId body) const noexcept {
  return data_->bodies[body.index()].offsets.get();
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

void Scene::UseScalarKernel() noexcept {
  data_->kernel = ScalarKernel();
}

void Scene::SetGround(double z_W) noexcept {
  data_->ground_z_W = z_W;
}

void Scene::Query(const Shape& held, const spatial::Pose& X_WH, const QueryOptions& options,
                  QueryWorkspace* workspace) const noexcept {
  QueryWorkspace::Data& work = workspace->data();
  work.Clear();
  const Placed placed(held, X_WH, data_->OffsetsOfHeld(options));
  BodyQuery query(placed, options, options.margin, -std::numeric_limits<double>::infinity(),
                  data_->kernel, &work);
  data_->Run(data_->BoxOf(placed, X_WH, options.margin), options, work, &query);
  data_->Finish(placed, &work);
}

bool Scene::IsFree(const Shape& held, const spatial::Pose& X_WH, double tolerance,
                   const QueryOptions& options, QueryWorkspace* workspace) const noexcept {
  QueryWorkspace::Data& work = workspace->data();
  work.Clear();
  const Placed placed(held, X_WH, data_->OffsetsOfHeld(options));
  BodyQuery query(placed, options, -tolerance, -tolerance, data_->kernel, &work);
  data_->Run(data_->BoxOf(placed, X_WH, 0), options, work, &query);
  data_->Finish(placed, &work);
  return !query.is_stopped();
}

}  // namespace hvas::contact
