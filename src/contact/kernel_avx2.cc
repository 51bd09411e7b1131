// Compiled with -mavx2: nothing here may be an inline function that other sources use as well, or
// the linker could hand its AVX2 version to a machine without. Hence no standard library.
#include <immintrin.h>

#include "contact/kernel.h"
#include "contact/traverse.inl.h"

namespace hvas::contact {
namespace {

struct Avx2Pack {
  using Float = __m256;
  using Int = __m256i;
  using Mask = __m256;

  static Float Load(const float* p) { return _mm256_loadu_ps(p); }

  static void Store(Float a, float* p) { _mm256_storeu_ps(p, a); }

  static void StoreInt(Int a, std::int32_t* p) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a);
  }

  static Float Set(float a) { return _mm256_set1_ps(a); }

  static Int SetInt(std::int32_t a) { return _mm256_set1_epi32(a); }

  static Float Add(Float a, Float b) { return _mm256_add_ps(a, b); }

  static Float Sub(Float a, Float b) { return _mm256_sub_ps(a, b); }

  static Float Mul(Float a, Float b) { return _mm256_mul_ps(a, b); }

  static Float Div(Float a, Float b) { return _mm256_div_ps(a, b); }

  static Float Min(Float a, Float b) { return _mm256_min_ps(a, b); }

  static Float Max(Float a, Float b) { return _mm256_max_ps(a, b); }

  static Float Sqrt(Float a) { return _mm256_sqrt_ps(a); }

  static Mask Less(Float a, Float b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }

  static Mask And(Mask a, Mask b) { return _mm256_and_ps(a, b); }

  static Float Select(Mask m, Float yes, Float no) { return _mm256_blendv_ps(no, yes, m); }

  static float Least(Float a) {
    __m128 b = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    b = _mm_min_ps(b, _mm_movehl_ps(b, b));
    return _mm_cvtss_f32(_mm_min_ss(b, _mm_shuffle_ps(b, b, 1)));
  }

  static unsigned Bits(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps(m)); }

  static Int Truncate(Float a) { return _mm256_cvttps_epi32(a); }

  static Float ToFloat(Int a) { return _mm256_cvtepi32_ps(a); }

  static Int AddInt(Int a, Int b) { return _mm256_add_epi32(a, b); }

  static Int MulInt(Int a, Int b) { return _mm256_mullo_epi32(a, b); }

  static Int MaxInt(Int a, Int b) { return _mm256_max_epi32(a, b); }

  static Int AndInt(Int a, std::int32_t b) { return _mm256_and_si256(a, _mm256_set1_epi32(b)); }

  static Int ShiftRight3(Int a) { return _mm256_srai_epi32(a, 3); }

  static Mask LessInt(Int a, Int b) { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a)); }

  static Float Gather(const float* p, Int index) { return _mm256_i32gather_ps(p, index, 4); }

  static Int GatherInt(const std::int32_t* p, Int index) {
    return _mm256_i32gather_epi32(p, index, 4);
  }

  static void GatherPair(const std::int16_t* p, Int index, Float* first, Float* second) {
    const Int both = _mm256_i32gather_epi32(reinterpret_cast<const int*>(p), index, 2);
    *first = _mm256_cvtepi32_ps(_mm256_srai_epi32(_mm256_slli_epi32(both, 16), 16));
    *second = _mm256_cvtepi32_ps(_mm256_srai_epi32(both, 16));
  }
};

}  // namespace

Kernel Avx2Kernel() noexcept {
  return {&Traversal<Avx2Pack>::Collect, &Traversal<Avx2Pack>::Test};
}

}  // namespace hvas::contact
