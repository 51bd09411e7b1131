#include "cad/brep/step_document.h"

#include <algorithm>
#include <istream>
#include <map>
#include <memory>
#include <set>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Interface_Static.hxx>
#include <Message_ProgressScope.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_OrientedClosedShell.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_SolidModel.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelMapHasher.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_TShape.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

#include "base/regular_file.h"
#include "base/units.h"
#include "cad/brep/occt_session.h"
#include "cad/encoding.h"
#include "cad/scene/placed_parts.h"
#include "cad/step/identities.h"
#include "cad/step/step_measure.h"
#include "cad/step/step_text.h"
#include "cad/step/text_encoding.h"

namespace hvas::cad {
namespace {

/** A text as a stream, without a copy of it. */
class TextStream : private std::streambuf, public std::istream {
 public:
  explicit TextStream(std::string_view text) : std::istream(this) {
    char* begin = const_cast<char*>(text.data());  // A stream for reading writes nothing.
    setg(begin, begin, begin + text.size());
  }
};

/** Has OpenCASCADE parse the text, which is UTF-8. The files that it refers to are read later and
 may be anything: as Latin-1 their bytes come through as they are, for CleanName to see to. */
IFSelect_ReturnStatus Parse(const std::filesystem::path& file, const StepText& text,
                            STEPCAFControl_Reader* reader) {
  TextStream stream(text.text());
  Interface_Static::SetCVal("read.step.codepage", "UTF8");
  const IFSelect_ReturnStatus status = reader->ChangeReader().ReadStream(file.c_str(), stream);
  Interface_Static::SetCVal("read.step.codepage", "iso8859-1");
  return status;
}

/** The parts and subassemblies that the file places, by the numbers of their definitions in the
 file. To be known before the transfer, which goes through all of them. */
PlacedTree ExamineProducts(const STEPCAFControl_Reader& reader) {
  const Handle(StepData_StepModel) model = reader.Reader().StepModel();
  Uses uses;
  std::set<std::uint64_t> used;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto usage = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
    if (!usage.IsNull() && !usage->RelatingProductDefinition().IsNull() &&
        !usage->RelatedProductDefinition().IsNull()) {
      const auto number = [&model](const Handle(Standard_Transient) & entity) {
        const int label = model->IdentLabel(entity);
        return static_cast<std::uint64_t>(label > 0 ? label : model->Number(entity));
      };
      uses[number(usage->RelatingProductDefinition())].push_back(
          number(usage->RelatedProductDefinition()));
      used.insert(number(usage->RelatedProductDefinition()));
    }
  }
  std::vector<std::uint64_t> roots;
  for (const auto& [user, list] : uses) {
    if (used.count(user) == 0) {
      roots.push_back(user);
    }
  }
  return ExamineTree(uses, roots);
}

/** Names of files that the STEP file refers to where it has their geometry itself: documents from
 which a part was exported, as CATIA names them. */
std::set<std::string> ListDocumentsOfParts(const STEPCAFControl_Reader& reader) {
  std::set<std::string> names;
  const Handle(Transfer_TransientProcess) process =
      reader.Reader().WS()->TransferReader()->TransientProcess();
  STEPConstruct_ExternRefs references(reader.Reader().WS());
  references.LoadExternRefs();
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char* const name = references.FileName(i);
    const Handle(StepBasic_ProductDefinition) definition = references.ProdDef(i);
    if (name == nullptr || definition.IsNull()) {
      continue;
    }
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, definition);
    if (!shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More()) {
      names.insert(name);
    }
  }
  return names;
}

void ReportMissingFiles(const STEPCAFControl_Reader& reader, Diagnostics* diagnostics) {
  std::vector<std::string> missing;
  const std::set<std::string> of_parts = ListDocumentsOfParts(reader);
  using ExternFiles =
      NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>;
  for (ExternFiles::Iterator it(reader.ExternFiles()); it.More(); it.Next()) {
    const Handle(STEPCAFControl_ExternFile)& file = it.Value();
    const bool is_read =
        !file.IsNull() && file->GetLoadStatus() == IFSelect_RetDone && file->GetTransferStatus();
    if (!is_read && of_parts.count(it.Key().ToCString()) == 0) {
      missing.emplace_back(it.Key().ToCString());
    }
  }
  std::sort(missing.begin(), missing.end());
  for (const std::string& name : missing) {
    diagnostics->Warn("missing-file", name,
                      "the assembly refers to this file, which could not be read",
                      "put the file beside the assembly");
  }
}

/** Where the files that the read ones refer to are, or would have been looked for. */
std::vector<std::filesystem::path> ListReferredFiles(const STEPCAFControl_Reader& reader,
                                                     const std::filesystem::path& file) {
  std::vector<std::filesystem::path> paths;
  using ExternFiles =
      NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>;
  for (ExternFiles::Iterator it(reader.ExternFiles()); it.More(); it.Next()) {
    const Handle(STEPCAFControl_ExternFile)& extern_file = it.Value();
    const bool is_loaded = !extern_file.IsNull() && !extern_file->GetWS().IsNull() &&
                           extern_file->GetLoadStatus() == IFSelect_RetDone;
    const std::filesystem::path name =
        is_loaded ? extern_file->GetWS()->LoadedFile() : it.Key().ToCString();
    paths.push_back((file.parent_path() / name).lexically_normal());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/** OpenCASCADE waits for ever for a pipe that the file names as one of its parts. */
Result<void> CheckReferredFiles(const STEPCAFControl_Reader& reader,
                                const std::filesystem::path& file) {
  STEPConstruct_ExternRefs references(reader.Reader().WS());
  references.LoadExternRefs();
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char* name = references.FileName(i);
    if (name == nullptr || *name == '\0') {
      continue;
    }
    const auto checked = CheckRegularFile(file.parent_path() / name);
    if (!checked && checked.error().code != ErrorCode::kNotFound) {
      return Fail(ErrorCode::kUnreadable,
                  fmt::format("it refers to {}: {}", name, checked.error().message),
                  file.filename().string(), checked.error().remedy);
    }
  }
  return {};
}

/** The entities of all faces that were transferred, by the shape under the face: its place and
 sense change in assemblies and when solids are turned. */
FaceEntityFn IndexFaces(const STEPCAFControl_Reader& reader) {
  const auto entities = std::make_shared<std::map<const TopoDS_TShape*, std::uint64_t>>();
  // Keeps the shapes, so that no other can have the address of one of them.
  const auto shapes = std::make_shared<std::vector<TopoDS_Shape>>();
  const Handle(StepData_StepModel) model = reader.Reader().StepModel();
  const Handle(Transfer_TransientProcess) process =
      reader.Reader().WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    const int id = model->IdentLabel(entity);
    if (id <= 0 || !entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface))) {
      continue;
    }
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (shape.IsNull()) {
      continue;
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      shapes->push_back(it.Current());
      entities->emplace(it.Current().TShape().get(), static_cast<std::uint64_t>(id));
    }
  }
  return [entities, shapes](const TopoDS_Face& face) -> std::uint64_t {
    const auto found = entities->find(face.TShape().get());
    return found != entities->end() ? found->second : 0;
  };
}

/** The shells of the file with faces that were not transferred. */
std::vector<LostFaces> ListLostFaces(const STEPCAFControl_Reader& reader) {
  std::vector<LostFaces> list;
  const Handle(StepData_StepModel) model = reader.Reader().StepModel();
  const Handle(Transfer_TransientProcess) process =
      reader.Reader().WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto shell = Handle(StepShape_ConnectedFaceSet)::DownCast(model->Value(i));
    if (shell.IsNull() || shell->IsKind(STANDARD_TYPE(StepShape_OrientedClosedShell)) ||
        shell->CfsFaces().IsNull()) {
      continue;
    }
    LostFaces entry{static_cast<std::uint64_t>(std::max(model->IdentLabel(shell), 0)),
                    0,
                    shell->NbCfsFaces(),
                    {}};
    for (int k = 1; k <= entry.total; ++k) {
      const TopoDS_Shape shape = TransferBRep::ShapeResult(process, shell->CfsFacesValue(k));
      const TopExp_Explorer face(shape, TopAbs_FACE);
      if (shape.IsNull() || !face.More()) {
        ++entry.lost;
      } else if (entry.sibling.IsNull()) {
        entry.sibling = face.Current();
      }
    }
    if (entry.lost > 0) {
      list.push_back(std::move(entry));
    }
  }
  return list;
}

/** The identities of the definitions in the document, by their labels. */
IdentityFn IndexIdentities(const STEPCAFControl_Reader& reader, const StepText& text) {
  const std::map<std::uint64_t, product::Identity> identities = ReadIdentities(text);
  if (identities.empty()) {
    return {};
  }
  const auto by_label =
      std::make_shared<NCollection_DataMap<TDF_Label, product::Identity, TDF_LabelMapHasher>>();
  const Handle(StepData_StepModel) model = reader.Reader().StepModel();
  const Handle(Transfer_TransientProcess) process =
      reader.Reader().WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepBasic_ProductDefinition))) {
      continue;
    }
    const int id = model->IdentLabel(entity);
    const auto found = identities.find(static_cast<std::uint64_t>(std::max(id, 0)));
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    TDF_Label label;
    if (found != identities.end() && !shape.IsNull() &&
        reader.GetShapeLabelMap().Find(shape, label)) {
      by_label->Bind(label, found->second);
    }
  }
  return [by_label](const TDF_Label& label) {
    const product::Identity* identity = by_label->Seek(label);
    return identity != nullptr ? *identity : product::Identity();
  };
}

/** Makes parts of the solids of a file that has no PRODUCT, each with the name of its entity.
 Errors: kUnsupported for more than `most`; kUnreadable where there are no solids either. */
Result<void> AddSolids(STEPCAFControl_Reader* reader, const std::string& file, std::size_t most,
                       const Handle(TDocStd_Document) & document, Diagnostics* diagnostics) {
  const Handle(StepData_StepModel) model = reader->Reader().StepModel();
  const Handle(XSControl_WorkSession) session = reader->Reader().WS();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  // Representations first: they have the unit of length.
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (model->Value(i)->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation))) {
      reader->ChangeReader().TransferEntity(model->Value(i));
    }
  }
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  std::vector<TDF_Label> parts;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto solid = Handle(StepShape_SolidModel)::DownCast(model->Value(i));
    if (solid.IsNull()) {
      continue;
    }
    TopoDS_Shape shape = TransferBRep::ShapeResult(process, solid);
    if (shape.IsNull() && reader->ChangeReader().TransferEntity(solid)) {
      shape = TransferBRep::ShapeResult(process, solid);
    }
    if (shape.IsNull()) {
      continue;
    }
    if (parts.size() >= most) {
      return FailTooManyParts(most, file);
    }
    const std::string own = solid->Name().IsNull() ? "" : solid->Name()->ToCString();
    const std::string name = own.empty() ? fmt::format("solid #{}", model->IdentLabel(solid)) : own;
    parts.push_back(shapes->NewShape());
    shapes->SetShape(parts.back(), shape);
    TDataStd_Name::Set(parts.back(), TCollection_ExtendedString(name.c_str(), Standard_True));
  }
  if (parts.empty()) {
    return Fail(ErrorCode::kUnreadable,
                "the STEP file has no product and no solid that can be read", file,
                "export the file again from the CAD system");
  }
  if (parts.size() > 1) {
    const TDF_Label root = shapes->NewShape();
    TDataStd_Name::Set(root, TCollection_ExtendedString(file.c_str(), Standard_True));
    for (const TDF_Label& part : parts) {
      shapes->AddComponent(root, part, TopLoc_Location());
    }
  }
  shapes->UpdateAssemblies();
  diagnostics->Warn("no-product", file,
                    fmt::format("the file has no PRODUCT: its {} solids are the parts, with the "
                                "names of their entities",
                                parts.size()),
                    "export it as an assembly, in which each part has a name");
  return {};
}

}  // namespace

std::string ReadStepFile(const std::filesystem::path& file, const ImportOptions& options,
                         Diagnostics* diagnostics) {
  std::string bytes = ReadRegularFile(file).value_or(std::string());
  if (!options.encoding.empty()) {
    return ToUtf8(bytes, options.encoding);
  }
  if (IsUtf8(bytes)) {
    return bytes;
  }
  const std::string encoding = GuessEncoding(bytes);
  diagnostics->Note("assumed-encoding", file.filename().string(),
                    fmt::format("the names in the file are not UTF-8; {} is assumed", encoding),
                    "if names are wrong, give the encoding: --encoding CP1251, GBK, ...");
  return ToUtf8(bytes, encoding);
}

void OverrideLengthUnit(const ImportOptions& options, StepText* text) {
  if (options.length_unit) {
    text->set_length_scale(*options.length_unit / FindLengthUnit(*text));
  }
}

Result<CadDocument> ReadStepDocument(const std::filesystem::path& file, const StepText& text,
                                     const ImportOptions& options, const ReadWatch& watch,
                                     Diagnostics* diagnostics, bool with_entities) {
  InitialiseOpenCascade();
  const std::string name = file.filename().string();
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(true);
  reader.SetPropsMode(true);
  reader.SetMatMode(true);
  reader.SetGDTMode(false);
  reader.SetViewMode(false);
  if (watch.progress) {
    watch.progress("read", 0);
  }
  if (Parse(file, text, &reader) != IFSelect_RetDone) {
    return Fail(ErrorCode::kUnreadable, "the STEP file is damaged", name,
                "export the file again from the CAD system");
  }
  if (const auto checked =
          CheckTree(ExamineProducts(reader), options.max_parts, name, "product definition #");
      !checked) {
    return Unexpected(checked.error());
  }
  if (const auto checked = CheckReferredFiles(reader, file); !checked) {
    return Unexpected(checked.error());
  }
  CadDocument result;
  result.document = MakeDocument();
  // OpenCASCADE converts lengths to the unit of the document.
  XCAFDoc_DocumentTool::SetLengthUnit(result.document,
                                      units::kMetresPerMillimetre / text.length_scale());
  const opencascade::handle<TransferProgress> indicator = new TransferProgress(&watch.progress);
  if (!reader.Transfer(result.document, indicator->Start())) {
    if (auto added = AddSolids(&reader, name, options.max_parts, result.document, diagnostics);
        !added) {
      CloseDocument(result.document);
      return Unexpected(std::move(added).error());
    }
  }
  XCAFDoc_DocumentTool::SetLengthUnit(result.document, units::kMetresPerMillimetre);
  ReportMissingFiles(reader, diagnostics);
  if (watch.referred_files != nullptr) {
    *watch.referred_files = ListReferredFiles(reader, file);
  }
  if (with_entities) {
    result.entity_of = IndexFaces(reader);
  }
  result.lost_faces = ListLostFaces(reader);
  result.header = ReadStepHeader(text.text());
  result.identity_of = IndexIdentities(reader, text);
  return result;
}

}  // namespace hvas::cad
