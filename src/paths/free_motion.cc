#include "paths/free_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "paths/check_way.h"
#include "paths/near_points.h"
#include "paths/shorten_way.h"
#include "paths/slide_step.h"
#include "spatial/decompose.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

// Of the part's size: how near others are looked for at the start, until enough are found. Choices.
constexpr double kLeastNear = 0.002;
constexpr double kMostNear = 0.04;
constexpr double kNearer = 1.6;      // Factor from one look to the next: a choice.
constexpr int kLeastContacts = 14;   // Twice as many as fix a part, and some: a choice.
constexpr int kReweightings = 12;    // The estimate of a screw with a head has settled by then.
constexpr double kLeastRate = 0.02;  // Rates below this are one in the weights: noise of facets.
constexpr double kMostRate = 0.12;   // Median rate of a motion that is free: seven degrees.
constexpr double kLargestMotionStep = 1.0 / 40;  // Of the part's size.
constexpr double kLeastMotionStep = 1.0 / 2000;  // Of the part's size.
constexpr double kLongerMotion = 1.5;            // Factor of steps that went well: a choice.
constexpr int kHalvingsToMiddle = 3;             // Of a correction that does not help: a choice.
constexpr int kMostCorrections = 4;              // Of a step: a choice.
// Of what is near: points so much farther than the nearest are taken farther away with it. A
// choice: all that is near would pull a thin nut askew, as it has more flank on one side.
constexpr double kFartherThanLeast = 0.25;
constexpr double kSettled = 0.03;  // Of what is near: a correction below this is the last one.
constexpr double kShareOfTolerance = 0.6;  // Poses no deeper than that are left where they are.
constexpr double kShareOfEstimate = 0.5;   // Of a new estimate of the motion in the next: a choice.
constexpr double kLeastMotionAhead = 0.3;  // Of a step; less is no way ahead.
constexpr double kSecant = 0.15;  // Of the part's size: the way by which the motion is improved.
constexpr std::size_t kLooksAlong = 16;  // Places of the way at which faces are noted: a choice.
constexpr double kExitsApart =
    0.1;  // Of the part's size: places from which straight exits are tried.

// Of a way that was found, whatever its search took: fifty turns take fewer.
constexpr std::uint64_t kMostQueriesOfMending = 200'000;

/** By how much a body moves about its centre, at a velocity whose v_W is that at W's origin. */
Displacement MoveAlong(const spatial::Twist& V_W, const Vec3& centre_W, double length) {
  return {Vec3(length * V_W.w), Vec3(length * (V_W.v + V_W.w.cross(centre_W)))};
}

/** The velocity that takes a body from one pose to another in a unit of time, likewise. */
spatial::Twist FindTwist(const Pose& from, const Pose& to) {
  const Screw screw = FindScrew(to * from.Inverse());
  return {screw.turn, Vec3(screw.along + screw.p_AQ.cross(screw.turn))};
}

class FreeMotion {
 public:
  FreeMotion(Probe* probe, std::uint64_t budget)
      : probe_(*probe), near_points_(*probe), last_query_(probe->queries() + budget) {}

  std::optional<Way> Run() {
    const Pose& start = probe_.problem().X_WB_start;
    if (!FindNear(start)) {
      return std::nullopt;
    }
    const std::optional<Vec6> motion = EstimateMotion(start);
    if (!motion) {
      return std::nullopt;
    }
    for (const double sign : {1.0, -1.0}) {
      if (auto path = Follow(start, ToTwist(start, sign * *motion))) {
        Way way;
        way.method = WayMethod::kFreeMotion;
        way.screw = DescribeScrew(*path);
        way.path = std::move(*path);
        return way;
      }
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] bool IsOver() const { return probe_.is_over() || probe_.queries() >= last_query_; }

  [[nodiscard]] Vec3 CentreOf(const Pose& X_WB) const { return X_WB * probe_.centre_B(); }

  // The twist has a length of one in the metric of the search, at the pose.
  [[nodiscard]] spatial::Twist ToTwist(const Pose& X_WB, const Vec6& motion) const {
    const Vec3 w = motion.tail<3>() / probe_.gyration();
    return {w, Vec3(motion.head<3>() - w.cross(CentreOf(X_WB)))};
  }

  [[nodiscard]] Vec6 RowOf(const NearPoint& c, const Vec3& centre_W) const {
    return probe_.RowOf(c.nhat_W, c.p_W, centre_W);
  }

  [[nodiscard]] Vec6 ToMotion(const Displacement& d) const {
    Vec6 motion;
    motion << d.v_W, probe_.gyration() * d.w_W;
    return motion;
  }

  // Looks further until the part has enough around it.
  bool FindNear(const Pose& X_WB) {
    near_ = std::max(kLeastNear * probe_.size(), 2 * std::abs(probe_.tolerance()));
    while (near_ < kMostNear * probe_.size() && !IsOver()) {
      near_points_.Find(X_WB, near_);
      const bool is_enough =
          near_points_.list().size() >= kLeastContacts && EstimateMotion(X_WB).has_value();
      near_ *= kNearer;  // Where it is enough, too: the part moves to and fro in its play.
      if (is_enough) {
        near_points_.Find(X_WB, near_);
        return true;
      }
    }
    return false;
  }

  // The motion along which what is near by the last query comes nearer the least.
  [[nodiscard]] std::optional<Vec6> EstimateMotion(const Pose& X_WB) {
    const Vec3 centre_W = CentreOf(X_WB);
    rows_.clear();
    for (const NearPoint& c : near_points_.list()) {
      rows_.push_back(RowOf(c, centre_W).normalized());
    }
    if (rows_.size() < kLeastContacts) {
      return std::nullopt;
    }
    std::vector<double> weights(rows_.size(), 1.0);
    Vec6 motion = Vec6::Zero();
    for (int i = 0; i < kReweightings; ++i) {
      Mat6 normal = Mat6::Zero();
      double sum = 0;
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        normal += weights[k] * rows_[k] * rows_[k].transpose();
        sum += weights[k];
      }
      motion = spatial::CalcLeastEigenvector(Mat6(normal / sum));
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        weights[k] = 1 / std::max(kLeastRate, std::abs(rows_[k].dot(motion)));
      }
    }
    rates_.clear();
    for (const Vec6& row : rows_) {
      rates_.push_back(std::abs(row.dot(motion)));
    }
    std::nth_element(rates_.begin(),
                     rates_.begin() + static_cast<std::ptrdiff_t>(rates_.size() / 2), rates_.end());
    const bool is_free = rates_[rates_.size() / 2] < kMostRate;
    return is_free ? std::optional<Vec6>(motion) : std::nullopt;
  }

  // The displacement that brings what is near by the last query as far away as it can be, in the
  // sense of least squares, at right angles to the motion: the middle between two flanks.
  [[nodiscard]] Displacement CalcToMiddle(const Pose& X_WB, const Vec6& motion) const {
    const Vec3 centre_W = CentreOf(X_WB);
    constexpr double kStay = 0.01;  // Share of staying, so that what nothing fixes stays: a choice.
    Mat6 normal = Mat6::Zero();
    Vec6 right = Vec6::Zero();
    const double target = std::min(near_, near_points_.CalcLeast() + kFartherThanLeast * near_);
    for (const NearPoint& c : near_points_.list()) {
      const double short_of = target - c.distance;
      if (short_of > 0) {
        const Vec6 row = RowOf(c, centre_W);
        normal += row * row.transpose();
        right += short_of * row;
      }
    }
    const double trace = std::max(normal.trace(), 1e-12);
    normal += kStay * trace * Mat6::Identity() + trace * motion * motion.transpose();
    Vec6 d = normal.ldlt().solve(right);
    d -= d.dot(motion) * motion;
    const double length = d.norm();
    if (length > near_) {
      d *= near_ / length;
    }
    return {Vec3(d.tail<3>() / probe_.gyration()), Vec3(d.head<3>())};
  }

  // One step along the motion, into the middle where much is near. None where it is blocked.
  [[nodiscard]] std::optional<Pose> Step(const Pose& X_WB, const spatial::Twist& twist,
                                         double length) {
    const Displacement wanted = MoveAlong(twist, CentreOf(X_WB), length);
    const Pose X_wanted = probe_.Move(X_WB, wanted);
    const Pose X_middle = FindMiddle(X_wanted, ToMotion(wanted).normalized());
    for (const Pose& X : {X_middle, X_wanted}) {
      std::optional<Pose> made = PushFree(X);
      if (!made) {
        continue;
      }
      const double ahead = ToMotion(probe_.CalcDisplacement(X_WB, *made)).dot(ToMotion(wanted)) /
                           ToMotion(wanted).squaredNorm();
      if (ahead > kLeastMotionAhead) {
        return made;
      }
    }
    return std::nullopt;
  }

  // No correction brings the part nearer to what is nearest.
  [[nodiscard]] Pose FindMiddle(Pose X, const Vec6& motion) {
    near_points_.Find(X, near_);
    double least = near_points_.CalcLeast();
    for (int i = 0; i < kMostCorrections && !IsOver(); ++i) {
      if (near_points_.list().size() < kLeastContacts) {
        break;
      }
      Displacement d = CalcToMiddle(X, motion);
      bool is_better = false;
      for (int halving = 0; halving < kHalvingsToMiddle && !is_better; ++halving) {
        const Pose moved = probe_.Move(X, d);
        near_points_.Find(moved, near_);
        is_better = near_points_.CalcLeast() > least;
        X = is_better ? moved : X;
        d = {Vec3(0.5 * d.w_W), Vec3(0.5 * d.v_W)};
      }
      const double now = near_points_.CalcLeast();
      if (!is_better || now - least < kSettled * near_) {
        break;
      }
      least = now;
    }
    return X;
  }

  // Pushes the part out of what it is too deep in: further than it has to be, as what lies between
  // two poses is to be free, too.
  [[nodiscard]] std::optional<Pose> PushFree(const Pose& X_WB) {
    const double target = PushTargetOf(probe_.tolerance());
    PushOut out(probe_, X_WB);
    std::optional<Pose> best;
    double deepest = -probe_.tolerance();
    for (int i = 0; i <= kMostCorrections && !IsOver(); ++i) {
      const Pose X = out.pose();
      const double distance = probe_.Query(X, std::max(0.0, target));
      if (distance >= deepest) {
        deepest = distance;
        best = X;
      }
      if (distance >= -kShareOfTolerance * probe_.tolerance()) {
        break;
      }
      out.Add(probe_.contacts(), target);
    }
    return best;
  }

  // Straight along the axis, in either sense, where that leads out.
  [[nodiscard]] std::optional<Pose> FindExit(const Pose& X_WB, const spatial::Twist& twist) {
    const Displacement d = MoveAlong(twist, CentreOf(X_WB), 1);
    const Vec3 along = d.w_W.norm() * probe_.gyration() > 0.2 ? d.w_W : d.v_W;
    const double sign = d.v_W.dot(along) < 0 ? -1 : 1;
    const Vec3 direction = sign * along.normalized();
    const double exit = probe_.CalcExit(X_WB, direction) + 1e-6;
    const Pose out(X_WB.q(), Vec3(X_WB.p() + exit * direction));
    const double step = CheckStepOf(probe_.tolerance());
    return IsScrewFree(&probe_, X_WB, out, step) ? std::optional<Pose>(out) : std::nullopt;
  }

  [[nodiscard]] std::optional<Path> Follow(const Pose& start, spatial::Twist twist) {
    Path path{start};
    double step = 0.25 * kLargestMotionStep * probe_.size();
    double since_exit = 0;
    while (!IsOver()) {
      const Pose& X = path.back();
      const std::optional<Pose> next = Step(X, twist, step);
      if (!next) {
        step *= 0.5;
        if (step < kLeastMotionStep * probe_.size()) {
          return std::nullopt;
        }
        continue;
      }
      since_exit += probe_.CalcLength(probe_.CalcDisplacement(X, *next));
      path.push_back(*next);
      if (probe_.CalcOverlap(*next) <= 0) {
        return path;
      }
      Improve(path, &twist);
      if (since_exit > kExitsApart * probe_.size()) {
        since_exit = 0;
        if (const auto out = FindExit(*next, twist)) {
          path.push_back(*out);
          return path;
        }
      }
      step = std::min(kLongerMotion * step, kLargestMotionStep * probe_.size());
    }
    return std::nullopt;
  }

  // The motion as it went: corrections into the middle have mended what was estimated.
  void Improve(const Path& path, spatial::Twist* twist) {
    const Pose& X = path.back();
    double length = 0;
    std::size_t i = path.size() - 1;
    while (i > 0 && length < kSecant * probe_.size()) {
      length += probe_.CalcLength(probe_.CalcDisplacement(path[i - 1], path[i]));
      --i;
    }
    if (length < 0.5 * kSecant * probe_.size()) {
      return;
    }
    const spatial::Twist gone = FindTwist(path[i], X);
    const Vec6 before = ToMotion(MoveAlong(*twist, CentreOf(X), 1)).normalized();
    const Vec6 now = ToMotion(MoveAlong(gone, CentreOf(X), 1)).normalized();
    *twist = ToTwist(X, Vec6(before + kShareOfEstimate * (now - before)).normalized());
  }

  // The screw of the way but for its ends, where the part is still, or already, moved aside.
  [[nodiscard]] FreeScrew DescribeScrew(const Path& path) {
    FreeScrew screw;
    const std::size_t last = path.size() > 3 ? path.size() - 2 : path.size() - 1;
    Vec6 sum = Vec6::Zero();
    for (std::size_t i = 1; i < last; ++i) {
      const spatial::Twist twist = FindTwist(path[i], path[i + 1]);
      sum.head<3>() += twist.v;
      sum.tail<3>() += twist.w;
    }
    const Vec3 w = sum.tail<3>();
    screw.turn = w.norm();
    if (screw.turn > 0) {
      const Vec3 v0 = sum.head<3>();
      screw.axis.axis_W = w / screw.turn;
      screw.axis.p_WQ = w.cross(v0) / w.squaredNorm();
      screw.axis.pitch = 2 * std::numbers::pi * v0.dot(w) / w.squaredNorm();
    }
    const spatial::Twist along{screw.axis.axis_W,
                               Vec3(screw.axis.pitch / (2 * std::numbers::pi) * screw.axis.axis_W +
                                    screw.axis.p_WQ.cross(screw.axis.axis_W))};
    const std::size_t stride = std::max<std::size_t>(1, last / kLooksAlong);
    for (std::size_t i = std::min<std::size_t>(1, last); i <= last; i += stride) {
      near_points_.Find(path[i], near_);
      const Vec3 centre_W = CentreOf(path[i]);
      const Vec6 unit = ToMotion(MoveAlong(along, centre_W, 1)).normalized();
      for (const NearPoint& point : near_points_.list()) {
        if (std::abs(RowOf(point, centre_W).normalized().dot(unit)) < kMostRate) {
          (i == 1 ? screw.flanks : screw.passed).push_back(point);
        }
      }
    }
    return screw;
  }

  Probe& probe_;
  NearPoints near_points_;
  std::uint64_t last_query_;
  double near_{0};
  std::vector<Vec6> rows_;
  std::vector<double> rates_;
};

}  // namespace

std::optional<Way> FindFreeMotion(Probe* probe, const WayOptions& options, std::uint64_t budget,
                                  double step) {
  const WayProblem& problem = probe->problem();
  auto way = problem.X_WB_goal ? std::nullopt : FreeMotion(probe, budget).Run();
  if (!way) {
    return std::nullopt;
  }
  WayOptions mending;
  mending.budget = kMostQueriesOfMending;
  mending.stop = options.stop;
  Probe of_mending(problem, mending);
  std::size_t edge = 0;
  auto path = RepairWay(&of_mending, way->path, step, &edge);
  if (!path) {
    return std::nullopt;
  }
  way->path = std::move(*path);
  return way;
}

}  // namespace hvas::paths
