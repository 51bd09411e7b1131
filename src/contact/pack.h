#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

/** Eight lanes without instructions of their own: the reference for the vector kernel. Every
 operation rounds once, as its vector twin does, so that both give the same bits. */
namespace hvas::contact {

struct ScalarPack {
  struct Float {
    float v[8];
  };

  struct Int {
    std::int32_t v[8];
  };

  struct Mask {
    bool v[8];
  };

  template <typename Out, typename Operation>
  static Out Map(Operation operation) {
    Out out;
    for (int i = 0; i < 8; ++i) {
      out.v[i] = operation(i);
    }
    return out;
  }

  static Float Load(const float* p) {
    return Map<Float>([&](int i) { return p[i]; });
  }

  static void Store(const Float& a, float* p) { std::memcpy(p, a.v, sizeof(a.v)); }

  static void StoreInt(const Int& a, std::int32_t* p) { std::memcpy(p, a.v, sizeof(a.v)); }

  static Float Set(float a) {
    return Map<Float>([&](int) { return a; });
  }

  static Int SetInt(std::int32_t a) {
    return Map<Int>([&](int) { return a; });
  }

  static Float Add(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] + b.v[i]; });
  }

  static Float Sub(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] - b.v[i]; });
  }

  static Float Mul(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] * b.v[i]; });
  }

  static Float Div(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] / b.v[i]; });
  }

  static Float Min(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] < b.v[i] ? a.v[i] : b.v[i]; });
  }

  static Float Max(const Float& a, const Float& b) {
    return Map<Float>([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
  }

  static Float Sqrt(const Float& a) {
    return Map<Float>([&](int i) { return __builtin_sqrtf(a.v[i]); });
  }

  static Mask Less(const Float& a, const Float& b) {
    return Map<Mask>([&](int i) { return a.v[i] < b.v[i]; });
  }

  static Mask And(const Mask& a, const Mask& b) {
    return Map<Mask>([&](int i) { return a.v[i] && b.v[i]; });
  }

  static Float Select(const Mask& m, const Float& yes, const Float& no) {
    return Map<Float>([&](int i) { return m.v[i] ? yes.v[i] : no.v[i]; });
  }

  static float Least(const Float& a) {
    float least = a.v[0];
    for (int i = 1; i < 8; ++i) {
      least = a.v[i] < least ? a.v[i] : least;
    }
    return least;
  }

  static unsigned Bits(const Mask& m) {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) {
      bits |= (m.v[i] ? 1U : 0U) << i;
    }
    return bits;
  }

  static Int Truncate(const Float& a) {
    return Map<Int>([&](int i) { return static_cast<std::int32_t>(a.v[i]); });
  }

  static Float ToFloat(const Int& a) {
    return Map<Float>([&](int i) { return static_cast<float>(a.v[i]); });
  }

  static Int AddInt(const Int& a, const Int& b) {
    return Map<Int>([&](int i) { return a.v[i] + b.v[i]; });
  }

  static Int MulInt(const Int& a, const Int& b) {
    return Map<Int>([&](int i) { return a.v[i] * b.v[i]; });
  }

  static Int MaxInt(const Int& a, const Int& b) {
    return Map<Int>([&](int i) { return a.v[i] > b.v[i] ? a.v[i] : b.v[i]; });
  }

  static Int AndInt(const Int& a, std::int32_t b) {
    return Map<Int>([&](int i) { return a.v[i] & b; });
  }

  static Int ShiftRight3(const Int& a) {
    return Map<Int>([&](int i) { return a.v[i] >> 3; });
  }

  static Mask LessInt(const Int& a, const Int& b) {
    return Map<Mask>([&](int i) { return a.v[i] < b.v[i]; });
  }

  static Float Gather(const float* p, const Int& index) {
    return Map<Float>([&](int i) { return p[index.v[i]]; });
  }

  static Int GatherInt(const std::int32_t* p, const Int& index) {
    return Map<Int>([&](int i) { return p[index.v[i]]; });
  }

  /** Two neighbours of a table of 16-bit integers. */
  static void GatherPair(const std::int16_t* p, const Int& index, Float* first, Float* second) {
    *first = Map<Float>([&](int i) { return static_cast<float>(p[index.v[i]]); });
    *second = Map<Float>([&](int i) { return static_cast<float>(p[index.v[i] + 1]); });
  }
};

}  // namespace hvas::contact
