#include "orders/tool_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/units.h"

namespace hvas::orders {
namespace {

constexpr double kFullTurn = units::kTurn;        // [rad]: a circle.
constexpr double kMargin = 3e-3;                  // [m] within which distances are known: a choice.
constexpr double kAngleError = 1e-4;              // [rad] of the ends of an arc: a choice.
constexpr double kPutOnStep = units::FromDeg(5);  // Between angles at which it is put on: a choice.

/** Distance of the nearest body from the tool at a pose, and which body it is. */
struct Nearest {
  double distance{std::numeric_limits<double>::infinity()};  // [m]
  contact::BodyId body;
};

class Sweeper {
 public:
  Sweeper(const ReachQuery& query, const simulation::ToolMate& mate, const spatial::Pose& X_WF)
      : query_(query), mate_(mate), X_WF_(X_WF) {
    options_.margin = kMargin;
    options_.self = query.fastener;
    options_.left_out[0] = query.left_out;
    constexpr std::uint32_t kBudget = 30'000;  // Points: as many as a query has room for, nearly.
    options_.point_budget = kBudget;
    const spatial::Pose X_WT = CalcToolPose(mate, X_WF, 0, 0);
    const Vec3 axis = X_WF.q() * mate.fastener.axis_B;
    const Vec3 origin = X_WF * mate.fastener.origin_B;
    for (const Vec3& vertex : query.tool_part->mesh.vertices) {
      lever_ = std::max(lever_, axis.cross(X_WT * vertex - origin).norm());
    }
  }

  [[nodiscard]] double lever() const { return lever_; }

  [[nodiscard]] bool is_truncated() const { return is_truncated_; }

  [[nodiscard]] Nearest Find(double angle, double lift) {
    query_.scene->Query(*query_.tool, CalcToolPose(mate_, X_WF_, angle, lift), options_,
                        &workspace_);
    is_truncated_ = is_truncated_ || workspace_.stats().is_truncated;
    Nearest nearest;
    for (const contact::Contact& contact : workspace_.contacts()) {
      if (contact.distance < nearest.distance) {
        nearest = {contact.distance, contact.body};
      }
    }
    nearest.distance = std::min({nearest.distance, workspace_.deepest(), kMargin});
    return nearest;
  }

  [[nodiscard]] bool IsFree(const Nearest& nearest) const {
    return nearest.distance > -query_.tolerance;
  }

  /** Angle or length that is surely free from a distance on, and at least the shortest step. */
  [[nodiscard]] double CalcStep(const Nearest& nearest) const {
    return std::max(nearest.distance, query_.shortest_step);
  }

  /** The body that is met in putting the tool on at an angle; invalid: none. */
  [[nodiscard]] contact::BodyId FindAlongAxis(double angle) {
    constexpr double kBeyond = 1e-3;  // [m] that it is drawn out further: a choice.
    const double length = mate_.engaged + kBeyond;
    for (double lift = 0; lift < length;) {
      const Nearest nearest = Find(angle, lift);
      if (!IsFree(nearest)) {
        return nearest.body;
      }
      lift += CalcStep(nearest);
    }
    return {};
  }

  /** Finds the arcs of the whole turn. */
  [[nodiscard]] std::vector<FreeArc> ListArcs();

 private:
  [[nodiscard]] double Bisect(double free, double blocked, contact::BodyId* body);

  const ReachQuery& query_;
  const simulation::ToolMate& mate_;
  const spatial::Pose& X_WF_;
  contact::QueryOptions options_;
  contact::QueryWorkspace workspace_;
  double lever_{1e-6};
  bool is_truncated_{false};
};

double Sweeper::Bisect(double free, double blocked, contact::BodyId* body) {
  while (std::abs(blocked - free) > kAngleError) {
    const double middle = 0.5 * (free + blocked);
    const Nearest nearest = Find(middle, 0);
    if (IsFree(nearest)) {
      free = middle;
    } else {
      blocked = middle;
      *body = nearest.body.is_valid() ? nearest.body : *body;
    }
  }
  return free;
}

std::vector<FreeArc> Sweeper::ListArcs() {
  // From an angle at which something is in the way, if there is one, so that no arc is cut in two.
  std::vector<FreeArc> arcs;
  double start = 0;
  contact::BodyId body;
  for (bool is_found = false; !is_found;) {
    const Nearest nearest = Find(start, 0);
    is_found = !IsFree(nearest);
    if (is_found) {
      body = nearest.body;
    } else {
      start += CalcStep(nearest) / lever_;
      if (start >= kFullTurn) {
        FreeArc whole;
        whole.to = kFullTurn;
        whole.is_full = true;
        return {whole};
      }
    }
  }
  bool is_free = false;
  double last = start;
  FreeArc arc;
  for (double angle = start; angle < start + kFullTurn;) {
    const Nearest nearest = Find(angle, 0);
    if (IsFree(nearest) && !is_free) {
      arc = {};
      arc.at_from = body;
      arc.from = angle == last ? angle : Bisect(angle, last, &arc.at_from);
    } else if (!IsFree(nearest) && is_free) {
      arc.at_to = nearest.body;
      arc.to = Bisect(last, angle, &arc.at_to);
      arcs.push_back(arc);
    }
    is_free = IsFree(nearest);
    body = is_free ? body : nearest.body;
    last = angle;
    angle += CalcStep(nearest) / lever_;
  }
  if (is_free) {
    arc.at_to = Find(start, 0).body;
    arc.to = Bisect(last, start + kFullTurn, &arc.at_to);
    arcs.push_back(arc);
  }
  return arcs;
}

/** Says of an arc whether the tool can be put on in it, and go on by being put on again. */
void TryPutOn(Sweeper* sweeper, const simulation::ToolMate& mate, FreeArc* arc,
              contact::BodyId* obstacle) {
  const auto is_free_at = [&](double angle) {
    const contact::BodyId body = sweeper->FindAlongAxis(angle);
    if (body.is_valid() && !obstacle->is_valid()) {
      *obstacle = body;
    }
    return !body.is_valid();
  };
  const double last = arc->is_full ? arc->to - kPutOnStep : arc->to;
  for (double angle = arc->from; angle <= last && !arc->can_go_on; angle += kPutOnStep) {
    if (!is_free_at(angle)) {
      continue;
    }
    arc->can_put_on = true;
    arc->can_go_on =
        arc->is_full || (angle + mate.pitch <= arc->to && is_free_at(angle + mate.pitch));
    if (!arc->is_full && angle + mate.pitch > arc->to) {
      break;
    }
  }
}

}  // namespace

spatial::Pose CalcToolPose(const simulation::ToolMate& mate, const spatial::Pose& X_WF,
                           double angle, double lift) {
  // Both frames have z out of the fastener, towards the user, and x along a flat's normal.
  const auto make_frame = [](const Vec3& z, const Vec3& x, const Vec3& p) {
    Mat3 R;
    R << x, z.cross(x), z;
    return spatial::Pose(Quat(R), p);
  };
  const DriveForm& f = mate.fastener;
  const DriveForm& t = mate.tool;
  const spatial::Pose X_FM = make_frame(-f.axis_B, f.flat_B, f.origin_B);
  const spatial::Pose X_TN = make_frame(t.axis_B, -t.flat_B, t.origin_B);
  const spatial::Pose X_MN(Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())),
                           Vec3(0, 0, lift - mate.engaged));
  return X_WF * X_FM * X_MN * X_TN.Inverse();
}

const FreeArc* ToolReach::FindBest() const {
  const FreeArc* best = nullptr;
  for (const FreeArc& arc : arcs) {
    const bool is_better = best == nullptr || (arc.can_go_on && !best->can_go_on) ||
                           (arc.can_go_on == best->can_go_on && arc.angle() > best->angle());
    if (arc.can_put_on && is_better) {
      best = &arc;
    }
  }
  return best;
}

ToolReach CalcToolReach(const ReachQuery& query, const simulation::ToolMate& mate,
                        const spatial::Pose& X_WF) {
  Sweeper sweeper(query, mate, X_WF);
  ToolReach reach;
  reach.lever = sweeper.lever();
  reach.arcs = sweeper.ListArcs();
  if (reach.arcs.empty()) {
    reach.obstacle = sweeper.Find(0, 0).body;
  }
  for (FreeArc& arc : reach.arcs) {
    TryPutOn(&sweeper, mate, &arc, &reach.obstacle_along_axis);
  }
  reach.is_truncated = sweeper.is_truncated();
  return reach;
}

}  // namespace hvas::orders
