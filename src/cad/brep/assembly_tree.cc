#include "cad/brep/assembly_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_Transform.hxx>
#include <NCollection_DataMap.hxx>
#include <Standard_ErrorHandler.hxx>
#include <Standard_OutOfMemory.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDF_Tool.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "base/parallel.h"
#include "base/units.h"
#include "cad/brep/curve_part.h"
#include "cad/brep/equal_shapes.h"
#include "cad/brep/part_shape.h"
#include "cad/brep/xcaf_labels.h"
#include "cad/scene/placed_parts.h"
#include "cad/scene/product_tree.h"
#include "cad/step/material.h"
#include "product/body_names.h"
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

constexpr double kScaleTolerance = 1e-6;  // Relative; scales that differ by less are equal.

using FaceEntities = NCollection_DataMap<TopoDS_Shape, std::uint64_t, TopTools_ShapeMapHasher>;

/** Walks an XCAF document and fills a product. */
class TreeBuilder {
 public:
  TreeBuilder(const CadDocument& document, const ImportOptions& options, const ReadWatch& watch,
              Product* product, Diagnostics* diagnostics)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document.document->Main())),
        options_(options),
        watch_(watch),
        product_(product),
        diagnostics_(diagnostics),
        entity_of_(document.entity_of),
        identity_of_(document.identity_of),
        lost_faces_(document.lost_faces) {}

  Result<void> Build();

 private:
  /** A part yet to be built: a definition, and the scale of its instance (-1: mirrored). */
  struct PartSource {
    TDF_Label definition;
    TopoDS_Shape shape;
    double scale{1};
    std::optional<Color> instance_color;
    FaceColors face_colors;
    FaceEntities entities;  // Of scaled faces only: entity_of_ knows the others.
    // Of each face of the part, the number in TopExp::MapShapes; 0: none.
    std::vector<int> face_order;
    Diagnostics notes;
  };

  /** Names already used among the children of one subassembly. */
  struct Siblings {
    std::string path;
    std::map<std::string, int> used;
  };

  SubassemblyId AddSubassembly(SubassemblyId parent, const std::string& name,
                               const TDF_Label& definition);
  std::string ClaimPath(SubassemblyId parent, const std::string& name);
  void Visit(const TDF_Label& definition, const TDF_Label& instance, SubassemblyId parent,
             const gp_Trsf& X_WP);
  void VisitComponents(const TDF_Label& assembly, SubassemblyId id, const gp_Trsf& X_WP);
  void AddLeaf(const TDF_Label& definition, const TDF_Label& instance, SubassemblyId parent,
               const gp_Trsf& X_WB);
  std::optional<PartId> FindPart(const TDF_Label& definition, const TDF_Label& instance,
                                 double scale);
  void Scale(PartSource* source);
  void Prepare(PartSource* source, Part* part);
  bool BuildPart(PartSource* source, Part* part) const;
  [[nodiscard]] std::vector<std::vector<std::size_t>> GroupSources(
      const std::vector<std::size_t>& wanted) const;
  void CopyGeometry(const Part& base, const std::vector<int>& base_order, const PartSource& source,
                    Part* part) const;
  [[nodiscard]] bool AreAlike(std::size_t a, std::size_t b) const;
  std::vector<PartId> ShareParts(const std::vector<EqualShape>& equal,
                                 const std::vector<bool>& is_built);
  std::vector<bool> BuildSources(const std::vector<std::size_t>& wanted);
  void BuildParts();
  void ReportLostFaces() const;
  void AssignParts(const std::vector<PartId>& part_of, const std::vector<EqualShape>& equal);

  Handle(XCAFDoc_ShapeTool) shapes_;
  const ImportOptions& options_;
  const ReadWatch& watch_;
  Product* product_;
  Diagnostics* diagnostics_;
  const FaceEntityFn& entity_of_;
  const IdentityFn& identity_of_;
  const std::vector<LostFaces>& lost_faces_;
  std::vector<PartSource> sources_;                     // One for each of product_->parts.
  std::map<std::string, std::optional<PartId>> known_;  // By entry, scale and colour.
  std::vector<Siblings> siblings_;                      // One for each subassembly.
  bool has_faces_{false};  // Of any part; where there are none, curves are shown.
};

/** @param definition  Null for a root that the document does not have. */
SubassemblyId TreeBuilder::AddSubassembly(SubassemblyId parent, const std::string& name,
                                          const TDF_Label& definition) {
  const SubassemblyId id(product_->subassemblies.size());
  Subassembly subassembly;
  subassembly.id = id;
  subassembly.parent = parent;
  subassembly.name = name;
  if (identity_of_ && !definition.IsNull()) {
    subassembly.identity = identity_of_(definition);
  }
  siblings_.push_back({parent.is_valid() ? ClaimPath(parent, name) : name, {}});
  product_->subassemblies.push_back(std::move(subassembly));
  if (parent.is_valid()) {
    product_->subassemblies[parent.index()].subassemblies.push_back(id);
  }
  return id;
}

std::string TreeBuilder::ClaimPath(SubassemblyId parent, const std::string& name) {
  Siblings& siblings = siblings_[parent.index()];
  return siblings.path + "/" + ClaimName(name, &siblings.used);
}

void TreeBuilder::Visit(const TDF_Label& definition, const TDF_Label& instance,
                        SubassemblyId parent, const gp_Trsf& X_WP) {
  if (product_->occurrences.size() > options_.max_parts) {
    return;
  }
  if (XCAFDoc_ShapeTool::IsAssembly(definition)) {
    const SubassemblyId id = AddSubassembly(parent, InstanceName(instance, definition), definition);
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
  std::optional<Color> color;
  if (instance != definition) {
    color = ColorOf(instance);
  }
  TCollection_AsciiString entry;
  TDF_Tool::Entry(definition, entry);
  const auto key = fmt::format("{} {} {}", entry.ToCString(), std::lround(scale / kScaleTolerance),
                               color ? fmt::format("{} {} {}", color->r, color->g, color->b) : "");
  const auto known = known_.find(key);
  if (known != known_.end()) {
    return known->second;
  }
  const std::string name = InstanceName(definition, definition);
  std::optional<PartId> id;
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(definition);
  const ShapeContent content = shape.IsNull() ? ShapeContent() : CountContent(shape);
  if (content.faces == 0 && (has_faces_ || content.free_curves == 0)) {
    diagnostics_->Note(
        "no-face", name,
        fmt::format("the part has no faces, only {} curves; it is omitted", content.free_curves));
  } else {
    if (content.faces > 0 && content.free_curves > 0) {
      diagnostics_->Note(
          "free-curves", name,
          fmt::format("{} curves that bound no face are omitted", content.free_curves));
    }
    id = PartId(product_->parts.size());
    Part part;
    part.id = *id;
    part.name = name;
    if (identity_of_) {
      part.identity = identity_of_(definition);
    }
    product_->parts.push_back(std::move(part));
    sources_.push_back({definition, shape, scale, color, {}, {}, {}, {}});
    if (scale != 1) {
      diagnostics_->Note("baked-scale", name,
                         fmt::format("an instance is {} by {}; it is imported as a part of its own",
                                     scale < 0 ? "mirrored" : "scaled", scale));
    }
  }
  known_[key] = id;
  return id;
}

/** Scales the shape of a source that is scaled or mirrored; what is known of its faces goes along.
 */
void TreeBuilder::Scale(PartSource* source) {
  gp_Trsf scaling;
  scaling.SetScale(gp_Pnt(), source->scale);
  BRepBuilderAPI_Transform transform(source->shape, scaling, true);
  FaceColors moved;
  for (FaceColors::Iterator it(source->face_colors); it.More(); it.Next()) {
    moved.Bind(transform.ModifiedShape(it.Key()), it.Value());
  }
  if (entity_of_) {
    for (TopExp_Explorer it(source->shape, TopAbs_FACE); it.More(); it.Next()) {
      source->entities.Bind(transform.ModifiedShape(it.Current()),
                            entity_of_(TopoDS::Face(it.Current())));
    }
  }
  source->face_colors = moved;
  source->shape = transform.Shape();
}

/** Reads what the document says of a part besides its shape. The rest needs no document. */
void TreeBuilder::Prepare(PartSource* source, Part* part) {
  part->material = MakeMaterial(FindStatedMaterial(source->definition), part->name, &source->notes);
  PartColors colors = CollectColors(source->definition);
  // The colour of an instance is meant to override that of its definition, but not of its faces.
  part->color = source->instance_color.value_or(colors.part.value_or(Color{}));
  source->face_colors = colors.faces;
  if (source->scale != 1) {
    Scale(source);
  }
}

bool TreeBuilder::BuildPart(PartSource* source, Part* part) const {
  Diagnostics* diagnostics = &source->notes;
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(source->shape, TopAbs_FACE, faces);
  const FaceColorFn color_of = [source, &faces](const TopoDS_Face& face) -> std::optional<Color> {
    source->face_order.push_back(faces.FindIndex(face));
    const Color* color = source->face_colors.Seek(face);
    return color != nullptr ? std::optional(*color) : std::nullopt;
  };
  const FaceEntityFn entity_of = [this, source](const TopoDS_Face& face) -> std::uint64_t {
    const std::uint64_t* entity = source->entities.Seek(face);
    return entity != nullptr ? *entity : entity_of_ ? entity_of_(face) : 0;
  };
  try {
    OCC_CATCH_SIGNALS
    if (faces.IsEmpty()
            ? BuildCurvePart(source->shape, options_, part, diagnostics)
            : BuildPartShape(source->shape, options_, color_of, part, diagnostics, entity_of)
                  .has_value()) {
      product::BuildFeatures(part, diagnostics);
      return true;
    }
    diagnostics->Warn("no-mesh", part->name, "the part could not be meshed and is omitted",
                      "heal the part in the CAD system and export it again");
  } catch (const Standard_OutOfMemory&) {
    throw std::bad_alloc();
  } catch (const Standard_Failure& failure) {
    diagnostics->Warn("part-failed", part->name,
                      fmt::format("OpenCASCADE could not process the part ({} {}); it is omitted",
                                  failure.DynamicType()->Name(), failure.GetMessageString()),
                      "heal the part in the CAD system and export it again");
  }
  return false;
}

/** The sources to build, in groups: those that have a face or an edge in common cannot be meshed at
 the same time. */
std::vector<std::vector<std::size_t>> TreeBuilder::GroupSources(
    const std::vector<std::size_t>& wanted) const {
  std::vector<std::size_t> group_of(sources_.size());
  std::iota(group_of.begin(), group_of.end(), 0);
  const auto find = [&group_of](std::size_t i) {
    while (group_of[i] != i) {
      i = group_of[i] = group_of[group_of[i]];
    }
    return i;
  };
  std::unordered_map<const TopoDS_TShape*, std::size_t> owners;
  for (const std::size_t i : wanted) {
    for (const TopAbs_ShapeEnum type : {TopAbs_FACE, TopAbs_EDGE}) {
      for (TopExp_Explorer it(sources_[i].shape, type); it.More(); it.Next()) {
        const std::size_t owner = owners.emplace(it.Current().TShape().get(), i).first->second;
        const std::size_t a = find(owner);
        const std::size_t b = find(i);
        group_of[std::max(a, b)] = std::min(a, b);
      }
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> groups;
  for (const std::size_t i : wanted) {
    groups[find(i)].push_back(i);
  }
  std::vector<std::vector<std::size_t>> result;
  result.reserve(groups.size());
  for (auto& [first, members] : groups) {
    result.push_back(std::move(members));
  }
  return result;
}

/** A part with the geometry of another, looks and material of its own.
 @param base_order  PartSource::face_order of the other. */
void TreeBuilder::CopyGeometry(const Part& base, const std::vector<int>& base_order,
                               const PartSource& source, Part* part) const {
  Part copy = base;
  copy.id = part->id;
  copy.name = part->name;
  copy.color = part->color;
  copy.material = part->material;
  copy.identity = part->identity;
  const double ratio = part->material.density / base.material.density;
  copy.mass.mass *= ratio;
  copy.mass.I_BBcm_B *= ratio;
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(source.shape, TopAbs_FACE, faces);
  for (std::size_t i = 0; i < copy.faces.size(); ++i) {
    const int number = i < base_order.size() ? base_order[i] : 0;
    if (number < 1 || number > faces.Extent()) {
      continue;
    }
    const TopoDS_Shape& face = faces(number);
    const Color* color = source.face_colors.Seek(face);
    copy.faces[i].color = color != nullptr ? std::optional(*color) : std::nullopt;
    const std::uint64_t* entity = source.entities.Seek(face);
    copy.faces[i].entity = entity != nullptr ? *entity
                           : entity_of_      ? entity_of_(TopoDS::Face(face))
                                             : 0;
  }
  copy.features.clear();
  copy.forms.clear();
  copy.inner_constraints.clear();
  *part = std::move(copy);
  product::BuildFeatures(part);
}

/** Whether two parts of one shape can be one: nothing about them tells them apart but the name. */
bool TreeBuilder::AreAlike(std::size_t a, std::size_t b) const {
  const Part& part_a = product_->parts[a];
  const Part& part_b = product_->parts[b];
  const auto same = [](const Color& x, const Color& y) {
    return x.r == y.r && x.g == y.g && x.b == y.b;
  };
  if (entity_of_ || !same(part_a.color, part_b.color) ||
      part_a.material.name != part_b.material.name ||
      part_a.material.density != part_b.material.density ||
      part_a.material.is_assumed != part_b.material.is_assumed) {
    return false;
  }
  if (sources_[a].face_colors.IsEmpty() && sources_[b].face_colors.IsEmpty()) {
    return true;
  }
  TopExp_Explorer it_b(sources_[b].shape, TopAbs_FACE);
  for (TopExp_Explorer it_a(sources_[a].shape, TopAbs_FACE); it_a.More() && it_b.More();
       it_a.Next(), it_b.Next()) {
    const Color* color_a = sources_[a].face_colors.Seek(it_a.Current());
    const Color* color_b = sources_[b].face_colors.Seek(it_b.Current());
    if ((color_a == nullptr) != (color_b == nullptr) ||
        (color_a != nullptr && !same(*color_a, *color_b))) {
      return false;
    }
  }
  return true;
}

/** Lets parts of one shape be one part, or at least have one shape. @returns for each source the
 part that it became. */
std::vector<PartId> TreeBuilder::ShareParts(const std::vector<EqualShape>& equal,
                                            const std::vector<bool>& is_built) {
  std::vector<PartId> part_of(sources_.size());
  std::vector<std::vector<std::size_t>> kinds(sources_.size());  // By base: one source a look.
  std::size_t shared = 0;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const std::size_t base = equal[i].base;
    if (!is_built[base]) {
      continue;
    }
    std::vector<std::size_t>& looks = kinds[base];
    const auto twin = std::find_if(looks.begin(), looks.end(),
                                   [this, i](std::size_t other) { return AreAlike(other, i); });
    if (twin != looks.end()) {
      part_of[i] = PartId(*twin);
    } else {
      part_of[i] = PartId(i);
      looks.push_back(i);
      if (base != i) {
        CopyGeometry(product_->parts[base], sources_[base].face_order, sources_[i],
                     &product_->parts[i]);
      }
    }
    shared += base != i && !sources_[i].shape.IsPartner(sources_[base].shape) ? 1U : 0U;
  }
  if (shared > 0) {
    diagnostics_->Note(
        "shared-parts", product_->source,
        fmt::format("{} parts have the shape of another part in another pose; they share it",
                    shared));
  }
  return part_of;
}

/** Builds the wanted sources, on several threads. @returns for each source whether it was built. */
std::vector<bool> TreeBuilder::BuildSources(const std::vector<std::size_t>& wanted) {
  const auto groups = GroupSources(wanted);
  std::vector<char> is_built(sources_.size(), 0);  // Not bool: threads write to neighbours.
  std::mutex mutex;
  ForEachIndex(
      groups.size(), options_.threads,
      [&](std::size_t g) {
        for (const std::size_t i : groups[g]) {
          if (watch_.part) {
            const std::scoped_lock lock(mutex);
            watch_.part(static_cast<std::uint32_t>(i), product_->parts[i].name);
          }
          is_built[i] = BuildPart(&sources_[i], &product_->parts[i]) ? 1 : 0;
        }
      },
      [&](std::size_t done) {
        if (watch_.progress) {
          const std::scoped_lock lock(mutex);
          watch_.progress("parts", static_cast<double>(done) / static_cast<double>(groups.size()));
        }
      });
  return {is_built.begin(), is_built.end()};
}

/** Warns of faces of the file that OpenCASCADE made nothing of, by the part that has the rest of
 their shell. */
void TreeBuilder::ReportLostFaces() const {
  for (const LostFaces& entry : lost_faces_) {
    std::string name = product_->source;
    for (std::size_t i = 0; i < sources_.size() && !entry.sibling.IsNull(); ++i) {
      TopTools_IndexedMapOfShape faces;
      TopExp::MapShapes(sources_[i].shape, TopAbs_FACE, faces);
      const bool is_owner =
          std::any_of(faces.cbegin(), faces.cend(),
                      [&](const TopoDS_Shape& face) { return face.IsPartner(entry.sibling); });
      if (is_owner) {
        name = product_->parts[i].name;
        break;
      }
    }
    diagnostics_->Warn("lost-faces", name,
                       fmt::format("{} of {} faces of the shell #{} of the file could not be read "
                                   "and are omitted",
                                   entry.lost, entry.total, entry.entity),
                       "heal the part in the CAD system and export it again");
  }
}

void TreeBuilder::BuildParts() {
  ReportLostFaces();
  const std::set<std::uint32_t> skipped(options_.skipped_parts.begin(),
                                        options_.skipped_parts.end());
  std::vector<TopoDS_Shape> shapes;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    Prepare(&sources_[i], &product_->parts[i]);
    shapes.push_back(sources_[i].shape);
  }
  const std::vector<EqualShape> equal = FindEqualShapes(shapes);
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (equal[i].base == i && skipped.count(static_cast<std::uint32_t>(i)) == 0) {
      wanted.push_back(i);
    }
  }
  const std::vector<PartId> part_of = ShareParts(equal, BuildSources(wanted));
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    if (part_of[i] == PartId(i) || equal[i].base == i) {  // Others have nothing to add.
      for (const Diagnostic& item : sources_[i].notes.items()) {
        diagnostics_->Add(item);
      }
    }
  }
  AssignParts(part_of, equal);
}

/** Gives occurrences the parts that their sources became, and leaves out those without. */
void TreeBuilder::AssignParts(const std::vector<PartId>& part_of,
                              const std::vector<EqualShape>& equal) {
  for (product::Occurrence& occurrence : product_->occurrences) {
    const std::size_t source = occurrence.part.index();
    if (equal[source].base != source) {
      occurrence.X_WB = occurrence.X_WB * equal[source].X_SB;
    }
  }
  ReplaceParts(part_of, product_);
}

Result<void> TreeBuilder::Build() {
  TDF_LabelSequence roots;
  shapes_->GetFreeShapes(roots);
  TDF_LabelSequence definitions;
  shapes_->GetShapes(definitions);
  has_faces_ = std::any_of(definitions.begin(), definitions.end(), [](const TDF_Label& label) {
    return TopExp_Explorer(XCAFDoc_ShapeTool::GetShape(label), TopAbs_FACE).More();
  });
  if (roots.Length() == 1 && XCAFDoc_ShapeTool::IsAssembly(roots.First())) {
    const std::string name = NameOf(roots.First());
    product_->name = name.empty() ? product_->name : name;
    const SubassemblyId root = AddSubassembly({}, product_->name, roots.First());
    const gp_Trsf X_WR = XCAFDoc_ShapeTool::GetLocation(roots.First()).Transformation();
    VisitComponents(roots.First(), root, X_WR);
  } else {
    const SubassemblyId root = AddSubassembly({}, product_->name, TDF_Label());
    for (const TDF_Label& label : roots) {
      Visit(label, label, root, gp_Trsf());
    }
  }
  if (product_->occurrences.size() > options_.max_parts) {
    return FailTooManyParts(options_.max_parts, product_->source);
  }
  product::NameSoleBodies(product_);
  BuildParts();
  if (product_->occurrences.empty()) {
    return Fail(ErrorCode::kUnreadable, "the file has no solid part", product_->source,
                "export the assembly with solids, not only points or references");
  }
  if (std::none_of(product_->parts.begin(), product_->parts.end(),
                   [](const Part& part) { return part.solid_count > 0; })) {
    diagnostics_->Warn("surfaces-only", product_->source,
                       has_faces_ ? "the file has surfaces but no solids; its parts have no mass"
                                  : "the file has curves but no solids; its parts have no mass",
                       "export the assembly with solids");
  }
  for (const product::Occurrence& occurrence : product_->occurrences) {
    for (const Vec3& vertex : product_->part_of(occurrence.id).mesh.vertices) {
      product_->box_W.Add(occurrence.X_WB * vertex);
    }
  }
  return {};
}

}  // namespace

Result<void> BuildProduct(const CadDocument& document, const ImportOptions& options,
                          const ReadWatch& watch, Product* product, Diagnostics* diagnostics) {
  product->header = document.header;
  return TreeBuilder(document, options, watch, product, diagnostics).Build();
}

}  // namespace hvas::cad
