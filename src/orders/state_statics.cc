#include "orders/state_statics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "contact/scene.h"
#include "fits/friction.h"
#include "mates/mate_kind.h"
#include "mates/place_bodies.h"
#include "sequence/fit_of_mate.h"
#include "sequence/neighbours.h"
#include "statics/equilibrium.h"
#include "statics/least_holds.h"

namespace hvas::orders {

using product::OccurrenceId;

/** A contact of two parts, and the mate whose walls it is on. */
struct StateContact {
  statics::StaticContact contact;  // Bodies are occurrences.
  bool is_on_walls{false};         // Walls of a slot that guide: they have no friction.
};

/** What a mate holds. */
struct StateJoint {
  OccurrenceId a;
  OccurrenceId b;
  Vec3 p_W;
  Vec3 axis_W;
  double pull_out;  // By the fit alone [N].
  double torque;    // By the fit alone [N m].
  double friction;  // Of what weight adds across the axis.
  double radius;    // [m]
};

/** A part that a screw, or a nut on it, presses on. */
struct StateClamp {
  OccurrenceId by;
  OccurrenceId part;
  OccurrenceId screw;
  OccurrenceId nut;
  Vec3 p_W;
};

namespace {

using product::FitKind;
using product::Mate;
using product::MateKind;

// Parts that are this close as drawn touch when they have settled [m]: as neighbours.cc has it.
constexpr double kSettledGap = 0.1e-3;
// Sine of the inclination of a normal to the horizontal below which a contact has no friction: what
// presses two upright walls together is not known of rigid bodies, and forces that hold a part
// between such walls by pressing it from both sides are no forces that gravity makes. A choice: 10
// degrees, an incline beyond which parts that slide in one another by friction of 0.15 wedge.
constexpr double kUprightWall = 0.17;
// Share of the full turn from which on a hole holds its shaft across its axis in all directions: a
// shaft does not come out of more than half a turn. A choice, three fifths, for recognised faces
// that end at edges.
constexpr double kClosedHole = 0.6;
// Cosine of the angle between two directions that are the same: 1 degree. A choice, as drawn parts
// are exact.
constexpr double kSameDirection = 0.99985;
// Share of a part's extent within which its points are on the table, for facets of round edges. A
// choice.
constexpr double kOnTable = 1e-5;

double FindStaticFriction(const product::Product& product, OccurrenceId a, OccurrenceId b) {
  for (const product::ContactPair& pair : product.contact_pairs) {
    const bool is_this = (pair.a == a && pair.b == b) || (pair.a == b && pair.b == a);
    if (is_this && pair.friction) {
      return *pair.friction;
    }
  }
  return fits::FindFriction(sequence::SurfaceOf(product.part_of(a).material),
                            sequence::SurfaceOf(product.part_of(b).material), fits::FrictionLaw{})
      .static_coefficient;
}

bool HasFace(std::span<const std::uint32_t> faces, std::uint32_t face) {
  return std::binary_search(faces.begin(), faces.end(), face);
}

bool HoldsFirmly(const Mate& mate) {
  return mate.fit && (mate.fit->kind == FitKind::kThread || mate.fit->kind == FitKind::kInsert);
}

double CalcEngagedLength(const Mate& mate) {
  return std::min(mate.hole_high, mate.shaft_high) - std::max(mate.hole_low, mate.shaft_low);
}

/** The joint that a shaft in a hole, or a tongue that is pressed into its slot, is; none where
 contacts answer for the mate. */
std::optional<StateJoint> FindJoint(const simulation::Model& model, const Mate& mate) {
  const product::Product& product = *model.product;
  if (!mates::HasFit(mate.kind) || mates::IsContradicted(product, mate)) {
    return std::nullopt;
  }
  const double length = CalcEngagedLength(mate);
  if (!(length > 0)) {
    return std::nullopt;
  }
  const spatial::Pose X_WM = model.bodies[mate.a.occurrence.index()].X_WB_goal * mate.a.X_BM;
  const bool is_round = mate.kind == MateKind::kAxisHole;
  const Vec3 axis_W = X_WM.R().col(is_round ? 2 : 0);
  const double middle =
      (std::min(mate.hole_high, mate.shaft_high) + std::max(mate.hole_low, mate.shaft_low)) / 2;
  StateJoint joint{
      mate.a.occurrence, mate.b.occurrence, X_WM.p() + middle * axis_W, axis_W, 0, 0, 0,
      mate.hole_radius};
  joint.friction = mate.conditions.friction ? *mate.conditions.friction
                                            : FindStaticFriction(product, joint.a, joint.b);
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const auto& fit = model.mates[mate.id.index()].fit;
  if (HoldsFirmly(mate) || (mate.fit && mate.fit->kind == FitKind::kInterference && !fit)) {
    joint.pull_out = joint.torque = kNoLimit;
    return joint;
  }
  if (fit) {
    joint.pull_out = fit->CalcReleaseForce(fit->length());
    joint.torque = is_round ? fit->CalcTorque(fit->length()) : kNoLimit;
  }
  if (!is_round) {
    return joint.pull_out > 0 ? std::optional(joint) : std::nullopt;
  }
  const product::Feature& hole =
      product.part_of(mate.a.occurrence).features[mate.a.feature.index()];
  const bool is_closed = hole.coverage >= kClosedHole * 2 * std::numbers::pi;
  return is_closed || joint.pull_out > 0 ? std::optional(joint) : std::nullopt;
}

/** Finds the contacts of two parts as drawn, without those of faces that joints answer for. */
class PairQuery {
 public:
  explicit PairQuery(const simulation::Model& model, const std::vector<bool>& is_joint)
      : model_(model), is_joint_(is_joint) {
    for (const simulation::Body& body : model.bodies) {
      scene_.SetEnabled(scene_.Add(body.shape, body.X_WB_goal), false);
    }
  }

  /** Appends them. */
  void Append(OccurrenceId a, OccurrenceId b, std::vector<StateContact>* contacts) {
    const contact::BodyId body(b.index());
    std::vector<contact::IgnoredPair> ignored;
    std::vector<Walls> walls;
    contact::QueryOptions options;
    options.margin = kSettledGap;
    for (const product::MateId id : model_.mates_of[a.index()]) {
      const Mate& mate = model_.product->mates[id.index()];
      if (!mate.Joins(a, b) || !mates::HasFit(mate.kind)) {
        continue;
      }
      const simulation::ModelMate& faces = model_.mates[id.index()];
      const bool is_a = mate.a.occurrence == a;
      const haptics::MateFaces& own = is_a ? *faces.faces_a : *faces.faces_b;
      const haptics::MateFaces& other = is_a ? *faces.faces_b : *faces.faces_a;
      if (is_joint_[id.index()]) {
        ignored.push_back({body, own.mating, other.with_neighbours});
        ignored.push_back({body, own.with_neighbours, other.mating});
        continue;
      }
      options.margin = std::max(options.margin,
                                kSettledGap + std::max(0.0, mate.hole_radius - mate.shaft_radius));
      if (mate.kind == MateKind::kPrismatic) {
        walls.push_back({own.mating, other.mating});
      }
    }
    options.ignored = ignored;
    scene_.SetEnabled(body, true);
    scene_.Query(*model_.bodies[a.index()].shape, model_.bodies[a.index()].X_WB_goal, options,
                 &workspace_);
    scene_.SetEnabled(body, false);
    const double friction = FindStaticFriction(*model_.product, a, b);
    const auto found = workspace_.contacts();
    // What is not on an exact face is an estimate at an edge, where faces are exact elsewhere.
    const bool has_exact = std::any_of(found.begin(), found.end(),
                                       [](const contact::Contact& c) { return c.is_exact; });
    for (const contact::Contact& c : found) {
      if (has_exact && !c.is_exact) {
        continue;
      }
      const bool is_on_walls = std::any_of(walls.begin(), walls.end(), [&c](const Walls& pair) {
        return HasFace(pair.own, c.held_face) && HasFace(pair.other, c.scene_face);
      });
      contacts->push_back({{static_cast<int>(a.index()), static_cast<int>(b.index()), c.p_WC,
                            c.nhat_W.normalized(), friction},
                           is_on_walls});
    }
  }

 private:
  struct Walls {
    std::span<const std::uint32_t> own;
    std::span<const std::uint32_t> other;
  };

  const simulation::Model& model_;
  const std::vector<bool>& is_joint_;
  contact::Scene scene_;
  contact::QueryWorkspace workspace_;
};

/** Normal of a plane mate, or axis of a conical seat; none of other mates. */
std::optional<Vec3> FindSeatDirection(const simulation::Model& model, const Mate& mate) {
  if (mate.kind != MateKind::kFaceFace && mate.kind != MateKind::kConeSeat) {
    return std::nullopt;
  }
  const simulation::Body& body = model.bodies[mate.a.occurrence.index()];
  return Vec3((body.X_WB_goal * mate.a.X_BM).R().col(2));
}

bool HasAxisMate(const simulation::Model& model, OccurrenceId a, OccurrenceId b) {
  const auto& ids = model.mates_of[a.index()];
  return std::any_of(ids.begin(), ids.end(), [&](product::MateId id) {
    const Mate& mate = model.product->mates[id.index()];
    return mate.kind == MateKind::kAxisHole && mate.Joins(a, b);
  });
}

/** Parts under the head of a screw, and those under a nut that the screw goes through. */
std::vector<StateClamp> ListClamped(const simulation::Model& model) {
  std::vector<StateClamp> clamped;
  for (const Mate& thread : model.product->mates) {
    if (!thread.fit || thread.fit->kind != FitKind::kThread || thread.kind != MateKind::kAxisHole ||
        mates::IsContradicted(*model.product, thread)) {
      continue;
    }
    const OccurrenceId nut = thread.a.occurrence;
    const OccurrenceId screw = thread.b.occurrence;
    const Vec3 axis_W = (model.bodies[nut.index()].X_WB_goal * thread.a.X_BM).R().col(2);
    for (const OccurrenceId by : {screw, nut}) {
      for (const product::MateId id : model.mates_of[by.index()]) {
        const Mate& seat = model.product->mates[id.index()];
        const OccurrenceId part = seat.a.occurrence == by ? seat.b.occurrence : seat.a.occurrence;
        const std::optional<Vec3> direction = FindSeatDirection(model, seat);
        if (part == nut || part == screw || !direction ||
            std::abs(direction->dot(axis_W)) < kSameDirection ||
            (by == nut && !HasAxisMate(model, screw, part))) {
          continue;
        }
        const simulation::Body& body = model.bodies[seat.a.occurrence.index()];
        clamped.push_back({by, part, screw, nut, (body.X_WB_goal * seat.a.X_BM).p()});
      }
    }
  }
  return clamped;
}

using Vec2 = Eigen::Vector2d;

/** Distance of the origin from the nearest edge of the convex hull of points, positive within; the
 least over the half planes that hold all points and touch two of them. */
double CalcInside(const std::vector<Vec2>& points) {
  double inside = std::numeric_limits<double>::infinity();
  bool has_edge = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < points.size(); ++j) {
      const Vec2 along = points[j] - points[i];
      if (i == j || along.norm() == 0) {
        continue;
      }
      const Vec2 inward = Vec2(-along.y(), along.x()).normalized();
      const bool is_edge = std::all_of(points.begin(), points.end(), [&](const Vec2& p) {
        return inward.dot(p - points[i]) >= -1e-9 * along.norm();
      });
      if (is_edge) {
        has_edge = true;
        inside = std::min(inside, -inward.dot(points[i]));
      }
    }
  }
  return has_edge ? inside : 0;
}

/** The margin of a part that stands on a table with gravity along a direction [rad]. */
double CalcMargin(const product::Part& part, const Vec3& p_BBcm, const Vec3& ghat_B) {
  double lowest = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : part.mesh.vertices) {
    lowest = std::max(lowest, ghat_B.dot(vertex));
  }
  const double height = lowest - ghat_B.dot(p_BBcm);
  const Vec3 u = ghat_B.unitOrthogonal();
  const Vec3 v = ghat_B.cross(u);
  const double tolerance = kOnTable * part.box_B.size().norm();
  // The outermost of the points on the table in each of many directions: their hull is that of all
  // but for a part in a thousand of a circle.
  constexpr int kDirections = 64;
  std::vector<Vec2> points;
  for (const Vec3& vertex : part.mesh.vertices) {
    if (lowest - ghat_B.dot(vertex) <= tolerance) {
      points.emplace_back(u.dot(vertex - p_BBcm), v.dot(vertex - p_BBcm));
    }
  }
  std::vector<Vec2> outermost;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const Vec2 direction(std::cos(angle), std::sin(angle));
    outermost.push_back(*std::max_element(
        points.begin(), points.end(),
        [&](const Vec2& p, const Vec2& q) { return p.dot(direction) < q.dot(direction); }));
  }
  return std::atan2(CalcInside(outermost), height);
}

}  // namespace

namespace {

/** The bodies that are there in a state, with what holds them. */
struct StateProblem {
  statics::StaticProblem problem;
  std::vector<int> body_of;  // By occurrence; statics::kGround: it is not there.
  std::vector<OccurrenceId> occurrence_of;

  [[nodiscard]] int BodyOf(OccurrenceId id) const { return body_of[id.index()]; }

  [[nodiscard]] bool Has(OccurrenceId id) const { return BodyOf(id) != statics::kGround; }
};

void AddContacts(const std::vector<StateContact>& contacts, const Vec3& ghat_W,
                 StateProblem* state) {
  for (const StateContact& pair : contacts) {
    statics::StaticContact contact = pair.contact;
    contact.a = state->body_of[static_cast<std::size_t>(pair.contact.a)];
    contact.b = state->body_of[static_cast<std::size_t>(pair.contact.b)];
    if (contact.a == statics::kGround || contact.b == statics::kGround) {
      continue;
    }
    if (pair.is_on_walls || std::abs(contact.nhat_W.dot(ghat_W)) < kUprightWall) {
      contact.friction = 0;
    }
    state->problem.contacts.push_back(contact);
  }
}

void AddJoints(const std::vector<simulation::Body>& bodies, const std::vector<StateJoint>& joints,
               StateProblem* state) {
  for (const StateJoint& joint : joints) {
    if (!state->Has(joint.a) || !state->Has(joint.b)) {
      continue;
    }
    // The lighter part lies in, or on, the other one with its weight across the axis.
    const double mass =
        std::min(bodies[joint.a.index()].mass.mass, bodies[joint.b.index()].mass.mass);
    const double across = joint.friction * mass * state->problem.g_W.cross(joint.axis_W).norm();
    state->problem.joints.push_back({state->BodyOf(joint.a), state->BodyOf(joint.b), joint.p_W,
                                     joint.axis_W, joint.pull_out + across,
                                     joint.torque + across * joint.radius});
  }
}

void AddClamps(const std::vector<StateClamp>& clamps, StateProblem* state) {
  for (const StateClamp& clamp : clamps) {
    if (state->Has(clamp.part) && state->Has(clamp.screw) && state->Has(clamp.nut)) {
      statics::StaticJoint joint;
      joint.a = state->BodyOf(clamp.part);
      joint.b = state->BodyOf(clamp.by);
      joint.p_W = clamp.p_W;
      state->problem.joints.push_back(joint);
    }
  }
}

/** Solves for the equilibrium, and for the least holds where they are asked for. */
Result<statics::Equilibrium> Solve(const StateProblem& state, bool finds_least_holds,
                                   StateStability* stability) {
  if (!finds_least_holds) {
    auto found = statics::SolveEquilibrium(state.problem);
    if (found) {
      stability->is_least_proven = found->stands;
    }
    return found;
  }
  auto holds = statics::FindLeastHolds(state.problem);
  if (!holds) {
    return Unexpected(holds.error());
  }
  for (const int body : holds->bodies) {
    stability->holds.push_back(state.occurrence_of[static_cast<std::size_t>(body)]);
  }
  stability->least = holds->least;
  stability->is_least_proven = holds->is_proven;
  return std::move(holds->unheld);
}

}  // namespace

struct StateStatics::Data {
  const simulation::Model& model;
  std::vector<StateContact> contacts;
  std::vector<StateJoint> joints;
  std::vector<StateClamp> clamped;
  std::vector<bool> is_tool;
  std::vector<bool> is_fixture;

  explicit Data(const simulation::Model& m) : model(m) {}

  [[nodiscard]] StateProblem MakeProblem(const std::vector<bool>& is_in_place,
                                         const StateStaticsOptions& options) const;
};

StateProblem StateStatics::Data::MakeProblem(const std::vector<bool>& is_in_place,
                                             const StateStaticsOptions& options) const {
  const OccurrenceId base = sequence::FindBase(model.sequence);
  StateProblem state;
  state.problem.g_W = statics::kStandardGravity * options.ghat_W;
  state.body_of.assign(model.bodies.size(), statics::kGround);
  for (const simulation::Body& body : model.bodies) {
    const std::size_t i = body.occurrence.index();
    if (is_tool[i] || (!is_fixture[i] && !is_in_place[i])) {
      continue;
    }
    state.body_of[i] = static_cast<int>(state.occurrence_of.size());
    state.occurrence_of.push_back(body.occurrence);
    const bool is_held = is_fixture[i] || (options.is_base_held && body.occurrence == base);
    state.problem.bodies.push_back({body.mass.mass, body.X_WB_goal * body.mass.p_BoBcm_B, is_held});
  }
  AddContacts(contacts, options.ghat_W, &state);
  AddJoints(model.bodies, joints, &state);
  if (options.are_screws_tight) {
    AddClamps(clamped, &state);
  }
  return state;
}

StateStatics::StateStatics(const simulation::Model& model) {
  auto data = std::make_unique<Data>(model);
  const std::size_t count = model.bodies.size();
  data->is_tool.assign(count, false);
  data->is_fixture.assign(count, false);
  for (const OccurrenceId id : model.accessories.tools) {
    data->is_tool[id.index()] = true;
  }
  for (const OccurrenceId id : model.accessories.fixtures) {
    data->is_fixture[id.index()] = true;
  }
  std::vector<bool> is_joint(model.product->mates.size(), false);
  for (const Mate& mate : model.product->mates) {
    if (std::optional<StateJoint> joint = FindJoint(model, mate)) {
      is_joint[mate.id.index()] = true;
      data->joints.push_back(*joint);
    }
  }
  PairQuery query(model, is_joint);
  for (std::size_t i = 0; i < model.sequence.neighbours.size(); ++i) {
    for (const OccurrenceId other : model.sequence.neighbours[i]) {
      if (i < other.index() && !data->is_tool[i] && !data->is_tool[other.index()]) {
        query.Append(OccurrenceId(i), other, &data->contacts);
      }
    }
  }
  data->clamped = ListClamped(model);
  data_ = std::move(data);
}

StateStatics::~StateStatics() = default;

Result<StateStability> StateStatics::CalcStability(const std::vector<bool>& is_in_place,
                                                   const StateStaticsOptions& options) const {
  if (is_in_place.size() != data_->model.bodies.size()) {
    return Fail(ErrorCode::kInvalid, "the state has not one entry for each part");
  }
  // Rounding of what callers make may be in the length.
  if (!options.ghat_W.allFinite() || std::abs(options.ghat_W.norm() - 1) > 1e-6) {
    return Fail(ErrorCode::kInvalid, "the direction of gravity is no unit vector");
  }
  const StateProblem state = data_->MakeProblem(is_in_place, options);
  StateStability stability;
  const auto equilibrium = Solve(state, options.finds_least_holds, &stability);
  if (!equilibrium) {
    return Unexpected(equilibrium.error());
  }
  stability.stands = equilibrium->stands;
  stability.contact_count = state.problem.contacts.size();
  stability.joint_count = state.problem.joints.size();
  for (std::size_t i = 0; i < state.occurrence_of.size(); ++i) {
    if (equilibrium->moves[i]) {
      stability.moving.push_back(state.occurrence_of[i]);
    }
  }
  return stability;
}

Result<StateStability> CalcStability(const simulation::Model& model,
                                     const std::vector<bool>& is_in_place,
                                     const StateStaticsOptions& options) {
  return StateStatics(model).CalcStability(is_in_place, options);
}

double CalcStandingMargin(const simulation::Model& model, OccurrenceId part, const Vec3& ghat_W) {
  const simulation::Body& body = model.bodies[part.index()];
  return CalcMargin(model.product->part_of(part), body.mass.p_BoBcm_B,
                    body.X_WB_goal.R().transpose() * ghat_W);
}

}  // namespace hvas::orders
