#include "accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include "contact/test/accuracy_cases.h"

namespace hvas::bench {
namespace {

using contact::testing::AccuracyCase;

std::vector<BenchPart> BuildParts(const AccuracyCase& test) {
  std::vector<BenchPart> built(2);
  for (std::size_t k = 0; k < 2; ++k) {
    built[k].source = (k == 0 ? test.held : test.other)(1e-6);
    built[k].shape = contact::testing::Build(built[k].source);
  }
  return built;
}

AccuracyRow Follow(const AccuracyCase& test, const AccuracyEntrant& entrant,
                   const std::vector<BenchPart>& built) {
  std::array<PeerMesh, 2> meshes;
  for (std::size_t k = 0; k < 2; ++k) {
    meshes[k] =
        MakePeerMesh((k == 0 ? test.held : test.other)(entrant.deviation), entrant.at_least);
  }
  const auto method =
      entrant.make(&built, [&](std::size_t k) -> const PeerMesh& { return meshes[k]; });
  method->Load(0, {{1, {}}});
  const int poses = std::min(entrant.poses, test.steps);
  AccuracyRow row{test.name, entrant.name, 0, 0, 0, poses};
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < poses; ++i) {
    method->Query(test.pose(i));
    double deepest = 0;
    for (const FoundContact& c : method->contacts()) {
      deepest = std::max(deepest, c.depth);
    }
    const double error = std::abs(deepest - test.depth);
    row.depth_error_mean += error / poses;
    row.depth_error_max = std::max(row.depth_error_max, error);
    const Vec3 force = method->PooledForce();
    row.force_change = i > 0 ? std::max(row.force_change, (force - last).norm()) : 0;
    last = force;
  }
  return row;
}

}  // namespace

Vec3 Method::PooledForce() {
  constexpr double kStiffness = 1e3;  // [N/m]
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  for (const FoundContact& c : contacts()) {
    const double depth = std::max(0.0, c.depth);
    sum += depth * depth * c.nhat_W;
    weight += depth;
  }
  return weight > 0 ? Vec3(kStiffness / weight * sum) : Vec3::Zero();
}

std::vector<AccuracyRow> RunAccuracy(const std::vector<AccuracyEntrant>& entrants) {
  std::vector<AccuracyRow> rows;
  for (const AccuracyCase& test : contact::testing::AllAccuracyCases()) {
    const std::vector<BenchPart> built = BuildParts(test);
    for (const AccuracyEntrant& entrant : entrants) {
      std::cerr << "accuracy " << test.name << ", " << entrant.name << '\n';
      rows.push_back(Follow(test, entrant, built));
    }
  }
  return rows;
}

}  // namespace hvas::bench
