#include "planning/widen_way.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <Eigen/Cholesky>

#include "planning/check_way.h"

namespace hvas::planning {
namespace {

using spatial::Pose;

constexpr double kClear = 0.02;       // Of the part's size: farther than this from others is clear.
constexpr double kMovedApart = 0.04;  // Of the part's size: the poses that are moved.
constexpr int kWideningSweeps =
    6;                        // Over all poses; further ones gain less than a tenth: a choice.
constexpr int kHalvings = 3;  // Of a move that does not help: a choice.
// Weight of staying between the neighbours, beside that of a pair of faces: choices.
constexpr double kStayBetween = 0.05;
constexpr double kMostMove = 0.5;  // Of kClear: a pose moves no further at once, as planes turn.

using FacePair = std::tuple<contact::BodyId, std::uint32_t, std::uint32_t>;

FacePair FacesOf(const contact::Contact& c) {
  return {c.body, c.held_face, c.scene_face};
}

/** What is near at a pose, by pairs of faces, so that each counts once whatever its samples. */
struct Nearness {
  double shortfall{0};    // Sum over the pairs of the square of what is short of being clear [m^2].
  Displacement clearing;  // What clears them best in the sense of least squares.
};

// Between two walls the clearing leads to the middle. Turns count as lengths.
Nearness Measure(const Probe& probe, const Pose& X_WB, const Displacement& to_middle) {
  const double clear = kClear * probe.size();
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
  const double scale = std::min(1.0, kMostMove * clear / std::max(d.norm(), 1e-12));
  nearness.clearing = {Vec3(scale * d.tail<3>() / g), Vec3(scale * d.head<3>())};
  return nearness;
}

}  // namespace

sweep::Path WidenWay(Probe* probe, const sweep::Path& path, double step, std::uint64_t budget) {
  sweep::Path way =
      sweep::Resample(path, probe->problem().part->box_B(), kMovedApart * probe->size());
  const double clear = kClear * probe->size();
  const std::uint64_t last = probe->queries() + budget;
  const auto is_over = [&] { return probe->queries() >= last || probe->is_over(); };
  // A divided screw is sampled at other places than the whole.
  for (std::size_t i = 1; i < way.size(); ++i) {
    if (is_over() || !IsScrewFree(probe, way[i - 1], way[i], step)) {
      return path;
    }
  }
  for (int sweep = 0; sweep < kWideningSweeps; ++sweep) {
    for (std::size_t i = 1; i + 1 < way.size() && !is_over(); ++i) {
      const double distance = probe->Query(way[i], clear);
      if (distance >= clear) {
        continue;
      }
      const Pose middle = sweep::Interpolate(way[i - 1], way[i + 1], 0.5);
      const Displacement to_middle = probe->CalcDisplacement(way[i], middle);
      const Nearness before = Measure(*probe, way[i], to_middle);
      Displacement d = before.clearing;
      for (int halving = 0; halving < kHalvings && !is_over(); ++halving) {
        const Pose moved = probe->Move(way[i], d);
        const double least = probe->Query(moved, clear);
        const bool is_clearer = least >= std::min(distance, 0.0) &&
                                Measure(*probe, moved, {}).shortfall < before.shortfall;
        if (is_clearer && IsScrewFree(probe, way[i - 1], moved, step) &&
            IsScrewFree(probe, moved, way[i + 1], step)) {
          way[i] = moved;
          break;
        }
        d = {Vec3(0.5 * d.w_W), Vec3(0.5 * d.v_W)};
      }
    }
  }
  return way;
}

}  // namespace hvas::planning
