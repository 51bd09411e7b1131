#include "mates/prismatic_fits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mates/limits.h"
#include "mates/propose_fit.h"
#include "product/mesh_ray.h"

namespace hvas::mates {
namespace {

using product::Connector;
using product::FaceId;
using product::Feature;
using product::FeatureId;
using product::Mate;
using product::MateKind;
using product::OccurrenceId;
using product::Part;
using product::Pose;
using product::Product;

constexpr double kAligned = 1 - 1e-6;  // Cosine: the 0.1 deg of the mates themselves.
constexpr double kInclined =
    -0.45;  // Cosine of flanks that may hold a part: that of Infer's walls.
// [m]: an inner part that is wider by more lies in the outer one as drawn, instead of being pressed
// in. It would meet the mouth of the slot deeper than a free way may (50 um,
// docs/algorithms/sequence.md) on each side.
constexpr double kMostInterference = 100e-6;
constexpr double kHeld = -0.5;     // Cosine of a third face that keeps a dovetail between flanks.
constexpr double kInPlane = 1e-3;  // Sine of the angle between a wall and a way along it.
constexpr std::size_t kMostWays = 24;  // Ways that are tried out of a slot: a choice.
constexpr double kSameEdge = 20e-6;    // [m]: edges nearer than this are one. A choice.
constexpr double kLeastOfChamfer =
    0.05;  // Cosines of a chamfer's normal to wall and way: a choice.

struct Span {
  double low{std::numeric_limits<double>::infinity()};
  double high{-std::numeric_limits<double>::infinity()};

  [[nodiscard]] double length() const { return high - low; }
};

Span Intersect(const Span& a, const Span& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

/** A plane through `p`, with its normal out of the material. */
struct Plane {
  Vec3 nhat_W;
  Vec3 p_W;
};

Plane PlaneOf(const Product& product, OccurrenceId id, FeatureId feature) {
  const Pose& X_WB = product.occurrences[id.index()].X_WB;
  const Feature& plane = product.part_of(id).features[feature.index()];
  return {X_WB.q() * plane.axis_B, X_WB * plane.origin_B};
}

/** Where the line from `p` along `dir` meets a plane, in lengths of `dir`. */
double MeetPlane(const Plane& plane, const Vec3& p_W, const Vec3& dir_W) {
  return plane.nhat_W.dot(plane.p_W - p_W) / plane.nhat_W.dot(dir_W);
}

/** Extent of faces along a direction, from a point. */
Span CalcSpan(const Product& product, OccurrenceId id, const std::vector<FaceId>& faces,
              const Vec3& p_W, const Vec3& dir_W) {
  const Part& part = product.part_of(id);
  const Pose& X_WB = product.occurrences[id.index()].X_WB;
  Span span;
  for (const FaceId face_id : faces) {
    const product::Face& face = part.faces[face_id.index()];
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
        const double along = dir_W.dot(X_WB * part.mesh.vertices[v] - p_W);
        span.low = std::min(span.low, along);
        span.high = std::max(span.high, along);
      }
    }
  }
  return span;
}

/** One face-face mate of a pair, seen from the first part. */
struct Wall {
  std::size_t mate{0};  // Index into Product::mates.
  FeatureId own, other;
  Plane own_plane, other_plane;
  Vec3 centre_W;   // Of the contact.
  double area{0};  // Of the contact [m^2].
};

Wall MakeWall(const Product& product, std::size_t index, OccurrenceId first) {
  const Mate& mate = product.mates[index];
  const bool is_first_a = mate.a.occurrence == first;
  const Connector& own = is_first_a ? mate.a : mate.b;
  const Connector& other = is_first_a ? mate.b : mate.a;
  return {index,
          own.feature,
          other.feature,
          PlaneOf(product, own.occurrence, own.feature),
          PlaneOf(product, other.occurrence, other.feature),
          (product.occurrences[own.occurrence.index()].X_WB * own.X_BM).p(),
          mate.overlap};
}

/** Two walls that may hold a part between them. */
struct WallPair {
  const Wall* low{nullptr};
  const Wall* high{nullptr};
  bool is_first_outer{true};
  Vec3 across_W{Vec3::UnitX()};  // From low to high.
  Vec3 middle_W{Vec3::Zero()};   // In the middle of the slot.
  double outer_width{0};
  double inner_width{0};
};

/** The pair, seen so that the outer walls face each other along `across`; none where the widths of
 the two parts are on different sides, as in a lap, or the inner part is too wide to be pressed in.
 */
std::optional<WallPair> MakePair(const Wall& a, const Wall& b) {
  WallPair pair{&a, &b};
  const Vec3 between = a.own_plane.nhat_W - b.own_plane.nhat_W;
  pair.across_W = between.normalized();
  const Vec3 centre_W = 0.5 * (a.centre_W + b.centre_W);
  const auto locate = [&](const Plane& plane) { return MeetPlane(plane, centre_W, pair.across_W); };
  const double own = locate(b.own_plane) - locate(a.own_plane);
  const double other = locate(b.other_plane) - locate(a.other_plane);
  if (own * other <= 0) {
    return std::nullopt;
  }
  // The normals of outer walls point to each other: own is positive where the first part has them.
  pair.is_first_outer = own > 0;
  if (!pair.is_first_outer) {
    pair.across_W = -pair.across_W;
  }
  pair.outer_width = std::abs(pair.is_first_outer ? own : other);
  pair.inner_width = std::abs(pair.is_first_outer ? other : own);
  if (pair.inner_width - pair.outer_width > kMostInterference) {
    return std::nullopt;
  }
  const Plane& low = pair.is_first_outer ? a.own_plane : a.other_plane;
  const Plane& high = pair.is_first_outer ? b.own_plane : b.other_plane;
  pair.middle_W =
      centre_W +
      0.5 * (MeetPlane(low, centre_W, pair.across_W) + MeetPlane(high, centre_W, pair.across_W)) *
          pair.across_W;
  return pair;
}

/** Whether a pair is nearer than another one. Flanks of a dovetail are as large as each other, its
 floor is not: of inclined walls the most equal ones count as the nearest. */
bool IsNearer(const WallPair& a, const WallPair& b, bool is_inclined) {
  constexpr double kSameShare = 1e-3;  // Of areas that differ by their rounding: a choice.
  const auto share = [](const WallPair& pair) {
    return std::min(pair.low->area, pair.high->area) / std::max(pair.low->area, pair.high->area);
  };
  if (is_inclined && std::abs(share(a) - share(b)) > kSameShare) {
    return share(a) > share(b);
  }
  return a.outer_width < b.outer_width;
}

/** Whether a third face keeps the inner part from leaving between inclined flanks. */
bool IsHeldBetween(const WallPair& pair, const std::vector<Wall>& walls) {
  const Vec3 opening_W = (pair.low->own_plane.nhat_W + pair.high->own_plane.nhat_W).normalized();
  return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) {
    return wall.own_plane.nhat_W.dot(opening_W) < kHeld;
  });
}

using NumberedPair = std::pair<std::size_t, WallPair>;

/** Finds the wall that is nearest to another one, of those that are not taken. */
std::optional<NumberedPair> FindNearestWall(const std::vector<Wall>& walls, std::size_t i,
                                            bool is_inclined, const std::vector<bool>& is_taken) {
  std::optional<NumberedPair> nearest;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const double cosine = walls[i].own_plane.nhat_W.dot(walls[k].own_plane.nhat_W);
    const bool fits = is_inclined ? cosine <= kInclined && cosine >= -kAligned : cosine < -kAligned;
    if (k == i || is_taken[k] || !fits) {
      continue;
    }
    const auto pair = i < k ? MakePair(walls[i], walls[k]) : MakePair(walls[k], walls[i]);
    if (pair && (!is_inclined || IsHeldBetween(*pair, walls)) &&
        (!nearest || IsNearer(*pair, nearest->second, is_inclined))) {
      nearest = {k, *pair};
    }
  }
  return nearest;
}

/** The pairs of walls of which each is the nearest of the other. Walls that are taken are left out.
 */
std::vector<WallPair> PairUp(const std::vector<Wall>& walls, bool is_inclined,
                             std::vector<bool>* is_taken) {
  std::vector<WallPair> pairs;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto nearest = (*is_taken)[i] ? std::optional<NumberedPair>()
                                        : FindNearestWall(walls, i, is_inclined, *is_taken);
    if (!nearest || nearest->first < i) {
      continue;
    }
    const auto back = FindNearestWall(walls, nearest->first, is_inclined, *is_taken);
    if (back && back->first == i) {
      (*is_taken)[i] = (*is_taken)[nearest->first] = true;
      pairs.push_back(nearest->second);
    }
  }
  return pairs;
}

/** The faces of one of a connector's walls that face the other part; all where that is not known.
 */
std::vector<FaceId> FacingOf(const Product& product, const Mate& mate, const Connector& side,
                             FeatureId feature) {
  const bool is_a = &side == &mate.a;
  const std::vector<FaceId>& all = product.part_of(side.occurrence).features[feature.index()].faces;
  std::vector<FaceId> faces;
  std::copy_if(all.begin(), all.end(), std::back_inserter(faces), [&](FaceId face) {
    return std::any_of(mate.surfaces.begin(), mate.surfaces.end(),
                       [&](const product::SurfaceConstraint& surface) {
                         return (is_a ? surface.a : surface.b) == face;
                       });
  });
  return faces.empty() ? all : faces;
}

/** The part of a side that both of its walls have, along a direction from a point. */
Span SpanOf(const Product& product, const Mate& mate, const Connector& side, const Vec3& p_W,
            const Vec3& dir_W) {
  const auto span = [&](FeatureId feature) {
    return CalcSpan(product, side.occurrence, FacingOf(product, mate, side, feature), p_W, dir_W);
  };
  return Intersect(span(side.feature), span(side.opposite));
}

Pose FrameOf(const Product& product, const Mate& mate) {
  return product.occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
}

void SetFrame(const Product& product, const Pose& X_WM, Mate* mate) {
  for (Connector* side : {&mate->a, &mate->b}) {
    side->X_BM = product.occurrences[side->occurrence.index()].X_WB.Inverse() * X_WM;
  }
}

Vec3 ProjectToWall(const Vec3& v_W, const Vec3& across_W) {
  return v_W - v_W.dot(across_W) * across_W;
}

/** Directions along both walls, which are square to other planes of the two parts or to these. */
std::vector<Vec3> ListWays(const Product& product, const Mate& mate) {
  const Plane low = PlaneOf(product, mate.a.occurrence, mate.a.feature);
  const Plane high = PlaneOf(product, mate.a.occurrence, mate.a.opposite);
  std::vector<Vec3> ways;
  const auto add = [&](const Vec3& way_W) {
    const bool is_new = std::none_of(
        ways.begin(), ways.end(), [&](const Vec3& known) { return known.dot(way_W) > kAligned; });
    if (is_new && ways.size() < kMostWays) {
      ways.push_back(way_W);
    }
  };
  const Vec3 edge_W = low.nhat_W.cross(high.nhat_W);
  if (edge_W.norm() > kInPlane) {  // Inclined flanks leave the way along their common edge alone.
    add(edge_W.normalized());
    add(-edge_W.normalized());
    return ways;
  }
  const Vec3 across_W = FrameOf(product, mate).q() * Vec3::UnitZ();
  for (const Connector* side : {&mate.a, &mate.b}) {
    const Part& part = product.part_of(side->occurrence);
    for (std::size_t i = 0; i < part.features.size(); ++i) {
      if (part.features[i].kind == product::FeatureKind::kPlane) {
        const Vec3 nhat_W = PlaneOf(product, side->occurrence, FeatureId(i)).nhat_W;
        if (std::abs(nhat_W.dot(across_W)) < kInPlane) {
          const Vec3 way_W = ProjectToWall(nhat_W, across_W).normalized();
          for (const Vec3& each_W : {way_W, Vec3(across_W.cross(way_W))}) {
            add(each_W);
            add(-each_W);
          }
        }
      }
    }
  }
  return ways;
}

/** Whether the outer part lets what is between its walls out along x of the mate: rays from the
 engaged region, as far as the inner part has to go, meet nothing. */
bool IsOpen(const Product& product, const Mate& mate) {
  constexpr std::array kSpread{0.0, -0.8, 0.8};  // Of the half breadth, where rays begin: a choice.
  constexpr std::array kAside{0.0, -0.96, 0.96};  // Of the half width, where rays begin: a choice.
  const Part& outer = product.part_of(mate.a.occurrence);
  const Pose& X_BM = mate.a.X_BM;
  const double half_width = std::min(mate.hole_radius, mate.shaft_radius);
  const double middle =
      0.5 * (std::max(mate.hole_low, mate.shaft_low) + std::min(mate.hole_high, mate.shaft_high));
  const double reach = mate.hole_high - mate.shaft_low;
  for (const double y : kSpread) {
    for (const double z : kAside) {
      const Vec3 p_M(middle, 0.5 * y * mate.breadth, z * half_width);
      if (product::IsBlocked(outer, X_BM * p_M, X_BM.q() * Vec3::UnitX(), reach)) {
        return false;
      }
    }
  }
  return true;
}

/** The mate with the way out of the inner part; any way where there is none. The parts move as a
 whole: ways along the walls of all mates of the pair come first. */
Mate ChooseWay(const Product& product, const Mate& mate, const std::vector<Mate>& all) {
  const auto is_along_all = [&](const Vec3& way_W) {
    return std::all_of(all.begin(), all.end(), [&](const Mate& other) {
      return std::abs(way_W.dot(FrameOf(product, other).q() * Vec3::UnitZ())) < kInPlane;
    });
  };
  std::vector<Vec3> ways = ListWays(product, mate);
  if (std::any_of(ways.begin(), ways.end(), is_along_all)) {
    std::erase_if(ways, [&](const Vec3& way_W) { return !is_along_all(way_W); });
  }
  std::vector<Mate> turned;
  for (const Vec3& way_W : ways) {
    turned.push_back(TurnToWay(product, mate, way_W));
  }
  std::erase_if(turned, [](const Mate& each) { return each.overlap <= 0; });
  // Lengths that differ by their rounding alone are the same, so that the first of them counts.
  std::stable_sort(turned.begin(), turned.end(), [](const Mate& x, const Mate& y) {
    return std::llround(x.overlap / kSameEdge) < std::llround(y.overlap / kSameEdge);
  });
  if (turned.empty()) {
    return TurnToWay(product, mate, FrameOf(product, mate).q() * Vec3::UnitX());
  }
  const auto open = std::find_if(turned.begin(), turned.end(),
                                 [&](const Mate& each) { return IsOpen(product, each); });
  return open != turned.end() ? *open : turned.front();
}

product::Fit ProposeWidth(const Mate& mate) {
  FitEvidence evidence;
  evidence.hole_radius = mate.hole_radius;
  evidence.shaft_radius = mate.shaft_radius;
  product::Fit fit = ProposeFit(evidence);
  if (fit.kind == product::FitKind::kThread) {  // A width is none, however far the faces overlap.
    fit = {product::FitKind::kInterference, "", 2 * mate.hole_radius, true,
           "the drawn faces overlap by more than a press fit has"};
  }
  return fit;
}

Mate JoinPair(const Product& product, const WallPair& pair, OccurrenceId first,
              OccurrenceId second) {
  const Mate& low = product.mates[pair.low->mate];
  const Mate& high = product.mates[pair.high->mate];
  Mate mate;
  mate.kind = MateKind::kPrismatic;
  mate.a.occurrence = pair.is_first_outer ? first : second;
  mate.b.occurrence = pair.is_first_outer ? second : first;
  mate.a.feature = pair.is_first_outer ? pair.low->own : pair.low->other;
  mate.a.opposite = pair.is_first_outer ? pair.high->own : pair.high->other;
  mate.b.feature = pair.is_first_outer ? pair.low->other : pair.low->own;
  mate.b.opposite = pair.is_first_outer ? pair.high->other : pair.high->own;
  mate.hole_radius = 0.5 * pair.outer_width;
  mate.shaft_radius = 0.5 * pair.inner_width;
  mate.breadth = std::min(low.overlap, high.overlap);  // An area as yet, until a way is chosen.
  mate.overlap = 1;
  for (const Mate* wall : {&low, &high}) {
    const bool is_same_side = wall->a.occurrence == mate.a.occurrence;
    for (const product::SurfaceConstraint& surface : wall->surfaces) {
      mate.surfaces.push_back({surface.kind, is_same_side ? surface.a : surface.b,
                               is_same_side ? surface.b : surface.a});
    }
  }
  SetFrame(product, Pose(spatial::FrameFromZ(pair.across_W), pair.middle_W), &mate);
  mate.fit = ProposeWidth(mate);
  return mate;
}

/** The chamfer or rounding of one side where the tongue goes in first: at the end of the tongue's
 walls towards smaller x, or at the mouth of the slot. */
LeadIn FindEdge(const Product& product, const Mate& mate, const Connector& side) {
  const bool is_slot = &side == &mate.a;
  const double half_width = is_slot ? mate.hole_radius : mate.shaft_radius;
  const double edge = is_slot ? mate.hole_high : mate.shaft_low;
  const double middle = is_slot ? 0.0 : CalcDrawnShift(product, mate);
  const Part& part = product.part_of(side.occurrence);
  const Pose X_MB = side.X_BM.Inverse();
  for (const product::Face& face : part.faces) {
    const bool is_plane = face.surface.kind == product::SurfaceKind::kPlane;
    const bool is_round = face.surface.kind == product::SurfaceKind::kCylinder;
    const Vec3 axis_M = X_MB.q() * face.surface.axis;
    const bool is_chamfer = is_plane && std::abs(axis_M.y()) < kInPlane &&
                            std::abs(axis_M.x()) > kLeastOfChamfer &&
                            std::abs(axis_M.z()) > kLeastOfChamfer;
    if (!is_chamfer && !(is_round && std::abs(axis_M.y()) > kAligned)) {
      continue;
    }
    Span x;
    Span z;
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
        const Vec3 p_M = X_MB * part.mesh.vertices[v];
        x = {std::min(x.low, p_M.x()), std::max(x.high, p_M.x())};
        const double away = std::abs(p_M.z() - middle);
        z = {std::min(z.low, away), std::max(z.high, away)};
      }
    }
    // A slot widens in front of its walls, a tongue narrows behind them.
    const double at_wall = is_slot ? z.low : z.high;
    const double at_edge = is_slot ? x.low : x.high;
    if (std::abs(at_wall - half_width) < kSameEdge && std::abs(at_edge - edge) < kSameEdge &&
        x.length() > kSameEdge && z.length() > kSameEdge) {
      return {is_round ? std::numbers::pi / 4 : std::atan2(z.length(), x.length()), z.length()};
    }
  }
  return {};
}

}  // namespace

Mate TurnToWay(const Product& product, const Mate& mate, const Vec3& way_W) {
  const Pose X_WM = FrameOf(product, mate);
  const Vec3 across_W = X_WM.q() * Vec3::UnitZ();
  const Vec3 flat_W = ProjectToWall(way_W, across_W);
  if (flat_W.norm() < kInPlane) {
    return mate;
  }
  Mat3 R_WM;
  R_WM.col(0) = flat_W.normalized();
  R_WM.col(1) = across_W.cross(R_WM.col(0));
  R_WM.col(2) = across_W;
  Mate turned = mate;
  SetFrame(product, Pose(Quat(R_WM), X_WM.p()), &turned);
  const auto span_of = [&](const Connector& side, int axis) {
    return SpanOf(product, mate, side, X_WM.p(), R_WM.col(axis));
  };
  const Span slot = span_of(mate.a, 0);
  const Span tongue = span_of(mate.b, 0);
  turned.hole_low = slot.low;
  turned.hole_high = slot.high;
  turned.shaft_low = tongue.low;
  turned.shaft_high = tongue.high;
  // Walls that only touch end to end do not stand beside each other.
  const double engaged = Intersect(slot, tongue).length();
  const double beside = Intersect(span_of(mate.a, 1), span_of(mate.b, 1)).length();
  const bool is_engaged = std::min(engaged, beside) > InferenceLimits().axial_overlap;
  turned.overlap = is_engaged ? engaged : 0.0;
  turned.breadth = is_engaged ? mate.overlap * mate.breadth / engaged : 0.0;
  return turned;
}

void JoinWalls(Product* product, std::size_t first) {
  if (product->mates.size() < first + 2) {
    return;
  }
  const Mate& any = product->mates[first];
  const auto [one, other] = std::minmax(any.a.occurrence, any.b.occurrence);
  std::vector<Wall> walls;
  for (std::size_t i = first; i < product->mates.size(); ++i) {
    walls.push_back(MakeWall(*product, i, one));
  }
  std::vector<bool> is_taken(walls.size(), false);
  std::vector<WallPair> pairs = PairUp(walls, false, &is_taken);
  const std::vector<WallPair> inclined = PairUp(walls, true, &is_taken);
  pairs.insert(pairs.end(), inclined.begin(), inclined.end());
  std::vector<Mate> without_way;
  for (const WallPair& pair : pairs) {
    without_way.push_back(JoinPair(*product, pair, one, other));
  }
  std::vector<Mate> made;
  std::vector<bool> is_joined(walls.size(), false);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Mate mate = ChooseWay(*product, without_way[i], without_way);
    if (mate.overlap > 0) {  // Walls that do not stand beside each other hold nothing.
      is_joined[pairs[i].low->mate - first] = is_joined[pairs[i].high->mate - first] = true;
      made.push_back(std::move(mate));
    }
  }
  std::vector<Mate> kept;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (!is_joined[i]) {
      kept.push_back(std::move(product->mates[first + i]));
    }
  }
  product->mates.resize(first);
  for (std::vector<Mate>* list : {&made, &kept}) {
    std::move(list->begin(), list->end(), std::back_inserter(product->mates));
  }
}

LeadIn FindLeadIn(const Product& product, const Mate& mate) {
  const LeadIn own = FindEdge(product, mate, mate.b);
  return own.angle > 0 ? own : FindEdge(product, mate, mate.a);
}

double CalcWallThickness(const Product& product, const Mate& mate) {
  const Part& part = product.part_of(mate.a.occurrence);
  const Pose X_MB = mate.a.X_BM.Inverse();
  Span z;
  for (const Vec3& p_B : part.mesh.vertices) {
    const double at = (X_MB * p_B).z();
    z = {std::min(z.low, at), std::max(z.high, at)};
  }
  return std::max(0.0, z.length() - 2 * mate.hole_radius);
}

double CalcDrawnShift(const Product& product, const Mate& mate) {
  const Pose X_WM = FrameOf(product, mate);
  const Vec3 across_W = X_WM.q() * Vec3::UnitZ();
  const auto meet = [&](FeatureId feature) {
    return MeetPlane(PlaneOf(product, mate.b.occurrence, feature), X_WM.p(), across_W);
  };
  return 0.5 * (meet(mate.b.feature) + meet(mate.b.opposite));
}

}  // namespace hvas::mates
