#include "sequence/thread_way.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "haptics/mate_guide.h"
#include "sequence/turning_way.h"

namespace hvas::sequence {
namespace {

constexpr double kTurnStep =
    units::kTurn / 24;  // Between poses: the chord is good to 1 %. A choice.

/** The thread that is engaged deepest in the part's place; null where there is none. */
const haptics::HeldMate* FindThread(const haptics::HeldPart& held) {
  const haptics::HeldMate* deepest = nullptr;
  double most = 0;
  for (const haptics::HeldMate& mate : held.mates) {
    const double depth = mate.thread ? haptics::CalcMateGeometry(mate, held.X_WB_goal).engaged : 0;
    if (depth > most) {
      most = depth;
      deepest = &mate;
    }
  }
  return deepest;
}

/** Distance along the way out after which nothing of the thread is engaged any more [m]. */
double CalcTravelOut(const haptics::HeldMate& mate, const haptics::HeldPart& held) {
  const Vec3 axis_W = mate.X_WM.q() * Vec3::UnitZ();
  const double along = (held.X_WB_goal * mate.X_BN.p() - mate.X_WM.p()).dot(axis_W);
  const bool is_upwards = axis_W.dot(held.insertion_W) <= 0;
  return is_upwards ? mate.capture.placed_high - (along + mate.capture.held_low)
                    : along + mate.capture.held_high - mate.capture.placed_low;
}

}  // namespace

paths::Path MakeThreadWay(const haptics::HeldPart& held, double engage_distance) {
  const haptics::HeldMate* mate = FindThread(held);
  if (mate == nullptr) {
    return {};
  }
  const haptics::HeldThread& thread = *mate->thread;
  const double rise = thread.rise();
  const double travel = CalcTravelOut(*mate, held);
  const double head = thread.head_angle();
  const Vec3 out_W = -held.insertion_W;
  const Vec3& p_WQ = mate->X_WM.p();
  const double last = head + travel / rise;
  paths::Path way;
  const int count = static_cast<int>(std::ceil(last / kTurnStep));
  for (int i = 0; i <= count; ++i) {
    const double angle = last * i / count;
    const Quat turn = spatial::RotationFromVector(std::copysign(angle, thread.lead) * out_W);
    const Vec3 p =
        p_WQ + turn * (held.X_WB_goal.p() - p_WQ) + rise * std::max(0.0, angle - head) * out_W;
    way.emplace_back(turn * held.X_WB_goal.q(), p);
  }
  const double straight = std::max(0.0, engage_distance - travel) + kLastPiece;
  way.emplace_back(way.back().q(), way.back().p() + straight * out_W);
  return way;
}

}  // namespace hvas::sequence
