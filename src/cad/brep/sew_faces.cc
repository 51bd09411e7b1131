#include "cad/brep/sew_faces.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

namespace hvas::cad {
namespace {

/** A closed shell as a solid of its own, with its place among the others. */
struct Closed {
  TopoDS_Shape shell;
  TopoDS_Solid solid;  // With the material inside.
  Bnd_Box box;
  std::size_t depth{0};  // Shells around it.
  std::size_t outer{0};  // The innermost of them.
};

Closed MakeClosed(const TopoDS_Shape& shell) {
  Closed closed;
  closed.shell = shell;
  const BRep_Builder builder;
  builder.MakeSolid(closed.solid);
  builder.Add(closed.solid, shell);
  BRepLib::OrientClosedSolid(closed.solid);
  BRepBndLib::Add(shell, closed.box);
  return closed;
}

/** Whether a shell lies inside a solid, by one of its vertices: shells do not cut each other. */
bool IsInside(const Closed& inner, const Closed& outer, double tolerance_mm) {
  if (outer.box.IsOut(inner.box.CornerMin()) || outer.box.IsOut(inner.box.CornerMax())) {
    return false;
  }
  const TopExp_Explorer vertex(inner.shell, TopAbs_VERTEX);
  if (!vertex.More()) {
    return false;
  }
  BRepClass3d_SolidClassifier classifier(outer.solid);
  classifier.Perform(BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())), tolerance_mm);
  return classifier.State() == TopAbs_IN;
}

void FindDepths(std::vector<Closed>* shells, double tolerance_mm) {
  for (std::size_t i = 0; i < shells->size(); ++i) {
    Closed& inner = (*shells)[i];
    for (std::size_t k = 0; k < shells->size(); ++k) {
      if (k != i && IsInside(inner, (*shells)[k], tolerance_mm)) {
        const bool is_nearer = inner.depth == 0 || (*shells)[k].box.SquareExtent() <
                                                       (*shells)[inner.outer].box.SquareExtent();
        inner.outer = is_nearer ? k : inner.outer;
        ++inner.depth;
      }
    }
  }
}

/** The solids at even depth, each with the shells of its cavities turned inside out. */
std::vector<TopoDS_Shape> MakeSolids(std::vector<Closed> shells, double tolerance_mm) {
  FindDepths(&shells, tolerance_mm);
  const BRep_Builder builder;
  for (const Closed& shell : shells) {
    if (shell.depth % 2 == 1) {
      for (TopExp_Explorer it(shell.solid, TopAbs_SHELL); it.More(); it.Next()) {
        builder.Add(shells[shell.outer].solid, it.Current().Reversed());
      }
    }
  }
  std::vector<TopoDS_Shape> solids;
  for (const Closed& shell : shells) {
    if (shell.depth % 2 == 0) {
      solids.emplace_back(shell.solid);
    }
  }
  return solids;
}

}  // namespace

SewnFaces SewFaces(const std::vector<TopoDS_Shape>& faces, double tolerance_mm) {
  const Handle(BRepBuilderAPI_Sewing) sewing = new BRepBuilderAPI_Sewing(tolerance_mm);
  for (const TopoDS_Shape& face : faces) {
    sewing->Add(face);
  }
  sewing->Perform();
  SewnFaces result;
  result.tolerance_mm = tolerance_mm;
  result.modified = [sewing](const TopoDS_Shape& face) {
    return sewing->IsModified(face) ? sewing->Modified(face) : face;
  };
  const BRep_Builder builder;
  TopoDS_Compound open;
  builder.MakeCompound(open);
  bool has_open = false;
  std::vector<Closed> closed;
  for (TopExp_Explorer it(sewing->SewedShape(), TopAbs_SHELL); it.More(); it.Next()) {
    if (BRep_Tool::IsClosed(it.Current())) {
      closed.push_back(MakeClosed(it.Current()));
    } else {
      builder.Add(open, it.Current());
      has_open = true;
    }
  }
  for (TopExp_Explorer it(sewing->SewedShape(), TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    builder.Add(shell, it.Current());
    if (BRep_Tool::IsClosed(shell)) {  // A sphere or a torus in one face.
      closed.push_back(MakeClosed(shell));
    } else {
      builder.Add(open, it.Current());
      has_open = true;
    }
  }
  if (has_open) {
    result.open = open;
    result.open_edges = sewing->NbFreeEdges();
  }
  result.solids = MakeSolids(std::move(closed), tolerance_mm);
  return result;
}

}  // namespace hvas::cad
