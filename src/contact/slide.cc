#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/query.h"

namespace hvas::contact {
namespace {

constexpr int kMaxSteps = 3;          // Slides over faces and edges to the lowest point: a choice.
constexpr double kWorthwhile = 2e-8;  // [m]; a slide that can gain less is left out.

constexpr double kFaceReach = 3.0;   // In spacings.
constexpr double kEdgeReach = 1.5;   // Spacings, on edges: a choice.
constexpr double kMostSparse = 8.0;  // A slide may not lead anywhere.

double SparsityOf(const RawContact& contact) {
  return std::min(static_cast<double>(contact.sparsity), kMostSparse);
}

// The face, or the two faces at an edge, on which a sample may move.
class Track {
 public:
  Track(const Placed& sampled, const SampleFaces& sample, double sparsity)
      : shape_(*sampled.shape), offsets_(sampled.offsets), faces_(sample.faces) {
    const auto& faces = sample.faces;
    reach_ = shape_.spacing *
             (faces[1] == kNoFace ? kFaceReach * std::sqrt(sparsity) : kEdgeReach * sparsity);
    is_usable_ =
        faces[2] == kNoFace && IsExact(faces[0]) && (faces[1] == kNoFace || IsExact(faces[1]));
  }

  [[nodiscard]] bool is_usable() const { return is_usable_; }

  [[nodiscard]] double reach() const { return reach_; }

  // The part of a direction that lies along the track at p.
  [[nodiscard]] Vec3 Along(const Vec3& p, const Vec3& direction) const {
    const Vec3 n = Surface(0).CalcDistance(p).gradient;
    if (faces_[1] == kNoFace) {
      return direction - direction.dot(n) * n;
    }
    const Vec3 tangent = n.cross(Surface(1).CalcDistance(p).gradient);
    const double squared = tangent.squaredNorm();
    return squared > 0 ? Vec3(direction.dot(tangent) / squared * tangent) : Vec3::Zero();
  }

  [[nodiscard]] bool Project(Vec3* p) const {
    if (faces_[1] != kNoFace) {
      const Vec3 wanted = *p;
      return ProjectOnEdge(Surface(0), Surface(1), wanted, p);
    }
    const auto exact = Surface(0).CalcDistance(*p);
    *p -= exact.distance * exact.gradient;
    return exact.is_valid;
  }

  // True where the trimmed part of the track goes as far as p.
  [[nodiscard]] bool Reaches(const Vec3& p) const {
    FaceFilter near;
    near.limit = 10 * kOnSurface;
    const Refined r = RefineAlone(shape_, offsets_, p, near);
    return r.is_exact && std::abs(r.distance) < kOnSurface;
  }

 private:
  [[nodiscard]] FaceSurface Surface(std::size_t i) const { return {shape_, offsets_, faces_[i]}; }

  [[nodiscard]] bool IsExact(std::uint32_t f) const {
    return shape_.exact.faces[f].kind != spatial::SurfaceKind::kFreeform;
  }

  const Shape::Data& shape_;
  const FaceOffsets* offsets_;
  const std::array<std::uint32_t, kMaxPointFaces>& faces_;
  double reach_{0};
  bool is_usable_{false};
};

struct State {
  Vec3 p;
  double distance;
  Vec3 gradient;  // In the sampled shape's frame.
};

// Steepest descent along the track with a secant step: the slope at two points gives the bottom of
// the parabola through them, which is exact for shapes that curve evenly.
template <typename Evaluate>
State Descend(const Track& track, const State& start, Evaluate evaluate) {
  State best = start;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Vec3 downhill = -track.Along(best.p, best.gradient);
    const double slope = downhill.norm();
    const double left = track.reach() - (best.p - start.p).norm();
    if (slope * left < kWorthwhile) {
      break;
    }
    const Vec3 direction = downhill / slope;
    const State from = best;
    const auto look = [&](double length, State* out) {
      out->p = from.p + length * direction;
      return track.Project(&out->p) && evaluate(out);
    };
    State probe;
    const double first = 0.25 * left;
    double length = first;
    if (look(first, &probe)) {
      const double change = track.Along(probe.p, probe.gradient).dot(direction) + slope;
      length = change > 0 ? std::min(first * slope / change, left) : left;
    } else {
      probe.distance = std::numeric_limits<double>::infinity();
      length = 0.1 * first;
    }
    State bottom;
    if (!look(length, &bottom)) {
      bottom.distance = std::numeric_limits<double>::infinity();
    }
    // The lower one where the track goes there, else the other.
    const State* const lower = bottom.distance < probe.distance ? &bottom : &probe;
    const State* const other = lower == &bottom ? &probe : &bottom;
    for (const State* s : {lower, other}) {
      if (s->distance < best.distance && track.Reaches(s->p)) {
        best = *s;
        break;
      }
    }
    if (best.distance > from.distance - 1e-10) {
      break;
    }
  }
  return best;
}

}  // namespace

void Slide(const Placed& sampled, const Shell& shell, const Placed& field,
           RawContact* contact) noexcept {
  const Track track(sampled, shell.faces[contact->point], SparsityOf(*contact));
  if (!track.is_usable() || !contact->is_exact) {
    return;
  }
  const RelativePose X_FS(field, sampled);
  const std::uint32_t face = contact->is_reverse ? contact->held_face : contact->scene_face;
  const auto evaluate = [&](State* s) {
    const Refined r = RefineAlone(*field.shape, field.offsets, X_FS * s->p, {});
    s->distance = r.distance + contact->allowance;
    s->gradient = X_FS.R.transpose() * r.gradient;
    return r.is_exact && r.face == face;
  };
  const State end = Descend(
      track, {contact->p, contact->distance, X_FS.R.transpose() * contact->gradient}, evaluate);
  contact->p = end.p;
  contact->distance = end.distance;
  contact->gradient = X_FS.R * end.gradient;
}

void SlideOnPlane(const Placed& sampled, const Shell& shell, const spatial::Surface& plane,
                  RawContact* contact) noexcept {
  const Track track(sampled, shell.faces[contact->point], SparsityOf(*contact));
  if (!track.is_usable()) {
    return;
  }
  const auto evaluate = [&](State* s) {
    s->distance = spatial::CalcDistance(plane, s->p).distance;
    s->gradient = plane.axis;
    return true;
  };
  const State end = Descend(track, {contact->p, contact->distance, plane.axis}, evaluate);
  contact->p = end.p;
  contact->distance = end.distance;
}

}  // namespace hvas::contact
