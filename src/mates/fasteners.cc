#include "mates/fasteners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "product/axis_features.h"
#include "product/flexible.h"
#include "product/words.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureKind;
using product::Occurrence;
using product::OccurrenceId;
using product::Part;
using product::Product;

constexpr double kSameAngle = 2e-3;     // [rad]: what exports err by. A choice.
constexpr double kSameDistance = 0.01;  // Part of the distance.

/** A flat beside an axis. */
struct HexagonFlat {
  double distance{0};  // Of its plane from the axis [m].
  double angle{0};     // Of its normal about the axis, modulo 60 degrees [rad].
  bool is_outward{true};
  const Feature* plane{nullptr};
};

/** Extent of faces along an axis, from its origin. */
std::pair<double, double> CalcExtent(const Part& part, const std::vector<product::FaceId>& faces,
                                     const Feature& axis) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const product::FaceId id : faces) {
    const product::Face& face = part.faces[id.index()];
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
        const double at = axis.axis_B.dot(part.mesh.vertices[v] - axis.origin_B);
        low = std::min(low, at);
        high = std::max(high, at);
      }
    }
  }
  return {low, high};
}

/** Whether a flat goes all along a part: that of a bore, which no screw has. */
bool GoesThrough(const Part& part, const Feature& plane, const Feature& axis) {
  constexpr double kAllAlong = 0.9;  // Of the part: mouths are chamfered. A choice.
  const auto [low, high] = CalcExtent(part, plane.faces, axis);
  double first = axis.span_low;
  double last = axis.span_high;
  for (const Vec3& vertex : part.mesh.vertices) {
    const double at = axis.axis_B.dot(vertex - axis.origin_B);
    first = std::min(first, at);
    last = std::max(last, at);
  }
  return high - low > kAllAlong * (last - first);
}

/** What flats around an axis are. */
struct HexagonsAround {
  bool is_outside{false};  // A head, a nut.
  bool is_socket{false};   // Inside, and ends in the part.
};

HexagonsAround FindHexagons(const Part& part, const Feature& axis) {
  const Mat3 R = spatial::FrameFromZ(axis.axis_B).toRotationMatrix();
  std::vector<HexagonFlat> flats;
  for (const Feature& plane : part.features) {
    if (plane.kind != FeatureKind::kPlane || std::abs(plane.axis_B.dot(axis.axis_B)) > kSameAngle) {
      continue;
    }
    const double distance = plane.axis_B.dot(plane.origin_B - axis.origin_B);
    const Vec3 n = R.transpose() * plane.axis_B;
    flats.push_back({std::abs(distance), std::atan2(n.y(), n.x()), distance > 0, &plane});
  }
  constexpr double kSixth = std::numbers::pi / 3;  // [rad] of a hexagon's corner.
  HexagonsAround found;
  for (const HexagonFlat& first : flats) {
    unsigned corners = 0;
    for (const HexagonFlat& flat : flats) {
      const double turn = (flat.angle - first.angle) / kSixth;
      const double nearest = std::round(turn);
      if (flat.is_outward == first.is_outward && first.distance > 0 &&
          std::abs(flat.distance - first.distance) < kSameDistance * first.distance &&
          std::abs(turn - nearest) * kSixth < kSameAngle) {
        corners |= 1U << (static_cast<unsigned>(static_cast<int>(nearest) + 12) % 6U);
      }
    }
    if (corners == 0x3FU) {
      found.is_outside = found.is_outside || first.is_outward;
      found.is_socket =
          found.is_socket || (!first.is_outward && !GoesThrough(part, *first.plane, axis));
    }
  }
  return found;
}

bool IsOnAxis(const Feature& a, const Feature& b) {
  return std::abs(a.axis_B.dot(b.axis_B)) > 1 - kSameAngle * kSameAngle &&
         a.axis_B.cross(b.origin_B - a.origin_B).norm() < kSameDistance * a.radius;
}

FastenerKind ClassifyByNames(const Product& product, const Occurrence& occurrence) {
  const Part& part = product.part_of(occurrence.id);
  const FastenerKind by_part = ClassifyName(part.name);
  if (by_part != FastenerKind::kNone) {
    return by_part;
  }
  const FastenerKind by_name = ClassifyName(occurrence.name);
  if (by_name != FastenerKind::kNone) {
    return by_name;
  }
  if (occurrence.parent.is_valid()) {
    const product::Subassembly& parent = product.subassemblies[occurrence.parent.index()];
    int solid_parts = 0;
    for (const OccurrenceId id : parent.occurrences) {
      solid_parts += product.part_of(id).solid_count > 0 ? 1 : 0;
    }
    const bool stands_for_it =
        parent.parent.is_valid() && parent.subassemblies.empty() && solid_parts <= 1;
    if (stands_for_it) {
      return ClassifyName(parent.name);
    }
  }
  return FastenerKind::kNone;
}

/** Whether a shaft has a bore along most of it, of more than a third of its radius. */
bool IsHollow(const Product& product, const product::Connector& shaft) {
  const Part& part = product.part_of(shaft.occurrence);
  const Feature& outside = part.features[shaft.feature.index()];
  const double length = outside.span_high - outside.span_low;
  return std::any_of(part.features.begin(), part.features.end(), [&](const Feature& hole) {
    constexpr double kThinnestBore = 0.35;  // Of the shaft's radius; M3 in 6 mm has 0.4: a choice.
    constexpr double kMostOf = 0.6;         // Part of the length; bores may be blind: a choice.
    return hole.kind == FeatureKind::kHole && hole.radius < outside.radius &&
           hole.radius > kThinnestBore * outside.radius && IsOnAxis(outside, hole) &&
           hole.span_high - hole.span_low > kMostOf * length;
  });
}

/** What gives when something goes through it, or goes through something, by its name. */
bool IsRivet(const Product& product, OccurrenceId id) {
  const auto is_rivet = [](std::string_view name) {
    return product::FindFlexibleKind(name) == product::FlexibleKind::kRivet;
  };
  return is_rivet(product.part_of(id).name) || is_rivet(product.occurrences[id.index()].name);
}

/** What is pressed in and holds by its fit, by its name. */
bool IsBearing(const Product& product, OccurrenceId id) {
  static constexpr std::array<std::string_view, 12> kWords{
      "bearing", "ball bearing", "lager",  "kugellager", "waelzlager", "gleitlager",
      "bushing", "roulement",    "palier", "cuscinetto", "rodamiento", "rolamento"};
  return product::HasOneOf(product::FoldName(product.part_of(id).name), kWords) ||
         product::HasOneOf(product::FoldName(product.occurrences[id.index()].name), kWords);
}

bool IsFlexible(const Product& product, OccurrenceId id) {
  const auto is_bent = [](std::string_view name) {
    const auto kind = product::FindFlexibleKind(name);
    return kind == product::FlexibleKind::kCable || kind == product::FlexibleKind::kBelt ||
           kind == product::FlexibleKind::kSnapHook || kind == product::FlexibleKind::kRubber;
  };
  const product::ElasticPart* elastic = product::FindElastic(product, id);
  // The seat of a shaft seal has a fit, whatever its lip does.
  const bool is_squeezed = elastic != nullptr && !IsPressedAlongAxis(elastic->kind) &&
                           elastic->kind != product::ElasticKind::kLipSeal;
  return is_squeezed || is_bent(product.part_of(id).name) ||
         is_bent(product.occurrences[id.index()].name);
}

}  // namespace

FastenerKind ClassifyShape(const Part& part) {
  // Fasteners have few features; plates with many holes would take long and are none.
  constexpr std::size_t kMostFeatures = 64;
  if (part.features.size() > kMostFeatures) {
    return FastenerKind::kNone;
  }
  const Feature* hole = nullptr;
  const Feature* shaft = nullptr;
  for (const Feature& feature : part.features) {
    if (feature.kind == FeatureKind::kHole && feature.thread != product::ThreadKind::kNone &&
        FindHexagons(part, feature).is_outside) {
      return FastenerKind::kNut;
    }
    const Feature*& best = feature.kind == FeatureKind::kShaft ? shaft : hole;
    if (product::IsCylinder(feature.kind) && (best == nullptr || feature.area > best->area)) {
      best = &feature;
    }
  }
  if (shaft == nullptr) {
    return FastenerKind::kNone;
  }
  const HexagonsAround hexagons = FindHexagons(part, *shaft);
  if (!hexagons.is_outside && !hexagons.is_socket) {
    return FastenerKind::kNone;
  }
  // Where a hole goes all the way through it is none: a nut with a flange, or a hub.
  const bool is_through = hole != nullptr && IsOnAxis(*shaft, *hole) &&
                          hole->span_high - hole->span_low > shaft->span_high - shaft->span_low;
  return is_through ? FastenerKind::kNone : FastenerKind::kScrew;
}

std::vector<FastenerKind> ClassifyOccurrences(const Product& product) {
  std::vector<std::optional<FastenerKind>> by_shape(product.parts.size());
  std::vector<FastenerKind> kinds;
  kinds.reserve(product.occurrences.size());
  for (const Occurrence& occurrence : product.occurrences) {
    FastenerKind kind = ClassifyByNames(product, occurrence);
    if (kind == FastenerKind::kNone) {
      std::optional<FastenerKind>& shape = by_shape[occurrence.part.index()];
      if (!shape) {
        shape = ClassifyShape(product.parts[occurrence.part.index()]);
      }
      kind = *shape;
    }
    kinds.push_back(kind);
  }
  return kinds;
}

FitEvidence MakeFitEvidence(const Product& product, const product::Mate& mate,
                            const std::vector<FastenerKind>& fasteners) {
  const auto thread_of = [&product](const product::Connector& side) {
    return product.part_of(side.occurrence).features[side.feature.index()].thread;
  };
  FitEvidence evidence;
  evidence.hole_radius = mate.hole_radius;
  evidence.shaft_radius = mate.shaft_radius;
  evidence.hole_part = fasteners[mate.a.occurrence.index()];
  evidence.shaft_part = fasteners[mate.b.occurrence.index()];
  const auto is_toothed = [&product](const product::Connector& side) {
    return product::IsToothed(product.part_of(side.occurrence).features[side.feature.index()]);
  };
  evidence.is_toothed = is_toothed(mate.a) || is_toothed(mate.b);
  evidence.may_pass = true;
  evidence.is_hollow = IsHollow(product, mate.b);
  evidence.is_flexible =
      IsFlexible(product, mate.a.occurrence) || IsFlexible(product, mate.b.occurrence);
  evidence.is_rivet = IsRivet(product, mate.b.occurrence);
  evidence.hole_thread = thread_of(mate.a);
  evidence.shaft_thread = thread_of(mate.b);
  evidence.is_pressed = product::IsPinName(product.part_of(mate.b.occurrence).name) ||
                        IsBearing(product, mate.a.occurrence) ||
                        IsBearing(product, mate.b.occurrence);
  evidence.engaged = mate.overlap;
  return evidence;
}

}  // namespace hvas::mates
