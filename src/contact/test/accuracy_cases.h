#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "contact/test/parts.h"
#include "spatial/pose.h"

/** Tests C, A, P and D of the study of contact and seats on a cone, a sphere and a torus: a part
 about 0.1 mm deep in another, the contact moving at 50 mm/s. Truth is their analytic geometry. */
namespace hvas::contact::testing {

inline constexpr double kMillisecondStep = 50e-6;  ///< [m] at 50 mm/s.

struct AccuracyCase {
  std::string name;
  std::function<ShapeSource(double deviation)> held, other;
  double depth;                               ///< Everywhere along the way [m].
  int steps;                                  ///< Steps of a millisecond.
  std::function<spatial::Pose(double)> pose;  ///< X_WH at a step; the other part is where W is.
  double force_limit;  ///< Limit of the pooled force's change in a step at 1 N/mm [N]; 0: none is
                       ///< stated.
};

inline Vec3 Radial(double length, double angle) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

/** C: a shaft pressed into a bore, around which it goes. Ideally 0.17 mN. */
inline AccuracyCase CaseC() {
  return {
      "C",
      [](double d) { return GroovedShaft(19.99e-3, 80e-3, d); },
      [](double d) { return GroovedBore(20e-3, 28e-3, 50e-3, d); },
      100e-6,
      500,
      [](double i) {
        return spatial::Pose(Radial(110e-6, kMillisecondStep / 20e-3 * i) + Vec3(0, 0, -15.3e-3));
      },
      0.25e-3};
}

/** A: the same, sliding along over the shaft's groove and the bore's. Ideally no change. */
inline AccuracyCase CaseA() {
  AccuracyCase out = CaseC();
  out.name = "A";
  out.steps = 700;
  out.pose = [](double i) {
    return spatial::Pose(Radial(110e-6, 0.3) + Vec3(0, 0, 8e-3 - kMillisecondStep * i));
  };
  out.force_limit = 2e-3;
  return out;
}

/** P: a plate with a window sliding on another. Ideally no change. */
inline AccuracyCase CaseP() {
  return {"P",
          [](double) {
            return Frame({40e-3, 30e-3, 5e-3}, {25e-3, 15e-3});
          },
          [](double) {
            return Frame({45e-3, 38e-3, 10e-3}, {22e-3, 12e-3});
          },
          100e-6,
          400,
          [](double i) {
            const double way = kMillisecondStep * i;
            return spatial::Pose(Vec3(-6e-3 + 0.8 * way, 4e-3 - 0.6 * way, 15e-3 - 100e-6));
          },
          0.05e-3};
}

/** D: a dowel in its hole, around which it goes. Ideally 1.11 mN. */
inline AccuracyCase CaseD() {
  return {"D",
          [](double d) { return Shaft(2.99e-3, 20e-3, d); },
          [](double d) { return Bushing(3e-3, 20e-3, 15e-3, d); },
          100e-6,
          400,
          [](double i) {
            return spatial::Pose(Radial(110e-6, kMillisecondStep / 3e-3 * i) + Vec3(0, 0, 2e-3));
          },
          0};
}

inline constexpr double kConeSlope = 0.125;   ///< Tangent of the half angle of taper and seat.
inline constexpr double kConeSeated = 48e-3;  ///< Height of the taper that just fits its seat.

inline Quat TurnedOver() {
  return spatial::RotationFromVector({std::numbers::pi, 0, 0});
}

/** A taper in its seat: lowered by z it is in by z sin(angle), and by e cos(angle) more on the side
 that it is off the axis by e. The taper stands on its wide end, so it is turned over. */
inline AccuracyCase CaseCone() {
  constexpr double kDown = 200e-6, kOff = 60e-6;
  const double angle = std::atan(kConeSlope);
  return {"cone",
          [](double d) { return Cone(15e-3, 10e-3, 40e-3, d); },
          [](double d) { return ConeSeat(9e-3, 16e-3, 56e-3, 25e-3, d); },
          kDown * std::sin(angle) + kOff * std::cos(angle),
          200,
          [](double i) {
            return spatial::Pose(TurnedOver(), Radial(kOff, kMillisecondStep / 12e-3 * i) +
                                                   Vec3(0, 0, kConeSeated - kDown));
          },
          0};
}

// Meshes that curve both ways are kept coarse: what counts is the surface beneath.
inline constexpr double kCoarse = 10e-6;  ///< [m]

/** A ball in a socket 0.05 mm larger: in by how far it is off centre, less that. */
inline AccuracyCase CaseSphere() {
  return {"sphere",
          [](double d) { return Ball(9.95e-3, std::max(d, kCoarse)); },
          [](double d) { return Socket(10e-3, 14e-3, std::max(d, kCoarse)); },
          100e-6,
          200,
          [](double i) {
            return spatial::Pose(Radial(75e-6, kMillisecondStep / 10e-3 * i) -
                                 Vec3(0, 0, 150e-6 * std::sqrt(0.75)));
          },
          0};
}

/** A ring lowered into a round groove 0.02 mm larger, turning. Ideally no change. */
inline AccuracyCase CaseTorus() {
  return {"torus",
          [](double d) { return Ring(20e-3, 3e-3, std::max(d, kCoarse)); },
          [](double d) { return RingGroove(20e-3, 3.02e-3, std::max(d, kCoarse)); },
          100e-6,
          200,
          [](double i) {
            const Vec3 turn(0, 0, kMillisecondStep / 20e-3 * i);
            return spatial::Pose(spatial::RotationFromVector(turn), Vec3(0, 0, -120e-6));
          },
          0.05e-3};
}

inline constexpr double kBaseRadius = 10e-3;  ///< Base radius of the involute [m].
inline constexpr double kRollFrom = 0.2;      ///< Where the flank begins [rad].
inline constexpr double kRollTo = 0.8;        ///< Where it ends [rad].
inline constexpr double kRackHalf = 5e-3;     ///< Half the height of the rack [m].

/** A tooth's flank about x, an involute that is one freeform face, on a wall of 1.5 mm. Faces: 0
 the flank, then planes. */
inline ShapeSource InvoluteFlank(double deviation) {
  constexpr double kWall = 1.5e-3;
  const int n = static_cast<int>(
      std::ceil((kRollTo - kRollFrom) * std::sqrt(kBaseRadius * kRollTo / (8 * deviation))));
  const auto normal_at = [](double t) { return Eigen::Vector2d(std::sin(t), -std::cos(t)); };
  const auto point_at = [&](double t) {
    const Eigen::Vector2d on_base(std::cos(t), std::sin(t));
    return Eigen::Vector2d(kBaseRadius * (on_base + t * normal_at(t)));
  };
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i <= n; ++i) {
    outline.push_back(point_at(kRollFrom + (kRollTo - kRollFrom) * i / n));
  }
  outline.emplace_back(outline.back() - kWall * normal_at(kRollTo));
  outline.emplace_back(outline.front() - kWall * normal_at(kRollFrom));
  ShapeSource source = Prism(outline, 6e-3);
  const auto flank = static_cast<std::uint32_t>(n);  // That many planes are one face.
  for (std::uint32_t& face : source.triangle_face) {
    face = face < flank ? 0 : face - flank + 1;
  }
  source.faces.erase(source.faces.begin() + 1, source.faces.begin() + n);
  source.faces[0] = {};
  return source;
}

/** The flank rolls on a flat rack, which goes the way of the base circle: at a roll t it reaches
 r_b t from the axis, so that its depth stays. The contact's radius of curvature r_b t trebles. */
inline AccuracyCase CaseInvolute() {
  constexpr double kDepth = 100e-6;
  constexpr int kSteps = 400;
  return {"involute",
          [](double d) { return InvoluteFlank(std::max(d, kCoarse)); },
          [](double) {
            return Block({20e-3, 20e-3, kRackHalf});
          },
          kDepth,
          kSteps,
          [](double i) {
            const double t = kRollFrom + (kRollTo - kRollFrom) * (0.1 + 0.8 * i / kSteps);
            return spatial::Pose(spatial::RotationFromVector({-t, 0, 0}),
                                 Vec3(0, 0, kRackHalf + kBaseRadius * t - kDepth));
          },
          0};
}

/** A case with no surface known under round faces: the corners of their meshes tell all. */
inline AccuracyCase AsFreeform(AccuracyCase test) {
  test.name += "_freeform";
  for (auto* make : {&test.held, &test.other}) {
    *make = [known = std::move(*make)](double deviation) {
      ShapeSource source = known(deviation);
      for (spatial::Surface& face : source.faces) {
        face = face.kind == spatial::SurfaceKind::kPlane ? face : spatial::Surface();
      }
      return source;
    };
  }
  return test;
}

inline std::vector<AccuracyCase> FreeformAccuracyCases() {
  return {AsFreeform(CaseC()),    AsFreeform(CaseA()),      AsFreeform(CaseD()),
          AsFreeform(CaseCone()), AsFreeform(CaseSphere()), AsFreeform(CaseTorus()),
          CaseInvolute()};
}

inline std::vector<AccuracyCase> AllAccuracyCases() {
  return {CaseC(), CaseA(), CaseP(), CaseD(), CaseCone(), CaseSphere(), CaseTorus()};
}

}  // namespace hvas::contact::testing
