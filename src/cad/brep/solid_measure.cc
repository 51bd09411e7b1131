#include "cad/brep/solid_measure.h"

#include <cmath>

#include <BRepGProp.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepGProp_Vinert.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <OSD_Parallel.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include "cad/brep/face_integrals.h"

namespace hvas::cad {
namespace {

constexpr double kWholeFaceError = 1e-9;  // Relative; as of faces with edges.

/** Adds the cones from the point to the parts of a whole sphere or torus, of a face of triangles
 its area alone. @returns the area of the face. */
double AddWholeFace(const TopoDS_Face& face, const gp_Pnt& about, SolidMeasure* sum) {
  GProp_GProps area(about);
  BRepGProp::SurfaceProperties(face, area);
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {
    return std::abs(area.Mass());
  }
  // Not by BRepGProp::VolumeProperties, whose cones start from the face's own placement.
  BRepGProp_Face surface;
  surface.Load(face);
  BRepGProp_Vinert cone;
  cone.SetLocation(about);
  cone.Perform(surface, kWholeFaceError);
  const gp_Pnt centre = cone.CentreOfMass();
  const Vec3 r(centre.X() - about.X(), centre.Y() - about.Y(), centre.Z() - about.Z());
  const gp_Mat central = cone.MatrixOfInertia();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      sum->inertia_mm5(row, column) += central(row + 1, column + 1);
    }
  }
  sum->volume_mm3 += cone.Mass();
  sum->first_mm4 += cone.Mass() * r;
  sum->inertia_mm5 += cone.Mass() * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  return std::abs(area.Mass());
}

/** Adds the cones from the point to the parts of a face. @returns the area of the face. */
double AddFace(const TopoDS_Face& face, const gp_Pnt& about, SolidMeasure* sum) {
  const auto integrals = IntegrateFace(face, about);
  if (!integrals) {
    return AddWholeFace(face, about, sum);
  }
  sum->volume_mm3 += integrals->volume_mm3;
  sum->first_mm4 += integrals->first_mm4;
  sum->inertia_mm5 += integrals->inertia_mm5;
  return integrals->area_mm2;
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

double MeasureArea(const TopoDS_Face& face) {
  SolidMeasure sum;
  return AddFace(face, gp_Pnt(), &sum);
}

}  // namespace hvas::cad
