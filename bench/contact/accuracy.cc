#include "accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "contact/test/parts.h"

namespace hvas::bench {
namespace {

namespace parts = contact::testing;
using spatial::Pose;

constexpr double kStep = 50e-6;  // [m] in a millisecond at 50 mm/s.

struct AccuracyTest {
  const char* name;
  std::function<contact::ShapeSource(double deviation)> held, other;
  double depth;  // [m]
  std::function<Pose(int)> pose;
};

Vec3 Radial(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

contact::ShapeSource Shaft(double deviation) {
  return parts::GroovedShaft(19.99e-3, 80e-3, deviation);
}

contact::ShapeSource Bore(double deviation) {
  return parts::GroovedBore(20e-3, 28e-3, 50e-3, deviation);
}

AccuracyTest Cone() {
  const double angle = std::atan2(5e-3, 40e-3);
  const double seated = 1e-3 / std::tan(angle) + 40e-3;
  constexpr double kDown = 200e-6, kOff = 60e-6;
  const Quat over = spatial::RotationFromVector({std::numbers::pi, 0, 0});
  return {"cone", [](double d) { return parts::Cone(15e-3, 10e-3, 40e-3, d); },
          [](double d) { return parts::ConeSeat(9e-3, 16e-3, 56e-3, 25e-3, d); },
          kDown * std::sin(angle) + kOff * std::cos(angle),
          [=](int i) {
            return Pose(over, Radial(kOff, kStep / 12e-3 * i) + Vec3(0, 0, seated - kDown));
          }};
}

std::vector<AccuracyTest> MakeTests() {
  return {
      {"C", Shaft, Bore, 100e-6,
       [](int i) { return Pose(Radial(110e-6, kStep / 20e-3 * i) + Vec3(0, 0, -15.3e-3)); }},
      // Over the shaft's groove and the bore's.
      {"A", Shaft, Bore, 100e-6,
       [](int i) { return Pose(Radial(110e-6, 0.3) + Vec3(0, 0, 6e-3 - kStep * i)); }},
      {"P",
       [](double) {
         return parts::Frame({40e-3, 30e-3, 5e-3}, {25e-3, 15e-3});
       },
       [](double) {
         return parts::Frame({45e-3, 38e-3, 10e-3}, {22e-3, 12e-3});
       },
       100e-6,
       [](int i) {
         return Pose(Vec3(-6e-3 + 0.8 * kStep * i, 4e-3 - 0.6 * kStep * i, 15e-3 - 100e-6));
       }},
      {"D", [](double d) { return parts::Shaft(2.99e-3, 20e-3, d); },
       [](double d) { return parts::Bushing(3e-3, 20e-3, 15e-3, d); }, 100e-6,
       [](int i) { return Pose(Radial(110e-6, kStep / 3e-3 * i) + Vec3(0, 0, 2e-3)); }},
      Cone(),
      {"sphere", [](double d) { return parts::Ball(9.95e-3, std::max(d, 10e-6)); },
       [](double d) { return parts::Socket(10e-3, 14e-3, std::max(d, 10e-6)); }, 100e-6,
       [](int i) {
         return Pose(Radial(75e-6, kStep / 10e-3 * i) + Vec3(0, 0, -150e-6 * std::sqrt(0.75)));
       }},
      {"torus", [](double d) { return parts::Ring(20e-3, 3e-3, std::max(d, 10e-6)); },
       [](double d) { return parts::RingGroove(20e-3, 3.02e-3, std::max(d, 10e-6)); }, 100e-6,
       [](int i) {
         return Pose(spatial::RotationFromVector({0, 0, kStep / 20e-3 * i}), Vec3(0, 0, -120e-6));
       }},
  };
}

std::vector<BenchPart> BuildParts(const AccuracyTest& test) {
  std::vector<BenchPart> built(2);
  for (std::size_t k = 0; k < 2; ++k) {
    built[k].source = (k == 0 ? test.held : test.other)(1e-6);
    built[k].shape = parts::Build(built[k].source);
  }
  return built;
}

AccuracyRow Follow(const AccuracyTest& test, const AccuracyEntrant& entrant,
                   const std::vector<BenchPart>& built) {
  std::array<PeerMesh, 2> meshes;
  for (std::size_t k = 0; k < 2; ++k) {
    meshes[k] =
        MakePeerMesh((k == 0 ? test.held : test.other)(entrant.deviation), entrant.at_least);
  }
  const auto method =
      entrant.make(&built, [&](std::size_t k) -> const PeerMesh& { return meshes[k]; });
  method->Load(0, {{1, {}}});
  AccuracyRow row{test.name, entrant.name, 0, 0, 0, entrant.poses};
  Vec3 last = Vec3::Zero();
  for (int i = 0; i < entrant.poses; ++i) {
    method->Query(test.pose(i));
    double deepest = 0;
    for (const FoundContact& c : method->contacts()) {
      deepest = std::max(deepest, c.depth);
    }
    const double error = std::abs(deepest - test.depth);
    row.depth_error_mean += error / entrant.poses;
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
  for (const AccuracyTest& test : MakeTests()) {
    const std::vector<BenchPart> built = BuildParts(test);
    for (const AccuracyEntrant& entrant : entrants) {
      std::cerr << "accuracy " << test.name << ", " << entrant.name << '\n';
      rows.push_back(Follow(test, entrant, built));
    }
  }
  return rows;
}

}  // namespace hvas::bench
