#include "cad/brep/part_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_Context.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <IMeshData_Face.hxx>
#include <IMeshData_Model.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeUpgrade_ShapeDivideAngle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <fmt/format.h>

#include "base/units.h"

namespace hvas::cad {
namespace {

constexpr double kDisplayDeflection = 1e-3;  // Of the diagonal.
constexpr double kDisplayAngle = 0.35;       // [rad], 20 degrees: round to the eye. A choice.
constexpr double kCoarser = 4;               // From one try to the next.
constexpr int kRetries = 3;                  // 4^3: 64 times coarser, then it is refused.

// Largest deflection inside faces over that of edges. Contact does not take distances from the mesh
// of an analytic face, so that angles limit it alone.
constexpr double kFreeformInterior = 2;
constexpr double kAnalyticInterior = 25;
constexpr double kAnalyticAngle = 0.3;  // [rad], inside spheres and tori.

/** Lets faces have deflections of their own inside, whereas edges are divided the same for all. */
class FaceLevels : public BRepMesh_Context {
 public:
  FaceLevels(const TopTools_MapOfShape& analytic, double deflection_mm)
      : analytic_(analytic), deflection_mm_(deflection_mm) {}

  Standard_Boolean PreProcessModel() override {
    if (!BRepMesh_Context::PreProcessModel()) {
      return Standard_False;
    }
    // The edges have their points by now. Freeform faces go by the angle inside.
    ChangeParameters().Angle = std::max(GetParameters().Angle, kAnalyticAngle);
    for (int i = 0; i < GetModel()->FacesNb(); ++i) {
      const auto& face = GetModel()->GetFace(i);
      const double factor =
          analytic_.Contains(face->GetFace()) ? kAnalyticInterior : kFreeformInterior;
      face->SetDeflection(std::max(face->GetDeflection(), factor * deflection_mm_));
    }
    return Standard_True;
  }

 private:
  const TopTools_MapOfShape& analytic_;
  double deflection_mm_;
};

/** Meshes anew, several faces at a time unless there is to be one thread only; every face comes out
 as it would alone. @param analytic  Null: no face is coarser inside than at its edges.
 @returns the number of triangles. */
std::size_t MeshOnce(const TopoDS_Shape& shape, const MeshLevel& level, bool is_threaded,
                     const TopTools_MapOfShape* analytic, double interior_factor = 1) {
  BRepTools::Clean(shape);  // Else a finer mesh keeps what it can of the coarser one.
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(shape);
  IMeshTools_Parameters& parameters = mesher.ChangeParameters();
  parameters.Deflection = units::ToMm(level.deflection);
  parameters.Angle = level.angle;
  parameters.InParallel = is_threaded;
  if (interior_factor > 1) {
    parameters.DeflectionInterior = interior_factor * parameters.Deflection;
    parameters.AngleInterior = 1;
  }
  Handle(IMeshTools_Context) context = new BRepMesh_Context;
  if (analytic != nullptr) {
    parameters.AngleInterior = parameters.Angle;
    context = new FaceLevels(*analytic, parameters.Deflection);
  }
  mesher.Perform(context);
  std::size_t count = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location location;
    const auto triangulation = BRep_Tool::Triangulation(TopoDS::Face(it.Current()), location);
    count += triangulation.IsNull() ? 0U : static_cast<std::size_t>(triangulation->NbTriangles());
  }
  return count;
}

/** The triangles that the present mesh of a shape would become at a finer level: on a surface that
 bends one way or not at all their number goes with the segments of a curve. */
struct Forecast {
  double flat{0};      // Triangles on planes, cylinders, cones and extrusions.
  double round{0};     // On other analytic surfaces.
  double freeform{0};  // All others.

  [[nodiscard]] double Calc(const MeshLevel& from, const MeshLevel& to) const {
    const double chords = std::max(1.0, from.deflection / to.deflection);
    const double turns = std::max(1.0, from.angle / to.angle);
    const double segments = std::max(std::sqrt(chords), turns);
    return flat * segments + round * std::max(segments, turns * turns) +
           freeform * std::max({segments, chords / kFreeformInterior, turns * turns});
  }
};

bool IsFlat(const TopoDS_Face& face) {
  TopLoc_Location location;
  if (BRep_Tool::Surface(face, location).IsNull()) {
    return true;
  }
  switch (BRepAdaptor_Surface(face, /*R=*/false).GetType()) {
    case GeomAbs_Plane:
    case GeomAbs_Cylinder:
    case GeomAbs_Cone:
    case GeomAbs_SurfaceOfExtrusion:
      return true;
    default:
      return false;
  }
}

Forecast MakeForecast(const TopoDS_Shape& shape, const TopTools_MapOfShape& analytic) {
  Forecast forecast;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    TopLoc_Location location;
    const auto triangulation = BRep_Tool::Triangulation(face, location);
    if (!triangulation.IsNull()) {
      double& kind = IsFlat(face)              ? forecast.flat
                     : analytic.Contains(face) ? forecast.round
                                               : forecast.freeform;
      kind += triangulation->NbTriangles();
    }
  }
  return forecast;
}

MeshLevel Coarsen(const MeshLevel& level) {
  return {kCoarser * level.deflection, std::min(1.6 * level.angle, 0.5)};
}

}  // namespace

bool IsMeshed(const TopoDS_Face& face) {
  TopLoc_Location location;
  return !BRep_Tool::Triangulation(face, location).IsNull();
}

MeshLevel MeshForDisplay(const TopoDS_Shape& shape, double diagonal, const ImportOptions& options) {
  MeshLevel level{std::max(options.min_deflection, kDisplayDeflection * diagonal), kDisplayAngle};
  const bool is_threaded = options.threads != 1;
  std::size_t count = MeshOnce(shape, level, is_threaded, nullptr);
  for (int i = 0; i < kRetries && 2 * count > options.max_triangles; ++i) {
    level = Coarsen(level);
    count = MeshOnce(shape, level, is_threaded, nullptr);
  }
  return level;
}

MeshLevel MeshForContact(const TopoDS_Shape& shape, double diagonal, const MeshLevel& display,
                         const std::vector<bool>& is_analytic, const ImportOptions& options,
                         const std::string& name, Diagnostics* diagnostics) {
  const double wanted = std::max(options.min_deflection, options.relative_deflection * diagonal);
  TopTools_MapOfShape analytic;
  std::size_t index = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    if (is_analytic[index++]) {
      analytic.Add(it.Current());
    }
  }
  const Forecast forecast = MakeForecast(shape, analytic);
  const auto most = static_cast<double>(options.max_triangles);
  MeshLevel level{wanted, options.max_angle};
  while (forecast.Calc(display, level) > most && level.deflection < display.deflection) {
    level.deflection *= kCoarser;
  }
  if (forecast.Calc(display, level) > most) {
    level.angle = Coarsen(level).angle;
  }
  const bool is_threaded = options.threads != 1;
  std::size_t count = MeshOnce(shape, level, is_threaded, &analytic);
  for (int i = 0; i < kRetries && count > options.max_triangles; ++i) {
    level = Coarsen(level);
    count = MeshOnce(shape, level, is_threaded, &analytic);
  }
  if (count > options.max_triangles) {
    diagnostics->Warn("large-mesh", name, fmt::format("the mesh has {} triangles", count),
                      "simplify the part; contact with it will be slow");
  } else if (level.deflection > wanted) {
    diagnostics->Note("coarse-mesh", name,
                      fmt::format("meshed to {:.1f} um instead of {:.1f} um, with {} triangles",
                                  units::ToUm(level.deflection), units::ToUm(wanted), count));
  }
  return level;
}

void AppendTriangles(const TopoDS_Face& face, product::Mesh* mesh) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) source = BRep_Tool::Triangulation(face, location);
  if (source.IsNull()) {
    return;
  }
  const auto first = static_cast<std::uint32_t>(mesh->vertices.size());
  const gp_Trsf& transform = location.Transformation();
  for (int i = 1; i <= source->NbNodes(); ++i) {
    const gp_Pnt p = source->Node(i).Transformed(transform);
    mesh->vertices.emplace_back(units::FromMm(p.X()), units::FromMm(p.Y()), units::FromMm(p.Z()));
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
    const Vec3& p = mesh->vertices[triangle[0]];
    if ((mesh->vertices[triangle[1]] - p).cross(mesh->vertices[triangle[2]] - p).norm() > 0) {
      mesh->triangles.push_back(triangle);
    }
  }
}

std::vector<TopoDS_Face> MeshInPieces(const TopoDS_Face& face, const MeshLevel& level) {
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
    MeshOnce(divide.Result(), {coarser * level.deflection, level.angle}, /*is_threaded=*/false,
             nullptr, coarser > 1 ? 100 : 1);
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

}  // namespace hvas::cad
