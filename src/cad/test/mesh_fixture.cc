#include "cad/test/mesh_fixture.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "base/units.h"

namespace hvas::cad::testing {

void AddArc(const ProfilePoint& centre, double radius, double from, double to, int steps,
            std::vector<ProfilePoint>* profile) {
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    profile->push_back({centre.r + radius * std::cos(angle), centre.z + radius * std::sin(angle)});
  }
}

TriangleSoup Revolve(const std::vector<ProfilePoint>& profile, int segments, bool is_loop) {
  TriangleSoup soup;
  const auto ring = static_cast<std::uint32_t>(segments);
  for (const ProfilePoint& point : profile) {
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      const double r = point.r < 1e-12 ? 0 : point.r;
      soup.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), point.z);
    }
  }
  const std::size_t strips = profile.size() - (is_loop ? 0 : 1);
  for (std::size_t k = 0; k < strips; ++k) {
    const auto low = static_cast<std::uint32_t>(k) * ring;
    const auto high = static_cast<std::uint32_t>((k + 1) % profile.size()) * ring;
    for (std::uint32_t i = 0; i < ring; ++i) {
      const std::uint32_t j = (i + 1) % ring;
      soup.triangles.push_back({low + i, low + j, high + j});
      soup.triangles.push_back({low + i, high + j, high + i});
    }
  }
  return soup;
}

TriangleSoup MakeBox(const Vec3& size) {
  TriangleSoup soup;
  for (int i = 0; i < 8; ++i) {
    soup.vertices.emplace_back((i & 1) != 0 ? size.x() : 0, (i & 2) != 0 ? size.y() : 0,
                               (i & 4) != 0 ? size.z() : 0);
  }
  soup.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return soup;
}

TriangleSoup MeshOf(const TopoDS_Shape& shape, double deflection_mm, double angle) {
  const BRepMesh_IncrementalMesh mesh(shape, deflection_mm, false, angle);
  TriangleSoup soup;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    TopLoc_Location location;
    const Handle(Poly_Triangulation) source = BRep_Tool::Triangulation(face, location);
    for (int i = 1; i <= source->NbTriangles(); ++i) {
      std::array<int, 3> node{};
      source->Triangle(i).Get(node[0], node[1], node[2]);
      if (face.Orientation() == TopAbs_REVERSED) {
        std::swap(node[1], node[2]);
      }
      const auto first = static_cast<std::uint32_t>(soup.vertices.size());
      for (const int n : node) {
        const gp_Pnt p = source->Node(n).Transformed(location.Transformation());
        soup.vertices.emplace_back(units::FromMm(p.X()), units::FromMm(p.Y()),
                                   units::FromMm(p.Z()));
      }
      soup.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return soup;
}

void Append(const TriangleSoup& other, TriangleSoup* soup) {
  const auto first = static_cast<std::uint32_t>(soup->vertices.size());
  soup->vertices.insert(soup->vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles) {
    soup->triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

void Move(const spatial::Pose& X_AB, TriangleSoup* soup) {
  for (Vec3& v : soup->vertices) {
    v = X_AB * v;
  }
}

void RoundToFloat(TriangleSoup* soup) {
  for (Vec3& v : soup->vertices) {
    for (int k = 0; k < 3; ++k) {
      v[k] = units::FromMm(static_cast<double>(static_cast<float>(units::ToMm(v[k]))));
    }
  }
}

void Shake(double deviation, Random* random, TriangleSoup* soup) {
  for (Vec3& v : soup->vertices) {
    const double x = random->Normal();
    const double y = random->Normal();
    const double z = random->Normal();
    v += deviation * Vec3(x, y, z);
  }
}

TriangleSoup Subdivide(const TriangleSoup& soup) {
  TriangleSoup finer;
  finer.vertices = soup.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.vertices.size()));
    if (is_new) {
      finer.vertices.push_back(0.5 * (soup.vertices[a] + soup.vertices[b]));
    }
    return at->second;
  };
  for (const Triangle& t : soup.triangles) {
    const std::uint32_t ab = middle(t[0], t[1]);
    const std::uint32_t bc = middle(t[1], t[2]);
    const std::uint32_t ca = middle(t[2], t[0]);
    finer.triangles.insert(finer.triangles.end(),
                           {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace hvas::cad::testing
