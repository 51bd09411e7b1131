#include "statics/equilibrium.h"

#include <cstddef>

#include "statics/programme.h"

namespace hvas::statics {

Result<Equilibrium> SolveEquilibrium(const StaticProblem& problem, const StaticOptions& options) {
  if (auto checked = CheckProblem(problem); !checked) {
    return Unexpected(checked.error());
  }
  Programme programme(problem, options);
  return programme.Solve(std::vector<bool>(problem.bodies.size(), false));
}

std::vector<spatial::Wrench> CalcResultants(const StaticProblem& problem,
                                            const Equilibrium& equilibrium) {
  std::vector<spatial::Wrench> resultants(problem.bodies.size());
  const auto apply = [&](int body, const Vec3& p_W, const Vec3& f_W, const Vec3& t_W) {
    if (body != kGround) {
      const auto i = static_cast<std::size_t>(body);
      resultants[i] += {(p_W - problem.bodies[i].p_WC).cross(f_W) + t_W, f_W};
    }
  };
  for (std::size_t i = 0; i < resultants.size(); ++i) {
    resultants[i].f = problem.bodies[i].mass * problem.g_W;
    resultants[i] += equilibrium.hold_wrenches_W[i];
  }
  for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
    const StaticContact& contact = problem.contacts[i];
    const Vec3& f_W = equilibrium.contact_forces_W[i];
    apply(contact.a, contact.p_W, f_W, Vec3::Zero());
    apply(contact.b, contact.p_W, -f_W, Vec3::Zero());
  }
  for (std::size_t i = 0; i < problem.joints.size(); ++i) {
    const StaticJoint& joint = problem.joints[i];
    const spatial::Wrench& wrench = equilibrium.joint_wrenches_W[i];
    apply(joint.a, joint.p_W, wrench.f, wrench.t);
    apply(joint.b, joint.p_W, -wrench.f, -wrench.t);
  }
  return resultants;
}

}  // namespace hvas::statics
