#include "tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/random.h"
#include "gear_pump_parts.h"

namespace hvas::bench {
namespace {

namespace pump = products::pump;
using spatial::Pose;
using std::numbers::pi;

constexpr double kMm = 1e-3;

/** A sum of sines between 0.5 and 8 Hz with random phases. */
class HandNoise {
 public:
  HandNoise(Random* random, double rms) : scale_(rms * std::sqrt(2.0 / kTerms)) {
    for (int i = 0; i < kTerms; ++i) {
      rate_[static_cast<std::size_t>(i)] = 2 * pi * random->Uniform(0.5, 8.0);
      phase_[static_cast<std::size_t>(i)] = random->Uniform(0, 2 * pi);
    }
  }

  [[nodiscard]] double At(double t) const {
    double sum = 0;
    for (std::size_t i = 0; i < kTerms; ++i) {
      sum += std::sin(rate_[i] * t + phase_[i]);
    }
    return scale_ * sum;
  }

 private:
  static constexpr int kTerms = 6;
  double scale_;
  std::array<double, kTerms> rate_{};
  std::array<double, kTerms> phase_{};
};

/** Root mean squares of the hand's noise along and about x, y and z. */
struct NoiseLevel {
  Vec3 p;
  Vec3 theta;
};

double SmoothStep(double x) {
  const double u = std::clamp(x, 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/** Poses from a height over the goal [m] as a function of the part of the track that is done. */
template <typename Height>
std::vector<Pose> MakePoses(std::uint64_t seed, const Pose& X_WG, const NoiseLevel& level,
                            Height height) {
  Random random(seed);
  std::vector<HandNoise> noise;
  for (int k = 0; k < 6; ++k) {
    noise.emplace_back(&random, k < 3 ? level.p[k] : level.theta[k - 3]);
  }
  std::vector<Pose> poses;
  for (int i = 0; i < kTrackPoses; ++i) {
    const double t = 1e-3 * i;
    const Vec3 p(noise[0].At(t), noise[1].At(t), noise[2].At(t) + height(t / (1e-3 * kTrackPoses)));
    const Vec3 theta(noise[3].At(t), noise[4].At(t), noise[5].At(t));
    poses.push_back(Pose(X_WG.p() + p) * Pose(spatial::RotationFromVector(theta), Vec3::Zero()) *
                    Pose(X_WG.q(), Vec3::Zero()));
  }
  return poses;
}

Pose AtMm(double x, double y, double z, double turn = 0) {
  return {spatial::RotationFromVector({0, 0, turn}), kMm * Vec3(x, y, z)};
}

Track ShaftIntoBushing() {
  Track track{"T1", "shaft into bushing", kShaft, {{kBushing, {}}}, {}};
  const NoiseLevel level{{0.06e-3, 0.06e-3, 0.02e-3}, {0.4e-3, 0.4e-3, 5e-3}};
  track.poses =
      MakePoses(11, {}, level, [](double s) { return 0.5e-3 - 60.5e-3 * SmoothStep(1.05 * s); });
  return track;
}

PlacedPart DrivenGear() {
  return {kDrivenGear, AtMm(0, -pump::kAxis, 0, pi / 2 + pi / 14)};
}

Track GearIntoHousing() {
  Track track{
      "T2", "drive gear into housing, meshing", kDriveGear, {{kHousing, {}}, DrivenGear()}, {}};
  const NoiseLevel level{{0.05e-3, 0.05e-3, 0.02e-3}, {0.6e-3, 0.6e-3, 4e-3}};
  track.poses = MakePoses(12, AtMm(0, pump::kAxis, 0), level,
                          [](double s) { return 24e-3 * (1 - SmoothStep(1.1 * s)); });
  return track;
}

Track CoverOntoHousing() {
  Track track{"T3",
              "cover over shafts, dowels and studs",
              kCover,
              {{kHousing, {}}, {kDriveGear, AtMm(0, pump::kAxis, 0)}, DrivenGear()},
              {}};
  for (const pump::Place& p : pump::kDowels) {
    track.others.push_back({kDowel, AtMm(p.x, p.y, pump::kFront - 14)});
  }
  for (const pump::Place& p : pump::kScrews) {
    track.others.push_back({kStud, AtMm(p.x, p.y, pump::kFront - 15)});
  }
  const NoiseLevel level{{0.07e-3, 0.07e-3, 0.02e-3}, {0.3e-3, 0.3e-3, 0.6e-3}};
  constexpr double kOverload = 0.9;  // From here on, of the track.
  track.poses = MakePoses(13, AtMm(0, 0, pump::kCoverBack), level, [](double s) {
    return 17e-3 * (1 - SmoothStep(s / kOverload)) -
           1.8e-3 * SmoothStep((s - kOverload) / (1 - kOverload));
  });
  return track;
}

constexpr std::array<PartNumber, 3> kFillers{kHub, kNippleBody, kSeal};

}  // namespace

std::vector<Track> MakeTracks() {
  return {ShaftIntoBushing(), GearIntoHousing(), CoverOntoHousing()};
}

std::set<std::size_t> ListParts(const Track& track) {
  std::set<std::size_t> list(kFillers.begin(), kFillers.end());
  list.insert(track.held);
  for (const PlacedPart& other : track.others) {
    list.insert(other.part);
  }
  return list;
}

std::vector<PlacedPart> MakeScene(const Track& track, const std::vector<BenchPart>& parts,
                                  std::size_t count) {
  std::vector<PlacedPart> scene(
      track.others.begin(),
      track.others.begin() + static_cast<std::ptrdiff_t>(std::min(count, track.others.size())));
  spatial::Box taken;
  for (const Pose& X_WH : track.poses) {
    taken.Add(spatial::Transform(X_WH, parts[track.held].shape->box_B()));
  }
  for (const PlacedPart& other : scene) {
    taken.Add(spatial::Transform(other.X_WB, parts[other.part].shape->box_B()));
  }
  double pitch = 0;
  for (const PartNumber f : kFillers) {
    pitch = std::max(pitch, parts[f].shape->box_B().size().norm());
  }
  // A part fits into its cell whatever way it is turned.
  const int reach = 2 + static_cast<int>(std::cbrt(static_cast<double>(count))) +
                    static_cast<int>(0.5 * taken.size().maxCoeff() / pitch);
  std::vector<std::tuple<double, int, int, int>> cells;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        const Vec3 centre = taken.centre() + pitch * Vec3(i, j, k);
        const Vec3 half = Vec3::Constant(0.5 * pitch);
        if (!taken.Overlaps({centre - half, centre + half})) {
          cells.emplace_back((centre - taken.centre()).norm(), i, j, k);
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  Random random(17);
  for (std::size_t c = 0; c < cells.size() && scene.size() < count; ++c) {
    const auto& [distance, i, j, k] = cells[c];
    const std::size_t part = kFillers[c % kFillers.size()];
    const Quat q =
        Quat(random.Normal(), random.Normal(), random.Normal(), random.Normal()).normalized();
    const Vec3 centre_W = taken.centre() + pitch * Vec3(i, j, k);
    scene.push_back({part, {q, centre_W - q * parts[part].shape->box_B().centre()}});
  }
  return scene;
}

}  // namespace hvas::bench
