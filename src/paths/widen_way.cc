#include "paths/widen_way.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "paths/check_way.h"
#include "paths/face_pair.h"

namespace hvas::paths {
namespace {

using spatial::Pose;

constexpr double kMovedApart = 0.04;  // Of the part's size: the poses that are moved.
constexpr int kWideningSweeps =
    6;                         // Over all poses; further ones gain less than a tenth: a choice.
constexpr int kDivisions = 2;  // Of the screws beside narrow places: 1 % of the part then.
constexpr int kHalvings = 3;   // Of a move that does not help: a choice.
// Weight of staying between the neighbours, beside that of a pair of faces: choices.
constexpr double kStayBetween = 0.05;
constexpr double kMostWidening =
    0.5;  // Of the clear distance: a pose moves no further at once, as planes turn.

/** What is near at a pose, by pairs of faces, so that each counts once whatever its samples. */
struct Nearness {
  double shortfall{0};    // Sum over the pairs of the square of what is short of being clear [m^2].
  Displacement clearing;  // What clears them best in the sense of least squares.
};

// Between two walls the clearing leads to the middle. Turns count as lengths.
Nearness Measure(const Probe& probe, const Pose& X_WB, const Displacement& to_middle) {
  const double clear = probe.clear_distance();
  const double g = probe.gyration();
  const Vec3 centre_W = X_WB * probe.centre_B();
  std::map<FacePair, std::pair<int, double>> pairs;  // Number of contacts, least distance.
  for (const contact::Contact& c : probe.contacts()) {
    auto& [count, least] = pairs.try_emplace(FacesOf(c), 0, clear).first->second;
    ++count;
    least = std::min(least, c.distance);
  }
  Nearness nearness;
  for (const auto& [faces, pair] : pairs) {
    nearness.shortfall += (clear - pair.second) * (clear - pair.second);
  }
  Mat6 normal = kStayBetween * Mat6::Identity();
  Vec6 right;
  right << kStayBetween * to_middle.v_W, kStayBetween * g * to_middle.w_W;
  for (const contact::Contact& c : probe.contacts()) {
    const double weight = 1.0 / pairs[FacesOf(c)].first;
    const Vec6 row = probe.RowOf(c.nhat_W, c.p_WC, centre_W);
    normal += weight * row * row.transpose();
    right += weight * (clear - c.distance) * row;
  }
  const Vec6 d = normal.ldlt().solve(right);
  const double scale = std::min(1.0, kMostWidening * clear / std::max(d.norm(), 1e-12));
  nearness.clearing = {Vec3(scale * d.tail<3>() / g), Vec3(scale * d.head<3>())};
  return nearness;
}

class Widening {
 public:
  Widening(Probe* probe, double step, std::uint64_t budget, Path way)
      : probe_(*probe), step_(step), last_(probe->queries() + budget), way_(std::move(way)) {}

  [[nodiscard]] bool IsFree() {
    for (std::size_t i = 1; i < way_.size(); ++i) {
      if (IsOver() || !IsScrewFree(&probe_, way_[i - 1], way_[i], step_)) {
        return false;
      }
    }
    return true;
  }

  void Sweep() {
    for (std::size_t i = 1; i + 1 < way_.size() && !IsOver(); ++i) {
      MovePose(i);
    }
  }

  /** Divides the screws beside poses that are nearer to others than half of what is clear: around
   a corner, poses far from each other cannot move apart. */
  void Divide() {
    std::vector<double> distances;
    for (const Pose& X_WB : way_) {
      if (IsOver()) {
        return;
      }
      distances.push_back(probe_.Query(X_WB, clear_));
    }
    Path divided{way_.front()};
    for (std::size_t i = 1; i < way_.size(); ++i) {
      if (std::min(distances[i - 1], distances[i]) < 0.5 * clear_ && !IsOver()) {
        const Pose middle = Interpolate(way_[i - 1], way_[i], 0.5);
        if (IsBetween(way_[i - 1], middle, way_[i])) {
          divided.push_back(middle);
        }
      }
      divided.push_back(way_[i]);
    }
    way_ = std::move(divided);
  }

  [[nodiscard]] Path&& TakeWay() { return std::move(way_); }

 private:
  [[nodiscard]] bool IsOver() const { return probe_.queries() >= last_ || probe_.is_over(); }

  [[nodiscard]] bool IsBetween(const Pose& from, const Pose& X_WB, const Pose& to) {
    return IsScrewFree(&probe_, from, X_WB, step_) && IsScrewFree(&probe_, X_WB, to, step_);
  }

  void MovePose(std::size_t i) {
    const double distance = probe_.Query(way_[i], clear_);
    if (distance >= clear_) {
      return;
    }
    const Pose middle = Interpolate(way_[i - 1], way_[i + 1], 0.5);
    const Nearness before = Measure(probe_, way_[i], probe_.CalcDisplacement(way_[i], middle));
    Displacement d = before.clearing;
    for (int halving = 0; halving < kHalvings && !IsOver(); ++halving) {
      const Pose moved = probe_.Move(way_[i], d);
      const double least = probe_.Query(moved, clear_);
      const bool is_clearer = least >= std::min(distance, 0.0) &&
                              Measure(probe_, moved, {}).shortfall < before.shortfall;
      if (is_clearer && IsBetween(way_[i - 1], moved, way_[i + 1])) {
        way_[i] = moved;
        return;
      }
      d = {Vec3(0.5 * d.w_W), Vec3(0.5 * d.v_W)};
    }
  }

  Probe& probe_;
  double step_;
  std::uint64_t last_;
  Path way_;
  double clear_{probe_.clear_distance()};
};

}  // namespace

Path WidenWay(Probe* probe, const Path& path, double step, std::uint64_t budget) {
  Widening widening(probe, step, budget,
                    Resample(path, probe->problem().part->box_B(), kMovedApart * probe->size()));
  if (!widening.IsFree()) {  // A divided screw is sampled at other places than the whole.
    return path;
  }
  for (int division = 0; division <= kDivisions; ++division) {
    if (division > 0) {
      widening.Divide();
    }
    for (int sweep = 0; sweep < kWideningSweeps; ++sweep) {
      widening.Sweep();
    }
  }
  return widening.TakeWay();
}

}  // namespace hvas::paths
