#include "app/product/product_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "app/output/text_table.h"
#include "app/product/joint_forms.h"
#include "app/product/overlaps_report.h"
#include "app/product/product_json.h"
#include "app/product/relations_report.h"
#include "base/units.h"
#include "mates/infer.h"
#include "product/names.h"

namespace hvas::app {
namespace {

using product::Mate;
using product::MateKind;
using product::Part;
using product::Product;
using units::ToMm;

double ToMm2(double area) {
  return ToMm(ToMm(area));
}

/** "axis hole" for "axis_hole". */
template <typename Kind>
std::string FormatKind(Kind kind) {
  std::string name = ToString(kind);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

template <typename Tag>
std::string List(const std::vector<Id<Tag>>& ids, std::string_view prefix = "") {
  std::vector<std::string> words;
  words.reserve(ids.size());
  for (const Id<Tag> id : ids) {
    words.push_back(fmt::format("{}{}", prefix, id.value()));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string FittedPathOf(const Product& product, product::OccurrenceId id, std::size_t width) {
  return Shorten(product.occurrences[id.index()].path, width);
}

/** Prints the tree line by line. */
class TreePrinter {
 public:
  TreePrinter(const Product& product, const Selection& selection, bool is_all)
      : product_(product), selection_(selection), limit_(is_all) {}

  void Print() {
    PrintNode(product::SubassemblyId(0), 0);
    limit_.PrintRest();
  }

 private:
  [[nodiscard]] bool HasSelected(product::SubassemblyId id) const {
    const product::Subassembly& node = product_.subassemblies[id.index()];
    return std::any_of(node.occurrences.begin(), node.occurrences.end(),
                       [this](product::OccurrenceId o) { return selection_.Has(o); }) ||
           std::any_of(node.subassemblies.begin(), node.subassemblies.end(),
                       [this](product::SubassemblyId s) { return HasSelected(s); });
  }

  void PrintLine(std::size_t indent, std::string_view name, int count) {
    if (limit_.Next()) {
      const std::string times = count > 1 ? fmt::format(" x {}", count) : "";
      const std::size_t used = std::min(indent, CountColumns() / 2);
      fmt::print("{}{}{}\n", std::string(used, ' '),
                 Shorten(name, CountColumns() - used - times.size()), times);
    }
  }

  /** One line for each subassembly and part; equal neighbours are counted, not listed. */
  void PrintNode(product::SubassemblyId id, std::size_t indent) {
    const product::Subassembly& node = product_.subassemblies[id.index()];
    PrintLine(indent, node.name, 1);
    for (const product::SubassemblyId child : node.subassemblies) {
      if (HasSelected(child)) {
        PrintNode(child, indent + 2);
      }
    }
    std::vector<std::pair<product::PartId, int>> counts;
    for (const product::OccurrenceId occurrence : node.occurrences) {
      if (!selection_.Has(occurrence)) {
        continue;
      }
      const product::PartId part = product_.occurrences[occurrence.index()].part;
      const auto it = std::find_if(counts.begin(), counts.end(),
                                   [part](const auto& entry) { return entry.first == part; });
      if (it == counts.end()) {
        counts.emplace_back(part, 1);
      } else {
        ++it->second;
      }
    }
    for (const auto& [part, count] : counts) {
      PrintLine(indent + 2, product_.parts[part.index()].name, count);
    }
  }

  const Product& product_;
  const Selection& selection_;
  ListLimit limit_;
};

void PrintParts(const Product& product, const Selection& selection, bool is_all) {
  TextTable table(
      {"id", "name, material", "uses", "mm3", "g", "kg/m3", "faces", "triangles", "features"}, 2);
  ListLimit limit(is_all);
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id) || !limit.Next()) {
      continue;
    }
    const auto uses =
        std::count_if(product.occurrences.begin(), product.occurrences.end(),
                      [&part](const product::Occurrence& o) { return o.part == part.id; });
    const product::Material& material = part.material;
    const std::string made_of = material.name.empty() ? material.standard : material.name;
    table.Add({fmt::format("p{}", part.id.value()),
               fmt::format("{}{}{}{}", part.name, made_of.empty() ? "" : ", ", made_of,
                           part.has_brep ? "" : " (triangles only)"),
               fmt::format("{}", uses), fmt::format("{:.1f}", units::ToMm3(part.mass.volume)),
               fmt::format("{:.3f}", 1e3 * part.mass.mass),
               fmt::format("{:.0f}{}", material.density, material.is_assumed ? "?" : " "),
               fmt::format("{}", part.faces.size()), fmt::format("{}", part.mesh.triangles.size()),
               fmt::format("{}", part.features.size())});
  }
  fmt::print("\nParts (? assumed)\n{}", table.ToText(2));
  limit.PrintRest();
}

std::string DescribeForm(const product::Form& form) {
  std::string text = FormatKind(form.kind);
  const auto add = [&text](bool is_there, const std::string& words) {
    text += is_there ? ", " + words : "";
  };
  add(form.count > 1,
      fmt::format("{} {}", form.count,
                  form.kind == product::FormKind::kHolePattern ? "holes" : "steps"));
  add(form.diameter > 0,
      fmt::format("{} {:.4g} mm", form.kind == product::FormKind::kSlot ? "width" : "diameter",
                  ToMm(form.diameter)));
  add(form.depth > 0, fmt::format("depth {:.4g} mm", ToMm(form.depth)));
  add(form.angle > 0, fmt::format("angle {:.4g} deg", units::ToDeg(form.angle)));
  add(form.lead_in > 0, fmt::format("lead-in {:.4g} mm", ToMm(form.lead_in)));
  return text;
}

std::string DescribeFeature(const product::Feature& feature) {
  std::string text = FormatKind(feature.kind);
  if (feature.radius > 0) {
    text += fmt::format(", diameter {:.4g} mm", ToMm(2 * feature.radius));
  }
  if (feature.half_angle > 0) {
    text += fmt::format(", angle {:.4g} deg", units::ToDeg(2 * feature.half_angle));
  }
  if (feature.span_high > feature.span_low) {
    text += fmt::format(", length {:.4g} mm", ToMm(feature.span_high - feature.span_low));
  }
  if (feature.thread != product::ThreadKind::kNone) {
    text += fmt::format(", {} thread", FormatKind(feature.thread));
    text += feature.thread_pitch > 0
                ? fmt::format(" of pitch {:.4g} mm", ToMm(feature.thread_pitch))
                : "";
  }
  return text;
}

/** Equal descriptions counted, in the order of the first of each. */
class Counted {
 public:
  void Add(std::string text, std::string which) {
    for (Entry& entry : entries_) {
      if (entry.text == text) {
        ++entry.count;
        entry.which += " " + which;
        return;
      }
    }
    entries_.push_back({std::move(text), std::move(which), 1});
  }

  void Print(ListLimit* limit) const {
    for (const Entry& entry : entries_) {
      if (limit->Next()) {
        constexpr std::size_t kMaxNames = 60;  // Columns, of 80 with what stands beside.
        std::string which = entry.which;
        if (which.size() > kMaxNames) {
          which = which.substr(0, which.rfind(' ', kMaxNames)) + " ...";
        }
        fmt::print("{}", Wrap(fmt::format("{} x {} ({})", entry.count, entry.text, which), 6));
      }
    }
  }

 private:
  struct Entry {
    std::string text;
    std::string which;
    int count;
  };

  std::vector<Entry> entries_;
};

void PrintFeatures(const Product& product, const Selection& selection, bool is_all) {
  fmt::print("\nFeatures\n");
  ListLimit limit(is_all);
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id) || (part.features.empty() && part.forms.empty()) || !limit.Next()) {
      continue;
    }
    fmt::print("{:>5}  {}\n", fmt::format("p{}", part.id.value()),
               Shorten(part.name, CountColumns() - 7));
    Counted counted;
    for (std::size_t i = 0; i < part.forms.size(); ++i) {
      counted.Add("form: " + DescribeForm(part.forms[i]), std::to_string(i));
    }
    for (std::size_t i = 0; i < part.features.size(); ++i) {
      // What the forms are made of is shown where it is asked for.
      if (part.forms.empty() || selection.is_chosen()) {
        counted.Add("feature: " + DescribeFeature(part.features[i]), std::to_string(i));
      }
    }
    counted.Print(&limit);
  }
  limit.PrintRest();
}

void PrintFaces(const Product& product, const Selection& selection, bool is_all) {
  TextTable table(
      {"part", "face", "kind, feature", "radius\nmm", "area\nmm2", "residual\nmm", "centre\nmm"},
      3);
  ListLimit limit(is_all);
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id)) {
      continue;
    }
    for (std::size_t i = 0; i < part.faces.size(); ++i) {
      if (!limit.Next()) {
        continue;
      }
      const product::Face& face = part.faces[i];
      std::string feature;
      for (std::size_t f = 0; f < part.features.size() && feature.empty(); ++f) {
        const auto& faces = part.features[f].faces;
        if (std::find(faces.begin(), faces.end(), product::FaceId(i)) != faces.end()) {
          feature = fmt::format(", {} {}", FormatKind(part.features[f].kind), f);
        }
      }
      const Vec3 centre = 0.5 * (face.box_B.low + face.box_B.high);
      table.Add({fmt::format("p{}", part.id.value()), fmt::format("{}", i),
                 FormatKind(face.surface.kind) + feature,
                 fmt::format("{:.4f}", ToMm(face.surface.radius)),
                 fmt::format("{:.3f}", ToMm2(face.area)),
                 fmt::format("{:.2g}", ToMm(face.residual)),
                 fmt::format("{:.2f} {:.2f} {:.2f}", ToMm(centre.x()), ToMm(centre.y()),
                             ToMm(centre.z()))});
    }
  }
  fmt::print("\nFaces\n{}", table.ToText(2));
  limit.PrintRest();
}

std::string DescribeConditions(const product::FitConditions& conditions) {
  std::string text;
  const auto add = [&text](const char* words, const std::optional<double>& value, double scale,
                           const char* unit) {
    text += value ? fmt::format("; {} {:.6g}{}", words, scale * *value, unit) : "";
  };
  const auto add_measured = [&text](const char* words,
                                    const std::vector<product::MeasuredDiameter>& measured) {
    for (std::size_t i = 0; i < measured.size(); ++i) {
      text += i == 0 ? fmt::format("; {} ", words) : std::string(", ");
      text += fmt::format("{:.6g} mm", ToMm(measured[i].diameter));
      text += measured.size() > 1 ? fmt::format(" at {:g} mm", ToMm(measured[i].depth)) : "";
    }
  };
  add_measured("measured hole", conditions.hole_diameters);
  add_measured("measured shaft", conditions.shaft_diameters);
  add("hole Rz", conditions.hole_roughness, units::ToUm(1), " um");
  add("shaft Rz", conditions.shaft_roughness, units::ToUm(1), " um");
  add("friction", conditions.friction, 1, "");
  add("hole at", conditions.hole_temperature_c, 1, " C");
  add("shaft at", conditions.shaft_temperature_c, 1, " C");
  return text;
}

std::string DescribeMate(const Mate& mate, bool with_evidence) {
  std::string text;
  switch (mate.kind) {
    case MateKind::kFaceFace:
      text = fmt::format("{:.2f} mm2", ToMm2(mate.overlap));
      break;
    case MateKind::kAxisHole:
      text =
          fmt::format("hole {:.4g} mm, shaft {:.4g} mm, engaged {:.2f} mm",
                      ToMm(2 * mate.hole_radius), ToMm(2 * mate.shaft_radius), ToMm(mate.overlap));
      break;
    case MateKind::kConeSeat:
      text = fmt::format("diameter {:.4g} mm, engaged {:.2f} mm", ToMm(2 * mate.hole_radius),
                         ToMm(mate.overlap));
      break;
    case MateKind::kSphereSeat:
      text = fmt::format("diameter {:.4g} mm, {:.2f} mm2", ToMm(2 * mate.hole_radius),
                         ToMm2(mate.overlap));
      break;
    case MateKind::kPrismatic:
      text = fmt::format("slot {:.5g} mm, tongue {:.5g} mm, engaged {:.2f} mm by {:.2f} mm",
                         ToMm(2 * mate.hole_radius), ToMm(2 * mate.shaft_radius),
                         ToMm(mate.overlap), ToMm(mate.breadth));
      break;
  }
  if (mate.fit) {
    text +=
        fmt::format("; {}{}{}{}", mate.fit->is_proposed ? "proposed " : "",
                    ToString(mate.fit->kind), mate.fit->code.empty() ? "" : " ", mate.fit->code);
    text += mate.fit->reason.empty() ? "" : fmt::format(" ({})", mate.fit->reason);
  }
  text += DescribeConditions(mate.conditions);
  text += mate.origin == product::MateOrigin::kUser ? "; by the user" : "";
  if (mate.confidence < 0.995) {
    text += fmt::format("; confidence {:.2f}", mate.confidence);
  }
  text += with_evidence && !mate.evidence.empty() ? "; " + mate.evidence : "";
  return text;
}

void PrintMates(const Product& product, const Selection& selection, bool is_all) {
  fmt::print("\nMates\n");
  ListLimit limit(is_all);
  for (const Mate& mate : product.mates) {
    if (!selection.Has(mate.id) || !limit.Next()) {
      continue;
    }
    PrintMate(product, mate, selection.is_chosen() || selection.is_filtered());
  }
  limit.PrintRest();
}

void PrintJoints(const Product& product, const Selection& selection, bool is_all) {
  if (product.joints.empty() && product.alignments.empty()) {
    return;
  }
  fmt::print("\nJoints, with the translations and rotations that they leave free\n");
  ListLimit limit(is_all);
  for (const product::Joint& joint : product.joints) {
    if (std::none_of(joint.mates.begin(), joint.mates.end(),
                     [&](product::MateId id) { return selection.Has(id); }) ||
        !limit.Next()) {
      continue;
    }
    const std::size_t width = (CountColumns() - 14) / 2;
    fmt::print("  {} t {} r  {} - {}\n", joint.free_translations, joint.free_rotations,
               FittedPathOf(product, joint.a, width), FittedPathOf(product, joint.b, width));
    fmt::print("{}", Wrap(fmt::format("{}{}", List(joint.mates, "m"),
                                      joint.pattern_count > 1
                                          ? fmt::format("; a pattern of {}", joint.pattern_count)
                                          : ""),
                          11));
  }
  limit.PrintRest();
  ListLimit hints(is_all);
  for (const product::Alignment& alignment : product.alignments) {
    if ((selection.Has(alignment.a.occurrence) || selection.Has(alignment.b.occurrence)) &&
        hints.Next()) {
      const std::size_t width = (CountColumns() - 16) / 2;
      fmt::print("  in line    {} - {}\n             holes with nothing through both\n",
                 FittedPathOf(product, alignment.a.occurrence, width),
                 FittedPathOf(product, alignment.b.occurrence, width));
    }
  }
  hints.PrintRest();
}

void PrintFits(const Product& product, const Selection& selection, bool is_all) {
  Counted fits;
  bool is_empty = true;
  for (const Mate& mate : product.mates) {
    if (mate.fit && selection.Has(mate.id)) {
      is_empty = false;
      fits.Add(fmt::format("{}{}{}{}, {:.6g} mm", mate.fit->is_proposed ? "proposed " : "",
                           ToString(mate.fit->kind), mate.fit->code.empty() ? "" : " ",
                           mate.fit->code, ToMm(mate.fit->nominal_diameter)),
               fmt::format("m{}", mate.id.value()));
    }
  }
  if (!is_empty) {
    fmt::print("\nFits\n");
    ListLimit limit(is_all);
    fits.Print(&limit);
    limit.PrintRest();
  }
}

/** " +0.1 -0.2", " +-0.1", or nothing. */
std::string DescribeLimits(const product::Dimension& dimension, double scale) {
  constexpr double kEqual = 1e-12;  // [m]: below any digit that is shown.
  const auto& [upper, lower] = std::pair(dimension.upper, dimension.lower);
  if (upper && lower && std::abs(*upper + *lower) < kEqual) {
    return fmt::format(" +-{:.6g}", scale * *upper);
  }
  return (upper ? fmt::format(" {:+.6g}", scale * *upper) : "") +
         (lower ? fmt::format(" {:+.6g}", scale * *lower) : "");
}

std::string DescribeFaces(const std::vector<product::FaceId>& faces) {
  return faces.empty() ? "no face" : "faces " + List(faces);
}

std::string DescribeDimension(const product::Dimension& dimension) {
  const bool is_angle = dimension.kind == product::DimensionKind::kAngular;
  const double scale = is_angle ? units::ToDeg(1) : ToMm(1);
  return fmt::format("{}: {} {:.6g}{} {}{} ({})", dimension.entity,
                     dimension.name.empty() ? ToString(dimension.kind) : dimension.name,
                     scale * dimension.nominal, DescribeLimits(dimension, scale),
                     is_angle ? "deg" : "mm", dimension.fit ? " " + *dimension.fit : "",
                     DescribeFaces(dimension.faces));
}

std::string DescribeTolerance(const product::GeometricTolerance& tolerance) {
  return fmt::format("{}: {} {:.6g} mm{}{} ({})", tolerance.entity, FormatKind(tolerance.kind),
                     ToMm(tolerance.magnitude), tolerance.datums.empty() ? "" : " to ",
                     fmt::join(tolerance.datums, " | "), DescribeFaces(tolerance.faces));
}

void PrintTolerances(const Product& product, const Selection& selection, bool is_all) {
  const ToleranceCounts counts = CountTolerances(product);
  if (counts.dimensions + counts.geometric == 0) {
    return;
  }
  fmt::print("\nTolerances\n");
  ListLimit limit(is_all);
  for (const Part& part : product.parts) {
    if (!selection.Has(part.id) || part.dimensions.size() + part.geometric_tolerances.size() == 0) {
      continue;
    }
    fmt::print("{:>5}  {}\n", fmt::format("p{}", part.id.value()),
               Shorten(part.name, CountColumns() - 7));
    for (const product::Dimension& dimension : part.dimensions) {
      if (limit.Next()) {
        fmt::print("{}", Wrap(DescribeDimension(dimension), 6));
      }
    }
    for (const product::GeometricTolerance& tolerance : part.geometric_tolerances) {
      if (limit.Next()) {
        fmt::print("{}", Wrap(DescribeTolerance(tolerance), 6));
      }
    }
  }
  limit.PrintRest();
}

void PrintDiagnostics(const Diagnostics& diagnostics, bool is_all) {
  if (diagnostics.items().empty()) {
    return;
  }
  fmt::print("\nOdd about the file\n");
  ListLimit limit(is_all);
  for (const Diagnostic& item : diagnostics.items()) {
    if (limit.Next()) {
      fmt::print("{}", Wrap(fmt::format("{} {} [{}]: {}{}", ToString(item.severity), item.code,
                                        item.entity, item.message,
                                        item.remedy.empty() ? "" : "; " + item.remedy),
                            2));
    }
  }
  limit.PrintRest();
}

/** What a summary calls several mates of a rare kind; empty for the kinds that it names always. */
std::string_view RarePluralOf(MateKind kind) {
  switch (kind) {
    case MateKind::kAxisHole:
    case MateKind::kFaceFace:
      return "";
    case MateKind::kConeSeat:
      return "cone seats";
    case MateKind::kSphereSeat:
      return "sphere seats";
    case MateKind::kPrismatic:
      return "prismatic";
  }
  return "";
}

/** "2 axis-hole and 2 face mates", and the rarer kinds where there are any. */
std::string CountMates(const Product& product) {
  const auto count = [&product](MateKind kind) {
    return std::count_if(product.mates.begin(), product.mates.end(),
                         [kind](const Mate& mate) { return mate.kind == kind; });
  };
  std::string rare;
  for (const MateKind kind : product::kMateKinds) {
    const std::string_view plural = RarePluralOf(kind);
    if (const auto found = count(kind); found > 0 && !plural.empty()) {
      rare += fmt::format(", {} {}", found, plural);
    }
  }
  return fmt::format("{} axis-hole and {} face mates{}", count(MateKind::kAxisHole),
                     count(MateKind::kFaceFace), rare);
}

void PrintSummary(const Product& product, const Diagnostics& diagnostics) {
  const mates::Linkage linkage = mates::CalcLinkage(product);
  const Vec3 size = product.box_W.size();
  fmt::print("\n{}: {} parts ({} different) in {} levels\n",
             Shorten(product.source, CountColumns() / 2), product.occurrences.size(),
             product.parts.size(), product.depth());
  fmt::print("{:.0f} mm3, {:.4g} kg, {:.1f} x {:.1f} x {:.1f} mm\n", units::ToMm3(product.volume()),
             product.mass(), ToMm(size.x()), ToMm(size.y()), ToMm(size.z()));
  fmt::print(
      "{}",
      Wrap(fmt::format("{}; {} of {} parts linked, in {} group{}; {} warnings", CountMates(product),
                       linkage.linked_parts, product.occurrences.size(), linkage.components,
                       linkage.components == 1 ? "" : "s", diagnostics.Count(Severity::kWarning)),
           0));
}

}  // namespace

void PrintMate(const Product& product, const Mate& mate, bool with_evidence) {
  const std::size_t width = (CountColumns() - 34) / 2;
  fmt::print("{:>6} {:<10} {:<11} {} <- {}\n", fmt::format("m{}", mate.id.value()), mate.key,
             FormatKind(mate.kind), FittedPathOf(product, mate.a.occurrence, width),
             FittedPathOf(product, mate.b.occurrence, width));
  fmt::print("{}", Wrap(DescribeMate(mate, with_evidence), 7));
}

void PrintText(const Product& product, const Diagnostics& diagnostics, const Selection& selection,
               bool is_all, WorkWatch* watch) {
  if (selection.Has(Section::kTree)) {
    TreePrinter(product, selection, is_all).Print();
  }
  if (selection.Has(Section::kParts)) {
    PrintParts(product, selection, is_all);
  }
  if (selection.Has(Section::kFeatures)) {
    PrintFeatures(product, selection, is_all);
  }
  if (selection.Has(Section::kFaces) && selection.is_chosen()) {
    PrintFaces(product, selection, is_all);
  }
  if (selection.Has(Section::kMates)) {
    PrintMates(product, selection, is_all);
  }
  if (selection.Has(Section::kJoints)) {
    PrintJoints(product, selection, is_all);
  }
  if (selection.Has(Section::kFits)) {
    PrintFits(product, selection, is_all);
    PrintJointForms(product, selection, is_all);
  }
  if (selection.Has(Section::kOverlaps)) {
    PrintOverlaps(product, selection, is_all, watch);
  }
  if (selection.Has(Section::kTolerances)) {
    PrintTolerances(product, selection, is_all);
  }
  PrintRequestedSections(product, selection, is_all);
  if (selection.Has(Section::kDiagnostics)) {
    PrintDiagnostics(diagnostics, is_all);
  }
  PrintSummary(product, diagnostics);
}

}  // namespace hvas::app
