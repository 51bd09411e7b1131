#include "cad/process/worker_io.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/write_all.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

constexpr std::int64_t kOftenestNs = 50'000'000;  // 20 times a second.

void WriteLine(std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  line.push_back('\n');
  (void)WriteAll(kProgressDescriptor, std::as_bytes(std::span(line)));
}

}  // namespace

void SendStage(std::string_view stage, double fraction) {
  static std::string last_stage;
  static std::int64_t last_ns = 0;
  const std::int64_t now_ns = MonotonicNs();
  if (stage == last_stage && now_ns - last_ns < kOftenestNs) {
    return;
  }
  last_stage = stage;
  last_ns = now_ns;
  WriteLine(fmt::format("stage {:.3f} {}", std::isfinite(fraction) ? fraction : 0.0, stage));
}

void SendPart(std::uint32_t number, std::string_view name) {
  WriteLine(fmt::format("part {} {}", number, name.substr(0, 1000)));
}

int HandOver(std::span<const std::byte> output) {
  return WriteAll(kOutputDescriptor, output) == 0 ? 0 : kWorkerNoOutput;
}

}  // namespace hvas::cad
