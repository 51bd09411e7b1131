#include "cad/brep/part_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeUpgrade_ShapeDivideAngle.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <fmt/format.h>

#include "base/units.h"
#include "cad/brep/mesh_context.h"

namespace hvas::cad {
namespace {

constexpr double kDisplayDeflection = 1e-3;     // Of the diagonal.
constexpr double kDisplayAngle = 0.35;          // [rad], 20 degrees: round to the eye. A choice.
constexpr double kCoarser = 4;                  // From one try to the next.
constexpr double kAngleInterior = 2;            // Of that of edges, as OpenCASCADE has it.
constexpr std::size_t kMostPieceNodes = 20000;  // Of one face that was cut: a choice.
constexpr int kRetries = 3;                     // 4^3: 64 times coarser, then it is refused.

/** What a try to mesh a shape may take. */
struct MeshEffort {
  bool is_threaded{false};
  std::size_t max_nodes{0};  // Inside freeform faces: a node more is two triangles more.
};

/** What came of one try to mesh a shape. */
struct Meshed {
  std::size_t count{0};          // Triangles.
  bool is_bound_reached{false};  // Some faces would have more.

  [[nodiscard]] bool IsOver(std::size_t max_triangles) const {
    return is_bound_reached || count > max_triangles;
  }
};

/** Meshes anew, several faces at a time unless there is to be one thread only; every face comes out
 as it would alone, but where the bound is reached. @param analytic  Null: no face is coarser inside
 than at its edges. */
Meshed MeshOnce(const TopoDS_Shape& shape, const MeshLevel& level, const MeshEffort& effort,
                const TopTools_MapOfShape* analytic, double interior_factor = 1) {
  BRepTools::Clean(shape);  // Else a finer mesh keeps what it can of the coarser one.
  BRepMesh_IncrementalMesh mesher;
  mesher.SetShape(shape);
  IMeshTools_Parameters& parameters = mesher.ChangeParameters();
  parameters.Deflection = units::ToMm(level.deflection);
  parameters.Angle = level.angle;
  parameters.InParallel = effort.is_threaded;
  if (interior_factor > 1) {
    parameters.DeflectionInterior = interior_factor * parameters.Deflection;
    parameters.AngleInterior = 1;
  }
  if (analytic != nullptr) {
    parameters.AngleInterior = kAngleInterior * parameters.Angle;
  }
  const opencascade::handle<MeshContext> context =
      new MeshContext(analytic, parameters.Deflection, effort.max_nodes);
  mesher.Perform(context);
  Meshed meshed;
  meshed.is_bound_reached = context->is_bound_reached();
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    TopLoc_Location location;
    const auto triangulation = BRep_Tool::Triangulation(TopoDS::Face(it.Current()), location);
    meshed.count +=
        triangulation.IsNull() ? 0U : static_cast<std::size_t>(triangulation->NbTriangles());
  }
  return meshed;
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

/** Meshes at a level, and coarser as long as that makes more triangles than there may be; `level`
 becomes that of the mesh. A try ends as soon as it is known to be in vain. The last one stays: it
 works at one face after the other, because which faces have got the nodes that there are must not
 depend on the threads. */
Meshed MeshWithin(const TopoDS_Shape& shape, std::size_t max_triangles,
                  const ImportOptions& options, const TopTools_MapOfShape* analytic,
                  MeshLevel* level) {
  MeshEffort effort{options.threads != 1, max_triangles / 2};
  Meshed meshed = MeshOnce(shape, *level, effort, analytic);
  for (int i = 0; i < kRetries && meshed.IsOver(max_triangles); ++i) {
    *level = Coarsen(*level);
    effort.is_threaded = effort.is_threaded && i + 1 < kRetries;
    meshed = MeshOnce(shape, *level, effort, analytic);
  }
  return meshed;
}

}  // namespace

bool IsMeshed(const TopoDS_Face& face) {
  TopLoc_Location location;
  return !BRep_Tool::Triangulation(face, location).IsNull();
}

MeshLevel MeshForDisplay(const TopoDS_Shape& shape, double diagonal, const ImportOptions& options) {
  MeshLevel level{std::max(options.min_deflection, kDisplayDeflection * diagonal), kDisplayAngle};
  MeshWithin(shape, options.max_triangles / 2, options, nullptr, &level);
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
  const Meshed meshed = MeshWithin(shape, options.max_triangles, options, &analytic, &level);
  const std::size_t count = meshed.count;
  if (meshed.IsOver(options.max_triangles)) {
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
  constexpr MeshEffort kPieceEffort{/*is_threaded=*/false, kMostPieceNodes};
  for (const auto& [cut_deg, coarser] : kWays) {
    // A copy does not know how the neighbours divided their edges; the way out when that is the
    // snag.
    const TopoDS_Shape source = coarser > 1 ? BRepBuilderAPI_Copy(face).Shape() : face;
    ShapeUpgrade_ShapeDivideAngle divide(units::FromDeg(cut_deg), source);
    divide.Perform();
    MeshOnce(divide.Result(), {coarser * level.deflection, level.angle}, kPieceEffort, nullptr,
             coarser > 1 ? 100 : 1);
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
