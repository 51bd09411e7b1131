#include "product/prismatic_forms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "base/units.h"
#include "product/axis_features.h"
#include "product/mesh_ray.h"

namespace hvas::product {

std::vector<bool> MarkFaces(const Part& part, const std::vector<Form>& forms) {
  std::vector<bool> is_marked(part.faces.size(), false);
  for (const Form& form : forms) {
    for (const FaceId face : form.faces) {
      is_marked[face.index()] = true;
    }
  }
  return is_marked;
}

namespace {

// Half a turn, with what is drawn inexactly (docs/algorithms/features.md, "Other forms"). Choices.
constexpr double kLeastHalfTurn = units::FromDeg(160);
constexpr double kLargestHalfTurn = units::FromDeg(200);
constexpr double kLeastSeat = 0.2;        // Of the largest plane's area.
constexpr std::size_t kMostSeats = 48;    // The largest planes; the others are fins and pads.
constexpr int kMostPockets = 500;         // Beyond that it is a mesh or a grille.
constexpr double kLeastChannel = 2;       // Length of a channel, in its widths.
constexpr double kShallowChannel = 0.25;  // Depth of a channel, in its widths.

struct Span {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  [[nodiscard]] double length() const { return high - low; }
};

/** Extent of a face along a direction, from a point. */
Span CalcSpan(const Part& part, FaceId id, const Vec3& origin, const Vec3& dir) {
  const Face& face = part.faces[id.index()];
  Span span;
  for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t) {
    for (const std::uint32_t v : part.mesh.triangles[t]) {
      const double z = (part.mesh.vertices[v] - origin).dot(dir);
      span.low = std::min(span.low, z);
      span.high = std::max(span.high, z);
    }
  }
  return span;
}

bool IsPlane(const Part& part, FaceId face) {
  return part.faces[face.index()].surface.kind == SurfaceKind::kPlane;
}

const Vec3& NormalOf(const Part& part, FaceId face) {
  return part.faces[face.index()].surface.axis;
}

bool IsFacing(const Part& part, FaceId a, FaceId b) {
  return IsParallel(NormalOf(part, a), NormalOf(part, b)) &&
         NormalOf(part, a).dot(NormalOf(part, b)) < 0;
}

bool Has(const std::vector<FaceId>& faces, FaceId face) {
  return std::find(faces.begin(), faces.end(), face) != faces.end();
}

/** The two flats that a half cylinder runs on into. */
std::optional<std::pair<FaceId, FaceId>> FindFlats(const Part& part, const FaceAdjacency& adjacency,
                                                   const Ring& arc) {
  std::set<FaceId> flats;
  for (const FaceId face : arc.faces) {
    for (const FaceNeighbour& neighbour : adjacency.neighbours(face)) {
      if (IsPlane(part, neighbour.face) && neighbour.tangent > 0.5 * neighbour.length) {
        flats.insert(neighbour.face);
      }
    }
  }
  if (flats.size() != 2) {
    return std::nullopt;
  }
  const auto flat = std::pair(*flats.begin(), *std::next(flats.begin()));
  return IsFacing(part, flat.first, flat.second) ? std::optional(flat) : std::nullopt;
}

/** Open or closed at an end, by most of its sectors. */
bool IsMostly(int count, const RingEnd& end) {
  return end.sectors > 0 && 10 * count > 6 * end.sectors;
}

/** A slot of one or two half cylinders that go down from their open end. */
std::optional<Form> MakeSlot(const Part& part, const std::vector<const Ring*>& arcs,
                             std::pair<FaceId, FaceId> flats) {
  const Ring& first = *arcs.front();
  const bool is_open_low = IsMostly(first.ends[0].convex, first.ends[0]);
  const bool is_open_high = IsMostly(first.ends[1].convex, first.ends[1]);
  if (!is_open_low && !is_open_high) {
    return std::nullopt;
  }
  Form form;
  form.kind = FormKind::kSlot;
  const std::size_t entry = is_open_high ? 1 : 0;
  form.axis_B = (entry == 1 ? -1.0 : 1.0) * first.axis_B;
  form.diameter = 2 * first.radius();
  form.depth = first.high - first.low;
  Vec3 middle = first.point(entry);
  for (const Ring* arc : arcs) {
    form.faces.insert(form.faces.end(), arc->faces.begin(), arc->faces.end());
  }
  if (arcs.size() == 2) {
    const Vec3 other = arcs[1]->origin_B;
    const Vec3 across = other - first.origin_B;
    middle += 0.5 * (across - across.dot(first.axis_B) * first.axis_B);
  } else {
    // A U: the middle between its round end and where its flats end.
    const Vec3 along = first.axis_B.cross(NormalOf(part, flats.first)).normalized();
    const Span span = CalcSpan(part, flats.first, middle, along);
    const double reach = std::abs(span.low) > std::abs(span.high) ? span.low : span.high;
    middle += 0.5 * (reach - std::copysign(first.radius(), reach)) * along;
  }
  form.origin_B = middle;
  form.faces.push_back(flats.first);
  form.faces.push_back(flats.second);
  const std::size_t bottom = 1 - entry;
  if (IsMostly(first.ends[bottom].concave, first.ends[bottom])) {
    for (const auto& [face, count] : first.ends[bottom].neighbours) {
      if (IsPlane(part, face) && !Has(form.faces, face)) {
        form.faces.push_back(face);
      }
    }
  }
  return form;
}

/** A channel: a floor with exactly two walls along it, which face each other; open at an end. */
std::optional<Form> MakeChannel(const Part& part, const FaceAdjacency& adjacency, FaceId floor) {
  std::vector<FaceId> walls;
  double open = 0;
  for (const FaceNeighbour& neighbour : adjacency.neighbours(floor)) {
    if (neighbour.Is(EdgeSense::kConvex)) {
      open += neighbour.length;
    } else if (neighbour.Is(EdgeSense::kConcave) && IsPlane(part, neighbour.face)) {
      walls.push_back(neighbour.face);
    } else {
      return std::nullopt;
    }
  }
  if (walls.size() != 2 || !IsFacing(part, walls[0], walls[1]) || open == 0 ||
      std::abs(NormalOf(part, floor).dot(NormalOf(part, walls[0]))) > 1e-3) {
    return std::nullopt;
  }
  const Vec3& across = NormalOf(part, walls[0]);
  const Vec3& up = NormalOf(part, floor);
  const Vec3 along = up.cross(across).normalized();
  const Vec3 centre = part.faces[floor.index()].box_B.centre();
  const Span width = CalcSpan(part, floor, centre, across);
  const Span length = CalcSpan(part, floor, centre, along);
  const double depth = std::min(CalcSpan(part, walls[0], centre, up).high,
                                CalcSpan(part, walls[1], centre, up).high) -
                       CalcSpan(part, floor, centre, up).high;
  const double rectangle = width.length() * length.length();
  if (part.faces[floor.index()].area < 0.9 * rectangle ||
      length.length() < kLeastChannel * width.length() ||
      depth < kShallowChannel * width.length()) {
    return std::nullopt;
  }
  Form form;
  form.kind = FormKind::kSlot;
  form.axis_B = -up;
  form.origin_B = centre + 0.5 * (width.low + width.high) * across +
                  0.5 * (length.low + length.high) * along + depth * up;
  form.diameter = width.length();
  form.depth = depth;
  form.faces = {walls[0], walls[1], floor};
  return form;
}

/** Whether an edge of a floor leads up a wall: an inner corner, or a fillet in it. */
bool IsWall(const std::vector<bool>& is_inner_round, const FaceNeighbour& neighbour) {
  return neighbour.Is(EdgeSense::kConcave) ||
         (neighbour.Is(EdgeSense::kTangent) && is_inner_round[neighbour.face.index()]);
}

/** Whether the space above a face is free, from a few of its triangles. */
bool IsClear(const Part& part, FaceId id, double reach) {
  const Face& face = part.faces[id.index()];
  constexpr std::uint32_t kRays = 5;  // Rays that look for what is in front: a choice.
  std::uint32_t blocked = 0;
  const std::uint32_t count = std::min(kRays, face.triangle_count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto& t =
        part.mesh.triangles[face.first_triangle + (2 * i + 1) * face.triangle_count / (2 * count)];
    const Vec3 p =
        (part.mesh.vertices[t[0]] + part.mesh.vertices[t[1]] + part.mesh.vertices[t[2]]) / 3;
    blocked += IsBlocked(part, p + 1e-7 * face.surface.axis, face.surface.axis, reach) ? 1 : 0;
  }
  return 2 * blocked < count;
}

/** The walls of a pocket: what its floor's border leads up, past fillets. */
std::optional<std::vector<FaceId>> FindWalls(const FaceAdjacency& adjacency, const RingSet& set,
                                             const std::vector<bool>& is_inner_round,
                                             FaceId floor) {
  std::vector<FaceId> walls;
  std::set<std::uint32_t> rings;
  bool is_round_only = true;
  for (const FaceNeighbour& neighbour : adjacency.neighbours(floor)) {
    const std::uint32_t ring = set.ring_of_face[neighbour.face.index()];
    const bool is_hole = ring != RingSet::kNone && set.rings[ring].is_inward;
    if (IsWall(is_inner_round, neighbour)) {
      walls.push_back(neighbour.face);
      is_round_only = is_round_only && ring != RingSet::kNone;
    } else if (!is_hole || !neighbour.Is(EdgeSense::kConvex)) {
      return std::nullopt;  // Open at this side.
    }
  }
  return walls.empty() || is_round_only ? std::nullopt : std::optional(walls);
}

}  // namespace

/** Adds the slots with round ends: two arcs between the same flats, or one that is open. */
void AddRoundSlots(const Part& part, const FaceAdjacency& adjacency,
                   const std::vector<Ring>& partials, double tolerance, std::vector<Form>* slots) {
  std::map<std::pair<FaceId, FaceId>, std::vector<const Ring*>> by_flats;
  for (const Ring& arc : partials) {
    if (arc.is_inward && arc.turn >= kLeastHalfTurn && arc.turn <= kLargestHalfTurn) {
      if (const auto flats = FindFlats(part, adjacency, arc)) {
        by_flats[*flats].push_back(&arc);
      }
    }
  }
  for (const auto& [flats, arcs] : by_flats) {
    const bool is_pair =
        arcs.size() == 2 && std::abs(arcs[0]->radius() - arcs[1]->radius()) < tolerance;
    if (arcs.size() == 1 || is_pair) {
      if (auto slot = MakeSlot(part, arcs, flats)) {
        slots->push_back(std::move(*slot));
      }
    }
  }
}

std::vector<Form> FindSlots(const Part& part, const FaceAdjacency& adjacency,
                            const std::vector<Ring>& partials, double tolerance) {
  std::vector<Form> slots;
  AddRoundSlots(part, adjacency, partials, tolerance, &slots);
  const std::vector<bool> is_taken = MarkFaces(part, slots);
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    if (!is_taken[f] && IsPlane(part, FaceId(f)) && part.faces[f].triangle_count > 0) {
      if (auto channel = MakeChannel(part, adjacency, FaceId(f))) {
        slots.push_back(std::move(*channel));
      }
    }
  }
  return slots;
}

/** Marks the faces of rounds that look inwards: bores and fillets. */
std::vector<bool> MarkInnerRounds(const Part& part, const std::vector<Ring>& rings,
                                  const std::vector<Ring>& partials) {
  std::vector<bool> is_inner_round(part.faces.size(), false);
  for (const std::vector<Ring>* list : {&rings, &partials}) {
    for (const Ring& ring : *list) {
      for (const FaceId face : ring.faces) {
        is_inner_round[face.index()] = ring.surface.outward < 0;
      }
    }
  }
  return is_inner_round;
}

/** How high a wall of a pocket goes; past a fillet the wall itself goes on. */
double CalcWallHeight(const Part& part, const FaceAdjacency& adjacency,
                      const std::vector<bool>& is_inner_round, FaceId wall, FaceId floor,
                      const Vec3& centre, const Vec3& up) {
  double height = CalcSpan(part, wall, centre, up).high;
  for (const FaceNeighbour& next : adjacency.neighbours(wall)) {
    if (is_inner_round[wall.index()] && next.face != floor && next.Is(EdgeSense::kTangent)) {
      height = std::max(height, CalcSpan(part, next.face, centre, up).high);
    }
  }
  return height;
}

Form MakePocket(const Part& part, const FaceAdjacency& adjacency,
                const std::vector<bool>& is_inner_round, FaceId floor,
                const std::vector<FaceId>& walls) {
  const Vec3& up = NormalOf(part, floor);
  const Vec3 centre = part.faces[floor.index()].box_B.centre();
  std::vector<double> heights;
  for (const FaceId wall : walls) {
    heights.push_back(CalcWallHeight(part, adjacency, is_inner_round, wall, floor, centre, up));
  }
  std::sort(heights.begin(), heights.end());
  Form form;
  form.kind = FormKind::kPocket;
  form.axis_B = -up;
  form.depth = heights[heights.size() / 2] - CalcSpan(part, floor, centre, up).high;
  form.origin_B = centre + form.depth * up;
  form.faces = walls;
  form.faces.push_back(floor);
  return form;
}

std::vector<Form> FindPockets(const Part& part, const FaceAdjacency& adjacency, const RingSet& set,
                              const std::vector<Ring>& partials, const std::vector<Form>& slots,
                              RecognitionLimits* limits) {
  const std::vector<bool> is_inner_round = MarkInnerRounds(part, set.rings, partials);
  const std::vector<bool> is_slot = MarkFaces(part, slots);
  const double reach = part.box_B.size().norm();
  std::vector<Form> pockets;
  int tried = 0;
  for (std::uint32_t f = 0; f < part.faces.size(); ++f) {
    const FaceId floor(f);
    if (is_slot[f] || !IsPlane(part, floor) || part.faces[f].triangle_count == 0) {
      continue;
    }
    const auto walls = FindWalls(adjacency, set, is_inner_round, floor);
    if (!walls || walls->size() < 2) {
      continue;
    }
    if (++tried > kMostPockets) {
      limits->Add("more than 500 pockets");
      break;
    }
    if (IsClear(part, floor, reach)) {
      pockets.push_back(MakePocket(part, adjacency, is_inner_round, floor, *walls));
    }
  }
  return pockets;
}

std::vector<Form> FindSeats(const Part& part, RecognitionLimits* limits) {
  std::vector<double> areas;
  for (const Feature& feature : part.features) {
    if (feature.kind == FeatureKind::kPlane) {
      areas.push_back(feature.area);
    }
  }
  std::sort(areas.rbegin(), areas.rend());
  if (areas.empty()) {
    return {};
  }
  if (areas.size() > kMostSeats && areas[kMostSeats] >= kLeastSeat * areas.front()) {
    limits->Add("more than 48 planes for seats");
  }
  const double least =
      std::max(kLeastSeat * areas.front(), areas.size() > kMostSeats ? areas[kMostSeats - 1] : 0.0);
  std::vector<Form> seats;
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    if (feature.kind != FeatureKind::kPlane || feature.area < least || seats.size() >= kMostSeats) {
      continue;
    }
    const FaceId face =
        *std::max_element(feature.faces.begin(), feature.faces.end(), [&part](FaceId a, FaceId b) {
          return part.faces[a.index()].area < part.faces[b.index()].area;
        });
    if (!IsClear(part, face, 0.5 * std::sqrt(feature.area))) {
      continue;
    }
    Form form;
    form.kind = FormKind::kSeat;
    form.features.emplace_back(i);
    form.faces = feature.faces;
    form.origin_B = feature.origin_B;
    form.axis_B = feature.axis_B;
    seats.push_back(std::move(form));
  }
  return seats;
}

}  // namespace hvas::product
