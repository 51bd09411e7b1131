#include "orders/order_effort.h"

#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "dynamics/world.h"
#include "mates/thread_joints.h"

namespace hvas::orders {
namespace {

using product::OccurrenceId;

// The thickness of a hand that holds a part: what is nearer to the way is in its way [m]. A choice.
constexpr double kHandThickness = 30e-3;
// A part that is pushed so far before it meets something is not backed by it [m]. A choice.
constexpr double kBackingGap = 1e-3;
constexpr double kAlongFit = 0.985;  // Cosine: 10 degrees between the axis of a fit and a way.

/** The box of a part along and across a way: F is W turned so that z is the way out. */
class WayFrame {
 public:
  explicit WayFrame(const Vec3& extraction_W) {
    Mat3 R_WF;
    R_WF.col(2) = extraction_W;
    R_WF.col(0) = extraction_W.unitOrthogonal();
    R_WF.col(1) = extraction_W.cross(R_WF.col(0));
    X_FW_ = spatial::Pose(Quat(R_WF).conjugate(), Vec3::Zero());
  }

  [[nodiscard]] spatial::Box BoxOf(const simulation::Model& model, OccurrenceId id) const {
    const product::Product& product = *model.product;
    return spatial::Transform(X_FW_ * product.occurrences[id.index()].X_WB,
                              product.part_of(id).box_B);
  }

 private:
  spatial::Pose X_FW_;
};

/** How far two boxes are apart across the way, which is z [m]. */
double CalcGapAcross(const spatial::Box& a, const spatial::Box& b) {
  const Vec3 gap = (b.low - a.high).cwiseMax(a.low - b.high).cwiseMax(0.0);
  return std::hypot(gap.x(), gap.y());
}

/** The axis of a fit: of its hole, or along its slot. */
Vec3 AxisOf(const product::Product& product, const product::Mate& mate) {
  const Quat q = (product.occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM).q();
  return q * (mate.kind == product::MateKind::kPrismatic ? Vec3::UnitX() : Vec3::UnitZ());
}

/** The gravity that loose parts have [m/s^2]. */
double Gravity() {
  return dynamics::WorldOptions().gravity;
}

bool IsIn(const sequence::Unit& unit, OccurrenceId id) {
  return std::find(unit.begin(), unit.end(), id) != unit.end();
}

OccurrenceId OtherOf(const product::Mate& mate, OccurrenceId id) {
  return mate.a.occurrence == id ? mate.b.occurrence : mate.a.occurrence;
}

}  // namespace

double CalcHandForce(double press, double weight, double rise) {
  const double along = std::max(0.0, press - weight * rise);
  const double across = weight * std::sqrt(std::max(0.0, 1 - rise * rise));
  return std::hypot(along, across);
}

EffortFinder::EffortFinder(const simulation::Model& model, sequence::Extraction* extraction,
                           std::map<OccurrenceId, std::size_t> move_of)
    : model_(model),
      extraction_(extraction),
      move_of_(std::move(move_of)),
      turns_(model.product->mates.size()) {
  for (const mates::ThreadJoint& joint : mates::FindThreadJoints(*model.product)) {
    turns_[joint.mate.index()] = joint.turns;
  }
}

WayEffort EffortFinder::Find(const std::vector<sequence::Unit>& units, std::size_t move,
                             const Vec3& extraction_W) {
  WayEffort effort;
  FindReach(move, units[move], extraction_W, &effort);
  FindPresses(units, move, extraction_W, &effort);
  return effort;
}

std::optional<std::size_t> EffortFinder::FindMove(OccurrenceId id) const {
  const auto found = move_of_.find(id);
  return found == move_of_.end() ? std::nullopt : std::optional(found->second);
}

void EffortFinder::FindReach(std::size_t move, const sequence::Unit& parts,
                             const Vec3& extraction_W, WayEffort* effort) const {
  const WayFrame frame(extraction_W);
  spatial::Box held;
  for (const OccurrenceId part : parts) {
    held.Add(frame.BoxOf(model_, part));
  }
  std::map<std::size_t, double> reaches;
  for (const product::Occurrence& other : model_.product->occurrences) {
    const auto other_move = FindMove(other.id);
    if (other_move == move || !extraction_->is_present(other.id)) {
      continue;
    }
    const spatial::Box box = frame.BoxOf(model_, other.id);
    if (CalcGapAcross(held, box) < kHandThickness) {
      double& reach = other_move ? reaches[*other_move] : effort->least_reach;
      reach = std::max(reach, box.high.z() - held.high.z());
    }
  }
  for (const auto& [other, reach] : reaches) {
    if (reach > effort->least_reach) {
      effort->reaches.push_back({other, reach});
    }
  }
  std::stable_sort(effort->reaches.begin(), effort->reaches.end(),
                   [](const ReachBeside& a, const ReachBeside& b) { return a.reach > b.reach; });
}

void EffortFinder::FindPresses(const std::vector<sequence::Unit>& units, std::size_t move,
                               const Vec3& extraction_W, WayEffort* effort) {
  const sequence::Unit& parts = units[move];
  for (const OccurrenceId part : parts) {
    for (const product::MateId id : model_.mates_of[part.index()]) {
      const product::Mate& mate = model_.product->mates[id.index()];
      const fits::FitForce* fit = model_.mates[id.index()].fit.get();
      const OccurrenceId other = OtherOf(mate, part);
      const bool is_pressed = fit != nullptr && fit->max_resistance() > 0 && !IsIn(parts, other) &&
                              extraction_->is_present(other) &&
                              std::abs(AxisOf(*model_.product, mate).dot(extraction_W)) > kAlongFit;
      if (!is_pressed) {
        continue;
      }
      Press press;
      press.onto = FindMove(other);
      press.force = fit->max_resistance();
      if (press.onto) {
        FindBacking(units[*press.onto], move, -extraction_W, &press);
      }
      effort->presses.push_back(std::move(press));
    }
  }
}

void EffortFinder::FindBacking(const sequence::Unit& pushed, std::size_t pushing,
                               const Vec3& push_W, Press* press) {
  press->is_backed = false;
  for (const sequence::Obstacle& obstacle :
       extraction_->ListObstacles(pushed, push_W, OccurrenceId())) {
    if (!obstacle.occurrence.is_valid() || obstacle.travelled > kBackingGap) {
      continue;
    }
    const auto move = FindMove(obstacle.occurrence);
    if (!move) {
      press->is_backed = true;
    } else if (*move != pushing) {
      press->backing.push_back(*move);
    }
  }
  std::sort(press->backing.begin(), press->backing.end());
  press->backing.erase(std::unique(press->backing.begin(), press->backing.end()),
                       press->backing.end());
}

double EffortFinder::CalcWeight(const sequence::Unit& parts) const {
  return std::accumulate(parts.begin(), parts.end(), 0.0, [this](double sum, OccurrenceId part) {
    return sum + Gravity() * model_.bodies[part.index()].mass.mass;
  });
}

std::vector<HandMotion> EffortFinder::ListMotions(const sequence::Unit& parts,
                                                  bool has_tool) const {
  const simulation::Body& lead = model_.bodies[parts.front().index()];
  const Vec3& p_BoBcm_B = lead.mass.p_BoBcm_B;
  const double distance = (lead.X_WB_goal * p_BoBcm_B - lead.X_WB_start * p_BoBcm_B).norm();
  PutCare care = PutCare::kNone;
  double turns = 0;
  spatial::Box box;
  for (const OccurrenceId part : parts) {
    const product::Occurrence& occurrence = model_.product->occurrences[part.index()];
    box.Add(spatial::Transform(occurrence.X_WB, model_.product->part_of(part).box_B));
    for (const product::MateId id : model_.mates_of[part.index()]) {
      const product::Mate& mate = model_.product->mates[id.index()];
      if (IsIn(parts, OtherOf(mate, part))) {
        continue;
      }
      const bool is_exact = mate.fit && product::IsIsoFit(mate.fit->kind);
      care = std::max(care, is_exact ? PutCare::kExact : PutCare::kSome);
      turns = std::max(turns, turns_[id.index()]);
    }
  }
  // The hand goes to the part as far as it then goes with it.
  const int move = CalcMoveMods(distance);
  const int get = CalcGetMods(box.size());
  const int put = CalcPutMods(care);
  const double mass = CalcWeight(parts) / Gravity();
  std::vector<HandMotion> motions{
      {MotionPurpose::kGoTo, fmt::format("M{}", move), move, distance},
      {MotionPurpose::kGet, get > 1 ? "E2 G3" : "G1", get, box.size().maxCoeff()},
      {MotionPurpose::kBring, fmt::format("M{}", move), move, distance},
      {MotionPurpose::kPut, put > 0 ? fmt::format("E2 P{}", put - 2) : "P0", put, 0}};
  if (const int load = CalcLoadMods(mass); load > 0) {
    motions.push_back({MotionPurpose::kLoad, fmt::format("L{}", load), load, mass});
  }
  if (has_tool) {
    motions.push_back({MotionPurpose::kToolOn, "M3 E2 P2", kToolOnMods, 0});
  }
  if (const int whole_turns = static_cast<int>(std::ceil(turns)); whole_turns > 0) {
    motions.push_back({MotionPurpose::kCrank, fmt::format("{} C{}", whole_turns, kCrankMods),
                       kCrankMods * whole_turns, turns});
  }
  return motions;
}

}  // namespace hvas::orders
