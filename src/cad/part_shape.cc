#include "cad/part_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeUpgrade_ShapeDivideAngle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/brep_surface.h"
#include "cad/recognise.h"
#include "cad/shape_hash.h"

namespace hvas::cad {
namespace {

using product::Face;
using product::Part;
using spatial::SurfaceKind;

constexpr double kRecognitionTolerance = 1e-6;          // [m]
constexpr double kRelativeRecognitionTolerance = 1e-6;  // Of the part's diagonal, for huge parts.

constexpr double kLeastGap = 100;            // Hole in a mesh, in deflections squared.
constexpr double kIntegrationError = 1e-10;  // Relative.

GProp_GProps CalcVolume(const TopoDS_Shape& solid, const gp_Pnt& about) {
  GProp_GProps properties(about);
  // The plain overload is off by up to 1e-4 of the volume on B-splines; the adaptive one costs no
  // more.
  BRepGProp::VolumeProperties(solid, properties, kIntegrationError);
  return properties;
}

/** What a part is made of: its solids, turned right side out; without any the solids inside its
 closed shells; else its loose faces. */
struct Body {
  TopoDS_Compound shape;
  GProp_GProps volume;
  int solid_count{0};
  int reversed_count{0};
  bool is_closed_shell{false};
};

void AddSolid(TopoDS_Shape solid, const gp_Pnt& centre, Body* body) {
  GProp_GProps volume = CalcVolume(solid, centre);
  if (volume.Mass() < 0) {
    solid.Reverse();
    volume = CalcVolume(solid, centre);
    ++body->reversed_count;
  }
  BRep_Builder().Add(body->shape, solid);
  body->volume.Add(volume);
  ++body->solid_count;
}

Body CollectBody(const TopoDS_Shape& shape, const gp_Pnt& centre) {
  Body body;
  body.volume = GProp_GProps(centre);
  const BRep_Builder builder;
  builder.MakeCompound(body.shape);
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    AddSolid(it.Current(), centre, &body);
  }
  if (body.solid_count > 0) {
    return body;
  }
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next()) {
    if (BRep_Tool::IsClosed(it.Current())) {
      TopoDS_Solid solid;
      builder.MakeSolid(solid);
      builder.Add(solid, it.Current());
      AddSolid(solid, centre, &body);
    }
  }
  body.is_closed_shell = body.solid_count > 0;
  if (body.solid_count == 0) {
    builder.Add(body.shape, shape);
  }
  return body;
}

std::size_t CountTriangles(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location location;
    const auto triangulation = BRep_Tool::Triangulation(TopoDS::Face(it.Current()), location);
    count += triangulation.IsNull() ? 0U : static_cast<std::size_t>(triangulation->NbTriangles());
  }
  return count;
}

bool IsMeshed(const TopoDS_Face& face) {
  TopLoc_Location location;
  return !BRep_Tool::Triangulation(face, location).IsNull();
}

std::size_t MeshOnce(const TopoDS_Shape& shape, double deflection, double angle,
                     double interior_factor = 1) {
  BRepTools::Clean(shape);  // Else a finer mesh keeps what it can of the coarser one.
  IMeshTools_Parameters parameters;
  parameters.Deflection = units::ToMm(deflection);
  parameters.Angle = angle;
  if (interior_factor > 1) {
    parameters.DeflectionInterior = interior_factor * parameters.Deflection;
    parameters.AngleInterior = 1;
  }
  const BRepMesh_IncrementalMesh mesher(shape, parameters);
  return CountTriangles(shape);
}

/** Meshes the shape in place, coarse first: on B-splines the number of triangles goes with the
 inverse of the deflection, and a fine mesh of the wrong part takes minutes. @returns the deflection
 used [m]. */
double MeshShape(const TopoDS_Shape& shape, double diagonal, const ImportOptions& options,
                 const std::string& name, Diagnostics* diagnostics) {
  constexpr double kFirst = 16;  // Of the wanted deflection.
  constexpr int kRetries = 3;
  const double wanted = std::max(options.min_deflection, options.relative_deflection * diagonal);
  double deflection = kFirst * wanted;
  double angle = options.max_angle;
  std::size_t count = MeshOnce(shape, deflection, angle);
  for (int i = 0; i < kRetries && count > options.max_triangles; ++i) {
    deflection *= 4;
    angle = std::min(1.6 * angle, 0.5);
    count = MeshOnce(shape, deflection, angle);
  }
  for (const double factor : {16.0, 4.0}) {
    if (deflection == kFirst * wanted &&
        factor * static_cast<double>(count) <= static_cast<double>(options.max_triangles)) {
      deflection /= factor;
      count = MeshOnce(shape, deflection, angle);
      break;
    }
  }
  if (count > options.max_triangles) {
    diagnostics->Warn("large-mesh", name, fmt::format("the mesh has {} triangles", count),
                      "simplify the part; contact with it will be slow");
  } else if (deflection > wanted) {
    diagnostics->Note("coarse-mesh", name,
                      fmt::format("meshed to {:.1f} um instead of {:.1f} um, with {} triangles",
                                  units::ToUm(deflection), units::ToUm(wanted), count));
  }
  return deflection;
}

/** Cuts a face that BRepMesh gives up (cones with a seam are among them) into pieces that it can
 do; of several ways the one that leaves the least undone. */
std::vector<TopoDS_Face> MeshInPieces(const TopoDS_Face& face, double deflection, double angle) {
  std::vector<TopoDS_Face> best;
  std::size_t least_undone = std::numeric_limits<std::size_t>::max();
  constexpr std::array<std::pair<double, double>, 6> kWays{
      {{90, 1}, {50, 1}, {35, 1}, {90, 2}, {90, 4}, {90, 16}}};  // Cut [deg], coarser by.
  for (const auto& [cut_deg, coarser] : kWays) {
    // A copy does not know how the neighbours divided their edges; the way out when that is the
    // snag.
    const TopoDS_Shape source = coarser > 1 ? BRepBuilderAPI_Copy(face).Shape() : face;
    ShapeUpgrade_ShapeDivideAngle divide(units::FromDeg(cut_deg), source);
    divide.Perform();
    MeshOnce(divide.Result(), coarser * deflection, angle, coarser > 1 ? 100 : 1);
    std::vector<TopoDS_Face> pieces;
    std::size_t undone = 0;
    for (TopExp_Explorer it(divide.Result(), TopAbs_FACE); it.More(); it.Next()) {
      pieces.push_back(TopoDS::Face(it.Current()));
      undone += IsMeshed(pieces.back()) ? 0U : 1U;
    }
    if (undone < least_undone) {
      least_undone = undone;
      best = std::move(pieces);
    }
    if (undone == 0) {
      break;
    }
  }
  return best;
}

/** Appends a face's triangles with outward orientation; slivers without an area are left out. */
void AppendTriangles(const TopoDS_Face& face, Part* part, Face* out) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) source = BRep_Tool::Triangulation(face, location);
  if (source.IsNull()) {
    return;
  }
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  const gp_Trsf& transform = location.Transformation();
  for (int i = 1; i <= source->NbNodes(); ++i) {
    const gp_Pnt p = source->Node(i).Transformed(transform);
    const Vec3 vertex(units::FromMm(p.X()), units::FromMm(p.Y()), units::FromMm(p.Z()));
    part->mesh.vertices.push_back(vertex);
    out->box_B.Add(vertex);
  }
  const bool is_reversed = (face.Orientation() == TopAbs_REVERSED) != transform.IsNegative();
  for (int i = 1; i <= source->NbTriangles(); ++i) {
    int a = 0;
    int b = 0;
    int c = 0;
    source->Triangle(i).Get(a, b, c);
    if (is_reversed) {
      std::swap(b, c);
    }
    const std::array<std::uint32_t, 3> triangle{first + static_cast<std::uint32_t>(a - 1),
                                                first + static_cast<std::uint32_t>(b - 1),
                                                first + static_cast<std::uint32_t>(c - 1)};
    const auto& vertices = part->mesh.vertices;
    const Vec3& p = vertices[triangle[0]];
    if ((vertices[triangle[1]] - p).cross(vertices[triangle[2]] - p).norm() > 0) {
      part->mesh.triangles.push_back(triangle);
    }
  }
  out->triangle_count =
      static_cast<std::uint32_t>(part->mesh.triangles.size()) - out->first_triangle;
}

double CalcArea(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const double area_mm2 = std::abs(properties.Mass());
  return area_mm2 * units::kMetresPerMillimetre * units::kMetresPerMillimetre;
}

/** Gives a face its surface, or leaves it freeform when the triangles do not lie on it. */
void SetSurface(const TopoDS_Face& source, double deflection, double tolerance, const Part& part,
                Face* face, Diagnostics* diagnostics) {
  if (face->triangle_count == 0) {
    return;  // Nothing to tell the outer side by.
  }
  FaceSurface found = CalcFaceSurface(source, tolerance);
  if (found.surface.kind == SurfaceKind::kFreeform) {
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
    diagnostics->Note("face-off-surface", part.name,
                      fmt::format("a face lies {:.3f} mm off the surface that the file gives for "
                                  "it; only its mesh is used",
                                  units::ToMm(worst)));
    return;
  }
  face->surface = found.surface;
  face->is_recognised = found.is_recognised;
}

void SetMass(const Body& body, Part* part) {
  constexpr double kMetres = units::kMetresPerMillimetre;
  part->solid_count = body.solid_count;
  if (body.solid_count == 0) {
    return;
  }
  const double density = part->material.density;
  part->mass.volume = units::FromMm3(body.volume.Mass());
  part->mass.mass = density * part->mass.volume;
  const gp_Pnt centre = body.volume.CentreOfMass();
  part->mass.p_BoBcm_B = kMetres * Vec3(centre.X(), centre.Y(), centre.Z());
  const gp_Mat inertia = body.volume.MatrixOfInertia();  // About the centre of mass.
  const double scale = density * units::FromMm3(1) * kMetres * kMetres;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      part->mass.I_BBcm_B(row, column) = scale * inertia(row + 1, column + 1);
    }
  }
}

double CalcMeshVolume(const product::Mesh& mesh, const Vec3& about) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    six_volumes += (mesh.vertices[t[0]] - about)
                       .dot((mesh.vertices[t[1]] - about).cross(mesh.vertices[t[2]] - about));
  }
  return six_volumes / 6;
}

/** Tells of what later stages will feel: no solid, loose faces, holes in the mesh. */
void CheckPart(const Part& part, int unmeshed, Diagnostics* diagnostics) {
  if (part.solid_count == 0) {
    diagnostics->Warn("no-solid", part.name, "the part has surfaces but no solid; it has no mass",
                      "export it as a solid body");
  }
  if (unmeshed > 0) {
    diagnostics->Warn(
        "unmeshed-face", part.name,
        fmt::format("{} of {} faces could not be meshed", unmeshed, part.faces.size()),
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
  return content;
}

bool BuildPartShape(const TopoDS_Shape& shape, const ImportOptions& options,
                    const FaceColorFn& color_of, Part* part, Diagnostics* diagnostics,
                    const FaceEntityFn& entity_of) {
  Bnd_Box box_mm;
  BRepBndLib::AddClose(shape, box_mm);
  if (box_mm.IsVoid() || box_mm.IsOpen()) {
    return false;
  }
  const double diagonal = units::FromMm(std::sqrt(box_mm.SquareExtent()));
  const gp_Pnt low = box_mm.CornerMin();
  const gp_Pnt centre = low.Translated(gp_Vec(low, box_mm.CornerMax()) * 0.5);
  const Body body = CollectBody(shape, centre);
  const double deflection = MeshShape(body.shape, diagonal, options, part->name, diagnostics);
  const double tolerance =
      std::max(kRecognitionTolerance, kRelativeRecognitionTolerance * diagonal);
  int unmeshed = 0;
  for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& source = TopoDS::Face(it.Current());
    Face face;
    face.area = CalcArea(source);
    face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
    if (IsMeshed(source)) {
      AppendTriangles(source, part, &face);
    } else if (face.area > kLeastGap * deflection * deflection) {
      for (const TopoDS_Face& piece : MeshInPieces(source, deflection, options.max_angle)) {
        AppendTriangles(piece, part, &face);
      }
      unmeshed += face.triangle_count == 0 ? 1 : 0;
    }
    SetSurface(source, deflection, tolerance, *part, &face, diagnostics);
    face.color = color_of(source);
    face.entity = entity_of ? entity_of(source) : 0;
    part->box_B.Add(face.box_B);
    part->faces.push_back(face);
  }
  if (part->mesh.triangles.empty()) {
    return false;
  }
  SetMass(body, part);
  if (body.is_closed_shell) {
    diagnostics->Note("closed-shell", part->name, "closed surfaces, taken as a solid");
  } else if (body.reversed_count > 0) {
    diagnostics->Note(
        "reversed-solid", part->name,
        fmt::format("{} solids were inside out and were turned", body.reversed_count));
  }
  CheckPart(*part, unmeshed, diagnostics);
  part->shape_hash = CalcShapeHash(*part);
  return true;
}

}  // namespace hvas::cad
