#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/query.h"

namespace hvas::contact {
namespace {

constexpr int kMaxSteps = 3;          // Slides over faces and edges to the lowest point: a choice.
constexpr double kWorthwhile = 2e-8;  // [m]; a slide that can gain less is left out.

// [m] by which the distances from a face's surface and from the shape differ, at most, where the
// face is the closest of the shape: rounding.
constexpr double kSame = 1e-9;

constexpr double kFaceReach = 3.0;   // In spacings.
constexpr double kEdgeReach = 1.5;   // Spacings, on edges: a choice.
constexpr double kMostSparse = 8.0;  // A slide may not lead anywhere.

double SparsityOf(const RawContact& contact) {
  return std::min(static_cast<double>(contact.sparsity), kMostSparse);
}

// A place of a sample, in its shape's frame.
struct State {
  Vec3 p{Vec3::Zero()};
  double distance{0};
  Vec3 gradient{Vec3::Zero()};    // Of the distance.
  std::array<Vec3, 2> normals{};  // Of the faces that it lies on.
  bool is_on_face{true};          // Not beyond the rim of a freeform face.
};

std::uint32_t OtherTriangle(const Shape::Data& shape, std::uint32_t triangle, std::uint32_t face) {
  return triangle != kNoFace && face != kNoFace ? shape.mesh.NeighbourOn(triangle, face) : kNoFace;
}

// The face, or the two faces at an edge, on which a sample may move.
class Track {
 public:
  Track(const Placed& sampled, const Shell& shell, std::uint32_t point, double sparsity)
      : shape_(*sampled.shape),
        offsets_(sampled.offsets),
        is_edge_(shell.faces[point].faces[1] != kNoFace),
        first_(shape_, offsets_, shell.faces[point].faces[0], shell.TriangleOf(point)),
        second_(shape_, offsets_, shell.faces[point].faces[1],
                OtherTriangle(shape_, shell.TriangleOf(point), shell.faces[point].faces[1])) {
    reach_ = shape_.spacing * (is_edge_ ? kEdgeReach * sparsity : kFaceReach * std::sqrt(sparsity));
    is_usable_ = shell.faces[point].faces[2] == kNoFace && first_.is_known() &&
                 (!is_edge_ || second_.is_known());
  }

  [[nodiscard]] bool is_usable() const { return is_usable_; }

  [[nodiscard]] bool is_freeform() const {
    return first_.is_freeform() || (is_edge_ && second_.is_freeform());
  }

  [[nodiscard]] double reach() const { return reach_; }

  // The part of the distance's gradient that lies along the track.
  [[nodiscard]] Vec3 GradientAlong(const State& at) const {
    if (!is_edge_) {
      return at.gradient - at.gradient.dot(at.normals[0]) * at.normals[0];
    }
    const Vec3 tangent = at.normals[0].cross(at.normals[1]);
    const double squared = tangent.squaredNorm();
    return squared > 0 ? Vec3(at.gradient.dot(tangent) / squared * tangent) : Vec3::Zero();
  }

  // The place that a contact is at, with the gradient of its distance.
  [[nodiscard]] State Begin(const RawContact& contact, const Vec3& gradient) {
    State start;
    start.p = contact.p;
    start.distance = contact.distance;
    start.gradient = gradient;
    FindNormals(&start);
    return start;
  }

  // Finds the normals of the faces at a place on them.
  void FindNormals(State* at) {
    at->normals[0] = first_.CalcDistance(at->p).gradient;
    if (is_edge_) {
      at->normals[1] = second_.CalcDistance(at->p).gradient;
    }
  }

  [[nodiscard]] bool Project(State* at) {
    if (is_edge_) {
      const Vec3 wanted = at->p;
      if (!ProjectOnEdge(first_, second_, wanted, &at->p)) {
        return false;
      }
      FindNormals(at);
      return true;
    }
    const auto exact = first_.CalcDistance(at->p);
    at->p -= exact.distance * exact.gradient;
    at->normals[0] = exact.gradient;
    at->is_on_face = first_.is_on_face();
    return exact.is_valid;
  }

  // True where the trimmed part of the track goes as far as a place.
  [[nodiscard]] bool Reaches(const State& at) const {
    if (!is_edge_ && first_.is_freeform()) {
      return at.is_on_face;
    }
    FaceFilter near;
    near.limit = 10 * kOnSurface;
    const Refined r = RefineAlone(shape_, offsets_, at.p, near);
    return r.is_exact && std::abs(r.distance) < kOnSurface;
  }

 private:
  const Shape::Data& shape_;
  const FaceOffsets* offsets_;
  bool is_edge_;
  FaceSurface first_;
  FaceSurface second_;
  double reach_{0};
  bool is_usable_{false};
};

// Two states downhill of one: a probe, and the bottom of the parabola that the slopes at both give,
// which is exact for shapes that curve evenly. Those that the track does not go to are infinitely
// far.
template <typename Evaluate>
std::array<State, 2> LookDownhill(const State& from, const Vec3& direction, double slope,
                                  double left, Track* track, Evaluate evaluate) {
  const auto look = [&](double length, State* out) {
    out->p = from.p + length * direction;
    const bool is_there = track->Project(out) && evaluate(out);
    out->distance = is_there ? out->distance : std::numeric_limits<double>::infinity();
    return is_there;
  };
  std::array<State, 2> states;
  auto& [probe, bottom] = states;
  const double first = 0.25 * left;
  double length = 0.1 * first;
  if (look(first, &probe)) {
    const double change = track->GradientAlong(probe).dot(direction) + slope;
    length = change > 0 ? std::min(first * slope / change, left) : left;
  }
  look(length, &bottom);
  return states;
}

// Steepest descent along the track with a secant step. `accept` is asked about each state that
// would be gone to; `is_barred` tells that it let none of a step's through.
template <typename Evaluate, typename Accept>
State Descend(const State& start, Track* track, Evaluate evaluate, Accept accept, bool* is_barred) {
  *is_barred = false;
  State best = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec3 downhill = -track->GradientAlong(best);
    const double slope = downhill.norm();
    const double left = track->reach() - (best.p - start.p).norm();
    if (slope * left < kWorthwhile) {
      break;
    }
    const double before = best.distance;
    const auto states = LookDownhill(best, downhill / slope, slope, left, track, evaluate);
    // The lower one where the track goes there, else the other.
    const std::size_t lower = states[1].distance < states[0].distance ? 1 : 0;
    for (const State* s : {&states[lower], &states[1 - lower]}) {
      if (!(s->distance < best.distance) || !track->Reaches(*s)) {
        continue;
      }
      *is_barred = !accept(*s);
      if (!*is_barred) {
        best = *s;
        break;
      }
    }
    if (best.distance > before - 1e-10) {
      break;
    }
  }
  return best;
}

}  // namespace

void Slide(const Placed& sampled, const Shell& shell, const Placed& field,
           RawContact* contact) noexcept {
  Track track(sampled, shell, contact->point, SparsityOf(*contact));
  if (!track.is_usable() || !contact->is_exact) {
    return;
  }
  const RelativePose X_FS(field, sampled);
  const std::uint32_t face = contact->is_reverse ? contact->held_face : contact->scene_face;
  const auto evaluate_to = [&](double limit, State* s) {
    FaceFilter near;
    near.limit = limit;
    const Refined r = RefineAlone(*field.shape, field.offsets, X_FS * s->p, near);
    s->distance = r.distance + contact->allowance;
    s->gradient = X_FS.R.transpose() * r.gradient;
    return r.is_exact && r.face == face;
  };
  const auto evaluate = [&](State* s) {
    return evaluate_to(std::numeric_limits<double>::infinity(), s);
  };
  const State start = track.Begin(*contact, X_FS.R.transpose() * contact->gradient);
  // With freeform faces the face's surface alone is asked on the way, and the whole shape where it
  // leads: a foot on a mesh takes long.
  FaceSurface surface(*field.shape, field.offsets, face, contact->triangle);
  const auto evaluate_surface = [&](State* s) {
    const spatial::SurfaceDistance found = surface.CalcDistance(X_FS * s->p);
    s->distance = found.distance + contact->allowance;
    s->gradient = X_FS.R.transpose() * found.gradient;
    return found.is_valid;
  };
  const auto is_of_shape = [&](const State& s) {
    State same = s;
    return evaluate_to(std::abs(s.distance - contact->allowance) + kSame, &same) &&
           std::abs(same.distance - s.distance) < kSame;
  };
  State met = start;
  State end = start;
  bool is_barred = true;
  const bool is_freeform = surface.is_freeform() || track.is_freeform();
  if (is_freeform && evaluate_surface(&met) && std::abs(met.distance - start.distance) < kSame) {
    end = Descend(start, &track, evaluate_surface, is_of_shape, &is_barred);
  }
  if (is_barred) {
    end = Descend(
        start, &track, evaluate, [](const State&) { return true; }, &is_barred);
  }
  contact->p = end.p;
  contact->distance = end.distance;
  contact->gradient = X_FS.R * end.gradient;
}

void SlideOnPlane(const Placed& sampled, const Shell& shell, const spatial::Surface& plane,
                  RawContact* contact) noexcept {
  Track track(sampled, shell, contact->point, SparsityOf(*contact));
  if (!track.is_usable()) {
    return;
  }
  const auto evaluate = [&](State* s) {
    s->distance = spatial::CalcDistance(plane, s->p).distance;
    s->gradient = plane.axis;
    return true;
  };
  const State start = track.Begin(*contact, plane.axis);
  bool is_barred = false;
  const State end = Descend(
      start, &track, evaluate, [](const State&) { return true; }, &is_barred);
  contact->p = end.p;
  contact->distance = end.distance;
}

}  // namespace hvas::contact
