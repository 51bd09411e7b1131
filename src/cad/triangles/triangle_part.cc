#include "cad/triangles/triangle_part.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "cad/triangles/segment.h"
#include "cad/triangles/shape_hash.h"
#include "product/features.h"

namespace hvas::cad {
namespace {

using product::Face;
using product::Part;

void AddFace(const WeldedMesh& mesh, const Segment& segment, const TriangleSoup& soup,
             std::vector<std::uint32_t>* number, Part* part) {
  Face face;
  face.surface = segment.surface;
  face.is_recognised = segment.surface.kind != spatial::SurfaceKind::kFreeform;
  face.residual = segment.residual;
  face.first_triangle = static_cast<std::uint32_t>(part->mesh.triangles.size());
  face.triangle_count = static_cast<std::uint32_t>(segment.triangles.size());
  face.first_display_triangle = face.first_triangle;
  face.display_triangle_count = face.triangle_count;
  if (segment.given < soup.faces.size()) {
    face.color = soup.faces[segment.given].color;
    face.entity = soup.faces[segment.given].entity;
  }
  const auto first = static_cast<std::uint32_t>(part->mesh.vertices.size());
  for (const std::uint32_t t : segment.triangles) {
    face.area += mesh.area[t];
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if ((*number)[v] == kNoTriangle || (*number)[v] < first) {
        (*number)[v] = static_cast<std::uint32_t>(part->mesh.vertices.size());
        part->mesh.vertices.push_back(mesh.vertices[v]);
        face.box_B.Add(mesh.vertices[v]);
      }
      triangle[k] = (*number)[v];
    }
    part->mesh.triangles.push_back(triangle);
  }
  part->box_B.Add(face.box_B);
  part->faces.push_back(face);
}

/** Volume, centroid and inertia of the closed shells: sums over tetrahedra from a point. */
void SetMass(const WeldedMesh& mesh, Part* part) {
  const Vec3 about = part->box_B.centre();
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!mesh.shells[mesh.shell[t]].is_closed) {
      continue;
    }
    const Vec3 a = mesh.vertices[mesh.triangles[t][0]] - about;
    const Vec3 b = mesh.vertices[mesh.triangles[t][1]] - about;
    const Vec3 c = mesh.vertices[mesh.triangles[t][2]] - about;
    const double piece = a.dot(b.cross(c)) / 6;
    const Vec3 sum = a + b + c;
    volume += piece;
    first += piece / 4 * sum;
    second += piece / 20 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  for (const MeshShell& shell : mesh.shells) {
    part->solid_count += shell.is_closed && shell.volume > 0 ? 1 : 0;
  }
  if (part->solid_count == 0 || !(volume > 0)) {
    part->solid_count = 0;
    return;
  }
  const Vec3 centre = first / volume;
  const Mat3 central = second - volume * centre * centre.transpose();
  const double density = part->material.density;
  part->mass.volume = volume;
  part->mass.mass = density * volume;
  part->mass.p_BoBcm_B = about + centre;
  part->mass.I_BBcm_B = density * (central.trace() * Mat3::Identity() - central);
}

void ReportDefects(const WeldedMesh& mesh, const Part& part, Diagnostics* diagnostics) {
  const MeshDefects& defects = mesh.defects;
  if (defects.unusable > 0) {
    diagnostics->Warn("damaged-mesh", part.name,
                      fmt::format("{} triangles have a corner that is not finite and are omitted",
                                  defects.unusable),
                      "export the mesh again");
  }
  if (defects.duplicate > 0) {
    diagnostics->Note("duplicate-triangles", part.name,
                      fmt::format("{} duplicate triangles are used once", defects.duplicate));
  }
  if (defects.flipped > 0 || defects.turned_shells > 0) {
    diagnostics->Note(
        "reversed-mesh", part.name,
        fmt::format("{} triangles and {} whole shells were inside out and were reversed",
                    defects.flipped, defects.turned_shells));
  }
  if (defects.has_unknown_cavities) {
    diagnostics->Warn(
        "limit-shells", part.name,
        fmt::format("the mesh has {} shells, which are too many to look for cavities: "
                    "all count as outer ones",
                    mesh.shells.size()),
        "export the bodies as parts of their own");
  }
  std::size_t open_shells = 0;
  for (const MeshShell& shell : mesh.shells) {
    open_shells += shell.is_closed ? 0U : 1U;
  }
  if (part.solid_count == 0) {
    diagnostics->Warn(
        "no-solid", part.name,
        fmt::format("this mesh is not closed ({} open edges), so it has no volume and no mass",
                    defects.open_edges),
        "repair the mesh, or export STEP");
  } else if (open_shells > 0) {
    diagnostics->Warn(
        "open-mesh", part.name,
        fmt::format("{} of {} pieces of this mesh are not closed, so they have no volume",
                    open_shells, mesh.shells.size()),
        "repair the mesh, or export STEP");
  }
  if (part.solid_count > 1) {
    diagnostics->Note("many-solids", part.name,
                      fmt::format("the mesh has {} separate bodies, which are treated as one part",
                                  part.solid_count));
  }
}

void ReportFit(const Part& part, Diagnostics* diagnostics) {
  double total = 0;
  double freeform = 0;
  double worst = 0;
  for (const Face& face : part.faces) {
    total += face.area;
    freeform += face.is_recognised ? 0 : face.area;
    worst = std::max(worst, face.residual);
  }
  diagnostics->Note(
      "fitted-mesh", part.name,
      fmt::format("the part has triangles only; {} faces were fitted to them with a deviation of "
                  "at most {:.3g} um, and {:.0f} % of the area is freeform",
                  part.faces.size(), units::ToUm(worst), 100 * freeform / total));
}

}  // namespace

bool BuildTrianglePart(const TriangleSoup& soup, Part* part, Diagnostics* diagnostics) {
  const WeldedMesh mesh = WeldMesh(soup);
  part->has_brep = false;
  if (mesh.triangles.empty()) {
    return false;
  }
  std::vector<std::uint32_t> given;
  if (soup.face.size() == soup.triangles.size()) {
    for (const std::uint32_t source : mesh.source) {
      given.push_back(soup.face[source]);
    }
  }
  std::vector<std::uint32_t> number(mesh.vertices.size(), kNoTriangle);
  for (const Segment& segment : SegmentMesh(mesh, given, soup.faces)) {
    AddFace(mesh, segment, soup, &number, part);
  }
  part->display_mesh = part->mesh;
  SetMass(mesh, part);
  ReportDefects(mesh, *part, diagnostics);
  ReportFit(*part, diagnostics);
  part->shape_hash = CalcShapeHash(*part);
  product::BuildFeatures(part, diagnostics);
  return true;
}

}  // namespace hvas::cad
