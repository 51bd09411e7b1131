#include "statics/test/blocks.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace hvas::statics::testing {

void AddRectangle(StaticProblem* problem, int a, int b, double x_low, double x_high, double y_low,
                  double y_high, double z, double friction) {
  for (const double x : {x_low, x_high}) {
    for (const double y : {y_low, y_high}) {
      problem->contacts.push_back({a, b, Vec3(x, y, z), Vec3::UnitZ(), friction});
    }
  }
}

StaticProblem MakeRandom(std::uint32_t seed, int body_count) {
  Random random(seed);
  const auto draw = [&random](double low, double high) { return random.Uniform(low, high); };
  const auto draw_point = [&draw](double size) {
    const double x = draw(-size, size);  // In this order with each compiler.
    const double y = draw(-size, size);
    return Vec3(x, y, draw(-size, size));
  };
  const auto draw_body = [&](int lowest) {
    return static_cast<int>(std::floor(draw(lowest, body_count)));
  };
  StaticProblem problem;
  for (int i = 0; i < body_count; ++i) {
    problem.bodies.push_back({std::pow(10, draw(-2, 1)), draw_point(0.1)});
  }
  for (int i = 0; i < 8 * body_count; ++i) {
    const int a = draw_body(0);
    const int b = draw_body(-1);
    if (a != b) {
      const Vec3 p_W = problem.bodies[static_cast<std::size_t>(a)].p_WC + draw_point(0.1);
      const Vec3 nhat_W = (draw_point(1) + Vec3(0, 0, b < a ? 1.5 : -1.5)).normalized();
      problem.contacts.push_back({a, b, p_W, nhat_W, draw(0, 0.6)});
    }
  }
  if (draw(0, 1) < 0.5 && body_count > 1) {
    problem.joints.push_back({0, draw(0, 1) < 0.5 ? 1 : kGround, draw_point(0.1),
                              draw_point(1).normalized(), draw(0, 5), draw(0, 0.1)});
  }
  return problem;
}

Proof CalcProof(const StaticProblem& problem, const std::vector<spatial::Twist>& motions_W) {
  const auto velocity = [&](int body, const Vec3& p_W) -> Vec3 {
    if (body == kGround) {
      return Vec3::Zero();
    }
    const auto i = static_cast<std::size_t>(body);
    return motions_W[i].v + motions_W[i].w.cross(p_W - problem.bodies[i].p_WC);
  };
  const auto turning = [&](int body) -> Vec3 {
    return body == kGround ? Vec3::Zero() : motions_W[static_cast<std::size_t>(body)].w;
  };
  Proof proof;
  double gravity = 0;
  double power = 0;
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const double body = problem.bodies[i].mass * problem.g_W.dot(motions_W[i].v);
    power += body;
    gravity += std::abs(body);
  }
  double fastest = 0;
  for (const StaticContact& contact : problem.contacts) {
    for (const int body : {contact.a, contact.b}) {
      if (body != kGround) {
        const auto i = static_cast<std::size_t>(body);
        fastest = std::max(
            fastest, motions_W[i].v.norm() +
                         motions_W[i].w.norm() * (contact.p_W - problem.bodies[i].p_WC).norm());
      }
    }
  }
  for (const StaticContact& contact : problem.contacts) {
    const Vec3 v_W = velocity(contact.a, contact.p_W) - velocity(contact.b, contact.p_W);
    for (const Vec3& edge_W : ListPyramidEdges(contact, problem.g_W)) {
      proof.worst_contact = std::min(proof.worst_contact, v_W.dot(edge_W) / fastest);
    }
  }
  for (const StaticJoint& joint : problem.joints) {
    const Vec3 v_W = velocity(joint.a, joint.p_W) - velocity(joint.b, joint.p_W);
    const Vec3 w_W = turning(joint.a) - turning(joint.b);
    const double along = v_W.dot(joint.axis_W);
    const double about = w_W.dot(joint.axis_W);
    power -= std::isfinite(joint.pull_out) ? joint.pull_out * std::abs(along) : 0;
    power -= std::isfinite(joint.torque) ? joint.torque * std::abs(about) : 0;
    // Without a limit, and in the other directions, the joint does not move at all.
    double forbidden = (v_W - along * joint.axis_W).norm();
    forbidden += std::isfinite(joint.pull_out) ? 0 : std::abs(along);
    proof.worst_contact =
        std::min(proof.worst_contact, -forbidden / std::max(fastest, v_W.norm() + 1e-300));
  }
  proof.power = gravity > 0 ? power / gravity : 0;
  return proof;
}

}  // namespace hvas::statics::testing
