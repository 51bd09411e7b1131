#include "cad/process/move_components.h"

#include <Quantity_ColorRGBA.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "base/units.h"
#include "cad/brep/part_shape.h"
#include "cad/brep/xcaf_labels.h"
#include "cad/scene/product_tree.h"

namespace hvas::cad {
namespace {

gp_Trsf ToTrsf(const spatial::Pose& pose) {
  const Quat& q = pose.q();
  gp_Trsf trsf;
  trsf.SetTransformation(
      gp_Quaternion(q.x(), q.y(), q.z(), q.w()),
      gp_Vec(units::ToMm(pose.p().x()), units::ToMm(pose.p().y()), units::ToMm(pose.p().z())));
  return trsf;
}

/** Builds the tree of a document anew beside the old one. */
class Mover {
 public:
  Mover(const opencascade::handle<TDocStd_Document>& document, const Motions& motions)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        motions_(motions) {}

  std::size_t Run(const std::string& name);

 private:
  /** An assembly to be filled, and its place in the tree. */
  struct Level {
    TDF_Label assembly;
    std::string path;
    gp_Trsf X_WA;  // Of the new assembly.
    std::map<std::string, int> used;
  };

  Level MakeLevel(const TDF_Label& model, const std::string& path, const gp_Trsf& X_WA);
  void Fill(const TDF_Label& source, const gp_Trsf& X_WS, Level* level);
  void Add(const TDF_Label& definition, const TDF_Label& instance, const gp_Trsf& X_WC,
           Level* level);
  void CopyLooks(const TDF_Label& from, const TDF_Label& to);
  void RemoveOthers(const TDF_Label& root);

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colors_;
  const Motions& motions_;
  std::size_t found_{0};
};

void Mover::CopyLooks(const TDF_Label& from, const TDF_Label& to) {
  Handle(TDataStd_Name) name;
  if (from.FindAttribute(TDataStd_Name::GetID(), name)) {
    TDataStd_Name::Set(to, name->Get());
  }
  for (const XCAFDoc_ColorType type : {XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_ColorCurv}) {
    Quantity_ColorRGBA color;
    if (colors_->GetColor(from, type, color)) {
      colors_->SetColor(to, color, type);
    }
  }
}

Mover::Level Mover::MakeLevel(const TDF_Label& model, const std::string& path,
                              const gp_Trsf& X_WA) {
  Level level{shapes_->NewShape(), path, X_WA, {}};
  if (!model.IsNull()) {
    CopyLooks(model, level.assembly);
  }
  return level;
}

void Mover::Fill(const TDF_Label& source, const gp_Trsf& X_WS, Level* level) {
  TDF_LabelSequence components;
  XCAFDoc_ShapeTool::GetComponents(source, components);
  for (const TDF_Label& component : components) {
    TDF_Label definition;
    if (XCAFDoc_ShapeTool::GetReferredShape(component, definition)) {
      const gp_Trsf X_SC = XCAFDoc_ShapeTool::GetLocation(component).Transformation();
      Add(definition, component, X_WS * X_SC, level);
    }
  }
}

/** Adds an instance that was at X_WC. Paths are claimed as the import does. */
void Mover::Add(const TDF_Label& definition, const TDF_Label& instance, const gp_Trsf& X_WC,
                Level* level) {
  const std::string name = InstanceName(instance, definition);
  TDF_Label target = definition;
  gp_Trsf X_WN = X_WC;
  if (XCAFDoc_ShapeTool::IsAssembly(definition)) {
    Level below = MakeLevel(definition, level->path + "/" + ClaimName(name, &level->used), X_WC);
    Fill(definition, X_WC, &below);
    target = below.assembly;
  } else if (CountContent(XCAFDoc_ShapeTool::GetShape(definition)).faces > 0) {
    const auto motion = motions_.find(level->path + "/" + ClaimName(name, &level->used));
    if (motion != motions_.end()) {
      X_WN = ToTrsf(motion->second) * X_WC;
      ++found_;
    }
  }
  const TDF_Label added = shapes_->AddComponent(level->assembly, target,
                                                TopLoc_Location(level->X_WA.Inverted() * X_WN));
  if (!added.IsNull() && instance != definition) {
    CopyLooks(instance, added);
  }
}

/** Takes out what the old tree leaves behind. */
void Mover::RemoveOthers(const TDF_Label& root) {
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& label : roots) {
      is_changed = (label != root && shapes_->RemoveShape(label)) || is_changed;
    }
  }
}

std::size_t Mover::Run(const std::string& name) {
  TDF_LabelSequence roots;
  shapes_->GetFreeShapes(roots);
  const bool has_root = roots.Length() == 1 && XCAFDoc_ShapeTool::IsAssembly(roots.First());
  const std::string own_name = has_root ? NameOf(roots.First()) : std::string();
  const std::string path = own_name.empty() ? name : own_name;
  Level top = MakeLevel(has_root ? roots.First() : TDF_Label(), path, gp_Trsf());
  if (has_root) {
    Fill(roots.First(), XCAFDoc_ShapeTool::GetLocation(roots.First()).Transformation(), &top);
  } else {
    TDataStd_Name::Set(top.assembly,
                       TCollection_ExtendedString(name.c_str(), /*isMultiByte=*/true));
    for (const TDF_Label& label : roots) {
      Add(label, label, gp_Trsf(), &top);
    }
  }
  shapes_->UpdateAssemblies();
  RemoveOthers(top.assembly);
  return found_;
}

}  // namespace

std::size_t MoveComponents(const opencascade::handle<TDocStd_Document>& document,
                           const std::string& name, const Motions& motions) {
  return Mover(document, motions).Run(name);
}

}  // namespace hvas::cad
