#include "contact/kernel.h"
#include "contact/pack.h"
#include "contact/traverse.inl.h"

namespace hvas::contact {

Kernel ScalarKernel() noexcept {
  return {&Traversal<ScalarPack>::Collect, &Traversal<ScalarPack>::Test};
}

Kernel ChooseKernel() noexcept {
#if defined(HVAS_HAS_AVX2_KERNEL)
  if (__builtin_cpu_supports("avx2")) {
    return Avx2Kernel();
  }
#endif
  return ScalarKernel();
}

float CalcCoarse(const FieldView& field, const float p[3], float gradient[3]) noexcept {
  int index[3];
  float w[3];
  float outside[3];
  float squared = 0;
  for (int k = 0; k < 3; ++k) {
    const float last = static_cast<float>(field.coarse_count[k] - 1);
    const float u = (p[k] - field.coarse_origin[k]) / field.coarse_cell;
    const float clamped = u < 0 ? 0 : (u > last ? last : u);
    index[k] = static_cast<int>(clamped);
    index[k] = index[k] > field.coarse_count[k] - 2 ? field.coarse_count[k] - 2 : index[k];
    w[k] = clamped - static_cast<float>(index[k]);
    outside[k] = (u - clamped) * field.coarse_cell;
    squared += outside[k] * outside[k];
  }
  const int row = field.coarse_count[0];
  const int plane = row * field.coarse_count[1];
  const float* d = field.coarse + index[2] * plane + index[1] * row + index[0];
  const auto mix = [](float a, float b, float weight) { return a + weight * (b - a); };
  const float e[4] = {d[1] - d[0], d[row + 1] - d[row], d[plane + 1] - d[plane],
                      d[plane + row + 1] - d[plane + row]};
  const float x[4] = {d[0] + w[0] * e[0], d[row] + w[0] * e[1], d[plane] + w[0] * e[2],
                      d[plane + row] + w[0] * e[3]};
  const float y0 = mix(x[0], x[1], w[1]);
  const float y1 = mix(x[2], x[3], w[1]);
  float distance = mix(y0, y1, w[2]);
  gradient[0] = mix(mix(e[0], e[1], w[1]), mix(e[2], e[3], w[1]), w[2]) / field.coarse_cell;
  gradient[1] = mix(x[1] - x[0], x[3] - x[2], w[2]) / field.coarse_cell;
  gradient[2] = (y1 - y0) / field.coarse_cell;
  if (squared > 0) {
    const float way = __builtin_sqrtf(squared);
    distance += way;
    for (int k = 0; k < 3; ++k) {
      gradient[k] = outside[k] / way;
    }
  }
  return distance;
}

}  // namespace hvas::contact
