#pragma once

#include <span>

#include "spatial/pose.h"

namespace hvas::contact {

struct Contact;

/** The force of an elastic layer between two parts, from all samples in contact:

     F = K sum(a d^2 n) / sum(a d),  T = K sum(a d^2 p x n) / sum(a d)

 with depth d, normal n, position p and area a of each sample: the mean over the contact of the
 springs' forces, weighted by depth. It does not depend on how many samples there are, and it is
 smooth where parts slide over edges, since a sample counts for the area around it. Samples on edges
 lie on no area of their own; they count for little, but for all where nothing else touches. */
class ContactLayer {
 public:
  static constexpr double kFaceArea = 1;     ///< Area of samples inside a face; a unit of its own.
  static constexpr double kEdgeArea = 0.01;  ///< Area of samples on edges and corners.

  /** RT-safe. */
  void Add(double area, double depth, const Vec3& nhat, const Vec3& p) noexcept {
    const double weight = area * depth;
    depth_ += weight;
    const Vec3 force = weight * depth * nhat;
    force_ += force;
    torque_ += p.cross(force);
  }

  /** Adds what was summed up in frame S, X_WS = (R, p). RT-safe. */
  void Add(const ContactLayer& in_S, const Mat3& R_WS, const Vec3& p_WS) noexcept {
    const Vec3 force = R_WS * in_S.force_;
    depth_ += in_S.depth_;
    force_ += force;
    torque_ += R_WS * in_S.torque_ + p_WS.cross(force);
  }

  /** The wrench on the held part, torque about p_WQ. Zero when nothing is in contact. RT-safe.
   @param stiffness  K [N/m]. */
  [[nodiscard]] spatial::Wrench CalcWrench(double stiffness, const Vec3& p_WQ) const noexcept;

 private:
  double depth_{0};            // sum(a d)
  Vec3 force_{Vec3::Zero()};   // sum(a d^2 n)
  Vec3 torque_{Vec3::Zero()};  // sum(a d^2 p x n)
};

/** Wrench and stiffness of springs at given contacts. Vectors are (rotation, translation). */
struct PooledWrench {
  spatial::Wrench F_W;   ///< Wrench on the held part, torque about p_WQ.
  Mat6 K{Mat6::Zero()};  ///< -dF/dx for x = (rotation vector about p_WQ, translation of it), W.
};

/** Sums springs of stiffness k at those contacts that are penetrated, with J = (p - p_WQ) x n above
 n and depth d:

     F = k sum(d J),   K = k sum(J J^T)

 K is symmetric and positive semidefinite. It leaves out the terms of the force itself, by which
 normals and lever arms turn: those are smaller by the ratio of depth to radius or lever arm.
 RT-safe. @param stiffness  k, of each contact [N/m]. */
[[nodiscard]] PooledWrench CalcPooledWrench(std::span<const Contact> contacts, const Vec3& p_WQ,
                                            double stiffness) noexcept;

}  // namespace hvas::contact
