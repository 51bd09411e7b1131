/** Statics of the states of assembly of products: for each prefix of the order of assembly, whether
 the parts stand, what falls, and the fewest to hold; with the times of contacts and programmes.

   statics_bench [--states] [--loose] [--over | --aside] FILE...

 A line for each product; with --states, for each state too; with --loose, no screw is tight; with
 --over, gravity is along +z, with --aside along +x.
 */
#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "load_model.h"
#include "orders/state_statics.h"

namespace {

using hvas::product::OccurrenceId;
using hvas::sequence::SequenceStep;

double CalcSeconds(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::string ListNames(const hvas::simulation::Model& model, const std::vector<OccurrenceId>& ids) {
  std::string names;
  for (const OccurrenceId id : ids) {
    names += (names.empty() ? "" : ", ") + model.product->occurrences[id.index()].name;
  }
  return names;
}

bool Measure(const std::string& file, bool has_states,
             const hvas::orders::StateStaticsOptions& options) {
  const auto loaded = hvas::bench::LoadModel(file);
  if (!loaded) {
    fmt::print(stderr, "{}\n", loaded.error().ToString());
    return false;
  }
  const hvas::simulation::Model& model = **loaded;
  auto begin = std::chrono::steady_clock::now();
  const hvas::orders::StateStatics statics(model);
  const double contact_time = CalcSeconds(begin);
  std::vector<bool> is_in_place(model.bodies.size(), false);
  int states = 0;
  int standing = 0;
  int unproven = 0;
  std::size_t contacts = 0;
  std::size_t most_holds = 0;
  double longest = 0;
  double total = 0;
  for (const SequenceStep& step : model.sequence.steps) {
    is_in_place[step.occurrence.index()] = true;
    for (const OccurrenceId id : step.members) {
      is_in_place[id.index()] = true;
    }
    begin = std::chrono::steady_clock::now();
    const auto found = statics.CalcStability(is_in_place, options);
    const double time = CalcSeconds(begin);
    if (!found) {
      fmt::print(stderr, "{}\n", found.error().ToString());
      return false;
    }
    ++states;
    standing += found->stands ? 1 : 0;
    unproven += found->is_least_proven ? 0 : 1;
    contacts = std::max(contacts, found->contact_count);
    most_holds = std::max(most_holds, found->holds.size());
    longest = std::max(longest, time);
    total += time;
    if (has_states) {
      fmt::print("  {:40} {:5.1f} ms  falls: {}  hold: {}\n",
                 model.product->occurrences[step.occurrence.index()].name, time * 1e3,
                 ListNames(model, found->moving), ListNames(model, found->holds));
    }
  }
  fmt::print(
      "{}: {} parts, {} contacts; contacts found in {:.0f} ms; {} states, {} stand, {} without a "
      "proof "
      "of the fewest holds, at most {} holds; mean {:.1f} ms, longest {:.1f} ms\n",
      file, model.bodies.size(), contacts, contact_time * 1e3, states, standing, unproven,
      most_holds, total * 1e3 / std::max(1, states), longest * 1e3);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  bool has_states = false;
  bool is_good = true;
  hvas::orders::StateStaticsOptions options;
  for (const std::string& argument : arguments) {
    if (argument == "--states") {
      has_states = true;
    } else if (argument == "--loose") {
      options.are_screws_tight = false;
    } else if (argument == "--over") {
      options.ghat_W = hvas::Vec3::UnitZ();
    } else if (argument == "--aside") {
      options.ghat_W = hvas::Vec3::UnitX();
    } else {
      is_good = Measure(argument, has_states, options) && is_good;
    }
  }
  return is_good ? 0 : 1;
}
