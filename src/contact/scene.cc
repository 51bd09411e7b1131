#include "contact/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/body_tree.h"
#include "contact/query.h"

namespace hvas::contact {

QueryWorkspace::QueryWorkspace(QueryMemory memory) : data_(std::make_unique<Data>()) {
  if (memory == QueryMemory::kOfMotion) {
    data_->memory = std::make_unique<BoundMemory>();
  }
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

// Whether the two faces of the i-th contact touch where no edge of theirs is near, too.
bool TouchesElsewhere(std::span<const RawContact> all, std::span<const bool> is_at_edge,
                      std::size_t i) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!is_at_edge[k] && all[k].body == all[i].body && all[k].held_face == all[i].held_face &&
        all[k].scene_face == all[i].scene_face) {
      return true;
    }
  }
  return false;
}

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
      const auto has_item = [item](std::span<const BodyId> list) {
        return std::find(list.begin(), list.end(), BodyId{item}) != list.end();
      };
      if (BodyId{item} != options.self &&
          std::none_of(options.left_out.begin(), options.left_out.end(), has_item)) {
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
  void Finish(const Placed& held, const std::optional<BrokenEdges>& edges,
              QueryWorkspace::Data* work) const noexcept {
    const std::size_t selected = work->reducer.Select(work->raw);
    work->deepest = work->reducer.deepest();
    work->stats.candidates = work->reducer.count();
    work->stats.is_truncated = work->stats.is_truncated || work->reducer.is_full();
    const std::size_t lowest = std::min({work->reducer.group_count(), selected, kMostSlides});
    const std::span<RawContact> raw(work->raw.data(), selected);
    for (std::size_t i = 0; i < selected; ++i) {
      if (raw[i].is_screened) {
        RefineScreened(held, &raw[i]);
      }
      if (i < lowest && raw[i].is_rough) {
        RefineRough(held, &raw[i]);
      }
      if (i < lowest && raw[i].point != kFixedPoint) {
        MoveToLowest(held, &raw[i]);
      }
      work->deepest = std::min(work->deepest, raw[i].distance);
    }
    const double deepest = std::max(0.0, -work->deepest);
    work->contact_count = edges.has_value() ? BreakEdges(held, *edges, deepest, raw) : selected;
    for (std::size_t i = 0; i < work->contact_count; ++i) {
      work->contacts[i] = MakeContact(held, raw[i]);
    }
  }

  // Gives a screened contact the distance and gradient of its face in double precision.
  void RefineScreened(const Placed& held, RawContact* raw) const noexcept {
    const Met met = Meet(held, *raw);
    const std::uint32_t face = raw->is_reverse ? raw->held_face : raw->scene_face;
    const spatial::SurfaceDistance exact =
        FaceSurface(*met.field.shape, met.field.offsets, face).CalcDistance(met.p);
    if (exact.is_valid) {
      raw->distance = exact.distance + raw->allowance;
      raw->gradient = exact.gradient;
    }
  }

  // Gives a contact with freeform faces the distance and gradient of their smooth surface.
  void RefineRough(const Placed& held, RawContact* raw) const noexcept {
    const Met met = Meet(held, *raw);
    const Refined r = RefineAlone(*met.field.shape, met.field.offsets, met.p, {});
    const std::uint32_t face = raw->is_reverse ? raw->held_face : raw->scene_face;
    if (r.is_valid && r.is_exact && r.face == face) {
      raw->distance = r.distance + raw->allowance;
      raw->gradient = r.gradient;
      raw->triangle = r.triangle;
      raw->is_exact = true;
    }
  }

  void MoveToLowest(const Placed& held, RawContact* raw) const noexcept {
    if (raw->body == BodyId{}.value()) {
      spatial::Surface plane;
      plane.kind = spatial::SurfaceKind::kPlane;
      plane.axis = held.R_WC.row(2);
      plane.origin = held.R_WC.transpose() * (Vec3(0, 0, ground_z_W) - held.p_WC);
      SlideOnPlane(held, held.shape->shell, plane, raw);
      return;
    }
    const Placed scene = Place(raw->body);
    const Placed& sampled = raw->is_reverse ? scene : held;
    const Placed& field = raw->is_reverse ? held : scene;
    const Shell& shell = raw->is_reverse ? scene.shape->features : held.shape->shell;
    Slide(sampled, shell, field, raw);
  }

  // A sample and the shape in whose field it is.
  struct Met {
    Placed field;
    Vec3 p;  // In the field's frame.
  };

  [[nodiscard]] Met Meet(const Placed& held, const RawContact& raw) const noexcept {
    const Placed scene = Place(raw.body);
    const Placed& sampled = raw.is_reverse ? scene : held;
    const Placed& field = raw.is_reverse ? held : scene;
    return {field, RelativePose(field, sampled) * raw.p};
  }

  // Whether the contact is with the side of a ledge that may be lower than `height`: just inside of
  // where the side is met another face is nearer, its top.
  bool FindTop(const Placed& held, double height, const RawContact& raw,
               Refined* top) const noexcept {
    constexpr double kSquare = 0.3;  // Cosine; blunter edges do not catch.
    constexpr double kLower = 0.99;  // Share of the height that is still below the ledge: a choice.
    if (raw.distance < -height) {
      return false;
    }
    const Met met = Meet(held, raw);
    const Vec3 inside = met.p - (raw.distance + height) * raw.gradient;
    *top = RefineAlone(*met.field.shape, met.field.offsets, inside, {});
    const bool is_low = top->is_exact && top->distance < 0 && top->distance > -kLower * height &&
                        top->gradient.dot(raw.gradient) < kSquare;
    top->distance += top->gradient.dot(met.p - inside);
    return is_low;
  }

  // Whether what seems to be in the way is not met on it: beside an edge the nearest point's plane
  // reaches further than the part. No deeper than `depth` is not met either.
  [[nodiscard]] bool IsPassedBy(const Placed& held, const Placed& held_ahead, double depth,
                                const RawContact& raw) const noexcept {
    constexpr double kLongest = 0.2e-3;  // [m] of a step; there may be a wall in a longer one.
    if (raw.distance <= 0) {
      return false;
    }
    const Met ahead = Meet(held_ahead, raw);
    const Vec3 step = ahead.p - Meet(held, raw).p;
    return raw.distance + raw.gradient.dot(step) < 0 && step.squaredNorm() < kLongest * kLongest &&
           RefineAlone(*ahead.field.shape, ahead.field.offsets, ahead.p, {}).distance > -depth;
  }

  // Leaves out what is passed by, and contacts with the sides of low ledges; those that are past
  // the side already become contacts with the top. Of two faces that meet within `height` the side
  // is the one that touches nowhere else. Returns how many are left, in their order.
  std::size_t BreakEdges(const Placed& held, const BrokenEdges& edges, double deepest,
                         std::span<RawContact> raw) const noexcept {
    Placed ahead = held;
    ahead.R_WC = edges.X_WH_ahead.R();
    ahead.p_WC = edges.X_WH_ahead.p() + ahead.R_WC * held.shape->p_BC;
    std::array<Refined, QueryWorkspace::kMaxContacts> top;
    std::array<bool, QueryWorkspace::kMaxContacts> is_low{};
    std::array<bool, QueryWorkspace::kMaxContacts> is_passed{};
    for (std::size_t i = 0; i < raw.size(); ++i) {
      if ((raw[i].is_exact || raw[i].is_rough) && raw[i].body != BodyId{}.value()) {
        is_low[i] = FindTop(held, edges.height, raw[i], &top[i]);
        is_passed[i] = IsPassedBy(held, ahead, edges.height + deepest, raw[i]);
      }
    }
    std::size_t kept = 0;
    const std::span<const RawContact> all = raw;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      RawContact contact = raw[i];
      const bool is_side = is_low[i] && !TouchesElsewhere(all, is_low, i);
      if (is_passed[i] || (is_side && contact.distance > 0)) {
        continue;
      }
      if (is_side) {
        contact.distance = top[i].distance;
        contact.gradient = top[i].gradient;
        (contact.is_reverse ? contact.held_face : contact.scene_face) = top[i].face;
      }
      raw[kept++] = contact;
    }
    return kept;
  }

  [[nodiscard]] Contact MakeContact(const Placed& held, const RawContact& raw) const noexcept {
    Contact contact;
    contact.held_face = raw.held_face;
    contact.scene_face = raw.scene_face;
    contact.is_exact = raw.is_exact;
    contact.distance = raw.distance;
    if (raw.body == BodyId{}.value()) {
      contact.p_WC = held.R_WC * raw.p + held.p_WC;
      contact.nhat_W = Vec3::UnitZ();
      return contact;
    }
    contact.body = BodyId{raw.body};
    const Placed scene = Place(raw.body);
    const Placed& sampled = raw.is_reverse ? scene : held;
    const Placed& field = raw.is_reverse ? held : scene;
    contact.p_WC = sampled.R_WC * raw.p + sampled.p_WC;
    contact.nhat_W = field.R_WC * raw.gradient;
    if (raw.is_reverse) {
      contact.p_WC -= raw.distance * contact.nhat_W;  // From the scene's edge to the held surface.
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
  data_->Finish(placed, options.broken_edges, &work);
}

bool Scene::IsFree(const Shape& held, const spatial::Pose& X_WH, double tolerance,
                   const QueryOptions& options, QueryWorkspace* workspace) const noexcept {
  QueryWorkspace::Data& work = workspace->data();
  work.Clear();
  const Placed placed(held, X_WH, data_->OffsetsOfHeld(options));
  BodyQuery query(placed, options, -tolerance, -tolerance, data_->kernel, &work);
  data_->Run(data_->BoxOf(placed, X_WH, 0), options, work, &query);
  data_->Finish(placed, {}, &work);
  return !query.is_stopped();
}

}  // namespace hvas::contact
