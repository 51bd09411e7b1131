#include "product/edge_forms.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/units.h"
#include "product/prismatic_forms.h"

namespace hvas::product {
namespace {

// Rules of docs/algorithms/features.md, "Other forms": choices, set on public assemblies.
constexpr double kLargestFilletTurn = units::FromDeg(170);
constexpr double kLargestFillet = 0.15;                      // Radius, of the part's diagonal.
constexpr double kSameRadius = 0.01;                         // Relative.
constexpr double kLeastChamferAngle = units::FromDeg(20);    // Each of its two faces [rad].
constexpr double kLargestChamferAngle = units::FromDeg(70);  // [rad].
constexpr double kLeastEdgeAngle = units::FromDeg(60);       // Of the edge that was cut off.
constexpr double kLargestEdgeAngle = units::FromDeg(120);    // [rad].
constexpr double kNarrow = 0.35;                             // Width of a chamfer, of its length.
constexpr double kNarrowBeside = 0.5;                        // The same, of its neighbours' widths.
constexpr double kSameWidth = 0.1;                           // Relative.

/** A face of an edge form, with what it must share with the others of its form. */
struct Strip {
  FaceId face;
  double size{0};  // Radius, or width [m].
  double angle{0};
  bool is_outward{true};
};

/** Joins strips of one size that meet, or are on one cone; each group by its first strip. */
std::vector<std::vector<std::size_t>> GroupStrips(const std::vector<Strip>& strips,
                                                  const Part& part, const FaceAdjacency& adjacency,
                                                  double same_size) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);  // No strip.
  std::vector<std::size_t> strip_of_face(part.faces.size(), kNone);
  for (std::size_t i = 0; i < strips.size(); ++i) {
    strip_of_face[strips[i].face.index()] = i;
  }
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> is_seen(strips.size(), false);
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (is_seen[i]) {
      continue;
    }
    std::vector<std::size_t> group{i};
    is_seen[i] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      for (const FaceNeighbour& neighbour : adjacency.neighbours(strips[group[k]].face)) {
        const std::size_t other = strip_of_face[neighbour.face.index()];
        if (other != kNone && !is_seen[other] && strips[other].is_outward == strips[i].is_outward &&
            std::abs(strips[other].size - strips[i].size) <= same_size * strips[i].size) {
          is_seen[other] = true;
          group.push_back(other);
        }
      }
    }
    // The corners of a hexagon that was turned over are faces of one cone and do not meet.
    const Surface& surface = part.faces[strips[i].face.index()].surface;
    for (std::size_t other = i + 1; surface.kind == SurfaceKind::kCone && other < strips.size();
         ++other) {
      const Surface& cone = part.faces[strips[other].face.index()].surface;
      if (!is_seen[other] && cone.kind == SurfaceKind::kCone &&
          (cone.origin - surface.origin).norm() < same_size * strips[i].size &&
          (cone.axis - surface.axis).norm() < 1e-3 &&
          std::abs(cone.second - surface.second) < 1e-3) {
        is_seen[other] = true;
        group.push_back(other);
      }
    }
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

Form MakeForm(const Part& part, FormKind kind, const std::vector<Strip>& strips,
              const std::vector<std::size_t>& group) {
  Form form;
  form.kind = kind;
  Box box;
  for (const std::size_t i : group) {
    form.faces.push_back(strips[i].face);
    box.Add(part.faces[strips[i].face.index()].box_B);
  }
  form.origin_B = box.centre();
  form.axis_B = part.faces[form.faces.front().index()].surface.axis;
  return form;
}

double CalcPerimeter(const FaceAdjacency& adjacency, FaceId face) {
  double perimeter = 0;
  for (const FaceEdge& edge : adjacency.edges(face)) {
    perimeter += (edge.end - edge.start).norm();
  }
  return perimeter;
}

/** Whether a patch of one surface runs on tangentially into two faces or more, along more than a
 third of its border. */
bool RunsOn(const FaceAdjacency& adjacency, const std::vector<FaceId>& patch) {
  double border = 0;
  double tangent = 0;
  int count = 0;
  for (const FaceId face : patch) {
    for (const FaceNeighbour& neighbour : adjacency.neighbours(face)) {
      if (std::find(patch.begin(), patch.end(), neighbour.face) == patch.end()) {
        border += neighbour.length;
        tangent += neighbour.tangent;
        count += neighbour.tangent > 0.5 * neighbour.length ? 1 : 0;
      }
    }
  }
  return count >= 2 && 3 * tangent > border;
}

/** The chamfer that a face is, if any: two convex edges of nearly its whole length. */
std::optional<Strip> ReadChamfer(const Part& part, const FaceAdjacency& adjacency, FaceId face) {
  std::optional<FaceNeighbour> first;
  std::optional<FaceNeighbour> second;
  for (const FaceNeighbour& neighbour : adjacency.neighbours(face)) {
    if (!first || neighbour.length > first->length) {
      second = first;
      first = neighbour;
    } else if (!second || neighbour.length > second->length) {
      second = neighbour;
    }
  }
  if (!first || !second || second->length < 0.6 * first->length) {
    return std::nullopt;
  }
  const double area = part.faces[face.index()].area;
  const double length = 0.5 * (first->length + second->length);
  const double width = area / length;
  const double edge_angle = first->angle + second->angle;
  if (2 * length < 0.6 * CalcPerimeter(adjacency, face) || width > kNarrow * length ||
      edge_angle < kLeastEdgeAngle || edge_angle > kLargestEdgeAngle) {
    return std::nullopt;
  }
  for (const FaceNeighbour* side : {&*first, &*second}) {
    if (!side->Is(EdgeSense::kConvex) || side->angle < kLeastChamferAngle ||
        side->angle > kLargestChamferAngle ||
        width > kNarrowBeside * part.faces[side->face.index()].area / side->length) {
      return std::nullopt;
    }
  }
  return Strip{face, width, 2 * std::min(first->angle, second->angle), true};
}

}  // namespace

std::vector<Form> FindFillets(const Part& part, const FaceAdjacency& adjacency, const RingSet& set,
                              const std::vector<Ring>& partials, const std::vector<Form>& taken) {
  const std::vector<bool> is_taken = MarkFaces(part, taken);
  const double largest = kLargestFillet * part.box_B.size().norm();
  std::vector<Strip> strips;
  const auto add = [&](const Ring& ring, double radius) {
    const bool is_free = std::none_of(ring.faces.begin(), ring.faces.end(),
                                      [&](FaceId face) { return is_taken[face.index()]; });
    if (is_free && radius <= largest && RunsOn(adjacency, ring.faces)) {
      for (const FaceId face : ring.faces) {
        strips.push_back({face, radius, 0, ring.surface.outward > 0});
      }
    }
  };
  for (const Ring& ring : partials) {
    if (ring.turn <= kLargestFilletTurn) {
      add(ring, ring.radius());
    }
  }
  for (const Ring& ring : set.rings) {
    if (ring.kind == SurfaceKind::kTorus) {
      add(ring, ring.surface.second);
    }
  }
  // Corners: pieces of a sphere that run on into the fillets.
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    const Face& face = part.faces[f];
    if (face.surface.kind == SurfaceKind::kSphere && !is_taken[f] &&
        face.surface.radius <= largest && RunsOn(adjacency, {FaceId(f)})) {
      strips.push_back({FaceId(f), face.surface.radius, 0, face.surface.outward > 0});
    }
  }
  std::sort(strips.begin(), strips.end(),
            [](const Strip& a, const Strip& b) { return a.face < b.face; });
  std::vector<Form> forms;
  for (const auto& group : GroupStrips(strips, part, adjacency, kSameRadius)) {
    Form form = MakeForm(part, FormKind::kFillet, strips, group);
    form.diameter = 2 * strips[group.front()].size;
    forms.push_back(std::move(form));
  }
  return forms;
}

std::vector<Form> FindEdgeChamfers(const Part& part, const FaceAdjacency& adjacency,
                                   const std::vector<Form>& taken) {
  const std::vector<bool> is_taken = MarkFaces(part, taken);
  std::vector<Strip> strips;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    const SurfaceKind kind = part.faces[f].surface.kind;
    if (is_taken[f] || (kind != SurfaceKind::kPlane && kind != SurfaceKind::kCone)) {
      continue;
    }
    if (const auto strip = ReadChamfer(part, adjacency, FaceId(f))) {
      strips.push_back(*strip);
    }
  }
  std::vector<Form> forms;
  for (const auto& group : GroupStrips(strips, part, adjacency, kSameWidth)) {
    Form form = MakeForm(part, FormKind::kChamfer, strips, group);
    form.depth = strips[group.front()].size;
    form.angle = strips[group.front()].angle;
    forms.push_back(std::move(form));
  }
  return forms;
}

}  // namespace hvas::product
