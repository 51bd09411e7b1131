#include "mates/build_mate.h"

#include <algorithm>
#include <cmath>

namespace hvas::mates {
namespace {

using product::Feature;
using product::FeatureId;
using product::Mate;
using product::MateKind;
using product::Pose;
using product::Product;

const Feature& FeatureOf(const Product& product, const MateSide& side) {
  return product.part_of(side.occurrence).features[side.feature.index()];
}

void SetFrames(const MateSide& a, const Pose& X_WM, const MateSide& b, const Pose& X_WN,
               Mate* mate) {
  mate->a = {a.occurrence, a.feature, a.X_WB.Inverse() * X_WM};
  mate->b = {b.occurrence, b.feature, b.X_WB.Inverse() * X_WN};
}

/** Holes and shafts, seats and tapers: spans from the middle of what they share. */
void SetAxial(const Product& product, const MateSide& a, const MateSide& b, Mate* mate) {
  const Feature& hole = FeatureOf(product, a);
  const Feature& shaft = FeatureOf(product, b);
  const AxialSpans spans = CalcAxialSpans(hole, shaft, a.X_WB.Inverse() * b.X_WB);
  const double middle = 0.5 * (spans.low + spans.high);
  const Vec3 axis_W = a.X_WB.q() * hole.axis_B;
  const Pose X_WM(spatial::FrameFromZ(axis_W), a.X_WB * hole.origin_B + middle * axis_W);
  SetFrames(a, X_WM, b, X_WM, mate);
  mate->hole_low = spans.first_low - middle;
  mate->hole_high = spans.first_high - middle;
  mate->shaft_low = spans.second_low - middle;
  mate->shaft_high = spans.second_high - middle;
  mate->overlap = std::max(0.0, spans.length());
  if (mate->kind == MateKind::kConeSeat) {
    // Where the frames are: their difference is the play across the axis.
    mate->hole_radius = middle * std::tan(hole.half_angle);
    mate->shaft_radius = (middle - spans.shift) * std::tan(shaft.half_angle);
  } else {
    mate->hole_radius = hole.radius;
    mate->shaft_radius = shaft.radius;
  }
}

/** Mean direction from a socket's faces to its centre: the way out. */
Vec3 CalcOpening(const product::Part& part, const Feature& socket) {
  Vec3 sum = Vec3::Zero();
  for (const product::FaceId id : socket.faces) {
    const product::Face& face = part.faces[id.index()];
    for (std::uint32_t i = 0; i < face.triangle_count; ++i) {
      const auto& t = part.mesh.triangles[face.first_triangle + i];
      const Vec3& p = part.mesh.vertices[t[0]];
      const Vec3& q = part.mesh.vertices[t[1]];
      const Vec3& r = part.mesh.vertices[t[2]];
      const double area = 0.5 * (q - p).cross(r - p).norm();
      sum += area * (socket.origin_B - (p + q + r) / 3).normalized();
    }
  }
  const double least = 1e-3 * socket.area;
  return sum.norm() > least && sum.norm() > 0 ? Vec3(sum.normalized()) : socket.axis_B;
}

}  // namespace

AxialSpans CalcAxialSpans(const Feature& first, const Feature& second, const Pose& X_AB) {
  AxialSpans spans;
  const Vec3 second_axis = X_AB.q() * second.axis_B;
  const Vec3 second_origin = X_AB * second.origin_B;
  spans.sense = first.axis_B.dot(second_axis) < 0 ? -1.0 : 1.0;
  spans.shift = first.axis_B.dot(second_origin - first.origin_B);
  spans.first_low = first.span_low;
  spans.first_high = first.span_high;
  spans.second_low = spans.shift + (spans.sense > 0 ? second.span_low : -second.span_high);
  spans.second_high = spans.shift + (spans.sense > 0 ? second.span_high : -second.span_low);
  spans.low = std::max(spans.first_low, spans.second_low);
  spans.high = std::min(spans.first_high, spans.second_high);
  // Where they engage, not at whatever point of the axis the file gives as its origin.
  const Vec3 middle = first.origin_B + 0.5 * (spans.low + spans.high) * first.axis_B;
  spans.axis_distance = second_axis.cross(middle - second_origin).norm();
  return spans;
}

Mate BuildMate(const Product& product, MateKind kind, const MateSide& a, const MateSide& b) {
  Mate mate;
  mate.id = product::MateId(product.mates.size());
  mate.kind = kind;
  switch (kind) {
    case MateKind::kAxisHole:
    case MateKind::kConeSeat:
      SetAxial(product, a, b, &mate);
      break;
    case MateKind::kFaceFace:
      MoveFrames(product, a, b, a.X_WB * FeatureOf(product, a).origin_B, &mate);
      break;
    case MateKind::kSphereSeat: {
      const Feature& socket = FeatureOf(product, a);
      const Vec3 opening_B = CalcOpening(product.part_of(a.occurrence), socket);
      const Pose X_WM(spatial::FrameFromZ(a.X_WB.q() * opening_B), a.X_WB * socket.origin_B);
      SetFrames(a, X_WM, b, X_WM, &mate);
      mate.hole_radius = socket.radius;
      mate.shaft_radius = FeatureOf(product, b).radius;
      break;
    }
    case MateKind::kPrismatic:
      break;  // Of two planes on each side: JoinWalls().
  }
  return mate;
}

void MoveFrames(const Product& product, const MateSide& a, const MateSide& b, const Vec3& p_W,
                Mate* mate) {
  const Feature& plane = FeatureOf(product, a);
  const Vec3 nhat_W = a.X_WB.q() * plane.axis_B;
  const Vec3 origin_W = p_W - nhat_W.dot(p_W - a.X_WB * plane.origin_B) * nhat_W;
  const Quat q_WM = spatial::FrameFromZ(nhat_W);
  const Quat half_turn(0, 1, 0, 0);  // About x: z of the other side opposes this one's.
  SetFrames(a, Pose(q_WM, origin_W), b, Pose(q_WM * half_turn, origin_W), mate);
}

}  // namespace hvas::mates
