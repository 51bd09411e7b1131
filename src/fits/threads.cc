#include "fits/threads.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"

namespace hvas::fits {
namespace {

struct MetricThread {
  double diameter_mm, pitch_mm, tap_drill_mm, fine_mm, medium_mm, coarse_mm;
};

struct FineThreads {
  double diameter_mm;
  double pitches_mm[5];
};

struct InchThread {
  const char* designation;
  double diameter_mm;
  int threads_per_inch;
  double tap_drill_mm, fine_mm, medium_mm, coarse_mm;
};

#include "fits/thread_tables.inc"

std::vector<Thread> MakeThreads() {
  using units::FromMm;
  std::vector<Thread> threads;
  for (const MetricThread& row : kCoarseThreads) {
    threads.push_back({fmt::format("M{:g}", row.diameter_mm), FromMm(row.diameter_mm),
                       FromMm(row.pitch_mm), FromMm(row.tap_drill_mm), FromMm(row.fine_mm),
                       FromMm(row.medium_mm), FromMm(row.coarse_mm), true});
  }
  for (const FineThreads& row : kFineThreads) {
    const auto coarse =
        std::find_if(std::begin(kCoarseThreads), std::end(kCoarseThreads),
                     [&row](const MetricThread& c) { return c.diameter_mm == row.diameter_mm; });
    const MetricThread holes = coarse != std::end(kCoarseThreads) ? *coarse : MetricThread{};
    for (const double pitch_mm : row.pitches_mm) {
      if (pitch_mm > 0) {
        threads.push_back({fmt::format("M{:g}x{:g}", row.diameter_mm, pitch_mm),
                           FromMm(row.diameter_mm), FromMm(pitch_mm),
                           FromMm(row.diameter_mm - pitch_mm), FromMm(holes.fine_mm),
                           FromMm(holes.medium_mm), FromMm(holes.coarse_mm), false});
      }
    }
  }
  for (const InchThread& row : kInchThreads) {
    threads.push_back({row.designation, FromMm(row.diameter_mm),
                       units::kMetresPerInch / row.threads_per_inch, FromMm(row.tap_drill_mm),
                       FromMm(row.fine_mm), FromMm(row.medium_mm), FromMm(row.coarse_mm),
                       std::string_view(row.designation).ends_with("UNC")});
  }
  return threads;
}

}  // namespace

double Thread::stress_area() const {
  const double mean = 0.5 * (pitch_diameter() + core_diameter());
  return 0.25 * std::numbers::pi * mean * mean;
}

std::span<const Thread> ListThreads() {
  static const std::vector<Thread> threads = MakeThreads();
  return threads;
}

namespace {

/** How far a drawn hole is from the diameters at which holes of a thread are drawn, the nearest
 counting: D1, the drill that leaves a pitch, the tap drill, and d3. */
double CalcHoleError(const Thread& thread, double hole) {
  double error = std::abs(hole - thread.minor_diameter());
  for (const double drawn :
       {thread.diameter - thread.pitch, thread.tap_drill, thread.core_diameter()}) {
    error = std::min(error, std::abs(hole - drawn));
  }
  return error;
}

}  // namespace

const Thread* FindThreadOfPair(double hole, double shaft) {
  // Choices: drawings round to hundredths, and holes of larger threads to tenths.
  constexpr double kRounding = 20e-6;    // [m]
  constexpr double kOfThePitch = 0.015;  // Beside it.
  const Thread* best = nullptr;
  double least = 0;
  for (const Thread& thread : ListThreads()) {
    const double most = kRounding + kOfThePitch * thread.pitch;
    const double of_shaft = std::abs(shaft - thread.diameter);
    const double of_hole = CalcHoleError(thread, hole);
    if (of_shaft > most || of_hole > most) {
      continue;
    }
    if (best == nullptr || of_shaft + of_hole < least - 1e-9) {
      best = &thread;
      least = of_shaft + of_hole;
    }
  }
  return best;
}

const Thread* FindThread(double diameter, double pitch) {
  constexpr double kNear = 0.02;  // Of the diameter: screws are drawn below it by their tolerance.
  const Thread* best = nullptr;
  double least = 0;
  for (const Thread& thread : ListThreads()) {
    const double off = std::abs(diameter - thread.diameter) / thread.diameter;
    if (off > kNear || (pitch <= 0 && !thread.is_coarse)) {
      continue;
    }
    const double score = pitch > 0 ? std::abs(pitch - thread.pitch) / thread.pitch + off : off;
    if (best == nullptr || score < least - 1e-9) {
      best = &thread;
      least = score;
    }
  }
  return best;
}

ThreadHole ClassifyThreadHole(const Thread& thread, double hole) {
  constexpr double kRounding = 1e-5;  // Of a drawn diameter, where it is written in hundredths [m].
  constexpr double kWidest = 1.05;    // Of the coarse series: somebody's own round figure.
  const double drilled = std::max(thread.tap_drill, thread.minor_diameter());
  const double widest =
      thread.clearance_coarse > 0 ? thread.clearance_coarse : 1.2 * thread.diameter;
  if (hole < thread.core_diameter() - kRounding) {
    return ThreadHole::kUndersized;
  }
  if (hole <= drilled + kRounding) {
    return ThreadHole::kCore;
  }
  if (hole <= thread.diameter + kRounding) {
    return ThreadHole::kNominal;
  }
  return hole <= kWidest * widest ? ThreadHole::kClearance : ThreadHole::kWide;
}

Tightening CalcTightening(const Thread& thread, double yield_stress, double mu_thread,
                          double mu_head, double head_diameter) {
  constexpr double kUse = 0.9;           // Of the yield point: nu of VDI 2230-1.
  constexpr double kFlankAngle = 1.155;  // 1 / cos 30 deg: the flanks of a profile of 60 deg.
  const double d2 = thread.pitch_diameter();
  const double d0 = 0.5 * (d2 + thread.core_diameter());
  const double twist =
      1.5 * (d2 / d0) * (thread.pitch / (std::numbers::pi * d2) + kFlankAngle * mu_thread);
  Tightening tightening;
  tightening.preload =
      kUse * yield_stress * thread.stress_area() / std::sqrt(1 + 3 * twist * twist);
  tightening.torque = tightening.preload *
                      (0.16 * thread.pitch + 0.58 * d2 * mu_thread + 0.5 * head_diameter * mu_head);
  return tightening;
}

double CalcMeanFlankPlay(const Thread& thread) {
  const double pitch_mm = units::ToMm(thread.pitch);
  const double allowance_um = 15 + 11 * pitch_mm;
  const double screw_um =
      90 * std::pow(pitch_mm, 0.4) * std::pow(units::ToMm(thread.diameter), 0.1);
  const double nut_um = 1.32 * screw_um;
  const double play = 1e-6 * (allowance_um + 0.5 * (screw_um + nut_um));
  return play * std::tan(std::numbers::pi / 6);
}

double CalcJointStiffness(const Thread& thread, double clamped) {
  constexpr double kModulus = 210e9;  // [Pa] of steel.
  const double d = thread.diameter;
  const double core = 0.25 * std::numbers::pi * thread.core_diameter() * thread.core_diameter();
  const double shank = 0.25 * std::numbers::pi * d * d;
  const double screw =
      (0.5 * d / shank + clamped / core + 0.5 * d / core + 0.4 * d / shank) / kModulus;
  constexpr double kTan30 = 0.5774;  // As the equation has it.
  const double cones =
      kTan30 * std::numbers::pi * kModulus * d /
      (2 * std::log(5 * (kTan30 * clamped + 0.5 * d) / (kTan30 * clamped + 2.5 * d)));
  return 1 / (screw + 1 / cones);
}

}  // namespace hvas::fits
