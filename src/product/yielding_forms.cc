#include "product/yielding_forms.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "product/ring_shape.h"
#include "spatial/box_pairs.h"

namespace hvas::product {
namespace {

constexpr double kOffAxis = 0.3e-3;       // [m] that two axes may be apart as drawn. A choice.
constexpr double kParallelAxes = 0.9998;  // Cosine: within 1.1 degrees. A choice.

/** Distance of a point from a line [m]. @param axis  Unit. */
double CalcDistance(const Vec3& p, const Vec3& origin, const Vec3& axis) {
  const Vec3 d = p - origin;
  return (d - d.dot(axis) * axis).norm();
}

/** How far a closed ring has to stretch, or to get narrower, to get to a groove [m]; 0 where it is
 not in it. */
double CalcLandHeight(const Form& groove, const RingShape& ring, const Pose& X_RG) {
  constexpr double kRoom = 0.1e-3;  // [m] that a ring may lie in the floor as drawn. A choice.
  const Vec3 axis_R = X_RG.q() * groove.axis_B;
  const Vec3 off_R = X_RG * groove.origin_B - ring.centre_B;
  if (std::abs(axis_R.dot(ring.axis_B)) < kParallelAxes || off_R.norm() > 0.5 * ring.height ||
      (off_R - off_R.dot(ring.axis_B) * ring.axis_B).norm() > kOffAxis) {
    return 0;
  }
  const double floor = 0.5 * groove.diameter;
  const double outer_land = floor + groove.depth;  // On a shaft.
  const double inner_land = floor - groove.depth;  // In a bore.
  const bool is_around = ring.inner > floor - kRoom && ring.inner < outer_land;
  const bool is_within = ring.outer < floor + kRoom && ring.outer > inner_land;
  return is_around ? outer_land - ring.inner : is_within ? ring.outer - inner_land : 0;
}

/** The area of the sides of a body along an axis, and of its two ends as seen along it [m^2]. */
std::pair<double, double> MeasureAreas(const Part& part, const Vec3& axis_B) {
  constexpr double kEnd = 0.5;  // Cosine: flanks of belts are within 20 degrees of an end.
  double sides = 0;
  double ends = 0;
  for (const auto& [a, b, c] : part.mesh.triangles) {
    const Vec3& p = part.mesh.vertices[a];
    const Vec3 area = 0.5 * (part.mesh.vertices[b] - p).cross(part.mesh.vertices[c] - p);
    const double along = std::abs(area.dot(axis_B));
    (along < kEnd * area.norm() ? sides : ends) += along < kEnd * area.norm() ? area.norm() : along;
  }
  return {sides, ends};
}

/** What an occurrence may be, by its part alone. */
struct Candidate {
  OccurrenceId occurrence;
  std::optional<RingShape> ring;
  std::optional<BandShape> band;
  double stretch{0};          // Ring: over the land of its groove [m].
  std::set<std::size_t> met;  // Band: arcs that go round a shaft.
};

std::optional<RingShape> FindClosedRing(const Part& part) {
  constexpr double kWidest = 0.2;  // Of the outer radius; wider ones neither stretch nor open.
  const std::optional<RingShape> ring = FindRingShape(part);
  const bool is_ring = ring && ring->gap == 0 && ring->width() < kWidest * ring->outer;
  return is_ring ? ring : std::nullopt;
}

/** Looks at one pair: whether the other part has the groove of a ring, or shafts in a band. */
void LookAtPair(const Product& product, OccurrenceId other, Candidate* candidate) {
  const Pose X_CO = product.occurrences[candidate->occurrence.index()].X_WB.Inverse() *
                    product.occurrences[other.index()].X_WB;
  const Part& part = product.part_of(other);
  if (candidate->ring) {
    for (const Form& form : part.forms) {
      if (form.kind == FormKind::kGroove) {
        candidate->stretch =
            std::max(candidate->stretch, CalcLandHeight(form, *candidate->ring, X_CO));
      }
    }
  }
  if (!candidate->band) {
    return;
  }
  for (const Feature& feature : part.features) {
    const BandShape& band = *candidate->band;
    if (feature.kind != FeatureKind::kShaft ||
        std::abs((X_CO.q() * feature.axis_B).dot(band.axis_B)) < kParallelAxes) {
      continue;
    }
    for (std::size_t i = 0; i < band.arcs_B.size(); ++i) {
      if (CalcDistance(X_CO * feature.origin_B, band.arcs_B[i], band.axis_B) < kOffAxis) {
        candidate->met.insert(i);
      }
    }
  }
}

std::optional<FlexiblePart> Judge(const Product& product, const Candidate& candidate) {
  constexpr double kMostStretch = 0.25;  // Of the radius, as of an O-ring.
  constexpr double kOver = 1.3;          // Of the land: the width is measured on a grid. A choice.
  if (candidate.ring && candidate.stretch > 0 &&
      candidate.stretch < kMostStretch * candidate.ring->inner) {
    return FlexiblePart{candidate.occurrence, FlexibleKind::kGrooveRing, kOver * candidate.stretch,
                        "its form, a closed ring in a groove"};
  }
  if (candidate.met.size() >= 2) {
    return FlexiblePart{candidate.occurrence, FlexibleKind::kBelt,
                        CalcAllowance(FlexibleKind::kBelt, product.part_of(candidate.occurrence)),
                        "its form, a thin band round shafts"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<BandShape> FindBandShape(const Part& part) {
  constexpr double kThickest = 0.05;  // Thickness over length: chain links are thicker. A choice.
  constexpr double kWidest = 0.4;     // Width over length; wider ones are walls. A choice.
  constexpr double kOffEnds = 0.35;   // How far ends may be off: flanks of V-belts are slanted.
  const Face* largest = nullptr;
  for (const Face& face : part.faces) {
    if (face.surface.kind == SurfaceKind::kCylinder &&
        (largest == nullptr || face.area > largest->area)) {
      largest = &face;
    }
  }
  if (largest == nullptr || !(part.mass.volume > 0)) {
    return std::nullopt;
  }
  BandShape band;
  band.axis_B = largest->surface.axis.normalized();
  for (const Face& face : part.faces) {
    const Surface& surface = face.surface;
    if (surface.kind == SurfaceKind::kCylinder &&
        std::abs(surface.axis.dot(band.axis_B)) > kParallelAxes &&
        std::none_of(band.arcs_B.begin(), band.arcs_B.end(), [&](const Vec3& known) {
          return CalcDistance(surface.origin, known, band.axis_B) < kOffAxis;
        })) {
      band.arcs_B.push_back(surface.origin);
    }
  }
  const auto [sides, ends] = MeasureAreas(part, band.axis_B);
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double nearest = low;
  for (const Vec3& vertex : part.mesh.vertices) {
    low = std::min(low, vertex.dot(band.axis_B));
    high = std::max(high, vertex.dot(band.axis_B));
    nearest = std::min(nearest, CalcDistance(vertex, part.box_B.centre(), band.axis_B));
  }
  const double width = high - low;
  if (band.arcs_B.size() < 2 || !(sides > 0) || !(width > 0)) {
    return std::nullopt;
  }
  band.thickness = 2 * part.mass.volume / sides;
  band.length = 0.5 * sides / width;
  const double full_ends = 2 * part.mass.volume / width;
  const double middle = 0.5 * (low + high) - part.box_B.centre().dot(band.axis_B);
  const bool is_band =
      band.thickness < kThickest * band.length && width < kWidest * band.length &&
      nearest > band.thickness && std::abs(ends - full_ends) < kOffEnds * full_ends &&
      CalcOpenAngle(part, part.box_B.centre(), band.axis_B, middle + 0.013 * width) < 1e-3;
  return is_band ? std::optional(band) : std::nullopt;
}

std::vector<FlexiblePart> ListYieldingInPlace(const Product& product, WorkWatch* watch) {
  std::map<PartId, Candidate> shapes;
  std::vector<Candidate> candidates;
  std::vector<Box> own;
  std::vector<Box> all;
  for (const Occurrence& occurrence : product.occurrences) {
    const Part& part = product.part_of(occurrence.id);
    const auto [shape, is_new] = shapes.try_emplace(occurrence.part);
    if (is_new) {
      shape->second.ring = FindClosedRing(part);
      shape->second.band = FindBandShape(part);
    }
    all.push_back(spatial::Transform(occurrence.X_WB, part.box_B));
    if (shape->second.ring || shape->second.band) {
      candidates.push_back(shape->second);
      candidates.back().occurrence = occurrence.id;
      own.push_back(all.back());
    }
  }
  spatial::ForEachPair(own, all, 0, watch, [&](std::size_t i, std::size_t k) {
    if (candidates[i].occurrence.index() != k) {
      LookAtPair(product, OccurrenceId(k), &candidates[i]);
    }
    return true;
  });
  std::vector<FlexiblePart> yielding;
  for (const Candidate& candidate : candidates) {
    if (auto part = Judge(product, candidate)) {
      yielding.push_back(std::move(*part));
    }
  }
  return yielding;
}

}  // namespace hvas::product
