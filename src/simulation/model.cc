#include "simulation/model.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "dynamics/world.h"
#include "mates/assignments.h"
#include "mates/fasteners.h"
#include "mates/place_bodies.h"
#include "mates/prismatic_fits.h"
#include "product/accessories.h"
#include "sequence/extraction.h"
#include "sequence/fit_of_mate.h"
#include "sequence/mate_faces.h"
#include "sequence/mate_way.h"
#include "sequence/thread_faces.h"
#include "simulation/actual_faces.h"
#include "simulation/first_parts.h"
#include "simulation/model_limits.h"
#include "simulation/shapes.h"
#include "simulation/table_layout.h"

namespace hvas::simulation {
namespace {

using product::OccurrenceId;
using product::Product;

/** A surface without a solid weighs nothing in the file; in the hand it needs some inertia. */
dynamics::MassProperties MakeMass(const product::Part& part) {
  constexpr double kLeastMass = 1e-4;  // [kg]: a tenth of a gram. A choice.
  const product::MassProperties& mass = part.mass;
  if (mass.mass > kLeastMass && mass.I_BBcm_B.determinant() > 0) {
    return {mass.mass, mass.p_BoBcm_B, mass.I_BBcm_B};
  }
  const double radius = 0.25 * part.box_B.size().norm();
  const double least = std::max(kLeastMass, mass.mass);
  return {least, part.box_B.centre(), 0.4 * least * radius * radius * Mat3::Identity()};
}

/** Draws the actual sizes of the fits. The way of a prismatic mate is that of the step that joins
 * it.
 */
void MakeFits(Model* model, Diagnostics* diagnostics) {
  for (ModelMate& compiled : model->mates) {
    const product::Mate& mate = model->product->mates[compiled.id.index()];
    if (model->bodies[mate.a.occurrence.index()].role == BodyRole::kPending ||
        model->bodies[mate.b.occurrence.index()].role == BodyRole::kPending) {
      continue;
    }
    const Vec3 way_W = sequence::FindWayOut(model->sequence, mate);
    compiled.fit =
        sequence::MakeFitForce(*model->product,
                               mate.kind == product::MateKind::kPrismatic && way_W.norm() > 0
                                   ? mates::TurnToWay(*model->product, mate, way_W)
                                   : mate,
                               model->seed, model->pairs, diagnostics);
  }
}

/** Contact has the clearance that the fits say, where they leave any. */
void GiveActualFaces(Model* model, Diagnostics* diagnostics) {
  const auto faces = MakeActualFaces(MakeActualFacesInput(*model), diagnostics);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    model->bodies[i].faces = faces[i];
  }
}

/** Parts get through what a way is free with: planning and contact agree. */
void RelieveWays(const std::stop_token& stop, Model* model, Diagnostics* diagnostics) {
  constexpr int kRounds = 3;  // What gives way at one place may meet the next: a choice.
  for (int round = 0; round < kRounds; ++round) {
    contact::Scene scene;
    sequence::SequenceInput input = MakeSequenceInput(*model, &scene);
    input.stop = stop;
    sequence::Extraction extraction(input, &model->sequence);
    for (const Body& body : model->bodies) {
      scene.SetOffsets(contact::BodyId(body.occurrence.index()), body.faces);
    }
    if (!extraction.RelieveWays(model->sequence.steps)) {
      return;
    }
    model->sequence.reliefs = extraction.ListReliefs();
    GiveActualFaces(model, diagnostics);
  }
}

/** Says which bodies are tools and fixtures, and finds the forms by which tools turn fasteners. */
void GiveRoles(Model* model) {
  const Product& product = *model->product;
  Accessories& accessories = model->accessories;
  accessories.tools = ListAccessories(product, product::AccessoryKind::kTool);
  accessories.fixtures = ListAccessories(product, product::AccessoryKind::kFixture);
  const auto bench = ListAccessories(product, product::AccessoryKind::kBench);
  accessories.fixtures.insert(accessories.fixtures.end(), bench.begin(), bench.end());
  accessories.bench_count = bench.size();
  for (const OccurrenceId id : accessories.tools) {
    model->bodies[id.index()].role = BodyRole::kTool;
  }
  for (const OccurrenceId id : accessories.fixtures) {
    model->bodies[id.index()].role = BodyRole::kFixture;
  }
  if (accessories.tools.empty()) {
    return;
  }
  const auto fasteners = mates::ClassifyOccurrences(product);
  std::map<product::PartId, std::vector<product::DriveForm>> drives;
  for (Body& body : model->bodies) {
    if (body.role == BodyRole::kTool ||
        fasteners[body.occurrence.index()] != mates::FastenerKind::kNone) {
      const product::PartId part = product.occurrences[body.occurrence.index()].part;
      const auto [entry, is_new] = drives.try_emplace(part);
      if (is_new) {
        constexpr double kTolerance = 2e-6;  // [m]: that of a part's features.
        product::RecognitionLimits limits;
        entry->second = product::FindDriveForms(product.parts[part.index()], kTolerance, &limits);
      }
      body.drives = entry->second;
    }
  }
}

/** Has the parts that no step brings in among the gaps, and no others: with another base, or
 another order, they are not those that were found. */
void MatchGaps(Model* model) {
  std::vector<bool> is_in_step(model->bodies.size(), false);
  for (const sequence::SequenceStep& step : model->sequence.steps) {
    for (const OccurrenceId part : sequence::UnitOf(step)) {
      is_in_step[part.index()] = true;
    }
  }
  for (const sequence::SequenceStep& step : model->sequence.steps) {
    if (step.kind == sequence::SequenceStep::Kind::kAssume) {
      is_in_step[step.occurrence.index()] = false;
    }
  }
  std::vector<sequence::SequenceGap>& gaps = model->sequence.gaps;
  std::erase_if(
      gaps, [&](const sequence::SequenceGap& gap) { return is_in_step[gap.occurrence.index()]; });
  std::vector<bool> is_gap(model->bodies.size(), false);
  for (const sequence::SequenceGap& gap : gaps) {
    is_gap[gap.occurrence.index()] = true;
  }
  for (const Body& body : model->bodies) {
    const std::size_t i = body.occurrence.index();
    if (body.role == BodyRole::kPart && !is_in_step[i] && !is_gap[i]) {
      gaps.push_back({body.occurrence, "it has no step in the order that is followed"});
    }
  }
}

/** The order that was asked for, in place of the one that was found. */
Result<void> PutInOrder(const CompileOptions& options, Model* model) {
  if (!options.steps.empty()) {
    model->sequence.steps = options.steps;
    MatchGaps(model);
  }
  if (options.first_parts.empty()) {
    return {};
  }
  auto sequence = sequence::Reorder(*model->product, model->sequence, options.first_parts);
  if (!sequence) {
    return Unexpected(sequence.error());
  }
  model->sequence = std::move(*sequence);
  return {};
}

}  // namespace

sequence::SequenceInput MakeSequenceInput(const Model& model, contact::Scene* scene) {
  sequence::SequenceInput input;
  input.product = model.product.get();
  input.scene = scene;
  input.absent = model.accessories.tools;
  input.fixtures = model.accessories.fixtures;
  if (!model.product->flexible.empty()) {
    input.give_limits.assign(model.bodies.size(), 0);
    for (const product::FlexiblePart& part : model.product->flexible) {
      input.give_limits[part.occurrence.index()] = part.allowance;
    }
  }
  for (const Body& body : model.bodies) {
    const contact::BodyId id = scene->Add(body.shape, body.X_WB_goal);
    input.shapes.push_back(body.shape);
    if (body.role == BodyRole::kPending) {
      scene->SetEnabled(id, false);
      input.absent.push_back(body.occurrence);
    }
  }
  for (const ModelMate& mate : model.mates) {
    input.faces_a.push_back(mate.faces_a);
    input.faces_b.push_back(mate.faces_b);
  }
  return input;
}

dynamics::MassProperties CombineMass(const Model& model, const sequence::SequenceStep& step) {
  const Body& leader = model.bodies[step.occurrence.index()];
  dynamics::MassProperties sum = leader.mass;
  for (const OccurrenceId id : step.members) {
    const Body& body = model.bodies[id.index()];
    const spatial::Pose X_BS = leader.X_WB_goal.Inverse() * body.X_WB_goal;
    const Vec3 p_BoScm_B = X_BS * body.mass.p_BoBcm_B;
    const double mass = sum.mass + body.mass.mass;
    const Vec3 d = p_BoScm_B - sum.p_BoBcm_B;
    const Mat3 R_BS = X_BS.R();
    // Both about the common centre of mass: Steiner with the reduced mass.
    const double reduced = sum.mass * body.mass.mass / mass;
    sum.I_BBcm_B += R_BS * body.mass.I_BBcm_B * R_BS.transpose() +
                    reduced * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    sum.p_BoBcm_B += body.mass.mass / mass * d;
    sum.mass = mass;
  }
  return sum;
}

namespace {

std::vector<PressedPair> ListAllPresses(const Product& product,
                                        const sequence::Sequence& sequence) {
  std::vector<PressedPair> presses = ListPressedPairs(product, sequence);
  for (auto list : {ListSqueezedPairs(product, sequence), ListSpreadLips(product, sequence)}) {
    std::move(list.begin(), list.end(), std::back_inserter(presses));
  }
  return presses;
}

/** Makes the boxes that stand for the shapes that are not there. Errors: those of MakeBoxShape. */
Result<PartShapes> MakeMissingBoxes(const Product& product, const PartShapes& shapes) {
  PartShapes boxes(shapes.size());
  for (const product::PartId id : ListWithoutShape(shapes)) {
    auto box = MakeBoxShape(product.parts[id.index()]);
    if (!box) {
      return Unexpected(box.error());
    }
    boxes[id.index()] = std::move(*box);
  }
  return boxes;
}

void ReportStage(const CompileOptions& options, const std::string& stage, double fraction) {
  if (options.progress) {
    options.progress(stage, fraction);
  }
}

/** Fails where the caller has asked to stop. */
Result<void> CheckNotStopped(const CompileOptions& options, const Product& product) {
  if (options.shape.stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "preparing the product was cancelled", product.source);
  }
  return {};
}

/** Makes a body of each occurrence; one whose part has no shape yet is a box, and pending. */
Result<void> MakeBodies(const PartShapes& shapes, Model* model) {
  const Product& product = *model->product;
  const auto boxes = MakeMissingBoxes(product, shapes);
  if (!boxes) {
    return Unexpected(boxes.error());
  }
  for (const product::Occurrence& occurrence : product.occurrences) {
    const std::size_t part = occurrence.part.index();
    model->bodies.push_back({occurrence.id,
                             shapes[part] != nullptr ? shapes[part] : (*boxes)[part],
                             MakeMass(product.part_of(occurrence.id)),
                             occurrence.X_WB,
                             occurrence.X_WB,
                             nullptr,
                             shapes[part] != nullptr ? BodyRole::kPart : BodyRole::kPending,
                             {}});
  }
  GiveRoles(model);
  return {};
}

/** Makes the faces of mates, each set once for all occurrences of a part. */
class MateFaceSets {
 public:
  explicit MateFaceSets(const Product& product) : product_(product) {}

  std::shared_ptr<const haptics::MateFaces> Make(const product::Connector& connector) {
    const product::PartId part = product_.occurrences[connector.occurrence.index()].part;
    auto& entry = made_[{part, connector.feature, connector.opposite}];
    if (entry == nullptr) {
      entry = std::make_shared<haptics::MateFaces>(
          sequence::CollectMateFaces(product_.parts[part.index()], FacesOf(product_, connector)));
    }
    return entry;
  }

 private:
  const Product& product_;
  std::map<std::tuple<product::PartId, product::FeatureId, product::FeatureId>,
           std::shared_ptr<const haptics::MateFaces>>
      made_;
};

/** Makes a mate with the faces that take part in it; those of threads, and of nuts that lock, are
 more than its connectors have. */
ModelMate MakeMate(const Product& product, const product::Mate& mate, bool is_nut,
                   MateFaceSets* faces) {
  ModelMate made;
  made.id = mate.id;
  made.faces_a = faces->Make(mate.a);
  made.faces_b = faces->Make(mate.b);
  const std::vector<product::FaceId> locking =
      is_nut ? sequence::ListLockingFaces(product, mate) : std::vector<product::FaceId>();
  if (!locking.empty()) {
    std::vector<product::FaceId> all = FacesOf(product, mate.a);
    all.insert(all.end(), locking.begin(), locking.end());
    made.faces_a = std::make_shared<haptics::MateFaces>(
        sequence::CollectMateFaces(product.part_of(mate.a.occurrence), all));
  }
  if (sequence::IsDrawnThread(mate) || !locking.empty()) {
    made.faces_a = sequence::WidenForThread(product, mate, mate.a, *made.faces_a);
    made.faces_b = sequence::WidenForThread(product, mate, mate.b, *made.faces_b);
  }
  return made;
}

void MakeMates(Model* model) {
  const Product& product = *model->product;
  MateFaceSets faces(product);
  model->mates_of.resize(product.occurrences.size());
  const std::vector<mates::FastenerKind> fasteners = mates::ClassifyOccurrences(product);
  const std::vector<mates::ThreadJoint> joints = mates::FindThreadJoints(product);
  auto next_joint = joints.begin();
  for (const product::Mate& mate : product.mates) {
    const bool is_nut = mate.fit && mate.fit->kind == product::FitKind::kThread &&
                        fasteners[mate.a.occurrence.index()] == mates::FastenerKind::kNut;
    ModelMate made = MakeMate(product, mate, is_nut, &faces);
    if (next_joint != joints.end() && next_joint->mate == mate.id) {
      made.thread = std::make_shared<const mates::ThreadJoint>(*next_joint++);
    }
    model->mates.push_back(std::move(made));
    if (!mates::IsContradicted(product, mate)) {
      model->mates_of[mate.a.occurrence.index()].push_back(mate.id);
      model->mates_of[mate.b.occurrence.index()].push_back(mate.id);
    }
  }
}

/** Finds the part that is named as the base; an invalid id where none is named. */
Result<OccurrenceId> FindNamedBase(const CompileOptions& options, const Model& model) {
  if (options.base.empty()) {
    return OccurrenceId();
  }
  const auto base = mates::FindOccurrence(*model.product, options.base);
  if (!base) {
    return Unexpected(base.error());
  }
  if (model.bodies[base->index()].role != BodyRole::kPart) {
    return Fail(ErrorCode::kInvalid,
                fmt::format("{} is no part of the product, and cannot be its base",
                            model.product->occurrences[base->index()].path),
                model.product->source, "name another part as the base");
  }
  return *base;
}

Result<void> FindOrder(const CompileOptions& options, Model* model) {
  contact::Scene scene;
  sequence::SequenceInput input = MakeSequenceInput(*model, &scene);
  input.way_looks = options.way_looks;
  input.queries = options.search_queries;
  const auto base = FindNamedBase(options, *model);
  if (!base) {
    return Unexpected(base.error());
  }
  input.base = *base;
  input.progress = [&options](double fraction) {
    ReportStage(options, "order of assembly", fraction);
  };
  input.stop = options.shape.stop;
  model->sequence = sequence::PlanSequence(input);
  return CheckNotStopped(options, *model->product);
}

/** Makes the bodies and mates of a product, and finds its order of assembly; parts without a shape
 are pending. */
Result<std::shared_ptr<Model>> MakeOrderedModel(std::shared_ptr<const product::Product> product,
                                                const PartShapes& shapes,
                                                const CompileOptions& options) {
  auto model = std::make_shared<Model>();
  model->product = std::move(product);
  model->seed = options.seed;
  model->pairs = options.pairs;
  if (const auto made = MakeBodies(shapes, model.get()); !made) {
    return Unexpected(made.error());
  }
  ReportStage(options, "mates", 0);
  MakeMates(model.get());
  if (const auto found = FindOrder(options, model.get()); !found) {
    return Unexpected(found.error());
  }
  return model;
}

/** Adds what follows from the order: where parts lie on the table, presses, fits and reliefs. */
Result<void> CompleteModel(const CompileOptions& options, Model* model, Diagnostics* diagnostics) {
  ReportStage(options, "layout", 0);
  if (auto laid_out = LayOutParts(model); !laid_out) {
    return laid_out;
  }
  if (auto ordered = PutInOrder(options, model); !ordered) {
    return ordered;
  }
  model->presses = ListAllPresses(*model->product, model->sequence);
  model->deformables = ListDeformables(*model->product, model->sequence, model->presses);
  MakeFits(model, diagnostics);
  GiveActualFaces(model, diagnostics);
  RelieveWays(options.shape.stop, model, diagnostics);
  if (auto running = CheckNotStopped(options, *model->product); !running) {
    return running;
  }
  ReportModelLimits(*model, diagnostics);
  ReportStage(options, "ready", 1);
  return {};
}

/** Compiles the parts whose shapes are there, as well as is possible soon: without ways that turn,
 and without reasons for what finds no way without the others. */
Result<std::shared_ptr<const Model>> CompileFirst(
    const std::shared_ptr<const product::Product>& product, const PartShapes& shapes,
    product::OccurrenceId base, const CompileOptions& options) {
  CompileOptions first;
  first.base = options.base.empty() ? product->occurrences[base.index()].path : options.base;
  first.seed = options.seed;
  first.pairs = options.pairs;
  first.shape.stop = options.shape.stop;
  first.way_looks = 0;
  auto model = MakeOrderedModel(product, shapes, first);
  if (!model) {
    return Unexpected(model.error());
  }
  Diagnostics unheeded;
  if (const auto completed = CompleteModel(first, model->get(), &unheeded); !completed) {
    return Unexpected(completed.error());
  }
  (*model)->sequence.gaps.clear();
  return std::shared_ptr<const Model>(*std::move(model));
}

/** Builds the shapes of all parts: first those with which somebody can begin, where the caller
 wants a model of these, and where the others take long. */
Result<void> BuildAllShapes(const std::shared_ptr<const product::Product>& product,
                            const CompileOptions& options, PartShapes* shapes) {
  ShapesControl control{options.shape, options.shape_cache.get(), options.threads, nullptr};
  control.progress = [&options](double fraction) {
    ReportStage(options, "contact shapes", fraction);
  };
  const FirstParts first = options.on_first_parts ? ChooseFirstParts(*product) : FirstParts();
  if (!first.parts.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    if (auto built = AddShapes(*product, first.parts, control, shapes); !built) {
      return built;
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    if (taken * (1 - first.share) >= options.least_gain * first.share) {
      if (const auto model = CompileFirst(product, *shapes, first.base, options)) {
        options.on_first_parts(*model);
        // One core is left to whoever begins.
        const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
        control.threads = std::max(1U, (options.threads > 0 ? options.threads : cores) - 1);
      }
    }
  }
  return AddShapes(*product, ListWithoutShape(*shapes), control, shapes);
}

}  // namespace

Result<std::shared_ptr<const Model>> Compile(std::shared_ptr<const product::Product> product,
                                             const CompileOptions& options,
                                             Diagnostics* diagnostics) {
  if (product->occurrences.empty()) {
    return Fail(ErrorCode::kInvalid, "the product has no parts", product->source);
  }
  ReportStage(options, "contact shapes", 0);
  PartShapes shapes(product->parts.size());
  if (const auto built = BuildAllShapes(product, options, &shapes); !built) {
    return Unexpected(built.error());
  }
  const auto problem =
      options.shape_cache != nullptr ? options.shape_cache->TakeProblem() : std::nullopt;
  if (problem) {
    diagnostics->Warn("shape-cache", problem->where, problem->message, problem->remedy);
  }
  auto model = MakeOrderedModel(std::move(product), shapes, options);
  if (model && !(*model)->sequence.screws.empty()) {
    // What was found to be a screw is one from now on, and the order is made with it.
    if (auto with_screws = sequence::AddScrewMates(*(*model)->product, (*model)->sequence.screws)) {
      model = MakeOrderedModel(std::move(with_screws), shapes, options);
    }
  }
  if (!model) {
    return Unexpected(model.error());
  }
  if (const auto completed = CompleteModel(options, model->get(), diagnostics); !completed) {
    return Unexpected(completed.error());
  }
  return std::shared_ptr<const Model>(*std::move(model));
}

std::shared_ptr<const Model> DrawSizes(const Model& model, std::uint64_t seed,
                                       fits::PairChoice pairs, Diagnostics* diagnostics) {
  auto drawn = std::make_shared<Model>(model);
  drawn->seed = seed;
  drawn->pairs = pairs;
  MakeFits(drawn.get(), diagnostics);
  GiveActualFaces(drawn.get(), diagnostics);
  return drawn;
}

std::shared_ptr<const Model> ChangeOrder(const Model& model,
                                         std::vector<sequence::SequenceStep> steps,
                                         const std::stop_token& stop, Diagnostics* diagnostics) {
  auto changed = std::make_shared<Model>(model);
  changed->sequence.steps = std::move(steps);
  changed->presses = ListAllPresses(*changed->product, changed->sequence);
  changed->deformables = ListDeformables(*changed->product, changed->sequence, changed->presses);
  RelieveWays(stop, changed.get(), diagnostics);
  return changed;
}

}  // namespace hvas::simulation
