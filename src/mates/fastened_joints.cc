#include "mates/fastened_joints.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "mates/fasteners.h"
#include "mates/judge.h"
#include "mates/resolve.h"

namespace hvas::mates {
namespace {

using product::Joint;
using product::Mate;
using product::MateId;
using product::MateKind;
using product::OccurrenceId;
using product::Product;

constexpr double kParallelAxes = 2e-3;  // [rad]: a tenth of a degree, as in mates.md, section 1.
constexpr double kOneAxis = 20e-6;      // [m]: of two shafts of one fastener, as there.
constexpr double kCircle = 0.1e-3;      // [m]: by which holes of a drawn circle are off. A choice.

using PartPair = std::pair<OccurrenceId, OccurrenceId>;

/** A hole that a fastener is in, placed on the fastener's axis: the holes may be off it. */
struct Hole {
  OccurrenceId part;
  const Mate* mate;
  Vec3 p_W, axis_W;
  double offset{0};  // How far the hole's axis is off [m].
  double at{0};      // Middle of the hole along the axis of the first one [m].
};

Hole MakeHole(const Product& product, const Mate& mate) {
  const product::Connector& shaft = mate.b;
  const product::Feature& feature =
      product.part_of(shaft.occurrence).features[shaft.feature.index()];
  const Pose& X_WB = product.occurrences[shaft.occurrence.index()].X_WB;
  const Vec3 p_B =
      feature.origin_B + feature.axis_B.dot(shaft.X_BM.p() - feature.origin_B) * feature.axis_B;
  return {mate.a.occurrence,         &mate, X_WB * p_B, X_WB.q() * feature.axis_B,
          CalcOffset(product, mate), 0};
}

Pose PlaceHole(const Product& product, const Mate& mate) {
  return product.occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
}

/** Fasteners of one direction between two parts. */
struct Group {
  OccurrenceId a, b;
  Vec3 axis_W;
  std::vector<OccurrenceId> fasteners;
  std::vector<Vec3> points_W;
  double diameter{0};
  double offset{0};
};

void Add(const Hole& low, const Hole& high, std::map<PartPair, std::vector<Group>>* groups) {
  const auto [a, b] = std::minmax(low.part, high.part);
  std::vector<Group>& of_pair = (*groups)[{a, b}];
  auto group = std::find_if(of_pair.begin(), of_pair.end(), [&](const Group& g) {
    return g.axis_W.cross(low.axis_W).norm() < kParallelAxes;
  });
  if (group == of_pair.end()) {
    of_pair.push_back({a, b, low.axis_W, {}, {}, 0, 0});
    group = std::prev(of_pair.end());
  }
  group->fasteners.push_back(low.mate->b.occurrence);
  group->points_W.push_back(low.p_W);
  group->diameter = std::max(group->diameter, 2 * low.mate->shaft_radius);
  group->offset = std::max({group->offset, low.offset, high.offset});
}

/** Takes the holes that one fastener is in by axes, and joins those that follow each other. */
void JoinAlong(std::vector<Hole> holes, std::map<PartPair, std::vector<Group>>* groups) {
  while (!holes.empty()) {
    const Hole first = holes.front();
    const auto others = std::stable_partition(holes.begin(), holes.end(), [&](const Hole& hole) {
      return first.axis_W.cross(hole.axis_W).norm() < kParallelAxes &&
             first.axis_W.cross(hole.p_W - first.p_W).norm() < kOneAxis;
    });
    std::vector<Hole> line(holes.begin(), others);
    holes.erase(holes.begin(), others);
    for (Hole& hole : line) {
      hole.at = first.axis_W.dot(hole.p_W - first.p_W);
    }
    std::stable_sort(line.begin(), line.end(),
                     [](const Hole& s, const Hole& t) { return s.at < t.at; });
    for (std::size_t i = 1; i < line.size(); ++i) {
      if (line[i - 1].part != line[i].part) {
        Add(line[i - 1], line[i], groups);
      }
    }
  }
}

/** The joint of two parts; null where they have no mate. Joints are in the order of the pairs. */
const Joint* FindJoint(const Product& product, OccurrenceId a, OccurrenceId b) {
  const auto found = std::lower_bound(
      product.joints.begin(), product.joints.end(), PartPair(a, b),
      [](const Joint& joint, const PartPair& pair) { return PartPair(joint.a, joint.b) < pair; });
  return found != product.joints.end() && found->a == a && found->b == b ? &*found : nullptr;
}

std::optional<MateId> FindPilot(const Product& product, const Joint* joint, const Group& group) {
  if (joint == nullptr) {
    return std::nullopt;
  }
  const auto found = std::find_if(joint->mates.begin(), joint->mates.end(), [&](MateId id) {
    const Mate& mate = product.mates[id.index()];
    return mate.kind == MateKind::kAxisHole &&
           (PlaceHole(product, mate).q() * Vec3::UnitZ()).cross(group.axis_W).norm() <
               kParallelAxes;
  });
  return found == joint->mates.end() ? std::nullopt : std::optional(*found);
}

/** The circle about a point of the axis that all fasteners are on; 0 where there is none. */
double CalcCircle(const Group& group, const Vec3& centre_W) {
  double least = 0;
  double most = 0;
  for (const Vec3& p_W : group.points_W) {
    const double distance = group.axis_W.cross(p_W - centre_W).norm();
    least = &p_W == group.points_W.data() ? distance : std::min(least, distance);
    most = std::max(most, distance);
  }
  return group.points_W.size() > 1 && most - least < kCircle ? least + most : 0;
}

FastenedJoint MakeJoint(const Product& product, const Group& group) {
  FastenedJoint fastened;
  fastened.a = group.a;
  fastened.b = group.b;
  fastened.fasteners = group.fasteners;
  fastened.diameter = group.diameter;
  fastened.offset = group.offset;
  const Joint* const joint = FindJoint(product, group.a, group.b);
  fastened.pilot = FindPilot(product, joint, group);
  Vec3 centre_W = Vec3::Zero();
  for (const Vec3& p_W : group.points_W) {
    centre_W += p_W / static_cast<double>(group.points_W.size());
  }
  if (fastened.pilot) {
    centre_W = PlaceHole(product, product.mates[fastened.pilot->index()]).p();
  }
  fastened.circle_diameter = CalcCircle(group, centre_W);
  const Pose& X_WA = product.occurrences[group.a.index()].X_WB;
  const Pose& X_WB = product.occurrences[group.b.index()].X_WB;
  std::vector<MateConstraint> constraints;
  if (joint != nullptr) {
    for (const MateId id : joint->mates) {
      constraints.push_back(MakeConstraint(product.mates[id.index()], group.b, X_WA));
    }
  }
  for (const Vec3& p_W : group.points_W) {
    const Pose X_WM(spatial::FrameFromZ(group.axis_W), p_W);
    constraints.push_back({MateKind::kAxisHole, X_WM, X_WB.Inverse() * X_WM});
  }
  const FreeTwists free = CalcFreeTwists(constraints, X_WB);
  fastened.free_translations = free.translations;
  fastened.free_rotations = free.rotations;
  return fastened;
}

}  // namespace

std::vector<FastenedJoint> FindFastenedJoints(const Product& product) {
  const std::vector<FastenerKind> kinds = ClassifyOccurrences(product);
  std::map<OccurrenceId, std::vector<Hole>> holes_of;
  for (const Mate& mate : product.mates) {
    if (mate.kind == MateKind::kAxisHole &&
        kinds[mate.a.occurrence.index()] != FastenerKind::kNut) {
      holes_of[mate.b.occurrence].push_back(MakeHole(product, mate));
    }
  }
  std::map<PartPair, std::vector<Group>> groups;
  for (const auto& [fastener, holes] : holes_of) {
    JoinAlong(holes, &groups);
  }
  std::vector<FastenedJoint> joints;
  for (const auto& [pair, of_pair] : groups) {
    for (const Group& group : of_pair) {
      if (group.fasteners.size() > 1 ||
          kinds[group.fasteners.front().index()] == FastenerKind::kScrew) {
        joints.push_back(MakeJoint(product, group));
      }
    }
  }
  return joints;
}

}  // namespace hvas::mates
