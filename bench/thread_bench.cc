/** A nut with modelled helices on its bolt in a scripted hand, by contact alone: five turns down
 and five up at one turn a second, pressed with 2 N. Advance of a turn, depth of contact and
 processor time of the tick, for each pair in a folder that has Factory's meshes
 (factory_nut_SIZE_subdiv_3x.obj and factory_bolt_SIZE.obj, in metres).

     thread_bench FOLDER SIZE=PITCH_MM...      thread_bench factory m8_loose=1.25 m16_tight=2
 */
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/file_cache.h"
#include "base/units.h"
#include "cad/import.h"
#include "haptics/test/rig.h"
#include "simulation/shapes.h"

namespace {

using hvas::Vec3;
using hvas::spatial::Pose;

constexpr double kTurns = 5;     // After the play is taken up.
constexpr double kStart = 6;     // Turns above where it is drawn, at the bolt's head.
constexpr double kRate = 1;      // [turns/s]
constexpr double kPush = 2e-3;   // How far the hand is ahead along the axis [m]: 2 N.
constexpr double kRunIn = 0.25;  // [turns] until the play is taken up.

std::shared_ptr<const hvas::contact::Shape> Load(const std::filesystem::path& file) {
  hvas::Diagnostics diagnostics;
  hvas::cad::ImportOptions options;
  options.length_unit = 1.0;
  hvas::cad::ImportControl control;
  control.cache_directory = hvas::FileCache::DefaultDirectory();
  const auto product = hvas::cad::Import(file, options, &diagnostics, control);
  if (!product || product->parts.empty()) {
    fmt::print(stderr, "{}: not read\n", file.string());
    std::exit(1);
  }
  hvas::simulation::ShapesControl shapes;
  return hvas::simulation::BuildShapes(*product, shapes).value().front();
}

double Quantile(std::vector<double> values, double q) {
  const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

struct Leg {
  double turned{0}, advanced{0};  // After the play is taken up [rad, m].
};

/** Turns the nut and presses the way it goes; the hand follows it along the axis. */
Leg Run(double sense, hvas::haptics::testing::HeldRig* rig, std::vector<double>* times_us) {
  using hvas::haptics::testing::kDt;
  const double rate = sense * kRate * hvas::units::kTurn;
  const int ticks = static_cast<int>(std::lround((kRunIn + kTurns) / kRate / kDt));
  const int run_in = static_cast<int>(std::lround(kRunIn / kRate / kDt));
  const Vec3 centre_B = rig->part.p_BoBcm_B;
  Leg leg;
  double angle = 0;
  double z_start = 0;
  hvas::Quat q_before = rig->hand->last().X_WD.q();
  for (int i = 0; i < ticks; ++i) {
    const double z = (rig->hand->last().X_WD * centre_B).z() + sense * kPush;
    const std::int64_t begin_ns = hvas::ThreadCpuNs();
    rig->hand->LeadTo(Vec3(0, 0, z), Vec3(0, 0, rate));
    times_us->push_back(1e-3 * static_cast<double>(hvas::ThreadCpuNs() - begin_ns));
    const hvas::Quat q = rig->hand->last().X_WD.q();
    if (i >= run_in) {
      angle += hvas::spatial::RotationBetween(q_before, q).z();
    } else {
      z_start = rig->hand->last().X_WD.p().z();
    }
    q_before = q;
  }
  leg.turned = angle;
  leg.advanced = rig->hand->last().X_WD.p().z() - z_start;
  return leg;
}

void Measure(const std::filesystem::path& folder, const std::string& size, double pitch) {
  hvas::haptics::TickOptions options;
  options.condition = hvas::haptics::Condition::kCollision;
  options.gravity_W.setZero();
  hvas::haptics::testing::HeldRig rig(options);
  const auto bolt = Load(folder / ("factory_bolt_" + size + ".obj"));
  const auto nut = Load(folder / ("factory_nut_" + size + "_subdiv_3x.obj"));
  rig.scene.Add(bolt, Pose());
  rig.Place(nut, Pose(Vec3(0, 0, kStart * pitch)));
  rig.part.mass = 0.02;
  rig.part.I_BBcm_B = 1e-6 * hvas::Mat3::Identity();
  rig.part.X_WB_goal = Pose(Vec3(1, 1, 1));
  rig.Take();
  rig.hand->Wait(0.3);
  std::vector<double> times_us;
  const Leg down = Run(-1, &rig, &times_us);
  const Leg up = Run(1, &rig, &times_us);
  const auto off = [pitch](const Leg& leg) {
    return 100 * (leg.advanced / (leg.turned / hvas::units::kTurn) / pitch - 1);
  };
  fmt::print(
      "{:10} turns {:.2f} down, {:.2f} up; advance off by {:+.2f} %, {:+.2f} %; deepest {:.1f} um; "
      "tick "
      "median {:.0f}, p99 {:.0f}, p99.9 {:.0f}, max {:.0f} us\n",
      size, -down.turned / hvas::units::kTurn, up.turned / hvas::units::kTurn, off(down), off(up),
      1e6 * hvas::haptics::testing::CalcDeepest(rig.hand->samples), Quantile(times_us, 0.5),
      Quantile(times_us, 0.99), Quantile(times_us, 0.999), Quantile(times_us, 1));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: thread_bench FOLDER SIZE=PITCH_MM...\n");
    return 2;
  }
  for (int i = 2; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t sign = argument.find('=');
    if (sign == std::string::npos) {
      fmt::print(stderr, "{}: say SIZE=PITCH_MM\n", argument);
      return 2;
    }
    Measure(argv[1], argument.substr(0, sign),
            hvas::units::FromMm(std::atof(argument.c_str() + sign + 1)));
  }
  return 0;
}
