// The inner loop of populations, eight assemblies side by side. Included once by each kernel's
// source; nothing here may have external linkage, or the linker could hand one instruction set's
// code to a machine without it. Hence no standard library.
#include "fits/population_kernel.h"

namespace {

using Floats = float __attribute__((vector_size(32)));
using Words = std::uint32_t __attribute__((vector_size(32)));
using Signed = std::int32_t __attribute__((vector_size(32)));
using Bytes = std::uint8_t __attribute__((vector_size(8)));
using Shorts = std::uint16_t __attribute__((vector_size(16)));

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

inline void NextBits(LaneRandom* random, Words* out) {
  Words* s = random->s;
  const Words sum = s[0] + s[3];
  *out = ((sum << 7) | (sum >> 25)) + s[0];
  const Words t = s[1] << 9;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = (s[3] << 11) | (s[3] >> 21);
}

inline void DrawBits(std::uint64_t seed, std::int32_t count, std::uint32_t* bits) {
  LaneRandom random;
  Seed(seed, &random);
  for (std::int32_t i = 0; i < count; i += hvas::fits::kLanes) {
    Words next;
    NextBits(&random, &next);
    __builtin_memcpy(bits + i, &next, sizeof(next));
  }
}

/** Two uniform whole numbers from -32768 to 32767. Roughness in 65536 steps is as good as even: its
 variance is off by 2^-32. */
inline void DrawTwo(LaneRandom* random, Floats* first, Floats* second) {
  Words bits;
  NextBits(random, &bits);
  *first = __builtin_convertvector(reinterpret_cast<Signed>(bits) >> 16, Floats);
  const Words low = bits << 16;
  *second = __builtin_convertvector(reinterpret_cast<Signed>(low) >> 16, Floats);
}

/** Steps above the lowest value, less than kForceBins, as bins: 0 at it, else from 1. */
inline void ToBins(const Floats& steps, std::uint16_t* row) {
  // Up to the next whole number, but for what is less than a 16-millionth of a step.
  const Signed bins = __builtin_convertvector(steps + 0.99999994F, Signed);
  const Shorts shorts = __builtin_convertvector(bins, Shorts);
  __builtin_memcpy(row, &shorts, sizeof(shorts));
}

inline void TakeSizes(hvas::fits::SizeBlock* block) {
  const Floats zero = {};
  const Signed lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  Floats sum = {};
  Floats squares = {};
  Signed interferences = {};
  Signed yields = {};
  for (int first = 0; first < block->assembly_count; first += hvas::fits::kLanes) {
    const Signed is_valid = lanes < block->assembly_count - first;
    Floats hole;
    Floats shaft;
    __builtin_memcpy(&hole, block->hole_um + first, sizeof(hole));
    __builtin_memcpy(&shaft, block->shaft_um + first, sizeof(shaft));
    const Floats from_middle = is_valid ? hole - shaft : zero;
    const Floats clearance = from_middle + block->middle_um;
    const Floats smoothed = clearance + block->loss_um;
    // A tenth of a nanometre: sizes in whole micrometres may meet exactly.
    const Signed interferes = (clearance < -1e-4F) & is_valid;
    const Signed gives = (-smoothed > block->yield_um) & is_valid;
    interferences -= interferes;
    yields -= gives;
    sum += from_middle;
    squares += from_middle * from_middle;
    const Floats mean = is_valid ? 0.5F * smoothed : zero + hvas::fits::kFarApart_um;
    __builtin_memcpy(block->mean_clearance_um + first, &mean, sizeof(mean));
    const Signed marks = (interferes & hvas::fits::kInterferes) | (gives & hvas::fits::kYields);
    Bytes bytes;
    __builtin_memcpy(&bytes, block->marks + first, sizeof(bytes));
    bytes |= __builtin_convertvector(marks, Bytes);
    __builtin_memcpy(block->marks + first, &bytes, sizeof(bytes));
    ToBins((from_middle - block->lowest_um) * block->bins_per_um, block->bins + first);
  }
  block->sum_um = 0;
  block->sum_um2 = 0;
  block->interferences = 0;
  block->yields = 0;
  for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
    block->sum_um += static_cast<double>(sum[lane]);
    block->sum_um2 += static_cast<double>(squares[lane]);
    block->interferences += interferences[lane];
    block->yields += yields[lane];
  }
}

/** S at a station [um]: `size_um` its magnitude, and `twice_um` two times max(0, -S), size_um - S.
 */
struct Station {
  Floats size_um;
  Floats twice_um;
};

inline Station MakeStation(const Floats& s) {
  const Words bits = reinterpret_cast<Words>(s) & 0x7fffffffU;
  const Floats size = reinterpret_cast<Floats>(bits);
  return {size, size - s};
}

/** Eight times the integral of max(0, -s) over a unit interval along which s goes evenly from a to
 b: with the interferences na, nb at its ends 8 (na + nb)^2 / (2 (|a| + |b|)) = (2 na + 2 nb)^2 /
 (|a| + |b|) holds whether s changes sign or not. Two intervals, with one division. */
inline void IntegrateTwo(const Station& a, const Station& b, const Station& c, Floats* first,
                         Floats* second) {
  // So that nothing is divided by zero between two stations that just touch [um]. Far below what
  // the sum with any other size keeps.
  constexpr float kTiny_um = 1e-12F;
  const Floats ab = a.twice_um + b.twice_um;
  const Floats bc = b.twice_um + c.twice_um;
  const Floats size_ab = a.size_um + b.size_um + kTiny_um;
  const Floats size_bc = b.size_um + c.size_um + kTiny_um;
  const Floats inverse = 1.0F / (size_ab * size_bc);
  *first = ab * ab * (inverse * size_bc);
  *second = bc * bc * (inverse * size_ab);
}

/** The stations of a land from its mouth on, two at a time. */
class Roughness {
 public:
  Roughness(const hvas::fits::LandView& land, int first, LaneRandom* random)
      : random_(random), step_(land.half_roughness_um / 32768) {
    for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
      base_[lane] = land.mean_clearance_um[first + lane];
    }
    base_ += 0.5F * step_;  // The middle of the steps.
  }

  inline void Next(Floats* a, Floats* b) {
    Floats x;
    Floats y;
    DrawTwo(random_, &x, &y);
    *a = base_ + step_ * x;
    *b = base_ + step_ * y;
  }

 private:
  LaneRandom* random_;
  float step_;
  Floats base_;
};

/** Adds a land's forces at the depths of the grid to their totals. */
inline void AddLand(const hvas::fits::LandView& land, int first, int depth_count,
                    LaneRandom* random, Floats* totals) {
  Floats s[hvas::fits::kMaxStations + 2];
  Floats f[hvas::fits::kMaxStations + 2];
  Roughness roughness(land, first, random);
  Floats unused;
  roughness.Next(&s[0], &unused);
  Station before = MakeStation(s[0]);
  const float scale = land.force_per_interval / 8;
  f[0] = Floats{};
  for (int j = 0; j < land.stations; j += 2) {
    roughness.Next(&s[j + 1], &s[j + 2]);
    const Station middle = MakeStation(s[j + 1]);
    const Station after = MakeStation(s[j + 2]);
    Floats one;
    Floats two;
    IntegrateTwo(before, middle, after, &one, &two);
    f[j + 1] = f[j] + scale * one;
    f[j + 2] = f[j + 1] + scale * two;
    before = after;
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
    const Station from = MakeStation(a);
    const Station to = MakeStation(a + at.part * (s[at.interval + 1] - a));
    Floats one;
    Floats unneeded;
    IntegrateTwo(from, to, to, &one, &unneeded);
    totals[d] += f[at.interval] + scale * at.part * one;
  }
}

/** Sorts the forces of eight assemblies at a depth into bins. @param scale  Bins for each of them.
 */
inline void Count(const Floats& force, float scale, int depth, int first,
                  hvas::fits::PopulationBlock* block, Floats* sum) {
  *sum += force;
  ToBins(force * scale, block->bins + static_cast<std::int64_t>(depth) * block->stride + first);
}

/** Whether the depths of the grid are the stations of the one land there is. */
inline bool HasDepthsAtStations(const hvas::fits::PopulationBlock& block) {
  const hvas::fits::LandView& land = block.lands[0];
  if (block.land_count != 1 || land.stations % 2 != 0 || block.depth_count != land.stations + 1 ||
      land.depths[0].interval >= 0) {
    return false;
  }
  for (int d = 1; d < block.depth_count; ++d) {
    if (land.depths[d].interval != d - 1 || !(land.depths[d].part >= 1)) {
      return false;
    }
  }
  return true;
}

/** One land, counted where it is integrated. @param[out] last  The forces at its end. */
inline void CountAtStations(const float* scales, int first, LaneRandom* random,
                            hvas::fits::PopulationBlock* block, Floats* sums, Floats* last) {
  const hvas::fits::LandView& land = block->lands[0];
  Roughness roughness(land, first, random);
  Floats s;
  Floats next;
  roughness.Next(&s, &next);
  Station before = MakeStation(s);
  Floats force = {};  // In eighths of force_per_interval, so that nothing is scaled on the way.
  Count(force, 0, 0, first, block, &sums[0]);
  for (int j = 0; j < land.stations; j += 2) {
    roughness.Next(&s, &next);
    const Station middle = MakeStation(s);
    const Station after = MakeStation(next);
    Floats one = {};
    Floats two = {};
    IntegrateTwo(before, middle, after, &one, &two);
    force += one;
    Count(force, scales[j + 1], j + 1, first, block, &sums[j + 1]);
    force += two;
    Count(force, scales[j + 2], j + 2, first, block, &sums[j + 2]);
    before = after;
  }
  *last = force;
}

inline void CountForces(hvas::fits::PopulationBlock* block) {
  LaneRandom random;
  Seed(block->seed, &random);
  Floats totals[hvas::fits::kMaxStations + 1] = {};
  Floats sums[hvas::fits::kMaxStations + 1] = {};
  float scales[hvas::fits::kMaxStations + 1] = {};
  const bool is_simple = HasDepthsAtStations(*block);
  const float unit = is_simple ? block->lands[0].force_per_interval / 8 : 1;
  for (int d = 0; d < block->depth_count; ++d) {
    scales[d] = block->bins_per_newton[d] * unit;
  }
  Signed over = {};
  for (int first = 0; first < block->assembly_count; first += hvas::fits::kLanes) {
    Floats last = {};
    if (is_simple) {
      CountAtStations(scales, first, &random, block, sums, &last);
    } else {
      for (int d = 0; d < block->depth_count; ++d) {
        totals[d] = Floats{};
      }
      for (int i = 0; i < block->land_count; ++i) {
        AddLand(block->lands[i], first, block->depth_count, &random, totals);
      }
      for (int d = 0; d < block->depth_count; ++d) {
        Count(totals[d], scales[d], d, first, block, &sums[d]);
      }
      last = totals[block->depth_count - 1];
    }
    over -= last * unit > block->press_force;
  }
  block->over_press = 0;
  for (int lane = 0; lane < hvas::fits::kLanes; ++lane) {
    block->over_press += over[lane];
    for (int d = 0; d < block->depth_count; ++d) {
      block->sums[d * hvas::fits::kLanes + lane] = sums[d][lane] * unit;
    }
  }
}

}  // namespace
