// Compiled with -mavx2, as kernel_avx2.cc is, and for the same reason without the standard library.
#include <immintrin.h>

#include "contact/closest_kernel.h"

namespace hvas::contact {
namespace {

using Four = __m256d;

// Rows become columns.
void Transpose(Four* r0, Four* r1, Four* r2, Four* r3) {
  const Four a = _mm256_unpacklo_pd(*r0, *r1);
  const Four b = _mm256_unpackhi_pd(*r0, *r1);
  const Four c = _mm256_unpacklo_pd(*r2, *r3);
  const Four d = _mm256_unpackhi_pd(*r2, *r3);
  *r0 = _mm256_permute2f128_pd(a, c, 0x20);
  *r1 = _mm256_permute2f128_pd(b, d, 0x20);
  *r2 = _mm256_permute2f128_pd(a, c, 0x31);
  *r3 = _mm256_permute2f128_pd(b, d, 0x31);
}

Four Dot(const Four u[3], const Four v[3]) {
  return _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(u[0], v[0]), _mm256_mul_pd(u[1], v[1])),
                       _mm256_mul_pd(u[2], v[2]));
}

Four LessOrEqual(Four a, Four b) {
  return _mm256_cmp_pd(a, b, _CMP_LE_OQ);
}

Four Select(Four mask, Four yes, Four no) {
  return _mm256_blendv_pd(no, yes, mask);
}

Four IsFeature(Four feature, double number) {
  return _mm256_cmp_pd(feature, _mm256_set1_pd(number), _CMP_EQ_OQ);
}

// Four triangles, coordinate by coordinate, and the dot products of their sides.
struct FourTriangles {
  Four a[3];
  Four b[3];
  Four c[3];
  Four ab[3];
  Four ac[3];
  Four ab_ab;
  Four ab_ac;
  Four ac_ac;
};

// Where results of four triangles go.
struct FourResults {
  double* at[3];
  double* squared;
  std::int32_t* features;
};

void CalcSides(FourTriangles* t) {
  for (int k = 0; k < 3; ++k) {
    t->ab[k] = _mm256_sub_pd(t->b[k], t->a[k]);
    t->ac[k] = _mm256_sub_pd(t->c[k], t->a[k]);
  }
}

// The closest points, q = a + u ab + v ac, and the features that they are on.
struct FourWeights {
  Four u;
  Four v;
  Four feature;  // As in CalcClosestOnTriangle.
};

// What CalcClosestOnTriangle decides one after the other is decided here at once; what it looks at
// first is selected last.
[[gnu::always_inline]] inline FourWeights FindWeights(const FourTriangles& t, const Four point[3]) {
  Four ap[3];
  for (int k = 0; k < 3; ++k) {
    ap[k] = _mm256_sub_pd(point[k], t.a[k]);
  }
  const Four zero = _mm256_setzero_pd();
  const Four d1 = Dot(t.ab, ap);
  const Four d2 = Dot(t.ac, ap);
  const Four d3 = _mm256_sub_pd(d1, t.ab_ab);
  const Four d4 = _mm256_sub_pd(d2, t.ab_ac);
  const Four d5 = _mm256_sub_pd(d1, t.ab_ac);
  const Four d6 = _mm256_sub_pd(d2, t.ac_ac);
  const Four d43 = _mm256_sub_pd(d4, d3);
  const Four d56 = _mm256_sub_pd(d5, d6);
  const Four vc = _mm256_sub_pd(_mm256_mul_pd(d1, d4), _mm256_mul_pd(d3, d2));
  const Four vb = _mm256_sub_pd(_mm256_mul_pd(d5, d2), _mm256_mul_pd(d1, d6));
  const Four va = _mm256_sub_pd(_mm256_mul_pd(d3, d6), _mm256_mul_pd(d5, d4));
  const auto all = [](Four x, Four y, Four z) { return _mm256_and_pd(_mm256_and_pd(x, y), z); };
  const Four at_a = _mm256_and_pd(LessOrEqual(d1, zero), LessOrEqual(d2, zero));
  const Four at_b = _mm256_and_pd(LessOrEqual(zero, d3), LessOrEqual(d4, d3));
  const Four at_c = _mm256_and_pd(LessOrEqual(zero, d6), LessOrEqual(d5, d6));
  const Four on_ab = all(LessOrEqual(vc, zero), LessOrEqual(zero, d1), LessOrEqual(d3, zero));
  const Four on_ac = all(LessOrEqual(vb, zero), LessOrEqual(zero, d2), LessOrEqual(d6, zero));
  const Four on_bc = all(LessOrEqual(va, zero), LessOrEqual(zero, d43), LessOrEqual(zero, d56));

  // u and v are over one denominator.
  Four below = _mm256_add_pd(_mm256_add_pd(va, vb), vc);
  Four feature =
      _mm256_andnot_pd(_mm256_cmp_pd(below, zero, _CMP_GT_OQ), _mm256_set1_pd(4));  // No area.
  below = Select(on_bc, _mm256_add_pd(d43, d56), below);
  Four u = vb;
  Four v = Select(on_bc, d43, vc);
  feature = Select(on_bc, _mm256_set1_pd(2), feature);
  below = Select(on_ac, _mm256_sub_pd(d2, d6), below);
  u = Select(on_ac, zero, u);
  v = Select(on_ac, d2, v);
  feature = Select(on_ac, _mm256_set1_pd(3), feature);
  feature = Select(at_c, _mm256_set1_pd(6), feature);
  below = Select(on_ab, _mm256_sub_pd(d1, d3), below);
  u = Select(on_ab, d1, u);
  v = Select(on_ab, zero, v);
  feature = Select(on_ab, _mm256_set1_pd(1), feature);
  feature = Select(at_b, _mm256_set1_pd(5), feature);
  feature = Select(at_a, _mm256_set1_pd(4), feature);
  v = _mm256_div_pd(v, below);
  u = Select(IsFeature(feature, 2), _mm256_sub_pd(_mm256_set1_pd(1), v), _mm256_div_pd(u, below));
  return {u, v, feature};
}

[[gnu::always_inline]] inline void CalcFour(const FourTriangles& t, const Four point[3],
                                            const FourResults& out) {
  const auto [u, v, feature] = FindWeights(t, point);
  const Four is_a = IsFeature(feature, 4);
  const Four is_b = IsFeature(feature, 5);
  const Four is_c = IsFeature(feature, 6);
  Four way[3];
  for (int k = 0; k < 3; ++k) {
    Four q =
        _mm256_add_pd(_mm256_add_pd(t.a[k], _mm256_mul_pd(u, t.ab[k])), _mm256_mul_pd(v, t.ac[k]));
    q = Select(is_a, t.a[k], Select(is_b, t.b[k], Select(is_c, t.c[k], q)));
    _mm256_storeu_pd(out.at[k], q);
    way[k] = _mm256_sub_pd(q, point[k]);
  }
  _mm256_storeu_pd(out.squared, Dot(way, way));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out.features), _mm256_cvttpd_epi32(feature));
}

}  // namespace

void CalcEightClosestAvx2(const TriangleCorners* triangles, const std::uint32_t numbers[8],
                          int count, const EightPoints& p, EightClosest* out) noexcept {
  for (int first = 0; first < count; first += 4) {
    // Twelve numbers of each triangle, read in threes of four.
    Four n[12];
    for (int row = 0; row < 12; row += 4) {
      for (int i = 0; i < 4; ++i) {
        n[row + i] = _mm256_loadu_pd(triangles[numbers[first + i]].a + row);
      }
      Transpose(&n[row], &n[row + 1], &n[row + 2], &n[row + 3]);
    }
    FourTriangles t;
    Four point[3];
    for (int k = 0; k < 3; ++k) {
      t.a[k] = n[k];
      t.b[k] = n[3 + k];
      t.c[k] = n[6 + k];
      point[k] = _mm256_loadu_pd(p.at[k] + first);
    }
    t.ab_ab = n[9];
    t.ab_ac = n[10];
    t.ac_ac = n[11];
    CalcSides(&t);
    CalcFour(t, point,
             {{out->q.at[0] + first, out->q.at[1] + first, out->q.at[2] + first},
              out->squared + first,
              out->features + first});
  }
}

void CalcFourClosestAvx2(const TriangleArrays& mesh, const std::uint32_t numbers[4],
                         const double p[3], FourClosest* out) noexcept {
  const __m256i three = _mm256_setr_epi64x(-1, -1, -1, 0);
  FourTriangles t;
  Four* const corners[3] = {t.a, t.b, t.c};
  for (int corner = 0; corner < 3; ++corner) {
    Four row[4];
    for (int i = 0; i < 4; ++i) {
      row[i] = _mm256_maskload_pd(mesh.vertices[mesh.triangles[numbers[i]][corner]], three);
    }
    Transpose(&row[0], &row[1], &row[2], &row[3]);
    for (int k = 0; k < 3; ++k) {
      corners[corner][k] = row[k];
    }
  }
  CalcSides(&t);
  t.ab_ab = Dot(t.ab, t.ab);
  t.ab_ac = Dot(t.ab, t.ac);
  t.ac_ac = Dot(t.ac, t.ac);
  const Four point[3] = {_mm256_set1_pd(p[0]), _mm256_set1_pd(p[1]), _mm256_set1_pd(p[2])};
  CalcFour(t, point, {{out->at[0], out->at[1], out->at[2]}, out->squared, out->features});
}

}  // namespace hvas::contact
