#include "cad/brep/part_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/brep/brep_surface.h"
#include "cad/brep/sew_faces.h"
#include "cad/brep/solid_measure.h"
#include "cad/triangles/recognise.h"
#include "cad/triangles/shape_hash.h"

namespace hvas::cad {
namespace {

using product::Face;
using product::Part;
using spatial::SurfaceKind;

constexpr double kRecognitionTolerance = 1e-6;          // [m]: below what is felt. A choice.
constexpr double kRelativeRecognitionTolerance = 1e-6;  // Of the part's diagonal, for huge parts.

// [m^2] in a square millimetre.
constexpr double kSquareMetres = units::kMetresPerMillimetre * units::kMetresPerMillimetre;
constexpr double kLeastGap = 100;  // Hole in a mesh, in deflections squared.

// Sewing takes time that grows faster than the number of faces. A choice.
constexpr std::size_t kMostSewnFaces = 2000;
constexpr double kSewing_mm = 0.01;  // The gap of surfaces that are meant to meet, as in IGES.

/** What a part is made of: its solids, turned right side out, also those that closed shells and
 surfaces that can be sewn enclose; behind them its loose faces. */
struct Body {
  TopoDS_Compound shape;
  gp_Pnt centre;         // What it is measured about.
  SolidMeasure measure;  // Areas of all faces; the rest is zero where there is no solid.
  int solid_count{0};
  int reversed_count{0};
  int closed_shell_count{0};    // Of the solids: those that the file has as surfaces only.
  std::size_t loose_count{0};   // Faces at the end of `shape` that enclose nothing.
  std::size_t unsewn_count{0};  // Of these: faces that are too many to be sewn.
  TopTools_DataMapOfShapeShape originals;  // The faces of the file that sewn ones come from.
};

void AddSolid(TopoDS_Shape solid, bool is_threaded, Body* body) {
  SolidMeasure measure = MeasureSolid(solid, body->centre, is_threaded);
  if (measure.volume_mm3 < 0) {
    solid.Reverse();
    measure.Negate();
    ++body->reversed_count;
  }
  BRep_Builder().Add(body->shape, solid);
  body->measure.Add(measure);
  ++body->solid_count;
}

/** The faces of a shape that are not in a solid, but for those that a solid has as well; closed
 shells among them become solids of the body. */
std::vector<TopoDS_Shape> CollectLooseFaces(const TopoDS_Shape& shape, bool is_threaded,
                                            Body* body) {
  TopTools_MapOfShape known;
  for (TopExp_Explorer it(body->shape, TopAbs_FACE); it.More(); it.Next()) {
    known.Add(it.Current().Oriented(TopAbs_FORWARD));
  }
  std::vector<TopoDS_Shape> loose;
  const auto add_loose = [&](const TopoDS_Shape& face) {
    if (known.Add(face.Oriented(TopAbs_FORWARD))) {
      loose.push_back(face);
    }
  };
  for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next()) {
    TopExp_Explorer first(it.Current(), TopAbs_FACE);
    const bool is_new = first.More() && !known.Contains(first.Current().Oriented(TopAbs_FORWARD));
    if (is_new && BRep_Tool::IsClosed(it.Current())) {
      TopoDS_Solid solid;
      BRep_Builder().MakeSolid(solid);
      BRep_Builder().Add(solid, it.Current());
      AddSolid(solid, is_threaded, body);
      ++body->closed_shell_count;
      for (; first.More(); first.Next()) {
        known.Add(first.Current().Oriented(TopAbs_FORWARD));
      }
      continue;
    }
    for (; first.More(); first.Next()) {
      add_loose(first.Current());
    }
  }
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    add_loose(it.Current());
  }
  return loose;
}

/** Sews loose faces: what closes becomes a solid of the body. @returns the faces that stay loose.
 */
std::vector<TopoDS_Shape> SewLooseFaces(const std::vector<TopoDS_Shape>& loose, bool is_threaded,
                                        Body* body) {
  if (loose.size() > kMostSewnFaces) {
    body->unsewn_count = loose.size();
    return loose;
  }
  const SewnFaces sewn = SewFaces(loose, kSewing_mm);
  if (sewn.solids.empty()) {
    return loose;
  }
  for (const TopoDS_Shape& solid : sewn.solids) {
    AddSolid(solid, is_threaded, body);
    ++body->closed_shell_count;
  }
  TopTools_MapOfShape closed;
  for (TopExp_Explorer it(body->shape, TopAbs_FACE); it.More(); it.Next()) {
    closed.Add(it.Current());
  }
  std::vector<TopoDS_Shape> open;
  for (const TopoDS_Shape& face : loose) {
    const TopoDS_Shape modified = sewn.modified(face);
    if (!closed.Contains(modified)) {
      open.push_back(face);
    } else if (!modified.IsSame(face)) {
      body->originals.Bind(modified, face);
    }
  }
  return open;
}

Body CollectBody(const TopoDS_Shape& shape, const gp_Pnt& centre, bool is_threaded) {
  Body body;
  body.centre = centre;
  const BRep_Builder builder;
  builder.MakeCompound(body.shape);
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    AddSolid(it.Current(), is_threaded, &body);
  }
  std::vector<TopoDS_Shape> loose = CollectLooseFaces(shape, is_threaded, &body);
  if (loose.size() > 1) {
    loose = SewLooseFaces(loose, is_threaded, &body);
  }
  body.loose_count = loose.size();
  for (const TopoDS_Shape& face : loose) {
    builder.Add(body.shape, face);
    body.measure.face_areas_mm2.push_back(MeasureArea(TopoDS::Face(face)));
  }
  return body;
}

/** Makes the part's faces, with their display triangles. @pre The shape is meshed for display. */
void AddDisplayMesh(const TopoDS_Shape& shape, Part* part) {
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    Face face;
    face.first_display_triangle = static_cast<std::uint32_t>(part->display_mesh.triangles.size());
    AppendTriangles(TopoDS::Face(it.Current()), &part->display_mesh);
    face.display_triangle_count = static_cast<std::uint32_t>(part->display_mesh.triangles.size()) -
                                  face.first_display_triangle;
    part->faces.push_back(face);
  }
}

/** Lends a face that could be meshed only in pieces its fine triangles for display. */
void CopyToDisplay(Part* part, Face* face) {
  product::Mesh& display = part->display_mesh;
  face->first_display_triangle = static_cast<std::uint32_t>(display.triangles.size());
  face->display_triangle_count = face->triangle_count;
  for (std::uint32_t i = 0; i < face->triangle_count; ++i) {
    const auto first = static_cast<std::uint32_t>(display.vertices.size());
    for (const std::uint32_t vertex : part->mesh.triangles[face->first_triangle + i]) {
      display.vertices.push_back(part->mesh.vertices[vertex]);
    }
    display.triangles.push_back({first, first + 1, first + 2});
  }
}

/** What was lost of the faces of a part. */
struct FaceLoss {
  int unmeshed{0};            // Faces without triangles.
  double unmeshed_area{0};    // Their area [m^2].
  double shown_only_area{0};  // Of the loose faces beside solids [m^2].
  double area{0};             // Of all faces [m^2].
};

/** Gives the part's faces area, box and triangles. Faces that enclose nothing have none where there
 are solids, whose contact they would spoil: they are shown. @pre The shape is meshed for contact,
 and AddDisplayMesh was called. */
FaceLoss AddContactMesh(const Body& body, const MeshLevel& level, Part* part) {
  FaceLoss loss;
  const std::size_t first_loose =
      body.solid_count > 0 ? part->faces.size() - body.loose_count : part->faces.size();
  std::size_t index = 0;
  for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next(), ++index) {
    const TopoDS_Face& source = TopoDS::Face(it.Current());
    Face& face = part->faces[index];
    face.area = kSquareMetres * body.measure.face_areas_mm2[index];
    loss.area += face.area;
    face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
    if (index >= first_loose) {
      loss.shown_only_area += face.area;
      continue;
    }
    const std::size_t first_vertex = part->mesh.vertices.size();
    const bool is_whole = IsMeshed(source);
    if (is_whole) {
      AppendTriangles(source, &part->mesh);
    } else if (face.area > kLeastGap * level.deflection * level.deflection) {
      for (const TopoDS_Face& piece : MeshInPieces(source, level)) {
        AppendTriangles(piece, &part->mesh);
      }
    }
    for (std::size_t i = first_vertex; i < part->mesh.vertices.size(); ++i) {
      face.box_B.Add(part->mesh.vertices[i]);
    }
    part->box_B.Add(face.box_B);
    face.triangle_count =
        static_cast<std::uint32_t>(part->mesh.triangles.size()) - face.first_triangle;
    if (face.display_triangle_count == 0) {
      CopyToDisplay(part, &face);
    }
    const bool is_gap = !is_whole && face.triangle_count == 0 &&
                        face.area > kLeastGap * level.deflection * level.deflection;
    loss.unmeshed += is_gap ? 1 : 0;
    loss.unmeshed_area += is_gap ? face.area : 0;
  }
  return loss;
}

/** Gives a face its surface, or leaves it freeform when the triangles do not lie on it. */
void SetSurface(const TopoDS_Face& source, FaceSurface found, double deflection, const Part& part,
                Face* face, Diagnostics* diagnostics) {
  // Without triangles there is nothing to tell the outer side by.
  if (face->triangle_count == 0 || found.surface.kind == SurfaceKind::kFreeform) {
    return;
  }
  const auto triangles =
      std::span(part.mesh.triangles).subspan(face->first_triangle, face->triangle_count);
  const double agreement = OrientSurface(part.mesh.vertices, triangles, &found.surface);
  const double slack = 10 * deflection + 4 * units::FromMm(BRep_Tool::Tolerance(source)) + 1e-5;
  double worst = 0;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t vertex : triangle) {
      worst = std::max(worst,
                       std::abs(CalcDistance(found.surface, part.mesh.vertices[vertex]).distance));
    }
  }
  if (agreement < 0.5 || worst > slack) {
    diagnostics->Note(
        "face-off-surface", part.name,
        fmt::format(
            "a face deviates by {:.3f} mm from its surface in the file; only its mesh is used",
            units::ToMm(worst)));
    return;
  }
  face->surface = found.surface;
  face->is_recognised = found.is_recognised;
}

void SetMass(const Body& body, Part* part) {
  constexpr double kMetres = units::kMetresPerMillimetre;  // [m] in a millimetre.
  const SolidMeasure& measure = body.measure;
  part->solid_count = body.solid_count;
  const double faces =
      std::accumulate(measure.face_areas_mm2.begin(), measure.face_areas_mm2.end(), 0.0);
  // A solid of no thickness has what rounding leaves of its volume.
  if (body.solid_count == 0 || !(measure.volume_mm3 > 1e-9 * std::pow(faces, 1.5))) {
    return;
  }
  const double density = part->material.density;
  part->mass.volume = units::FromMm3(measure.volume_mm3);
  part->mass.mass = density * part->mass.volume;
  const Vec3 r = measure.first_mm4 / measure.volume_mm3;
  const Vec3 centre(body.centre.X(), body.centre.Y(), body.centre.Z());
  part->mass.p_BoBcm_B = kMetres * (centre + r);
  const Mat3 shift = measure.volume_mm3 * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  part->mass.I_BBcm_B =
      density * units::FromMm3(1) * kMetres * kMetres * (measure.inertia_mm5 - shift);
}

double CalcMeshVolume(const product::Mesh& mesh, const Vec3& about) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    six_volumes += (mesh.vertices[t[0]] - about)
                       .dot((mesh.vertices[t[1]] - about).cross(mesh.vertices[t[2]] - about));
  }
  return six_volumes / 6;
}

/** Tells of what later stages will feel: no solid or volume, several solids, holes in the mesh. */
void CheckPart(const Part& part, const Body& body, const FaceLoss& loss, Diagnostics* diagnostics) {
  const auto share = [&loss](double area) { return 100 * area / std::max(loss.area, 1e-30); };
  if (part.solid_count > 0 && body.loose_count > 0) {
    diagnostics->Warn(
        "loose-faces", part.name,
        fmt::format("{} of {} faces ({:.3g} % of the area) belong to no solid{}; they are shown, "
                    "but have no contact and no mass",
                    body.loose_count, part.faces.size(), share(loss.shown_only_area),
                    body.unsewn_count > 0 ? " and are too many to be sewn" : ""),
        "close the surfaces to a solid in the CAD system, or leave them out of the export");
  }

  if (part.solid_count == 0) {
    diagnostics->Warn("no-solid", part.name, "the part has surfaces but no solid; it has no mass",
                      "export the part as a solid body");
  } else if (part.mass.volume <= 0) {
    diagnostics->Warn("no-volume", part.name, "the solid encloses no volume; it has no mass",
                      "heal the part in the CAD system and export it again");
  }
  if (part.solid_count > 1) {
    diagnostics->Note(
        "several-solids", part.name,
        fmt::format("the part has {} solids, which move as one rigid body", part.solid_count),
        "export the solids as parts of a subassembly to move them separately");
  }
  if (loss.unmeshed > 0) {
    diagnostics->Warn("unmeshed-face", part.name,
                      fmt::format("{} of {} faces ({:.3g} % of the area) could not be meshed",
                                  loss.unmeshed, part.faces.size(), share(loss.unmeshed_area)),
                      "heal the part in the CAD system and export it again");
  }
  const double mesh_volume = CalcMeshVolume(part.mesh, part.mass.p_BoBcm_B);
  if (part.solid_count > 0 &&
      std::abs(mesh_volume - part.mass.volume) > 0.02 * std::abs(part.mass.volume)) {
    diagnostics->Warn("volume-mismatch", part.name,
                      fmt::format("the mesh encloses {:.3f} mm3, the solid {:.3f} mm3",
                                  units::ToMm3(mesh_volume), units::ToMm3(part.mass.volume)),
                      "the solid may be open; heal it in the CAD system");
  }
}

}  // namespace

ShapeContent CountContent(const TopoDS_Shape& shape) {
  ShapeContent content;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    ++content.solids;
  }
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    ++content.faces;
  }
  for (TopExp_Explorer it(shape, TopAbs_EDGE, TopAbs_FACE); it.More(); it.Next()) {
    ++content.free_curves;
  }
  return content;
}

std::optional<MeshLevel> BuildPartShape(const TopoDS_Shape& shape, const ImportOptions& options,
                                        const FaceColorFn& color_of, Part* part,
                                        Diagnostics* diagnostics, const FaceEntityFn& entity_of) {
  Bnd_Box box_mm;
  BRepBndLib::AddClose(shape, box_mm);
  if (box_mm.IsVoid() || box_mm.IsOpen()) {
    return std::nullopt;
  }
  const double diagonal = units::FromMm(std::sqrt(box_mm.SquareExtent()));
  const gp_Pnt low = box_mm.CornerMin();
  const gp_Pnt centre = low.Translated(gp_Vec(low, box_mm.CornerMax()) * 0.5);
  const Body body = CollectBody(shape, centre, options.threads != 1);
  const MeshLevel display = MeshForDisplay(body.shape, diagonal, options);
  AddDisplayMesh(body.shape, part);
  const double tolerance =
      std::max(kRecognitionTolerance, kRelativeRecognitionTolerance * diagonal);
  std::vector<FaceSurface> surfaces;
  std::vector<bool> is_analytic;
  for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next()) {
    surfaces.push_back(CalcFaceSurface(TopoDS::Face(it.Current()), tolerance));
    is_analytic.push_back(surfaces.back().surface.kind != SurfaceKind::kFreeform);
  }
  const MeshLevel level =
      MeshForContact(body.shape, diagonal, display, is_analytic, options, part->name, diagnostics);
  const FaceLoss loss = AddContactMesh(body, level, part);
  std::size_t index = 0;
  for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next(), ++index) {
    const TopoDS_Face& source = TopoDS::Face(it.Current());
    Face& face = part->faces[index];
    SetSurface(source, surfaces[index], level.deflection, *part, &face, diagnostics);
    const TopoDS_Shape* original = body.originals.Seek(source);
    const TopoDS_Face& known = original != nullptr ? TopoDS::Face(*original) : source;
    face.color = color_of(known);
    face.entity = entity_of ? entity_of(known) : 0;
  }
  BRepTools::Clean(body.shape);  // The triangles are ours now.
  if (part->mesh.triangles.empty()) {
    return std::nullopt;
  }
  SetMass(body, part);
  if (body.closed_shell_count > 0) {
    diagnostics->Note("closed-shell", part->name, "closed surfaces are treated as a solid");
  } else if (body.reversed_count > 0) {
    diagnostics->Note(
        "reversed-solid", part->name,
        fmt::format("{} solids were inside out and were reversed", body.reversed_count));
  }
  CheckPart(*part, body, loss, diagnostics);
  part->shape_hash = CalcShapeHash(*part);
  return level;
}

}  // namespace hvas::cad
