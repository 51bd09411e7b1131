#include "cad/worker_io.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>

#include <fmt/format.h>

#include "base/clock.h"
#include "cad/worker.h"

namespace hvas::cad {
namespace {

constexpr std::int64_t kOftenestNs = 50'000'000;

bool WriteAll(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(descriptor, bytes.data(), bytes.size());
    if (size <= 0 && errno != EINTR) {
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  }
  return true;
}

void WriteLine(std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  line.push_back('\n');
  (void)WriteAll(kProgressDescriptor, std::as_bytes(std::span(line)));
}

}  // namespace

void TellStage(std::string_view stage, double fraction) {
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

void TellPart(std::uint32_t number, std::string_view name) {
  WriteLine(fmt::format("part {} {}", number, name.substr(0, 1000)));
}

int HandOver(std::span<const std::byte> output) {
  return WriteAll(kOutputDescriptor, output) ? 0 : kWorkerNoOutput;
}

}  // namespace hvas::cad
