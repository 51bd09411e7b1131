#include "sequence/screw_mates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/user_mate.h"

namespace hvas::sequence {
namespace {

using product::FaceId;
using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::OccurrenceId;

constexpr double kMostlyOfOne = 0.8;    // Share of the flanks that are another part's: a choice.
constexpr double kShareOfLength = 0.6;  // Of the engaged length that is gone along the screw.
constexpr double kLeastThreadDepth =
    25e-6;                           // [m] of a thread: just over what IsDrawnThread() asks for.
constexpr double kConfidence = 0.8;  // The way was checked; what it is meant for is not known.

/** The body that most of the flanks belong to; invalid where there is none. */
contact::BodyId FindOther(const std::vector<paths::NearPoint>& flanks) {
  contact::BodyId other;
  std::size_t most = 0;
  for (const paths::NearPoint& flank : flanks) {
    if (flank.body == other) {
      continue;
    }
    const auto count = static_cast<std::size_t>(
        std::count_if(flanks.begin(), flanks.end(),
                      [&](const paths::NearPoint& point) { return point.body == flank.body; }));
    if (count > most) {
      most = count;
      other = flank.body;
    }
  }
  const auto enough = kMostlyOfOne * static_cast<double>(flanks.size());
  return static_cast<double>(most) >= enough ? other : contact::BodyId();
}

std::vector<FaceId> ToFaces(const std::set<std::uint32_t>& numbers) {
  std::vector<FaceId> faces;
  faces.reserve(numbers.size());
  for (const std::uint32_t number : numbers) {
    faces.emplace_back(number);
  }
  return faces;
}

/** A hole or shaft of the flanks, at their middle. */
Feature MakeFeature(const product::Product& product, const ScrewPair& pair, OccurrenceId id,
                    FeatureKind kind, const std::vector<FaceId>& faces) {
  const product::Part& part = product.part_of(id);
  const spatial::Pose X_BW = product.occurrences[id.index()].X_WB.Inverse();
  Feature feature;
  feature.kind = kind;
  feature.faces = faces;
  feature.origin_B = X_BW * pair.axis.p_WQ;
  feature.axis_B = X_BW.q() * pair.axis.axis_W;
  feature.radius = 0.5 * (pair.core_radius + pair.outer_radius);
  feature.span_low = std::numeric_limits<double>::infinity();
  feature.span_high = -feature.span_low;
  for (const FaceId id_of_face : faces) {
    const product::Face& face = part.faces[id_of_face.index()];
    for (std::uint32_t t = 0; t < face.triangle_count; ++t) {
      for (const std::uint32_t v : part.mesh.triangles[face.first_triangle + t]) {
        const double along = feature.axis_B.dot(part.mesh.vertices[v] - feature.origin_B);
        feature.span_low = std::min(feature.span_low, along);
        feature.span_high = std::max(feature.span_high, along);
      }
    }
    feature.area += face.area;
  }
  feature.coverage = 2 * std::numbers::pi;
  feature.thread = product::ThreadKind::kModelled;
  feature.thread_pitch = std::abs(pair.axis.pitch);
  return feature;
}

/** Adds a feature to an occurrence's part, unless another occurrence has brought it. */
FeatureId AddFeature(product::Product* product, OccurrenceId id, Feature feature) {
  product::Part& part = product->parts[product->occurrences[id.index()].part.index()];
  const auto known =
      std::find_if(part.features.begin(), part.features.end(), [&feature](const Feature& other) {
        return other.kind == feature.kind && other.thread == feature.thread &&
               other.faces == feature.faces;
      });
  if (known != part.features.end()) {
    return FeatureId(static_cast<std::size_t>(known - part.features.begin()));
  }
  part.features.push_back(std::move(feature));
  return FeatureId(part.features.size() - 1);
}

/** Takes the faces of a pair into the features of a thread between its parts that is known: it was
 recognised by a few of them. @returns false where there is none. */
bool WidenThread(const ScrewPair& pair, product::Product* product) {
  const auto known =
      std::find_if(product->mates.begin(), product->mates.end(), [&](const product::Mate& mate) {
        return mate.a.occurrence == pair.hole && mate.b.occurrence == pair.shaft && mate.fit &&
               mate.fit->kind == product::FitKind::kThread;
      });
  if (known == product->mates.end()) {
    return false;
  }
  const auto widen = [&](const product::Connector& side, const std::vector<FaceId>& faces) {
    product::Part& part =
        product->parts[product->occurrences[side.occurrence.index()].part.index()];
    Feature& feature = part.features[side.feature.index()];
    std::set<std::uint32_t> all;
    for (const FaceId face : feature.faces) {
      all.insert(face.value());
    }
    for (const FaceId face : faces) {
      all.insert(face.value());
    }
    feature.faces = ToFaces(all);
    feature.thread = product::ThreadKind::kModelled;
  };
  widen(known->a, pair.hole_faces);
  widen(known->b, pair.shaft_faces);
  return true;
}

bool AddScrewMate(const ScrewPair& pair, product::Product* product) {
  const FeatureId hole =
      AddFeature(product, pair.hole,
                 MakeFeature(*product, pair, pair.hole, FeatureKind::kHole, pair.hole_faces));
  const FeatureId shaft =
      AddFeature(product, pair.shaft,
                 MakeFeature(*product, pair, pair.shaft, FeatureKind::kShaft, pair.shaft_faces));
  auto mate = mates::MakeMate(*product, {pair.hole, {}, hole}, {pair.shaft, {}, shaft});
  const std::vector<std::string>& removed = product->removed_mates;
  if (!mate || mate->id.index() < product->mates.size() ||
      std::find(removed.begin(), removed.end(), mate->key) != removed.end()) {
    return false;  // It is there already, or the user does not want it.
  }
  mate->hole_radius = pair.core_radius;
  mate->shaft_radius = pair.outer_radius;
  mate->origin = product::MateOrigin::kInferred;
  mate->confidence = kConfidence;
  mate->evidence = fmt::format(
      "the screw that the faces leave, checked to its end: pitch {:.3f} mm, {:.2f} turns",
      units::ToMm(pair.axis.pitch), pair.turn / (2 * std::numbers::pi));
  product::Fit fit;
  fit.kind = product::FitKind::kThread;
  fit.nominal_diameter = 2 * pair.outer_radius;
  fit.reason = "the parts come apart along a screw";
  mate->fit = std::move(fit);
  mates::AddMate(product, std::move(*mate));
  return true;
}

/** What the flanks say of one of the two parts of a screw. */
struct FlanksOf {
  double least{std::numeric_limits<double>::infinity()};  ///< Radius of its points [m].
  double most{0};
  std::set<std::uint32_t> met;  ///< Faces of the other part that its points meet.
};

/** Flanks between a part and another one, about the axis of a screw. */
struct Flanks {
  double low{std::numeric_limits<double>::infinity()};  ///< Along the axis [m].
  double high{-std::numeric_limits<double>::infinity()};
  double outward{0};  ///< Sum of the cosines of the part's pushes to outward.
  FlanksOf part;
  FlanksOf other;
};

Flanks CollectFlanks(const paths::FreeScrew& screw, contact::BodyId other) {
  Flanks flanks;
  for (const paths::NearPoint& flank : screw.flanks) {
    if (flank.body != other) {
      continue;
    }
    const Vec3 from = flank.p_W - screw.axis.p_WQ;
    const double along = from.dot(screw.axis.axis_W);
    const Vec3 aside = from - along * screw.axis.axis_W;
    const double radius = aside.norm();
    flanks.low = std::min(flanks.low, along);
    flanks.high = std::max(flanks.high, along);
    flanks.outward += radius > 0 ? flank.nhat_W.dot(aside) / radius : 0;
    FlanksOf& of = flank.is_of_part ? flanks.part : flanks.other;
    of.least = std::min(of.least, radius);
    of.most = std::max(of.most, radius);
    of.met.insert(flank.face);
  }
  for (const paths::NearPoint& point : screw.passed) {
    if (point.body == other) {
      (point.is_of_part ? flanks.part : flanks.other).met.insert(point.face);
    }
  }
  flanks.part.met.erase(contact::kNoFace);
  flanks.other.met.erase(contact::kNoFace);
  return flanks;
}

}  // namespace

std::optional<ScrewPair> FindScrewPair(OccurrenceId part, const paths::FreeScrew& screw) {
  const contact::BodyId other = FindOther(screw.flanks);
  if (!other.is_valid() || !(screw.turn > 0)) {
    return std::nullopt;
  }
  const Flanks flanks = CollectFlanks(screw, other);
  const double gone = screw.turn * std::abs(screw.axis.pitch) / (2 * std::numbers::pi);
  if (flanks.part.met.empty() || flanks.other.met.empty() ||
      gone < kShareOfLength * (flanks.high - flanks.low)) {
    return std::nullopt;
  }
  // What pushes the part outwards from the axis is a shaft in it.
  const bool is_part_hole = flanks.outward > 0;
  const FlanksOf& hole = is_part_hole ? flanks.part : flanks.other;
  const FlanksOf& shaft = is_part_hole ? flanks.other : flanks.part;
  ScrewPair pair;
  pair.hole = is_part_hole ? part : OccurrenceId(other.index());
  pair.shaft = is_part_hole ? OccurrenceId(other.index()) : part;
  pair.axis = screw.axis;
  pair.turn = screw.turn;
  pair.core_radius = hole.least;
  pair.outer_radius = shaft.most;
  pair.hole_faces = ToFaces(shaft.met);
  pair.shaft_faces = ToFaces(hole.met);
  const bool is_deep = pair.outer_radius > pair.core_radius + kLeastThreadDepth;
  return is_deep ? std::optional(pair) : std::nullopt;
}

std::shared_ptr<const product::Product> AddScrewMates(const product::Product& product,
                                                      const std::vector<ScrewPair>& pairs) {
  auto with = std::make_shared<product::Product>(product);
  bool is_any = false;
  for (const ScrewPair& pair : pairs) {
    is_any = WidenThread(pair, with.get()) || AddScrewMate(pair, with.get()) || is_any;
  }
  return is_any ? with : nullptr;
}

}  // namespace hvas::sequence
