#include "cad/brep/solid_measure.h"

#include <cmath>

#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepGProp_Domain.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepGProp_Vinert.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <OSD_Parallel.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pln.hxx>

namespace hvas::cad {
namespace {

constexpr double kIntegrationError =
    1e-10;  // Relative; with 1e-8, which is a third faster, volumes of gears err by 1e-4.

/** Whether the fixed quadrature is exact on a face: an analytic surface between curves that are
 lines or conics in its parameters. */
bool IsSimple(const TopoDS_Face& face, GeomAbs_SurfaceType type) {
  if (type > GeomAbs_Torus) {
    return false;
  }
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
    if (BRepAdaptor_Curve2d(TopoDS::Edge(it.Current()), face).GetType() > GeomAbs_Ellipse) {
      return false;
    }
  }
  return true;
}

/** The signed distance of a plane from a point along the outward normal of a face on it. */
double CalcHeight(const TopoDS_Face& face, const gp_Pln& plane, const gp_Pnt& about) {
  const bool is_reversed = face.Orientation() == TopAbs_REVERSED;
  const double sign = plane.Position().Direct() != is_reversed ? 1 : -1;
  return sign * gp_Vec(about, plane.Location()).Dot(gp_Vec(plane.Axis().Direction()));
}

/** Adds integrals times factors, one for each degree of the position in them. */
void AddIntegrals(const GProp_GProps& source, const gp_Pnt& about, const Vec3& factors,
                  SolidMeasure* sum) {
  const double mass = source.Mass();
  const gp_Pnt centre = source.CentreOfMass();
  const Vec3 r(centre.X() - about.X(), centre.Y() - about.Y(), centre.Z() - about.Z());
  const gp_Mat central = source.MatrixOfInertia();
  Mat3 inertia = mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      inertia(row, column) += central(row + 1, column + 1);
    }
  }
  sum->volume_mm3 += factors[0] * mass;
  sum->first_mm4 += factors[1] * mass * r;
  sum->inertia_mm5 += factors[2] * inertia;
}

/** The cones from a point to the parts of a curved face. Not by BRepGProp::VolumeProperties, whose
 cones start from the origin of the face's own placement. */
BRepGProp_Vinert Integrate(const TopoDS_Face& face, const gp_Pnt& about, bool is_simple) {
  BRepGProp_Vinert volume;
  volume.SetLocation(about);
  BRepGProp_Face surface;
  surface.Load(face);
  BRepGProp_Domain domain;
  const bool is_bounded = face.NbChildren() > 0;
  if (is_bounded) {
    domain.Init(face);
  }
  if (is_bounded && is_simple) {
    volume.Perform(surface, domain);
  } else if (is_bounded) {
    volume.Perform(surface, domain, kIntegrationError);
  } else if (is_simple) {
    volume.Perform(surface);
  } else {
    volume.Perform(surface, kIntegrationError);
  }
  return volume;
}

/** Adds the cones from the point to the parts of a face. @returns the area of the face. */
double AddFace(const TopoDS_Face& face, const gp_Pnt& about, SolidMeasure* sum) {
  GProp_GProps area(about);
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {  // Triangles only.
    BRepGProp::SurfaceProperties(face, area);
    return std::abs(area.Mass());
  }
  const BRepAdaptor_Surface surface(face, /*R=*/false);
  const bool is_simple = IsSimple(face, surface.GetType());
  if (surface.GetType() == GeomAbs_Plane && !is_simple) {
    BRepGProp::SurfaceProperties(face, area, kIntegrationError);
  } else {
    BRepGProp::SurfaceProperties(face, area);
  }
  if (surface.GetType() == GeomAbs_Plane) {
    // Cones of one height: integrals over the area, over 3, 4 and 5 by the degree.
    const double height = (area.Mass() < 0 ? -1 : 1) * CalcHeight(face, surface.Plane(), about);
    AddIntegrals(area, about, height * Vec3(1.0 / 3, 1.0 / 4, 1.0 / 5), sum);
    return std::abs(area.Mass());
  }
  const BRepGProp_Vinert volume = Integrate(face, about, is_simple);
  AddIntegrals(volume, about, Vec3::Ones(), sum);
  return std::abs(area.Mass());
}

}  // namespace

void SolidMeasure::Add(const SolidMeasure& other) {
  volume_mm3 += other.volume_mm3;
  first_mm4 += other.first_mm4;
  inertia_mm5 += other.inertia_mm5;
  face_areas_mm2.insert(face_areas_mm2.end(), other.face_areas_mm2.begin(),
                        other.face_areas_mm2.end());
}

void SolidMeasure::Negate() {
  volume_mm3 = -volume_mm3;
  first_mm4 = -first_mm4;
  inertia_mm5 = -inertia_mm5;
}

SolidMeasure MeasureSolid(const TopoDS_Shape& solid, const gp_Pnt& about, bool is_threaded) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    faces.push_back(TopoDS::Face(it.Current()));
  }
  std::vector<SolidMeasure> cones(faces.size());
  const auto measure_face = [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const double area = AddFace(faces[index], about, &cones[index]);
    cones[index].face_areas_mm2.push_back(area);
  };
  OSD_Parallel::For(0, static_cast<int>(faces.size()), measure_face,
                    /*isForceSingleThreadExecution=*/!is_threaded);
  SolidMeasure measure;
  for (const SolidMeasure& cone : cones) {
    measure.Add(cone);
  }
  return measure;
}

double MeasureArea(const TopoDS_Shape& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return std::abs(properties.Mass());
}

}  // namespace hvas::cad
