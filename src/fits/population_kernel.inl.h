// The inner loop of populations, eight assemblies side by side. Included once by each kernel's
// source; nothing here may have external linkage, or the linker could hand one instruction set's
// code to a machine without it. Hence no standard library.
#include "fits/population_kernel.h"

namespace {

using Floats = float __attribute__((vector_size(32)));
using Words = std::uint32_t __attribute__((vector_size(32)));
using Signed = std::int32_t __attribute__((vector_size(32)));

/** xoshiro128++ (Blackman and Vigna, ACM TOMS 47(4), 2021) in every lane. */
struct LaneRandom {
  Words s[4];
};

inline void Seed(std::uint64_t seed, LaneRandom* random) {
  // SplitMix64, as its authors recommend.
  for (int k = 0; k < 4; ++k) {
    for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
      seed += 0x9e3779b97f4a7c15ULL;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
      z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
      random->s[k][lane] = static_cast<std::uint32_t>((z ^ (z >> 31U)) >> 32U);
    }
  }
}

/** Uniform in [-1, 1), 23 bits. */
inline void Draw(LaneRandom* random, Floats* out) {
  Words* s = random->s;
  const Words sum = s[0] + s[3];
  const Words bits = ((sum << 7) | (sum >> 25)) + s[0];
  const Words t = s[1] << 9;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = (s[3] << 11) | (s[3] >> 21);
  // Exponent of [2, 4), less 3.
  const Words mantissa = (bits >> 9) | 0x40000000U;
  *out = reinterpret_cast<Floats>(mantissa) - 3.0F;
}

/** Integral of max(0, -s) over a unit interval along which s goes evenly from a to b: with the
 interferences na, nb at its ends (na + nb)^2 / (2 (|a| + |b|)) holds whether s changes sign or
 not. */
inline void Integrate(const Floats& a, const Floats& b, Floats* out) {
  const Floats zero = {};
  const Floats na = a < zero ? -a : zero;
  const Floats nb = b < zero ? -b : zero;
  const Floats size_a = a < zero ? -a : a;
  const Floats size_b = b < zero ? -b : b;
  const Floats sum = na + nb;
  *out = 0.5F * sum * sum / (size_a + size_b + 1e-30F);
}

inline void AddLand(const hvas::fits::LandView& land, int first, int depth_count,
                    LaneRandom* random, Floats* totals) {
  Floats s[hvas::fits::kMaxStations + 1];
  Floats f[hvas::fits::kMaxStations + 1];
  Floats mean;
  for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
    mean[lane] = land.mean_clearance_um[first + lane];
  }
  f[0] = Floats{};
  for (int j = 0; j <= land.stations; ++j) {
    Floats u;
    Draw(random, &u);
    s[j] = mean + land.half_roughness_um * u;
    if (j > 0) {
      Floats interference;
      Integrate(s[j - 1], s[j], &interference);
      f[j] = f[j - 1] + land.force_per_interval * interference;
    }
  }
  for (int d = 0; d < depth_count; ++d) {
    const hvas::fits::LandDepth at = land.depths[d];
    if (at.interval < 0) {
      continue;
    }
    if (at.part >= 1) {
      totals[d] += f[at.interval + 1];
      continue;
    }
    const Floats& a = s[at.interval];
    Floats interference;
    Integrate(a, a + at.part * (s[at.interval + 1] - a), &interference);
    totals[d] += f[at.interval] + land.force_per_interval * at.part * interference;
  }
}

/** Adds the forces of eight assemblies, `valid` of them real, to what a block counts. */
inline void Count(const Floats& force, const Floats& valid, int depth, int first,
                  hvas::fits::PopulationBlock* block, Floats* sum) {
  *sum += force * valid;
  const Floats zero = {};
  const Floats highest = zero + static_cast<float>(hvas::fits::kForceBins - 1);
  Floats at = force * block->bins_per_newton[depth];
  at = at < highest ? at : highest;
  // Comparisons give -1 where true.
  const Signed bins = __builtin_convertvector(at, Signed) - (force > zero);
  std::uint16_t* row = block->bins + static_cast<std::int64_t>(depth) * block->stride + first;
  for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
    row[lane] = static_cast<std::uint16_t>(bins[lane]);
  }
}

inline void CountForces(hvas::fits::PopulationBlock* block) {
  LaneRandom random;
  Seed(block->seed, &random);
  Floats totals[hvas::fits::kMaxStations + 1];
  Floats sums[hvas::fits::kMaxStations + 1];
  for (int d = 0; d < block->depth_count; ++d) {
    sums[d] = Floats{};
  }
  block->over_press = 0;
  for (int first = 0; first < block->assembly_count; first += hvas::fits::kLanes) {
    Floats valid;
    for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
      valid[lane] = first + lane < block->assembly_count ? 1.0F : 0.0F;
    }
    for (int d = 0; d < block->depth_count; ++d) {
      totals[d] = Floats{};
    }
    for (int i = 0; i < block->land_count; ++i) {
      AddLand(block->lands[i], first, block->depth_count, &random, totals);
    }
    for (int d = 0; d < block->depth_count; ++d) {
      Count(totals[d], valid, d, first, block, &sums[d]);
    }
    const Floats& last = totals[block->depth_count - 1];
    for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
      block->over_press += last[lane] * valid[lane] > block->press_force ? 1 : 0;
    }
  }
  for (int d = 0; d < block->depth_count; ++d) {
    for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
      block->sums[d * hvas::fits::kLanes + lane] = sums[d][lane];
    }
  }
}

}  // namespace
