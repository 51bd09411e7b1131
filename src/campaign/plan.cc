#include "campaign/plan.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/regular_file.h"
#include "base/units.h"
#include "fits/iso286.h"
#include "fits/materials.h"
#include "yaml/yaml_fields.h"

namespace hvas::campaign {
namespace {

using yaml::Bounds;
using yaml::ListOf;
using yaml::NumbersOf;
using yaml::YamlDocument;
using yaml::YamlFields;

constexpr std::size_t kLargestPlan = 1'000'000;  // [bytes]: what YamlDocument reads.
constexpr std::size_t kMostVariants = 1000;      // of one list: a choice, more than a page can show
constexpr std::int64_t kMostRuns = 1'000'000'000'000;  // 1e12: years on any machine. A choice.
constexpr std::int64_t kMostPlanCells = 1'000'000;     // Each has a summary in memory: a choice.
constexpr int kMostShardRuns = 1'000'000;              // A shard is made in memory: about 100 MB.
constexpr double kMostSeeds = 2'000'000'000;           // of one cell: what an int has
constexpr double kLargestPress = 1e9;                  // [N]: no press is so strong
constexpr double kLargestDeviation_um = 10'000;        // beyond the widest zone of ISO 286
/** In the order of simulation::PersonKind, after the guided hand, which is no person. */
constexpr std::array<std::string_view, 4> kPersons{"guided", "careful", "hasty", "stiff"};

/** Whether a text is a valid id: ids are joined by " / " in names of cells. */
bool IsVariantId(std::string_view text) {
  return !text.empty() && text.size() <= 40 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-' || c == '.';
         });
}

/** Reads a document into a plan. */
class PlanReader {
 public:
  PlanReader(YamlDocument* document, Plan* plan) : document_(document), plan_(plan) {}

  void Read() {
    YamlFields fields(document_, document_->root(), "the plan");
    if (fields.Text("format") != kPlanFormat) {
      document_->Refuse(fields.Get("format"), "the format of the plan is not known",
                        fmt::format("write `format: {}`", kPlanFormat));
    }
    plan_->id = ReadId(&fields);
    plan_->method = fields.WordOr("method", kMethods, plan_->method);
    ReadProducts(&fields);
    ReadVariants(&fields, "fits", &plan_->fits,
                 [this](YamlFields* one, FitVariant* fit) { ReadFit(one, fit); });
    ReadVariants(&fields, "sizes", &plan_->sizes,
                 [this](YamlFields* one, SizeVariant* sizes) { ReadSizes(one, sizes); });
    ReadVariants(&fields, "materials", &plan_->materials,
                 [this](YamlFields* one, MaterialVariant* m) { ReadMaterials(one, m); });
    ReadPersons(&fields);
    ReadSeeds(&fields);
    if (fields.Has("press_force_n")) {
      plan_->press_force = fields.NumberOr("press_force_n", {1e-3, kLargestPress}, 0);
    }
    plan_->may_yield = fields.FlagOr("may_yield", plan_->may_yield);
    plan_->shard_runs = fields.IntegerOr("shard_runs", {1, kMostShardRuns},
                                         plan_->method == Method::kFits ? 10'000 : 20);
    ReadSensitivity(&fields);
    fields.Finish();
    CheckSize(fields);
  }

 private:
  std::string ReadId(YamlFields* fields) {
    std::string id = fields->Text("id");
    if (!id.empty() && !IsVariantId(id)) {
      document_->Refuse(fields->Get("id"),
                        fmt::format("the id \"{}\" of {} is not valid", id, fields->entity()),
                        "use at most 40 letters, digits, dots, - and _");
    }
    return id;
  }

  void ReadProducts(YamlFields* fields) {
    if (!fields->Require("products").IsDefined()) {
      return;
    }
    const auto files = fields->TextsOr("products", {});
    if (files.empty() || files.size() > kMostVariants) {
      document_->Refuse(fields->Get("products"), "\"products\" is empty, or has more than 1000",
                        "name 1 to 1000 CAD files");
    }
    for (const std::string& file : files) {
      const std::filesystem::path folder = plan_->file.parent_path();
      plan_->products.push_back(folder / file);
    }
  }

  /** Reads a list of variants, each a mapping with an id; without the list there is one variant,
   which leaves all as it is. */
  template <typename Variant, typename Reader>
  void ReadVariants(YamlFields* fields, const std::string& key, std::vector<Variant>* variants,
                    const Reader& read) {
    if (!fields->Has(key)) {
      variants->emplace_back().id = "default";
      return;
    }
    const YAML::Node list = fields->Get(key);
    std::set<std::string> ids;
    for (const YAML::Node& node : ListOf(document_, list, fmt::format("\"{}\"", key))) {
      YamlFields one(document_, node,
                     fmt::format("element {} of \"{}\"", variants->size() + 1, key));
      Variant variant;
      variant.id = ReadId(&one);
      if (!variant.id.empty() && !ids.insert(variant.id).second) {
        document_->Refuse(node,
                          fmt::format("the id \"{}\" occurs twice in \"{}\"", variant.id, key),
                          "give each an id of its own");
      }
      read(&one, &variant);
      one.Finish();
      variants->push_back(std::move(variant));
    }
    if (variants->empty() || variants->size() > kMostVariants) {
      document_->Refuse(list, fmt::format("\"{}\" is empty, or has more than 1000", key),
                        "write 1 to 1000 elements, or leave it out");
    }
  }

  void ReadFit(YamlFields* fields, FitVariant* fit) {
    fit->assignments = fields->TextsOr("assign", {});
    for (const std::string& assignment : fit->assignments) {
      const std::size_t equals = assignment.rfind('=');
      const std::string code = equals == std::string::npos ? "" : assignment.substr(equals + 1);
      if (!fits::ParseFit(code) && !fits::ParseToleranceClass(code)) {
        document_->Refuse(
            fields->Get("assign"),
            fmt::format("\"{}\" of {} is not an assignment of a fit", assignment, fields->entity()),
            "write AXIS=FIT, for example all=H7/g6 or m0=H7/p6");
      }
    }
  }

  std::vector<double> ReadDeviations(YamlFields* fields, const std::string& key) {
    const YAML::Node node = fields->Require(key);
    std::vector<double> deviations;
    for (const double deviation_um : NumbersOf(node)) {
      if (std::abs(deviation_um) > kLargestDeviation_um) {
        deviations.clear();
        break;
      }
      deviations.push_back(units::FromUm(deviation_um));
    }
    if (deviations.empty()) {
      document_->Refuse(
          node,
          fmt::format("\"{}\" of {} has no deviation, or one out of range", key, fields->entity()),
          "write measured deviations from the nominal size in um: [3, 5.5, -2]");
    }
    return deviations;
  }

  std::optional<UniformRange> ReadRange(YamlFields* fields, const std::string& key, Bounds bounds) {
    if (!fields->Has(key)) {
      return std::nullopt;
    }
    const YAML::Node node = fields->Get(key);
    const auto numbers = NumbersOf(node);
    if (numbers.size() != 2 || numbers[0] > numbers[1] || numbers[0] < bounds.low ||
        numbers[1] > bounds.high) {
      document_->Refuse(
          node, fmt::format("\"{}\" of {} is not a range", key, fields->entity()),
          fmt::format("write [low, high] within {:g} to {:g}", bounds.low, bounds.high));
      return std::nullopt;
    }
    return UniformRange{numbers[0], numbers[1]};
  }

  void ReadSizes(YamlFields* fields, SizeVariant* sizes) {
    sizes->spread = fields->WordOr("spread", kSpreads, sizes->spread);
    if (sizes->spread == Spread::kCapability) {
      sizes->cp = fields->NumberOr("cp", {0.1, 100}, sizes->cp);
      sizes->cpk = fields->NumberOr("cpk", {0.01, 100}, std::min(sizes->cp, sizes->cpk));
      if (sizes->cpk > sizes->cp) {
        document_->Refuse(fields->Get("cpk"),
                          fmt::format("\"cpk\" of {} is larger than its cp", fields->entity()),
                          "write a cpk of at most cp");
      }
    }
    if (sizes->spread == Spread::kMeasured) {
      sizes->hole_deviations = ReadDeviations(fields, "hole_deviations_um");
      sizes->shaft_deviations = ReadDeviations(fields, "shaft_deviations_um");
    }
    sizes->friction = ReadRange(fields, "friction", {0, 2});
    sizes->roughness = ReadRange(fields, "rz_um", {0, 1000});
    if (sizes->roughness) {
      sizes->roughness->low = units::FromUm(sizes->roughness->low);
      sizes->roughness->high = units::FromUm(sizes->roughness->high);
    }
  }

  void ReadMaterials(YamlFields* fields, MaterialVariant* variant) {
    const YAML::Node list = fields->Require("parts");
    if (!list.IsDefined()) {
      return;
    }
    for (const YAML::Node& node :
         ListOf(document_, list, fmt::format("\"parts\" of {}", fields->entity()))) {
      YamlFields one(document_, node, fmt::format("a part of {}", fields->entity()));
      PartMaterial part{one.Text("part"), one.Text("material")};
      if (!part.material.empty() && !fits::FindMaterial(part.material)) {
        document_->Refuse(one.Get("material"),
                          fmt::format("the material \"{}\" is not known", part.material),
                          "name one of the table that `hvas fit materials` prints");
      }
      one.Finish();
      variant->parts.push_back(std::move(part));
    }
  }

  void ReadPersons(YamlFields* fields) {
    const auto words = fields->TextsOr("persons", {"guided"});
    for (const std::string& word : words) {
      const auto found = std::find(kPersons.begin(), kPersons.end(), word);
      if (found == kPersons.end()) {
        document_->Refuse(fields->Get("persons"),
                          fmt::format("the person \"{}\" is not known", word),
                          fmt::format("write one or more of: {}", fmt::join(kPersons, ", ")));
        return;
      }
      const auto index = found - kPersons.begin();
      plan_->persons.push_back(
          index == 0 ? std::nullopt : std::optional(static_cast<person::PersonKind>(index - 1)));
    }
    const bool has_choice = plan_->method == Method::kAssemble;
    if (words.empty() || words.size() > kPersons.size() || (!has_choice && words.size() > 1)) {
      document_->Refuse(fields->Get("persons"),
                        "\"persons\" is empty, or has several with the method fits, which has none",
                        "leave it out, or write `method: assemble`");
    }
  }

  void ReadSeeds(YamlFields* fields) {
    const YAML::Node node = fields->Require("seeds");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields seeds(document_, node, "\"seeds\"");
    plan_->seeds.first = static_cast<std::uint64_t>(seeds.IntegerOr("first", {0, kMostSeeds}, 1));
    static_cast<void>(seeds.Require("count"));
    plan_->seeds.count = seeds.IntegerOr("count", {1, kMostSeeds}, 1);
    seeds.Finish();
  }

  void ReadSensitivity(YamlFields* fields) {
    const YAML::Node node = fields->Get("sensitivity");
    if (!node.IsDefined()) {
      return;
    }
    YamlFields these(document_, node, "\"sensitivity\"");
    SensitivityOptions options;
    options.samples = these.IntegerOr("samples", {64, 1e6}, options.samples);
    options.resamples = these.IntegerOr("resamples", {100, 10'000}, options.resamples);
    these.Finish();
    if (plan_->method != Method::kFits) {
      document_->Refuse(node, "\"sensitivity\" needs the method fits",
                        "remove it, or write `method: fits`");
    }
    plan_->sensitivity = options;
  }

  void CheckSize(const YamlFields& fields) {
    if (document_->error()) {
      return;
    }
    if (plan_->CountCells() > kMostPlanCells) {
      document_->Refuse(fields.node(),
                        fmt::format("the plan has {} combinations", plan_->CountCells()),
                        fmt::format("shorten its lists: at most {} are possible", kMostPlanCells));
    } else if (plan_->CountCells() > kMostRuns / plan_->seeds.count) {
      document_->Refuse(fields.node(), "the plan has more than 1e12 runs",
                        "lower the count of seeds");
    }
  }

  YamlDocument* document_;
  Plan* plan_;
};

}  // namespace

std::int64_t Plan::CountCells() const {
  std::int64_t count = 1;  // At most 1000^4 times 3.
  for (const std::size_t size :
       {products.size(), fits.size(), sizes.size(), materials.size(), persons.size()}) {
    count *= static_cast<std::int64_t>(size);
  }
  return count;
}

std::int64_t Plan::CountShards() const {
  return (CountRuns() + shard_runs - 1) / shard_runs;
}

Cell FindCell(const Plan& plan, std::int64_t index) {
  Cell cell;
  cell.index = index;
  auto rest = static_cast<std::size_t>(index);
  const auto take = [&rest](std::size_t size) {
    const std::size_t one = rest % size;
    rest /= size;
    return one;
  };
  cell.person = take(plan.persons.size());
  cell.material = take(plan.materials.size());
  cell.sizes = take(plan.sizes.size());
  cell.fit = take(plan.fits.size());
  cell.product = rest;
  return cell;
}

std::string DescribeCell(const Plan& plan, const Cell& cell) {
  std::vector<std::string> words;
  if (plan.products.size() > 1) {
    words.push_back(plan.products[cell.product].stem().string());
  }
  if (plan.fits.size() > 1) {
    words.push_back(plan.fits[cell.fit].id);
  }
  if (plan.sizes.size() > 1) {
    words.push_back(plan.sizes[cell.sizes].id);
  }
  if (plan.materials.size() > 1) {
    words.push_back(plan.materials[cell.material].id);
  }
  if (plan.persons.size() > 1) {
    words.emplace_back(Plan::NamePerson(plan.persons[cell.person]));
  }
  return words.empty() ? "all" : fmt::format("{}", fmt::join(words, " / "));
}

RunRange FindRuns(const Plan& plan, std::int64_t shard) {
  const std::int64_t first = shard * plan.shard_runs;
  return {first, std::min(first + plan.shard_runs, plan.CountRuns())};
}

Result<Plan> ParsePlan(const std::string& text, const std::filesystem::path& file) {
  auto document = YamlDocument::Parse(text, file.string());
  if (!document) {
    return Unexpected(document.error());
  }
  Plan plan;
  plan.file = file;
  plan.text = text;
  PlanReader(&*document, &plan).Read();
  if (document->error()) {
    return Unexpected(*document->error());
  }
  return plan;
}

Result<Plan> ReadPlan(const std::filesystem::path& file) {
  const Result<std::string> text = ReadRegularFile(file, kLargestPlan);
  return text ? ParsePlan(*text, file) : Unexpected(text.error());
}

}  // namespace hvas::campaign
