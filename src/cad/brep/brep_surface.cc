#include "cad/brep/brep_surface.h"

#include <cmath>
#include <vector>

#include <BRepAdaptor_Surface.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include "base/units.h"
#include "cad/triangles/recognise.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;
using units::FromMm;

// Samples each way on a surface that may be a simpler one drawn freely: a choice, not measured.
constexpr int kGrid = 9;

Vec3 ToPoint(const gp_Pnt& p) {
  return {FromMm(p.X()), FromMm(p.Y()), FromMm(p.Z())};
}

Vec3 ToDirection(const gp_Dir& d) {
  return Vec3(d.X(), d.Y(), d.Z()).normalized();
}

Surface Make(SurfaceKind kind, const gp_Pnt& origin, const gp_Dir& axis, double radius_mm,
             double second) {
  Surface surface;
  surface.kind = kind;
  surface.origin = ToPoint(origin);
  surface.axis = ToDirection(axis);
  surface.radius = FromMm(radius_mm);
  surface.second = second;
  return surface;
}

/** Points and normals on a grid over the parameter range; poles, where there is no normal, are left
 out. */
std::vector<SurfaceSample> SampleFace(const BRepAdaptor_Surface& adaptor, const TopoDS_Face& face) {
  double u_low = 0;
  double u_high = 0;
  double v_low = 0;
  double v_high = 0;
  BRepTools::UVBounds(face, u_low, u_high, v_low, v_high);
  std::vector<SurfaceSample> samples;
  for (const double bound : {u_low, u_high, v_low, v_high}) {
    if (Precision::IsInfinite(bound)) {
      return samples;
    }
  }
  samples.reserve(static_cast<std::size_t>(kGrid) * kGrid);
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      gp_Pnt p;
      gp_Vec du;
      gp_Vec dv;
      adaptor.D1(u_low + (u_high - u_low) * i / (kGrid - 1),
                 v_low + (v_high - v_low) * j / (kGrid - 1), p, du, dv);
      const Vec3 n = Vec3(du.X(), du.Y(), du.Z()).cross(Vec3(dv.X(), dv.Y(), dv.Z()));
      const double norm = n.norm();
      if (norm > 1e-9 * (du.SquareMagnitude() + dv.SquareMagnitude()) && norm > 0) {
        samples.push_back({ToPoint(p), n / norm});
      }
    }
  }
  return samples;
}

}  // namespace

FaceSurface CalcFaceSurface(const TopoDS_Face& face, double tolerance) {
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {  // A tessellated face.
    return {};
  }
  const BRepAdaptor_Surface adaptor(face);
  switch (adaptor.GetType()) {
    case GeomAbs_Plane: {
      const gp_Pln plane = adaptor.Plane();
      return {Make(SurfaceKind::kPlane, plane.Location(), plane.Axis().Direction(), 0, 0), false};
    }
    case GeomAbs_Cylinder: {
      const gp_Cylinder cylinder = adaptor.Cylinder();
      return {Make(SurfaceKind::kCylinder, cylinder.Location(), cylinder.Axis().Direction(),
                   cylinder.Radius(), 0),
              false};
    }
    case GeomAbs_Cone: {
      const gp_Cone cone = adaptor.Cone();
      return {Make(SurfaceKind::kCone, cone.Apex(), cone.Axis().Direction(), 0,
                   std::abs(cone.SemiAngle())),
              false};
    }
    case GeomAbs_Sphere: {
      const gp_Sphere sphere = adaptor.Sphere();
      return {Make(SurfaceKind::kSphere, sphere.Location(), sphere.Position().Direction(),
                   sphere.Radius(), 0),
              false};
    }
    case GeomAbs_Torus: {
      const gp_Torus torus = adaptor.Torus();
      if (torus.MinorRadius() >= torus.MajorRadius()) {
        return {};  // It crosses its own axis; CalcDistance does not answer for that.
      }
      return {Make(SurfaceKind::kTorus, torus.Location(), torus.Axis().Direction(),
                   torus.MajorRadius(), FromMm(torus.MinorRadius())),
              false};
    }
    default:
      break;
  }
  const auto surface = RecogniseSurface(SampleFace(adaptor, face), tolerance);
  return surface ? FaceSurface{*surface, true} : FaceSurface{};
}

}  // namespace hvas::cad
