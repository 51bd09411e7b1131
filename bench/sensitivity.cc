// Varies constants of the tick, of the shapes and of the simulated person, each by factors and all
// else as it is, and tells what becomes of an assembly: parts in their place, time, largest true
// force, deepest penetration. Prints Markdown: docs/algorithms/sensitivity.md is its output.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/import.h"
#include "contact/shape_data.h"
#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/side_file.h"
#include "mates/stated_fits.h"
#include "person/simulated_person.h"
#include "simulation/assembly_run.h"
#include "simulation/executors.h"
#include "simulation/model.h"
#include "simulation/test/small_models.h"

namespace hvas {
namespace {

using ModelPtr = std::shared_ptr<const simulation::Model>;
using ProductPtr = std::shared_ptr<product::Product>;

/** All that an assembly is run with and that is varied here. */
struct Setting {
  haptics::TickOptions tick;
  person::PersonOptions person;
  contact::ShapeOptions shape;
  int effort_level{0};  ///< The level of simulation::kEffortLevels.
};

/** A constant, or those that belong together, and how a factor gets to them. */
struct Constant {
  std::string name;
  std::string value;  ///< As it is, with its unit.
  std::function<void(double factor, Setting* setting)> scale;
};

/** What became of the assemblies of one setting, over all seeds. */
struct Outcome {
  int seated{0};
  int parts{0};
  double time{0};      ///< Mean [s].
  double peak{0};      ///< Mean over the seeds of the largest true force [N].
  double deepest{0};   ///< Over all seeds [m].
  std::string reason;  ///< Why the first part that is lost is not in its place.
};

/** Factors by which each constant is multiplied; 1 is the assembly as it is. */
constexpr std::array<double, 4> kFactors{0.5, 0.8, 1.25, 2};

/** The longest assembly of a seed [s] of session time: ten times what the bushing takes. */
constexpr double kLimit = 150;

void Add(std::vector<Constant>* all, const char* name, const char* value,
         std::function<void(double, Setting*)> scale) {
  all->push_back({name, value, std::move(scale)});
}

void AddOfTick(std::vector<Constant>* all) {
  Add(all, "limits of capture", "10 deg, 5 mm, 3 mm, 30 mm", [](double f, Setting* s) {
    mates::CaptureThresholds& capture = s->tick.guidance.capture;
    for (double* limit : {&capture.angle, &capture.axis_distance, &capture.axial_gap,
                          &capture.face_distance, &capture.in_plane_gap}) {
      *limit *= f;
    }
  });
  Add(all, "ramp of guidance", "0.25 s",
      [](double f, Setting* s) { s->tick.guidance.ramp_time *= f; });
  Add(all, "stiffness of guidance", "1e6 N/m, 1e4 N m/rad", [](double f, Setting* s) {
    s->tick.guidance.k_lin *= f;
    s->tick.guidance.k_rot *= f;
  });
  Add(all, "force of guidance", "20 N, 2 N m", [](double f, Setting* s) {
    s->tick.guidance.max_force *= f;
    s->tick.guidance.max_torque *= f;
  });
  Add(all, "distance of seating", "0.15 mm, 0.06 rad", [](double f, Setting* s) {
    s->tick.guidance.seat_distance *= f;
    s->tick.guidance.seat_angle *= f;
  });
  Add(all, "stiffness of the coupling", "1000 N/m, 3 N m/rad", [](double f, Setting* s) {
    s->tick.coupling.k_lin *= f;
    s->tick.coupling.k_rot *= f;
  });
  Add(all, "damping of the coupling", "8 N s/m, 0.02 N m s/rad", [](double f, Setting* s) {
    s->tick.coupling.b_lin *= f;
    s->tick.coupling.b_rot *= f;
  });
  Add(all, "compliance of contacts", "0.5 um/N",
      [](double f, Setting* s) { s->tick.contact.compliance *= f; });
  Add(all, "settling time of contacts", "2 ms",
      [](double f, Setting* s) { s->tick.contact.settling_time *= f; });
  Add(all, "speed of recovery", "20 mm/s",
      [](double f, Setting* s) { s->tick.contact.recovery_speed *= f; });
}

/** @param spacing  [m] @param voxel  [m]: those of the product as it is. */
void AddOfShapes(std::vector<Constant>* all, double spacing, double voxel) {
  all->push_back({"spacing of the point shell", fmt::format("{:.2f} mm", units::ToMm(spacing)),
                  [spacing](double f, Setting* s) { s->shape.point_spacing = f * spacing; }});
  all->push_back({"cell of the distance field", fmt::format("{:.2f} mm", units::ToMm(voxel)),
                  [voxel](double f, Setting* s) { s->shape.voxel = f * voxel; }});
}

void AddOfPerson(std::vector<Constant>* all) {
  Add(all, "stiffness and damping of the arm", "400 N/m, 25 N s/m", [](double f, Setting* s) {
    s->person.stiffness *= f;
    s->person.damping *= f;
  });
  Add(all, "speed of approach", "0.15 m/s",
      [](double f, Setting* s) { s->person.approach_speed *= f; });
  Add(all, "speed of insertion", "40 mm/s",
      [](double f, Setting* s) { s->person.insert_speed *= f; });
  Add(all, "error of aim", "0.7 mm, 0.015 rad", [](double f, Setting* s) {
    s->person.aim_error *= f;
    s->person.aim_error_angle *= f;
  });
  Add(all, "tremor", "0.05 mm", [](double f, Setting* s) { s->person.tremor *= f; });
  Add(all, "first push", "4 N", [](double f, Setting* s) { s->person.first_push *= f; });
  Add(all, "most push", "6.8 N", [](double f, Setting* s) {
    s->person.push_limit *= f;
    s->person.unguided_limit *= f;
  });
}

/** What every assembly of a run has in common. */
struct Common {
  int seeds{8};
  haptics::Condition condition{haptics::Condition::kHybrid};
};

Outcome Assemble(const ModelPtr& model, const Setting& setting, const Common& common) {
  haptics::TickOptions tick = setting.tick;
  tick.condition = common.condition;
  Outcome outcome;
  for (int seed = 1; seed <= common.seeds; ++seed) {
    simulation::Simulation simulation(model, tick);
    simulation.haptics().SetEffortLevel(setting.effort_level);
    person::SimulatedPerson person(setting.person, static_cast<std::uint64_t>(seed),
                                   simulation::StartOfHand(*model));
    simulation::AssemblyRun run(&simulation, &person, nullptr);
    const auto report = simulation::RunLockstep(run.MakeExecution(&person, kLimit));
    double peak = 0;
    for (const simulation::PartResult& part : run.results()) {
      outcome.seated += part.is_seated ? 1 : 0;
      outcome.reason = outcome.reason.empty() ? part.reason : outcome.reason;
      peak = std::max(peak, part.peak_true);
      outcome.deepest = std::max(outcome.deepest, part.deepest);
    }
    outcome.parts += static_cast<int>(model->bodies.size());
    outcome.time += 1e-9 * static_cast<double>(report.session_ns) / common.seeds;
    outcome.peak += peak / common.seeds;
  }
  return outcome;
}

std::string Describe(const Outcome& outcome, const Outcome& usual) {
  const std::string lost = outcome.seated < usual.seated
                               ? fmt::format("**{} lost**, ", usual.seated - outcome.seated)
                               : "";
  return fmt::format("{}{:.1f} s, {:.1f} N, {:.0f} um", lost, outcome.time, outcome.peak,
                     units::ToUm(outcome.deepest));
}

/** A product with its mates, and the fits of its file and of the side file beside it. */
Result<ProductPtr> Load(const std::string& file) {
  Diagnostics diagnostics;
  auto product = cad::Import(file, {}, &diagnostics, {});
  if (!product) {
    return Unexpected(product.error());
  }
  mates::Infer(&*product, &diagnostics);
  const std::filesystem::path side_file = mates::FindAssignmentFile(file);
  if (!std::filesystem::exists(side_file)) {
    mates::AssignStatedFits(&*product);
  } else if (const auto applied = mates::ApplyAssignments(side_file, &*product); !applied) {
    return Unexpected(applied.error());
  }
  return std::make_shared<product::Product>(std::move(*product));
}

Result<ModelPtr> Compile(const ProductPtr& product, const contact::ShapeOptions& shape) {
  simulation::CompileOptions options;
  options.shape = shape;
  Diagnostics diagnostics;
  return simulation::Compile(product, options, &diagnostics);
}

/** All that is varied for a product, whose shapes have the finest of what its parts were given. */
std::vector<Constant> MakeConstants(const simulation::Model& model) {
  double voxel = std::numeric_limits<double>::infinity();
  double spacing = voxel;
  for (const simulation::Body& body : model.bodies) {
    voxel = std::min(voxel, body.shape->voxel());
    spacing = std::min(spacing, body.shape->data().spacing);
  }
  std::vector<Constant> constants;
  AddOfTick(&constants);
  AddOfShapes(&constants, spacing, voxel);
  AddOfPerson(&constants);
  return constants;
}

/** Prints the table of one product, row by row. */
class Table {
 public:
  Table(ProductPtr product, ModelPtr model, const Common& common)
      : product_(std::move(product)),
        model_(std::move(model)),
        common_(common),
        usual_(Assemble(model_, {}, common)) {}

  void PrintHead(const std::string& name) const {
    fmt::print("### {}\n\nAs it is, {} seeds: {} of {} parts, {}.\n\n", name, common_.seeds,
               usual_.seated, usual_.parts, Describe(usual_, usual_));
    fmt::print("| constant | as it is |");
    for (const double factor : kFactors) {
      fmt::print(" x {:g} |", factor);
    }
    fmt::print("\n|---|---|---|---|---|---|\n");
  }

  Result<void> PrintRow(const Constant& constant) {
    fmt::print("| {} | {} |", constant.name, constant.value);
    for (const double factor : kFactors) {
      Setting setting;
      constant.scale(factor, &setting);
      const bool is_shaped = setting.shape.voxel > 0 || setting.shape.point_spacing > 0;
      const Result<ModelPtr> model = is_shaped ? Compile(product_, setting.shape) : model_;
      if (!model) {
        return Unexpected(model.error());
      }
      PrintCell(Assemble(*model, setting, common_),
                fmt::format("{} x {:g}", constant.name, factor));
    }
    fmt::print("\n");
    std::fflush(stdout);
    return {};
  }

  /** What a tick does when it is short of time, level by level. */
  void PrintEfforts() {
    fmt::print("| iterations, points of a tick | 30, 4096 |");
    for (std::size_t level = 0; level < simulation::kEffortLevels.size(); ++level) {
      Setting setting;
      setting.effort_level = static_cast<int>(level);
      const haptics::Effort& effort = simulation::kEffortLevels[level];
      fmt::print(" {}, {}:", effort.iterations, effort.point_budget);
      PrintCell(Assemble(model_, setting, common_), fmt::format("level {}", level));
    }
    fmt::print("\n\n");
  }

  /** Why parts are lost. */
  void PrintReasons() const {
    for (const std::string& reason : reasons_) {
      fmt::print("- {}\n", reason);
    }
    fmt::print("\n");
  }

 private:
  void PrintCell(const Outcome& outcome, const std::string& what) {
    fmt::print(" {} |", Describe(outcome, usual_));
    if (outcome.seated < usual_.seated) {
      reasons_.push_back(fmt::format("{}: {}", what, outcome.reason));
    }
  }

  ProductPtr product_;
  ModelPtr model_;
  Common common_;
  Outcome usual_;
  std::vector<std::string> reasons_;
};

Result<void> Study(const std::string& name, const ProductPtr& product, const Common& common) {
  const auto model = Compile(product, {});
  if (!model) {
    return Unexpected(model.error());
  }
  Table table(product, *model, common);
  table.PrintHead(name);
  for (const Constant& constant : MakeConstants(**model)) {
    if (const auto printed = table.PrintRow(constant); !printed) {
      return printed;
    }
  }
  table.PrintEfforts();
  table.PrintReasons();
  return {};
}

Result<void> Run(const std::vector<std::string>& files, const Common& common) {
  auto peg = std::make_shared<product::Product>(simulation::testing::PegInBlock());
  if (const auto studied = Study("Peg in a block", peg, common); !studied) {
    return studied;
  }
  for (const std::string& file : files) {
    const auto product = Load(file);
    if (!product) {
      return Unexpected(product.error());
    }
    const auto studied = Study(file, *product, common);
    if (!studied) {
      return studied;
    }
  }
  return {};
}

}  // namespace
}  // namespace hvas

int main(int argc, char** argv) {
  CLI::App app("Varies constants, and tells what becomes of an assembly");
  std::vector<std::string> files;
  hvas::Common common;
  const std::map<std::string, hvas::haptics::Condition> conditions{
      {"collision", hvas::haptics::Condition::kCollision},
      {"constraint", hvas::haptics::Condition::kConstraint},
      {"hybrid", hvas::haptics::Condition::kHybrid}};
  app.add_option("file", files, "CAD files of products, besides a peg in a block");
  app.add_option("--seeds", common.seeds, "Assemblies of each setting")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--condition", common.condition, "What guides and stops a part: hybrid without")
      ->transform(CLI::CheckedTransformer(conditions));
  CLI11_PARSE(app, argc, argv);
  if (const auto done = hvas::Run(files, common); !done) {
    fmt::print(stderr, "{}\n", done.error().ToString());
    return 1;
  }
  return 0;
}
