/** Which walls does a loop render without trembling? For five devices, three hands, and a grid of
 stiffness and damping: with the coupling alone, and with the passivity controller.

   zwidth_bench [--csv FILE]

 prints a map of each device (# stable both ways, + only with the controller, - only without,
 . neither) and the largest stable stiffness. */
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "device/profile.h"
#include "haptics/coupling_rule.h"
#include "haptics/test/wall_rig.h"

namespace {

using namespace hvas;  // NOLINT: a program of its own.
using haptics::testing::Grip;
using haptics::testing::kGrips;

constexpr const char* kProfiles[] = {"touch", "touch_x", "sigma7", "inverse3", "virtuose"};
constexpr double kStiffness[] = {0.125, 0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24};
constexpr double kDamping[] = {0, 0.25, 0.5, 1, 1.5};

struct Cell {
  bool plain;
  bool controlled;
};

/** By damping, then stiffness. */
using Map = std::vector<std::vector<Cell>>;

Map Sweep(const device::DeviceProfile& profile, const Grip& grip) {
  Map map;
  for (const double b : kDamping) {
    std::vector<Cell> row;
    for (const double k : kStiffness) {
      const auto press = [&](bool is_controlled) {
        return haptics::testing::Press(profile, grip, k * profile.max_stiffness,
                                       b * profile.max_damping, is_controlled)
            .is_stable();
      };
      row.push_back({press(false), press(true)});
    }
    map.push_back(row);
  }
  return map;
}

/** Up to where all are stable, of the rows' best. */
double FindLargest(const Map& map, bool Cell::*is_stable) {
  double largest = 0;
  for (const auto& row : map) {
    for (std::size_t i = 0; i < row.size() && row[i].*is_stable; ++i) {
      largest = std::max(largest, kStiffness[i]);
    }
  }
  return largest;
}

void Print(const Map& map, const device::DeviceProfile& profile) {
  for (std::size_t j = map.size(); j-- > 0;) {
    fmt::print("    B {:6.1f} |", kDamping[j] * profile.max_damping);
    for (const Cell& cell : map[j]) {
      fmt::print(" {}", cell.plain ? (cell.controlled ? '#' : '-') : (cell.controlled ? '+' : '.'));
    }
    fmt::print("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Stable walls by device, hand, stiffness and damping");
  std::string csv;
  app.add_option("--csv", csv, "All cells as a table");
  CLI11_PARSE(app, argc, argv);
  std::FILE* file = csv.empty() ? nullptr : std::fopen(csv.c_str(), "w");
  if (!csv.empty() && file == nullptr) {
    fmt::print(stderr, "{}: cannot be written\n", csv);
    return 1;
  }
  if (file != nullptr) {
    fmt::print(file, "device,hand,k_n_per_m,b_ns_per_m,stable_plain,stable_controlled\n");
  }
  for (const char* id : kProfiles) {
    const device::DeviceProfile& profile = device::FindProfile(id)->profile;
    const auto chosen = haptics::ChooseCoupling(profile, 1, 1 / profile.rate_hz);
    fmt::print("{}: K up to {:.0f} N/m by steps, chosen K {:.0f} N/m, B {:.2f} N s/m\n", id,
               kStiffness[std::size(kStiffness) - 1] * profile.max_stiffness, chosen.k_lin,
               chosen.b_lin);
    for (const Grip& grip : kGrips) {
      const Map map = Sweep(profile, grip);
      fmt::print("  {} hand: largest stable K {:.0f} N/m plain, {:.0f} N/m with the controller\n",
                 grip.name, profile.max_stiffness * FindLargest(map, &Cell::plain),
                 profile.max_stiffness * FindLargest(map, &Cell::controlled));
      Print(map, profile);
      for (std::size_t j = 0; file != nullptr && j < map.size(); ++j) {
        for (std::size_t i = 0; i < map[j].size(); ++i) {
          fmt::print(file, "{},{},{},{},{:d},{:d}\n", id, grip.name,
                     kStiffness[i] * profile.max_stiffness, kDamping[j] * profile.max_damping,
                     map[j][i].plain, map[j][i].controlled);
        }
      }
    }
  }
  if (file != nullptr) {
    std::fclose(file);
  }
  return 0;
}
