/** A peg of 20 mm that an arm's spring leads into its bore with 0.1 mm of clearance, at steps of 1
 ms: this library in C++ and in Python, and MuJoCo on what `hvas export` writes of the same product.
 How many times faster than real time each is, and how deep contacts get.

   step_bench PRODUCTS PYTHON SCRIPT [SECONDS]  */
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "assembly/stepped_run.h"
#include "base/scratch_folder.h"
#include "exchange/mjcf.h"

namespace {

using namespace hvas;  // NOLINT: a program, not a header.

constexpr double kClearance_mm = 0.1;
constexpr double kSpeed = 25e-3;    // [m/s]
constexpr double kAbove = 46e-3;    // [m]
constexpr double kBeside = 1e-3;    // How far beside its axis, so that it rubs at its bore [m].
constexpr double kBelow = 5e-3;     // How far below its place the peg is led [m].
constexpr double kTouching = 0.4;   // When it is led beside the axis: it is in its bore [s].
constexpr double kStiffness = 400;  // Of the arm [N/m].
constexpr double kDamping = 25;     // [N s/m]

double CpuSeconds() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/** Where the peg is led to, above its place, at a time [m]. */
double LedAbove(double t) {
  return std::max(-kBelow, kAbove - kSpeed * t);
}

struct Figure {
  double times_real_time{0};
  double deepest_um{0};
  double left_mm{0};  ///< Distance from its place at the end.
};

void Print(const char* what, const Figure& figure) {
  std::printf("%-24s %8.1f x real time, deepest contact %7.2f um, %6.3f mm from its place\n", what,
              figure.times_real_time, figure.deepest_um, figure.left_mm);
}

product::Product OpenPeg(const std::filesystem::path& products) {
  const ScratchFolder folder = ScratchFolder::Make().value();
  std::filesystem::copy_file(products / "peg_hole.step", folder.path() / "peg_hole.step");
  std::ofstream(folder.path() / "peg_hole.hvas.json") << fmt::format(
      R"({{"format": "hvas-assignments-1", "fits": [{{"hole": "block", "shaft": "peg",
        "hole_diameter_mm": {}, "shaft_diameter_mm": 20}}]}})",
      20 + kClearance_mm);
  Diagnostics diagnostics;
  assembly::OpenOptions options;
  options.file = folder.path() / "peg_hole.step";
  return assembly::OpenProduct(options, &diagnostics).value();
}

Figure RunOurs(const product::Product& product, double seconds) {
  Diagnostics diagnostics;
  const auto model = assembly::PrepareModel(product, {}, &diagnostics).value();
  assembly::SteppedOptions options;
  const spatial::Pose goal = model->bodies[1].X_WB_goal;
  const auto led = [&](double t) {
    return spatial::Pose(goal.q(), goal.p() + Vec3(t > kTouching ? kBeside : 0, 0, LedAbove(t)));
  };
  options.X_WB_start = led(0);
  options.contact_in_holes = true;
  const auto run = assembly::SteppedRun::Create(model, options).value();
  person::HandReference hand;
  hand.is_gripping = true;
  Figure figure;
  const double start = CpuSeconds();
  const double begin = run->last().t_s;
  while (run->last().t_s - begin < seconds) {
    hand.X_WR = led(run->last().t_s - begin) * run->X_HB().Inverse();
    for (const assembly::TickRow& row : run->Step(hand, 10)) {
      figure.deepest_um = std::max(figure.deepest_um, -1e6 * row.deepest);
    }
  }
  figure.times_real_time = seconds / (CpuSeconds() - start);
  figure.left_mm = 1e3 * (run->last().X_WB[2] - goal.p().z());
  return figure;
}

Figure RunMuJoCo(const product::Product& product, double seconds) {
  const ScratchFolder folder = ScratchFolder::Make().value();
  const exchange::ExportedProduct exported = exchange::MakeExported(product);
  const std::filesystem::path file = folder.path() / "peg.xml";
  std::ofstream(file) << exchange::MakeMjcf(exported);
  std::array<char, 1000> error{};
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
      mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())),
      mj_deleteModel);
  if (model == nullptr) {
    std::fprintf(stderr, "%s\n", error.data());
    std::exit(1);
  }
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  const int body = mj_name2id(model.get(), mjOBJ_BODY, exported.bodies[1].name.c_str());
  const int joint = model->body_jntadr[body];
  mjtNum* q = data->qpos + model->jnt_qposadr[joint];
  mjtNum* v = data->qvel + model->jnt_dofadr[joint];
  const Vec3 goal = product.occurrences[1].X_WB.p();
  q[2] = goal.z() + LedAbove(0);
  Figure figure;
  const double start = CpuSeconds();
  while (data->time < seconds) {
    mjtNum* f = data->xfrc_applied + 6 * body;
    const std::array<double, 3> led{goal.x() + (data->time > kTouching ? kBeside : 0), goal.y(),
                                    goal.z() + LedAbove(data->time)};
    for (std::size_t k = 0; k < 3; ++k) {
      f[k] = kStiffness * (led[k] - q[k]) - kDamping * v[k];
    }
    mj_step(model.get(), data.get());
    for (int i = 0; i < data->ncon; ++i) {
      figure.deepest_um = std::max(figure.deepest_um, -1e6 * data->contact[i].dist);
    }
  }
  figure.times_real_time = seconds / (CpuSeconds() - start);
  figure.left_mm = 1e3 * (q[2] - goal.z());
  return figure;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: %s PRODUCTS PYTHON SCRIPT [SECONDS]\n", argv[0]);
    return 1;
  }
  const double seconds = argc == 5 ? std::atof(argv[4]) : 1.8;
  const product::Product product = OpenPeg(argv[1]);
  Print("hvas, C++", RunOurs(product, seconds));
  std::fflush(stdout);
  const std::string command = fmt::format("'{}' '{}' {}", argv[2], argv[3], seconds);
  if (std::system(command.c_str()) != 0) {
    return 1;
  }
  Print("MuJoCo on the export", RunMuJoCo(product, seconds));
  return 0;
}
