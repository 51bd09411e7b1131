#include "contact/block_build.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace hvas::contact {
namespace {

// The n-th point of a grid with so many points a side, x first.
Vec3 GridPoint(int n, int side) {
  const int x = n % side;
  const int y = n / side % side;
  const int z = n / (side * side);
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

// A face stays listed where it is this much further away than the closest one, so that it is found
// when that one is ignored or when the part as made differs from the drawing.
constexpr double kFaceMarginVoxels = 0.25;
constexpr double kLeastFaceMargin = 100e-6;  // [m]

const double kOctantRadius =
    4 * kHalfDiagonal;  // Of the ball around an octant of a block, in voxels.

constexpr double kDeepestContact = 200e-6;  // [m]: the depth of exact zones (contact.md, "Zones").

Vec3 Corner(int i) {
  return {(i & 1) * 2.0 - 1, ((i >> 1) & 1) * 2.0 - 1, (i >> 2) * 2.0 - 1};
}

// The distinct faces of a list, none when there are more than `most`.
template <std::size_t most>
struct FewFaces {
  std::array<std::uint32_t, most> faces{};
  std::size_t count{0};

  FewFaces(const Mesh& mesh, const NearList& list) {
    for (const NearTriangle& entry : list) {
      const std::uint32_t face = mesh.face[entry.triangle];
      if (IndexOf(face) < count) {
        continue;
      }
      if (count == most) {
        count = 0;
        return;
      }
      faces[count++] = face;
    }
  }

  [[nodiscard]] std::size_t IndexOf(std::uint32_t face) const {
    return static_cast<std::size_t>(
        std::find(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(count), face) -
        faces.begin());
  }
};

constexpr std::size_t kMostFaces = 12;  // A screen compares so many: a choice.

// The distance from a surface in single precision has a gradient everywhere but on an axis.
bool HasFormWithin(const spatial::Surface& surface, const Vec3& centre, double radius) {
  constexpr double kOffAxis = 100e-6;  // [m]: the margin of faces listed (contact.md). A choice.
  if (MakeFaceForm(surface).kind == FaceForm::Kind::kNone) {
    return false;
  }
  const Vec3 r = centre - surface.origin;
  return surface.kind == spatial::SurfaceKind::kPlane ||
         r.cross(surface.axis).norm() > radius + kOffAxis;
}

bool IsOneFace(const Mesh& mesh, const NearList& list) {
  const std::uint32_t face = mesh.face[list.front().triangle];
  return std::all_of(list.begin(), list.end(),
                     [&](const NearTriangle& n) { return mesh.face[n.triangle] == face; });
}

}  // namespace

double CalcExactDepth(double voxel) {
  return std::clamp(kDeepestContact, voxel, 2 * voxel);
}

double CalcBlockReach(double voxel) {
  return std::max(CalcExactDepth(voxel), 1.5 * voxel);
}

BlockBuilder::BlockBuilder(const Shape::Data& data, const NearSearch& search)
    : data_(data),
      search_(search),
      h_(data.voxel),
      quantum_(kBandVoxels * data.voxel / 32767),
      exact_depth_(CalcExactDepth(data.voxel)),
      block_reach_(CalcBlockReach(data.voxel)),
      face_margin_(std::max(kFaceMarginVoxels * data.voxel, kLeastFaceMargin)) {
  for (const double deviation : data.exact.deviation) {
    most_deviation_ = std::max(most_deviation_, 2 * deviation + 1e-9);
  }
}

Vec3 BlockBuilder::CentreOf(const Index3& zone) const {
  return block_->origin + h_ * (2.0 * Vec3(zone[0], zone[1], zone[2]) + Vec3::Ones());
}

Zone* BlockBuilder::ZoneOf(const Index3& zone) const {
  return &block_->zones[static_cast<std::size_t>(zone[2] * 16 + zone[1] * 4 + zone[0])];
}

void BlockBuilder::Build(const NearSet& near, Block* block) {
  block_ = block;
  hint_ = near.list.front().triangle;
  const Vec3 middle = block->origin + Vec3::Constant(4 * h_);
  if (!TryExact(near.list, middle, 4 * h_, {0, 0, 0}, 4)) {
    search_.FilterOctants(near, middle - Vec3::Constant(2 * h_), middle + Vec3::Constant(2 * h_),
                          kOctantRadius * h_, 0xff, &begun_, &octants_);
    if (IsFar(middle)) {
      return;
    }
    for (int o = 0; o < 8; ++o) {
      BuildOctant({2 * (o & 1), 2 * ((o >> 1) & 1), 2 * (o >> 2)},
                  &octants_[static_cast<std::size_t>(o)]);
    }
  }
  block->face = block->is_near ? FindOnlyFace() : kNoFace;
}

// Many blocks that a ball around them says nothing about are found to be too far away by balls
// around their octants. The side of such a block is that of its last zone, where it is clear: at a
// gap of the mesh, or where faces coincide, it is not.
bool BlockBuilder::IsFar(const Vec3& middle) {
  if (!data_.mesh.is_closed) {
    return false;
  }
  const auto is_octant_far = [&](std::size_t o) {
    const Vec3 centre = middle + 2 * h_ * Corner(static_cast<int>(o));
    const NearSet& octant = octants_[o];
    return search_.Find(octant.list, centre, 0, octant.least.triangle).distance >
           (block_reach_ + kOctantRadius * h_) * kSlack + most_deviation_;
  };
  const auto nearest = std::min_element(
      octants_.begin(), octants_.end(),
      [](const NearSet& a, const NearSet& b) { return a.least.distance < b.least.distance; });
  if (!is_octant_far(static_cast<std::size_t>(nearest - octants_.begin()))) {
    return false;
  }
  for (std::size_t o = 0; o < octants_.size(); ++o) {
    if (!is_octant_far(o)) {
      return false;
    }
  }
  const auto side_at = [&](double from_middle) {
    const Vec3 p = middle + Vec3::Constant(from_middle * h_);
    return search_.FindSide(octants_[7].list, p, NearSearch::kAnywhere, octants_[7].least.triangle);
  };
  const std::optional<bool> side = side_at(3);  // In the middle of the last zone.
  if (!side || side != side_at(4)) {
    return false;
  }
  block_->is_inside = *side;
  return true;
}

// The face that gives all distances of the block as they are, where there is one.
std::uint32_t BlockBuilder::FindOnlyFace() const {
  const std::uint32_t face = block_->zones[0].code & zone::kPayload;
  for (const Zone& zone : block_->zones) {
    const std::uint32_t kind = zone.code & ~zone::kPayload;
    if ((kind != zone::kExact && kind != zone::kFar) || (zone.code & zone::kPayload) != face) {
      return kNoFace;
    }
  }
  const spatial::Surface& surface = data_.exact.faces[face];
  if (!HasFormWithin(surface, block_->origin + Vec3::Constant(4 * h_), 8 * kHalfDiagonal * h_)) {
    return kNoFace;
  }
  for (int n = 0; n < kBlockNodes; ++n) {
    const Vec3 p = block_->origin + h_ * GridPoint(n, 9);
    const auto exact = spatial::CalcDistance(surface, p);
    const int stored = block_->nodes[static_cast<std::size_t>(n)];
    if (!exact.is_valid || std::abs(stored - ToUnits(exact.distance)) > 1) {
      return kNoFace;
    }
  }
  return face;
}

std::int16_t BlockBuilder::ToUnits(double phi) const {
  // Adding this leaves no digit below one: rounded as a double is, to even. std::lrint is a call.
  constexpr double kRounder = 0x1.8p52;
  const double units = std::clamp(phi / quantum_, -32767.0, 32767.0);
  return static_cast<std::int16_t>((units + kRounder) - kRounder);
}

void BlockBuilder::BuildOctant(const Index3& low, NearSet* octant) {
  const Vec3 centre = CentreOf(low) + Vec3::Constant(h_);
  const double distance = FindDistance(octant->list, centre, 0);
  DropFarFaces(centre, 2 * h_, distance, &octant->list);
  if (TryExact(octant->list, centre, 2 * h_, low, 2)) {
    return;
  }
  octant->least = LeastOf(octant->list);
  search_.BeginOctants(*octant, CentreOf(low), CentreOf({low[0] + 1, low[1] + 1, low[2] + 1}),
                       2 * kHalfDiagonal * h_, 0xff, &begun_);
  for (int z = 0; z < 8; ++z) {
    BuildZone({low[0] + (z & 1), low[1] + ((z >> 1) & 1), low[2] + (z >> 2)},
              begun_[static_cast<std::size_t>(z)]);
  }
}

void BlockBuilder::BuildZone(const Index3& zone, const BegunFilter& begun) {
  const Vec3 centre = CentreOf(zone);
  const double radius = 2 * kHalfDiagonal * h_;
  const Nearest nearest = search_.FindSignedInBoxed(begun, centre);
  hint_ = nearest.triangle;
  const double distance = std::abs(nearest.distance);
  if (distance > kBandVoxels * h_ * kSlack + radius) {
    FillFarZone(zone, nearest.distance);
    return;
  }
  NearList* list = &zone_.list;
  if (distance <= exact_depth_ + radius) {
    search_.End(centre, radius, begun, &zone_);
    DropFarFaces(centre, h_, distance, list);
    if (TryExact(*list, centre, h_, zone, 1)) {
      return;
    }
    DecideZone(centre, *list, ZoneOf(zone));
  } else {
    ZoneOf(zone)->code = zone::kFar | data_.mesh.face[hint_];
  }
  FillNodes(zone, begun.list);
}

// Where one analytic face alone can be closest in a cube of zones, its surface gives all distances:
// the closest point lies inside the face, as at its rim another face would be as close.
bool BlockBuilder::TryExact(const NearList& list, const Vec3& centre, double half,
                            const Index3& low, int zones) {
  const std::uint32_t face = data_.mesh.face[list.front().triangle];
  const spatial::Surface& surface = data_.exact.faces[face];
  if (surface.kind == spatial::SurfaceKind::kFreeform || !IsOneFace(data_.mesh, list) ||
      !AgreesWithFace(list, centre, half)) {
    return false;
  }
  const double reach = exact_depth_ + 2 * kHalfDiagonal * h_;
  for (int z = 0; z < zones * zones * zones; ++z) {
    const Index3 zone{low[0] + z % zones, low[1] + z / zones % zones, low[2] + z / zones / zones};
    const double distance = spatial::CalcDistance(surface, CentreOf(zone)).distance;
    ZoneOf(zone)->code = (std::abs(distance) > reach ? zone::kFar : zone::kExact) | face;
  }
  for (int k = 2 * low[2]; k <= 2 * (low[2] + zones); ++k) {
    for (int j = 2 * low[1]; j <= 2 * (low[1] + zones); ++j) {
      for (int i = 2 * low[0]; i <= 2 * (low[0] + zones); ++i) {
        const Vec3 p = block_->origin + h_ * Vec3(i, j, k);
        const auto exact = spatial::CalcDistance(surface, p);
        SetNode(i, j, k,
                exact.is_valid
                    ? exact.distance
                    : search_.FindSigned(list, p, NearSearch::kAnywhere, hint_).distance);
      }
    }
  }
  return true;
}

// The unbounded surface may come closer than the face does, on the far side of an axis.
bool BlockBuilder::AgreesWithFace(const NearList& list, const Vec3& centre, double half) {
  const std::uint32_t face = data_.mesh.face[list.front().triangle];
  const double tolerance = 2 * data_.exact.deviation[face] + 1e-9;
  for (int i = 0; i < 9; ++i) {
    const Vec3 p = i < 8 ? Vec3(centre + half * Corner(i)) : centre;
    const auto exact = spatial::CalcDistance(data_.exact.faces[face], p);
    if (!exact.is_valid) {
      return false;
    }
    const Nearest nearest = search_.FindSigned(list, p, (p - centre).norm(), hint_);
    hint_ = nearest.triangle;
    if (std::abs(exact.distance - nearest.distance) > tolerance) {
      return false;
    }
  }
  return true;
}

// The distance of the closest triangle of a list.
double BlockBuilder::FindDistance(const NearList& list, const Vec3& p, double offset) {
  const Nearest nearest = search_.Find(list, p, offset, hint_);
  hint_ = nearest.triangle;
  return nearest.distance;
}

struct BlockBuilder::OctantFaces {
  std::span<const std::uint32_t> faces;
  std::array<Vec3, 8> centres;
  std::array<std::array<double, kMostFaces>, 8> away{};  // The faces' least distances.
  std::array<bool, kMostFaces> is_near{};
  std::size_t near{0};  // How many are.

  [[nodiscard]] bool are_all_near() const { return near == faces.size(); }

  void Mark(std::size_t f, bool is) {
    is_near[f] = is;
    near += is ? 1 : 0;
  }
};

double BlockBuilder::CalcLimit(double from_mesh, double radius) const {
  return (from_mesh + 2 * radius) * kSlack + face_margin_;
}

// Measures how far the faces are from the octants' centres, and marks those that are near for sure.
void BlockBuilder::MeasureFaces(double limit, OctantFaces* faces) const {
  for (std::size_t o = 0; o < 8 && !faces->are_all_near(); ++o) {
    for (std::size_t f = 0; f < faces->faces.size(); ++f) {
      if (faces->is_near[f]) {
        continue;
      }
      const std::uint32_t face = faces->faces[f];
      const auto exact = spatial::CalcDistance(data_.exact.faces[face], faces->centres[o]);
      const double away = std::abs(exact.distance) - data_.exact.deviation[face];
      faces->away[o][f] = away;
      faces->Mark(f, !exact.is_valid || away <= limit);
    }
  }
}

// Takes out the faces that nowhere in the cube are the closest, nor nearly so. A ball around the
// whole cube says little; in each of its octants a face's unbounded surface tells how near the face
// can be. How far the mesh is from an octant's centre is looked for only where the bounds that
// follow from its `distance` from the cube's centre do not decide.
void BlockBuilder::DropFarFaces(const Vec3& centre, double half, double distance, NearList* list) {
  const FewFaces<kMostFaces> few(data_.mesh, *list);
  if (few.count < 2) {
    return;
  }
  const double radius = kHalfDiagonal * half;
  const double offset = radius * kSlack;  // Of the octants' centres.
  const Bounds limit{CalcLimit(std::max(0.0, distance - offset), radius),
                     CalcLimit(distance + offset, radius)};
  OctantFaces faces{std::span(few.faces).first(few.count), {}};
  for (std::size_t o = 0; o < 8; ++o) {
    faces.centres[o] = centre + 0.5 * half * Corner(static_cast<int>(o));
  }
  MeasureFaces(limit.low, &faces);
  for (std::size_t o = 0; o < 8 && !faces.are_all_near(); ++o) {
    double exact_limit = -1;
    for (std::size_t f = 0; f < few.count; ++f) {
      if (faces.is_near[f] || faces.away[o][f] > limit.high) {
        continue;
      }
      if (exact_limit < 0) {
        exact_limit = CalcLimit(FindDistance(*list, faces.centres[o], offset), radius);
      }
      faces.Mark(f, faces.away[o][f] <= exact_limit);
    }
  }
  if (faces.are_all_near()) {
    return;
  }
  const auto is_far = [&](const NearTriangle& entry) {
    return !faces.is_near[few.IndexOf(data_.mesh.face[entry.triangle])];
  };
  list->erase(std::remove_if(list->begin(), list->end(), is_far), list->end());
}

// Takes out the triangles that a look from the zone's centre tells not to be the closest of their
// face to any point of it, and gives the others their distances from there and their points_.
void BlockBuilder::DropHidden(const Vec3& centre, std::size_t faces, NearList* list) {
  const double radius = 2 * kHalfDiagonal * h_;
  points_.clear();
  std::array<double, kMostFaces> limit{};
  limit.fill(std::numeric_limits<double>::infinity());
  NearSearch::EightTriangles eight(search_, centre);
  for (std::size_t i = 0; i < list->size(); i += NearSearch::EightTriangles::kMost) {
    eight.Clear();
    for (std::size_t k = i; k < std::min(i + eight.kMost, list->size()); ++k) {
      eight.Add((*list)[k].triangle);
    }
    eight.Calc();
    for (int k = 0; k < eight.count(); ++k) {
      const std::size_t at = i + static_cast<std::size_t>(k);
      points_.push_back(eight.PointOf(k));
      (*list)[at].distance = std::sqrt(eight.squared(k));
      double& face_least = limit[face_numbers_[at]];
      face_least = std::min(face_least, (*list)[at].distance);
    }
  }
  for (std::size_t f = 0; f < faces; ++f) {
    limit[f] = (limit[f] + 2 * radius) * kSlack;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const NearTriangle entry = (*list)[i];
    const double most = limit[face_numbers_[i]];
    if (search_.CalcLeastLimit(entry.triangle, points_[i], centre, radius, most) <= most) {
      points_[kept] = points_[i];
      face_numbers_[kept] = face_numbers_[i];
      (*list)[kept++] = entry;
    }
  }
  list->resize(kept);
}

struct BlockBuilder::Cubes {
  // Two in each direction. With three, lists are 2 % shorter and take twice as long.
  static constexpr std::size_t kCount = 8;

  std::array<Vec3, kCount> centres;
  double radius{0};  // Of a ball around each.
  double offset{0};  // Of their centres from the zone's.
  std::array<double, kMostFaces>
      first{};  // The least distance of each face from the zone's centre.
  // The distance of each face from each cube's centre, once it is needed; before, less than zero.
  std::array<std::array<double, kMostFaces>, kCount> least{};

  Cubes(const Vec3& centre, double h) : radius(2 * kHalfDiagonal * h / 2) {
    for (std::size_t o = 0; o < kCount; ++o) {
      centres[o] = centre + 0.5 * h * Corner(static_cast<int>(o));
      least[o].fill(-1);
    }
    offset = (centres[0] - centre).norm();
    first.fill(std::numeric_limits<double>::infinity());
  }
};

// Lists what is left, with the side of the zone that its closest point is on.
void BlockBuilder::CollectCandidates(const Vec3& centre, const NearList& list, Cubes* cubes) {
  candidates_.clear();
  for (std::size_t i = 0; i < list.size(); ++i) {
    const NearTriangle& entry = list[i];
    const std::size_t face = face_numbers_[i];
    const Vec3 way = points_[i].q - centre;
    const unsigned side =
        (way.x() > 0 ? 1U : 0U) | (way.y() > 0 ? 2U : 0U) | (way.z() > 0 ? 4U : 0U);
    candidates_.push_back({entry, face, side});
    cubes->first[face] = std::min(cubes->first[face], entry.distance);
  }
}

// Finds the candidates' points closest to the cube on their own side: what may be the closest is so
// most often there.
void BlockBuilder::FindPointsOnSide(const Cubes& cubes) {
  NearSearch::EightTriangles eight(search_);
  for (std::size_t i = 0; i < candidates_.size(); i += NearSearch::EightTriangles::kMost) {
    eight.Clear();
    for (std::size_t k = i; k < std::min(i + eight.kMost, candidates_.size()); ++k) {
      eight.Add(candidates_[k].entry.triangle, cubes.centres[candidates_[k].side]);
    }
    eight.Calc();
    for (int k = 0; k < eight.count(); ++k) {
      points_[i + static_cast<std::size_t>(k)] = eight.PointOf(k);
    }
  }
}

bool BlockBuilder::MayBeClosestInCubes(std::size_t i, Cubes* cubes) const {
  const Candidate& candidate = candidates_[i];
  const double from_centre = cubes->first[candidate.face];
  const Bounds bounds{std::max(0.0, from_centre - cubes->offset), from_centre + cubes->offset};
  for (const unsigned turn : {0U, 1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
    const std::size_t o = candidate.side ^ turn;
    const Vec3& c = cubes->centres[o];
    double* const face_least = &cubes->least[o][candidate.face];
    const double most = (*face_least < 0 ? bounds.high : *face_least) + 2 * cubes->radius;
    if (turn != 0 && !search_.MayReach(candidate.entry.triangle, c, most * kSlack)) {
      continue;
    }
    const TrianglePoint point =
        turn == 0 ? points_[i] : search_.ClosestOn(candidate.entry.triangle, c);
    if (MayBeClosest(candidate, point, c, cubes->radius, bounds, face_least)) {
      return true;
    }
  }
  return false;
}

// Of each face, keeps the triangles that may be its closest somewhere in the zone, with their
// distances from its centre, nearest first. Cubes of half the zone are looked at one by one.
void BlockBuilder::KeepClosest(const Vec3& centre, NearList* list) {
  const Mesh& mesh = data_.mesh;
  const FewFaces<kMostFaces> few(mesh, *list);
  if (few.count == 0 || list->size() <= few.count) {
    for (NearTriangle& entry : *list) {
      entry.distance = (search_.ClosestOn(entry.triangle, centre).q - centre).norm();
    }
    std::sort(list->begin(), list->end(), IsNearer());
    return;
  }
  face_numbers_.clear();
  for (const NearTriangle& entry : *list) {
    face_numbers_.push_back(few.IndexOf(mesh.face[entry.triangle]));
  }
  DropHidden(centre, few.count, list);
  Cubes cubes(centre, h_);
  CollectCandidates(centre, *list, &cubes);
  FindPointsOnSide(cubes);
  list->clear();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (MayBeClosestInCubes(i, &cubes)) {
      list->push_back(candidates_[i].entry);
    }
  }
  std::sort(list->begin(), list->end(), IsNearer());
}

// Whether a candidate, with its point closest to a ball's centre, may be the closest of its face to
// some point of the ball. How far the face is from the centre is looked for only where its bounds
// do not decide.
bool BlockBuilder::MayBeClosest(const Candidate& candidate, const TrianglePoint& point,
                                const Vec3& c, double radius, const Bounds& bounds,
                                double* least) const {
  const auto limit_of = [radius](double distance) { return (distance + 2 * radius) * kSlack; };
  const double most = limit_of(*least < 0 ? bounds.high : *least);
  const double needed = search_.CalcLeastLimit(candidate.entry.triangle, point, c, radius, most);
  if (needed > most) {
    return false;
  }
  if (*least >= 0 || needed <= limit_of(bounds.low)) {
    return true;
  }
  *least = (point.q - c).norm();
  for (const Candidate& other : candidates_) {
    if (other.face == candidate.face && search_.MayReach(other.entry.triangle, c, *least)) {
      *least = std::min(*least, (search_.ClosestOn(other.entry.triangle, c).q - c).norm());
    }
  }
  return needed <= limit_of(*least);
}

void BlockBuilder::DecideZone(const Vec3& centre, const NearList& list, Zone* out) {
  if (IsSmooth(list)) {
    out->code = zone::kSmooth | hint_;
    return;
  }
  kept_ = list;
  KeepClosest(centre, &kept_);
  NearList& listed = block_->listed;
  out->code = zone::kList;
  out->begin = static_cast<std::uint32_t>(listed.size());
  listed.insert(listed.end(), kept_.begin(), kept_.end());
  out->end = static_cast<std::uint32_t>(listed.size());
}

// Freeform faces that go over into each other without an edge: one of their triangles leads to all.
bool BlockBuilder::IsSmooth(const NearList& list) const {
  return std::all_of(list.begin(), list.end(), [&](const NearTriangle& entry) {
    const auto& kinds = data_.mesh.edge_kind[entry.triangle];
    return data_.exact.faces[data_.mesh.face[entry.triangle]].kind ==
               spatial::SurfaceKind::kFreeform &&
           std::all_of(kinds.begin(), kinds.end(), [](EdgeKind kind) {
             return kind == EdgeKind::kSmooth || kind == EdgeKind::kOpen;
           });
  });
}

// All nodes are beyond the band, on one side of the surface.
void BlockBuilder::FillFarZone(const Index3& zone, double distance) {
  ZoneOf(zone)->code = zone::kFar | data_.mesh.face[hint_];
  SetNode(2 * zone[0], 2 * zone[1], 2 * zone[2], distance);
  const auto row_at = [&](int j, int k) {
    return block_->nodes.begin() + (k * 81 + j * 9 + 2 * zone[0]);
  };
  const std::int16_t units = *row_at(2 * zone[1], 2 * zone[2]);
  for (int k = 2 * zone[2]; k <= 2 * zone[2] + 2; ++k) {
    for (int j = 2 * zone[1]; j <= 2 * zone[1] + 2; ++j) {
      std::fill_n(row_at(j, k), 3, units);
    }
  }
}

// Nodes on a zone's upper sides are filled by the next zone in the block.
void BlockBuilder::FillNodes(const Index3& zone, const BoxedList& list) {
  NodeGrid grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.count[axis] = zone[axis] == 3 ? 3 : 2;
    for (std::size_t i = 0; i < 3; ++i) {
      grid.at[axis][i] = block_->origin[static_cast<int>(axis)] +
                         h_ * static_cast<double>(2 * zone[axis] + static_cast<int>(i));
    }
  }
  // What is listed has the closest triangle to each point of the zone.
  if ((ZoneOf(zone)->code & ~zone::kPayload) == zone::kList) {
    search_.FindSignedAtNodes(kept_, hint_, grid, &room_, &nodes_);
  } else {
    search_.FindSignedAtNodes(list, hint_, grid, &room_, &nodes_);
  }
  std::size_t node = 0;
  for (std::size_t k = 0; k < grid.count[2]; ++k) {
    for (std::size_t j = 0; j < grid.count[1]; ++j) {
      for (std::size_t i = 0; i < grid.count[0]; ++i, ++node) {
        SetNode(2 * zone[0] + static_cast<int>(i), 2 * zone[1] + static_cast<int>(j),
                2 * zone[2] + static_cast<int>(k), nodes_[node].distance);
      }
    }
  }
}

void BlockBuilder::SetNode(int i, int j, int k, double phi) {
  block_->is_near = block_->is_near || std::abs(phi) < block_reach_;
  block_->is_inside = phi < 0;
  block_->nodes[static_cast<std::size_t>(k * 81 + j * 9 + i)] = ToUnits(phi);
}

}  // namespace hvas::contact
