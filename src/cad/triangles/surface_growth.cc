#include "cad/triangles/surface_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "cad/triangles/recognise.h"
#include "cad/triangles/surface_fit.h"
#include "spatial/decompose.h"

namespace hvas::cad {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

// A turn has at least eight facets; six are a hexagon. With some slack for uneven ones.
const double kLargestTurnCosine = std::cos(units::FromDeg(48));
// From the middle of a facet to its corners: half of an eighth of a turn around the axis for a
// strip; between the normals there for a patch.
const double kStripCosine = std::cos(units::FromDeg(25));
const double kPatchCosine = std::cos(units::FromDeg(35));
constexpr std::size_t kMaxRing = 40;
constexpr std::size_t kMaxGrowthPoints = 1500;
constexpr double kGain = 1.05;           // By this much a less simple surface has to be larger.
constexpr double kLeastBend = 6;         // Bend of a curved surface over its extent, in tolerances.
constexpr double kLeastLooseTurn = 0.3;  // Of a loosely fitted one, to each side of its mean [rad].
constexpr double kApart = 2e-3;          // Directions that differ by more are two [rad].

/** How many different values there are, of which neighbours differ by more than a gap. */
std::size_t CountDistinct(std::vector<double> values, double gap) {
  std::sort(values.begin(), values.end());
  std::size_t count = values.empty() ? 0 : 1;
  for (std::size_t i = 1; i < values.size(); ++i) {
    count += values[i] - values[i - 1] > gap ? 1U : 0U;
  }
  return count;
}

/** Two more than a surface of this kind has parameters. */
std::size_t CountLeastPoints(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kSphere:
      return 6;
    case SurfaceKind::kCylinder:
      return 7;
    case SurfaceKind::kCone:
      return 8;
    default:
      return 9;
  }
}

/** Thickness of points across their best plane [m]. */
double CalcBend(std::span<const Vec3> points) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) {
    centre += p;
  }
  centre /= static_cast<double>(points.size());
  Mat3 C = Mat3::Zero();
  for (const Vec3& p : points) {
    C += (p - centre) * (p - centre).transpose();
  }
  const Vec3 nhat = spatial::CalcEigensystem(C).vectors.col(0);
  double low = 0;
  double high = 0;
  for (const Vec3& p : points) {
    low = std::min(low, (p - centre).dot(nhat));
    high = std::max(high, (p - centre).dot(nhat));
  }
  return high - low;
}

double CalcExtent(std::span<const Vec3> points) {
  spatial::Box box;
  for (const Vec3& p : points) {
    box.Add(p);
  }
  return box.size().norm();
}

/** From the axis to p, unit; zero on the axis. */
Vec3 RadialDirection(const Surface& surface, const Vec3& p) {
  const Vec3 q = p - surface.origin;
  const Vec3 radial = q - q.dot(surface.axis) * surface.axis;
  const double r = radial.norm();
  return r > 0 ? Vec3(radial / r) : Vec3::Zero();
}

bool IsPlausible(const Surface& surface, double extent) {
  constexpr double kMostExtents = 200;  // In extents.
  switch (surface.kind) {
    case SurfaceKind::kCone:
      return surface.second > units::FromDeg(0.2) && surface.second < units::FromDeg(89);
    case SurfaceKind::kTorus:
      return surface.second < 0.999 * surface.radius && surface.radius < kMostExtents * extent;
    default:
      return surface.radius < kMostExtents * extent;
  }
}

}  // namespace

SurfaceGrower::SurfaceGrower(const WeldedMesh& mesh, const Facets& facets, double tolerance)
    : mesh_(mesh), facets_(facets), tolerance_(tolerance) {
  is_taken_.assign(facets.size(), false);
  facet_stamp_.assign(facets.size(), 0);
  vertex_stamp_.assign(mesh.vertices.size(), 0);
}

/** The facets that share a corner with the seed and are reached over smooth edges. */
void SurfaceGrower::CollectRing(std::uint32_t seed) {
  const std::uint32_t stamp = ++round_;
  for (const std::uint32_t v : facets_.vertices[seed]) {
    vertex_stamp_[v] = stamp;
  }
  ring_.assign(1, seed);
  facet_stamp_[seed] = stamp;
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    for (const FacetLink& link : facets_.links_of(ring_[i])) {
      const auto corners = facets_.vertices[link.facet];
      if (ring_.size() < kMaxRing && facet_stamp_[link.facet] != stamp && !is_taken_[link.facet] &&
          link.cosine > kLargestTurnCosine &&
          std::any_of(corners.begin(), corners.end(),
                      [&](std::uint32_t v) { return vertex_stamp_[v] == stamp; })) {
        facet_stamp_[link.facet] = stamp;
        ring_.push_back(link.facet);
      }
    }
  }
}

/** The seed and its neighbours along its longest edges: three strips of a cylinder or cone, without
 what lies at their ends. */
void SurfaceGrower::CollectStrips(std::uint32_t seed) {
  // Share of the longest link: the two long sides of a strip. A choice.
  constexpr double kLong = 0.6;
  double longest = 0;
  for (const FacetLink& link : facets_.links_of(seed)) {
    longest = std::max(longest, link.length);
  }
  strips_.assign(1, seed);
  for (const FacetLink& link : facets_.links_of(seed)) {
    if (link.length >= kLong * longest && link.cosine > kLargestTurnCosine &&
        !is_taken_[link.facet]) {
      strips_.push_back(link.facet);
    }
  }
}

void SurfaceGrower::CollectPoints(std::span<const std::uint32_t> members) {
  const std::uint32_t stamp = ++round_;
  points_.clear();
  for (const std::uint32_t f : members) {
    for (const std::uint32_t v : facets_.corners[f]) {
      if (vertex_stamp_[v] != stamp) {
        vertex_stamp_[v] = stamp;
        points_.push_back(mesh_.vertices[v]);
      }
    }
  }
}

/** Least squares through the corners of facets, of a part of them where there are many.
 @returns The largest distance of those used. */
double SurfaceGrower::Refit(std::span<const std::uint32_t> members, Surface* surface) {
  CollectPoints(members);
  if (points_.size() > kMaxGrowthPoints) {
    const double stride =
        static_cast<double>(points_.size()) / static_cast<double>(kMaxGrowthPoints);
    for (std::size_t i = 0; i < kMaxGrowthPoints; ++i) {
      points_[i] = points_[static_cast<std::size_t>(static_cast<double>(i) * stride)];
    }
    points_.resize(kMaxGrowthPoints);
  }
  return RefineSurface(points_, std::max(CalcExtent(points_), tolerance_), surface);
}

bool SurfaceGrower::IsOnSurface(const Surface& surface, std::uint32_t facet,
                                double tolerance) const {
  const Vec3& nhat = facets_.normal[facet];
  const bool is_ruled =
      surface.kind == SurfaceKind::kCylinder || surface.kind == SurfaceKind::kCone;
  const Vec3 middle = RadialDirection(surface, facets_.centre[facet]);
  for (const std::uint32_t v : facets_.corners[facet]) {
    const Vec3& p = mesh_.vertices[v];
    const auto at = CalcDistance(surface, p);
    if (std::abs(at.distance) > tolerance) {
      return false;
    }
    if (!at.is_valid || nhat.isZero()) {
      continue;
    }
    if (is_ruled ? RadialDirection(surface, p).dot(middle) < kStripCosine
                 : at.gradient.dot(nhat) < kPatchCosine) {
      return false;
    }
  }
  const auto at_centre = CalcDistance(surface, facets_.centre[facet]);
  return nhat.isZero() || !at_centre.is_valid || at_centre.gradient.dot(nhat) > kStripCosine;
}

void SurfaceGrower::Spread(const Surface& surface, double tolerance, std::size_t limit,
                           std::vector<std::uint32_t>* members) {
  const std::uint32_t stamp = ++round_;
  for (const std::uint32_t f : *members) {
    facet_stamp_[f] = stamp;
  }
  for (std::size_t i = 0; i < members->size() && members->size() < limit; ++i) {
    for (const FacetLink& link : facets_.links_of((*members)[i])) {
      if (facet_stamp_[link.facet] != stamp && !is_taken_[link.facet] &&
          IsOnSurface(surface, link.facet, tolerance)) {
        facet_stamp_[link.facet] = stamp;
        members->push_back(link.facet);
      }
    }
  }
}

/** Takes off facets whose middle stands off the surface much more than that of most: a flat on a
 ball has all of its corners on the ball. */
void SurfaceGrower::DropCaps(const Surface& surface, std::vector<std::uint32_t>* members) const {
  constexpr double kFar = 5;  // Multiple of the middle height (segmentation.md).
  std::vector<double> heights;
  heights.reserve(members->size());
  for (const std::uint32_t f : *members) {
    heights.push_back(std::abs(CalcDistance(surface, facets_.centre[f]).distance));
  }
  std::vector<double> sorted = heights;
  // Few facets of one surface are alike; among many some are cut small at the rim.
  const std::size_t rank = sorted.size() <= 10 ? (sorted.size() - 1) / 2 : 4 * sorted.size() / 5;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double limit = kFar * std::max(*middle, tolerance_);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < members->size(); ++i) {
    if (heights[i] <= limit) {
      (*members)[kept++] = (*members)[i];
    }
  }
  members->resize(kept);
}

/** Whether the normals of facets stray from their mean by more than an angle. */
bool SurfaceGrower::TurnsMoreThan(double angle, std::span<const std::uint32_t> members) const {
  Vec3 mean = Vec3::Zero();
  for (const std::uint32_t f : members) {
    mean += facets_.area[f] * facets_.normal[f];
  }
  const double least = std::cos(angle) * mean.norm();
  return std::any_of(members.begin(), members.end(), [&](std::uint32_t f) {
    return !facets_.normal[f].isZero() && facets_.normal[f].dot(mean) <= least;
  });
}

/** Whether the corners say more than the surface has parameters: three flats around an axis, three
 circles of a sphere, four of a torus; and that it is no plane. */
bool SurfaceGrower::IsSupported(const Surface& surface, std::span<const std::uint32_t> members) {
  CollectPoints(members);
  const double extent = CalcExtent(points_);
  if (!IsPlausible(surface, extent) || CalcBend(points_) < kLeastBend * tolerance_ ||
      (tolerance_ > 2 * mesh_.resolution && !TurnsMoreThan(kLeastLooseTurn, members))) {
    return false;
  }
  const Mat3 R = spatial::FrameFromZ(surface.axis).toRotationMatrix();
  std::vector<double> around;
  std::vector<double> across;
  if (surface.kind == SurfaceKind::kCylinder || surface.kind == SurfaceKind::kCone) {
    for (const std::uint32_t f : members) {
      const Vec3 n = R.transpose() * facets_.normal[f];
      if (!n.isZero()) {
        around.push_back(std::atan2(n.y(), n.x()));
      }
    }
    return CountDistinct(std::move(around), kApart) >= 3;
  }
  if (surface.kind == SurfaceKind::kSphere) {
    // Along the mean normal; a sphere has no axis of its own.
    Vec3 mean = Vec3::Zero();
    for (const std::uint32_t f : members) {
      mean += facets_.area[f] * facets_.normal[f];
    }
    mean = mean.norm() > 0 ? Vec3(mean.normalized()) : Vec3::UnitZ();
    for (const Vec3& p : points_) {
      across.push_back(mean.dot(p - surface.origin) / surface.radius);
    }
    return members.size() >= 6 && CountDistinct(std::move(across), kApart) >= 3;
  }
  for (const Vec3& p : points_) {
    const Vec3 q = R.transpose() * (p - surface.origin);
    around.push_back(std::atan2(q.y(), q.x()));
    across.push_back(std::atan2(q.z(), std::hypot(q.x(), q.y()) - surface.radius));
  }
  return members.size() >= 9 && CountDistinct(std::move(around), kApart) >= 4 &&
         CountDistinct(std::move(across), kApart) >= 4;
}

/** Whether anything may go on beyond the rim that another kind of surface could take. */
bool SurfaceGrower::HasSmoothRim(std::span<const std::uint32_t> members) {
  const std::uint32_t stamp = ++round_;
  for (const std::uint32_t f : members) {
    facet_stamp_[f] = stamp;
  }
  return std::any_of(members.begin(), members.end(), [&](std::uint32_t f) {
    const auto links = facets_.links_of(f);
    return std::any_of(links.begin(), links.end(), [&](const FacetLink& link) {
      return facet_stamp_[link.facet] != stamp && !is_taken_[link.facet] &&
             link.cosine > kLargestTurnCosine;
    });
  });
}

/** The surface that all of the seeds lie on, the way their normals look. */
std::optional<Surface> SurfaceGrower::FitSeeds(SurfaceKind kind,
                                               const std::vector<std::uint32_t>& seeds) {
  std::vector<SurfaceSample> samples;
  for (const std::uint32_t f : seeds) {
    if (!facets_.normal[f].isZero()) {
      samples.push_back({facets_.centre[f], facets_.normal[f]});
    }
  }
  if (samples.size() < (kind == SurfaceKind::kTorus ? 6U : 3U)) {
    return std::nullopt;
  }
  std::optional<Surface> surface = FitSurface(kind, samples);
  // Through so few corners a surface can always be laid.
  CollectPoints(seeds);
  if (!surface || points_.size() < CountLeastPoints(kind) ||
      !(Refit(seeds, &*surface) <= tolerance_)) {
    return std::nullopt;
  }
  double sense = 0;
  for (const SurfaceSample& sample : samples) {
    sense += CalcDistance(*surface, sample.p).gradient.dot(sample.nhat);
  }
  surface->outward = sense < 0 ? -surface->outward : surface->outward;
  const bool is_on_all = std::all_of(seeds.begin(), seeds.end(), [&](std::uint32_t f) {
    return IsOnSurface(*surface, f, tolerance_);
  });
  return is_on_all ? surface : std::nullopt;
}

/** Takes in the facets around that fit, and fits the surface to them, until there are no more. */
void SurfaceGrower::Extend(Surface* surface, std::vector<std::uint32_t>* members) {
  constexpr int kMaxRounds = 24;  // Rounds of growth and a new fit: a bound, a choice.
  for (int round = 0; round < kMaxRounds; ++round) {
    const std::size_t before = members->size();
    Spread(*surface, 3 * tolerance_, 3 * before, members);
    if (members->size() == before) {
      break;
    }
    Surface refined = *surface;
    if (Refit(*members, &refined) <= 2 * tolerance_) {
      *surface = refined;
    }
    std::erase_if(*members, [&](std::uint32_t f) { return !IsOnSurface(*surface, f, tolerance_); });
    if (members->size() <= before) {
      break;
    }
  }
}

std::optional<GrownSurface> SurfaceGrower::Grow(SurfaceKind kind,
                                                const std::vector<std::uint32_t>& seeds) {
  std::optional<Surface> surface = FitSeeds(kind, seeds);
  if (!surface) {
    return std::nullopt;
  }
  std::vector<std::uint32_t> members = seeds;
  Extend(&*surface, &members);
  if (members.size() < 3) {
    return std::nullopt;
  }
  DropCaps(*surface, &members);
  if (members.size() < 3 || !IsSupported(*surface, members)) {
    return std::nullopt;
  }
  GrownSurface grown{*surface, std::move(members), 0};
  std::sort(grown.facets.begin(), grown.facets.end());
  for (const std::uint32_t f : grown.facets) {
    grown.area += facets_.area[f];
  }
  return grown;
}

std::optional<GrownSurface> SurfaceGrower::Find(std::uint32_t seed) {
  CollectRing(seed);
  CollectStrips(seed);
  std::optional<GrownSurface> best;
  for (const SurfaceKind kind :
       {SurfaceKind::kCylinder, SurfaceKind::kCone, SurfaceKind::kSphere, SurfaceKind::kTorus}) {
    const bool is_ruled = kind == SurfaceKind::kCylinder || kind == SurfaceKind::kCone;
    std::optional<GrownSurface> grown;
    if (is_ruled && strips_.size() == 3) {
      grown = Grow(kind, strips_);
    }
    if (!grown) {
      grown = Grow(kind, ring_);
    }
    if (grown && (!best || grown->area > kGain * best->area)) {
      best = std::move(grown);
      if (!HasSmoothRim(best->facets)) {
        break;
      }
    }
  }
  return best;
}

void SurfaceGrower::Take(const GrownSurface& grown) {
  for (const std::uint32_t f : grown.facets) {
    is_taken_[f] = true;
  }
}

}  // namespace hvas::cad
