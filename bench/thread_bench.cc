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

#include "base/file_cache.h"
#include "base/units.h"
#include "cad/import.h"
#include "haptics/test/turned_nut.h"
#include "simulation/shapes.h"

namespace {

using hvas::Vec3;
using hvas::spatial::Pose;

constexpr hvas::haptics::testing::TurnedNut kTurned{.turns = 5, .rate = 1};
constexpr double kStart = 6;  // Turns above where it is drawn, at the bolt's head.

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
  const auto down = hvas::haptics::testing::Turn(kTurned, -1, &rig, &times_us);
  const auto up = hvas::haptics::testing::Turn(kTurned, 1, &rig, &times_us);
  const auto off = [pitch](const hvas::haptics::testing::NutLeg& leg) {
    return 100 * (leg.advanced / leg.turns / pitch - 1);
  };
  fmt::print(
      "{:10} turns {:.2f} down, {:.2f} up; advance off by {:+.2f} %, {:+.2f} %; deepest {:.1f} um; "
      "tick "
      "median {:.0f}, p99 {:.0f}, p99.9 {:.0f}, max {:.0f} us\n",
      size, -down.turns, up.turns, off(down), off(up),
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
