#include "cad/assembly_tree.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_Transform.hxx>
#include <NCollection_DataMap.hxx>
#include <Quantity_Color.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "base/units.h"
#include "cad/material.h"
#include "cad/part_shape.h"
#include "product/features.h"

namespace hvas::cad {
namespace {

using product::Color;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using product::Subassembly;
using product::SubassemblyId;

constexpr std::size_t kMaxOccurrences = 1000000;
constexpr double kScaleTolerance = 1e-6;

using FaceEntities = NCollection_DataMap<TopoDS_Shape, std::uint64_t, TopTools_ShapeMapHasher>;
using FaceColors = NCollection_DataMap<TopoDS_Shape, Color, TopTools_ShapeMapHasher>;

std::string ToUtf8(const TCollection_ExtendedString& text) {
  std::string bytes(static_cast<std::size_t>(text.LengthOfCString()) + 1, '\0');
  char* data = bytes.data();
  const int length = text.ToUTF8CString(data);
  bytes.resize(static_cast<std::size_t>(std::max(length, 0)));
  return bytes;
}

/** A label's name without surrounding blanks; may be empty. */
std::string NameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) {
    return {};
  }
  const std::string text = ToUtf8(name->Get());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos
             ? std::string()
             : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/** Whether an instance's name was made up by a program and the product's name says more. */
bool IsGenerated(const std::string& name) {
  return name.rfind("NAUO", 0) == 0 || name.rfind("=>", 0) == 0 ||
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0 || c == ':'; });
}

std::string InstanceName(const TDF_Label& component, const TDF_Label& definition) {
  const std::string own = NameOf(component);
  const std::string type = NameOf(definition);
  if (!own.empty() && !IsGenerated(own)) {
    return own;
  }
  return type.empty() ? "part" : type;
}

Color ToColor(const Quantity_Color& color) {
  double r = 0;
  double g = 0;
  double b = 0;
  color.Values(r, g, b, Quantity_TOC_sRGB);
  return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

std::optional<Color> ColorOf(const Handle(XCAFDoc_ColorTool) & tool, const TDF_Label& label) {
  Quantity_Color color;
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
    if (tool->GetColor(label, type, color)) {
      return ToColor(color);
    }
  }
  return std::nullopt;
}

/** The material that a label refers to, if any. */
std::optional<TDF_Label> MaterialLabel(const TDF_Label& label) {
  Handle(TDataStd_TreeNode) node;
  if (label.FindAttribute(XCAFDoc::MaterialRefGUID(), node) && node->HasFather()) {
    return node->Father()->Label();
  }
  return std::nullopt;
}

/** Walks an XCAF document and fills a product. */
class TreeBuilder {
 public:
  TreeBuilder(const Handle(TDocStd_Document) & document, const ImportOptions& options,
              const ReadWatch& watch, Product* product, Diagnostics* diagnostics,
              const FaceEntityFn& entity_of)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        materials_(XCAFDoc_DocumentTool::MaterialTool(document->Main())),
        options_(options),
        watch_(watch),
        product_(product),
        diagnostics_(diagnostics),
        entity_of_(entity_of) {}

  Result<void> Build();

 private:
  /** A part yet to be built: a definition, and the scale of its instance (-1: mirrored). */
  struct PartSource {
    TDF_Label definition;
    double scale{1};
    std::optional<Color> instance_color;
  };

  /** Names already used among the children of one subassembly. */
  struct Siblings {
    std::string path;
    std::map<std::string, int> used;
  };

  SubassemblyId AddSubassembly(SubassemblyId parent, const std::string& name);
  std::string ClaimPath(SubassemblyId parent, const std::string& name);
  void Visit(const TDF_Label& definition, const TDF_Label& instance, SubassemblyId parent,
             const gp_Trsf& X_WP);
  void VisitComponents(const TDF_Label& assembly, SubassemblyId id, const gp_Trsf& X_WP);
  void AddLeaf(const TDF_Label& definition, const TDF_Label& instance, SubassemblyId parent,
               const gp_Trsf& X_WB);
  std::optional<PartId> FindPart(const TDF_Label& definition, const TDF_Label& instance,
                                 double scale);
  bool BuildPart(const PartSource& source, Part* part);
  void SetMaterial(const TDF_Label& definition, Part* part);
  FaceColors CollectColors(const TDF_Label& definition, Part* part, bool* has_color);
  void BuildParts();
  void DropUnbuilt(const std::vector<bool>& is_built);

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  Handle(XCAFDoc_MaterialTool) materials_;
  const ImportOptions& options_;
  const ReadWatch& watch_;
  Product* product_;
  Diagnostics* diagnostics_;
  const FaceEntityFn& entity_of_;
  std::vector<PartSource> sources_;  // One for each of product_->parts.
  std::map<std::pair<std::string, long>, std::optional<PartId>> known_;  // By entry and scale.
  std::vector<Siblings> siblings_;  // One for each subassembly.
  bool is_too_large_{false};
};

SubassemblyId TreeBuilder::AddSubassembly(SubassemblyId parent, const std::string& name) {
  const SubassemblyId id(product_->subassemblies.size());
  Subassembly subassembly;
  subassembly.id = id;
  subassembly.parent = parent;
  subassembly.name = name;
  siblings_.push_back({parent.is_valid() ? ClaimPath(parent, name) : name, {}});
  product_->subassemblies.push_back(std::move(subassembly));
  if (parent.is_valid()) {
    product_->subassemblies[parent.index()].subassemblies.push_back(id);
  }
  return id;
}

std::string TreeBuilder::ClaimPath(SubassemblyId parent, const std::string& name) {
  Siblings& siblings = siblings_[parent.index()];
  std::string step = name;
  std::replace(step.begin(), step.end(), '/', '_');
  const std::string base = step;
  for (int& count = siblings.used[base]; ++count > 1;) {
    step = fmt::format("{}#{}", base, count);
    if (siblings.used.count(step) == 0) {  // Someone may be called "nut#2" by birth.
      siblings.used[step] = 1;
      break;
    }
  }
  return siblings.path + "/" + step;
}

void TreeBuilder::Visit(const TDF_Label& definition, const TDF_Label& instance,
                        SubassemblyId parent, const gp_Trsf& X_WP) {
  if (product_->occurrences.size() > kMaxOccurrences) {
    is_too_large_ = true;
    return;
  }
  if (XCAFDoc_ShapeTool::IsAssembly(definition)) {
    const SubassemblyId id = AddSubassembly(parent, InstanceName(instance, definition));
    VisitComponents(definition, id, X_WP);
  } else {
    AddLeaf(definition, instance, parent, X_WP);
  }
}

void TreeBuilder::VisitComponents(const TDF_Label& assembly, SubassemblyId id,
                                  const gp_Trsf& X_WP) {
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(assembly, components);
  for (const TDF_Label& component : components) {
    TDF_Label definition;
    if (XCAFDoc_ShapeTool::GetReferredShape(component, definition)) {
      const gp_Trsf X_PC = XCAFDoc_ShapeTool::GetLocation(component).Transformation();
      Visit(definition, component, id, X_WP * X_PC);
    }
  }
}

void TreeBuilder::AddLeaf(const TDF_Label& definition, const TDF_Label& instance,
                          SubassemblyId parent, const gp_Trsf& X_WB) {
  double scale = X_WB.ScaleFactor();
  if (std::abs(scale - 1) < kScaleTolerance) {
    scale = 1;
  }
  const std::optional<PartId> part = FindPart(definition, instance, scale);
  if (!part) {
    return;
  }
  product::Occurrence occurrence;
  occurrence.id = OccurrenceId(product_->occurrences.size());
  occurrence.part = *part;
  occurrence.parent = parent;
  occurrence.name = InstanceName(instance, definition);
  occurrence.path = ClaimPath(parent, occurrence.name);
  // gp_Trsf is scale times rotation, then translation; the scale is in the part.
  const gp_Quaternion q = X_WB.GetRotation();
  const gp_XYZ& p = X_WB.TranslationPart();
  occurrence.X_WB = {Quat(q.W(), q.X(), q.Y(), q.Z()).normalized(),
                     Vec3(units::FromMm(p.X()), units::FromMm(p.Y()), units::FromMm(p.Z()))};
  product_->subassemblies[parent.index()].occurrences.push_back(occurrence.id);
  product_->occurrences.push_back(std::move(occurrence));
}

std::optional<PartId> TreeBuilder::FindPart(const TDF_Label& definition, const TDF_Label& instance,
                                            double scale) {
  TCollection_AsciiString entry;
  TDF_Tool::Entry(definition, entry);
  const auto key = std::pair(std::string(entry.ToCString()), std::lround(scale / kScaleTolerance));
  const auto known = known_.find(key);
  if (known != known_.end()) {
    return known->second;
  }
  const std::string name = InstanceName(definition, definition);
  std::optional<PartId> id;
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(definition);
  if (shape.IsNull() || CountContent(shape).faces == 0) {
    diagnostics_->Note("no-face", name, "curves or points only; left out");
  } else {
    id = PartId(product_->parts.size());
    Part part;
    part.id = *id;
    part.name = name;
    product_->parts.push_back(std::move(part));
    sources_.push_back({definition, scale, ColorOf(colors_, instance)});
    if (scale != 1) {
      diagnostics_->Note("baked-scale", name,
                         fmt::format("an instance is {} by {}; it became a part of its own",
                                     scale < 0 ? "mirrored" : "scaled", scale));
    }
  }
  known_[key] = id;
  return id;
}

void TreeBuilder::SetMaterial(const TDF_Label& definition, Part* part) {
  std::optional<TDF_Label> label = MaterialLabel(definition);
  TDF_LabelSequence children;
  XCAFDoc_ShapeTool::GetSubShapes(definition, children);
  for (const TDF_Label& child : children) {
    if (!label) {
      label = MaterialLabel(child);
    }
  }
  std::optional<double> density;
  double value = 0;
  if (label) {
    Handle(TCollection_HAsciiString) name;
    Handle(TCollection_HAsciiString) description;
    Handle(TCollection_HAsciiString) density_name;
    Handle(TCollection_HAsciiString) density_type;
    if (materials_->GetMaterial(*label, name, description, value, density_name, density_type)) {
      part->material.name = name.IsNull() ? "" : name->ToCString();
      density = NormaliseDensity(value);
    }
  }
  if (density) {
    part->material.density = *density;
    part->material.is_assumed = false;
    return;
  }
  diagnostics_->Note(
      "assumed-density", part->name,
      value == 0 ? fmt::format("no density given; {} kg/m3 assumed", part->material.density)
                 : fmt::format("a density of {} makes no sense in any unit; {} kg/m3 assumed",
                               value, part->material.density));
}

FaceColors TreeBuilder::CollectColors(const TDF_Label& definition, Part* part, bool* has_color) {
  FaceColors face_colors;
  if (const auto color = ColorOf(colors_, definition)) {
    part->color = *color;
    *has_color = true;
  }
  TDF_LabelSequence children;
  XCAFDoc_ShapeTool::GetSubShapes(definition, children);
  // Solids and shells first, so that a face's own colour wins.
  for (const bool is_face_pass : {false, true}) {
    for (const TDF_Label& child : children) {
      const auto color = ColorOf(colors_, child);
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(child);
      if (!color || shape.IsNull() || (shape.ShapeType() == TopAbs_FACE) != is_face_pass) {
        continue;
      }
      if (!*has_color && shape.ShapeType() == TopAbs_SOLID) {
        part->color = *color;
        *has_color = true;
      }
      for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
        face_colors.Bind(it.Current(), *color);
      }
    }
  }
  return face_colors;
}

bool TreeBuilder::BuildPart(const PartSource& source, Part* part) {
  SetMaterial(source.definition, part);
  bool has_color = false;
  FaceColors face_colors = CollectColors(source.definition, part, &has_color);
  if (!has_color && source.instance_color) {
    part->color = *source.instance_color;
  }
  FaceEntities entities;  // Of the moved faces.
  TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(source.definition);
  if (source.scale != 1) {
    gp_Trsf scaling;
    scaling.SetScale(gp_Pnt(), source.scale);
    BRepBuilderAPI_Transform transform(shape, scaling, true);
    FaceColors moved;
    for (FaceColors::Iterator it(face_colors); it.More(); it.Next()) {
      moved.Bind(transform.ModifiedShape(it.Key()), it.Value());
    }
    if (entity_of_) {
      for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
        entities.Bind(transform.ModifiedShape(it.Current()),
                      entity_of_(TopoDS::Face(it.Current())));
      }
    }
    face_colors = moved;
    shape = transform.Shape();
  }
  const FaceColorFn color_of = [&face_colors](const TopoDS_Face& face) -> std::optional<Color> {
    const Color* color = face_colors.Seek(face);
    return color != nullptr ? std::optional(*color) : std::nullopt;
  };
  const FaceEntityFn entity_of = [this, &entities](const TopoDS_Face& face) -> std::uint64_t {
    const std::uint64_t* entity = entities.Seek(face);
    return entity != nullptr ? *entity : entity_of_ ? entity_of_(face) : 0;
  };
  if (!BuildPartShape(shape, options_, color_of, part, diagnostics_, entity_of)) {
    diagnostics_->Warn("no-mesh", part->name, "the part could not be meshed; left out",
                       "heal the part in the CAD system and export it again");
    return false;
  }
  product::BuildFeatures(part);
  return true;
}

void TreeBuilder::BuildParts() {
  std::vector<bool> is_built;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (watch_.progress) {
      watch_.progress("parts", static_cast<double>(i) / static_cast<double>(sources_.size()));
    }
    const auto& skipped = options_.skipped_parts;
    const auto number = static_cast<std::uint32_t>(i);
    if (std::find(skipped.begin(), skipped.end(), number) != skipped.end()) {
      is_built.push_back(false);
      continue;
    }
    if (watch_.part) {
      watch_.part(number, product_->parts[i].name);
    }
    is_built.push_back(BuildPart(sources_[i], &product_->parts[i]));
  }
  if (std::find(is_built.begin(), is_built.end(), false) != is_built.end()) {
    DropUnbuilt(is_built);
  }
}

/** Removes parts without geometry with their occurrences and numbers the rest anew. */
void TreeBuilder::DropUnbuilt(const std::vector<bool>& is_built) {
  std::vector<Part> parts;
  std::vector<PartId> new_part(is_built.size());
  for (std::size_t i = 0; i < is_built.size(); ++i) {
    if (is_built[i]) {
      new_part[i] = PartId(parts.size());
      parts.push_back(std::move(product_->parts[i]));
      parts.back().id = new_part[i];
    }
  }
  product_->parts = std::move(parts);
  for (Subassembly& subassembly : product_->subassemblies) {
    subassembly.occurrences.clear();
  }
  std::vector<product::Occurrence> occurrences;
  for (product::Occurrence& occurrence : product_->occurrences) {
    occurrence.part = new_part[occurrence.part.index()];
    if (occurrence.part.is_valid()) {
      occurrence.id = OccurrenceId(occurrences.size());
      product_->subassemblies[occurrence.parent.index()].occurrences.push_back(occurrence.id);
      occurrences.push_back(std::move(occurrence));
    }
  }
  product_->occurrences = std::move(occurrences);
}

Result<void> TreeBuilder::Build() {
  TDF_LabelSequence roots;
  shapes_->GetFreeShapes(roots);
  if (roots.Length() == 1 && XCAFDoc_ShapeTool::IsAssembly(roots.First())) {
    const std::string name = NameOf(roots.First());
    product_->name = name.empty() ? product_->name : name;
    const SubassemblyId root = AddSubassembly({}, product_->name);
    const gp_Trsf X_WR = XCAFDoc_ShapeTool::GetLocation(roots.First()).Transformation();
    VisitComponents(roots.First(), root, X_WR);
  } else {
    const SubassemblyId root = AddSubassembly({}, product_->name);
    for (const TDF_Label& label : roots) {
      Visit(label, label, root, gp_Trsf());
    }
  }
  if (is_too_large_) {
    return Fail(ErrorCode::kUnsupported,
                fmt::format("the product has more than {} parts", kMaxOccurrences),
                product_->source, "open one of its subassemblies");
  }
  BuildParts();
  if (std::none_of(product_->parts.begin(), product_->parts.end(),
                   [](const Part& part) { return part.solid_count > 0; })) {
    return Fail(ErrorCode::kUnreadable, "the file holds no solid part", product_->source,
                "export the assembly with its solids, not only curves, surfaces or references");
  }
  for (const product::Occurrence& occurrence : product_->occurrences) {
    for (const Vec3& vertex : product_->part_of(occurrence.id).mesh.vertices) {
      product_->box_W.Add(occurrence.X_WB * vertex);
    }
  }
  return {};
}

}  // namespace

Result<void> BuildProduct(const Handle(TDocStd_Document) & document, const ImportOptions& options,
                          const ReadWatch& watch, Product* product, Diagnostics* diagnostics,
                          const FaceEntityFn& entity_of) {
  return TreeBuilder(document, options, watch, product, diagnostics, entity_of).Build();
}

}  // namespace hvas::cad
