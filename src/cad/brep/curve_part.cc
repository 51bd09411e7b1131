#include "cad/brep/curve_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/triangles/shape_hash.h"

namespace hvas::cad {
namespace {

constexpr double kRadius = 1e-3;      // Of a tube, over the diagonal of the part. A choice.
constexpr double kDeflection = 1e-3;  // Of the chords of a curve, likewise. A choice.
constexpr double kAngle = 0.35;       // [rad] between chords, 20 degrees: round to the eye.
constexpr std::uint32_t kSides = 3;   // Of a tube: the fewest.

/** Points along a curve; none where it has no length or no end. */
std::vector<Vec3> SampleCurve(const TopoDS_Edge& edge, double deflection) {
  std::vector<Vec3> points;
  if (BRep_Tool::Degenerated(edge) || !BRep_Tool::IsGeometric(edge)) {
    return points;
  }
  const BRepAdaptor_Curve curve(edge);
  if (Precision::IsInfinite(curve.FirstParameter()) ||
      Precision::IsInfinite(curve.LastParameter())) {
    return points;
  }
  const GCPnts_TangentialDeflection chords(curve, kAngle, units::ToMm(deflection));
  for (int i = 1; i <= chords.NbPoints(); ++i) {
    const gp_Pnt p = chords.Value(i);
    const Vec3 point(units::FromMm(p.X()), units::FromMm(p.Y()), units::FromMm(p.Z()));
    if (points.empty() || (point - points.back()).norm() > 0) {
      points.push_back(point);
    }
  }
  return points.size() > 1 ? points : std::vector<Vec3>();
}

/** Appends a tube around a polyline, closed at its ends. @pre Neighbouring points differ. */
void AppendTube(const std::vector<Vec3>& points, double radius, product::Mesh* mesh) {
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  Vec3 side = Vec3::Zero();  // Turns with the polyline, and as little as possible about it.
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 chord =
        points[std::min(i + 1, points.size() - 1)] - points[std::max<std::size_t>(i, 1) - 1];
    const Vec3 axis = chord.norm() > 0 ? Vec3(chord.normalized())
                                       : Vec3((points[i] - points[i - 1]).normalized());
    side -= side.dot(axis) * axis;
    side = side.norm() > 1e-3 ? Vec3(side.normalized()) : Vec3(axis.unitOrthogonal());
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      mesh->vertices.emplace_back(
          points[i] + radius * (std::cos(angle) * side + std::sin(angle) * axis.cross(side)));
    }
  }
  const auto last = static_cast<std::uint32_t>(mesh->vertices.size()) - kSides;
  for (std::uint32_t ring = first; ring < last; ring += kSides) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = ring + k;
      const std::uint32_t b = ring + (k + 1) % kSides;
      mesh->triangles.push_back({a, b, b + kSides});
      mesh->triangles.push_back({a, b + kSides, a + kSides});
    }
  }
  mesh->triangles.push_back({first, first + 2, first + 1});
  mesh->triangles.push_back({last, last + 1, last + 2});
}

/** Adds a face whose triangles are the last ones of the mesh, from `first_triangle` on. */
void AddTubeFace(std::size_t first_triangle, product::Part* part) {
  product::Face face;
  face.first_triangle = static_cast<std::uint32_t>(first_triangle);
  face.triangle_count = static_cast<std::uint32_t>(part->mesh.triangles.size() - first_triangle);
  face.first_display_triangle = face.first_triangle;
  face.display_triangle_count = face.triangle_count;
  for (std::size_t i = first_triangle; i < part->mesh.triangles.size(); ++i) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = part->mesh.vertices[part->mesh.triangles[i][k]];
      face.box_B.Add(corners[k]);
    }
    face.area += 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  }
  part->box_B.Add(face.box_B);
  part->faces.push_back(face);
}

}  // namespace

bool BuildCurvePart(const TopoDS_Shape& shape, const ImportOptions& options, product::Part* part,
                    Diagnostics* diagnostics) {
  Bnd_Box box_mm;
  BRepBndLib::Add(shape, box_mm);
  if (box_mm.IsVoid() || box_mm.IsOpen()) {
    return false;
  }
  const double diagonal = units::FromMm(std::sqrt(box_mm.SquareExtent()));
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const std::vector<Vec3> points = SampleCurve(TopoDS::Edge(edges(i)), kDeflection * diagonal);
    const std::size_t first = part->mesh.triangles.size();
    if (!points.empty() && first + 2 * kSides * points.size() <= options.max_triangles) {
      AppendTube(points, kRadius * diagonal, &part->mesh);
      AddTubeFace(first, part);
    }
  }
  if (part->faces.empty()) {
    return false;
  }
  part->display_mesh = part->mesh;
  part->shape_hash = CalcShapeHash(*part);
  diagnostics->Warn("curves-only", part->name,
                    fmt::format("the part has {} curves and no faces; {} of them are shown as thin "
                                "tubes, and it has no mass",
                                edges.Extent(), part->faces.size()),
                    "export the part as a solid body");
  return true;
}

}  // namespace hvas::cad
