#include "app/inspect.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/load_product.h"
#include "app/product_json.h"
#include "base/units.h"
#include "mates/infer.h"

namespace hvas::app {
namespace {

using product::Mate;
using product::MateKind;
using product::Product;
using units::ToMm;

/** The tree with one line for each subassembly and part; equal neighbours are counted, not listed.
 */
void PrintTree(const Product& product, product::SubassemblyId id, int level) {
  const product::Subassembly& node = product.subassemblies[id.index()];
  const std::string indent(static_cast<std::size_t>(2 * level), ' ');
  fmt::print("{}{}\n", indent, node.name);
  for (const auto child : node.subassemblies) {
    PrintTree(product, child, level + 1);
  }
  std::vector<std::pair<product::PartId, int>> counts;
  for (const auto occurrence : node.occurrences) {
    const auto part = product.occurrences[occurrence.index()].part;
    const auto it = std::find_if(counts.begin(), counts.end(),
                                 [part](const auto& entry) { return entry.first == part; });
    if (it == counts.end()) {
      counts.emplace_back(part, 1);
    } else {
      ++it->second;
    }
  }
  for (const auto& [part, count] : counts) {
    fmt::print("{}  {}{}\n", indent, product.parts[part.index()].name,
               count > 1 ? fmt::format(" x {}", count) : "");
  }
}

void PrintParts(const Product& product) {
  fmt::print("\nParts\n  {:>3} {:>4}  {:>12} {:>10} {:>9} {:>6} {:>5} {:>6} {:>6} {:>9}  {}\n",
             "id", "uses", "volume_mm3", "mass_g", "kg_per_m3", "faces", "holes", "shafts",
             "planes", "triangles", "name");
  for (const product::Part& part : product.parts) {
    const auto uses =
        std::count_if(product.occurrences.begin(), product.occurrences.end(),
                      [&part](const product::Occurrence& o) { return o.part == part.id; });
    const auto features = [&part](product::FeatureKind kind) {
      return std::count_if(part.features.begin(), part.features.end(),
                           [kind](const product::Feature& f) { return f.kind == kind; });
    };
    fmt::print("  {:>3} {:>4}  {:>12.1f} {:>10.3f} {:>8.0f}{} {:>6} {:>5} {:>6} {:>6} {:>9}  {}\n",
               part.id.value(), uses, units::ToMm3(part.mass.volume), 1e3 * part.mass.mass,
               part.material.density, part.material.is_assumed ? "?" : " ", part.faces.size(),
               features(product::FeatureKind::kHole), features(product::FeatureKind::kShaft),
               features(product::FeatureKind::kPlane), part.mesh.triangles.size(), part.name);
  }
}

std::string DescribeMate(const Mate& mate) {
  if (mate.kind == MateKind::kFaceFace) {
    return fmt::format("face on face, {:.2f} mm2", mate.overlap * 1e6);
  }
  std::string text =
      fmt::format("hole {:.4g} mm, shaft {:.4g} mm, engaged {:.2f} mm", ToMm(2 * mate.hole_radius),
                  ToMm(2 * mate.shaft_radius), ToMm(mate.overlap));
  if (mate.fit) {
    text +=
        fmt::format(", {}{}{}{}", mate.fit->is_proposed ? "proposed " : "",
                    ToString(mate.fit->kind), mate.fit->code.empty() ? "" : " ", mate.fit->code);
    text += mate.fit->reason.empty() ? "" : fmt::format(" ({})", mate.fit->reason);
  }
  return text;
}

void PrintMates(const Product& product) {
  fmt::print("\nMates\n");
  for (const Mate& mate : product.mates) {
    fmt::print("  {:>3}  {} <- {}: {}\n", mate.id.value(),
               product.occurrences[mate.a.occurrence.index()].path,
               product.occurrences[mate.b.occurrence.index()].path, DescribeMate(mate));
  }
}

/** " +0.1 -0.2", " +-0.1", or nothing. */
std::string DescribeLimits(const product::Dimension& dimension, double scale) {
  constexpr double kEqual = 1e-12;
  const auto& [upper, lower] = std::pair(dimension.upper, dimension.lower);
  if (upper && lower && std::abs(*upper + *lower) < kEqual) {
    return fmt::format(" +-{:.6g}", scale * *upper);
  }
  return (upper ? fmt::format(" {:+.6g}", scale * *upper) : "") +
         (lower ? fmt::format(" {:+.6g}", scale * *lower) : "");
}

std::string DescribeFaces(const std::vector<product::FaceId>& faces) {
  std::vector<std::uint32_t> ids;
  for (const product::FaceId face : faces) {
    ids.push_back(face.value());
  }
  return ids.empty() ? "no face" : fmt::format("faces {}", fmt::join(ids, " "));
}

void PrintTolerances(const Product& product) {
  const ToleranceCounts counts = CountTolerances(product);
  if (counts.dimensions + counts.geometric == 0) {
    return;
  }
  fmt::print("\nTolerances\n");
  for (const product::Part& part : product.parts) {
    for (const product::Dimension& dimension : part.dimensions) {
      const bool is_angle = dimension.kind == product::DimensionKind::kAngular;
      const double scale = is_angle ? units::ToDeg(1) : ToMm(1);
      fmt::print("  {} {}: {} {:.6g}{} {}{} ({})\n", part.name, dimension.entity,
                 dimension.name.empty() ? ToString(dimension.kind) : dimension.name,
                 scale * dimension.nominal, DescribeLimits(dimension, scale),
                 is_angle ? "deg" : "mm", dimension.fit ? " " + *dimension.fit : "",
                 DescribeFaces(dimension.faces));
    }
    for (const product::GeometricTolerance& tolerance : part.geometric_tolerances) {
      fmt::print("  {} {}: {} {:.6g} mm{}{} ({})\n", part.name, tolerance.entity,
                 ToString(tolerance.kind), ToMm(tolerance.magnitude),
                 tolerance.datums.empty() ? "" : " to ", fmt::join(tolerance.datums, " | "),
                 DescribeFaces(tolerance.faces));
    }
  }
}

void PrintText(const Product& product, const Diagnostics& diagnostics) {
  const auto axis_hole =
      std::count_if(product.mates.begin(), product.mates.end(),
                    [](const Mate& mate) { return mate.kind == MateKind::kAxisHole; });
  const mates::Linkage linkage = mates::CalcLinkage(product);
  const Vec3 size = product.box_W.size();
  PrintTree(product, product::SubassemblyId(0), 0);
  PrintParts(product);
  PrintMates(product);
  PrintTolerances(product);
  if (!diagnostics.items().empty()) {
    fmt::print("\nOdd about the file\n");
  }
  for (const Diagnostic& item : diagnostics.items()) {
    fmt::print("  {} {} [{}]: {}{}\n", ToString(item.severity), item.code, item.entity,
               item.message, item.remedy.empty() ? "" : "; " + item.remedy);
  }
  fmt::print(
      "\n{}: {} parts ({} different) in {} levels, {:.0f} mm3, {:.4g} kg, {:.1f} x {:.1f} x {:.1f} "
      "mm\n{} axis-hole and {} face mates; {} of {} parts linked, in {} group{}; {} warnings\n",
      product.source, product.occurrences.size(), product.parts.size(), product.depth(),
      units::ToMm3(product.volume()), product.mass(), ToMm(size.x()), ToMm(size.y()),
      ToMm(size.z()), axis_hole, static_cast<std::ptrdiff_t>(product.mates.size()) - axis_hole,
      linkage.linked_parts, product.occurrences.size(), linkage.components,
      linkage.components == 1 ? "" : "s", diagnostics.Count(Severity::kWarning));
}

}  // namespace

int RunInspect(const InspectOptions& options) {
  Diagnostics diagnostics;
  const auto product = LoadProduct(options.load, &diagnostics);
  if (!product) {
    fmt::print(stderr, "hvas: {}\n", product.error().ToString());
    return 1;
  }
  if (options.is_json) {
    // Names that are no UTF-8 in the file must not cost the whole answer.
    fmt::print("{}\n", ToJson(*product, diagnostics)
                           .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  } else {
    PrintText(*product, diagnostics);
  }
  return 0;
}

void AddInspect(CLI::App* app, int* status) {
  CLI::App* command =
      app->add_subcommand("inspect", "Show what is in a STEP assembly: tree, parts, mates, fits");
  const auto options = std::make_shared<InspectOptions>();
  command->add_option("file", options->load.file, "STEP file (AP203, AP214, AP242)")->required();
  command->add_flag("--json", options->is_json, "Print one JSON document");
  AddLoadOptions(command, &options->load);
  command->footer(
      "Examples:\n"
      "  hvas inspect pump.step\n"
      "  hvas inspect pump.step --json | jq .summary");
  command->callback([options, status] { *status = RunInspect(*options); });
}

}  // namespace hvas::app
