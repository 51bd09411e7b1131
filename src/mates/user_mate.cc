#include "mates/user_mate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/build_mate.h"
#include "mates/fasteners.h"
#include "mates/joints.h"
#include "mates/judge.h"
#include "mates/limits.h"
#include "mates/mate_key.h"
#include "mates/mate_kind.h"
#include "mates/place_bodies.h"
#include "mates/propose_fit.h"
#include "mates/resolve.h"
#include "mates/surface_pairs.h"

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::Mate;
using product::MateId;
using product::MateKind;
using product::OccurrenceId;
using product::Part;
using product::Pose;
using product::Product;
using units::ToMm;

const char* Describe(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kHole:
      return "a hole";
    case FeatureKind::kShaft:
      return "a shaft";
    case FeatureKind::kPlane:
      return "a plane";
    case FeatureKind::kConeSeat:
      return "a conical seat";
    case FeatureKind::kTaper:
      return "a taper";
    case FeatureKind::kSocket:
      return "a socket";
    case FeatureKind::kBall:
      return "a ball";
  }
  return "?";
}

std::string NameOf(const Product& product, const Pick& pick) {
  return product.occurrences[pick.occurrence.index()].path;
}

Result<MateSide> FindSide(const Product& product, const Pick& pick) {
  if (pick.occurrence.index() >= product.occurrences.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such occurrence", product.source,
                "hvas inspect lists them with their ids");
  }
  const Part& part = product.part_of(pick.occurrence);
  MateSide side{pick.occurrence, pick.feature, product.occurrences[pick.occurrence.index()].X_WB};
  if (pick.face.is_valid()) {
    if (pick.face.index() >= part.faces.size()) {
      return Fail(ErrorCode::kNotFound,
                  fmt::format("there is no face {}; the last one is {}", pick.face.value(),
                              part.faces.empty() ? 0 : part.faces.size() - 1),
                  NameOf(product, pick), "hvas inspect lists features with their faces");
    }
    const auto found =
        std::find_if(part.features.begin(), part.features.end(), [&pick](const Feature& feature) {
          return std::find(feature.faces.begin(), feature.faces.end(), pick.face) !=
                 feature.faces.end();
        });
    if (found == part.features.end()) {
      return Fail(
          ErrorCode::kUnsupported,
          fmt::format("face {} belongs to no hole, shaft, plane, cone or ball", pick.face.value()),
          NameOf(product, pick), "choose a face of one of these; hvas inspect lists them");
    }
    side.feature = FeatureId(static_cast<std::size_t>(found - part.features.begin()));
  }
  if (!side.feature.is_valid() || side.feature.index() >= part.features.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such feature", NameOf(product, pick),
                "hvas inspect lists features with their ids");
  }
  return side;
}

/** The kind of mate that two features make with `a` first, if they make one in this order. */
std::optional<MateKind> FindKind(FeatureKind a, FeatureKind b) {
  if (a == FeatureKind::kHole && b == FeatureKind::kShaft) {
    return MateKind::kAxisHole;
  }
  if (a == FeatureKind::kPlane && b == FeatureKind::kPlane) {
    return MateKind::kFaceFace;
  }
  if (a == FeatureKind::kConeSeat && b == FeatureKind::kTaper) {
    return MateKind::kConeSeat;
  }
  if (a == FeatureKind::kSocket && b == FeatureKind::kBall) {
    return MateKind::kSphereSeat;
  }
  return std::nullopt;
}

Error ExplainKinds(const Product& product, const MateSide& a, FeatureKind kind_a, const MateSide& b,
                   FeatureKind kind_b) {
  std::string remedy = "choose two planes, or a hole and a shaft";
  if (kind_a == kind_b) {
    const char* other = kind_a == FeatureKind::kHole       ? "a shaft"
                        : kind_a == FeatureKind::kShaft    ? "a hole"
                        : kind_a == FeatureKind::kConeSeat ? "a taper"
                        : kind_a == FeatureKind::kTaper    ? "a conical seat"
                        : kind_a == FeatureKind::kSocket   ? "a ball"
                                                           : "a socket";
    remedy = fmt::format("choose {} on one side", other);
    if (kind_a == FeatureKind::kHole) {
      remedy += "; a bolt aligns the holes of two parts";
    }
  }
  return {ErrorCode::kInvalid,
          fmt::format("{} and {} cannot mate", Describe(kind_a), Describe(kind_b)),
          fmt::format("{} and {}", product.occurrences[a.occurrence.index()].path,
                      product.occurrences[b.occurrence.index()].path),
          remedy};
}

double SizeOf(const Product& product, const MateSide& side) {
  const spatial::Box& box = product.part_of(side.occurrence).box_B;
  return box.is_empty() ? 0.0 : box.size().norm();
}

/** An error where the sizes of two features that could mate are too different. */
std::optional<Error> CheckSizes(const Product& product, MateKind kind, const Feature& a,
                                const Feature& b, double scale) {
  const InferenceLimits limits;
  const std::string where = product.source;
  switch (kind) {
    case MateKind::kAxisHole:
    case MateKind::kSphereSeat: {
      const double most = CalcLargestPlay(limits, scale, std::min(a.radius, b.radius));
      if (std::abs(a.radius - b.radius) >= most) {
        return Error{ErrorCode::kInvalid,
                     fmt::format("radii of {:.3f} and {:.3f} mm cannot mate: they may differ by at "
                                 "most {:.3f} mm",
                                 ToMm(a.radius), ToMm(b.radius), ToMm(most)),
                     where, "choose the faces that touch each other"};
      }
      break;
    }
    case MateKind::kConeSeat:
      if (std::abs(a.half_angle - b.half_angle) > limits.cone_angle) {
        return Error{ErrorCode::kInvalid,
                     fmt::format("cones of {:.2f} and {:.2f} deg (half angles) cannot mate",
                                 units::ToDeg(a.half_angle), units::ToDeg(b.half_angle)),
                     where, "choose cones with equal angles"};
      }
      break;
    case MateKind::kFaceFace:
    case MateKind::kPrismatic:
      break;
  }
  return std::nullopt;
}

/** True where the drawn poses fulfil the mate within the limits of inference. */
bool IsDrawnMated(MateKind kind, const Feature& a, const Feature& b, const Pose& X_AB,
                  double scale) {
  const InferenceLimits limits;
  const Vec3 axis_b = X_AB.q() * b.axis_B;
  const Vec3 origin_b = X_AB * b.origin_B;
  if (kind == MateKind::kSphereSeat) {
    return (origin_b - a.origin_B).norm() < limits.axis_distance * scale;
  }
  const double sense = kind == MateKind::kFaceFace ? -1.0 : 1.0;
  const double sine = a.axis_B.cross(axis_b).norm();
  const double cosine = a.axis_B.dot(axis_b);
  if (sine > limits.angle || (kind != MateKind::kAxisHole && sense * cosine < 0)) {
    return false;
  }
  if (kind == MateKind::kFaceFace) {
    return std::abs(a.axis_B.dot(origin_b - a.origin_B)) < limits.plane_gap * scale;
  }
  const AxialSpans spans = CalcAxialSpans(a, b, X_AB);
  const double play =
      kind == MateKind::kConeSeat ? std::abs(spans.shift) * std::sin(a.half_angle) : 0.0;
  return spans.axis_distance < limits.axis_distance * scale &&
         spans.length() > limits.axial_overlap * scale && play < limits.cone_gap * scale;
}

/** The pose of the second part that fulfils the mate, from its drawn one by the shortest way. */
Pose CalcMatedPose(MateKind kind, const Feature& a, const Pose& X_WA, const Feature& b,
                   const Pose& X_WB) {
  const Vec3 origin_a = X_WA * a.origin_B;
  Vec3 target = X_WA.q() * a.axis_B;
  const Vec3 axis_b = X_WB.q() * b.axis_B;
  if (kind == MateKind::kFaceFace || (kind == MateKind::kAxisHole && axis_b.dot(target) < 0)) {
    target = -target;  // A shaft goes in by the end that it is drawn nearer with.
  }
  const Quat turn = IsCentre(kind) ? Quat::Identity() : spatial::RotationTaking(axis_b, target);
  const Quat q_WB = (turn * X_WB.q()).normalized();
  Vec3 goal = origin_a;
  Vec3 point_B = b.origin_B;
  if (kind == MateKind::kAxisHole) {
    goal += 0.5 * (a.span_low + a.span_high) * (X_WA.q() * a.axis_B);
    point_B += 0.5 * (b.span_low + b.span_high) * b.axis_B;
  }
  return {q_WB, goal - q_WB * point_B};
}

bool IsBetweenSameParts(const Mate& x, const Mate& y) {
  return std::minmax(x.a.occurrence, x.b.occurrence) == std::minmax(y.a.occurrence, y.b.occurrence);
}

/** True where mates have moved one of the two parts against the other: then what inference finds
 between them holds for these poses only. */
bool IsMovedApart(const Product& product, const Mate& mate) {
  const std::vector<Pose>& drawn = product.placement.drawn_poses;
  if (drawn.empty()) {
    return false;
  }
  const std::size_t a = mate.a.occurrence.index();
  const std::size_t b = mate.b.occurrence.index();
  const Pose before = drawn[a].Inverse() * drawn[b];
  const Pose now = product.occurrences[a].X_WB.Inverse() * product.occurrences[b].X_WB;
  constexpr double kMoved = 1e-9;  // [m], and [rad]: well above rounding.
  return (before.p() - now.p()).norm() > kMoved ||
         spatial::RotationBetween(before.q(), now.q()).norm() > kMoved;
}

/** True where the mates that do not give way can be fulfilled with the new one, each of the user's
 shafts by either end. */
bool CanAgree(const Product& product, const Mate& mate) {
  const bool are_inferred_free = IsMovedApart(product, mate);
  BodyProblem problem;
  problem.is_fixed = {true, false};
  const OccurrenceId held = mate.b.occurrence;
  const auto add = [&](const Mate& other) {
    problem.mates.push_back(MakeBodyMate(product, other));
    BodyMate& added = problem.mates.back();
    const bool holds_b = other.b.occurrence == held;
    added.a = holds_b ? 0 : 1;
    added.b = holds_b ? 1 : 0;
    added.is_sense_open =
        other.kind == MateKind::kAxisHole && other.origin == product::MateOrigin::kUser;
  };
  for (const Mate& other : product.mates) {
    const bool is_user = other.origin == product::MateOrigin::kUser;
    const bool gives_way = other.kind == MateKind::kFaceFace || are_inferred_free;
    if (IsBetweenSameParts(other, mate) && (is_user || !gives_way)) {
      add(other);
    }
  }
  add(mate);
  problem.mates.back().is_sense_open = mate.kind == MateKind::kAxisHole;
  return PlaceBodies(problem, std::vector<bool>(problem.mates.size(), true)).is_fulfilled;
}

/** An error where the other mates of the two parts cannot be fulfilled together with this one. */
std::optional<Error> CheckContradiction(const Product& product, const Mate& mate) {
  const Pose& X_WA = product.occurrences[mate.a.occurrence.index()].X_WB;
  const Pose& X_WB = product.occurrences[mate.b.occurrence.index()].X_WB;
  std::vector<MateConstraint> constraints;
  std::string others;
  for (const Mate& other : product.mates) {
    if (IsBetweenSameParts(other, mate)) {
      constraints.push_back(MakeConstraint(other, mate.b.occurrence, X_WA));
      others += fmt::format("{}m{}", others.empty() ? "" : ", ", other.id.value());
    }
  }
  if (constraints.empty()) {
    return std::nullopt;
  }
  constraints.push_back(MakeConstraint(mate, mate.b.occurrence, X_WA));
  // Drawn play of 1 % of the limits of inference is no contradiction.
  constexpr double kAgree = 1e-6;  // [m]
  const Resolution resolution = Resolve(constraints, X_WB);
  if (resolution.is_converged || resolution.residual < kAgree || CanAgree(product, mate)) {
    return std::nullopt;
  }
  return Error{ErrorCode::kInvalid,
               fmt::format("the mate contradicts {} between the same parts (off by {:.3f} mm)",
                           others, ToMm(resolution.residual)),
               product.occurrences[mate.b.occurrence.index()].path,
               "remove those mates first, or choose other surfaces"};
}

const Feature& FeatureOfSide(const Product& product, const MateSide& side) {
  return product.part_of(side.occurrence).features[side.feature.index()];
}

bool IsMated(const Product& product, MateKind kind, const MateSide& a, const MateSide& b) {
  const double scale = CalcLengthScale(std::min(SizeOf(product, a), SizeOf(product, b)));
  return IsDrawnMated(kind, FeatureOfSide(product, a), FeatureOfSide(product, b),
                      a.X_WB.Inverse() * b.X_WB, scale);
}

/** A mate of two surfaces in the product's poses, but for its key and evidence. */
Mate MakeFrames(const Product& product, MateKind kind, const MateSide& a, MateSide b) {
  if (!IsMated(product, kind, a, b)) {
    b.X_WB =
        CalcMatedPose(kind, FeatureOfSide(product, a), a.X_WB, FeatureOfSide(product, b), b.X_WB);
  }
  Mate mate = BuildMate(product, kind, a, b);
  if (kind == MateKind::kFaceFace) {
    const PlaneOverlap overlap = CalcPlaneOverlap(product, mate);
    mate.overlap = overlap.area;
    if (overlap.area > 0) {
      MoveFrames(product, a, b, a.X_WB * (mate.a.X_BM * overlap.p_MQ), &mate);
    }
  } else if (kind == MateKind::kSphereSeat) {
    mate.overlap = CalcSphereOverlap(product, mate);
  } else if (kind == MateKind::kAxisHole) {
    mate.fit = ProposeFit(MakeFitEvidence(product, mate, ClassifyOccurrences(product)));
  }
  return mate;
}

/** Makes a mate the user's, with what follows from that. */
void MakeUsers(const Product& product, Mate* mate) {
  mate->origin = product::MateOrigin::kUser;
  mate->confidence = 1;
  mate->evidence = "given by the user: " + DescribeEvidence(product, *mate);
  mate->surfaces = FindSurfacePairs(product, *mate);
}

MateSide SideOf(const Product& product, const product::Connector& connector) {
  return {connector.occurrence, connector.feature,
          product.occurrences[connector.occurrence.index()].X_WB};
}

}  // namespace

Result<Mate> MakeMate(const Product& product, const Pick& pick_a, const Pick& pick_b) {
  Result<MateSide> a = FindSide(product, pick_a);
  Result<MateSide> b = a ? FindSide(product, pick_b) : Unexpected(a.error());
  if (!b) {
    return Unexpected(b.error());
  }
  if (a->occurrence == b->occurrence) {
    return Fail(ErrorCode::kInvalid, "a part cannot be mated with itself", NameOf(product, pick_a),
                "choose surfaces of two parts");
  }
  const auto kind_of = [&product](const MateSide& side) {
    return FeatureOfSide(product, side).kind;
  };
  std::optional<MateKind> kind = FindKind(kind_of(*a), kind_of(*b));
  if (!kind) {
    kind = FindKind(kind_of(*b), kind_of(*a));
    if (!kind) {
      return Unexpected(ExplainKinds(product, *a, kind_of(*a), *b, kind_of(*b)));
    }
    std::swap(*a, *b);
  }
  if (*kind == MateKind::kFaceFace && b->occurrence < a->occurrence) {
    std::swap(*a, *b);  // As inference has it.
  }
  const double scale = CalcLengthScale(std::min(SizeOf(product, *a), SizeOf(product, *b)));
  if (auto error = CheckSizes(product, *kind, FeatureOfSide(product, *a),
                              FeatureOfSide(product, *b), scale)) {
    return Unexpected(*error);
  }
  Mate mate = MakeFrames(product, *kind, *a, *b);
  mate.key = CalcKey(product, mate);
  const auto same = std::find_if(product.mates.begin(), product.mates.end(),
                                 [&mate](const Mate& other) { return other.key == mate.key; });
  if (same != product.mates.end()) {
    return *same;
  }
  if (auto error = CheckContradiction(product, mate)) {
    return Unexpected(*error);
  }
  MakeUsers(product, &mate);
  return mate;
}

Mate RemakeMate(const Product& product, const Mate& mate) {
  Mate remade = MakeFrames(product, mate.kind, SideOf(product, mate.a), SideOf(product, mate.b));
  remade.key = mate.key;
  MakeUsers(product, &remade);
  return remade;
}

bool IsMated(const Product& product, const Mate& mate) {
  return IsMated(product, mate.kind, SideOf(product, mate.a), SideOf(product, mate.b));
}

MateId AddMate(Product* product, Mate mate) {
  mate.id = MateId(product->mates.size());
  std::erase(product->removed_mates, mate.key);
  product->mates.push_back(std::move(mate));
  BuildJoints(product);
  return product->mates.back().id;
}

Result<MateId> FindMate(const Product& product, std::string_view text) {
  const auto fail = [&](std::string message) {
    return Fail(ErrorCode::kNotFound, std::move(message), product.source,
                "hvas inspect lists mates with their ids and keys");
  };
  if (text.size() > 1 && text.front() == 'm') {
    std::size_t index = 0;
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data() + 1, end, index);
    if (error == std::errc() && last == end) {
      return index < product.mates.size()
                 ? Result<MateId>(MateId(index))
                 : Result<MateId>(fail(fmt::format("there is no mate {}; the product has {} mates",
                                                   text, product.mates.size())));
    }
  }
  std::optional<MateId> found;
  for (const Mate& mate : product.mates) {
    if (text.empty() || mate.key.compare(0, text.size(), text) != 0) {
      continue;
    }
    if (found) {
      return fail(fmt::format("several mates have keys that begin with '{}'", text));
    }
    found = mate.id;
  }
  return found ? Result<MateId>(*found)
               : Result<MateId>(fail(fmt::format("there is no mate '{}'", text)));
}

Result<Mate> RemoveMate(Product* product, std::string_view text) {
  const Result<MateId> id = FindMate(*product, text);
  if (!id) {
    return Unexpected(id.error());
  }
  Mate removed = std::move(product->mates[id->index()]);
  product->removed_mates.push_back(removed.key);
  product->mates.erase(product->mates.begin() + static_cast<std::ptrdiff_t>(id->index()));
  for (std::size_t i = id->index(); i < product->mates.size(); ++i) {
    product->mates[i].id = MateId(i);
  }
  BuildJoints(product);
  return removed;
}

}  // namespace hvas::mates
