#include "app/devices/doctor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/devices/doctor_checks.h"
#include "app/devices/latency_json.h"
#include "app/output/json_flag.h"
#include "app/output/progress.h"
#include "app/output/terminal.h"
#include "app/output/text_layout.h"
#include "base/clock.h"
#include "base/histogram.h"
#include "simulation/realtime_thread.h"

namespace hvas::app {
namespace {

// The exit status: the machine is no good for a haptic loop.
constexpr int kNotGood = 2;
// A wake-up that comes later than this leaves too little of a period for the tick.
constexpr double kLatestShare = 0.5;

struct DoctorOptions {
  double seconds{5};     ///< Long enough for wake-ups that are late once a second [s].
  double rate_hz{1000};  ///< X4 asks for 1 kHz.
  bool is_json{false};
};

struct Measured {
  simulation::RealtimeGrant grant;
  LatencyHistogram wake_up;
  std::uint64_t late{0};    ///< Woke up more than a period after the deadline.
  std::uint64_t missed{0};  ///< Periods that were passed over.
};

/** A thread that does nothing but wake up, as the haptic thread would. */
Measured MeasureWakeUps(const DoctorOptions& options) {
  Measured measured;
  const auto period_ns = std::llround(1e9 / options.rate_hz);
  std::thread thread([&] {
    measured.grant = simulation::RequestRealtime();
    simulation::Pacer pacer(period_ns);
    const std::int64_t end_ns = MonotonicNs() + std::llround(1e9 * options.seconds);
    while (MonotonicNs() < end_ns) {
      const std::int64_t late_ns = pacer.Wait();
      measured.wake_up.Add(late_ns);
      measured.late += late_ns > period_ns ? 1 : 0;
    }
    measured.missed = pacer.missed();
  });
  thread.join();
  simulation::ReleaseRealtime();
  return measured;
}

bool IsPunctual(const Measured& measured, double rate_hz) {
  const double latest_ns = kLatestShare * 1e9 / rate_hz;
  return static_cast<double>(measured.wake_up.Quantile(0.999)) < latest_ns && measured.late == 0;
}

void PrintJson(const std::vector<DoctorCheck>& checks, const Measured& measured,
               const DoctorOptions& options) {
  nlohmann::ordered_json document;
  document["schema"] = 1;
  document["checks"] = nlohmann::ordered_json::array();
  for (const DoctorCheck& check : checks) {
    document["checks"].push_back({{"name", check.name},
                                  {"value", check.value},
                                  {"good", check.is_good},
                                  {"remedy", check.remedy}});
  }
  document["rate_hz"] = options.rate_hz;
  document["wake_ups"] = measured.wake_up.count();
  document["scheduling"] = measured.grant.ToString();
  document["wake_up_us"] = MakeLatencyJson(measured.wake_up);
  document["late_wake_ups"] = measured.late;
  document["missed_periods"] = measured.missed;
  document["punctual"] = IsPunctual(measured, options.rate_hz);
  fmt::print("{}\n", document.dump(2));
}

void PrintText(const std::vector<DoctorCheck>& checks, const Measured& measured,
               const DoctorOptions& options) {
  for (const DoctorCheck& check : checks) {
    const std::string line =
        Fold(fmt::format("      {} {}", PadTo(check.name, 28), check.value)).substr(4);
    fmt::print("{}{}", check.is_good ? Painted("good", Style::kGood) : Painted("LOOK", Style::kBad),
               line);
    if (!check.is_good) {
      fmt::print("{}", Wrap(check.remedy, 8));
    }
  }
  fmt::print("\n{}",
             Fold(fmt::format("A thread that wakes up {:.0f} times a second, for {:.3g} s: "
                              "{}.\n",
                              options.rate_hz, options.seconds, measured.grant.ToString())));
  PrintLatencyHistogram("wake-up after the deadline", measured.wake_up);
  fmt::print("{}", Fold(fmt::format(
                       "{} of {} wake-ups were more than a period late, {} periods were skipped.\n"
                       "{}",
                       measured.late, measured.wake_up.count(), measured.missed,
                       IsPunctual(measured, options.rate_hz)
                           ? "This machine meets the deadlines of a loop at this rate.\n"
                           : "This machine misses some deadlines of a loop at this rate. The force "
                             "of a device is reduced meanwhile, and never increased.\n")));
}

int RunDoctor(const DoctorOptions& options) {
  const std::vector<DoctorCheck> checks = CheckMachine("/");
  const Measured measured = [&options] {
    const Busy busy(fmt::format("measuring for {:.3g} s", options.seconds));
    return MeasureWakeUps(options);
  }();
  if (options.is_json) {
    PrintJson(checks, measured, options);
  } else {
    PrintText(checks, measured, options);
  }
  return IsPunctual(measured, options.rate_hz) ? 0 : kNotGood;
}

}  // namespace

void AddDoctor(CLI::App* app, int* status) {
  CLI::App* command = app->add_subcommand(
      "doctor",
      "Check whether this machine meets the deadlines of a haptic loop, and what would help");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("--seconds", options->seconds, "Duration of the measurement [s]")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--rate", options->rate_hz, "Rate of the loop [Hz]")
      ->check(CLI::Range(100.0, 8000.0))
      ->capture_default_str();
  AddJsonFlag(command, &options->is_json, "doctor");
  command->footer(
      "Exit status: 0 when 999 of 1000 wake-ups are less than half a period late and none a full "
      "period,\n"
      "2 otherwise, 1 on an error.\n"
      "Examples:\n"
      "  hvas doctor\n"
      "  hvas doctor --rate 4000 --seconds 60\n"
      "  hvas doctor --json | jq '.checks[] | select(.good | not)'");
  command->callback([options, status] { *status = RunDoctor(*options); });
}

}  // namespace hvas::app
