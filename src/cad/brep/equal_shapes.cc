#include "cad/brep/equal_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include "base/units.h"
#include "cad/brep/brep_surface.h"
#include "spatial/decompose.h"

namespace hvas::cad {
namespace {

using spatial::Pose;
using spatial::SurfaceKind;

constexpr double kTolerance = 1e-6;          // [m]: no face of a real part is as small. A choice.
constexpr double kRelativeTolerance = 1e-6;  // Of the size.

/** What equal shapes have in common and is had for nothing. */
using Counts = std::vector<int>;

Counts CountAll(const TopoDS_Shape& shape) {
  Counts counts(5, 0);
  constexpr std::array<TopAbs_ShapeEnum, 5> kTypes{TopAbs_SOLID, TopAbs_SHELL, TopAbs_WIRE,
                                                   TopAbs_EDGE, TopAbs_VERTEX};
  for (std::size_t i = 0; i < kTypes.size(); ++i) {
    for (TopExp_Explorer it(shape, kTypes[i]); it.More(); it.Next()) {
      ++counts[i];
    }
  }
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location location;
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    const bool has_surface = !BRep_Tool::Surface(face, location).IsNull();
    counts.push_back(has_surface ? BRepAdaptor_Surface(face, /*R=*/false).GetType() : -1);
    counts.push_back(face.Orientation());
  }
  return counts;
}

Vec3 ToMetres(const gp_Pnt& p) {
  return units::kMetresPerMillimetre * Vec3(p.X(), p.Y(), p.Z());
}

/** Points of a shape that move with it: vertices, points between them on curved edges, and points
 of faces without a name. In the order of the shape. */
struct Outline {
  std::vector<Vec3> points;  // [m]
  Vec3 centroid{Vec3::Zero()};
  Vec3 moments{Vec3::Zero()};  // Of the points about it, ascending [m^2].
  double size{0};              // Largest distance of a point from the centroid [m].
};

/** A point of the face at fractions of its parameter range; nothing where that is unbounded. */
std::optional<Vec3> PointAt(const TopoDS_Face& face, double u, double v) {
  double u0 = 0;
  double u1 = 0;
  double v0 = 0;
  double v1 = 0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  for (const double bound : {u0, u1, v0, v1}) {
    if (Precision::IsInfinite(bound)) {
      return std::nullopt;
    }
  }
  return ToMetres(BRepAdaptor_Surface(face, false).Value(u0 + u * (u1 - u0), v0 + v * (v1 - v0)));
}

constexpr std::array<std::array<double, 2>, 4> kSamples{
    {{0.5, 0.5}, {0.25, 0.375}, {0.625, 0.25}, {0.375, 0.75}}};

void AddFacePoints(const TopoDS_Face& face, Outline* outline) {
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {
    return;
  }
  const GeomAbs_SurfaceType type = BRepAdaptor_Surface(face, /*R=*/false).GetType();
  if (type < GeomAbs_Sphere) {  // Vertices and edges tell all of planes, cylinders and cones.
    return;
  }
  for (const auto& [u, v] : kSamples) {
    if (const auto point = PointAt(face, u, v)) {
      outline->points.push_back(*point);
    }
  }
}

Outline MakeOutline(const TopoDS_Shape& shape) {
  Outline outline;
  TopTools_IndexedMapOfShape vertices;
  TopExp::MapShapes(shape, TopAbs_VERTEX, vertices);
  for (int i = 1; i <= vertices.Extent(); ++i) {
    outline.points.push_back(ToMetres(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i)))));
  }
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    if (BRep_Tool::Degenerated(edge)) {
      continue;
    }
    const BRepAdaptor_Curve curve(edge);
    const double low = curve.FirstParameter();
    const double high = curve.LastParameter();
    if (curve.GetType() == GeomAbs_Line || Precision::IsInfinite(low) ||
        Precision::IsInfinite(high)) {
      continue;
    }
    for (const double t : {0.25, 0.5, 0.75}) {
      outline.points.push_back(ToMetres(curve.Value(low + t * (high - low))));
    }
  }
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    AddFacePoints(TopoDS::Face(it.Current()), &outline);
  }
  if (outline.points.empty()) {
    return outline;
  }
  for (const Vec3& point : outline.points) {
    outline.centroid += point;
  }
  outline.centroid /= static_cast<double>(outline.points.size());
  Mat3 C = Mat3::Zero();
  for (const Vec3& point : outline.points) {
    const Vec3 q = point - outline.centroid;
    C += q * q.transpose();
    outline.size = std::max(outline.size, q.norm());
  }
  outline.moments = spatial::CalcEigensystem(C / static_cast<double>(outline.points.size())).values;
  return outline;
}

double ToleranceOf(const Outline& outline) {
  return std::max(kTolerance, kRelativeTolerance * outline.size);
}

/** The rotation and translation that take the points of one outline to those of another, if they
 do. Points on one line do not tell the turn about it: no answer. */
std::optional<Pose> FindMotion(const Outline& from, const Outline& to) {
  const double tolerance = ToleranceOf(from);
  if (from.points.size() != to.points.size() || from.points.size() < 3 ||
      std::abs(from.size - to.size) > tolerance ||
      (from.moments - to.moments).norm() > 4 * from.size * tolerance) {
    return std::nullopt;
  }
  Mat3 H = Mat3::Zero();
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    H += (from.points[i] - from.centroid) * (to.points[i] - to.centroid).transpose();
  }
  const spatial::SingularValues3 svd = spatial::CalcSingularValues(H);
  if (svd.values[1] < 1e-9 * svd.values[0]) {
    return std::nullopt;
  }
  const Mat3 VU = svd.V * svd.U.transpose();
  const Vec3 signs(1, 1, VU.determinant() < 0 ? -1 : 1);
  const Mat3 R = svd.V * signs.asDiagonal() * svd.U.transpose();
  const Pose X(Quat(R).normalized(), to.centroid - R * from.centroid);
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    if ((X * from.points[i] - to.points[i]).norm() > tolerance) {
      return std::nullopt;
    }
  }
  return X;
}

/** Whether each face of `from`, moved, lies on the surface of its counterpart in `to`. */
bool DoFacesMatch(const TopoDS_Shape& from, const TopoDS_Shape& to, const Pose& X,
                  double tolerance) {
  TopExp_Explorer b(to, TopAbs_FACE);
  for (TopExp_Explorer a(from, TopAbs_FACE); a.More(); a.Next(), b.Next()) {
    const TopoDS_Face& face = TopoDS::Face(a.Current());
    const TopoDS_Face& other = TopoDS::Face(b.Current());
    TopLoc_Location location;
    if (BRep_Tool::Surface(face, location).IsNull()) {
      return false;
    }
    if (BRepAdaptor_Surface(face, /*R=*/false).GetType() > GeomAbs_Torus) {
      continue;  // Its points are in the outline.
    }
    const spatial::Surface surface = CalcFaceSurface(other, 0).surface;
    if (surface.kind == SurfaceKind::kFreeform) {
      continue;
    }
    for (const auto& [u, v] : kSamples) {
      const auto point = PointAt(face, u, v);
      if (point && std::abs(CalcDistance(surface, X * *point).distance) > tolerance) {
        return false;
      }
    }
  }
  return true;
}

/** A shape that others may equal. */
struct Candidate {
  std::size_t index{0};
  Outline outline;
};

}  // namespace

std::vector<EqualShape> FindEqualShapes(const std::vector<TopoDS_Shape>& shapes) {
  std::vector<EqualShape> result(shapes.size());
  std::map<Counts, std::vector<std::size_t>> alike;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    result[i].base = i;
    if (!shapes[i].IsNull()) {
      alike[CountAll(shapes[i])].push_back(i);
    }
  }
  for (const auto& [counts, members] : alike) {
    if (members.size() < 2) {
      continue;
    }
    std::vector<Candidate> bases;
    for (const std::size_t i : members) {
      const auto same = std::find_if(bases.begin(), bases.end(), [&](const Candidate& base) {
        return shapes[base.index].IsSame(shapes[i]);
      });
      if (same != bases.end()) {
        result[i].base = same->index;
        continue;
      }
      Candidate candidate{i, MakeOutline(shapes[i])};
      for (const Candidate& base : bases) {
        const auto X = FindMotion(base.outline, candidate.outline);
        if (X && DoFacesMatch(shapes[base.index], shapes[i], *X, ToleranceOf(base.outline))) {
          result[i] = {base.index, *X};
          break;
        }
      }
      if (result[i].base == i) {
        bases.push_back(std::move(candidate));
      }
    }
  }
  return result;
}

}  // namespace hvas::cad
