#include "cad/brep/iges_document.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESBasic_SubfigureDef.hxx>
#include <IGESCAFControl.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Message_ProgressScope.hxx>
#include <NCollection_DataMap.hxx>
#include <Quantity_Color.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelMapHasher.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <UnitsMethods.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "base/regular_file.h"
#include "base/units.h"
#include "cad/brep/occt_session.h"
#include "cad/brep/sew_faces.h"
#include "cad/iges/iges_text.h"
#include "cad/length_unit.h"
#include "cad/scene/placed_parts.h"
#include "cad/step/text_encoding.h"

namespace hvas::cad {
namespace {

// Edges of trimmed surfaces lie apart by what the writing CAD system calls the same: at least this,
// so that files of a coarse one close, and no more, so that no small face is lost. Choices [mm].
constexpr double kLeastSewing_mm = 0.01;
constexpr double kMostSewing_mm = 0.1;
constexpr int kMostDamaged = 8;  // Entities that are reported one by one: a choice.

std::string TextOf(const Handle(TCollection_HAsciiString) & text) {
  return text.IsNull() ? std::string() : CleanName(text->ToCString());
}

/** What entities say of the shapes that they became. */
class EntityLabels {
 public:
  EntityLabels(const Handle(IGESData_IGESModel) & model,
               const Handle(Transfer_TransientProcess) & process);

  /** Empty where there is none. */
  [[nodiscard]] std::string NameOf(const TopoDS_Shape& shape) const {
    const auto found = names_.find(shape.TShape().get());
    return found == names_.end() ? std::string() : found->second;
  }

  [[nodiscard]] std::optional<Quantity_Color> ColorOf(const TopoDS_Shape& shape) const {
    const auto found = colors_.find(shape.TShape().get());
    return found == colors_.end() ? std::nullopt : std::optional(found->second);
  }

  /** The directory entry that a shape is made of, as IGES numbers them: "D17"; empty where it is
   none. */
  [[nodiscard]] std::string EntryOf(const TopoDS_Shape& shape) const {
    const auto found = entries_.find(shape.TShape().get());
    return found == entries_.end() ? std::string() : fmt::format("D{}", found->second);
  }

 private:
  std::map<const TopoDS_TShape*, std::string> names_;
  std::map<const TopoDS_TShape*, Quantity_Color> colors_;
  std::map<const TopoDS_TShape*, int> entries_;
  std::vector<TopoDS_Shape> shapes_;  // So that no other shape gets one's address.
};

std::string NameOfEntity(const Handle(IGESData_IGESEntity) & entity) {
  const auto definition = Handle(IGESBasic_SubfigureDef)::DownCast(entity);
  if (!definition.IsNull() && !TextOf(definition->Name()).empty()) {
    return TextOf(definition->Name());
  }
  if (entity->HasName() && !TextOf(entity->NameValue()).empty()) {
    return TextOf(entity->NameValue());
  }
  return entity->HasShortLabel() ? TextOf(entity->ShortLabel()) : std::string();
}

std::optional<Quantity_Color> ColorOfEntity(const Handle(IGESData_IGESEntity) & entity) {
  const auto color = Handle(IGESGraph_Color)::DownCast(entity->Color());
  if (!color.IsNull()) {
    double r = 0;
    double g = 0;
    double b = 0;
    color->RGBIntensity(r, g, b);  // In percent.
    const auto part = [](double percent) { return std::clamp(percent / 100, 0.0, 1.0); };
    return Quantity_Color(part(r), part(g), part(b), Quantity_TOC_sRGB);
  }
  constexpr int kColors = 8;  // IGES 5.3, 2.2.4.4.13: black, red, green, blue, ... white.
  return entity->RankColor() > 0 && entity->RankColor() <= kColors
             ? std::optional(IGESCAFControl::DecodeColor(entity->RankColor()))
             : std::nullopt;
}

EntityLabels::EntityLabels(const Handle(IGESData_IGESModel) & model,
                           const Handle(Transfer_TransientProcess) & process) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = model->Entity(i);
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (shape.IsNull()) {
      continue;
    }
    shapes_.push_back(shape);
    entries_.emplace(shape.TShape().get(), 2 * i - 1);
    if (std::string name = NameOfEntity(entity); !name.empty()) {
      names_.emplace(shape.TShape().get(), std::move(name));
    }
    if (const auto color = ColorOfEntity(entity)) {
      colors_.emplace(shape.TShape().get(), *color);
    }
  }
}

/** Turns the shapes of the file's roots into definitions of a document. */
class DocumentBuilder {
 public:
  DocumentBuilder(const Handle(TDocStd_Document) & document, const EntityLabels& labels,
                  double sewing_mm, std::string file, Diagnostics* diagnostics)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        labels_(labels),
        sewing_mm_(sewing_mm),
        file_(std::move(file)),
        diagnostics_(diagnostics) {}

  /** Errors: kUnsupported for more parts than `max_parts`. */
  Result<void> Build(const std::vector<TopoDS_Shape>& roots, std::size_t max_parts);

 private:
  struct Child {
    TDF_Label definition;
    TopLoc_Location location;
  };

  std::optional<Child> AddShape(const TopoDS_Shape& shape);
  TDF_Label AddDefinition(const TopoDS_Shape& shape);
  TDF_Label AddGroup(const std::vector<TopoDS_Shape>& members, const std::string& name);
  TDF_Label AddPart(const TopoDS_Shape& shape, const std::string& name);
  void AddSewn(const std::vector<TopoDS_Shape>& faces, const std::string& name,
               std::vector<Child>* children);
  TDF_Label MakeAssembly(const std::vector<Child>& children, const std::string& name);
  void SetColors(const TDF_Label& part, const std::vector<TopoDS_Shape>& sources,
                 const std::function<TopoDS_Shape(const TopoDS_Shape&)>& modified);
  void ReportOpen(const SewnFaces& sewn, const std::vector<TopoDS_Shape>& faces,
                  const std::string& name);
  void ReportOpenSolid(const TopoDS_Shape& solid, const std::string& name);
  void Report() const;
  [[nodiscard]] std::uint64_t NumberOf(const TDF_Label& label);

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  const EntityLabels& labels_;
  double sewing_mm_;
  std::string file_;
  Diagnostics* diagnostics_;
  std::map<const TopoDS_TShape*, TDF_Label> known_;
  Uses uses_;
  NCollection_DataMap<TDF_Label, std::uint64_t, TDF_LabelMapHasher> numbers_;
  int sewn_faces_{0}, sewn_solids_{0}, curves_{0};
};

std::uint64_t DocumentBuilder::NumberOf(const TDF_Label& label) {
  const auto next = static_cast<std::uint64_t>(numbers_.Extent());
  return *numbers_.Bound(label, numbers_.IsBound(label) ? numbers_.Find(label) : next);
}

void SetName(const TDF_Label& label, const std::string& name) {
  if (!name.empty()) {
    TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), /*isMultiByte=*/true));
  }
}

TDF_Label DocumentBuilder::AddPart(const TopoDS_Shape& shape, const std::string& name) {
  const TDF_Label label = shapes_->NewShape();
  shapes_->SetShape(label, shape);
  SetName(label, name);
  return label;
}

std::vector<TopoDS_Shape> ListFaces(const std::vector<TopoDS_Shape>& shapes) {
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& shape : shapes) {
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      faces.push_back(it.Current());
    }
  }
  return faces;
}

/** Colours a part as its entities are: as a whole where all of its faces have one colour, else each
 face. @param sources  Faces of the file that `modified` turns into faces of the part. */
void DocumentBuilder::SetColors(const TDF_Label& part, const std::vector<TopoDS_Shape>& sources,
                                const std::function<TopoDS_Shape(const TopoDS_Shape&)>& modified) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(XCAFDoc_ShapeTool::GetShape(part), TopAbs_FACE, faces);
  std::vector<std::pair<TopoDS_Shape, Quantity_Color>> colored;
  for (const TopoDS_Shape& source : sources) {
    const auto color = labels_.ColorOf(source);
    const TopoDS_Shape face = color ? modified(source) : TopoDS_Shape();
    if (color && faces.Contains(face)) {
      colored.emplace_back(face, *color);
    }
  }
  const bool is_uniform =
      static_cast<int>(colored.size()) == faces.Extent() &&
      std::all_of(colored.begin(), colored.end(),
                  [&colored](const auto& entry) { return entry.second == colored.front().second; });
  if (is_uniform) {
    colors_->SetColor(part, colored.front().second, XCAFDoc_ColorGen);
    return;
  }
  for (const auto& [face, color] : colored) {
    TDF_Label label;
    if (shapes_->AddSubShape(part, face, label)) {
      colors_->SetColor(label, color, XCAFDoc_ColorSurf);
    }
  }
}

/** Says which surfaces of a group stay open, by their entities in the file. */
void DocumentBuilder::ReportOpen(const SewnFaces& sewn, const std::vector<TopoDS_Shape>& faces,
                                 const std::string& name) {
  constexpr std::size_t kMostNamed = 8;  // Entities in one message: a choice.
  TopTools_IndexedMapOfShape open;
  TopExp::MapShapes(sewn.open, TopAbs_FACE, open);
  std::vector<std::string> entries;
  for (const TopoDS_Shape& face : ListFaces(faces)) {
    std::string entry = labels_.EntryOf(face);
    if (!entry.empty() && open.Contains(sewn.modified(face))) {
      entries.push_back(std::move(entry));
    }
  }
  const std::size_t more = entries.size() > kMostNamed ? entries.size() - kMostNamed : 0;
  entries.resize(entries.size() - more);
  diagnostics_->Warn(
      "open-faces", name.empty() ? file_ : name,
      fmt::format(
          "surfaces do not close to a solid: {} edges have no neighbour within {:g} mm{}{}{}",
          sewn.open_edges, sewn.tolerance_mm, entries.empty() ? "" : "; entities ",
          fmt::join(entries, ", "), more > 0 ? fmt::format(" and {} more", more) : ""),
      "export the part as a solid (IGES type 186), or as STEP");
}

/** Warns of a solid of the file whose shell does not close. */
void DocumentBuilder::ReportOpenSolid(const TopoDS_Shape& solid, const std::string& name) {
  int open_edges = 0;
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(solid, TopAbs_EDGE, TopAbs_FACE, faces_of);
  for (int i = 1; i <= faces_of.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of.FindKey(i));
    const bool is_alone =
        faces_of.FindFromIndex(i).Extent() == 1 &&
        !BRep_Tool::IsClosed(edge, TopoDS::Face(faces_of.FindFromIndex(i).First()));
    open_edges += is_alone && !BRep_Tool::Degenerated(edge) ? 1 : 0;
  }
  if (open_edges > 0) {
    const std::string entry = labels_.EntryOf(solid);
    diagnostics_->Warn(
        "open-faces", name.empty() ? file_ : name,
        fmt::format("the solid{}{} does not close: {} edges belong to one face alone",
                    entry.empty() ? "" : " of entity ", entry, open_edges),
        "close the part in the CAD system and export it again, or as STEP");
  }
}

/** Sews the loose faces of one group: a part for each solid, and one for what stays open. */
void DocumentBuilder::AddSewn(const std::vector<TopoDS_Shape>& faces, const std::string& name,
                              std::vector<Child>* children) {
  if (faces.empty()) {
    return;
  }
  const SewnFaces sewn = SewFaces(faces, sewing_mm_);
  std::vector<TopoDS_Shape> bodies = sewn.solids;
  if (!sewn.open.IsNull()) {
    bodies.push_back(sewn.open);
    ReportOpen(sewn, faces, name);
  }
  sewn_solids_ += static_cast<int>(sewn.solids.size());
  sewn_faces_ += static_cast<int>(faces.size());
  for (const TopoDS_Shape& body : bodies) {
    const TDF_Label part = AddPart(body, name);
    SetColors(part, ListFaces(faces), sewn.modified);
    children->push_back({part, TopLoc_Location()});
  }
}

TDF_Label DocumentBuilder::MakeAssembly(const std::vector<Child>& children,
                                        const std::string& name) {
  const TDF_Label assembly = shapes_->NewShape();
  SetName(assembly, name);
  std::vector<std::uint64_t>& used = uses_[NumberOf(assembly)];
  for (const Child& child : children) {
    shapes_->AddComponent(assembly, child.definition, child.location);
    used.push_back(NumberOf(child.definition));
  }
  return assembly;
}

/** The part that a group is, or an assembly of its bodies. Null for a group of curves. */
TDF_Label DocumentBuilder::AddGroup(const std::vector<TopoDS_Shape>& members,
                                    const std::string& name) {
  std::vector<Child> children;
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& member : members) {
    if (member.ShapeType() == TopAbs_SHELL || member.ShapeType() == TopAbs_FACE) {
      faces.push_back(member);
    } else if (member.ShapeType() > TopAbs_FACE) {
      ++curves_;
    } else if (auto child = AddShape(member)) {
      children.push_back(*child);
    }
  }
  AddSewn(faces, name, &children);
  if (children.empty()) {
    return {};
  }
  if (children.size() > 1 || !children.front().location.IsIdentity()) {
    return MakeAssembly(children, name);
  }
  const TDF_Label& lone = children.front().definition;
  if (!lone.IsAttribute(TDataStd_Name::GetID())) {
    SetName(lone, name);
  }
  return lone;
}

TDF_Label DocumentBuilder::AddDefinition(const TopoDS_Shape& shape) {
  const std::string name = labels_.NameOf(shape);
  if (shape.ShapeType() == TopAbs_SOLID) {
    ReportOpenSolid(shape, name);
    const TDF_Label part = AddPart(shape, name);
    if (const auto color = labels_.ColorOf(shape)) {
      colors_->SetColor(part, *color, XCAFDoc_ColorGen);
    }
    SetColors(part, ListFaces({shape}), [](const TopoDS_Shape& face) { return face; });
    return part;
  }
  std::vector<TopoDS_Shape> members;
  for (TopoDS_Iterator it(shape); it.More(); it.Next()) {
    members.push_back(it.Value());
  }
  return AddGroup(members, name);
}

/** A solid or a compound; what is placed several times has one definition. */
std::optional<DocumentBuilder::Child> DocumentBuilder::AddShape(const TopoDS_Shape& shape) {
  const TopoDS_Shape base = shape.Located(TopLoc_Location());
  const auto known = known_.find(base.TShape().get());
  const TDF_Label definition = known != known_.end() ? known->second : AddDefinition(base);
  known_[base.TShape().get()] = definition;
  return definition.IsNull() ? std::nullopt : std::optional(Child{definition, shape.Location()});
}

void DocumentBuilder::Report() const {
  if (sewn_faces_ > 0) {
    diagnostics_->Note("sewn-faces", file_,
                       fmt::format("{} surfaces without a solid were sewn within {:g} mm, which "
                                   "gave {} solids",
                                   sewn_faces_, sewing_mm_, sewn_solids_));
  }
  if (curves_ > 0) {
    diagnostics_->Note("iges-curves", file_,
                       fmt::format("{} curves and points are omitted", curves_));
  }
}

Result<void> DocumentBuilder::Build(const std::vector<TopoDS_Shape>& roots, std::size_t max_parts) {
  TDF_Label root = AddGroup(roots, "");
  if (root.IsNull() && curves_ > 0) {  // Curves are omitted only where there is anything else.
    const BRep_Builder builder;
    TopoDS_Compound curves;
    builder.MakeCompound(curves);
    for (const TopoDS_Shape& shape : roots) {
      builder.Add(curves, shape);
    }
    root = AddPart(curves, file_);
    curves_ = 0;
  }
  Report();
  if (root.IsNull()) {
    return Fail(ErrorCode::kUnreadable, "the IGES file has no solids, surfaces or curves", file_,
                "export solids or trimmed surfaces");
  }
  if (auto checked = CheckTree(ExamineTree(uses_, {NumberOf(root)}), max_parts, file_, "entity");
      !checked) {
    return checked;
  }
  shapes_->UpdateAssemblies();
  return {};
}

/** Warns of entities that could not be read or turned into shapes. */
void ReportDamaged(const Handle(IGESData_IGESModel) & model, Interface_CheckIterator checks,
                   const std::string& file, int* count, Diagnostics* diagnostics) {
  for (checks.Start(); checks.More(); checks.Next()) {
    const Handle(Interface_Check) check = checks.Value();
    if (!check->HasFailed()) {
      continue;
    }
    const int number = checks.Number();
    const bool is_entity = number > 0 && number <= model->NbEntities();
    if (++*count > kMostDamaged) {
      continue;
    }
    const std::string where = is_entity
                                  ? fmt::format("{}, entity D{} (type {})", file, 2 * number - 1,
                                                model->Entity(number)->TypeNumber())
                                  : file;
    diagnostics->Warn("iges-entity", where,
                      fmt::format("the entity is damaged or cannot be represented: {}",
                                  CleanName(check->CFail(1))),
                      "heal the entity in the CAD system and export the file again, or as STEP");
  }
}

/** Gives a model another unit of length [m]. */
Result<void> SetLengthUnit(double unit, const std::string& file,
                           const Handle(IGESData_IGESModel) & model) {
  constexpr int kUnits = 11;          // Flags of IGES 5.3, section 2.2.4.3.14; 3 is a name.
  constexpr double kSameUnit = 1e-9;  // Relative.
  for (int flag = 1; flag <= kUnits; ++flag) {
    const double known = units::FromMm(UnitsMethods::GetLengthFactorValue(flag));
    if (flag != 3 && std::abs(known - unit) < kSameUnit * unit) {
      IGESData_GlobalSection global = model->GlobalSection();
      global.SetUnitFlag(flag);
      model->SetGlobalSection(global);
      return {};
    }
  }
  return Fail(ErrorCode::kUnsupported, fmt::format("IGES has no unit of {} m", unit), file,
              "give mm, cm, m, in or ft");
}

product::FileHeader MakeHeader(const IGESData_GlobalSection& global) {
  product::FileHeader header;
  header.format = "IGES";
  header.name = TextOf(global.FileName());
  header.description = TextOf(global.SendName());
  header.time_stamp = TextOf(global.Date());
  header.authors = TextOf(global.AuthorName());
  header.organisations = TextOf(global.CompanyName());
  header.preprocessor = TextOf(global.InterfaceVersion());
  header.originating_system = TextOf(global.SystemId());
  header.schema = fmt::format("IGES version {}", global.IGESVersion());
  return header;
}

}  // namespace

Result<CadDocument> ReadIgesDocument(const std::filesystem::path& file,
                                     const ImportOptions& options, const ReadWatch& watch,
                                     Diagnostics* diagnostics) {
  const std::string name = file.filename().string();
  const auto text = ReadRegularFile(file);
  if (!text) {
    return Unexpected(text.error());
  }
  if (const auto checked = CheckIgesText(*text, name); !checked) {
    return Unexpected(checked.error());
  }
  InitialiseOpenCascade();
  if (watch.progress) {
    watch.progress("read", 0);
  }
  IGESControl_Reader reader;
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull()) {
    return Fail(ErrorCode::kUnreadable, "the IGES file is damaged", name,
                "export the file again from the CAD system");
  }
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  if (const auto checked = CheckLengthUnit(units::FromMm(model->GlobalSection().UnitValue()), name,
                                           "the global section");
      !checked) {
    return Unexpected(checked.error());
  }
  if (options.length_unit) {
    if (const auto set = SetLengthUnit(*options.length_unit, name, model); !set) {
      return Unexpected(set.error());
    }
  }
  int damaged = 0;
  ReportDamaged(model, reader.WS()->ModelCheckList(), name, &damaged, diagnostics);
  const opencascade::handle<TransferProgress> indicator = new TransferProgress(&watch.progress);
  reader.TransferRoots(indicator->Start());
  const Handle(Transfer_TransientProcess) process =
      reader.WS()->TransferReader()->TransientProcess();
  ReportDamaged(model, process->CheckList(Standard_False), name, &damaged, diagnostics);
  if (damaged > kMostDamaged) {
    diagnostics->Warn("iges-entity", name,
                      fmt::format("{} entities are damaged or cannot be represented; the first {} "
                                  "are listed",
                                  damaged, kMostDamaged),
                      "heal them in the CAD system and export the file again, or as STEP");
  }
  std::vector<TopoDS_Shape> roots;
  for (int i = 1; i <= reader.NbShapes(); ++i) {
    roots.push_back(reader.Shape(i));
  }
  const double sewing_mm =
      std::clamp(model->GlobalSection().Resolution() * model->GlobalSection().UnitValue(),
                 kLeastSewing_mm, kMostSewing_mm);
  CadDocument result;
  result.document = MakeDocument();
  const EntityLabels labels(model, process);
  const auto built = DocumentBuilder(result.document, labels, sewing_mm, name, diagnostics)
                         .Build(roots, options.max_parts);
  if (!built) {
    CloseDocument(result.document);
    return Unexpected(built.error());
  }
  result.header = MakeHeader(model->GlobalSection());
  return result;
}

}  // namespace hvas::cad
