// Puts a part in with a hand of one's own: a policy of a few lines that leads the part along its
// way in and presses on while it sticks. It runs tick by tick, faster than real time:
//
//   own_hand FILE
#include <algorithm>
#include <cstdio>
#include <utility>

#include <hvas/hvas.h>

namespace {

int Fail(const hvas::Error& error) {
  std::fprintf(stderr, "%s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FILE\n", argv[0]);
    return 1;
  }
  hvas::Diagnostics diagnostics;
  hvas::assembly::OpenOptions open;
  open.file = argv[1];
  auto product = hvas::assembly::OpenProduct(open, &diagnostics);
  if (!product) {
    return Fail(product.error());
  }
  const auto model = hvas::assembly::PrepareModel(*std::move(product), {}, &diagnostics);
  if (!model) {
    return Fail(model.error());
  }

  // The second step of the sequence; the part begins 10 mm beyond where it engages.
  hvas::assembly::SteppedOptions options;
  if (options.step >= (*model)->sequence.steps.size()) {
    std::fprintf(stderr, "%s: there is no second part to put in\n", argv[1]);
    return 1;
  }
  const hvas::sequence::SequenceStep& step = (*model)->sequence.steps[options.step];
  const hvas::spatial::Pose& goal = (*model)->bodies[step.occurrence.index()].X_WB_goal;
  double travel = step.engage_distance + 10e-3;
  const auto at = [&](double s) {
    return hvas::spatial::Pose(goal.q(), goal.p() + s * step.extraction_W);
  };
  options.X_WB_start = at(travel);
  const auto run = hvas::assembly::SteppedRun::Create(*model, options);
  if (!run) {
    return Fail(run.error());
  }

  constexpr double kSpeed = 0.04;      // [m/s]
  constexpr double kMostLead = 15e-3;  // How far the hand goes ahead of a part that sticks [m].
  constexpr double kLimit_s = 30;
  hvas::simulation::HandReference hand;
  hand.is_gripping = true;
  while (!(*run)->is_seated() && (*run)->last().t_s < kLimit_s) {
    const double* p = (*run)->last().X_WB;
    const double there = (hvas::Vec3(p[0], p[1], p[2]) - goal.p()).dot(step.extraction_W);
    travel = std::max(travel - kSpeed * 10e-3, there - kMostLead);
    hand.X_WR = at(travel) * (*run)->X_HB().Inverse();
    (*run)->Step(hand, 10);  // 10 ms
  }
  const char* name = (*model)->product->occurrences[step.occurrence.index()].name.c_str();
  std::printf("%s is %s after %.2f s\n", name,
              (*run)->is_seated() ? "in its place" : "NOT in its place", (*run)->last().t_s);
  return (*run)->is_seated() ? 0 : 2;
}
