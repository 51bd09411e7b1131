#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "arguments.h"
#include "bindings.h"
#include "evidence/picture.h"
#include "person/simulated_person.h"

namespace hvas::python {
namespace {

using assembly::ContactRow;
using assembly::SteppedRun;
using assembly::TickRow;
using simulation::Model;
using ModelPtr = std::shared_ptr<const Model>;

haptics::Condition ToCondition(const std::string& name) {
  if (name == "collision") {
    return haptics::Condition::kCollision;
  }
  if (name == "constraint") {
    return haptics::Condition::kConstraint;
  }
  if (name == "hybrid") {
    return haptics::Condition::kHybrid;
  }
  throw py::value_error("a condition is 'collision', 'constraint' or 'hybrid', not '" + name + "'");
}

const std::string& PathOf(const Model& model, product::OccurrenceId id) {
  return model.product->occurrences[id.index()].path;
}

// Python holds models behind a class of its own, as pybind11 has no holder of const objects.
struct ModelHandle {
  ModelPtr model;
  std::vector<Diagnostic> diagnostics;
};

py::object Describe(const sequence::SequenceStep& step, const Model& model, std::size_t index) {
  static constexpr const char* kNames[] = {"base", "insert", "park", "remove", "aside", "return"};
  py::list members;
  for (const product::OccurrenceId id : step.members) {
    members.append(id.index());
  }
  const spatial::Pose goal =
      sequence::GoalOf(step, model.bodies[step.occurrence.index()].X_WB_goal);
  return MakeDataclass(
      "Step",
      py::dict(py::arg("index") = index,
               py::arg("kind") = kNames[static_cast<std::size_t>(step.kind)],
               py::arg("occurrence") = step.occurrence.index(),
               py::arg("path") = PathOf(model, step.occurrence), py::arg("members") = members,
               py::arg("goal") = ToTuple(goal), py::arg("extraction") = ToTuple(step.extraction_W),
               py::arg("engage_distance") = step.engage_distance));
}

py::list ListSteps(const ModelHandle& handle) {
  py::list list;
  const auto& steps = handle.model->sequence.steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    list.append(Describe(steps[i], *handle.model, i));
  }
  return list;
}

py::dict ListGaps(const ModelHandle& handle) {
  py::dict gaps;
  for (const sequence::SequenceGap& gap : handle.model->sequence.gaps) {
    gaps[py::str(PathOf(*handle.model, gap.occurrence))] = gap.reason;
  }
  return gaps;
}

std::unique_ptr<ModelHandle> Prepare(const std::shared_ptr<product::Product>& product,
                                     const py::object& seed, const std::string& base,
                                     const std::vector<std::string>& first_parts, bool is_cached,
                                     const py::object& progress) {
  std::stop_source stop;
  assembly::PrepareOptions options;
  options.seed = ToSeed("seed", seed);
  options.base = base;
  options.first_parts = first_parts;
  options.progress = MakeProgress(progress, &stop);
  options.stop = stop.get_token();
  if (is_cached) {
    options.shape_cache = assembly::MakeShapeCache(FileCache::DefaultDirectory());
  }
  Diagnostics found;
  auto model = [&] {
    const py::gil_scoped_release unlocked;
    return assembly::PrepareModel(*product, options, &found);
  }();
  auto handle = std::make_unique<ModelHandle>();
  handle->model = Take(std::move(model));
  handle->diagnostics = found.items();
  return handle;
}

std::unique_ptr<ModelHandle> DrawSizes(const ModelHandle& handle, const py::object& seed) {
  Diagnostics found;
  auto drawn = std::make_unique<ModelHandle>();
  drawn->model =
      simulation::DrawSizes(*handle.model, ToSeed("seed", seed), handle.model->pairs, &found);
  drawn->diagnostics = found.items();
  return drawn;
}

std::unique_ptr<ModelHandle> StateFriction(const ModelHandle& handle,
                                           const py::object& friction_object) {
  const double friction = ToNumber("friction", friction_object, kFriction);
  const auto product = std::make_shared<product::Product>(*handle.model->product);
  const std::size_t count = product->occurrences.size();
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      product->contact_pairs.push_back(
          {product::OccurrenceId(a), product::OccurrenceId(b), std::nullopt, friction});
    }
  }
  for (product::Mate& mate : product->mates) {
    mate.conditions.friction = friction;
  }
  Model model = *handle.model;
  model.product = product;
  auto stated = std::make_unique<ModelHandle>();
  Diagnostics found;
  // The same sizes, in fits with the other friction.
  stated->model = simulation::DrawSizes(model, model.seed, model.pairs, &found);
  stated->diagnostics = found.items();
  return stated;
}

py::list Plan(const ModelHandle& handle, const py::object& orders,
              const std::vector<std::pair<std::string, std::string>>& before,
              const std::map<std::string, py::object>& weights) {
  constexpr std::int64_t kMostOrders = 1000;  // As `hvas plan --orders` has it.
  assembly::PlanOptions options;
  options.most_orders = static_cast<std::size_t>(ToInteger("orders", orders, 1, kMostOrders));
  options.before = before;
  const std::map<std::string, double*> known{
      {"turn", &options.weights.turn},
      {"direction_change", &options.weights.direction_change},
      {"tool_change", &options.weights.tool_change},
      {"loose", &options.weights.loose},
      {"cramped", &options.weights.cramped},
      {"reach", &options.weights.reach},
      {"force", &options.weights.force},
      {"hand_time", &options.weights.hand_time}};
  for (const auto& [name, value] : weights) {
    const auto weight = known.find(name);
    if (weight == known.end()) {
      std::string names;
      for (const auto& [each, unused] : known) {
        names.append(names.empty() ? "" : ", ").append(each);
      }
      throw py::value_error(fmt::format("no weight is called '{}'; there are {}", name, names));
    }
    *weight->second = ToNumber(fmt::format("weights['{}']", name).c_str(), value, {0, kMostWeight});
  }
  auto found = [&] {
    const py::gil_scoped_release unlocked;
    return assembly::PlanOrder(*handle.model, options);
  }();
  const assembly::OrderPlan plan = Take(std::move(found));
  py::list list;
  for (const orders::FoundOrder& order : plan.search.orders) {
    py::list parts;
    for (const std::size_t move : order.moves) {
      parts.append(PathOf(*handle.model, plan.rules.moves[move].parts.front()));
    }
    list.append(
        MakeDataclass("Order", py::dict(py::arg("cost") = order.cost, py::arg("parts") = parts)));
  }
  return list;
}

py::object Describe(const simulation::PartResult& part, const Model& model) {
  return MakeDataclass(
      "PartResult",
      py::dict(py::arg("occurrence") = part.occurrence.index(),
               py::arg("path") = PathOf(model, part.occurrence), py::arg("seated") = part.is_seated,
               py::arg("assumed") = part.is_assumed, py::arg("reason") = part.reason,
               py::arg("note") = part.note, py::arg("time") = part.time,
               py::arg("path_length") = part.path, py::arg("peak_true") = part.peak_true,
               py::arg("peak_felt") = part.peak_felt, py::arg("fit_true") = part.fit_true,
               py::arg("fit_felt") = part.fit_felt, py::arg("preload") = part.preload,
               py::arg("tightening") = part.tightening, py::arg("deepest") = part.deepest,
               py::arg("arrival") = part.arrival));
}

py::object Assemble(const ModelHandle& handle, const py::object& seed,
                    const std::vector<std::string>& devices, const std::string& condition,
                    bool turns_threads, bool is_realtime, const py::object& limit_s,
                    const std::filesystem::path& record, bool is_replaced,
                    const py::object& on_part) {
  std::stop_source stop;
  assembly::RunOptions options;
  options.seed = ToSeed("seed", seed);
  options.devices = devices;
  options.condition = ToCondition(condition);
  options.guidance.threads_turn = turns_threads;
  options.is_realtime = is_realtime;
  options.limit_s = ToNumber("limit_s", limit_s, {0, kMostTime});
  options.record = record;
  options.is_record_replaced = is_replaced;
  options.stop = stop.get_token();
  const auto tell = MakeProgress(py::none(), &stop);
  options.on_part = [&](const simulation::AssemblyProgress&, const simulation::PartResult& part) {
    tell("", 0);  // Ctrl-C.
    if (!on_part.is_none() && !stop.stop_requested()) {
      const py::gil_scoped_acquire lock;
      MakeProgress(py::cpp_function(
                       [&](const std::string&, double) { on_part(Describe(part, *handle.model)); }),
                   &stop)("", 0);
    }
  };
  auto run = [&] {
    const py::gil_scoped_release unlocked;
    return assembly::RunAssembly(handle.model, options);
  }();
  ThrowInterrupt();
  const assembly::RunOutcome outcome = Take(std::move(run));
  if (outcome.record_error) {
    Throw(*outcome.record_error);
  }
  py::list parts;
  for (const simulation::PartResult& part : outcome.parts) {
    parts.append(Describe(part, *handle.model));
  }
  return MakeDataclass(
      "Outcome",
      py::dict(py::arg("parts") = parts, py::arg("complete") = outcome.is_complete(),
               py::arg("digest") = outcome.digest, py::arg("ticks") = outcome.execution.ticks,
               py::arg("session_time") = 1e-9 * static_cast<double>(outcome.execution.session_ns),
               py::arg("wall_time") = 1e-9 * static_cast<double>(outcome.execution.wall_ns)));
}

/** The parts that are in their places and in the hand, drawn without a screen. */
py::array Draw(const SteppedRun& run, const py::object& width_object,
               const py::object& height_object, const py::object& to_eye) {
  constexpr std::int64_t kMostPixels = 4096;
  const auto width = static_cast<int>(ToInteger("width", width_object, 1, kMostPixels));
  const auto height = static_cast<int>(ToInteger("height", height_object, 1, kMostPixels));
  const Vec3 eye = ToVector("to_eye", to_eye, {-kMostLength, kMostLength});
  const double level = std::hypot(eye.x(), eye.y());
  if (!(level > 0) || level < 1e-3 * std::abs(eye.z())) {
    throw py::value_error("to_eye is the direction to the eye, which is not to be vertical");
  }
  std::vector<std::uint8_t> pixels;
  {
    const py::gil_scoped_release unlocked;
    const product::Product& product = *run.model().product;
    spatial::Box box_W = product.box_W;
    std::vector<evidence::PictureBody> bodies;
    const std::vector<simulation::PartState> parts = run.ListParts();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (parts[i].placement == simulation::Placement::kPlaced ||
          parts[i].placement == simulation::Placement::kHeld) {
        const product::Part& part = product.part_of(product::OccurrenceId(i));
        bodies.push_back({&part, parts[i].X_WB, std::nullopt, {}});
        // As far out as the part begins, so that the view stays.
        box_W.Add(
            spatial::Transform(spatial::Pose(run.step().engage_distance * run.step().extraction_W) *
                                   product.occurrences[i].X_WB,
                               part.box_B));
      }
    }
    pixels = evidence::DrawPixels(bodies, evidence::Projection(box_W, width, height, eye));
  }
  py::array_t<std::uint8_t> array({height, width, 4});
  std::copy(pixels.begin(), pixels.end(), array.mutable_data());
  return array;
}

/** A run that Python steps: the rows are views of what the run keeps. */
class PythonRun {
 public:
  PythonRun(const ModelHandle& handle, const py::object& step, const py::object& start,
            const std::string& condition, bool has_contact_in_holes, bool turns_threads,
            const py::object& stiffness, const py::object& damping,
            const py::object& turn_stiffness, const py::object& turn_damping,
            const py::object& rate_hz)
      : model_(handle.model) {
    assembly::SteppedOptions options;
    options.step = ToIndex("step", step, model_->sequence.steps.size());
    if (!start.is_none()) {
      options.X_WB_start = ToPose("start", start);
    }
    options.condition = ToCondition(condition);
    options.contact_in_holes = has_contact_in_holes;
    options.threads_turn = turns_threads;
    options.arm.stiffness = ToNumber("stiffness", stiffness, kImpedance);
    options.arm.damping = ToNumber("damping", damping, kImpedance);
    options.arm.turn_stiffness = ToNumber("turn_stiffness", turn_stiffness, kImpedance);
    options.arm.turn_damping = ToNumber("turn_damping", turn_damping, kImpedance);
    options.rate_hz = ToNumber("rate_hz", rate_hz, {1000, 8000});
    run_ = Take(SteppedRun::Create(model_, options));
    reference_.X_WR = HandPose();
    reference_.is_gripping = true;
  }

  static py::array Step(const py::object& self, const py::object& pose, const py::object& force,
                        const py::object& ticks_object, bool grip) {
    auto& run = self.cast<PythonRun&>();
    const auto ticks = static_cast<std::size_t>(ToInteger("ticks", ticks_object, 1, kMostTicks));
    simulation::HandReference reference = run.reference_;
    if (!pose.is_none()) {  // Of the part; the hand keeps its grip.
      reference.X_WR = ToPose("pose", pose) * run.run_->X_HB().Inverse();
    }
    reference.f_W =
        force.is_none() ? Vec3(Vec3::Zero()) : ToVector("force", force, {-kMostForce, kMostForce});
    reference.is_gripping = grip;
    run.reference_ = reference;  // Only now: a refused call changes nothing.
    {
      const py::gil_scoped_release unlocked;
      run.rows_ = run.run_->Step(run.reference_, ticks);
    }
    return View(self);
  }

  /** Rows of the last call of step, where they are; the next one writes over them. */
  static py::array View(const py::object& self) {
    auto& run = self.cast<PythonRun&>();
    return ViewOf(run.rows_, self);
  }

  /** Contacts of the last tick, where they are. */
  static py::array ViewContacts(const py::object& self) {
    return ViewOf(self.cast<PythonRun&>().run_->contacts(), self);
  }

  /** Where the hand is. */
  [[nodiscard]] spatial::Pose HandPose() const {
    const double* X = run_->last().X_WH;
    return {Quat(X[3], X[4], X[5], X[6]), Vec3(X[0], X[1], X[2])};
  }

  /** Poses of all parts. */
  [[nodiscard]] py::list ListPoses() const {
    py::list poses;
    for (const simulation::PartState& part : run_->ListParts()) {
      poses.append(ToTuple(part.X_WB));
    }
    return poses;
  }

  [[nodiscard]] const SteppedRun& run() const { return *run_; }

  [[nodiscard]] const Model& model() const { return *model_; }

 private:
  template <typename Row>
  static py::array ViewOf(std::span<const Row> rows, const py::object& owner) {
    return py::array(py::dtype::of<Row>(), {static_cast<py::ssize_t>(rows.size())},
                     {static_cast<py::ssize_t>(sizeof(Row))}, rows.data(), owner);
  }

  static constexpr std::int64_t kMostTicks = 1'000'000;  // A quarter of a GB of rows: a choice.

  ModelPtr model_;
  std::unique_ptr<SteppedRun> run_;
  simulation::HandReference reference_;
  std::span<const TickRow> rows_;
};

void DefineModel(py::module_* module) {
  py::class_<ModelHandle>(*module, "Model",
                          "A product that is prepared: immutable, and shared by all runs.")
      .def_property_readonly("steps", &ListSteps, "The order of assembly.")
      .def_property_readonly("gaps", &ListGaps,
                             "Reasons of the parts that no step brings in, by path.")
      .def_property_readonly("seed", [](const ModelHandle& handle) { return handle.model->seed; })
      .def("with_seed", &DrawSizes, py::arg("seed"), "The same model with other sizes of its fits.")
      .def("with_friction", &StateFriction, py::arg("friction"),
           "The same model with this Coulomb coefficient, 0 to 2, in all contacts and fits.")
      .def("plan", &Plan, py::arg("orders") = 5,
           py::arg("before") = std::vector<std::pair<std::string, std::string>>(),
           py::arg("weights") = std::map<std::string, py::object>(),
           "Orders of assembly of low cost. Weights: turn, direction_change, tool_change, loose, "
           "cramped, reach, force, hand_time.")
      .def("assemble", &Assemble, py::arg("seed") = 1,
           py::arg("devices") = std::vector<std::string>{""}, py::arg("condition") = "hybrid",
           py::arg("threads_turn").noconvert() = false, py::arg("realtime").noconvert() = false,
           py::arg("limit_s") = 0.0, py::arg("record") = "", py::arg("replace").noconvert() = false,
           py::arg("on_part") = py::none(),
           "Has a simulated person, or the user of a device, put every part in; in virtual time "
           "unless realtime. threads_turn: screws and nuts go in by turning, and are tightened. "
           "on_part is called with each hvas.types.PartResult.")
      .def("__repr__", [](const ModelHandle& handle) {
        return "<hvas.Model " + handle.model->product->source + ": " +
               std::to_string(handle.model->sequence.steps.size()) + " steps>";
      });
  module->def("prepare", &Prepare, py::arg("product"), py::arg("seed"), py::arg("base"),
              py::arg("first_parts"), py::arg("cache").noconvert(), py::arg("progress"));
}

void DefineStep(py::class_<PythonRun>* run) {
  const person::PersonOptions arm;
  using Object = const py::object&;
  run->def(py::init<const ModelHandle&, Object, Object, const std::string&, bool, bool, Object,
                    Object, Object, Object, Object>(),
           py::arg("model"), py::arg("step") = 1, py::arg("start") = py::none(),
           py::arg("condition") = "hybrid", py::arg("contact_in_holes").noconvert() = false,
           py::arg("threads_turn").noconvert() = false, py::arg("stiffness") = arm.stiffness,
           py::arg("damping") = arm.damping, py::arg("turn_stiffness") = arm.turn_stiffness,
           py::arg("turn_damping") = arm.turn_damping, py::arg("rate_hz") = 1000.0)
      .def(
          "step",
          [](const py::object& self, const py::object& pose, const py::object& force,
             const py::object& ticks,
             bool grip) { return PythonRun::Step(self, pose, force, ticks, grip); },
          py::arg("pose") = py::none(), py::arg("force") = py::none(), py::arg("ticks") = 1,
          py::arg("grip").noconvert() = true,
          "Runs ticks, without the interpreter's lock.\n\n"
          "Args:\n"
          "    pose: Where the hand leads the part to; None: as before.\n"
          "    force: Of the arm besides its spring, in the world [N]; None: none.\n"
          "    ticks: 1 to 1,000,000.\n"
          "    grip: False lets go.\n\n"
          "Returns:\n"
          "    A structured array with a row for each tick, a view: the next call writes over it, "
          "so "
          "copy what is to stay. Fields: t_s, X_WH (hand), X_WB (part), F_felt_W and F_true_W "
          "(force, "
          "then torque), p_WC and f_C_W (the contact that presses hardest), deepest, insertion, "
          "axial_true, preload, tightening, offset, tilt, contacts, state (index into "
          "hvas.STATES).");
}

void DefineState(py::class_<PythonRun>* run) {
  run->def_property_readonly(
         "rows", [](const py::object& self) { return PythonRun::View(self); },
         "What the last step returned.")
      .def_property_readonly(
          "contacts", [](const py::object& self) { return PythonRun::ViewContacts(self); },
          "All contacts that pressed on the part in the last tick, a view as rows are. Fields: "
          "p_WC, f_C_W (force on the part), distance, other (occurrence; -1: none).")
      .def_property_readonly("seated", [](const PythonRun& run) { return run.run().is_seated(); })
      .def_property_readonly(
          "t", [](const PythonRun& run) { return run.run().last().t_s; },
          "Session time at the beginning of the last tick [s].")
      .def_property_readonly("pose",
                             [](const PythonRun& run) {
                               const TickRow& row = run.run().last();
                               return py::array_t<double>(7, row.X_WB);
                             })
      .def_property_readonly(
          "led", [](const PythonRun& run) { return ToTuple(run.HandPose() * run.run().X_HB()); })
      .def_property_readonly(
          "force",
          [](const PythonRun& run) { return py::array_t<double>(6, run.run().last().F_felt_W); },
          "Force and torque that the hand is given [N, N m].")
      .def_property_readonly("goal", [](const PythonRun& run) { return ToTuple(run.run().goal()); })
      .def_property_readonly("poses", &PythonRun::ListPoses)
      .def(
          "picture",
          [](const PythonRun& run, const py::object& width, const py::object& height,
             const py::object& to_eye) { return Draw(run.run(), width, height, to_eye); },
          py::arg("width") = 320, py::arg("height") = 240,
          py::arg("to_eye") = std::array<double, 3>{0.5, -0.7, 0.5},
          "Array of height x width x 4 (red, green, blue, opacity): what is in its place and in "
          "the "
          "hand, drawn without a screen.")
      .def_property_readonly("mass", [](const PythonRun& run) {
        return simulation::CombineMass(run.model(), run.run().step()).mass;
      });
}

}  // namespace

void DefineRun(py::module_* module) {
  PYBIND11_NUMPY_DTYPE(TickRow, t_s, X_WH, X_WB, F_felt_W, F_true_W, p_WC, f_C_W, deepest,
                       insertion, axial_true, preload, tightening, offset, tilt, contacts, state);
  PYBIND11_NUMPY_DTYPE(ContactRow, p_WC, f_C_W, distance, other);
  DefineModel(module);
  py::class_<PythonRun> run(
      *module, "Run",
      "One step of the order, tick by tick, with a hand that the caller leads. The part is in the "
      "hand from the beginning.\n\n"
      "Args:\n"
      "    model: As hvas.prepare gives it.\n"
      "    step: Index of a step that inserts a part.\n"
      "    start: Pose of the part when it is taken; None: where it lies on the table.\n"
      "    condition: 'hybrid', 'collision' (contact only) or 'constraint' (mates only).\n"
      "    contact_in_holes: A shaft with play touches its hole: it tilts, jams and wedges.\n"
      "    threads_turn: Screws and nuts go in by turning, and are tightened.\n"
      "    stiffness, damping, turn_stiffness, turn_damping: Of the arm [N/m, N s/m, N m/rad, N m "
      "s/rad].\n"
      "    rate_hz: Of the haptic tick, 1000 to 8000.");
  DefineStep(&run);
  DefineState(&run);
  module->attr("STATES") = py::make_tuple("empty", "free", "near", "captured", "mating", "seated");
}

}  // namespace hvas::python
