#include <map>
#include <stdexcept>

#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_Styles.hxx>
#include <StepBasic_DerivedUnitElement.hxx>
#include <StepBasic_NamedUnit.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepBasic_SiUnitAndMassUnit.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_RepresentationContext.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_MechanicalDesignGeometricPresentationRepresentation.hxx>
#include <StepVisual_PresentationStyleAssignment.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>

#include "drawing.h"

namespace hvas::products {
namespace {

Handle(TCollection_HAsciiString) Text(const std::string& text) {
  return new TCollection_HAsciiString(text.c_str());
}

void SetName(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), Standard_True));
}

/** Fills an XCAF document from a drawing, every definition once. */
class DocumentWriter {
 public:
  explicit DocumentWriter(const Handle(TDocStd_Document) & document)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        materials_(XCAFDoc_DocumentTool::MaterialTool(document->Main())) {}

  TDF_Label Add(const AssemblyDefinition& assembly) {
    if (const auto known = assembly_labels_.find(&assembly); known != assembly_labels_.end()) {
      return known->second;
    }
    const TDF_Label label = shapes_->NewShape();
    SetName(label, assembly.name);
    for (const AssemblyDefinition::Child& child : assembly.children) {
      const TDF_Label definition = child.part != nullptr ? Add(*child.part) : Add(*child.assembly);
      SetName(shapes_->AddComponent(label, definition, TopLoc_Location(child.X_AC)), child.name);
    }
    assembly_labels_.emplace(&assembly, label);
    return label;
  }

 private:
  TDF_Label Add(const PartDefinition& part) {
    if (const auto known = part_labels_.find(&part); known != part_labels_.end()) {
      return known->second;
    }
    const TDF_Label label = shapes_->AddShape(part.solid.shape, /*makeAssembly=*/Standard_False);
    SetName(label, part.name);
    // The kernel's writer and reader hold densities in g/cm^3.
    materials_->SetMaterial(label, Text(part.material.name), Text(part.material.name),
                            part.material.density_kg_m3 / 1000, Text("density measure"),
                            Text("POSITIVE_RATIO_MEASURE"));
    part_labels_.emplace(&part, label);
    return label;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_MaterialTool) materials_;
  std::map<const PartDefinition*, TDF_Label> part_labels_;          // Looked up only.
  std::map<const AssemblyDefinition*, TDF_Label> assembly_labels_;  // Looked up only.
};

/** Colours every part's solid. The kernel's own colour mode writes the same, but in the order of
 the shapes' addresses in memory. */
void WriteColors(const Drawing& drawing, const Handle(XSControl_WorkSession) & session,
                 const Handle(StepData_StepModel) & model) {
  const Handle(Transfer_FinderProcess) finder = session->TransferWriter()->FinderProcess();
  for (const PartDefinition& part : drawing.parts) {
    const Handle(StepRepr_RepresentationItem) solid =
        STEPConstruct::FindEntity(finder, part.solid.shape);
    STEPConstruct_Styles styles(session);
    const Handle(StepRepr_RepresentationContext) context = styles.FindContext(part.solid.shape);
    if (solid.IsNull() || context.IsNull()) {
      throw std::runtime_error("no STEP entity for part " + part.name);
    }
    const Handle(StepVisual_Colour) color = STEPConstruct_Styles::EncodeColor(
        Quantity_Color(part.color.r, part.color.g, part.color.b, Quantity_TOC_RGB));
    styles.AddStyle(solid, styles.MakeColorPSA(solid, color, color, color, 0), nullptr);
    Handle(StepVisual_MechanicalDesignGeometricPresentationRepresentation) presentation;
    styles.CreateMDGPR(context, presentation);
    model->AddWithRefs(presentation);
  }
}

/** The kernel's writer states densities in g^3 cm^2 where it means g cm^-3. */
void MendDensityUnits(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto element = Handle(StepBasic_DerivedUnitElement)::DownCast(model->Value(i));
    if (element.IsNull()) continue;
    const bool is_mass = element->Unit()->IsKind(STANDARD_TYPE(StepBasic_SiUnitAndMassUnit));
    element->SetExponent(is_mass ? 1 : -3);
  }
}

/** Names every occurrence; the kernel's writer loses the names of those placed at their origin. */
void NameOccurrences(const Drawing& drawing, const Handle(StepData_StepModel) & model) {
  struct Uses {
    const AssemblyDefinition* assembly{nullptr};
    std::size_t seen{0};
  };

  std::map<std::string, Uses> uses;
  for (const AssemblyDefinition& assembly : drawing.assemblies)
    uses[assembly.name] = {&assembly};
  const auto product_name = [](const Handle(StepBasic_ProductDefinition) & definition) {
    return std::string(definition->Formation()->OfProduct()->Name()->ToCString());
  };
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto use = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(model->Value(i));
    if (use.IsNull()) continue;
    Uses& parent = uses.at(product_name(use->RelatingProductDefinition()));
    const AssemblyDefinition::Child& child = parent.assembly->children.at(parent.seen++);
    if (product_name(use->RelatedProductDefinition()) !=
        (child.part != nullptr ? child.part->name : child.assembly->name)) {
      throw std::runtime_error("occurrences of " + parent.assembly->name + " are out of order");
    }
    use->SetName(Text(child.name));
  }
}

/** Time and author would make every run's file another one. */
void FixHeader(const Handle(StepData_StepModel) & model, const std::string& name) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(Text(name));
  header.SetTimeStamp(Text("2000-01-01T00:00:00"));
  header.SetAuthorValue(1, Text("HVAS"));
  header.SetOrganizationValue(1, Text("HVAS"));
  header.SetOriginatingSystem(Text("make_products"));
  header.SetPreprocessorVersion(Text("Open CASCADE 7.6"));
  header.SetAuthorisation(Text(""));
  header.SetDescriptionValue(1, Text("HVAS example product " + name));
}

void Flatten(const AssemblyDefinition& assembly, const gp_Trsf& X_WA, const std::string& prefix,
             std::vector<PlacedPart>& placed) {
  for (const AssemblyDefinition::Child& child : assembly.children) {
    const gp_Trsf X_WC = X_WA * child.X_AC;
    const std::string path = prefix + child.name;
    if (child.part != nullptr) {
      placed.push_back({child.name, path, child.part, X_WC});
    } else {
      Flatten(*child.assembly, X_WC, path + "/", placed);
    }
  }
}

int CalcDepth(const AssemblyDefinition& assembly) {
  int deepest = 0;
  for (const AssemblyDefinition::Child& child : assembly.children) {
    if (child.assembly != nullptr) deepest = std::max(deepest, CalcDepth(*child.assembly));
  }
  return deepest + 1;
}

}  // namespace

std::vector<PlacedPart> Flatten(const Drawing& drawing) {
  std::vector<PlacedPart> placed;
  Flatten(drawing.assemblies.front(), gp_Trsf(), "", placed);
  return placed;
}

int CalcDepth(const Drawing& drawing) {
  return CalcDepth(drawing.assemblies.front());
}

void WriteStep(const Drawing& drawing, const std::string& path) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("write.step.schema", "AP242DIS");
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);  // Half the size; readers project.

  Handle(TDocStd_Document) document;
  const Handle(XCAFApp_Application) application = XCAFApp_Application::GetApplication();
  application->NewDocument("MDTV-XCAF", document);
  DocumentWriter(document).Add(drawing.assemblies.front());
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->UpdateAssemblies();

  STEPCAFControl_Writer writer;
  writer.SetColorMode(Standard_False);
  writer.SetNameMode(Standard_True);
  writer.SetMaterialMode(Standard_True);
  writer.SetPropsMode(Standard_False);
  if (!writer.Transfer(document, STEPControl_AsIs)) {
    throw std::runtime_error("cannot translate " + drawing.name + " to STEP");
  }
  const Handle(StepData_StepModel) model = writer.ChangeWriter().Model();
  WriteColors(drawing, writer.ChangeWriter().WS(), model);
  MendDensityUnits(model);
  NameOccurrences(drawing, model);
  FixHeader(model, drawing.name);
  if (writer.Write(path.c_str()) != IFSelect_RetDone) {
    throw std::runtime_error("cannot write " + path);
  }
  application->Close(document);
}

}  // namespace hvas::products
