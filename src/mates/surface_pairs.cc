#include "mates/surface_pairs.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

#include "mates/plane_overlap.h"

namespace hvas::mates {
namespace {

using product::Connector;
using product::Face;
using product::FaceId;
using product::Feature;
using product::FeatureId;
using product::Mate;
using product::MateKind;
using product::Part;
using product::Pose;
using product::Product;
using product::SurfaceConstraint;
using product::SurfaceConstraintKind;

constexpr std::size_t kSectors = 72;      // Of a turn: 5 degrees.
constexpr std::size_t kDirections = 512;  // Of a sphere.
constexpr double kLeastShare = 1e-3;      // Of an overlapping area.

using Sectors = std::bitset<kSectors>;
using Directions = std::bitset<kDirections>;

/** A side of a mate with the pose of the frame that both sides share. */
struct Side {
  const Part& part;
  Pose X_MB;
};

Side MakeSide(const Product& product, const Connector& connector, bool is_opposed) {
  // The frames of planes oppose each other; seen from one of them the other is turned about x.
  const Quat turn = is_opposed ? Quat(0, 1, 0, 0) : Quat(1, 0, 0, 0);
  const Pose X_BM(connector.X_BM.q() * turn, connector.X_BM.p());
  return {product.part_of(connector.occurrence), X_BM.Inverse()};
}

template <typename Visit>
void VisitTriangles(const Side& side, FaceId id, const Visit& visit) {
  const Face& face = side.part.faces[id.index()];
  for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
    const auto& t = side.part.mesh.triangles[face.first_triangle + i];
    visit(std::array<Vec3, 3>{side.X_MB * side.part.mesh.vertices[t[0]],
                              side.X_MB * side.part.mesh.vertices[t[1]],
                              side.X_MB * side.part.mesh.vertices[t[2]]});
  }
}

/** Where a face lies around the z axis. Without triangles: anywhere. */
struct AxialReach {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  Sectors sectors;
};

AxialReach CalcAxialReach(const Side& side, FaceId id) {
  AxialReach reach;
  if (side.part.faces[id.index()].triangle_count == 0) {
    reach.sectors.set();
    return reach;
  }
  std::swap(reach.low, reach.high);
  constexpr double kTurn = 2 * std::numbers::pi;  // A full turn [rad].
  VisitTriangles(side, id, [&](const std::array<Vec3, 3>& corners) {
    const double first = std::atan2(corners[0].y(), corners[0].x());
    double low = 0;
    double high = 0;
    for (const Vec3& p : corners) {
      reach.low = std::min(reach.low, p.z());
      reach.high = std::max(reach.high, p.z());
      // A triangle spans less than half a turn: unwrap about its first corner.
      const double turn = std::remainder(std::atan2(p.y(), p.x()) - first, kTurn);
      low = std::min(low, turn);
      high = std::max(high, turn);
    }
    // By the middles of the sectors, so that neighbours with a common edge do not share one.
    const double sector = kTurn / kSectors;
    const auto begin = static_cast<long>(std::ceil((first + low) / sector - 0.5));
    const auto end = static_cast<long>(std::floor((first + high) / sector - 0.5));
    for (long k = begin; k <= end; ++k) {
      const long n = kSectors;
      reach.sectors.set(static_cast<std::size_t>(((k % n) + n) % n));
    }
  });
  return reach;
}

bool DoOverlap(const AxialReach& a, const AxialReach& b) {
  constexpr double kLeast = 1e-6;  // [m]: less is touching. A choice.
  return std::min(a.high, b.high) - std::max(a.low, b.low) > kLeast &&
         (a.sectors & b.sectors).any();
}

const std::array<Vec3, kDirections>& EvenDirections() {
  static const std::array<Vec3, kDirections> directions = [] {
    std::array<Vec3, kDirections> out;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < kDirections; ++i) {
      const double z = 1 - (2 * static_cast<double>(i) + 1) / kDirections;
      const double r = std::sqrt(1 - z * z);
      const double angle = golden * static_cast<double>(i);
      out[i] = {r * std::cos(angle), r * std::sin(angle), z};
    }
    return out;
  }();
  return directions;
}

/** The directions, which fall in z, that can lie in a cap around a direction of this z. */
std::pair<std::size_t, std::size_t> FindBand(double z, double cosine) {
  const double polar = std::acos(std::clamp(z, -1.0, 1.0));
  const double reach = std::acos(std::clamp(cosine, -1.0, 1.0)) + 1e-9;
  const double high = std::cos(std::max(0.0, polar - reach));
  const double low = std::cos(std::min(std::numbers::pi, polar + reach));
  const auto index = [](double at) { return 0.5 * ((1 - at) * kDirections - 1); };
  const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(index(high))));
  const auto end = static_cast<std::size_t>(std::max(0.0, std::ceil(index(low)) + 1));
  return {begin, std::min(end, kDirections)};
}

/** The directions from the origin in which a face lies. Without triangles: all. */
Directions CalcDirections(const Side& side, FaceId id) {
  Directions covered;
  if (side.part.faces[id.index()].triangle_count == 0) {
    return covered.set();
  }
  VisitTriangles(side, id, [&](const std::array<Vec3, 3>& p) {
    const std::array<Vec3, 3> walls{p[0].cross(p[1]), p[1].cross(p[2]), p[2].cross(p[0])};
    const double sense = walls[0].dot(p[2]) < 0 ? -1.0 : 1.0;
    const Vec3 middle = (p[0] + p[1] + p[2]).normalized();
    double least = 1;  // Cosine of the cap around the middle that holds the triangle.
    for (const Vec3& corner : p) {
      least = std::min(least, middle.dot(corner.normalized()));
    }
    const auto [begin, end] = FindBand(middle.z(), least);
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& d = EvenDirections()[i];
      if (sense * walls[0].dot(d) >= 0 && sense * walls[1].dot(d) >= 0 &&
          sense * walls[2].dot(d) >= 0) {
        covered.set(i);
      }
    }
  });
  return covered;
}

bool DoOverlap(const Directions& a, const Directions& b) {
  return (a & b).any();
}

/** A face of a plane, flattened. */
struct FlatFace {
  Vec2 low, high;
  std::vector<Triangle2> triangles;
};

FlatFace Flatten(const Side& side, FaceId id) {
  FlatFace flat;
  const double inf = std::numeric_limits<double>::infinity();
  flat.low = Vec2::Constant(inf);
  flat.high = Vec2::Constant(-inf);
  VisitTriangles(side, id, [&](const std::array<Vec3, 3>& corners) {
    flat.triangles.push_back({corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()});
    for (const Vec3& p : corners) {
      flat.low = flat.low.cwiseMin(p.head<2>());
      flat.high = flat.high.cwiseMax(p.head<2>());
    }
  });
  return flat;
}

/** Those faces whose boxes in M can meet the box of the others, seen along z. */
std::vector<FaceId> SelectFacesNear(const Side& side, const std::vector<FaceId>& faces,
                                    const Side& other, const std::vector<FaceId>& other_faces) {
  spatial::Box box;
  for (const FaceId id : other_faces) {
    box.Add(spatial::Transform(other.X_MB, other.part.faces[id.index()].box_B));
  }
  std::vector<FaceId> near;
  for (const FaceId id : faces) {
    const spatial::Box own = spatial::Transform(side.X_MB, side.part.faces[id.index()].box_B);
    if ((own.low.head<2>().array() <= box.high.head<2>().array()).all() &&
        (box.low.head<2>().array() <= own.high.head<2>().array()).all()) {
      near.push_back(id);
    }
  }
  return near;
}

void AddPlanePairs(const Side& a, const std::vector<FaceId>& faces_a, const Side& b,
                   const std::vector<FaceId>& faces_b, double area, WorkWatch* watch,
                   std::vector<SurfaceConstraint>* pairs) {
  if (faces_a.size() == 1 && faces_b.size() == 1) {
    pairs->push_back({SurfaceConstraintKind::kCoplanar, faces_a[0], faces_b[0]});
    return;
  }
  const std::vector<FaceId> near_a = SelectFacesNear(a, faces_a, b, faces_b);
  const std::vector<FaceId> near_b = SelectFacesNear(b, faces_b, a, near_a);
  std::vector<FlatFace> flat_b;
  flat_b.reserve(near_b.size());
  for (const FaceId id : near_b) {
    flat_b.push_back(Flatten(b, id));
  }
  for (const FaceId id_a : near_a) {
    const FlatFace flat_a = Flatten(a, id_a);
    for (std::size_t k = 0; k < near_b.size() && MayGoOn(watch); ++k) {
      const FlatFace& other = flat_b[k];
      const bool can_meet = (flat_a.low.array() <= other.high.array()).all() &&
                            (other.low.array() <= flat_a.high.array()).all();
      if (can_meet && CalcOverlap(SelectNear(flat_a.triangles, other.triangles),
                                  SelectNear(other.triangles, flat_a.triangles), watch)
                              .area > kLeastShare * area) {
        pairs->push_back({SurfaceConstraintKind::kCoplanar, id_a, near_b[k]});
      }
    }
  }
}

template <typename Reach>
void AddPairs(const Side& a, const std::vector<FaceId>& faces_a, const Side& b,
              const std::vector<FaceId>& faces_b, SurfaceConstraintKind kind,
              Reach (*calc)(const Side&, FaceId), WorkWatch* watch,
              std::vector<SurfaceConstraint>* pairs) {
  if (faces_a.size() == 1 && faces_b.size() == 1) {
    pairs->push_back({kind, faces_a[0], faces_b[0]});
    return;
  }
  std::vector<Reach> reach_b;
  reach_b.reserve(faces_b.size());
  for (const FaceId id : faces_b) {
    reach_b.push_back(calc(b, id));
  }
  for (const FaceId id_a : faces_a) {
    if (!MayGoOn(watch)) {
      return;
    }
    const Reach reach_a = calc(a, id_a);
    for (std::size_t k = 0; k < faces_b.size(); ++k) {
      if (DoOverlap(reach_a, reach_b[k])) {
        pairs->push_back({kind, id_a, faces_b[k]});
      }
    }
  }
}

}  // namespace

std::vector<SurfaceConstraint> FindSurfacePairs(const Product& product, const Mate& mate,
                                                const std::vector<FeaturePair>& features,
                                                WorkWatch* watch) {
  const Side a = MakeSide(product, mate.a, false);
  const Side b = MakeSide(product, mate.b, mate.kind == MateKind::kFaceFace);
  std::vector<SurfaceConstraint> pairs;
  for (const auto& [feature_a, feature_b] : features) {
    const std::vector<FaceId>& faces_a = a.part.features[feature_a.index()].faces;
    const std::vector<FaceId>& faces_b = b.part.features[feature_b.index()].faces;
    switch (mate.kind) {
      case MateKind::kAxisHole:
        AddPairs(a, faces_a, b, faces_b, SurfaceConstraintKind::kCoaxial, &CalcAxialReach, watch,
                 &pairs);
        break;
      case MateKind::kConeSeat:
        AddPairs(a, faces_a, b, faces_b, SurfaceConstraintKind::kSameCone, &CalcAxialReach, watch,
                 &pairs);
        break;
      case MateKind::kSphereSeat:
        AddPairs(a, faces_a, b, faces_b, SurfaceConstraintKind::kConcentric, &CalcDirections, watch,
                 &pairs);
        break;
      case MateKind::kFaceFace:
        AddPlanePairs(a, faces_a, b, faces_b, mate.overlap, watch, &pairs);
        break;
      case MateKind::kPrismatic:
        break;  // It has the pairs of the walls that it is made of.
    }
  }
  return pairs;
}

std::vector<SurfaceConstraint> FindSurfacePairs(const Product& product, const Mate& mate,
                                                WorkWatch* watch) {
  return FindSurfacePairs(product, mate, {{mate.a.feature, mate.b.feature}}, watch);
}

PlaneOverlap CalcPlaneOverlap(const Product& product, const Mate& mate) {
  const auto flatten = [&product](const Connector& connector, bool is_opposed) {
    const Side side = MakeSide(product, connector, is_opposed);
    std::vector<Triangle2> all;
    for (const FaceId id : side.part.features[connector.feature.index()].faces) {
      const FlatFace flat = Flatten(side, id);
      all.insert(all.end(), flat.triangles.begin(), flat.triangles.end());
    }
    return all;
  };
  const Overlap overlap = CalcOverlap(flatten(mate.a, false), flatten(mate.b, true));
  return {overlap.area, Vec3(overlap.centroid.x(), overlap.centroid.y(), 0)};
}

double CalcSphereOverlap(const Product& product, const Mate& mate) {
  const auto cover = [](const Side& side, FeatureId feature) {
    Directions all;
    for (const FaceId id : side.part.features[feature.index()].faces) {
      all |= CalcDirections(side, id);
    }
    return all;
  };
  const Directions common = cover(MakeSide(product, mate.a, false), mate.a.feature) &
                            cover(MakeSide(product, mate.b, false), mate.b.feature);
  const double share = static_cast<double>(common.count()) / kDirections;
  return share * 4 * std::numbers::pi * mate.shaft_radius * mate.shaft_radius;
}

}  // namespace hvas::mates
