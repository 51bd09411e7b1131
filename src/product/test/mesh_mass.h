#pragma once

#include "product/product.h"

namespace hvas::product::testing {

/** Mass of what a closed mesh encloses: the sums over its tetrahedra with the origin. */
inline MassProperties CalcMass(const Mesh& mesh, double density) {
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();  // The integral of p p^T.
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    const double piece = a.dot(b.cross(c)) / 6;
    const Vec3 sum = a + b + c;
    volume += piece;
    first += piece / 4 * sum;
    second += piece / 20 *
              (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  MassProperties mass;
  mass.volume = volume;
  mass.mass = density * volume;
  mass.p_BoBcm_B = first / volume;
  const Mat3 central = second - volume * mass.p_BoBcm_B * mass.p_BoBcm_B.transpose();
  mass.I_BBcm_B = density * (central.trace() * Mat3::Identity() - central);
  return mass;
}

}  // namespace hvas::product::testing
