#include "contact/query.h"

#include <algorithm>

namespace hvas::contact {
namespace {

constexpr std::size_t kMaxPairsPerBody = 8;  // Bits of a face mask; further pairs share the last.
const std::uint32_t kGroundBody = BodyId{}.value();

std::uint8_t BitsOf(const SampleFaces& sample, const std::vector<std::uint8_t>& mask) {
  std::uint8_t bits = 0;
  for (const std::uint32_t f : sample.faces) {
    if (f != kNoFace) {
      bits = static_cast<std::uint8_t>(bits | mask[f]);
    }
  }
  return bits;
}

// Whether `direction` leads along a sample's edge, or at a corner where none of its faces looks: what
// lies there is met by the edge's end or by other samples, while this one slides past it.
bool IsAlongEdge(const SampleFaces& sample, const Vec3& direction, double best) {
  constexpr double kAlong = 0.8;
  constexpr double kAway = 0.05;
  if (sample.faces[1] == kNoFace) {
    return false;
  }
  if (sample.faces[2] != kNoFace) {
    return best < kAway;
  }
  const Vec3 tangent = sample.normal(0).cross(sample.normal(1));
  const double along = tangent.dot(direction);
  return along * along > kAlong * kAlong * tangent.squaredNorm();
}

// Whether a sample can be where its part touches something in `direction`, seen from the part, and
// which of its faces does. A side wall that happens to be near another part's top face cannot:
// moving along the wall it would never meet it.
bool Faces(const SampleFaces& sample, float limit, const Vec3& direction, std::uint32_t* face) {
  *face = sample.faces[0];
  double best = -2;
  for (std::size_t i = 0; i < kMaxPointFaces && sample.faces[i] != kNoFace; ++i) {
    const double cosine = sample.normal(i).dot(direction);
    if (cosine > best) {
      best = cosine;
      *face = sample.faces[i];
    }
    const bool is_corner = sample.faces[2] != kNoFace;  // May be hollow on one side.
    if (cosine < static_cast<double>(limit) && !is_corner) {
      return false;
    }
  }
  return best > static_cast<double>(limit) && !IsAlongEdge(sample, direction, best);
}

}  // namespace

void QueryWorkspace::Data::Clear() noexcept {
  reducer.Clear();
  layer = {};
  contact_count = 0;
  stats = {};
  deepest = std::numeric_limits<double>::infinity();
}

FloatPose RelativePose::Single() const {
  FloatPose out{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      out.R[3 * i + j] = static_cast<float>(R(i, j));
    }
    out.p[i] = static_cast<float>(p[i]);
  }
  return out;
}

void BodyQuery::Body(BodyId id, const Placed& scene) noexcept {
  if (is_stopped_ || !BoxesTouch(RelativePose(scene, held_), scene)) {
    return;
  }
  ++work_->stats.bodies_tested;
  const bool has_ignored = SetMasks(id, 0xff);
  Samples<false>(held_, held_.shape->shell, scene, has_ignored, id.value());
  Samples<true>(scene, scene.shape->features, held_, has_ignored, id.value());
  work_->layer.Add(layer_, scene.R_WC, scene.p_WC);
  layer_ = {};
  if (has_ignored) {
    SetMasks(id, 0);
  }
}

bool BodyQuery::BoxesTouch(const RelativePose& X_SH, const Placed& scene) const noexcept {
  const Vec3 half_S = scene.half() + Vec3::Constant(margin_);
  const Vec3 half_H = held_.half();
  const Mat3 turn = X_SH.R.cwiseAbs();
  const Vec3 reach_S = half_S + turn * half_H;
  const Vec3 reach_H = half_H + turn.transpose() * half_S;
  const Vec3 p_H = X_SH.R.transpose() * X_SH.p;
  return (X_SH.p.cwiseAbs().array() <= reach_S.array()).all() &&
         (p_H.cwiseAbs().array() <= reach_H.array()).all();
}

// Marks (keep = 0xff) or clears (keep = 0) the faces of this body's ignored pairs.
bool BodyQuery::SetMasks(BodyId id, std::uint8_t keep) noexcept {
  std::size_t pair = 0;
  for (const IgnoredPair& ignored : options_.ignored) {
    if (ignored.body != id) {
      continue;
    }
    const auto bit =
        static_cast<std::uint8_t>(1U << std::min<std::size_t>(pair++, kMaxPairsPerBody - 1));
    const auto mark = [&](std::span<const std::uint32_t> faces, std::vector<std::uint8_t>* mask) {
      for (const std::uint32_t f : faces) {
        if (f < kMaxQueryFaces) {
          (*mask)[f] = static_cast<std::uint8_t>(((*mask)[f] | bit) & keep);
        }
      }
    };
    mark(ignored.held_faces, &work_->held_mask);
    mark(ignored.scene_faces, &work_->scene_mask);
  }
  return pair > 0;
}

template <bool kIsReverse>
void BodyQuery::Samples(const Placed& sampled, const Shell& shell, const Placed& field,
                        bool has_ignored, std::uint32_t body) noexcept {
  if (is_stopped_) {
    return;
  }
  const RelativePose X(field, sampled);
  const Mat3 R_back = -X.R.transpose();
  HitBuffer hits;
  hits.hits = work_->hits.data();
  hits.capacity = static_cast<std::uint32_t>(work_->hits.size());
  // Room for the rounding of single precision coordinates.
  const double rounding = 4e-7 * (X.p.norm() + sampled.half().norm() + field.half().norm());
  const double reach = margin_ + rounding + sampled.growth() + field.growth();
  traverse_(shell.view, field.shape->field.view, X.Single(), static_cast<float>(reach), &hits);
  work_->stats.points_tested += hits.points_tested;
  work_->stats.is_truncated = work_->stats.is_truncated || hits.is_truncated;

  const std::vector<std::uint8_t>& own_mask = kIsReverse ? work_->scene_mask : work_->held_mask;
  const std::vector<std::uint8_t>& other_mask = kIsReverse ? work_->held_mask : work_->scene_mask;
  // So deep that something is wrong whatever way the sample looks.
  const double deep = -0.5 * sampled.shape->spacing;
  RawContact contact;
  contact.body = body;
  contact.is_reverse = kIsReverse;
  for (std::uint32_t i = 0; i < hits.count && !is_stopped_; ++i) {
    const Hit& hit = hits.hits[i];
    contact.p = sampled.Sample(shell, hit.point);
    const SampleFaces& faces = shell.faces[hit.point];
    const Vec3 p_F = X * contact.p;
    FaceFilter filter;
    if (has_ignored) {
      filter = {other_mask.data(), BitsOf(faces, own_mask)};
    }
    const Refined r = RefineActual(*field.shape, field.offsets, p_F, hit, filter);
    if (!r.is_valid || r.distance >= margin_) {
      continue;
    }
    const Vec3 towards = R_back * r.gradient;  // In the sampled shape's frame.
    std::uint32_t own_face = kNoFace;
    // An edge is met by its own samples: they know its direction, a face's samples would guess it.
    const bool is_face_at_edge = faces.faces[1] == kNoFace && r.other_face != kNoFace;
    if (is_face_at_edge && r.distance > deep) {
      continue;
    }
    if (!Faces(faces, shell.facing[hit.point], towards, &own_face) && r.distance > deep) {
      continue;
    }
    contact.distance = r.distance;
    contact.gradient = r.gradient;
    contact.is_exact = r.is_exact;
    contact.point = hit.point;
    contact.held_face = kIsReverse ? r.face : own_face;
    contact.scene_face = kIsReverse ? own_face : r.face;
    if constexpr (kIsReverse) {
      Add(contact, faces, towards, contact.p);
    } else {
      Add(contact, faces, r.gradient, p_F);
    }
  }
}

void BodyQuery::Ground(double z_W) noexcept {
  const Shell& shell = held_.shape->shell;
  if (shell.nodes.empty() || is_stopped_) {
    return;
  }
  std::array<std::int32_t, 256> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  const Vec3 up_H = held_.R_WC.row(2);
  const double limit = z_W + margin_ + held_.growth() - held_.p_WC.z();
  while (size > 0 && !is_stopped_) {
    const SphereNode& node = shell.nodes[static_cast<std::size_t>(stack[--size])];
    for (int k = 0; k < 8; ++k) {
      const Vec3 centre(static_cast<double>(node.x[k]), static_cast<double>(node.y[k]),
                        static_cast<double>(node.z[k]));
      if (node.child[k] == -1 || up_H.dot(centre) - static_cast<double>(node.radius[k]) >= limit) {
        continue;
      }
      if (node.child[k] < -1) {
        GroundLeaf(z_W, static_cast<std::size_t>(-2 - node.child[k]));
      } else if (size < stack.size()) {
        stack[size++] = node.child[k];
      } else {
        work_->stats.is_truncated = true;
      }
    }
  }
  work_->layer.Add(layer_, Mat3::Identity(), Vec3::Zero());
  layer_ = {};
}

void BodyQuery::GroundLeaf(double z_W, std::size_t leaf) noexcept {
  const Shell& shell = held_.shape->shell;
  work_->stats.points_tested += shell.leaf_count[leaf];
  RawContact contact;
  contact.body = kGroundBody;
  contact.scene_face = kNoFace;
  contact.is_exact = true;
  contact.gradient = Vec3::UnitZ();
  for (std::uint32_t i = 0; i < shell.leaf_count[leaf] && !is_stopped_; ++i) {
    contact.point = static_cast<std::uint32_t>(8 * leaf) + i;
    contact.p = held_.Sample(shell, contact.point);
    const Vec3 p_W = held_.R_WC * contact.p + held_.p_WC;
    contact.distance = p_W.z() - z_W;
    if (contact.distance < margin_) {
      Faces(shell.faces[contact.point], -1.0F, -held_.R_WC.row(2).transpose(), &contact.held_face);
      Add(contact, shell.faces[contact.point], Vec3::UnitZ(), p_W);
    }
  }
}

void BodyQuery::Add(const RawContact& contact, const SampleFaces& faces, const Vec3& nhat_S,
                    const Vec3& p_S) noexcept {
  work_->reducer.Add(contact, nhat_S, p_S);
  if (contact.distance < 0) {
    const bool is_inside_face = faces.faces[1] == kNoFace;
    const double area = is_inside_face ? ContactLayer::kFaceArea : ContactLayer::kEdgeArea;
    layer_.Add(area, -contact.distance, nhat_S, p_S);
  }
  is_stopped_ = contact.distance < stop_distance_;
}

}  // namespace hvas::contact
