#pragma once

#include <cstdint>
#include <vector>

#include "statics/problem.h"

/** Problems made of blocks, for tests. */
namespace hvas::statics::testing {

/** Adds the corners of a horizontal rectangle as contacts by which b carries a. */
void AddRectangle(StaticProblem* problem, int a, int b, double x_low, double x_high, double y_low,
                  double y_high, double z, double friction);

/** Bodies at random places with random contacts, and some joints. */
[[nodiscard]] StaticProblem MakeRandom(std::uint32_t seed, int body_count);

/** What a virtual motion proves, calculated from the definition alone. */
struct Proof {
  /** Least power of any edge of a contact's pyramid, per speed of the points that meet and per
   length of the edge: not below zero up to rounding where the proof is right. */
  double worst_contact{0};
  double power{0};  ///< Power of gravity less what joints take, per that of gravity: above zero.
};

[[nodiscard]] Proof CalcProof(const StaticProblem& problem,
                              const std::vector<spatial::Twist>& motions_W);

}  // namespace hvas::statics::testing
