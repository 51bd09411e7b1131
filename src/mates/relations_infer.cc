#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "mates/limits.h"
#include "mates/relations.h"
#include "product/face_adjacency.h"
#include "spatial/box_pairs.h"

namespace hvas::mates {
namespace {

using product::ElementKind;
using product::Feature;
using product::FeatureId;
using product::FeatureKind;
using product::OccurrenceId;
using product::Part;
using product::PartId;
using product::Product;
using product::Relation;
using product::RelationKind;
using product::RelationSide;
using spatial::Box;

constexpr double kWeldTolerance = 1e-7;      // Of vertices of one edge [m]; as for forms.
constexpr double kLeastEdge = 1e-3;          // Shorter edges align by chance: a choice [m].
constexpr std::size_t kMostEdgeFaces = 500;  // Of a part whose edges are looked at: a choice.

bool IsRound(const RelationSide& side) {
  return side.element == ElementKind::kCylinder || side.element == ElementKind::kSphere;
}

/** A feature of an occurrence, in W. */
struct Placed {
  RelationSide side;
  Vec3 p_W, axis_W;
  Box box_W;
  double area{0};
};

/** A straight edge of a part. */
struct Edge {
  RelationSide side;  // Without its occurrence.
  double half_length{0};
};

class RelationSearch {
 public:
  RelationSearch(const Product& product, WorkWatch* watch, const RelationLimits& limits)
      : product_(product),
        watch_(watch),
        limits_(limits),
        cos_angle_(std::cos(angle_limits_.angle)) {}

  std::vector<Relation> Run();
  void Report(Diagnostics* diagnostics) const;

 private:
  void RunPair(OccurrenceId a, OccurrenceId b);
  void Add(RelationKind kind, const RelationSide& a, const RelationSide& b, double magnitude);
  [[nodiscard]] std::vector<Placed> PlaceFeatures(OccurrenceId id);
  [[nodiscard]] static const Placed* FindMain(const std::vector<Placed>& features);
  void AddOrientation(const Placed& a, const Placed& b);
  void AddPlanes(const Placed& a, const Placed& b, double scale);
  void AddTangent(const Placed& a, const Placed& b, double scale);
  void AddNearestFacing(const std::vector<Placed>& of_a, const std::vector<Placed>& of_b,
                        double scale);
  void AddEdges(OccurrenceId a, OccurrenceId b, double scale);
  void AddHoles();
  const std::vector<Edge>& EdgesOf(PartId id);

  const Product& product_;
  WorkWatch* watch_;
  RelationLimits limits_;
  InferenceLimits angle_limits_;
  double cos_angle_;
  std::vector<Relation> relations_;
  std::size_t of_pair_{0};
  std::size_t left_out_{0};
  std::set<PartId> shortened_;  // Parts of which not all features or edges were looked at.
  std::map<PartId, std::vector<Edge>> edges_;
};

void RelationSearch::Add(RelationKind kind, const RelationSide& a, const RelationSide& b,
                         double magnitude) {
  if (of_pair_ >= limits_.per_pair || relations_.size() >= limits_.total) {
    ++left_out_;
    return;
  }
  ++of_pair_;
  Relation relation;
  relation.kind = kind;
  relation.a = a;
  relation.b = b;
  relation.magnitude = magnitude;
  Measure(product_, &relation);
  relations_.push_back(std::move(relation));
}

/** The largest features first. */
std::vector<Placed> RelationSearch::PlaceFeatures(OccurrenceId id) {
  const Part& part = product_.part_of(id);
  const product::Pose& X_WB = product_.occurrences[id.index()].X_WB;
  std::vector<Placed> placed;
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    const Feature& feature = part.features[i];
    if (product::IsCone(feature.kind)) {
      continue;
    }
    Placed item;
    item.side = MakeSide(product_, id, FeatureId(i));
    item.p_W = X_WB * item.side.origin_B;
    item.axis_W = X_WB.q() * item.side.axis_B;
    item.area = feature.area;
    Box box_B;
    for (const product::FaceId face : feature.faces) {
      box_B.Add(part.faces[face.index()].box_B);
    }
    item.box_W = Transform(X_WB, box_B);
    placed.push_back(std::move(item));
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.area > b.area; });
  if (placed.size() > limits_.features) {
    shortened_.insert(part.id);
    placed.resize(limits_.features);
  }
  return placed;
}

/** What gives a part its direction: its largest feature with an axis. */
const Placed* RelationSearch::FindMain(const std::vector<Placed>& features) {
  const auto found = std::find_if(features.begin(), features.end(), [](const Placed& item) {
    return item.side.element != ElementKind::kSphere;
  });
  return found == features.end() ? nullptr : &*found;
}

void RelationSearch::AddOrientation(const Placed& a, const Placed& b) {
  const double cosine = std::clamp(a.axis_W.dot(b.axis_W), -1.0, 1.0);
  const double sine = std::sin(angle_limits_.angle);
  if (std::abs(cosine) >= cos_angle_) {
    Add(RelationKind::kParallel, a.side, b.side, 0);
    const Vec3 d = b.p_W - a.p_W;
    const double distance = (d - a.axis_W.dot(d) * a.axis_W).norm();
    const bool are_axes =
        a.side.element == ElementKind::kCylinder && b.side.element == ElementKind::kCylinder;
    if (are_axes && distance > angle_limits_.axis_distance) {
      Add(RelationKind::kDistance, a.side, b.side, distance);
    }
  } else if (std::abs(cosine) <= sine) {
    Add(RelationKind::kPerpendicular, a.side, b.side, 0);
  } else {
    Add(RelationKind::kAngle, a.side, b.side, std::acos(cosine));
  }
}

/** Planes in one plane with their normals to the same side. */
void RelationSearch::AddPlanes(const Placed& a, const Placed& b, double scale) {
  const bool are_planes =
      a.side.element == ElementKind::kPlane && b.side.element == ElementKind::kPlane;
  if (are_planes && a.axis_W.dot(b.axis_W) >= cos_angle_ &&
      std::abs(a.axis_W.dot(b.p_W - a.p_W)) <= angle_limits_.plane_gap * scale) {
    Add(RelationKind::kFlush, a.side, b.side, 0);
  }
}

/** Round on flat, or round on round, where they touch within their extents. */
void RelationSearch::AddTangent(const Placed& a, const Placed& b, double scale) {
  if (!IsRound(a.side) && !IsRound(b.side)) {
    return;
  }
  Relation relation;
  relation.kind = RelationKind::kTangent;
  relation.a = a.side;
  relation.b = b.side;
  Measure(product_, &relation);
  // One within the other with equal radii is a mate, or a shaft with play in its hole.
  const bool is_inner = a.side.is_inward != b.side.is_inward;
  const bool is_seat = is_inner && a.side.element == b.side.element;
  if (!is_seat && !(a.side.is_inward && b.side.is_inward) &&
      !(a.side.is_inward && b.side.element == ElementKind::kPlane) &&
      !(b.side.is_inward && a.side.element == ElementKind::kPlane) &&
      relation.residual <= angle_limits_.plane_gap * scale) {
    Add(RelationKind::kTangent, a.side, b.side, 0);
  }
}

/** The facing planes that are nearest to each other without touching. */
void RelationSearch::AddNearestFacing(const std::vector<Placed>& of_a,
                                      const std::vector<Placed>& of_b, double scale) {
  std::optional<std::pair<const Placed*, const Placed*>> nearest;
  double least = 0;
  for (const Placed& a : of_a) {
    for (const Placed& b : of_b) {
      const bool face = a.side.element == ElementKind::kPlane &&
                        b.side.element == ElementKind::kPlane &&
                        a.axis_W.dot(b.axis_W) <= -cos_angle_;
      const double gap = face ? a.axis_W.dot(b.p_W - a.p_W) : 0;
      if (gap > angle_limits_.plane_gap * scale && (!nearest || gap < least) &&
          a.box_W.Expanded(gap * (1 + 1e-6)).Overlaps(b.box_W)) {
        nearest = {&a, &b};
        least = gap;
      }
    }
  }
  if (nearest) {
    Add(RelationKind::kDistance, nearest->first->side, nearest->second->side, least);
  }
}

/** The plane that each face of a part belongs to; invalid for other faces. */
std::vector<FeatureId> FindPlanes(const Part& part) {
  std::vector<FeatureId> plane_of(part.faces.size());
  for (std::size_t i = 0; i < part.features.size(); ++i) {
    if (part.features[i].kind == FeatureKind::kPlane) {
      for (const product::FaceId face : part.features[i].faces) {
        plane_of[face.index()] = FeatureId(i);
      }
    }
  }
  return plane_of;
}

/** Adds the straight convex edges of a face to planes of other faces with greater numbers. */
void AddEdgesOf(const Part& part, const product::FaceAdjacency& adjacency,
                const std::vector<FeatureId>& plane_of, std::size_t face,
                std::vector<Edge>* edges) {
  if (!plane_of[face].is_valid()) {
    return;
  }
  std::map<FeatureId, std::pair<Vec3, Vec3>> ends;  // By the plane behind the edge.
  const Feature& first = part.features[plane_of[face].index()];
  for (const product::FaceEdge& edge : adjacency.edges(product::FaceId(face))) {
    if (!edge.other.is_valid() || edge.sense != product::EdgeSense::kConvex ||
        !plane_of[edge.other.index()].is_valid() || edge.other.index() < face) {
      continue;
    }
    const FeatureId behind = plane_of[edge.other.index()];
    const Vec3 axis = first.axis_B.cross(part.features[behind.index()].axis_B).normalized();
    auto& [low, high] = ends.try_emplace(behind, edge.start, edge.start).first->second;
    for (const Vec3& p : {edge.start, edge.end}) {
      low = axis.dot(p) < axis.dot(low) ? p : low;
      high = axis.dot(p) > axis.dot(high) ? p : high;
    }
  }
  for (const auto& [other, span] : ends) {
    Edge edge;
    edge.half_length = 0.5 * (span.second - span.first).norm();
    edge.side.element = ElementKind::kEdge;
    edge.side.feature = plane_of[face];
    edge.side.second = other;
    edge.side.origin_B = 0.5 * (span.first + span.second);
    edge.side.axis_B = (span.second - span.first).normalized();
    if (2 * edge.half_length >= kLeastEdge) {
      edges->push_back(edge);
    }
  }
}

/** The straight edges between two planes of a part, longest first. */
const std::vector<Edge>& RelationSearch::EdgesOf(PartId id) {
  const auto [found, is_new] = edges_.try_emplace(id);
  std::vector<Edge>& edges = found->second;
  const Part& part = product_.parts[id.index()];
  if (!is_new) {
    return edges;
  }
  if (part.faces.size() > kMostEdgeFaces) {
    shortened_.insert(id);
    return edges;
  }
  const std::vector<FeatureId> plane_of = FindPlanes(part);
  const product::FaceAdjacency adjacency(part, kWeldTolerance);
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    AddEdgesOf(part, adjacency, plane_of, f, &edges);
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.half_length > b.half_length; });
  if (edges.size() > limits_.features) {
    shortened_.insert(id);
    edges.resize(limits_.features);
  }
  return edges;
}

/** Edges on one line that share some of it. */
void RelationSearch::AddEdges(OccurrenceId a, OccurrenceId b, double scale) {
  const product::Occurrence& of_a = product_.occurrences[a.index()];
  const product::Occurrence& of_b = product_.occurrences[b.index()];
  const std::vector<Edge>& edges_a = EdgesOf(of_a.part);
  const std::vector<Edge>& edges_b = EdgesOf(of_b.part);
  const double gap = angle_limits_.plane_gap * scale;
  for (const Edge& edge_a : edges_a) {
    const Vec3 p_W = of_a.X_WB * edge_a.side.origin_B;
    const Vec3 axis_W = of_a.X_WB.q() * edge_a.side.axis_B;
    for (const Edge& edge_b : edges_b) {
      const Vec3 d = of_b.X_WB * edge_b.side.origin_B - p_W;
      const double along = axis_W.dot(d);
      if (std::abs(axis_W.dot(of_b.X_WB.q() * edge_b.side.axis_B)) >= cos_angle_ &&
          (d - along * axis_W).norm() <= gap &&
          std::abs(along) < edge_a.half_length + edge_b.half_length - gap) {
        RelationSide side_a = edge_a.side;
        RelationSide side_b = edge_b.side;
        side_a.occurrence = a;
        side_b.occurrence = b;
        Add(RelationKind::kEdgeOnEdge, side_a, side_b, 0);
      }
    }
  }
}

void RelationSearch::RunPair(OccurrenceId a, OccurrenceId b) {
  of_pair_ = 0;
  const std::vector<Placed> of_a = PlaceFeatures(a);
  const std::vector<Placed> of_b = PlaceFeatures(b);
  const double size =
      std::min(product_.part_of(a).box_B.size().norm(), product_.part_of(b).box_B.size().norm());
  const double scale = CalcLengthScale(size);
  const Placed* main_a = FindMain(of_a);
  const Placed* main_b = FindMain(of_b);
  if (main_a != nullptr && main_b != nullptr) {
    AddOrientation(*main_a, *main_b);
  }
  for (const Placed& item_a : of_a) {
    for (const Placed& item_b : of_b) {
      if (item_a.box_W.Expanded(limits_.near).Overlaps(item_b.box_W)) {
        AddPlanes(item_a, item_b, scale);
        AddTangent(item_a, item_b, scale);
      }
    }
  }
  AddNearestFacing(of_a, of_b, scale);
  AddEdges(a, b, scale);
}

void RelationSearch::AddHoles() {
  for (const product::Alignment& alignment : product_.alignments) {
    of_pair_ = 0;
    Add(RelationKind::kHoleToHole, MakeSide(product_, alignment.a.occurrence, alignment.a.feature),
        MakeSide(product_, alignment.b.occurrence, alignment.b.feature), 0);
  }
}

std::vector<Relation> RelationSearch::Run() {
  relations_ = product_.relations;
  std::set<std::pair<OccurrenceId, OccurrenceId>> pairs;
  for (const product::Joint& joint : product_.joints) {
    pairs.insert(std::minmax(joint.a, joint.b));
  }
  std::vector<Box> boxes;
  for (const product::Occurrence& occurrence : product_.occurrences) {
    boxes.push_back(Transform(occurrence.X_WB, product_.part_of(occurrence.id).box_B));
  }
  spatial::ForEachPair(boxes, limits_.near, watch_, [&](std::size_t a, std::size_t b) {
    pairs.insert(std::pair(OccurrenceId(a), OccurrenceId(b)));
    return true;
  });
  AddHoles();
  for (const auto& [a, b] : pairs) {
    if (!MayGoOn(watch_)) {
      break;
    }
    RunPair(a, b);
  }
  return std::move(relations_);
}

void RelationSearch::Report(Diagnostics* diagnostics) const {
  if (left_out_ > 0) {
    diagnostics->Note("limit-relations", product_.source,
                      fmt::format("{} relations are left out: at most {} of two parts and {} of a "
                                  "product are listed",
                                  left_out_, limits_.per_pair, limits_.total));
  }
  for (const PartId id : shortened_) {
    diagnostics->Note("limit-relations", product_.parts[id.index()].name,
                      fmt::format("relations are looked for at the {} largest features of the "
                                  "part, and at its edges where it has at most {} faces",
                                  limits_.features, kMostEdgeFaces));
  }
}

}  // namespace

RelationSide MakeSide(const Product& product, OccurrenceId occurrence, FeatureId feature) {
  const Feature& from = product.part_of(occurrence).features[feature.index()];
  RelationSide side;
  side.occurrence = occurrence;
  side.feature = feature;
  side.element = from.kind == FeatureKind::kPlane ? ElementKind::kPlane
                 : product::IsSphere(from.kind)   ? ElementKind::kSphere
                                                  : ElementKind::kCylinder;
  side.origin_B = from.origin_B;
  side.axis_B = from.axis_B;
  side.radius = from.radius;
  side.is_inward = from.kind == FeatureKind::kHole || from.kind == FeatureKind::kSocket ||
                   from.kind == FeatureKind::kConeSeat;
  if (side.element == ElementKind::kCylinder) {
    side.origin_B += 0.5 * (from.span_low + from.span_high) * from.axis_B;
  }
  return side;
}

std::vector<Relation> ListRelations(const Product& product, Diagnostics* diagnostics,
                                    WorkWatch* watch, const RelationLimits& limits) {
  RelationSearch search(product, watch, limits);
  std::vector<Relation> relations = search.Run();
  search.Report(diagnostics);
  return relations;
}

}  // namespace hvas::mates
