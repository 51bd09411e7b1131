#include "cad/brep/xcaf_labels.h"

#include <algorithm>
#include <cctype>

#include <Quantity_Color.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDataStd_TreeNode.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFDoc.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_MaterialTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "cad/step/text_encoding.h"

namespace hvas::cad {
namespace {

using product::Color;

std::u16string ToUtf16(const TCollection_ExtendedString& text) {
  std::u16string units;
  for (int i = 1; i <= text.Length(); ++i) {
    units.push_back(text.Value(i));
  }
  return units;
}

/** Whether an instance's name was made up by a program and the product's name says more. */
bool IsGenerated(const std::string& name) {
  return name.rfind("NAUO", 0) == 0 || name.rfind("=>", 0) == 0 ||
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0 || c == ':'; });
}

Color ToColor(const Quantity_Color& color) {
  double r = 0;
  double g = 0;
  double b = 0;
  color.Values(r, g, b, Quantity_TOC_sRGB);
  return {static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)};
}

/** The material that a label refers to, if any. */
std::optional<TDF_Label> MaterialLabel(const TDF_Label& label) {
  Handle(TDataStd_TreeNode) node;
  if (label.FindAttribute(XCAFDoc::MaterialRefGUID(), node) && node->HasFather()) {
    return node->Father()->Label();
  }
  return std::nullopt;
}

}  // namespace

std::string NameOf(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) {
    return {};
  }
  return CleanName(ToUtf16(name->Get()));
}

std::string InstanceName(const TDF_Label& component, const TDF_Label& definition) {
  std::string own = NameOf(component);
  const std::string type = NameOf(definition);
  if (!own.empty() && !IsGenerated(own)) {
    return own;
  }
  return type.empty() ? "part" : type;
}

std::optional<Color> ColorOf(const TDF_Label& label) {
  const Handle(XCAFDoc_ColorTool) tool = XCAFDoc_DocumentTool::ColorTool(label);
  Quantity_Color color;
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
    if (tool->GetColor(label, type, color)) {
      return ToColor(color);
    }
  }
  return std::nullopt;
}

PartColors CollectColors(const TDF_Label& definition) {
  PartColors colors;
  colors.part = ColorOf(definition);
  TDF_LabelSequence children;
  XCAFDoc_ShapeTool::GetSubShapes(definition, children);
  // Solids and shells first, so that a face's own colour wins.
  for (const bool is_face_pass : {false, true}) {
    for (const TDF_Label& child : children) {
      const auto color = ColorOf(child);
      const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(child);
      if (!color || shape.IsNull() || (shape.ShapeType() == TopAbs_FACE) != is_face_pass) {
        continue;
      }
      if (!colors.part && shape.ShapeType() == TopAbs_SOLID) {
        colors.part = *color;
      }
      for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
        colors.faces.Bind(it.Current(), *color);
      }
    }
  }
  return colors;
}

std::optional<StatedMaterial> FindStatedMaterial(const TDF_Label& definition) {
  std::optional<TDF_Label> label = MaterialLabel(definition);
  TDF_LabelSequence children;
  XCAFDoc_ShapeTool::GetSubShapes(definition, children);
  for (const TDF_Label& child : children) {
    if (!label) {
      label = MaterialLabel(child);
    }
  }
  if (!label) {
    return std::nullopt;
  }
  Handle(TCollection_HAsciiString) name;
  Handle(TCollection_HAsciiString) description;
  Handle(TCollection_HAsciiString) density_name;
  Handle(TCollection_HAsciiString) density_type;
  StatedMaterial material;
  if (!XCAFDoc_DocumentTool::MaterialTool(definition)
           ->GetMaterial(*label, name, description, material.density, density_name, density_type)) {
    return std::nullopt;
  }
  material.name = name.IsNull() ? std::string() : CleanName(std::string_view(name->ToCString()));
  return material;
}

}  // namespace hvas::cad
