#include "sequence/extraction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/mate_kind.h"
#include "mates/place_bodies.h"
#include "sequence/base_choice.h"
#include "sequence/narrow_hole.h"
#include "sequence/overlap_search.h"
#include "sequence/way_directions.h"

namespace hvas::sequence {
namespace {

using product::Mate;
using product::MateKind;
using product::OccurrenceId;

constexpr double kWayRelief = kDepthTolerance + 10e-6;  // [m]; a way is free with less
constexpr double kShortestStep = 0.25e-3;               // [m] between looks along a way
constexpr double kEndlessWay = std::numeric_limits<double>::infinity();
constexpr double kLongestStep = 2e-3;  // [m]; longer ones could pass through a thin wall.
// Looks along one way, so that the time does not grow with the size of a product: 10 m at the
// longest step, and 1.25 m at the shortest. A choice.
constexpr double kMostLooksOfWay = 5000;

}  // namespace

Unit UnitOf(const SequenceStep& step) {
  Unit unit{step.occurrence};
  unit.insert(unit.end(), step.members.begin(), step.members.end());
  return unit;
}

Extraction::Extraction(const SequenceInput& input, const Sequence* known)
    : input_(input),
      product_(*input.product),
      is_present_(product_.occurrences.size(), true),
      is_in_unit_(product_.occurrences.size(), false),
      is_aside_(product_.occurrences.size(), false),
      mates_of_(product_.occurrences.size()),
      memories_(product_.occurrences.size()),
      giving_memories_(product_.occurrences.size()),
      reliefs_(input),
      bending_memories_(product_.occurrences.size()),
      searches_(product_.occurrences.size()),
      budget_(input.queries) {
  std::map<product::PartId, std::vector<Vec3>> lines_of_part;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    const auto [entry, is_new] = lines_of_part.try_emplace(occurrence.part);
    if (is_new) {
      entry->second = ListPlaneLines(product_.part_of(occurrence.id));
    }
    plane_lines_.push_back(entry->second);
  }
  for (const Mate& mate : product_.mates) {
    if (mates::IsContradicted(product_, mate)) {
      continue;
    }
    const product::Pose& X_WA = product_.occurrences[mate.a.occurrence.index()].X_WB;
    const product::Pose& X_WB = product_.occurrences[mate.b.occurrence.index()].X_WB;
    const Vec3 axis_a = (X_WA * mate.a.X_BM).q() * Vec3::UnitZ();
    const Vec3 axis_b = (X_WB * mate.b.X_BM).q() * Vec3::UnitZ();
    const product::Part& part = product_.part_of(mate.a.occurrence);
    const double cosine = mate.kind == MateKind::kConeSeat
                              ? std::cos(part.features[mate.a.feature.index()].half_angle)
                              : 1.0;
    const Vec3 way_W = (X_WA * mate.a.X_BM).q() * Vec3::UnitX();
    mates_of_[mate.a.occurrence.index()].push_back(
        {&mate, mate.b.occurrence, axis_a, -way_W, true, cosine});
    mates_of_[mate.b.occurrence.index()].push_back(
        {&mate, mate.a.occurrence, axis_b, way_W, false, cosine});
  }
  for (const product::Occurrence& occurrence : product_.occurrences) {
    boxes_.push_back(spatial::Transform(occurrence.X_WB, product_.part_of(occurrence.id).box_B));
  }
  if (known == nullptr) {
    OverlapSearch search(
        input, [this](OccurrenceId id) { return CollectIgnored(id); }, &reliefs_);
    overlaps_ = search.Find();
  } else {
    overlaps_ = known->overlaps;
    gives_ = known->gives;
    reliefs_.Restore(known->reliefs);
  }
  for (const product::Occurrence& occurrence : product_.occurrences) {
    allowances_.push_back(ListAllowances(overlaps_, gives_, occurrence.id));
  }
}

void Extraction::SetPresent(const Unit& unit, bool is_present) {
  for (const OccurrenceId id : unit) {
    is_present_[id.index()] = is_present;
    input_.scene->SetEnabled(contact::BodyId(id.index()), is_present);
  }
}

void Extraction::SetUnit(const Unit& unit, bool is_in_unit) {
  for (const OccurrenceId id : unit) {
    is_in_unit_[id.index()] = is_in_unit;
  }
}

double Extraction::SizeOf(OccurrenceId id) const {
  return sequence::SizeOf(product_.part_of(id));
}

std::string Extraction::Describe(OccurrenceId id) const {
  return id.is_valid() ? product_.occurrences[id.index()].path : std::string("the table");
}

std::vector<Vec3> Extraction::CollectDirections(const Unit& unit) const {
  std::vector<Vec3> directions;
  std::vector<Vec3> normals;  // Of the faces that others hold.
  const auto add = [&directions](const Vec3& d) { AddDirection(d, &directions); };
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      if (!IsMated(view.other)) {
        continue;
      }
      switch (view.mate->kind) {
        case MateKind::kAxisHole:
          add(view.axis_W);
          add(-view.axis_W);
          break;
        case MateKind::kFaceFace:
          add(-view.axis_W);  // away from the partner's face
          AddDirection(view.axis_W, &normals);
          break;
        case MateKind::kConeSeat:
        case MateKind::kSphereSeat:
          add(view.is_a ? Vec3(-view.axis_W) : view.axis_W);  // z points out of the seat
          break;
        case MateKind::kPrismatic:
          for (const Vec3& way_W : {view.way_W, Vec3(view.axis_W.cross(view.way_W))}) {
            add(way_W);
            add(-way_W);
          }
          break;
      }
    }
  }
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0),
                        Vec3(0, 0, -1)}) {
    add(d);
  }
  AddEdges(normals, &directions);
  for (const OccurrenceId id : unit) {
    for (const Vec3& line_B : plane_lines_[id.index()]) {
      const Vec3 line_W = product_.occurrences[id.index()].X_WB.q() * line_B;
      add(line_W);
      add(-line_W);
    }
  }
  SortUpwardFirst(&directions);
  // What lies on a face is lifted off it rather than pushed along it: washers of a stack.
  const auto count_rubbed = [&normals](const Vec3& d) {
    return std::count_if(normals.begin(), normals.end(),
                         [&d](const Vec3& n) { return std::abs(n.dot(d)) <= kParallel; });
  };
  std::stable_sort(directions.begin(), directions.end(),
                   [&](const Vec3& a, const Vec3& b) { return count_rubbed(a) < count_rubbed(b); });
  return directions;
}

bool Extraction::IsAllowed(const MateView& view, const Vec3& direction) {
  const double along = view.axis_W.dot(direction);
  switch (view.mate->kind) {
    case MateKind::kAxisHole:
      return std::abs(along) >= 1 - kParallel;
    case MateKind::kFaceFace:
      return along <= kParallel;  // the outward normal points into the partner
    case MateKind::kConeSeat:
      // Up to the half angle from the axis; steeper ways run into the other side of the seat.
      return (view.is_a ? -along : along) >= view.cos_half_angle - kParallel;
    case MateKind::kSphereSeat:
      return true;  // how far the socket reaches around the ball is left to contact
    case MateKind::kPrismatic:
      return std::abs(along) <= kParallel;  // Where the slot ends is left to contact.
  }
  return true;
}

bool Extraction::MatesAllow(const Unit& unit, const Vec3& direction) const {
  return std::all_of(unit.begin(), unit.end(), [&](OccurrenceId id) {
    const std::vector<MateView>& views = mates_of_[id.index()];
    return std::all_of(views.begin(), views.end(), [&](const MateView& view) {
      return !IsMated(view.other) || IsAllowed(view, direction) || MayPass(view, id, direction);
    });
  });
}

double Extraction::CalcExitDistance(const Unit& unit, const Vec3& direction) const {
  spatial::Box box;
  for (const OccurrenceId id : unit) {
    box.Add(boxes_[id.index()]);
  }
  double farthest = 0;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!IsAround(OccurrenceId(i))) {
      continue;
    }
    // Distance after which the boxes are apart for good: the earliest over the three axes.
    double apart = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double d = direction[k];
      if (std::abs(d) < 1e-9) {
        const bool overlaps = boxes_[i].low[k] < box.high[k] && box.low[k] < boxes_[i].high[k];
        apart = overlaps ? apart : 0.0;
        continue;
      }
      const double gap = d > 0 ? boxes_[i].high[k] - box.low[k] : box.high[k] - boxes_[i].low[k];
      apart = std::min(apart, std::max(0.0, gap / std::abs(d)));
    }
    farthest = std::max(farthest, std::isfinite(apart) ? apart : 0.0);
  }
  return farthest;
}

double Extraction::CalcWallTravel(const MateView& view, OccurrenceId id,
                                  const Vec3& direction) const {
  const auto span = [&](const product::Connector& connector) {
    const product::Part& part = product_.part_of(connector.occurrence);
    const product::Pose& X_WB = product_.occurrences[connector.occurrence.index()].X_WB;
    std::pair<double, double> lowest_and_highest(std::numeric_limits<double>::infinity(),
                                                 -std::numeric_limits<double>::infinity());
    for (const product::FaceId face_id : part.features[connector.feature.index()].faces) {
      const product::Face& face = part.faces[face_id.index()];
      for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
        for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
          const double along = direction.dot(X_WB * part.mesh.vertices[v]);
          lowest_and_highest.first = std::min(lowest_and_highest.first, along);
          lowest_and_highest.second = std::max(lowest_and_highest.second, along);
        }
      }
    }
    return lowest_and_highest;
  };
  const Mate& mate = *view.mate;
  const bool is_own_a = mate.a.occurrence == id;
  const auto own = span(is_own_a ? mate.a : mate.b);
  const auto other = span(is_own_a ? mate.b : mate.a);
  return std::max(0.0, other.second - own.first);
}

double Extraction::CalcEngagement(const Unit& unit, const Vec3& direction) const {
  double farthest = 0;
  bool is_guided = false;
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      const Mate& mate = *view.mate;
      const bool is_wall =
          (mate.kind == MateKind::kFaceFace || mate.kind == MateKind::kPrismatic) &&
          std::abs(view.axis_W.dot(direction)) < kParallel;
      if (IsMated(view.other) && is_wall) {
        is_guided = true;
        farthest = std::max(farthest, CalcWallTravel(view, id, direction));
      }
      if (!IsMated(view.other) || mate.kind != MateKind::kAxisHole ||
          std::abs(view.axis_W.dot(direction)) <= kParallel) {
        continue;
      }
      is_guided = true;
      const bool is_shaft = !view.is_a;
      const double sense = view.axis_W.dot(direction) * (is_shaft ? 1.0 : -1.0);
      const double travel =
          sense > 0 ? mate.hole_high - mate.shaft_low : mate.shaft_high - mate.hole_low;
      farthest = std::max(farthest, travel);
    }
  }
  return is_guided ? farthest : std::min(CalcExitDistance(unit, direction), 20e-3);
}

std::vector<contact::IgnoredPair> Extraction::CollectIgnored(OccurrenceId id,
                                                             const Vec3& direction) const {
  std::vector<contact::IgnoredPair> ignored;
  for (const MateView& view : mates_of_[id.index()]) {
    if (!IsMated(view.other) || !mates::HasFit(view.mate->kind) ||
        IsAcrossOpenAxis(view, direction)) {
      continue;
    }
    const auto& own = (view.is_a ? input_.faces_a : input_.faces_b)[view.mate->id.index()];
    const auto& other = (view.is_a ? input_.faces_b : input_.faces_a)[view.mate->id.index()];
    const contact::BodyId body(view.other.index());
    ignored.push_back({body, own->mating, other->with_neighbours});
    ignored.push_back({body, own->with_neighbours, other->mating});
  }
  return ignored;
}

bool Extraction::RelieveWays(const std::vector<SequenceStep>& steps) {
  const FaceReliefs::Depths before = reliefs_.depths();
  Unit all;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    all.push_back(occurrence.id);
  }
  SetPresent(all, false);
  SetPresent(input_.fixtures, true);
  for (const SequenceStep& step : steps) {
    const Unit unit = UnitOf(step);
    const OccurrenceId id = step.occurrence;
    const bool goes_aside = step.kind == SequenceStep::Kind::kAside;
    const bool returns = step.kind == SequenceStep::Kind::kReturn;
    if (returns) {
      MoveBack(id);
    }
    if (step.way.empty() && (goes_aside || returns || step.kind == SequenceStep::Kind::kInsert)) {
      double length = kEndlessWay;
      if (IsWithinProduct(step.kind)) {
        length = step.engage_distance;
      }
      SetUnit(unit, true);
      RelieveWay(unit, goes_aside ? Vec3(-step.extraction_W) : step.extraction_W, length);
      SetUnit(unit, false);
    }
    SetPresent(unit, step.kind != SequenceStep::Kind::kPark);
    if (goes_aside) {
      MoveAside(id, GoalOf(step, product_.occurrences[id.index()].X_WB));
    }
  }
  return reliefs_.depths() != before;
}

void Extraction::RelieveWay(const Unit& unit, const Vec3& direction, double length) {
  const std::vector<Member> members = ListMembers(unit, direction);
  const double way = std::min(length, CalcExitDistance(unit, direction));
  const double step = CalcStep(unit, way);
  const int last = static_cast<int>(way / step);
  FaceReliefs::Depths deepest;
  for (int i = 0; i <= last && !input_.stop.stop_requested(); ++i) {
    for (const Member& member : members) {
      const contact::QueryOptions query = MakeQuery(member, kReliefFrom);
      const spatial::Pose X = CalcPoseAlong(member.id, i * step * direction);
      const contact::Shape& shape = input_.scene->shape(query.self);
      if (!input_.scene->IsFree(shape, X, kReliefFrom, query, &workspace_)) {
        input_.scene->Query(shape, X, query, &workspace_);
        for (const contact::Contact& contact : workspace_.contacts()) {
          if (contact.distance >= -kWayRelief) {
            reliefs_.AddContact(member.id, contact, &deepest);
          }
        }
      }
    }
  }
  (void)reliefs_.Add(deepest);
}

std::vector<contact::Allowance> Extraction::CollectAllowances(OccurrenceId id) const {
  if (giving_ == Giving::kNone) {
    return allowances_[id.index()];
  }
  // By how far the two may give, where that is more.
  std::vector<contact::Allowance> allowances;
  for (const product::Occurrence& other : product_.occurrences) {
    const double limit = CalcGiveLimit(id, other.id);
    // A clearance is meant to the surface: what a way is free with counts as a part of it.
    const double depth = giving_ == Giving::kByClearance ? limit - kDepthTolerance : limit;
    if (depth > 0 && IsAround(other.id)) {
      allowances.push_back({contact::BodyId(other.id.index()), depth, {}, {}});
    }
  }
  for (const contact::Allowance& drawn : allowances_[id.index()]) {
    const auto given = std::find_if(allowances.begin(), allowances.end(),
                                    [&](const auto& other) { return other.body == drawn.body; });
    if (given == allowances.end()) {
      allowances.push_back(drawn);
    } else if (giving_ == Giving::kByClearance && drawn.depth > given->depth) {
      *given = drawn;  // Faces that do not overlap as drawn get no more than the clearance.
    } else {
      given->depth = std::max(given->depth, drawn.depth);
    }
  }
  return allowances;
}

std::vector<Extraction::Member> Extraction::ListMembers(const Unit& unit,
                                                        const Vec3& direction) const {
  std::vector<Member> members;
  for (const OccurrenceId id : unit) {
    Member member{id, CollectIgnored(id, direction), CollectAllowances(id), {}};
    for (const OccurrenceId other : unit) {
      member.left_out.emplace_back(other.index());
    }
    members.push_back(std::move(member));
  }
  return members;
}

contact::QueryOptions Extraction::MakeQuery(const Member& member, double depth) {
  contact::QueryOptions query;
  query.margin = -depth;
  query.ignored = member.ignored;
  query.allowances = member.allowances;
  query.left_out[0] = member.left_out;
  query.self = contact::BodyId(member.id.index());
  return query;
}

spatial::Pose Extraction::CalcPoseAlong(OccurrenceId id, const Vec3& travel_W) const {
  const product::Pose& X_WB = product_.occurrences[id.index()].X_WB;
  return {X_WB.q(), X_WB.p() + travel_W};
}

double Extraction::CalcStep(const Unit& unit, double length) const {
  double step = kLongestStep;
  for (const OccurrenceId id : unit) {
    const contact::Shape& shape = input_.scene->shape(contact::BodyId(id.index()));
    step = std::min(step, std::max(kShortestStep, 0.01 * shape.box_B().size().norm()));
  }
  return std::max(step, length / kMostLooksOfWay);
}

std::optional<Obstacle> Extraction::FindBlocker(const Unit& unit, const Vec3& direction,
                                                double from,
                                                std::span<const contact::BodyId> excepted) {
  const std::vector<Member> members = ListMembers(unit, direction);
  const double exit = CalcExitDistance(unit, direction);
  const double step = CalcStep(unit, exit);
  const int last = static_cast<int>(exit / step);
  for (int i = static_cast<int>(std::lround(from / step)); i <= last; ++i) {
    const double s = i * step;
    if (input_.stop.stop_requested()) {
      return Obstacle{OccurrenceId(), s, {}};  // No way is found any more.
    }
    for (const Member& member : members) {
      contact::QueryOptions query = MakeQuery(member, kDepthTolerance);
      query.left_out[1] = excepted;
      const spatial::Pose X = CalcPoseAlong(member.id, s * direction);
      const bool is_free = input_.scene->IsFree(input_.scene->shape(query.self), X, kDepthTolerance,
                                                query, &workspace_);
      CountQuery();
      if (!is_free) {
        const auto contacts = workspace_.contacts();
        return Obstacle{
            contacts.empty() ? OccurrenceId() : OccurrenceId(contacts[0].body.index()), s, {}};
      }
    }
  }
  return std::nullopt;
}

SequenceStep Extraction::MakeStep(const Unit& unit, const Vec3& direction) const {
  SequenceStep step;
  step.occurrence = unit.front();
  step.members.assign(unit.begin() + 1, unit.end());
  step.extraction_W = direction;
  step.engage_distance = CalcEngagement(unit, direction);
  return step;
}

std::optional<SequenceStep> Extraction::TryRemove(const Unit& unit, Memory* memory) {
  SetUnit(unit, true);
  std::ptrdiff_t mates_around = 0;
  for (const OccurrenceId id : unit) {
    mates_around += std::count_if(mates_of_[id.index()].begin(), mates_of_[id.index()].end(),
                                  [this](const MateView& view) { return IsMated(view.other); });
  }
  const auto still_blocked = [this](const Attempt& attempt) {
    return attempt.blocker && attempt.blocker->occurrence.is_valid() &&
           IsAround(attempt.blocker->occurrence);
  };
  std::optional<SequenceStep> step;
  const bool is_unchanged =
      !memory->attempts.empty() && mates_around == memory->mates_around &&
      std::all_of(memory->attempts.begin(), memory->attempts.end(), still_blocked);
  if (!is_unchanged) {
    std::vector<Attempt> tried;
    for (const Vec3& direction : CollectDirections(unit)) {
      if (!MatesAllow(unit, direction)) {
        continue;
      }
      const auto known = std::find_if(
          memory->attempts.begin(), memory->attempts.end(),
          [&](const Attempt& a) { return a.direction == direction && still_blocked(a); });
      if (known != memory->attempts.end()) {
        tried.push_back(*known);
        continue;
      }
      std::optional<Obstacle> blocker = FindBlocker(unit, direction, 0, {});
      if (!blocker && giving_ != Giving::kNone) {
        blocker = FindTooWide(unit.front(), direction);
      }
      if (!blocker) {
        step = MakeStep(unit, direction);
        break;
      }
      tried.push_back({direction, blocker});
    }
    if (tried.empty()) {
      tried.push_back({Vec3::Zero(), std::nullopt});
    }
    *memory = {std::move(tried), mates_around};
  }
  SetUnit(unit, false);
  if (step) {
    SetPresent(unit, false);
  }
  return step;
}

std::string Extraction::ExplainStuck(OccurrenceId id) const {
  const Attempt* farthest = nullptr;
  for (const Attempt& attempt : memories_[id.index()].attempts) {
    if (attempt.blocker &&
        (farthest == nullptr || attempt.blocker->travelled > farthest->blocker->travelled)) {
      farthest = &attempt;
    }
  }
  if (farthest != nullptr) {
    return "no free path: " + ExplainObstacle(id, *farthest->blocker, farthest->direction);
  }
  std::set<OccurrenceId> partners;
  for (const MateView& view : mates_of_[id.index()]) {
    if (is_present_[view.other.index()]) {
      partners.insert(view.other);
    }
  }
  std::string names;
  for (const OccurrenceId partner : partners) {
    names += (names.empty() ? "" : " and ") + Describe(partner);
  }
  return fmt::format("its mates with {} leave no straight way out", names);
}

std::string Extraction::ExplainObstacle(OccurrenceId id, const Obstacle& obstacle,
                                        const Vec3& direction) const {
  std::string why = ExplainTooWide(product_, id, obstacle.occurrence, direction, kDepthTolerance);
  why = why.empty() ? ExplainOverlap(id, obstacle.occurrence) : why;
  return fmt::format("meets {} after {:.1f} mm along its best way out{}{}",
                     Describe(obstacle.occurrence), units::ToMm(obstacle.travelled),
                     why.empty() ? "" : ", as drawn: ", why);
}

std::string Extraction::ExplainOverlap(OccurrenceId id, OccurrenceId other) const {
  const auto overlap = std::find_if(overlaps_.begin(), overlaps_.end(),
                                    [&](const DrawnOverlap& o) { return o.Joins(id, other); });
  if (overlap == overlaps_.end()) {
    return {};
  }
  return overlap->answer == DrawnOverlap::Answer::kNone
             ? fmt::format("it runs {:.3f} mm deep through its material, with no opening for it",
                           units::ToMm(overlap->depth))
             : fmt::format("the two overlap by {:.3f} mm, and the way would need more",
                           units::ToMm(overlap->depth));
}

std::vector<Vec3> Extraction::ListDirections(const Unit& unit) {
  SetUnit(unit, true);
  std::vector<Vec3> directions = CollectDirections(unit);
  SetUnit(unit, false);
  return directions;
}

std::vector<Vec3> Extraction::CollectContactNormals(OccurrenceId id) {
  constexpr double kNear = 0.1e-3;    // [m]; faces closer than this as drawn touch
  constexpr double kSame = 1 - 1e-4;  // cosine of the angle between normals that are one
  constexpr std::size_t kMost =
      16;  // normals; those of a ball in its socket are as many as one likes
  const std::vector<contact::IgnoredPair> ignored = CollectIgnored(id);
  contact::QueryOptions query;
  query.margin = kNear;
  query.ignored = ignored;
  query.allowances = allowances_[id.index()];
  query.self = contact::BodyId(id.index());
  input_.scene->Query(input_.scene->shape(query.self), product_.occurrences[id.index()].X_WB, query,
                      &workspace_);
  std::vector<Vec3> normals;
  for (const contact::Contact& contact : workspace_.contacts()) {
    const bool is_known = std::any_of(normals.begin(), normals.end(), [&](const Vec3& known) {
      return known.dot(contact.nhat_W) > kSame;
    });
    if (!is_known && normals.size() < kMost) {
      normals.push_back(contact.nhat_W);
    }
  }
  return normals;
}

std::vector<Vec3> Extraction::ListContactDirections(OccurrenceId id) {
  SetUnit({id}, true);
  const std::vector<Vec3> normals = CollectContactNormals(id);
  SetUnit({id}, false);
  return ListFreeDirections(normals);
}

std::vector<Obstacle> Extraction::ListObstacles(const Unit& unit, const Vec3& direction,
                                                OccurrenceId fixed) {
  std::vector<Obstacle> obstacles;
  std::vector<contact::BodyId> known;
  const auto add = [&](const Obstacle& obstacle) {
    const contact::BodyId body(obstacle.occurrence.index());
    if (std::find(known.begin(), known.end(), body) == known.end()) {
      known.push_back(body);
      obstacles.push_back(obstacle);
    }
    return fixed.is_valid() && obstacle.occurrence == fixed;
  };
  SetUnit(unit, true);
  bool is_blocked = false;
  for (const OccurrenceId id : unit) {
    for (const MateView& view : mates_of_[id.index()]) {
      if (!is_blocked && IsMated(view.other) && !IsAllowed(view, direction)) {
        is_blocked = add({view.other, 0, view.mate->id});
      }
    }
  }
  double from = 0;
  while (!is_blocked) {
    const std::optional<Obstacle> blocker = FindBlocker(unit, direction, from, known);
    if (!blocker) {
      break;
    }
    from = blocker->travelled;
    is_blocked = add(*blocker) || !blocker->occurrence.is_valid();
  }
  SetUnit(unit, false);
  return obstacles;
}

double Extraction::CalcWayLength(const Unit& unit, const Vec3& direction) {
  SetUnit(unit, true);
  const double length = CalcExitDistance(unit, direction);
  SetUnit(unit, false);
  return length;
}

double Extraction::CalcEngageDistance(const Unit& unit, const Vec3& direction) {
  SetUnit(unit, true);
  const double distance = CalcEngagement(unit, direction);
  SetUnit(unit, false);
  return distance;
}

std::optional<SequenceStep> Extraction::TryRemove(const Unit& unit) {
  return TryRemove(unit, &unit_memories_[unit]);
}

std::optional<SequenceStep> Extraction::TryRemoveAlong(const Unit& unit, const Vec3& direction) {
  SetUnit(unit, true);
  std::optional<SequenceStep> step;
  if (MatesAllow(unit, direction) && !FindBlocker(unit, direction, 0, {})) {
    step = MakeStep(unit, direction);
  }
  SetUnit(unit, false);
  if (step) {
    SetPresent(unit, false);
  }
  return step;
}

std::optional<SequenceStep> Extraction::TryRemoveOne(Unit* rest, const Unit& staying) {
  for (std::size_t i = 0; i + 1 < rest->size(); ++i) {
    const OccurrenceId id = (*rest)[i];
    if (std::binary_search(staying.begin(), staying.end(), id)) {
      continue;
    }
    if (auto step = TryRemove({id}, &memories_[id.index()])) {
      rest->erase(rest->begin() + static_cast<std::ptrdiff_t>(i));
      return step;
    }
  }
  return std::nullopt;
}

bool Extraction::IsAcrossOpenAxis(const MateView& view, const Vec3& direction) const {
  // A clip has to hold on to its shaft, and to open: choices.
  constexpr double kLeastCoverage = 90 * std::numbers::pi / 180;
  constexpr double kMostCoverage = 330 * std::numbers::pi / 180;
  const product::Connector& hole = view.mate->a;
  if (view.mate->kind != MateKind::kAxisHole || direction == Vec3::Zero() ||
      std::abs(view.axis_W.dot(direction)) > kParallel) {
    return false;
  }
  const double coverage = product_.part_of(hole.occurrence).features[hole.feature.index()].coverage;
  return coverage >= kLeastCoverage && coverage <= kMostCoverage;
}

bool Extraction::AllowBeyondDrawn(const Unit& parts) {
  const auto is_among = [&parts](OccurrenceId id) {
    return std::find(parts.begin(), parts.end(), id) != parts.end();
  };
  const auto is_blocked_by = [this](OccurrenceId id, OccurrenceId other) {
    const std::vector<Attempt>& attempts = memories_[id.index()].attempts;
    return std::any_of(attempts.begin(), attempts.end(), [other](const Attempt& attempt) {
      return attempt.blocker && attempt.blocker->occurrence == other;
    });
  };
  std::set<OccurrenceId> changed;
  for (DrawnOverlap& overlap : overlaps_) {
    const bool may_pass = !overlap.is_beyond && overlap.answer != DrawnOverlap::Answer::kNone;
    if (may_pass && is_among(overlap.a) && is_among(overlap.b) &&
        (is_blocked_by(overlap.a, overlap.b) || is_blocked_by(overlap.b, overlap.a))) {
      overlap.is_beyond = true;
      overlap.answer = DrawnOverlap::Answer::kAllowance;
      overlap.allowed =
          std::min(std::max(overlap.allowed, overlap.depth) + kBeyondDrawn, overlap.largest);
      overlap.passing_a.clear();
      overlap.passing_b.clear();
      changed.insert({overlap.a, overlap.b});
    }
  }
  for (const OccurrenceId id : changed) {
    allowances_[id.index()] = ListAllowances(overlaps_, gives_, id);
  }
  if (!changed.empty()) {
    Forget(parts);
  }
  return !changed.empty();
}

void Extraction::Forget(const Unit& parts) {
  for (const OccurrenceId id : parts) {
    memories_[id.index()] = {};
    giving_memories_[id.index()] = {};
    bending_memories_[id.index()] = {};
  }
  unit_memories_.clear();
}

}  // namespace hvas::sequence
