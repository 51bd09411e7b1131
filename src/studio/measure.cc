#include "studio/measure.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "product/names.h"
#include "studio/event_json.h"

namespace hvas::studio {
namespace {

using spatial::Surface;
using spatial::SurfaceKind;

constexpr double kParallel = 1e-4;  // sine of the angle below which axes count as parallel

struct Measured {
  const product::Face* face{nullptr};
  Surface surface_W;
};

Result<Measured> FindFace(const simulation::Model& model, const LiveState& state,
                          const PickedFace& pick) {
  if (pick.occurrence.index() >= state.parts.size()) {
    return Fail(ErrorCode::kNotFound, "there is no such part",
                fmt::format("o{}", pick.occurrence.value()), "");
  }
  const product::Part& part = model.product->part_of(pick.occurrence);
  if (pick.face.index() >= part.faces.size()) {
    return Fail(
        ErrorCode::kNotFound,
        fmt::format("the part has {} faces, and no face {}", part.faces.size(), pick.face.value()),
        part.name, "");
  }
  const product::Face& face = part.faces[pick.face.index()];
  return Measured{&face,
                  spatial::Transform(state.parts[pick.occurrence.index()].X_WB, face.surface)};
}

bool HasAxis(SurfaceKind kind) {
  return kind != SurfaceKind::kSphere && kind != SurfaceKind::kFreeform;
}

bool IsRound(SurfaceKind kind) {
  return kind == SurfaceKind::kCylinder || kind == SurfaceKind::kSphere;
}

void Describe(const Measured& measured, Json* json) {
  (*json)["kind"] = ToString(measured.surface_W.kind);
  (*json)["area_mm2"] = 1e6 * measured.face->area;
  std::string text =
      fmt::format("{}, {:.2f} mm2", ToString(measured.surface_W.kind), 1e6 * measured.face->area);
  if (IsRound(measured.surface_W.kind)) {
    (*json)["radius_mm"] = units::ToMm(measured.surface_W.radius);
    text += fmt::format(", diameter {:.4f} mm", 2 * units::ToMm(measured.surface_W.radius));
  }
  (*json)["text"] = text;
  (*json)["p_m"] = Json::array({ToJson(measured.surface_W.origin)});
}

/** Foot points of the shortest distance between two surfaces. */
struct Span {
  Vec3 p_a, p_b;
};

/** Calculates the span from the plane a to a point of b. */
Span CalcSpanToPlane(const Surface& plane, const Vec3& p_b) {
  const Vec3 p_a = p_b - plane.axis.dot(p_b - plane.origin) * plane.axis;
  return {p_a, p_b};
}

/** Calculates the span from the axis a to a point of b. */
Span CalcSpanToAxis(const Surface& round, const Vec3& p_b) {
  return {round.origin + round.axis.dot(p_b - round.origin) * round.axis, p_b};
}

/** Calculates the span between two axes. @pre they are not parallel. */
Span CalcSpanOfAxes(const Surface& a, const Surface& b) {
  const Vec3 r = b.origin - a.origin;
  const double cosine = a.axis.dot(b.axis);
  const double sine_sq = 1 - cosine * cosine;
  const double along_a = (a.axis.dot(r) - cosine * b.axis.dot(r)) / sine_sq;
  const double along_b = (cosine * a.axis.dot(r) - b.axis.dot(r)) / sine_sq;
  return {a.origin + along_a * a.axis, b.origin + along_b * b.axis};
}

/** Finds the span between two surfaces; none where they intersect, like planes at an angle. */
std::optional<Span> FindSpan(const Surface& a, const Surface& b) {
  const bool is_plane_a = a.kind == SurfaceKind::kPlane;
  const bool is_plane_b = b.kind == SurfaceKind::kPlane;
  const double sine = HasAxis(a.kind) && HasAxis(b.kind) ? a.axis.cross(b.axis).norm() : 0;
  if (is_plane_a && is_plane_b) {
    return sine < kParallel ? std::optional(CalcSpanToPlane(a, b.origin)) : std::nullopt;
  }
  if (is_plane_a || is_plane_b) {
    const Surface& plane = is_plane_a ? a : b;
    const Surface& other = is_plane_a ? b : a;
    const bool meets = HasAxis(other.kind) && std::abs(plane.axis.dot(other.axis)) > kParallel;
    return meets ? std::nullopt : std::optional(CalcSpanToPlane(plane, other.origin));
  }
  if (!HasAxis(a.kind) || !HasAxis(b.kind)) {
    return HasAxis(a.kind)
               ? CalcSpanToAxis(a, b.origin)
               : (HasAxis(b.kind) ? CalcSpanToAxis(b, a.origin) : Span{a.origin, b.origin});
  }
  return sine < kParallel ? CalcSpanToAxis(a, b.origin) : CalcSpanOfAxes(a, b);
}

void Compare(const Measured& a, const Measured& b, Json* json) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;  // Degrees in a radian.
  (*json)["kind"] = fmt::format("{} to {}", ToString(a.surface_W.kind), ToString(b.surface_W.kind));
  std::string text;
  if (HasAxis(a.surface_W.kind) && HasAxis(b.surface_W.kind)) {
    const double cosine = std::abs(a.surface_W.axis.dot(b.surface_W.axis));
    const double angle_deg =
        kDegrees * std::atan2(a.surface_W.axis.cross(b.surface_W.axis).norm(), cosine);
    (*json)["angle_deg"] = angle_deg;
    text = fmt::format("angle {:.4f} deg", angle_deg);
  }
  if (const auto span = FindSpan(a.surface_W, b.surface_W)) {
    const double distance_mm = units::ToMm((span->p_a - span->p_b).norm());
    (*json)["distance_mm"] = distance_mm;
    (*json)["p_m"] = Json::array({ToJson(span->p_a), ToJson(span->p_b)});
    text = fmt::format("distance {:.4f} mm{}{}", distance_mm, text.empty() ? "" : ", ", text);
  }
  (*json)["text"] = text.empty() ? "there is nothing to measure between these surfaces" : text;
}

}  // namespace

Result<Json> Measure(const simulation::Model& model, const LiveState& state, const PickedFace& a,
                     const std::optional<PickedFace>& b) {
  const auto first = FindFace(model, state, a);
  if (!first) {
    return Unexpected(first.error());
  }
  Json json;
  if (!b) {
    Describe(*first, &json);
    return json;
  }
  const auto second = FindFace(model, state, *b);
  if (!second) {
    return Unexpected(second.error());
  }
  Compare(*first, *second, &json);
  return json;
}

}  // namespace hvas::studio
