// Damaged files of every format against the whole reader. Each copy is read in a process of its
// own, as the program does it; whatever kills or stops that process is then given to the program's
// own import, which has to come back with a product or an error.
//
//   import_storm COUNT FILE...
//
// COUNT damaged copies of each FILE. Exit status 1 when the program's own import fails to answer,
// or when a refusal says nothing.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/test/temporary_folder.h"
#include "cad/import.h"
#include "cad/read_cad.h"
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
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
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
  if (argc < 3) {
    fmt::print(stderr, "usage: {} COUNT FILE...   COUNT damaged copies of each file\n", argv[0]);
    return 1;
  }
  try {
    return Run(std::strtol(argv[1], nullptr, 10), {argv + 2, argv + argc});
  } catch (const std::exception& exception) {
    fmt::print(stderr, "{}\n", exception.what());
    return 1;
  }
}
