#include "cad/triangles/tessellated.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cad/scene/placed_parts.h"
#include "cad/scene/product_tree.h"
#include "cad/step/material.h"
#include "cad/step/step_measure.h"
#include "cad/step/step_surface.h"
#include "cad/step/step_text.h"
#include "cad/step/text_encoding.h"
#include "cad/triangles/triangle_part.h"

namespace hvas::cad {
namespace {

using product::Color;
using product::Part;
using product::PartId;
using product::Product;
using product::SubassemblyId;
using spatial::Pose;
using Id = std::uint64_t;

// What is nested deeper runs in a circle: a choice.
constexpr int kDeepest = 100;

/** What of an entity's type is looked for: the record of that name, or nothing. */
/** One use of a product definition in another. */
struct Use {
  Id usage{0};  ///< NEXT_ASSEMBLY_USAGE_OCCURRENCE.
  Id child{0};
  std::string name;
};

class TessellationReader {
 public:
  TessellationReader(const StepText& text, const ImportOptions& options, const ReadWatch& watch,
                     Product* product, Diagnostics* diagnostics)
      : text_(text),
        options_(options),
        watch_(watch),
        product_(product),
        diagnostics_(diagnostics) {}

  Result<void> Read();

 private:
  void Index();
  void IndexRelation(const StepEntity& entity);
  void IndexRecord(Id id, const StepRecord& record);
  [[nodiscard]] std::string NameOf(Id definition) const;
  void Visit(Id definition, const std::string& name, SubassemblyId parent, const Pose& X_WP,
             int depth, ProductTree* tree);
  [[nodiscard]] Pose PoseOf(const Use& use) const;
  [[nodiscard]] std::vector<Id> ShapesOf(Id definition) const;
  [[nodiscard]] std::optional<PartId> FindPart(Id definition);
  void AddShape(Id representation, TriangleSoup* soup);
  void AddItem(Id item, const ShapeUnits& units, std::optional<Color> color, int depth,
               TriangleSoup* soup);
  void AddFace(Id face, const StepRecord& record, const ShapeUnits& units,
               std::optional<Color> color, TriangleSoup* soup);
  [[nodiscard]] const std::vector<Vec3>& PointsOf(Id coordinates);
  /** Fails where products are used more often than there may be parts. */
  [[nodiscard]] Result<void> CheckUses(const std::vector<Id>& roots) const;
  /** Reports what was left out, and what such a file lacks. */
  void ReportLimits() const;
  [[nodiscard]] std::optional<Color> ColorOf(Id item) const;

  const StepText& text_;
  const ImportOptions& options_;
  const ReadWatch& watch_;
  Product* product_;
  Diagnostics* diagnostics_;
  bool has_deep_products_{false};  // Deeper than kDeepest.
  bool has_deep_shells_{false};    // Deeper than AddItem goes.

  std::set<Id> shapes_;                         // Tessellated representations.
  std::map<Id, std::set<Id>> related_;          // Representations that stand for each other.
  std::map<Id, std::vector<Id>> shapes_of_;     // Representations of a product definition.
  std::map<Id, Id> shape_definitions_;          // PRODUCT_DEFINITION_SHAPE to what it is of.
  std::map<Id, std::vector<Use>> uses_;         // By the product definition around.
  std::set<Id> used_;                           // Product definitions that are in another.
  std::map<Id, Id> transformed_;                // Usage to its relation with transformation.
  std::vector<std::pair<Id, Id>> definitions_;  // (PRODUCT_DEFINITION_SHAPE, representation).
  std::vector<std::pair<Id, Id>> placed_;       // (relation, shape definition of the usage).
  std::vector<Id> products_;                    // Product definitions.
  std::map<Id, Id> styles_;                     // Item to its STYLED_ITEM.
  std::map<Id, std::vector<Vec3>> points_;      // In the file's unit.
  std::map<Id, std::optional<PartId>> parts_;   // By product definition; 0: the whole file.
};

void TessellationReader::IndexRelation(const StepEntity& entity) {
  const StepRecord* relation = nullptr;
  for (const char* name : {"SHAPE_REPRESENTATION_RELATIONSHIP", "REPRESENTATION_RELATIONSHIP"}) {
    const StepRecord* record = FindRecord(entity, name);
    relation = record != nullptr && record->values.size() >= 4 ? record : relation;
  }
  const bool is_transformed =
      FindRecord(entity, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") != nullptr;
  if (relation != nullptr && !is_transformed) {
    related_[relation->values[2].reference].insert(relation->values[3].reference);
    related_[relation->values[3].reference].insert(relation->values[2].reference);
  }
}

void TessellationReader::IndexRecord(Id id, const StepRecord& record) {
  const auto reference = [&record](std::size_t i) {
    return i < record.values.size() ? record.values[i].reference : 0;
  };
  if (record.name == "TESSELLATED_SHAPE_REPRESENTATION") {
    shapes_.insert(id);
  } else if (record.name == "SHAPE_DEFINITION_REPRESENTATION") {
    definitions_.emplace_back(reference(0), reference(1));
  } else if (record.name == "PRODUCT_DEFINITION_SHAPE") {
    shape_definitions_[id] = reference(2);
  } else if (record.name == "PRODUCT_DEFINITION" ||
             record.name == "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS") {
    products_.push_back(id);
  } else if (record.name == "NEXT_ASSEMBLY_USAGE_OCCURRENCE" && record.values.size() > 4) {
    uses_[reference(3)].push_back({id, reference(4), record.values[1].text});
    used_.insert(reference(4));
  } else if (record.name == "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
    placed_.emplace_back(reference(0), reference(1));
  } else if (record.name == "STYLED_ITEM" || record.name == "OVER_RIDING_STYLED_ITEM") {
    styles_.emplace(reference(2), id);
  }
}

/** One pass over the entities for what ties shapes to products. */
void TessellationReader::Index() {
  for (const StepText::Statement& statement : text_.statements()) {
    const std::string_view body = statement.body.substr(0, 400);
    const auto mentions = [body](std::string_view name) {
      return body.find(name) != std::string_view::npos;
    };
    if (!mentions("REPRESENTATION") && !mentions("PRODUCT_DEFINITION") &&
        !mentions("STYLED_ITEM") && !mentions("NEXT_ASSEMBLY")) {
      continue;
    }
    const StepEntity entity = ParseStepEntity(statement.body);
    IndexRelation(entity);
    for (const StepRecord& record : entity) {
      IndexRecord(statement.id, record);
    }
  }
  for (const auto& [relation, definition] : placed_) {
    const auto usage = shape_definitions_.find(definition);
    if (usage != shape_definitions_.end()) {
      transformed_[usage->second] = relation;
    }
  }
  for (const auto& [definition, representation] : definitions_) {
    const auto of = shape_definitions_.find(definition);
    if (of != shape_definitions_.end()) {
      shapes_of_[of->second].push_back(representation);
    }
  }
}

/** PRODUCT_DEFINITION, its formation, its PRODUCT. */
std::string TessellationReader::NameOf(Id definition) const {
  for (const StepRecord& record : text_.Find(definition)) {
    for (const StepRecord& formation :
         record.values.size() > 2 ? text_.Find(record.values[2].reference) : StepEntity()) {
      for (const StepRecord& product :
           formation.values.size() > 2 ? text_.Find(formation.values[2].reference) : StepEntity()) {
        if (product.name == "PRODUCT" && product.values.size() > 1) {
          const std::string name = CleanName(std::string_view(product.values[1].text));
          return name.empty() ? CleanName(std::string_view(product.values[0].text)) : name;
        }
      }
    }
  }
  return {};
}

/** The tessellated representations of a product definition, its own and those related to them. */
std::vector<Id> TessellationReader::ShapesOf(Id definition) const {
  std::set<Id> seen;
  std::vector<Id> queue;
  if (const auto own = shapes_of_.find(definition); own != shapes_of_.end()) {
    queue = own->second;
  }
  std::vector<Id> shapes;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Id id = queue[i];
    if (!seen.insert(id).second) {
      continue;
    }
    if (shapes_.count(id) > 0) {
      shapes.push_back(id);
    }
    if (const auto related = related_.find(id); related != related_.end()) {
      queue.insert(queue.end(), related->second.begin(), related->second.end());
    }
  }
  return shapes;
}

std::optional<Color> TessellationReader::ColorOf(Id item) const {
  const auto style = styles_.find(item);
  if (style == styles_.end()) {
    return std::nullopt;
  }
  constexpr std::size_t kMostSteps = 64;  // Entities on the way to a colour: a choice.
  std::vector<Id> queue{style->second};
  const auto follow = [&](const StepValue& value) {
    if (value.reference > 0 && value.reference != item) {
      queue.push_back(value.reference);
    }
  };
  for (std::size_t i = 0; i < queue.size() && i < kMostSteps; ++i) {
    for (const StepRecord& record : text_.Find(queue[i])) {
      if (record.name == "COLOUR_RGB" && record.values.size() > 3) {
        const auto part = [&record](std::size_t k) {
          return static_cast<float>(std::clamp(record.values[k].number, 0.0, 1.0));
        };
        return Color{part(1), part(2), part(3)};
      }
      for (const StepValue& value : record.values) {
        follow(value);
        std::for_each(value.items.begin(), value.items.end(), follow);
      }
    }
  }
  return std::nullopt;
}

const std::vector<Vec3>& TessellationReader::PointsOf(Id coordinates) {
  const auto [at, is_new] = points_.try_emplace(coordinates);
  if (is_new) {
    for (const StepRecord& record : text_.Find(coordinates)) {
      if (record.name != "COORDINATES_LIST" || record.values.size() < 3) {
        continue;
      }
      for (const StepValue& point : record.values[2].items) {
        at->second.push_back(
            point.items.size() == 3
                ? Vec3(point.items[0].number, point.items[1].number, point.items[2].number)
                : Vec3::Constant(std::nan("")));
      }
    }
  }
  return at->second;
}

/** Numbers of points, counted from 1, as indices into the vertices; what is none becomes one that
 cannot be used. */
std::uint32_t PointIndex(const StepValue& value, const std::vector<StepValue>& points,
                         std::uint32_t first) {
  double number = value.number;
  if (!points.empty()) {
    const bool is_there = number >= 1 && number <= static_cast<double>(points.size());
    number = is_there ? points[static_cast<std::size_t>(number) - 1].number : 0;
  }
  return number >= 1 && number < 1e9 ? first + static_cast<std::uint32_t>(number) - 1 : kNoTriangle;
}

void TessellationReader::AddFace(Id face, const StepRecord& record, const ShapeUnits& units,
                                 std::optional<Color> color, TriangleSoup* soup) {
  const bool is_complex = record.name.find("COMPLEX_") == 0;
  const bool is_set = record.name.find("_SURFACE_SET") != std::string::npos;
  const std::size_t index = is_set ? 4 : 5;  // Sets have no geometric link.
  if (record.values.size() <= index + (is_complex ? 2U : 1U)) {
    return;
  }
  const std::vector<Vec3>& points = PointsOf(record.values[1].reference);
  const auto first = static_cast<std::uint32_t>(soup->vertices.size());
  for (const Vec3& p : points) {
    soup->vertices.push_back(units.length * p);
  }
  const auto number = static_cast<std::uint32_t>(soup->faces.size());
  const Id link = is_set ? 0 : record.values[4].reference;
  const std::optional<Color> own = ColorOf(face);
  soup->faces.push_back(
      {link > 0 ? ReadStepSurface(text_, link, units) : std::nullopt, own ? own : color, face});
  const auto add = [&](const StepValue& a, const StepValue& b, const StepValue& c) {
    const std::vector<StepValue>& map = record.values[index].items;
    soup->triangles.push_back(
        {PointIndex(a, map, first), PointIndex(b, map, first), PointIndex(c, map, first)});
    soup->face.push_back(number);
  };
  for (const StepValue& list : record.values[index + 1].items) {
    const std::vector<StepValue>& p = list.items;
    for (std::size_t i = 2; i < p.size(); ++i) {  // A triangle is a strip of one.
      i % 2 == 0 ? add(p[i - 2], p[i - 1], p[i]) : add(p[i - 1], p[i - 2], p[i]);
    }
  }
  for (std::size_t k = 0; is_complex && k < record.values[index + 2].items.size(); ++k) {
    const std::vector<StepValue>& p = record.values[index + 2].items[k].items;
    for (std::size_t i = 2; i < p.size(); ++i) {
      add(p[0], p[i - 1], p[i]);
    }
  }
}

/** A face, or what holds faces. */
void TessellationReader::AddItem(Id item, const ShapeUnits& units, std::optional<Color> color,
                                 int depth, TriangleSoup* soup) {
  constexpr int kDeepestItem = 4;  // Levels of sets in sets: a choice.
  if (depth > kDeepestItem) {
    has_deep_shells_ = true;
    return;
  }
  for (const StepRecord& record : text_.Find(item)) {
    if (record.name.find("TRIANGULATED_FACE") != std::string::npos ||
        record.name.find("TRIANGULATED_SURFACE_SET") != std::string::npos) {
      AddFace(item, record, units, color, soup);
    } else if ((record.name == "TESSELLATED_SOLID" || record.name == "TESSELLATED_SHELL") &&
               record.values.size() > 1) {
      const std::optional<Color> own = ColorOf(item);
      for (const StepValue& value : record.values[1].items) {
        AddItem(value.reference, units, own ? own : color, depth + 1, soup);
      }
    }
  }
}

void TessellationReader::AddShape(Id representation, TriangleSoup* soup) {
  const ShapeUnits units{ReadUnitOf(text_, representation, Quantity::kLength),
                         ReadUnitOf(text_, representation, Quantity::kAngle)};
  for (const StepRecord& record : text_.Find(representation)) {
    if (record.values.size() > 1) {
      for (const StepValue& item : record.values[1].items) {
        AddItem(item.reference, units, ColorOf(representation), 0, soup);
      }
    }
  }
}

std::optional<PartId> TessellationReader::FindPart(Id definition) {
  const auto [known, is_new] = parts_.try_emplace(definition);
  if (!is_new) {
    return known->second;
  }
  TriangleSoup soup;
  const std::vector<Id> shapes =
      definition > 0 ? ShapesOf(definition) : std::vector<Id>(shapes_.begin(), shapes_.end());
  for (const Id shape : shapes) {
    AddShape(shape, &soup);
  }
  if (soup.triangles.empty()) {
    return std::nullopt;
  }
  Part part;
  part.id = PartId(product_->parts.size());
  part.name = definition > 0 ? NameOf(definition) : product_->name;
  part.name = part.name.empty() ? product_->name : part.name;
  const auto number = static_cast<std::uint32_t>(part.id.index());
  if (watch_.part) {
    watch_.part(number, part.name);
  }
  const auto& skipped = options_.skipped_parts;
  if (std::find(skipped.begin(), skipped.end(), number) == skipped.end()) {
    if (!soup.faces.empty() && soup.faces.front().color) {
      part.color = *soup.faces.front().color;
    }
    part.material = MakeMaterial(std::nullopt, part.name, diagnostics_);
    if (!BuildTrianglePart(soup, &part, diagnostics_)) {
      diagnostics_->Warn("no-mesh", part.name, "the part has no usable triangle and is omitted",
                         "export the part again");
    }
  }
  known->second = part.id;
  product_->parts.push_back(std::move(part));
  return known->second;
}

/** Where a child is: the relation's second item in the parent, over its first in the child. */
Pose TessellationReader::PoseOf(const Use& use) const {
  const auto relation = transformed_.find(use.usage);
  if (relation == transformed_.end()) {
    return {};
  }
  const StepEntity entity = text_.Find(relation->second);
  const StepRecord* with = FindRecord(entity, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION");
  const StepRecord* ends = FindRecord(entity, "REPRESENTATION_RELATIONSHIP");
  if (with == nullptr || with->values.empty() || ends == nullptr || ends->values.size() < 4) {
    return {};
  }
  for (const StepRecord& record : text_.Find(with->values.back().reference)) {
    if (record.name != "ITEM_DEFINED_TRANSFORMATION" || record.values.size() < 4) {
      continue;
    }
    const auto units = [this](Id representation) {
      return ShapeUnits{ReadUnitOf(text_, representation, Quantity::kLength), 1};
    };
    const auto one =
        ReadStepPlacement(text_, record.values[2].reference, units(ends->values[2].reference));
    const auto two =
        ReadStepPlacement(text_, record.values[3].reference, units(ends->values[3].reference));
    if (!one || !two) {
      return {};
    }
    const auto own = shapes_of_.find(use.child);
    const bool is_child_second =
        own != shapes_of_.end() && std::find(own->second.begin(), own->second.end(),
                                             ends->values[3].reference) != own->second.end();
    return is_child_second ? *one * two->Inverse() : *two * one->Inverse();
  }
  return {};
}

void TessellationReader::Visit(Id definition, const std::string& name, SubassemblyId parent,
                               const Pose& X_WP, int depth, ProductTree* tree) {
  has_deep_products_ = has_deep_products_ || depth > kDeepest;
  if (depth > kDeepest || product_->occurrences.size() > options_.max_parts) {
    return;
  }
  if (const std::optional<PartId> part = FindPart(definition)) {
    tree->AddOccurrence(parent, *part, name, X_WP);
  }
  const auto uses = uses_.find(definition);
  if (uses == uses_.end()) {
    return;
  }
  const SubassemblyId id = depth > 0 ? tree->AddSubassembly(parent, name) : parent;
  for (const Use& use : uses->second) {
    const std::string type = NameOf(use.child);
    Visit(use.child, type.empty() ? use.name : type, id, X_WP * PoseOf(use), depth + 1, tree);
  }
}

Result<void> TessellationReader::Read() {
  if (watch_.progress) {
    watch_.progress("parts", 0);
  }
  Index();
  std::vector<Id> roots;
  for (const Id id : products_) {
    if (used_.count(id) == 0) {
      roots.push_back(id);
    }
  }
  if (roots.size() == 1) {
    const std::string name = NameOf(roots.front());
    product_->name = name.empty() ? product_->name : name;
  }
  if (auto checked = CheckUses(roots); !checked) {
    return checked;
  }
  ProductTree tree(product_);
  for (const Id root : roots) {
    Visit(root, NameOf(root), SubassemblyId(0), {}, roots.size() > 1 ? 1 : 0, &tree);
  }
  if (product_->occurrences.size() > options_.max_parts) {
    return FailTooManyParts(options_.max_parts, product_->source);
  }
  if (product_->occurrences.empty()) {  // Shapes that no product claims.
    if (const std::optional<PartId> part = FindPart(0)) {
      tree.AddOccurrence(SubassemblyId(0), *part, product_->parts[part->index()].name, {});
    }
  }
  tree.Finish();
  if (product_->occurrences.empty()) {
    return Fail(ErrorCode::kUnreadable, "the file has no triangles", product_->source,
                "export the parts as solids");
  }
  ReportLimits();
  return {};
}

Result<void> TessellationReader::CheckUses(const std::vector<Id>& roots) const {
  Uses uses;
  for (const auto& [user, list] : uses_) {
    for (const Use& use : list) {
      uses[user].push_back(use.child);
    }
  }
  return CheckTree(ExamineTree(uses, roots), options_.max_parts, product_->source, "product #");
}

void TessellationReader::ReportLimits() const {
  if (has_deep_products_ || has_deep_shells_) {
    diagnostics_->Warn("limit-depth", product_->source,
                       fmt::format("{} nested too deep are left out",
                                   !has_deep_shells_    ? "products"
                                   : has_deep_products_ ? "products, and shells in shells,"
                                                        : "shells in shells"),
                       "export the product with fewer levels");
  }
  diagnostics_->Warn("no-brep", product_->source,
                     "the file has triangles and no solids; surfaces are those given in the file "
                     "or fitted to the triangles",
                     "export the product with exact geometry for exact areas and volumes");
}

}  // namespace

bool MayHoldTessellation(std::string_view step_text) {
  return step_text.find("TESSELLATED_SHAPE_REPRESENTATION") != std::string_view::npos &&
         step_text.find("TRIANGULATED_") != std::string_view::npos;
}

Result<void> ReadTessellated(const StepText& text, const ImportOptions& options,
                             const ReadWatch& watch, Product* product, Diagnostics* diagnostics) {
  return TessellationReader(text, options, watch, product, diagnostics).Read();
}

}  // namespace hvas::cad
