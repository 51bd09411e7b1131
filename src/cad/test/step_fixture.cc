#include "cad/test/step_fixture.h"

#include <algorithm>
#include <stdexcept>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_Location.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax2.hxx>

namespace hvas::cad::testing {
namespace {

void SetName(const TDF_Label& label, const std::string& name) {
  TDataStd_Name::Set(label, TCollection_ExtendedString(name.c_str(), /*isMultiByte=*/true));
}

Handle(TCollection_HAsciiString) ToHandle(const std::string& text) {
  return new TCollection_HAsciiString(text.c_str());
}

}  // namespace

DocumentBuilder::DocumentBuilder() {
  STEPCAFControl_Controller::Init();
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
}

DocumentBuilder::~DocumentBuilder() {
  XCAFApp_Application::GetApplication()->Close(document_);
}

TDF_Label DocumentBuilder::AddPart(const TopoDS_Shape& shape, const std::string& name) {
  const TDF_Label label =
      XCAFDoc_DocumentTool::ShapeTool(document_->Main())->AddShape(shape, /*makeAssembly=*/false);
  SetName(label, name);
  return label;
}

TDF_Label DocumentBuilder::AddAssembly(const std::string& name) {
  const TDF_Label label = XCAFDoc_DocumentTool::ShapeTool(document_->Main())->NewShape();
  SetName(label, name);
  return label;
}

void DocumentBuilder::AddComponent(const TDF_Label& assembly, const TDF_Label& definition,
                                   const TopLoc_Location& location, const std::string& name) {
  const auto tool = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  SetName(tool->AddComponent(assembly, definition, location), name);
}

void DocumentBuilder::SetLocation(const TDF_Label& assembly, int component,
                                  const gp_Trsf& placement) {
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(assembly, components);
  XCAFDoc_Location::Set(components.Value(component), TopLoc_Location(placement));
}

void DocumentBuilder::SetColor(const TDF_Label& label, const Quantity_Color& color) {
  XCAFDoc_DocumentTool::ColorTool(document_->Main())->SetColor(label, color, XCAFDoc_ColorSurf);
}

void DocumentBuilder::SetFaceColor(const TDF_Label& part, const TopoDS_Shape& face,
                                   const Quantity_Color& color) {
  const auto tool = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
  SetColor(tool->AddSubShape(part, face), color);
}

void DocumentBuilder::SetMaterial(const TDF_Label& part, const std::string& name, double density) {
  XCAFDoc_DocumentTool::MaterialTool(document_->Main())
      ->SetMaterial(part, ToHandle(name), ToHandle(name), density, ToHandle("density measure"),
                    ToHandle("POSITIVE_RATIO_MEASURE"));
}

const Handle(TDocStd_Document) & DocumentBuilder::document() {
  return document_;
}

void DocumentBuilder::Write(const std::filesystem::path& file, const std::string& unit) {
  XCAFDoc_DocumentTool::ShapeTool(document_->Main())->UpdateAssemblies();
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document_, STEPControl_AsIs) ||
      writer.Write(file.c_str()) != IFSelect_RetDone) {
    throw std::runtime_error("cannot write " + file.string());
  }
}

TopoDS_Shape MakePlate() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(60, 40, 10).Shape();
  const gp_Ax2 axis(gp_Pnt(20, 20, -5), gp::DZ());
  return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(axis, 5, 20).Shape()).Shape();
}

int CountCode(const Diagnostics& diagnostics, std::string_view code) {
  return static_cast<int>(
      std::count_if(diagnostics.items().begin(), diagnostics.items().end(),
                    [code](const Diagnostic& item) { return item.code == code; }));
}

TopLoc_Location Translation(double x_mm, double y_mm, double z_mm) {
  gp_Trsf trsf;
  trsf.SetTranslation(gp_Vec(x_mm, y_mm, z_mm));
  return trsf;
}

}  // namespace hvas::cad::testing
