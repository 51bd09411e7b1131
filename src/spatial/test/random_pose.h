#pragma once

#include <numbers>

#include "base/random.h"
#include "spatial/pose.h"

namespace hvas::spatial {

/** A vector with coordinates uniform in [-size, size). */
inline Vec3 RandomVector(Random* random, double size) {
  const double x = random->Uniform(-size, size);
  const double y = random->Uniform(-size, size);
  return {x, y, random->Uniform(-size, size)};
}

inline Vec3 RandomDirection(Random* random) {
  const double x = random->Normal();
  const double y = random->Normal();
  return Vec3(x, y, random->Normal()).normalized();
}

/** Uniform over all rotations. */
inline Quat RandomRotation(Random* random) {
  const double w = random->Normal();
  const double x = random->Normal();
  const double y = random->Normal();
  return Quat(w, x, y, random->Normal()).normalized();
}

inline Pose RandomPose(Random* random, double size) {
  const Quat q = RandomRotation(random);
  return {q, RandomVector(random, size)};
}

}  // namespace hvas::spatial
