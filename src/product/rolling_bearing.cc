#include "product/rolling_bearing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace hvas::product {
namespace {

constexpr double kSameSize = 0.01;  // Part of a radius that equal elements differ by. A choice.
constexpr double kOnCircle = 0.02;  // Part of the circle's radius that centres lie beside it.
constexpr double kWidestGap = 1.6;  // Times the even spacing: filling slots leave wide gaps.
constexpr double kReach = 0.35;     // Part of an element's radius between it and its raceway.
constexpr double kLongestRing = 6;  // Times the elements' radius: beyond, it is a shaft or tube.
constexpr std::size_t kMostFeatures = 64;   // of a ring, and of an element.
constexpr std::size_t kFewestElements = 3;  // that hold a ring centred.

/** A ball or a roller in its place. */
struct Element {
  OccurrenceId id;
  Vec3 centre_W{Vec3::Zero()};
  double radius{0};
  std::optional<Vec3> axis_W;  ///< Of a roller.
};

/** Extent of a part about an axis. */
struct Extent {
  double inner{std::numeric_limits<double>::infinity()};
  double outer{0};
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};
};

struct Axis {
  Vec3 origin_W{Vec3::Zero()};
  Vec3 direction_W{Vec3::UnitZ()};
};

/** A part whose faces are spheres and the flats of its poles, or a cylinder and its ends. */
std::optional<std::pair<double, bool>> FindElementRadius(const Part& part) {
  if (part.faces.empty() || part.faces.size() > 8 || part.mass.volume <= 0) {
    return std::nullopt;
  }
  const Vec3 size = part.box_B.size();
  const Face* largest = &part.faces.front();
  for (const Face& face : part.faces) {
    largest = face.area > largest->area ? &face : largest;
  }
  const double r = largest->surface.radius;
  const Vec3 to_centre = part.box_B.centre() - largest->surface.origin;
  constexpr double kSphere = 4 * std::numbers::pi / 3;  // A definition: volume of the unit ball.
  if (largest->surface.kind == SurfaceKind::kSphere && largest->surface.outward > 0) {
    const bool is_ball = (size - Vec3::Constant(2 * r)).cwiseAbs().maxCoeff() < 0.1 * r &&
                         to_centre.norm() < 0.1 * r &&
                         std::abs(part.mass.volume / (kSphere * r * r * r) - 1) < 0.1;
    return is_ball ? std::optional(std::pair(r, false)) : std::nullopt;
  }
  if (largest->surface.kind == SurfaceKind::kCylinder && largest->surface.outward > 0) {
    const Vec3& axis = largest->surface.axis;
    const double length =
        size.cwiseProduct(axis.cwiseAbs()).maxCoeff();  // Exact where the axis is one of the frame.
    const double full = std::numbers::pi * r * r * length;
    const bool is_roller = to_centre.cross(axis).norm() < 0.1 * r && length > r &&
                           length < 20 * r && std::abs(part.mass.volume / full - 1) < 0.1;
    return is_roller ? std::optional(std::pair(r, true)) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<Element> ListElements(const Product& product, const std::vector<bool>& may_take) {
  std::vector<std::optional<std::pair<double, bool>>> radii;
  radii.reserve(product.parts.size());
  for (const Part& part : product.parts) {
    radii.push_back(FindElementRadius(part));
  }
  std::vector<Element> elements;
  for (const Occurrence& occurrence : product.occurrences) {
    const auto& radius = radii[occurrence.part.index()];
    if (!radius || !may_take[occurrence.id.index()]) {
      continue;
    }
    const Part& part = product.part_of(occurrence.id);
    Element element{occurrence.id, occurrence.X_WB * part.box_B.centre(), radius->first, {}};
    if (radius->second) {
      const auto largest =
          std::max_element(part.faces.begin(), part.faces.end(),
                           [](const Face& a, const Face& b) { return a.area < b.area; });
      element.axis_W = occurrence.X_WB.q() * largest->surface.axis;
    }
    elements.push_back(element);
  }
  return elements;
}

Extent CalcExtent(const Product& product, OccurrenceId id, const Axis& axis) {
  const Pose& X_WB = product.occurrences[id.index()].X_WB;
  Extent extent;
  for (const Vec3& vertex : product.part_of(id).mesh.vertices) {
    const Vec3 r = X_WB * vertex - axis.origin_W;
    const double h = r.dot(axis.direction_W);
    const double distance = (r - h * axis.direction_W).norm();
    extent.inner = std::min(extent.inner, distance);
    extent.outer = std::max(extent.outer, distance);
    extent.low = std::min(extent.low, h);
    extent.high = std::max(extent.high, h);
  }
  return extent;
}

/** Elements of one size on one circle around an axis. */
struct Circle {
  std::vector<const Element*> elements;
  Axis axis;  // With the origin in the middle of the circle.
  double radius{0};
};

bool IsEven(const Circle& circle) {
  const Quat q = spatial::FrameFromZ(circle.axis.direction_W);
  std::vector<double> angles;
  for (const Element* element : circle.elements) {
    const Vec3 r = q.conjugate() * (element->centre_W - circle.axis.origin_W);
    angles.push_back(std::atan2(r.y(), r.x()));
  }
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2 * std::numbers::pi);
  const double even = 2 * std::numbers::pi / static_cast<double>(circle.elements.size());
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const double gap = angles[i] - angles[i - 1];
    if (gap > kWidestGap * even || gap < 0.5 * even) {
      return false;
    }
  }
  return true;
}

/** The elements around an axis, by their size, place along the axis and distance from it. */
std::vector<Circle> FindCircles(const std::vector<Element>& elements, const Axis& axis,
                                const std::vector<bool>& is_taken) {
  std::vector<Circle> circles;
  std::vector<std::pair<double, double>> places;  // Height and size of each circle.
  for (const Element& element : elements) {
    const Vec3 r = element.centre_W - axis.origin_W;
    const double h = r.dot(axis.direction_W);
    const double distance = (r - h * axis.direction_W).norm();
    if (is_taken[element.id.index()] || distance < 1.2 * element.radius ||
        distance > 40 * element.radius ||
        (element.axis_W && std::abs(element.axis_W->dot(axis.direction_W)) < 0.7)) {
      continue;
    }
    std::size_t i = 0;
    while (i < circles.size() &&
           !(std::abs(places[i].first - h) < kOnCircle * distance &&
             std::abs(places[i].second - element.radius) < kSameSize * element.radius &&
             std::abs(circles[i].radius - distance) < kOnCircle * distance)) {
      ++i;
    }
    if (i == circles.size()) {
      circles.push_back({{}, {axis.origin_W + h * axis.direction_W, axis.direction_W}, distance});
      places.emplace_back(h, element.radius);
    }
    circles[i].elements.push_back(&element);
  }
  circles.erase(std::remove_if(circles.begin(), circles.end(),
                               [](const Circle& circle) {
                                 return circle.elements.size() < kFewestElements || !IsEven(circle);
                               }),
                circles.end());
  return circles;
}

/** Axes that a part could be a ring around: those of its holes, at most one for each axis. */
std::vector<Axis> ListRingAxes(const Product& product, OccurrenceId id) {
  const Part& part = product.part_of(id);
  std::vector<Axis> axes;
  if (part.features.size() > kMostFeatures || part.mass.volume <= 0) {
    return axes;
  }
  const Pose& X_WB = product.occurrences[id.index()].X_WB;
  for (const Feature& feature : part.features) {
    if (feature.kind == FeatureKind::kHole &&
        feature.axis_B.cross(part.box_B.centre() - feature.origin_B).norm() <
            0.02 * part.box_B.size().norm()) {
      const Vec3 centre_B = part.box_B.centre();
      axes.push_back({X_WB * centre_B, X_WB.q() * feature.axis_B});
      break;
    }
  }
  return axes;
}

/** What has a box near the elements of a circle. */
std::vector<OccurrenceId> ListNear(const Product& product, const Circle& circle,
                                   const std::vector<bool>& may_take) {
  Box box;
  for (const Element* element : circle.elements) {
    box.Add(element->centre_W);
  }
  const Box near = box.Expanded(circle.elements.front()->radius);
  std::vector<OccurrenceId> ids;
  for (const Occurrence& occurrence : product.occurrences) {
    if (may_take[occurrence.id.index()] &&
        spatial::Transform(occurrence.X_WB, product.part_of(occurrence.id).box_B).Overlaps(near)) {
      ids.push_back(occurrence.id);
    }
  }
  return ids;
}

/** The two rings of a circle, and what lies between them; empty where it has none. */
std::vector<OccurrenceId> CompleteBearing(const Product& product, const Circle& circle,
                                          const std::vector<bool>& may_take) {
  const double r = circle.elements.front()->radius;
  const double R = circle.radius;
  std::vector<std::pair<OccurrenceId, Extent>> others;
  for (const OccurrenceId id : ListNear(product, circle, may_take)) {
    const bool is_element = std::any_of(circle.elements.begin(), circle.elements.end(),
                                        [id](const Element* element) { return element->id == id; });
    if (!is_element) {
      others.emplace_back(id, CalcExtent(product, id, circle.axis));
    }
  }
  const Extent* inner = nullptr;
  const Extent* outer = nullptr;
  const auto is_ring = [&](const Extent& e) {
    return e.inner > 0.2 * R && e.high - e.low < kLongestRing * r && e.low < 0.5 * r &&
           e.high > -0.5 * r;
  };
  for (const auto& [id, extent] : others) {
    if (!is_ring(extent)) {
      continue;
    }
    const bool is_inside = extent.inner < R - r * (1 - kReach) && extent.outer < R + 0.5 * r &&
                           extent.outer > R - r * (1 + kReach);
    const bool is_outside = extent.outer > R + r * (1 - kReach) && extent.inner > R - 0.5 * r &&
                            extent.inner < R + r * (1 + kReach);
    // The ring next to the elements is the one that reaches them; cages are between.
    if (is_inside && (inner == nullptr || extent.inner < inner->inner)) {
      inner = &extent;
    }
    if (is_outside && (outer == nullptr || extent.outer > outer->outer)) {
      outer = &extent;
    }
  }
  if (inner == nullptr || outer == nullptr || inner == outer) {
    return {};
  }
  std::vector<OccurrenceId> members;
  for (const Element* element : circle.elements) {
    members.push_back(element->id);
  }
  const double slack = 0.1 * r;
  for (const auto& [id, extent] : others) {
    const bool is_between = extent.inner > inner->inner - slack &&
                            extent.outer < outer->outer + slack &&
                            extent.low > std::min(inner->low, outer->low) - slack &&
                            extent.high < std::max(inner->high, outer->high) + slack;
    if (is_between) {
      members.push_back(id);
    }
  }
  std::sort(members.begin(), members.end());
  return members;
}

}  // namespace

std::vector<std::vector<OccurrenceId>> FindRollingBearings(const Product& product,
                                                           const std::vector<bool>& may_take,
                                                           WorkWatch* watch) {
  std::vector<bool> is_free = may_take;
  const std::vector<Element> elements = ListElements(product, may_take);
  std::vector<std::vector<OccurrenceId>> bearings;
  if (elements.size() < kFewestElements) {
    return bearings;
  }
  std::vector<bool> is_taken(product.occurrences.size(), false);
  for (const Occurrence& occurrence : product.occurrences) {
    for (const Axis& axis : ListRingAxes(product, occurrence.id)) {
      if (!is_free[occurrence.id.index()] || !MayGoOn(watch)) {
        continue;
      }
      for (const Circle& circle : FindCircles(elements, axis, is_taken)) {
        if (!MayGoOn(watch)) {
          return bearings;
        }
        const std::vector<OccurrenceId> members = CompleteBearing(product, circle, is_free);
        for (const OccurrenceId id : members) {
          is_free[id.index()] = false;
          is_taken[id.index()] = true;
        }
        if (!members.empty()) {
          bearings.push_back(members);
        }
      }
    }
  }
  return bearings;
}

}  // namespace hvas::product
