// Damaged files of every format against the whole reader. Each copy is read in a process of its
// own, as the program does it; whatever kills or stops that process is then given to the program's
// own import, which has to come back with a product or an error.
//
//   import_storm [--limits] COUNT FILE...
//
// COUNT damaged copies of each FILE. Exit status 1 when the program's own import fails to answer,
// or when a refusal says nothing.
//
// With --limits each copy is opened as the program opens a file, mates included, in a process of
// its own; the most memory that this process and the reading one had together, and the longest
// time, are printed. Exit status 1 also when one went beyond the limits that files have by default.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>

#include "assembly/open_product.h"
#include "base/clock.h"
#include "base/diagnostics.h"
#include "base/test/temporary_folder.h"
#include "base/work_watch.h"
#include "cad/import.h"
#include "cad/process/read_cad.h"
#include "fuzz/mutate.h"

namespace {

namespace fs = std::filesystem;

constexpr int kOpened = 0;
constexpr int kRefused = 3;  // Not 1 or 2, which a dying library may exit with.
constexpr int kSilent = 4;
constexpr unsigned kSeconds = 10;
constexpr long kAskAlways = 300;
constexpr long kAskEvery = 10;
constexpr rlim_t kMemory = rlim_t{2} << 30;

struct Tally {
  long opened{0}, refused{0}, silent{0}, killed{0};
  long asked{0}, answered{0};  // Of the killed, by the program's own import.
};

std::string ReadFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void WriteFile(const fs::path& path, const std::string& bytes) {
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  if (!(stream << bytes << std::flush)) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

/** Coarse: this is about damage, not about meshes. */
hvas::cad::ImportOptions MakeOptions() {
  hvas::cad::ImportOptions options;
  options.relative_deflection = 1e-3;
  options.max_angle = 0.5;
  options.threads = 1;
  return options;
}

/** In the child: reads the file and ends with what came of it. */
[[noreturn]] void ReadAndExit(const fs::path& file) {
  alarm(kSeconds);
  const rlimit memory{kMemory, kMemory};
  setrlimit(RLIMIT_AS, &memory);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  const int null = open("/dev/null", O_WRONLY);  // Libraries complain of every damage.
  dup2(null, STDOUT_FILENO);
  dup2(null, STDERR_FILENO);
  hvas::Diagnostics diagnostics;
  const auto product = hvas::cad::ReadCad(file, MakeOptions(), &diagnostics);
  if (product) {
    _exit(kOpened);
  }
  const bool says_enough = !product.error().message.empty() && !product.error().where.empty();
  _exit(says_enough ? kRefused : kSilent);
}

int ReadInChild(const fs::path& file) {
  const pid_t child = fork();
  if (child == 0) {
    ReadAndExit(file);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

Tally Storm(const fs::path& seed, long count, const fs::path& folder) {
  const std::string bytes = ReadFile(seed);
  const fs::path file = folder / ("damaged" + seed.extension().string());
  hvas::Random random(1);
  Tally tally;
  for (long i = 0; i < count; ++i) {
    WriteFile(file, hvas::fuzz::Mutate(bytes, &random));
    switch (ReadInChild(file)) {
      case kOpened:
        ++tally.opened;
        continue;
      case kRefused:
        ++tally.refused;
        continue;
      case kSilent:
        ++tally.silent;
        continue;
      default:
        break;
    }
    if (++tally.killed > kAskAlways && tally.killed % kAskEvery != 0) {
      continue;
    }
    ++tally.asked;
    hvas::Diagnostics diagnostics;
    const auto product = hvas::cad::Import(file, MakeOptions(), &diagnostics);
    tally.answered += product || !product.error().message.empty() ? 1 : 0;
  }
  return tally;
}

/** What opening a file took. */
struct Cost {
  double memory_mib{0};  ///< The most of the reading process, and of the one that started it.
  double time_s{0};
};

/** In the child: opens the file as the program does, and ends with what came of it. */
[[noreturn]] void OpenAndExit(const fs::path& file, int costs) {
  hvas::Diagnostics diagnostics;
  hvas::assembly::OpenOptions options;
  options.file = file;
  const auto product = hvas::assembly::OpenProduct(options, &diagnostics);
  rusage own{};
  rusage reader{};
  getrusage(RUSAGE_SELF, &own);
  getrusage(RUSAGE_CHILDREN, &reader);
  const std::array<long, 2> peaks{own.ru_maxrss, reader.ru_maxrss};  // [KiB]
  const bool is_told = write(costs, peaks.data(), sizeof(peaks)) == sizeof(peaks);
  const bool says_enough =
      product || (!product.error().message.empty() && !product.error().where.empty());
  _exit(!is_told || !says_enough ? kSilent : product ? kOpened : kRefused);
}

/** @returns the status of the child; -1 when it died. */
int OpenInChild(const fs::path& file, Cost* cost) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    return -1;
  }
  const std::int64_t begin_ns = hvas::MonotonicNs();
  const pid_t child = fork();
  if (child == 0) {
    OpenAndExit(file, ends[1]);
  }
  close(ends[1]);
  std::array<long, 2> peaks{};
  const bool is_told = read(ends[0], peaks.data(), sizeof(peaks)) == sizeof(peaks);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  cost->time_s = 1e-9 * static_cast<double>(hvas::MonotonicNs() - begin_ns);
  cost->memory_mib = static_cast<double>(peaks[0] + peaks[1]) / 1024;
  return is_told && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool StormWithin(const fs::path& seed, long count, const fs::path& folder) {
  const std::string bytes = ReadFile(seed);
  const fs::path file = folder / ("damaged" + seed.extension().string());
  hvas::Random random(1);
  Tally tally;
  Cost most;
  for (long i = 0; i < count; ++i) {
    WriteFile(file, hvas::fuzz::Mutate(bytes, &random));
    Cost cost;
    const int status = OpenInChild(file, &cost);
    tally.opened += status == kOpened ? 1 : 0;
    tally.refused += status == kRefused ? 1 : 0;
    tally.silent += status == kSilent ? 1 : 0;
    tally.killed += status == -1 ? 1 : 0;
    most.memory_mib = std::max(most.memory_mib, cost.memory_mib);
    most.time_s = std::max(most.time_s, cost.time_s);
  }
  fmt::print("{:<24} {:>7} {:>7} {:>7} {:>7} {:>9.0f} {:>9.1f}\n", seed.filename().string(), count,
             tally.opened, tally.refused, tally.silent + tally.killed, most.memory_mib,
             most.time_s);
  std::fflush(stdout);
  constexpr double kEnd = 2;  // To end a process that is over its limit, and to tell [s].
  const double allowed_mib = static_cast<double>(hvas::DefaultMemoryLimit()) / (1 << 20);
  return tally.silent + tally.killed == 0 && most.memory_mib <= allowed_mib &&
         most.time_s <= hvas::WorkLimits().time + kEnd;
}

int RunWithin(long count, const std::vector<fs::path>& seeds) {
  const hvas::testing::TemporaryFolder folder;
  bool is_good = true;
  fmt::print("{:<24} {:>7} {:>7} {:>7} {:>7} {:>9} {:>9}\n", "file", "copies", "opened", "refused",
             "silent", "most_mib", "longest_s");
  for (const fs::path& seed : seeds) {
    is_good = StormWithin(seed, count, folder.path()) && is_good;
  }
  return is_good ? 0 : 1;
}

int Run(long count, const std::vector<fs::path>& seeds) {
  const hvas::testing::TemporaryFolder folder;
  bool is_good = true;
  fmt::print("{:<24} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9}\n", "file", "copies", "opened", "refused",
             "killed", "asked", "answered");
  for (const fs::path& seed : seeds) {
    const Tally tally = Storm(seed, count, folder.path());
    fmt::print("{:<24} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9}\n", seed.filename().string(), count,
               tally.opened, tally.refused, tally.killed, tally.asked, tally.answered);
    std::fflush(stdout);
    is_good = is_good && tally.silent == 0 && tally.answered == tally.asked;
  }
  return is_good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool is_within = !words.empty() && words.front() == "--limits";
  words.erase(words.begin(), words.begin() + (is_within ? 1 : 0));
  if (words.size() < 2) {
    fmt::print(stderr, "usage: {} [--limits] COUNT FILE...   COUNT damaged copies of each file\n",
               argv[0]);
    return 1;
  }
  try {
    const long count = std::strtol(words.front().c_str(), nullptr, 10);
    const std::vector<fs::path> seeds(words.begin() + 1, words.end());
    return is_within ? RunWithin(count, seeds) : Run(count, seeds);
  } catch (const std::exception& exception) {
    fmt::print(stderr, "{}\n", exception.what());
    return 1;
  }
}
