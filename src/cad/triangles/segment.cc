#include "cad/triangles/segment.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "base/units.h"
#include "cad/triangles/facets.h"
#include "cad/triangles/recognise.h"
#include "cad/triangles/segment_tidy.h"
#include "cad/triangles/surface_growth.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

constexpr std::uint32_t kNone = kNoTriangle;  // No segment.
// Tolerances, in resolutions. The last is for meshes that make no sense at the others.
constexpr std::array<double, 4> kLevels{1, 10, 100, 400};
constexpr std::size_t kUsualLevels = 3;
// Seeds in vain before their smooth surroundings are skipped too, ever more of them.
constexpr std::size_t kFailuresAtFull = 1000;
constexpr std::size_t kMostSkipped = 2000;

/** Marks up to `count` facets that are reached from one over smooth edges. */
void SkipAround(const Facets& facets, std::uint32_t seed, std::size_t count,
                std::vector<bool>* is_tried) {
  std::vector<std::uint32_t> queue(1, seed);
  std::set<std::uint32_t> seen{seed};
  for (std::size_t i = 0; i < queue.size(); ++i) {
    (*is_tried)[queue[i]] = true;
    for (const FacetLink& link : facets.links_of(queue[i])) {
      if (queue.size() < count && link.cosine > kSmoothCosine && seen.insert(link.facet).second) {
        queue.push_back(link.facet);
      }
    }
  }
}

class Segmenter {
 public:
  Segmenter(const WeldedMesh& mesh, const std::vector<std::uint32_t>& given,
            const std::vector<TriangleSoup::GivenFace>& faces)
      : mesh_(mesh), given_(given), faces_(faces) {
    label_.assign(mesh.triangles.size(), kNone);
    given_.resize(mesh.triangles.size(), kNone);
  }

  /** @param first  Of the levels; lower ones are below the noise of the mesh. */
  std::vector<Segment> Run(std::size_t first) {
    TakeGivenSurfaces();
    const std::size_t end = std::max(first + 1, kUsualLevels);
    for (std::size_t level = first; level < end; ++level) {
      RunLevel(kLevels[level] * mesh_.resolution, level + 1 == end);
    }
    return TidySegments(mesh_, given_, std::move(label_), std::move(segments_));
  }

 private:
  void TakeGivenSurfaces();
  void RunLevel(double tolerance, bool is_last);
  void TakeCurved(const Facets& facets, double tolerance, SurfaceGrower* grower);
  void TakePlanes(const Facets& facets, const SurfaceGrower& grower, double tolerance,
                  bool is_last);
  void TakePlane(const Facets& facets, std::uint32_t facet, double tolerance);
  void TakeRest(const Facets& facets, double tolerance);
  [[nodiscard]] std::uint32_t AddSegment(const Surface& surface, double tolerance);
  void Label(const Facets& facets, std::uint32_t facet, std::uint32_t segment);
  void TakeGivenSurface(std::uint32_t face, std::span<const std::uint32_t> triangles);

  const WeldedMesh& mesh_;
  std::vector<std::uint32_t> given_;
  const std::vector<TriangleSoup::GivenFace>& faces_;
  std::vector<std::uint32_t> label_;  // Of each triangle: its segment.
  std::vector<Segment> segments_;
};

std::uint32_t Segmenter::AddSegment(const Surface& surface, double tolerance) {
  segments_.emplace_back();
  segments_.back().tolerance = tolerance;
  segments_.back().surface = surface;
  return static_cast<std::uint32_t>(segments_.size() - 1);
}

void Segmenter::Label(const Facets& facets, std::uint32_t facet, std::uint32_t segment) {
  for (const std::uint32_t t : facets.triangles[facet]) {
    label_[t] = segment;
  }
  auto& corners = segments_[segment].corners;
  const auto own = facets.corners[facet];
  corners.insert(corners.end(), own.begin(), own.end());
}

void Segmenter::TakeGivenSurface(std::uint32_t face, std::span<const std::uint32_t> triangles) {
  constexpr double kSlack = 4;  // In resolutions; the corners have the digits that the file has.
  Surface surface = *faces_[face].surface;
  std::vector<Triangle> own;
  for (const std::uint32_t t : triangles) {
    own.push_back(mesh_.triangles[t]);
    for (const std::uint32_t v : mesh_.triangles[t]) {
      if (!(std::abs(CalcDistance(surface, mesh_.vertices[v]).distance) <=
            kSlack * mesh_.resolution)) {
        return;
      }
    }
  }
  if (surface.kind == SurfaceKind::kFreeform ||
      OrientSurface(mesh_.vertices, own, &surface) < 0.5) {
    return;
  }
  const std::uint32_t segment = AddSegment(surface, mesh_.resolution);
  segments_[segment].is_given_surface = true;
  for (const std::uint32_t t : triangles) {
    label_[t] = segment;
    const Triangle& corners = mesh_.triangles[t];
    segments_[segment].corners.insert(segments_[segment].corners.end(), corners.begin(),
                                      corners.end());
  }
}

void Segmenter::TakeGivenSurfaces() {
  std::vector<std::vector<std::uint32_t>> members(faces_.size());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (given_[t] < faces_.size()) {
      members[given_[t]].push_back(t);
    }
  }
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].surface && !members[f].empty()) {
      TakeGivenSurface(f, members[f]);
    }
  }
}

void Segmenter::TakeCurved(const Facets& facets, double tolerance, SurfaceGrower* grower) {
  std::vector<bool> is_tried(facets.size(), false);
  std::size_t failures = 0;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    if (is_tried[f] || grower->is_taken(f) || facets.normal[f].isZero()) {
      continue;
    }
    is_tried[f] = true;
    const std::optional<GrownSurface> grown = grower->Find(f);
    if (grown) {
      grower->Take(*grown);
      const std::uint32_t segment = AddSegment(grown->surface, tolerance);
      for (const std::uint32_t member : grown->facets) {
        Label(facets, member, segment);
      }
    } else if (++failures > kFailuresAtFull) {
      SkipAround(facets, f, std::min<std::size_t>(failures / 4, kMostSkipped), &is_tried);
    }
  }
}

void Segmenter::RunLevel(double tolerance, bool is_last) {
  std::vector<std::uint32_t> group(mesh_.triangles.size(), kNone);
  for (std::size_t t = 0; t < group.size(); ++t) {
    if (label_[t] == kNone) {
      group[t] = std::min(given_[t], kNone - 1);
    }
  }
  const Facets facets = MakeFacets(mesh_, group, tolerance);
  SurfaceGrower grower(mesh_, facets, tolerance);
  TakeCurved(facets, tolerance, &grower);
  TakePlanes(facets, grower, tolerance, is_last);
  if (is_last) {
    TakeRest(facets, tolerance);
  }
}

/** A facet is a flat face when its corners say so, or when nothing goes on smoothly beside it.
 Small flat pieces amid others of their kind are left to a freeform face. */
void Segmenter::TakePlanes(const Facets& facets, const SurfaceGrower& grower, double tolerance,
                           bool is_last) {
  const double total = std::accumulate(mesh_.area.begin(), mesh_.area.end(), 0.0);
  const bool is_tight = tolerance <= 2 * mesh_.resolution;
  std::vector<std::uint32_t> planes;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    if (grower.is_taken(f) || facets.normal[f].isZero()) {
      continue;
    }
    double largest = 0;  // Of the pieces that go on smoothly.
    bool is_smooth = false;
    for (const FacetLink& link : facets.links_of(f)) {
      if (!grower.is_taken(link.facet) && link.cosine > kSmoothCosine) {
        is_smooth = true;
        largest = std::max(largest, facets.area[link.facet]);
      }
    }
    const std::size_t corners = facets.corners[f].size();
    const std::size_t triangles = facets.triangles[f].size();
    const bool is_overdetermined = corners >= 6 || (corners >= 4 && facets.area[f] > 5e-3 * total);
    const bool is_plane = !is_smooth || (is_tight && triangles >= 2 && is_overdetermined) ||
                          ((is_last || !is_tight) && facets.area[f] > 4 * largest);
    if (is_plane) {
      planes.push_back(f);
    }
  }
  for (const std::uint32_t f : planes) {
    TakePlane(facets, f, tolerance);
  }
}

void Segmenter::TakePlane(const Facets& facets, std::uint32_t facet, double tolerance) {
  std::vector<SurfaceSample> samples;
  for (const std::uint32_t v : facets.vertices[facet]) {
    samples.push_back({mesh_.vertices[v], facets.normal[facet]});
  }
  Surface plane = FitSurface(SurfaceKind::kPlane, samples).value_or(Surface{});
  plane.kind = SurfaceKind::kPlane;
  plane.axis = plane.axis.dot(facets.normal[facet]) < 0 ? Vec3(-plane.axis) : plane.axis;
  if (plane.axis.dot(facets.normal[facet]) < 0.99) {  // Corners nearly in a line.
    plane.origin = facets.centre[facet];
    plane.axis = facets.normal[facet];
  }
  Label(facets, facet, AddSegment(plane, tolerance));
}

/** What is left and hangs together smoothly is a freeform face; two or three flats are flats. */
void Segmenter::TakeRest(const Facets& facets, double tolerance) {
  constexpr std::size_t kMostFlats = 3;  // More that go on smoothly are a freeform face.
  std::vector<bool> is_done(facets.size(), false);
  for (std::uint32_t seed = 0; seed < facets.size(); ++seed) {
    if (is_done[seed] || label_[facets.triangles[seed].front()] != kNone) {
      continue;
    }
    std::vector<std::uint32_t> members(1, seed);
    is_done[seed] = true;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (const FacetLink& link : facets.links_of(members[i])) {
        const bool is_sliver =
            facets.normal[members[i]].isZero() || facets.normal[link.facet].isZero();
        if (!is_done[link.facet] && label_[facets.triangles[link.facet].front()] == kNone &&
            (is_sliver || link.cosine > kSmoothCosine) &&
            given_[facets.triangles[link.facet].front()] ==
                given_[facets.triangles[seed].front()]) {
          is_done[link.facet] = true;
          members.push_back(link.facet);
        }
      }
    }
    const auto flats = std::partition(members.begin(), members.end(), [&](std::uint32_t f) {
      return members.size() > kMostFlats || facets.normal[f].isZero();
    });
    const bool is_freeform = flats != members.begin();
    const std::uint32_t segment = is_freeform ? AddSegment({}, mesh_.resolution) : kNone;
    std::for_each(members.begin(), flats, [&](std::uint32_t f) { Label(facets, f, segment); });
    std::for_each(flats, members.end(), [&](std::uint32_t f) { TakePlane(facets, f, tolerance); });
  }
}

/** How much there is to say about the faces; freeform ones by the piece. */
std::size_t CountPieces(const std::vector<Segment>& segments) {
  std::size_t count = 0;
  for (const Segment& segment : segments) {
    const bool is_freeform = segment.surface.kind == SurfaceKind::kFreeform;
    count += is_freeform ? 1 + segment.triangles.size() / 4 : 1;
  }
  return count;
}

}  // namespace

std::vector<Segment> SegmentMesh(const WeldedMesh& mesh, const std::vector<std::uint32_t>& given,
                                 const std::vector<TriangleSoup::GivenFace>& faces) {
  std::vector<Segment> best = Segmenter(mesh, given, faces).Run(0);
  std::size_t least = CountPieces(best);
  // A mesh of noisy or rounded corners falls to pieces below its noise, or is left freeform.
  if (least <= std::max<std::size_t>(8, mesh.triangles.size() / 32)) {
    return best;
  }
  for (std::size_t first = 1; first < kLevels.size(); ++first) {
    std::vector<Segment> segments = Segmenter(mesh, given, faces).Run(first);
    const std::size_t pieces = CountPieces(segments);
    if (2 * pieces < least) {
      least = pieces;
      best = std::move(segments);
    }
  }
  return best;
}

}  // namespace hvas::cad
