#include "campaign/prepared_cell.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "assembly/prepare_model.h"
#include "assembly/run_assembly.h"
#include "base/shell_words.h"
#include "fits/materials.h"
#include "mates/assignments.h"

namespace hvas::campaign {
namespace {

constexpr std::size_t kMostKept =
    16;  // Combinations in memory; shards follow each other. A choice.

/** Sets what the forces of fits and the masses need to know of a material. */
void SetMaterial(const fits::Material& standard, product::Part* part) {
  product::Material& material = part->material;
  const double ratio = standard.density / material.density;
  part->mass.mass *= ratio;
  part->mass.I_BBcm_B *= ratio;
  material.name = standard.name;
  material.standard = standard.name;
  material.is_assumed = material.is_standard_assumed = false;
  material.density = standard.density;
  material.youngs_modulus = standard.youngs_modulus;
  material.poisson_ratio = standard.poisson_ratio;
  material.yield_strength = standard.yield_strength;
  material.thermal_expansion = standard.thermal_expansion;
}

Result<void> SetMaterials(const MaterialVariant& variant, const Plan& plan,
                          product::Product* product) {
  for (const PartMaterial& wanted : variant.parts) {
    bool is_found = false;
    for (product::Part& part : product->parts) {
      if (wanted.part == "all" || part.name == wanted.part) {
        SetMaterial(*fits::FindMaterial(wanted.material)->material, &part);
        is_found = true;
      }
    }
    if (!is_found) {
      return Fail(ErrorCode::kInvalid,
                  fmt::format("materials of \"{}\": {} has no part with the name \"{}\"",
                              variant.id, product->source, wanted.part),
                  plan.file.string(), "name a part that `hvas inspect` lists, or write all");
    }
  }
  return {};
}

/** Names the place in the plan of an error about an assignment, which knows only that of `--fit`.
 */
Error NamePlan(Error error, const Plan& plan, const Cell& cell) {
  constexpr std::string_view kOption = "--fit ";
  if (error.where.starts_with(kOption)) {
    error.where = fmt::format("{}: {} of fits \"{}\"", plan.file.string(),
                              error.where.substr(kOption.size()), plan.fits[cell.fit].id);
  }
  return error;
}

bool HasPlainSizes(const SizeVariant& sizes) {
  return sizes.spread == Spread::kZone && !sizes.friction && !sizes.roughness;
}

/** Whether two combinations have one product: all but the person is the same. */
bool IsSameProduct(const Cell& a, const Cell& b) {
  return a.product == b.product && a.fit == b.fit && a.sizes == b.sizes && a.material == b.material;
}

}  // namespace

CellStore::CellStore(const Plan* plan, assembly::OpenOptions open)
    : plan_(plan),
      open_(std::move(open)),
      shapes_(assembly::MakeShapeCache(open_.cache_directory)) {}

CellStore::CellResult CellStore::Prepare(std::int64_t index) {
  const std::lock_guard lock(mutex_);
  const auto kept = std::find_if(cells_.begin(), cells_.end(),
                                 [index](const auto& cell) { return cell->cell.index == index; });
  if (kept != cells_.end()) {
    return *kept;
  }
  auto made = PrepareNew(index);
  if (made) {
    cells_.push_back(*made);
    if (cells_.size() > kMostKept) {
      cells_.pop_front();
    }
  }
  return made;
}

Result<CellStore::OpenedProduct> CellStore::Open(std::size_t index) {
  if (opened_ && opened_->index == index) {
    return *opened_;
  }
  OpenedProduct opened;
  opened.index = index;
  assembly::OpenOptions open = open_;
  open.file = plan_->products[index];
  auto product = assembly::OpenProduct(open, &opened.diagnostics);
  if (!product) {
    return Unexpected(product.error());
  }
  opened.product = *std::move(product);
  opened_ = std::move(opened);
  return *opened_;
}

CellStore::CellResult CellStore::PrepareNew(std::int64_t index) {
  auto prepared = std::make_shared<PreparedCell>();
  prepared->cell = FindCell(*plan_, index);
  const auto same = std::find_if(cells_.begin(), cells_.end(), [&](const auto& other) {
    return IsSameProduct(other->cell, prepared->cell);
  });
  if (same != cells_.end()) {
    *prepared = PreparedCell{prepared->cell, (*same)->product, (*same)->fits, (*same)->diagnostics};
    return prepared;
  }
  const auto opened = Open(prepared->cell.product);
  if (!opened) {
    return Unexpected(opened.error());
  }
  prepared->product = opened->product;
  prepared->diagnostics = opened->diagnostics;
  for (const std::string& fit : plan_->fits[prepared->cell.fit].assignments) {
    if (const auto assigned = mates::AssignFit(&prepared->product, fit); !assigned) {
      return Unexpected(NamePlan(assigned.error(), *plan_, prepared->cell));
    }
  }
  const auto set =
      SetMaterials(plan_->materials[prepared->cell.material], *plan_, &prepared->product);
  if (!set) {
    return Unexpected(set.error());
  }
  auto fits =
      FitModel::Make(prepared->product, plan_->sizes[prepared->cell.sizes], &prepared->diagnostics);
  if (!fits) {
    return Unexpected(fits.error());
  }
  prepared->fits = *std::move(fits);
  return prepared;
}

RunResult CalcRun(const PreparedCell& cell, const Plan& plan, std::uint64_t seed) {
  // Each thread keeps the memory of these from one run to the next.
  thread_local std::vector<std::uint64_t> values;
  thread_local std::vector<MadeFit> made;
  values.resize(cell.fits.factors().size());
  cell.fits.DrawFactors(seed, values);
  made.clear();
  made.reserve(cell.fits.mates().size());
  for (std::size_t i = 0; i < cell.fits.mates().size(); ++i) {
    made.push_back(cell.fits.CalcFit(i, values));
  }
  RunResult result = cell.fits.Judge(made, plan);
  result.cell = cell.cell.index;
  result.seed = static_cast<std::int64_t>(seed);
  return result;
}

Result<RunResult> PlayRun(const PreparedCell& cell, const Plan& plan, std::uint64_t seed,
                          const PlayOptions& options) {
  product::Product product = cell.product;
  if (const SizeVariant& sizes = plan.sizes[cell.cell.sizes]; !HasPlainSizes(sizes)) {
    SetDrawnConditions(cell.fits, seed, sizes, &product);
  }
  assembly::PrepareOptions prepare;
  prepare.seed = seed;
  prepare.pairs = fits::PairChoice::kAny;
  prepare.shape_cache = options.shapes;
  prepare.stop = options.stop;
  Diagnostics diagnostics;
  const auto model = assembly::PrepareModel(std::move(product), prepare, &diagnostics);
  if (!model) {
    return Unexpected(model.error());
  }
  assembly::RunOptions run;
  run.seed = seed;
  run.person = plan.persons[cell.cell.person];
  run.record = options.record;
  run.is_record_replaced = options.is_record_replaced;
  run.stop = options.stop;
  const auto outcome = assembly::RunAssembly(*model, run);
  if (!outcome) {
    return Unexpected(outcome.error());
  }
  if (outcome->record_error) {
    return Unexpected(*outcome->record_error);
  }
  if (options.stop.stop_requested()) {
    return Fail(ErrorCode::kCancelled, "the run was stopped", cell.product.source);
  }
  RunResult result = CalcRun(cell, plan, seed);
  result.is_complete = outcome->is_complete();
  result.force = 0;
  for (const simulation::PartResult& part : outcome->parts) {
    result.force = std::max(result.force, part.peak_true);
    result.time += part.time;
    if (!part.is_seated && result.cause != Cause::kNotSeated) {
      result.cause = Cause::kNotSeated;
      result.entity = part.occurrence.value();
    }
  }
  return result;
}

std::string DescribePlay(const Plan& plan, const RunResult& run) {
  const Cell cell = FindCell(plan, run.cell);
  const SizeVariant& sizes = plan.sizes[cell.sizes];
  if (!HasPlainSizes(sizes) || !plan.materials[cell.material].parts.empty()) {
    return fmt::format("hvas campaign play {} {} --record run-{}.hvasrec",
                       QuoteWord(plan.file.string()), run.run, run.run);
  }
  std::string words = "hvas assemble " + QuoteWord(plan.products[cell.product].string());
  for (const std::string& fit : plan.fits[cell.fit].assignments) {
    words += " --fit " + QuoteWord(fit);
  }
  if (const auto person = plan.persons[cell.person]) {
    words += fmt::format(" --person {}", person::ToString(*person));
  }
  return words + fmt::format(" --sizes any --seed {} --record run-{}.hvasrec", run.seed, run.run);
}

}  // namespace hvas::campaign
