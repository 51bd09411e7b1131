#include "parts.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/file_cache.h"
#include "cad/brep/part_shape.h"
#include "contact/shape_cache.h"
#include "gear_pump_parts.h"

namespace hvas::bench {
namespace {

namespace pump = products::pump;
using products::Cut;
using products::Join;
using products::Move;
using products::Solid;
using products::Translation;

constexpr double kBore = 20.04;  // Of the pump's bushings, for journals of 20 [mm].

/** d 39.98, on z from its tip at 0: lead-in, ring groove, undercut and shoulder at 60, keyway. */
Solid DrawShaft() {
  constexpr double kRadius = 19.99;
  const Solid body = products::Turn({{0, 0},
                                     {kRadius - 1, 0},
                                     {kRadius, 1},
                                     {kRadius, 20},
                                     {kRadius - 1, 20},
                                     {kRadius - 1, 24},
                                     {kRadius, 24},
                                     {kRadius, 58},
                                     {kRadius - 0.5, 58},
                                     {kRadius - 0.5, 60},
                                     {26, 60},
                                     {26, 80},
                                     {0, 80}});
  const Solid slot = products::RoundEndedBar(24, 8, 15, 30);
  const gp_Trsf along = products::Frame(0, 0, 41, gp_Dir(0, 1, 0), gp_Dir(0, 0, 1));
  return Cut(body, Move(slot, along));
}

/** Bore of 40 on z from -50 to its mouth at 0: lead-in, oil groove, radial oil hole. */
Solid DrawBushing() {
  const Solid body = products::Turn({{20, -50},
                                     {28, -50},
                                     {28, 0},
                                     {21, 0},
                                     {20, -1},
                                     {20, -22},
                                     {21, -22},
                                     {21, -26},
                                     {20, -26}});
  const Solid hole = products::Cylinder(5, 15, 35);
  return Cut(body, Move(hole, products::Frame(0, 0, -12, gp_Dir(1, 0, 0), gp_Dir(0, 0, 1))));
}

Solid DrawPumpBushing() {
  return products::Tube(26, kBore, 0, 18, 0.5, 0.5);
}

Solid WithBushings(Solid body, double z) {
  for (const double side : {1.0, -1.0}) {
    body = Join(body, Move(DrawPumpBushing(), Translation(0, side * pump::kAxis, z)));
  }
  return body;
}

/** d 6 from z = 0 to 45, a ring every millimetre for the thread at the top. */
Solid DrawStud() {
  constexpr double kRadius = 3, kDepth = 0.4, kPitch = 1;
  std::vector<products::RadiusHeight> section{{0, 0}, {kRadius - 0.5, 0}, {kRadius, 0.5}};
  for (double z = 32; z < 44; z += kPitch) {
    section.push_back({kRadius, z});
    section.push_back({kRadius - kDepth, z + 0.4 * kPitch});
    section.push_back({kRadius, z + 0.8 * kPitch});
  }
  section.push_back({kRadius, 44.2});
  section.push_back({kRadius - 0.8, 45});
  section.push_back({0, 45});
  return products::Turn(section);
}

std::vector<BenchPart> DrawParts() {
  std::vector<BenchPart> parts(kPartCount);
  const auto set = [&](PartNumber number, const char* name, Solid solid) {
    parts[number].name = name;
    parts[number].solid = std::move(solid);
  };
  set(kShaft, "shaft", DrawShaft());
  set(kBushing, "bushing", DrawBushing());
  const Solid gasket = Move(pump::MakeGasket(), Translation(0, 0, pump::kFront));
  set(kHousing, "housing", Join(WithBushings(pump::MakeHousing(), 12), gasket));
  set(kDriveGear, "drive gear", pump::MakeDriveShaft());
  set(kDrivenGear, "driven gear", pump::MakeDrivenShaft());
  set(kCover, "cover", WithBushings(pump::MakeCover(), 0));
  set(kDowel, "dowel", products::Cylinder(5.98, 0, 24, 0.8, 0.8));
  set(kStud, "stud", DrawStud());
  set(kHub, "coupling hub", pump::MakeCouplingHub());
  set(kNippleBody, "hose nipple", pump::MakeHoseNipple());
  set(kSeal, "oil seal", pump::MakeOilSeal());
  return parts;
}

}  // namespace

Result<contact::ShapeSource> MeshSolid(const products::Solid& solid, double deflection) {
  cad::ImportOptions options;  // As the program itself meshes.
  if (deflection > 0) {
    options.relative_deflection = 0;
    options.min_deflection = deflection;
    options.max_angle = 0.5;
  }
  product::Part part;
  Diagnostics diagnostics;
  const auto level = cad::BuildPartShape(
      solid.shape, options, [](const TopoDS_Face&) { return std::nullopt; }, &part, &diagnostics);
  if (!level) {
    return Fail(ErrorCode::kInternal, "a part of the benchmark could not be meshed", "", "");
  }
  contact::ShapeSource source;
  source.vertices = std::move(part.mesh.vertices);
  source.triangles = std::move(part.mesh.triangles);
  source.triangle_face.resize(source.triangles.size());
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    source.faces.push_back(part.faces[f].surface);
    std::fill_n(source.triangle_face.begin() + part.faces[f].first_triangle,
                part.faces[f].triangle_count, static_cast<std::uint32_t>(f));
  }
  return source;
}

Result<std::vector<BenchPart>> MakeParts(const std::set<std::size_t>& wanted) {
  std::vector<BenchPart> parts = DrawParts();
  const auto directory = FileCache::DefaultDirectory();
  for (const std::size_t number : wanted) {
    BenchPart& part = parts[number];
    auto source = MeshSolid(part.solid, 0);
    if (!source) {
      return Unexpected(source.error());
    }
    part.source = std::move(*source);
    auto shape = directory ? contact::ShapeCache(*directory).LoadOrBuild(part.source, {})
                           : contact::Shape::Build(part.source, {});
    if (!shape) {
      return Unexpected(shape.error());
    }
    part.shape = *shape;
    std::cerr << fmt::format(
        "  {:13s} {:6d} triangles {:3d} faces, voxel {:.2f} mm, {:6d} points, {:5.1f} MB\n",
        part.name, part.source.triangles.size(), part.source.faces.size(),
        1e3 * part.shape->voxel(), part.shape->point_count(),
        1e-6 * static_cast<double>(part.shape->memory_bytes()));
  }
  return parts;
}

}  // namespace hvas::bench
