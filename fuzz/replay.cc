// Feeds a target its seeds and damaged copies of them: what a fuzzer once found stays found, on any
// compiler and under the sanitizers.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/mutate.h"
#include "fuzz/target.h"

namespace {

std::vector<std::string> ReadFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> files;
  for (const std::filesystem::path& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return files;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s COUNT FOLDER   COUNT damaged copies of the files in FOLDER\n",
                 argv[0]);
    return 1;
  }
  try {
    const long count = std::strtol(argv[1], nullptr, 10);
    const std::vector<std::string> seeds = ReadFiles(argv[2]);
    if (seeds.empty() || count <= 0) {
      std::fprintf(stderr, "no seeds in %s, or no COUNT\n", argv[2]);
      return 1;
    }
    for (const std::string& seed : seeds) {
      hvas::fuzz::TestOne(seed);
    }
    hvas::Random random(1);
    for (long i = 0; i < count; ++i) {
      const std::string& seed = seeds[static_cast<std::size_t>(i) % seeds.size()];
      hvas::fuzz::TestOne(hvas::fuzz::Mutate(seed, &random));
    }
    std::printf("%zu seeds and %ld damaged copies\n", seeds.size(), count);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "an exception came out: %s\n", exception.what());
    return 1;
  }
  return 0;
}
