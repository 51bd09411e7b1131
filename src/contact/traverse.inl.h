// The query's inner loop over packs of eight lanes. Included once by each kernel's source.
#pragma once

#include "contact/kernel.h"

namespace hvas::contact {

template <typename P>
class Traversal {
  using Float = typename P::Float;
  using Int = typename P::Int;
  using Mask = typename P::Mask;

 public:
  static void Collect(const ShellView& shell, const FieldView& field, const FloatPose& X_FS,
                      float margin, const BoundView& bounds, LeafBuffer* out) {
    Traversal(shell, field, {}, X_FS, margin, bounds, nullptr).CollectLeaves(out);
  }

  static void Test(const ShellView& shell, const FieldView& field, const FaceView& faces,
                   const FloatPose& X_FS, float margin, const BoundView& bounds,
                   const LeafChoice& choice, HitBuffer* out) {
    Traversal(shell, field, faces, X_FS, margin, bounds, out).TestLeaves(choice);
  }

 private:
  Traversal(const ShellView& shell, const FieldView& field, const FaceView& faces,
            const FloatPose& X_FS, float margin, const BoundView& bounds, HitBuffer* out)
      : shell_(shell),
        field_(field),
        faces_(faces),
        X_(X_FS),
        margin_(margin),
        bounds_(bounds),
        out_(out) {}

  void CollectLeaves(LeafBuffer* out) const {
    if (shell_.node_count == 0) {
      return;
    }
    constexpr int kStack = 256;  // Pairs of nodes that wait: a choice.
    std::int32_t stack[kStack];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const std::int32_t number = stack[--size];
      const SphereNode& node = shell_.nodes[number];
      unsigned near = NearChildren(node, 8 * number);
      while (near != 0) {
        const int lane = __builtin_ctz(near);
        near &= near - 1;
        const std::int32_t child = node.child[lane];
        if (child < -1 && out->count < out->capacity) {
          out->leaves[out->count++] = {static_cast<std::uint32_t>(-2 - child),
                                       static_cast<std::uint32_t>(8 * number + lane)};
        } else if (child >= 0 && size < kStack) {
          stack[size++] = child;
        } else if (child != -1) {
          out->is_truncated = true;
        }
      }
    }
  }

  void TestLeaves(const LeafChoice& choice) {
    if (choice.points >= 8) {
      for (std::uint32_t i = 0; i < choice.count; i += choice.stride) {
        const std::uint32_t leaf = choice.leaves[i].leaf;
        const float* x = shell_.x + 8 * leaf;
        const float* y = shell_.y + 8 * leaf;
        const float* z = shell_.z + 8 * leaf;
        std::uint32_t number[8];
        for (std::uint32_t lane = 0; lane < 8; ++lane) {
          number[lane] = 8 * leaf + lane;
        }
        least_ = kNoBound;
        TestPoints(P::Load(x), P::Load(y), P::Load(z), number, shell_.leaf_count[leaf]);
        if (bounds_.bounds != nullptr) {
          bounds_.bounds[choice.leaves[i].place] = bounds_.moved + (least_ - kBoundRounding);
        }
      }
      return;
    }
    alignas(32) float x[8] = {};
    alignas(32) float y[8] = {};
    alignas(32) float z[8] = {};
    std::uint32_t number[8] = {};
    unsigned size = 0;
    for (std::uint32_t i = 0; i < choice.count; i += choice.stride) {
      const std::uint32_t leaf = choice.leaves[i].leaf;
      const std::uint32_t count = shell_.leaf_count[leaf];
      for (std::uint32_t k = 0; k < choice.points && k < count; ++k) {
        const std::uint32_t point = 8 * leaf + shell_.order[8 * leaf + k];
        x[size] = shell_.x[point];
        y[size] = shell_.y[point];
        z[size] = shell_.z[point];
        number[size] = point;
        if (++size == 8) {
          TestPoints(P::Load(x), P::Load(y), P::Load(z), number, size);
          size = 0;
        }
      }
    }
    if (size > 0) {
      TestPoints(P::Load(x), P::Load(y), P::Load(z), number, size);
    }
  }

  void Transform(const Float& x, const Float& y, const Float& z, Float* out) const {
    for (int k = 0; k < 3; ++k) {
      const Float a = P::Mul(P::Set(X_.R[3 * k]), x);
      const Float b = P::Mul(P::Set(X_.R[3 * k + 1]), y);
      const Float c = P::Mul(P::Set(X_.R[3 * k + 2]), z);
      out[k] = P::Add(P::Add(a, b), P::Add(c, P::Set(X_.p[k])));
    }
  }

  // Which children of a node may have a hit, by what is known of them from before, and by how far
  // their spheres are. `place` is that of the first child's bound.
  unsigned NearChildren(const SphereNode& node, std::int32_t place) const {
    unsigned open = 0xffU;
    if (bounds_.bounds != nullptr) {
      const Float known = P::Load(bounds_.bounds + place);
      open = P::Bits(P::Less(known, P::Set(bounds_.moved + margin_)));
      if (open == 0) {
        return 0;
      }
    }
    Float c[3];
    Transform(P::Load(node.x), P::Load(node.y), P::Load(node.z), c);
    const Float bound = CalcFarBound(c);
    const Float radius = P::Load(node.radius);
    const unsigned near = open & P::Bits(P::Less(bound, P::Add(radius, P::Set(margin_))));
    if (bounds_.bounds != nullptr && near != open) {
      alignas(32) float least[8];
      P::Store(P::Sub(P::Sub(bound, radius), P::Set(kBoundRounding)), least);
      for (unsigned far = open & ~near; far != 0; far &= far - 1) {
        const int lane = __builtin_ctz(far);
        bounds_.bounds[place + lane] = bounds_.moved + least[lane];
      }
    }
    return near;
  }

  // A point is at least as far from the surface as the nearest coarse node's distance (which
  // changes by at most the way to it) and the part's box say.
  Float CalcFarBound(const Float* c) const {
    const Float zero = P::Set(0.0F);
    Float to_node = zero;
    Float to_box = zero;
    Int index = P::SetInt(0);
    const float inverse = 1.0F / field_.coarse_cell;
    for (int k = 2; k >= 0; --k) {
      const Float origin = P::Set(field_.coarse_origin[k]);
      Float u = P::Mul(P::Sub(c[k], origin), P::Set(inverse));
      u = P::Min(P::Max(u, zero), P::Set(static_cast<float>(field_.coarse_count[k] - 1)));
      const Int i = P::Truncate(P::Add(u, P::Set(0.5F)));
      const Float at = P::Add(P::Mul(P::ToFloat(i), P::Set(field_.coarse_cell)), origin);
      const Float d = P::Sub(c[k], at);
      to_node = P::Add(to_node, P::Mul(d, d));
      const Float below = P::Sub(P::Set(field_.low[k]), c[k]);
      const Float above = P::Sub(c[k], P::Set(field_.high[k]));
      const Float outside = P::Max(P::Max(below, above), zero);
      to_box = P::Add(to_box, P::Mul(outside, outside));
      index = P::AddInt(P::MulInt(index, P::SetInt(field_.coarse_count[k])), i);
    }
    const Float phi = P::Gather(field_.coarse, index);
    return P::Max(P::Sub(phi, P::Sqrt(to_node)), P::Sqrt(to_box));
  }

  static constexpr float kNoBound = 3e38F;  // More than any distance.

  struct Sample {
    Float distance;
    Float middle;  // Of the cell.
    Float gradient[3];
  };

  // The least distance that the points of a sample may have. The slack is measured in cells near
  // the surface. Elsewhere interpolation errs by 1/4 h^2 over the distance at the most, as a
  // distance curves by no more than its reciprocal in two directions.
  Float CalcBandBound(const Sample& s, const Float& slack) const {
    const Float near = P::Sub(s.distance, slack);
    const Float far = P::Sub(near, P::Set(0.25F * field_.voxel));
    return P::Select(P::Less(s.middle, P::Set(kSlackVoxels * field_.voxel)), near, far);
  }

  // Trilinear value and gradient in cells given by block, cell within it and weights.
  Sample Interpolate(const Int& base, const Float* w) const {
    Float d[8];
    const int offsets[4] = {0, 9, 81, 90};
    for (int k = 0; k < 4; ++k) {
      P::GatherPair(field_.nodes, P::AddInt(base, P::SetInt(offsets[k])), &d[2 * k], &d[2 * k + 1]);
    }
    const auto mix = [](const Float& a, const Float& slope, const Float& weight) {
      return P::Add(a, P::Mul(slope, weight));
    };
    Float e[4];
    Float x[4];
    for (int k = 0; k < 4; ++k) {
      e[k] = P::Sub(d[2 * k + 1], d[2 * k]);
      x[k] = mix(d[2 * k], e[k], w[0]);
    }
    const Float dy0 = P::Sub(x[1], x[0]);
    const Float dy1 = P::Sub(x[3], x[2]);
    const Float y0 = mix(x[0], dy0, w[1]);
    const Float y1 = mix(x[2], dy1, w[1]);
    const Float dz = P::Sub(y1, y0);
    const Float scale = P::Set(field_.quantum);
    const Float slope = P::Set(field_.quantum / field_.voxel);
    const Float dx0 = mix(e[0], P::Sub(e[1], e[0]), w[1]);
    const Float dx1 = mix(e[2], P::Sub(e[3], e[2]), w[1]);
    Sample s;
    const Float low = P::Add(P::Add(d[0], d[1]), P::Add(d[2], d[3]));
    const Float high = P::Add(P::Add(d[4], d[5]), P::Add(d[6], d[7]));
    s.middle = P::Mul(P::Add(low, high), P::Set(0.125F * field_.quantum));
    s.distance = P::Mul(mix(y0, dz, w[2]), scale);
    s.gradient[0] = P::Mul(mix(dx0, P::Sub(dx1, dx0), w[2]), slope);
    s.gradient[1] = P::Mul(mix(dy0, P::Sub(dy1, dy0), w[2]), slope);
    s.gradient[2] = P::Mul(dz, slope);
    return s;
  }

  // Points in the grid of the field. The functions that take them are parts of TestPoints.
  struct Places {
    Float p[3];                        // Coordinates in the field's frame.
    alignas(32) float position[3][8];  // Likewise.
    Float w[3];                        // Shares of the cell.
    Int cell;                          // The node of the cell in its block.
    Int zone;                          // Twice its number in the block.
    Int top;                           // The block, or what stands for one.
    Mask inside;                       // Of the grid.
  };

  [[gnu::always_inline]] inline void Locate(Places* at) const {
    const Float zero = P::Set(0.0F);
    const float inverse = 1.0F / field_.voxel;
    Int block = P::SetInt(0);
    at->cell = P::SetInt(0);
    at->zone = P::SetInt(0);
    at->inside = P::Less(P::Set(-1.0F), zero);
    for (int k = 2; k >= 0; --k) {
      const Float u = P::Mul(P::Sub(at->p[k], P::Set(field_.origin[k])), P::Set(inverse));
      const Float end = P::Set(static_cast<float>(8 * field_.blocks[k]));
      at->inside = P::And(at->inside, P::And(P::Less(P::Set(-0.5F), u), P::Less(u, end)));
      const Float clamped = P::Max(P::Min(u, P::Sub(end, P::Set(0.5F))), zero);
      const Int i = P::Truncate(clamped);
      at->w[k] = P::Sub(clamped, P::ToFloat(i));
      block = P::AddInt(P::MulInt(block, P::SetInt(field_.blocks[k])), P::ShiftRight3(i));
      at->cell = P::AddInt(P::MulInt(at->cell, P::SetInt(9)), P::AndInt(i, 7));
      at->zone = P::AddInt(P::MulInt(at->zone, P::SetInt(4)), P::AndInt(i, 6));
    }
    at->top = P::GatherInt(field_.top, block);
    for (int k = 0; k < 3; ++k) {
      P::Store(at->p[k], at->position[k]);
    }
  }

  // Tests the points that are in blocks with nodes.
  [[gnu::always_inline]] inline void TestInBlocks(const Places& at, const Mask& has,
                                                  unsigned has_bits, const std::uint32_t* number) {
    const Int b = P::MaxInt(at.top, P::SetInt(0));
    std::int32_t code[8];
    P::StoreInt(P::AddInt(P::MulInt(b, P::SetInt(128)), at.zone), code);
    std::uint32_t zones[8];
    unsigned exact = 0;
    for (unsigned rest = has_bits; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      zones[lane] = faces_.zones[code[lane] >> 1];
      exact |= ((zones[lane] & ~zone::kPayload) == zone::kExact ? 1U : 0U) << lane;
    }
    // Where one face has the distance of each point, what is stored at the nodes is not needed.
    const unsigned left =
        exact == has_bits ? ScreenFaces(has_bits, zones, at.p, number, bounds_.bounds != nullptr)
                          : has_bits;
    if (left == 0) {
      return;
    }
    const Sample s = Interpolate(P::AddInt(P::MulInt(b, P::SetInt(kBlockNodes)), at.cell), at.w);
    const Float slack = P::Gather(field_.slack, b);
    const unsigned hits = P::Bits(P::Less(s.distance, P::Add(P::Set(margin_), slack))) & left;
    if (bounds_.bounds != nullptr) {
      // Unused lanes repeat a point: they change no minimum.
      least_ = P::Least(P::Select(has, CalcBandBound(s, slack), P::Set(kNoBound)));
    }
    const unsigned others = left == has_bits ? Screen(hits, at.p, zones, number) : hits;
    PushInBand(others, s, at.position, zones, number);
  }

  // Tests the points in blocks that one face has the distances of.
  [[gnu::always_inline]] inline void TestInFaceBlocks(const Places& at, unsigned on_face,
                                                      const std::uint32_t* number) {
    std::int32_t code[8];
    P::StoreInt(at.top, code);
    std::uint32_t face[8];
    for (unsigned rest = on_face; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      face[lane] = static_cast<std::uint32_t>(kTopFace - code[lane]);
    }
    const unsigned unsure = ScreenFaces(on_face, face, at.p, number, bounds_.bounds != nullptr);
    least_ = unsure != 0 ? -kNoBound : least_;
  }

  void TestPoints(const Float& x, const Float& y, const Float& z, const std::uint32_t* number,
                  unsigned count) {
    const unsigned used = (1U << count) - 1U;
    out_->points_tested += count;
    Places at;
    Transform(x, y, z, at.p);
    Locate(&at);
    const Mask has = P::And(at.inside, P::LessInt(P::SetInt(-1), at.top));
    const unsigned has_bits = P::Bits(has) & used;
    if (has_bits != 0) {
      TestInBlocks(at, has, has_bits, number);
    }
    const Mask in_face_block = P::And(at.inside, P::LessInt(at.top, P::SetInt(kTopInside)));
    const unsigned on_face = P::Bits(in_face_block) & used;
    if (on_face != 0) {
      TestInFaceBlocks(at, on_face, number);
    }
    const unsigned solid = P::Bits(P::And(at.inside, P::LessInt(at.top, P::SetInt(kTopOutside))));
    // Outside the part and in no block is further away than `beyond`.
    const unsigned nowhere = used & ~has_bits & ~on_face;
    if (bounds_.bounds != nullptr && nowhere != 0) {
      const Float none = P::Set(kNoBound);
      const Float far = P::Max(CalcFarBound(at.p), P::Set(field_.beyond));
      const float value = P::Least(P::Select(in_face_block, none, P::Select(has, none, far)));
      least_ = (nowhere & solid) != 0 ? -kNoBound : (value < least_ ? value : least_);
    }
    const unsigned rest = nowhere & (margin_ > field_.beyond ? ~0U : solid);
    if (rest != 0) {
      PushCoarse(rest, solid, at.position, number);
    }
  }

  static constexpr float kUnsure = 0.4e-6F;  // [m]; twice what single precision may be wrong by.

  // Pushes the hits that one analytic face decides, by their distance from it; returns the others.
  unsigned Screen(unsigned hits, const Float* p, const std::uint32_t* code,
                  const std::uint32_t* number) {
    unsigned one = 0;
    unsigned several = 0;
    for (unsigned rest = hits; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      const std::uint32_t how = code[lane] & ~zone::kPayload;
      one |= (how == zone::kExact ? 1U : 0U) << lane;
      several |= (how == zone::kList && faces_.lists != nullptr ? 1U : 0U) << lane;
    }
    const unsigned others = hits & ~(one | several);
    return others | ScreenFaces(one, code, p, number, false) |
           ScreenLists(several, code, p, number);
  }

  // The lanes of `todo` whose code is that of the first of them.
  static unsigned SameAsFirst(unsigned todo, const std::uint32_t* code) {
    const std::uint32_t first = code[__builtin_ctz(todo)];
    unsigned same = 0;
    for (unsigned rest = todo; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      same |= (code[lane] == first ? 1U : 0U) << lane;
    }
    return same;
  }

  // What a face's form says of points: their distances, and what their gradients follow from.
  struct Seen {
    Float distance;
    Float radial[3];
    Float r;        // Distance from the axis.
    Float u;        // The same less the radius.
    Float h;        // Height along the axis.
    Float reach;    // Of round ones: distance from the middle of the section.
    unsigned good;  // The lanes that are not on the axis, where there is no gradient.
  };

  static Seen Look(const FaceForm& form, const Float* p) {
    Seen seen;
    Float q[3];
    for (int k = 0; k < 3; ++k) {
      q[k] = P::Sub(p[k], P::Set(form.origin[k]));
    }
    const auto dot = [](const Float* a, const Float* b) {
      return P::Add(P::Add(P::Mul(a[0], b[0]), P::Mul(a[1], b[1])), P::Mul(a[2], b[2]));
    };
    const Float axis[3] = {P::Set(form.axis[0]), P::Set(form.axis[1]), P::Set(form.axis[2])};
    seen.h = dot(q, axis);
    for (int k = 0; k < 3; ++k) {
      seen.radial[k] = P::Sub(q[k], P::Mul(seen.h, axis[k]));
    }
    seen.r = P::Sqrt(dot(seen.radial, seen.radial));
    seen.u = P::Sub(seen.r, P::Set(form.radius));
    const bool is_round = form.kind == FaceForm::Kind::kRound;
    Float d;
    if (is_round) {
      seen.reach = P::Sqrt(P::Add(P::Mul(seen.u, seen.u), P::Mul(seen.h, seen.h)));
      d = P::Sub(seen.reach, P::Set(form.minor));
    } else {
      seen.reach = seen.u;
      d = P::Add(P::Mul(P::Set(form.across), seen.u), P::Mul(P::Set(form.along), seen.h));
    }
    seen.distance = P::Mul(P::Set(form.outward), d);
    constexpr float kOnAxis = 1e-5F;  // [m]: nearer than that a direction is rounding. A choice.
    const bool has_axis = is_round || form.across != 0.0F;
    seen.good = has_axis ? P::Bits(P::Less(P::Set(kOnAxis), seen.r)) : 0xffU;
    return seen;
  }

  // Unit gradients of the distances.
  static void CalcGradient(const FaceForm& form, const Seen& seen, float (*gradient)[8]) {
    const Float least = P::Set(1e-12F);
    Float across = P::Set(form.across);
    Float along = P::Set(form.along);
    if (form.kind == FaceForm::Kind::kRound) {
      const Float reach = P::Max(seen.reach, least);
      across = P::Div(seen.u, reach);
      along = P::Div(seen.h, reach);
    }
    const Float outward = P::Set(form.outward);
    const Float per_radial = P::Div(P::Mul(outward, across), P::Max(seen.r, least));
    const Float per_axis = P::Mul(outward, along);
    for (int k = 0; k < 3; ++k) {
      const Float along_axis = P::Mul(per_axis, P::Set(form.axis[k]));
      P::Store(P::Add(P::Mul(per_radial, seen.radial[k]), along_axis), gradient[k]);
    }
  }

  // Of lanes whose code is a face's number; returns those on the axis of theirs.
  unsigned ScreenFaces(unsigned todo, const std::uint32_t* code, const Float* p,
                       const std::uint32_t* number, bool keeps_least) {
    unsigned others = 0;
    while (todo != 0) {
      const std::uint32_t face = code[__builtin_ctz(todo)];
      const unsigned same = SameAsFirst(todo, code);
      todo &= ~same;
      const FaceForm& form = faces_.forms[face];
      if (form.kind == FaceForm::Kind::kNone) {
        others |= same;
        continue;
      }
      const Seen seen = Look(form, p);
      others |= same & ~seen.good;
      alignas(32) float distance[8];
      P::Store(seen.distance, distance);
      for (unsigned rest = keeps_least ? same : 0; rest != 0; rest &= rest - 1) {
        const float value = distance[__builtin_ctz(rest)] - kUnsure;
        least_ = value < least_ ? value : least_;
      }
      unsigned hits = same & seen.good & P::Bits(P::Less(seen.distance, P::Set(margin_)));
      if (hits == 0) {
        continue;
      }
      alignas(32) float gradient[3][8];
      CalcGradient(form, seen, gradient);
      for (; hits != 0; hits &= hits - 1) {
        const int lane = __builtin_ctz(hits);
        Push({number[lane],
              distance[lane],
              {gradient[0][lane], gradient[1][lane], gradient[2][lane]},
              face});
      }
    }
    return others;
  }

  // What `ZoneList::FromSurfaces` decides, where single precision is enough to tell that it does.
  unsigned ScreenLists(unsigned todo, const std::uint32_t* code, const Float* p,
                       const std::uint32_t* number) {
    unsigned others = 0;
    while (todo != 0) {
      const std::uint32_t number_of_list = code[__builtin_ctz(todo)] & zone::kPayload;
      const ListFaces& list = faces_.lists[number_of_list];
      const unsigned same = SameAsFirst(todo, code);
      todo &= ~same;
      Seen seen[ListFaces::kMost];
      unsigned good = list.kind == ListFaces::Kind::kMixed ? 0U : same;
      for (unsigned i = 0; good != 0 && i < list.count; ++i) {
        const FaceForm& form = faces_.forms[list.faces[i]];
        if (form.kind == FaceForm::Kind::kNone) {
          good = 0;
        } else {
          seen[i] = Look(form, p);
          good &= seen[i].good;
        }
      }
      others |= same & ~good;
      if (good != 0) {
        others |= ScreenList(list, number_of_list, seen, good, number);
      }
    }
    return others;
  }

  // Which of a list's faces has the distance at a point, and how far the second is behind it.
  struct Extreme {
    float way;
    float second;
    unsigned face;
  };

  [[gnu::always_inline]] static inline Extreme FindExtreme(const float (*distance)[8],
                                                           unsigned count, float side, int lane) {
    Extreme found{side * distance[0][lane], -3e38F, 0};
    for (unsigned i = 1; i < count; ++i) {
      const float to = side * distance[i][lane];
      found.second = to > found.way ? found.way : (to > found.second ? to : found.second);
      found.face = to > found.way ? i : found.face;
      found.way = to > found.way ? to : found.way;
    }
    return found;
  }

  // The lanes whose distances the surfaces do not decide, or nearly do not.
  unsigned ScreenList(const ListFaces& list, std::uint32_t number_of_list, const Seen* seen,
                      unsigned lanes, const std::uint32_t* number) {
    alignas(32) float distance[ListFaces::kMost][8];
    for (unsigned i = 0; i < list.count; ++i) {
      P::Store(seen[i].distance, distance[i]);
    }
    const float side = list.kind == ListFaces::Kind::kIntersection ? 1.0F : -1.0F;
    unsigned others = 0;
    unsigned hits = 0;
    unsigned met = 0;  // Bits of the faces that decide a hit.
    unsigned deciding[8];
    for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      const unsigned bit = 1U << lane;
      const auto [way, second, last] = FindExtreme(distance, list.count, side, lane);
      if (side > 0 && way >= margin_) {
        continue;
      }
      if (way - second < kUnsure || !(way < -kUnsure || second + way < -kUnsure)) {
        others |= bit;
      } else if (distance[last][lane] < margin_) {
        hits |= bit;
        met |= 1U << last;
        deciding[lane] = last;
      }
    }
    alignas(32) float gradient[ListFaces::kMost][3][8];
    for (; met != 0; met &= met - 1) {
      const int i = __builtin_ctz(met);
      CalcGradient(faces_.forms[list.faces[i]], seen[i], gradient[i]);
    }
    for (; hits != 0; hits &= hits - 1) {
      const int lane = __builtin_ctz(hits);
      const unsigned i = deciding[lane];
      Push({number[lane],
            distance[i][lane],
            {gradient[i][0][lane], gradient[i][1][lane], gradient[i][2][lane]},
            list.faces[i],
            number_of_list});
    }
    return others;
  }

  void PushInBand(unsigned hits, const Sample& s, const float (*position)[8],
                  const std::uint32_t* zones, const std::uint32_t* number) {
    alignas(32) float distance[8];
    alignas(32) float gradient[3][8];
    P::Store(s.distance, distance);
    for (int k = 0; k < 3; ++k) {
      P::Store(s.gradient[k], gradient[k]);
    }
    // Towards the band's ends nodes are clamped: there the coarse grid knows better.
    const float reliable = 0.5F * field_.band;
    for (; hits != 0; hits &= hits - 1) {
      const int lane = __builtin_ctz(hits);
      Hit hit{
          number[lane], distance[lane], {gradient[0][lane], gradient[1][lane], gradient[2][lane]}};
      hit.zone = zones[lane];
      if (distance[lane] < -reliable || distance[lane] > reliable) {
        const float at[3] = {position[0][lane], position[1][lane], position[2][lane]};
        float slope[3];
        const float coarse = CalcCoarse(field_, at, slope);
        if (distance[lane] < 0 ? coarse < hit.distance : coarse > hit.distance) {
          hit.distance = coarse;
          for (int k = 0; k < 3; ++k) {
            hit.gradient[k] = slope[k];
          }
        }
      }
      Push(hit);
    }
  }

  // In no block, inside or outside: which, the directory knows better than the coarse grid.
  void PushCoarse(unsigned lanes, unsigned solid, const float (*position)[8],
                  const std::uint32_t* number) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      const float at[3] = {position[0][lane], position[1][lane], position[2][lane]};
      Hit hit{number[lane], 0.0F, {}};
      const float coarse = CalcCoarse(field_, at, hit.gradient);
      const float side = (solid >> static_cast<unsigned>(lane) & 1U) != 0 ? -1.0F : 1.0F;
      hit.distance = side * coarse > field_.beyond ? coarse : side * field_.beyond;
      if (hit.distance < margin_) {
        Push(hit);
      }
    }
  }

  void Push(const Hit& hit) {
    if (out_->count < out_->capacity) {
      out_->hits[out_->count++] = hit;
    } else {
      out_->is_truncated = true;
    }
  }

  const ShellView& shell_;
  const FieldView& field_;
  FaceView faces_;
  const FloatPose& X_;
  float margin_;
  BoundView bounds_;
  float least_{kNoBound};  // Lower bound of the distance of the points tested last [m].
  HitBuffer* out_;
};

}  // namespace hvas::contact
