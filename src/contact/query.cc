#include "contact/query.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hvas::contact {
namespace {

const std::uint32_t kGroundBody = BodyId{}.value();  // An invalid id: Contact::body.
// Points of a leaf beside threads that are deep in one another, whose flanks bear what there is to
// bear. A choice.
constexpr std::uint32_t kBesideThread = 2;
constexpr double kScreened = 0.2e-6;  // [m]; what single precision may be wrong by.
// Hits that one test does not decide go through the triangles of a list. For each point of the
// budget there may be so many triangles; a hit takes as long as some in any case, faces as made are
// looked for in a list three times, and of a list without names of faces more is looked at. Of each
// pair some hits may, so that none is left out. docs/algorithms/contact.md says what comes of it.
constexpr double kTrianglesPerPoint = 10;
constexpr double kTrianglesPerHit = 8;
constexpr double kScansAsMade = 3;
constexpr double kScansUnnamed = 2;
constexpr double kLeastHits = 16;
// [m] beyond the margin in which samples are looked for, to remember how far they are. A choice.
constexpr double kLookedBeyond = 0.1e-3;
// [m] by which two lists may answer differently for a point, beside the deviation of meshes. A
// choice.
constexpr double kListsAgree = 1e-6;

std::uint8_t BitsOf(const SampleFaces& sample, const std::vector<std::uint8_t>& mask) {
  std::uint8_t bits = 0;
  for (const std::uint32_t f : sample.faces) {
    if (f != kNoFace) {
      bits = static_cast<std::uint8_t>(bits | mask[f]);
    }
  }
  return bits;
}

// Whether `direction` leads along the edge that a sample is on, or at a corner where none of its
// faces looks: what lies there is met by the edge's end or by other samples, while this one slides
// past it.
bool IsAlongEdge(const SampleFaces& sample, const Vec3& direction, double best) {
  constexpr double kAlong = 0.8;  // Cosine: 37 degrees from the edge.
  constexpr double kAway = 0.05;  // Cosine: 87 degrees from both faces.
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
  if (sample.faces[1] == kNoFace) {
    return sample.normal(0).dot(direction) > static_cast<double>(limit);
  }
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

// A step through n hits that comes to all of them and to neighbours far apart: what is found first
// then spans the contact, and few of the rest go beyond it.
std::uint32_t Stride(std::uint32_t n) {
  if (n < 3) {
    return 1;
  }
  auto step = static_cast<std::uint32_t>(0.6180339887 * n);
  while (step > 1 && std::gcd(step, n) != 1) {
    --step;
  }
  return std::max(step, 1U);
}

// What the kernel decided of a hit among several faces as drawn, it may not have decided of them as
// made, or when some of them are left out.
bool IsScreened(const Placed& sampled, const Placed& field, const Hit& hit,
                const FaceFilter& filter) {
  if (hit.list == kNoList) {
    return hit.face != kUnscreened;
  }
  if (sampled.offsets != nullptr) {
    return false;
  }
  const ListFaces& list = field.shape->exact.list_faces[hit.list];
  return std::none_of(list.faces, list.faces + list.count, [&](std::uint32_t face) {
    return filter.Drops(face) || (field.offsets != nullptr && field.offsets->Moves(face));
  });
}

// Whether the faces of a list decide where a hit is that no single test does.
bool IsOfList(const Hit& hit) {
  return hit.face == kUnscreened && (hit.zone & ~zone::kPayload) == zone::kList;
}

bool IsAllowed(std::span<const std::uint32_t> faces, std::uint32_t face) {
  return faces.empty() || std::binary_search(faces.begin(), faces.end(), face);
}

// How deep a sample may lie in a face, where it may at all. A sample on an edge is of every face
// that meets there.
template <bool kIsReverse>
double AllowedDepth(const Allowance& allowance, const SampleFaces& sample, std::uint32_t face) {
  const auto own = kIsReverse ? allowance.scene_faces : allowance.held_faces;
  const auto other = kIsReverse ? allowance.held_faces : allowance.scene_faces;
  const bool is_own =
      std::any_of(sample.faces.begin(), sample.faces.end(),
                  [&own](std::uint32_t f) { return f != kNoFace && IsAllowed(own, f); });
  // Far inside, the field does not know which face is the nearest.
  return is_own && (face == kNoFace || IsAllowed(other, face)) ? allowance.depth : 0;
}

// Keeps one hit of `stride`, a power of two: of each leaf the most telling points, and if that
// leaves none, of some leaves one.
class HitChoice {
 public:
  HitChoice(const Shell& shell, const LeafChoice& tested, std::uint32_t stride)
      : shell_(shell),
        points_(std::max(tested.points / stride, 1U)),
        leaf_stride_(std::max(stride * points_ / tested.points, 1U)) {}

  [[nodiscard]] bool Has(std::uint32_t point) const {
    return (points_ >= 8 || shell_.rank[point] < points_) &&
           (leaf_stride_ == 1 || point / 8 % leaf_stride_ == 0);
  }

 private:
  const Shell& shell_;
  std::uint32_t points_;
  std::uint32_t leaf_stride_;
};

ThreadSamples SamplesOf(const Shape::Data& shape, const Helix* thread, bool is_deep) {
  if (thread == nullptr) {
    return {};
  }
  const auto number = static_cast<std::uint8_t>(thread - shape.helices.data() + 1);
  return {number, is_deep ? static_cast<std::uint8_t>(number + kMaxHelices) : std::uint8_t{0}};
}

// Whether nothing but a thread can be the nearest of a shape there.
bool IsNearestThread(const Shape::Data& shape, const Helix& thread, const Vec3& p) {
  const ZoneAt zone = FindZone(shape, p);
  return zone.is_list() && shape.list_thread[zone.payload()] == &thread - shape.helices.data() + 1;
}

Refined RefineAtThread(const Helix& thread, const HelixPoint& at, double limit) {
  const HelixDistance found = CalcHelixDistance(thread, at, limit);
  Refined refined;
  refined.distance = found.distance;
  refined.gradient = found.gradient;
  return refined;
}

// What single precision says of a hit on one face, with both faces as made; to kScreened.
double ScreenedDistance(const Placed& sampled, const Shell& shell, const Placed& field,
                        const Hit& hit, const Vec3& p_F, const Vec3& towards) {
  auto distance = static_cast<double>(hit.distance);
  if (sampled.offsets != nullptr) {
    distance -= towards.dot(sampled.offsets->ShiftOf(shell, hit.point));
  }
  if (field.offsets != nullptr) {
    distance -= field.offsets->At(hit.face, p_F).offset;
  }
  return distance;
}

}  // namespace

void QueryWorkspace::Data::Clear() noexcept {
  if (memory != nullptr) {
    memory->Begin();
  }
  reducer.Clear();
  leaf_count = 0;
  body_count = 0;
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

void BodyQuery::Collect(BodyId id, const Placed& scene) noexcept {
  if (!BoxesTouch(RelativePose(scene, held_), scene)) {
    return;
  }
  if (work_->body_count == kMaxQueryBodies) {
    work_->stats.is_truncated = true;
    return;
  }
  NearBody& near = work_->bodies[work_->body_count++];
  near.body = id;
  near.threads = FindThreads(id, scene);
  const auto& [ours, theirs, is_deep] = near.threads;
  CollectLeaves<false>(held_, held_.shape->shell, scene, SamplesOf(*held_.shape, ours, is_deep),
                       &near);
  CollectLeaves<true>(scene, scene.shape->features, held_, SamplesOf(*scene.shape, theirs, is_deep),
                      &near);
}

ThreadPair BodyQuery::FindThreads(BodyId id, const Placed& scene) const noexcept {
  if (scene.shape->helices.empty() || held_.shape->helices.empty() ||
      FindAllowance(id) != nullptr ||
      std::any_of(options_.ignored.begin(), options_.ignored.end(),
                  [id](const IgnoredPair& ignored) { return ignored.body == id; })) {
    return {};
  }
  const RelativePose X_SH(scene, held_);
  for (const Helix& ours : held_.shape->helices) {
    for (const Helix& theirs : scene.shape->helices) {
      const double overlap = CalcThreadOverlap(theirs, ours, X_SH.R, X_SH.p);
      if (overlap > 0) {
        constexpr double kDeep = 2;  // Pitches: there are whole turns on both sides. A choice.
        return {&ours, &theirs, overlap > kDeep * ours.pitch};
      }
    }
  }
  return {};
}

double BodyQuery::Reach(const Placed& sampled, const Placed& field,
                        const RelativePose& X_FS) const noexcept {
  const double rounding = 4e-7 * (X_FS.p.norm() + sampled.half().norm() + field.half().norm());
  return margin_ + rounding + sampled.growth() + field.growth();
}

template <bool kIsReverse>
void BodyQuery::CollectLeaves(const Placed& sampled, const Shell& shell, const Placed& field,
                              const ThreadSamples& left_out, NearBody* near) noexcept {
  const RelativePose X(field, sampled);
  const std::size_t side = kIsReverse ? 1 : 0;
  near->bounds[side] = {};
  if (work_->memory != nullptr) {
    const auto made = [](const Placed& part) {
      return part.offsets != nullptr ? part.offsets->serial() : 0;
    };
    const SampledPair pair{sampled.shape->serial,
                           field.shape->serial,
                           near->body.value(),
                           options_.self.value(),
                           kIsReverse,
                           made(sampled),
                           made(field)};
    near->bounds[side] =
        work_->memory->Find(pair, X.R, X.p, sampled.half().norm(), 8 * shell.nodes.size());
  }
  LeafBuffer out;
  out.leaves = work_->leaves.data() + work_->leaf_count;
  out.capacity = static_cast<std::uint32_t>(work_->leaves.size() - work_->leaf_count);
  kernel_.collect(shell.view, field.shape->field.view, X.Single(),
                  static_cast<float>(Reach(sampled, field, X)), near->bounds[side], &out);
  work_->stats.is_truncated = work_->stats.is_truncated || out.is_truncated;
  if (left_out.number != 0) {
    // What is on its thread is met by its edges, and by what the other has beside its own thread.
    const auto* kept = std::remove_if(
        out.leaves, out.leaves + out.count,
        [&](const NearLeaf& leaf) { return left_out.Has(shell.leaf_thread[leaf.leaf]); });
    out.count = static_cast<std::uint32_t>(kept - out.leaves);
  }
  near->first[side] = static_cast<std::uint32_t>(work_->leaf_count);
  near->count[side] = out.count;
  work_->leaf_count += out.count;
}

void BodyQuery::Share() noexcept {
  const auto leaves = static_cast<double>(std::max<std::size_t>(work_->leaf_count, 1));
  points_per_leaf_ = options_.point_budget / leaves;
  // Whoever needs less than an equal share leaves the rest to the others.
  std::array<std::uint32_t, 2 * kMaxQueryBodies> wanted;
  std::size_t size = 0;
  for (std::size_t i = 0; i < work_->body_count; ++i) {
    for (const std::uint32_t count : work_->bodies[i].count) {
      wanted[size++] = 8 * count;
    }
  }
  std::sort(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(size));
  double left = options_.point_budget;
  share_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size; ++i) {
    const double share = left / static_cast<double>(size - i);
    if (wanted[i] > share) {
      share_ = std::max(share, 1.0);
      return;
    }
    left -= wanted[i];
  }
}

LeafChoice BodyQuery::Thin(const LeafChoice& all, double points) noexcept {
  LeafChoice choice = all;
  if (all.points * static_cast<double>(all.count) > points) {
    choice.points = static_cast<std::uint32_t>(std::max(1.0, points / all.count));
    choice.stride = static_cast<std::uint32_t>(std::max(1.0, std::ceil(all.count / points)));
  }
  return choice;
}

LeafChoice BodyQuery::TestLeaves(const Placed& sampled, const Shell& shell, const Placed& field,
                                 const RelativePose& X_FS, const LeafChoice& all,
                                 const BoundView& bounds, HitBuffer* hits) noexcept {
  const ExactTable& exact = field.shape->exact;
  const FaceView faces{exact.zones.data(), exact.forms.data(), exact.list_faces.data()};
  const FloatPose X_single = X_FS.Single();
  const auto reach = static_cast<float>(Reach(sampled, field, X_FS));
  const auto test = [&](const LeafChoice& choice) {
    kernel_.test(shell.view, field.shape->field.view, faces, X_single, reach, bounds, choice, hits);
  };
  const LeafChoice choice = Thin(all, share_);
  const bool is_thinned = choice.points < all.points || choice.stride > 1;
  const auto whole = static_cast<std::uint32_t>(share_ / (2 * all.points));
  if (!is_thinned || bounds.bounds == nullptr || whole == 0) {
    test(choice);
    return choice;
  }
  // Half of the share goes to leaves of which all points are tested, others in each query: those
  // that are far are then known to be, and soon the rest is no more than the share.
  const std::uint32_t begin = bounds.turn * whole % all.count;
  const std::uint32_t end = std::min(begin + whole, all.count);
  const LeafChoice thinned = Thin(all, share_ / 2);
  test({all.leaves, begin, thinned.points, thinned.stride});
  test({all.leaves + begin, end - begin, all.points, 1});
  test({all.leaves + end, all.count - end, thinned.points, thinned.stride});
  return thinned;
}

std::uint32_t BodyQuery::CalcStride(std::span<const Hit> hits, std::uint32_t leaf_count,
                                    bool are_lists_screened, const Placed& field) const noexcept {
  if (!options_.bounds_refinement) {
    return 1;
  }
  const std::vector<std::uint32_t>& begin = field.shape->exact.list_begin;
  double count = 0;
  double triangles = 0;
  for (const Hit& hit : hits) {
    const bool is_refined = hit.list == kNoList ? hit.face == kUnscreened : !are_lists_screened;
    if (!is_refined || hit.face == kKnownFar) {
      continue;
    }
    ++count;
    const std::uint32_t list = hit.list != kNoList ? hit.list : hit.zone & zone::kPayload;
    if (hit.list != kNoList || IsOfList(hit)) {
      const double scans = FacesOfList(*field.shape, list) == nullptr ? kScansUnnamed : 1;
      triangles += scans * (begin[list + 1] - begin[list]);
    }
  }
  triangles *= field.offsets != nullptr ? kScansAsMade : 1;
  triangles += kTrianglesPerHit * count;
  const double share = kTrianglesPerPoint * points_per_leaf_ * leaf_count;
  std::uint32_t stride = 1;  // Doubled: the same hits are kept as their number varies a little.
  while (count > kLeastHits * stride && triangles > share * stride) {
    stride *= 2;
  }
  return stride;
}

void BodyQuery::Body(std::size_t i, const Placed& scene) noexcept {
  if (is_stopped_) {
    return;
  }
  const NearBody& near = work_->bodies[i];
  ++work_->stats.bodies_tested;
  const bool has_ignored = SetMasks(near.body, 0xff);
  allowance_ = FindAllowance(near.body);
  if (near.threads.held != nullptr) {
    ThreadEdges<false>(held_, *near.threads.held, scene, *near.threads.scene, near.body);
    ThreadEdges<true>(scene, *near.threads.scene, held_, *near.threads.held, near.body);
  }
  Samples<false>(held_, held_.shape->shell, scene, has_ignored, near);
  Samples<true>(scene, scene.shape->features, held_, has_ignored, near);
  work_->layer.Add(layer_, scene.R_WC, scene.p_WC);
  layer_ = {};
  if (has_ignored) {
    SetMasks(near.body, 0);
  }
}

const Allowance* BodyQuery::FindAllowance(BodyId id) const noexcept {
  const auto found = std::find_if(options_.allowances.begin(), options_.allowances.end(),
                                  [id](const Allowance& a) { return a.body == id; });
  return found == options_.allowances.end() ? nullptr : &*found;
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
    const auto bit = static_cast<std::uint8_t>(
        1U << std::min<std::size_t>(pair++, QueryOptions::kMaxPairsPerBody - 1));
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
double BodyQuery::CalcAllowance(const SampleFaces& sample, std::uint32_t face) const noexcept {
  return allowance_ != nullptr ? AllowedDepth<kIsReverse>(*allowance_, sample, face) : 0;
}

template <bool kIsReverse>
bool BodyQuery::IsAllowed(const SampledShell& sampled, const Hit& hit,
                          const Sample& sample) const noexcept {
  const double depth = CalcAllowance<kIsReverse>(sample.faces, kNoFace);
  const double least =
      static_cast<double>(hit.distance) + depth - sampled.placed.growth() - sampled.field.growth();
  if (depth == 0 || least < margin_) {
    return false;
  }
  const Shape::Data& shape = *sampled.field.shape;
  const ZoneAt zone = FindZone(shape, sample.p_F);
  if (!zone.is_list() || least - zone.slack < margin_) {
    return false;
  }
  const auto other = kIsReverse ? allowance_->held_faces : allowance_->scene_faces;
  const ListFaces* list = FacesOfList(shape, zone.payload());
  return other.empty() || (list != nullptr && std::all_of(list->faces, list->faces + list->count,
                                                          [&other](std::uint32_t face) {
                                                            return contact::IsAllowed(other, face);
                                                          }));
}

template <bool kIsReverse>
void BodyQuery::ThreadEdges(const Placed& sampled, const Helix& own, const Placed& field,
                            const Helix& other, BodyId body) noexcept {
  if (is_stopped_) {
    return;
  }
  const RelativePose X(field, sampled);
  RawContact contact;
  contact.body = body.value();
  contact.is_reverse = kIsReverse;
  contact.point = kFixedPoint;
  contact.held_face = kNoFace;
  contact.scene_face = kNoFace;
  work_->stats.points_tested +=
      ForEachEdgeContact(own, other, X.R, X.p, margin_, [&](const HelixContact& found) {
        contact.p = found.p;
        contact.gradient = found.gradient;
        contact.distance = found.distance;
        if constexpr (kIsReverse) {
          work_->reducer.Add(contact, -(X.R.transpose() * found.gradient), found.p);
        } else {
          work_->reducer.Add(contact, found.gradient, X * found.p);
        }
        is_stopped_ = found.distance < stop_distance_;
        return !is_stopped_;
      });
}

template <bool kIsReverse>
bool BodyQuery::AddScreened(const SampledShell& sampled, const Hit& hit, const Sample& sample,
                            RawContact* contact) noexcept {
  const Vec3 gradient(static_cast<double>(hit.gradient[0]), static_cast<double>(hit.gradient[1]),
                      static_cast<double>(hit.gradient[2]));
  const Vec3 towards = sampled.R_back * gradient;
  const double unallowed =
      ScreenedDistance(sampled.placed, sampled.shell, sampled.field, hit, sample.p_F, towards);
  const double allowance = CalcAllowance<kIsReverse>(sample.faces, hit.face);
  const double distance = unallowed + allowance;
  std::uint32_t own_face = kNoFace;
  if (distance >= margin_ + kScreened ||
      (!Faces(sample.faces, sampled.shell.facing[hit.point], towards, &own_face) &&
       unallowed > sampled.deep + kScreened)) {
    return true;
  }
  if (distance >= margin_ - kScreened || distance <= stop_distance_ + kScreened) {
    return false;
  }
  contact->is_screened = true;
  contact->is_rough = false;
  contact->triangle = kNoFace;
  contact->is_exact = true;
  contact->distance = distance;
  contact->gradient = gradient;
  contact->allowance = allowance;
  contact->point = hit.point;
  contact->held_face = kIsReverse ? hit.face : own_face;
  contact->scene_face = kIsReverse ? own_face : hit.face;
  Add(*contact, sample.faces, kIsReverse ? towards : gradient,
      kIsReverse ? contact->p : sample.p_F);
  return true;
}

template <bool kIsReverse>
void BodyQuery::AddRefined(const SampledShell& sampled, const Hit& hit, const Sample& sample,
                           const Refined& r, RawContact* contact) noexcept {
  contact->allowance = CalcAllowance<kIsReverse>(sample.faces, r.face);
  if (!r.is_valid || r.distance + contact->allowance >= margin_) {
    return;
  }
  const Vec3 towards = sampled.R_back * r.gradient;  // In the sampled shape's frame.
  // An edge is met by its own samples: they know its direction, a face's samples would guess it.
  const bool is_face_at_edge = sample.faces.faces[1] == kNoFace && r.other_face != kNoFace;
  if (is_face_at_edge && r.distance > sampled.deep) {
    return;
  }
  std::uint32_t own_face = kNoFace;
  if (!Faces(sample.faces, sampled.shell.facing[hit.point], towards, &own_face) &&
      (r.distance > sampled.deep || r.is_continued)) {
    return;
  }
  contact->is_screened = false;
  contact->is_rough = r.is_rough;
  contact->triangle = r.triangle;
  contact->is_exact = r.is_exact;
  contact->distance = r.distance + contact->allowance;
  contact->gradient = r.gradient;
  contact->held_face = kIsReverse ? r.face : own_face;
  contact->scene_face = kIsReverse ? own_face : r.face;
  Add(*contact, sample.faces, kIsReverse ? towards : r.gradient,
      kIsReverse ? contact->p : sample.p_F);
}

void BodyQuery::MarkKnownFar(const BoundView& bounds, bool are_lists_screened,
                             HitBuffer* hits) const noexcept {
  for (std::uint32_t i = 0; i < hits->count; ++i) {
    Hit& hit = hits->hits[i];
    const bool is_of_list = hit.list == kNoList ? IsOfList(hit) : !are_lists_screened;
    if (is_of_list && work_->memory->IsBeyond(bounds, hit.point, margin_)) {
      hit.face = kKnownFar;
    }
  }
}

void BodyQuery::FindHits(std::uint32_t first, ShellQuery* query) noexcept {
  const auto& [sampled, shell, field, R_back, deep] = query->samples;
  HitBuffer& hits = query->hits;
  hits.hits = work_->hits.data();
  hits.capacity = static_cast<std::uint32_t>(work_->hits.size());
  const std::uint32_t leaf_count = query->tested.count;
  const std::uint32_t most = query->body.threads.is_deep ? kBesideThread : 8;
  const LeafChoice all{work_->leaves.data() + first, leaf_count, most, 1};
  query->tested = TestLeaves(sampled, shell, field, query->X_FS, all, query->bounds, &hits);
  const bool is_thinned = query->tested.points < most || query->tested.stride > 1;
  work_->stats.points_tested += hits.points_tested;
  work_->stats.points_dropped += is_thinned ? most * leaf_count - hits.points_tested : 0;
  const bool are_lists_screened =
      !query->has_ignored && sampled.offsets == nullptr && field.offsets == nullptr;
  if (query->remembers) {
    MarkKnownFar(query->bounds, are_lists_screened, &hits);
  }
  query->stride = CalcStride({hits.hits, hits.count}, leaf_count, are_lists_screened, field);
  work_->stats.is_truncated =
      work_->stats.is_truncated || is_thinned || hits.is_truncated || query->stride > 1;
  query->sparsity =
      8.0F * static_cast<float>(query->tested.stride) / static_cast<float>(query->tested.points);
}

template <bool kIsReverse>
bool BodyQuery::AddAtThread(const ShellQuery& query, const Helix& thread, const Hit& hit,
                            const Sample& sample, RawContact* contact) noexcept {
  const HelixPoint place = Locate(thread, sample.p_F);
  if (!IsInThread(thread, place, margin_) &&
      !IsNearestThread(*query.samples.field.shape, thread, sample.p_F)) {
    return false;
  }
  contact->point = kFixedPoint;
  contact->sparsity = query.sparsity;
  AddRefined<kIsReverse>(query.samples, hit, sample, RefineAtThread(thread, place, margin_),
                         contact);
  return true;
}

void BodyQuery::Remember(const ShellQuery& query, const Hit& hit, const Refined& r,
                         double limit) noexcept {
  if (!query.remembers || (hit.list == kNoList && !IsOfList(hit))) {
    return;
  }
  const double least = r.is_valid ? r.distance : limit;
  const ExactTable& exact = query.samples.field.shape->exact;
  const double unsure = 2 * exact.most_deviation + kListsAgree +
                        (r.is_valid && r.is_rough ? exact.deviation[r.face] : 0);
  work_->memory->SetFar(query.bounds, hit.point, least - unsure);
}

template <bool kIsReverse>
void BodyQuery::AddHit(const ShellQuery& query, const Hit& hit, const Sample& sample,
                       const FaceFilter& filter, bool is_refined, RawContact* contact) noexcept {
  const Placed& field = query.samples.field;
  if (IsScreened(query.samples.placed, field, hit, filter)) {
    contact->sparsity = query.sparsity;
    if (filter.Drops(hit.face) || AddScreened<kIsReverse>(query.samples, hit, sample, contact)) {
      return;
    }
  } else if (!is_refined) {
    ++work_->stats.points_dropped;
    return;
  } else if (IsAllowed<kIsReverse>(query.samples, hit, sample)) {
    return;
  }
  const Refined r = RefineActual(*field.shape, field.offsets, sample.p_F, hit, filter);
  Remember(query, hit, r, filter.limit);
  // So deep inside, the field knows no face: for a sample of faces that something else answers
  // for, what it answers for may be all around, as the thread of a screw around the rim of its
  // core hole.
  const bool is_answered_for = r.face == kNoFace && filter.bits != 0;
  if (!is_answered_for) {
    contact->point = hit.point;
    contact->sparsity = query.sparsity * static_cast<float>(query.stride);
    AddRefined<kIsReverse>(query.samples, hit, sample, r, contact);
  }
}

template <bool kIsReverse>
void BodyQuery::Samples(const Placed& sampled, const Shell& shell, const Placed& field,
                        bool has_ignored, const NearBody& body) noexcept {
  const std::size_t side = kIsReverse ? 1 : 0;
  if (is_stopped_ || body.count[side] == 0) {
    return;
  }
  const RelativePose X(field, sampled);
  const BoundView& bounds = body.bounds[side];
  // What is left out of the other part, or stands for its thread, is no bound of its distance.
  const bool remembers = bounds.bounds != nullptr && !has_ignored && body.threads.held == nullptr;
  ShellQuery query{{sampled, shell, field, -X.R.transpose(), -0.5 * sampled.shape->spacing},
                   X,
                   body,
                   bounds,
                   has_ignored,
                   remembers};
  query.tested.count = body.count[side];
  FindHits(body.first[side], &query);

  const std::vector<std::uint8_t>& own_mask = kIsReverse ? work_->scene_mask : work_->held_mask;
  const std::vector<std::uint8_t>& other_mask = kIsReverse ? work_->held_mask : work_->scene_mask;
  const Helix* own_thread = kIsReverse ? body.threads.scene : body.threads.held;
  const Helix* other_thread = kIsReverse ? body.threads.held : body.threads.scene;
  const ThreadSamples left_out = SamplesOf(*sampled.shape, own_thread, body.threads.is_deep);
  const HitChoice tested(shell, query.tested, 1);
  const HitChoice refined(shell, query.tested, query.stride);
  RawContact contact;
  contact.body = body.body.value();
  contact.is_reverse = kIsReverse;
  FaceFilter filter;
  filter.limit = margin_ + (remembers ? kLookedBeyond : 0);
  filter.allows_rough = true;
  const std::uint32_t step = Stride(query.hits.count);
  std::uint32_t at = 0;
  for (std::uint32_t i = 0; i < query.hits.count && !is_stopped_; ++i) {
    const Hit& hit = query.hits.hits[at];
    at += step;
    at -= at >= query.hits.count ? query.hits.count : 0;
    // Some are of leaves that were tested whole, to know how far they are; on its thread a part is
    // met by its edges.
    if (hit.face == kKnownFar || !tested.Has(hit.point) ||
        (left_out.number != 0 && left_out.Has(shell.thread[hit.point]))) {
      continue;
    }
    contact.p = sampled.Sample(shell, hit.point);
    const Sample sample{shell.faces[hit.point], X * contact.p};
    if (has_ignored) {
      filter.mask = other_mask.data();
      filter.bits = BitsOf(sample.faces, own_mask);
    }
    const bool is_at_thread = other_thread != nullptr &&
                              AddAtThread<kIsReverse>(query, *other_thread, hit, sample, &contact);
    if (!is_at_thread) {
      AddHit<kIsReverse>(query, hit, sample, filter, refined.Has(hit.point), &contact);
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

void BodyQuery::AddToLayer(double distance, const SampleFaces& faces, const Vec3& nhat_S,
                           const Vec3& p_S) noexcept {
  if (distance < 0) {
    const bool is_inside_face = faces.faces[1] == kNoFace;
    const double area = is_inside_face ? ContactLayer::kFaceArea : ContactLayer::kEdgeArea;
    layer_.Add(area, -distance, nhat_S, p_S);
  }
}

void BodyQuery::Add(const RawContact& contact, const SampleFaces& faces, const Vec3& nhat_S,
                    const Vec3& p_S) noexcept {
  work_->reducer.Add(contact, nhat_S, p_S);
  AddToLayer(contact.distance, faces, nhat_S, p_S);
  is_stopped_ = contact.distance < stop_distance_;
}

}  // namespace hvas::contact
