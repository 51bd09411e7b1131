// Prepares CAD files, and explains each part that the order of assembly gives up, with times:
//
//   gap_bench [--looks N] [--seed N] [--first NAME]... [--rigid NAME]... [--explain PATH]...
//   FILE...
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "assembly/open_product.h"
#include "assembly/prepare_model.h"
#include "base/file_cache.h"
#include "orders/gap_reason.h"

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/** What is asked for besides the files. */
struct Wishes {
  std::vector<std::string> first;
  std::vector<std::string> rigid;
  std::vector<std::string> explained;  // Paths of parts that are not given up.
  std::uint64_t seed{1};
  hvas::orders::GapReasonOptions options;
};

void ExplainFile(const std::string& file, const Wishes& wishes) {
  const auto cache = hvas::FileCache::DefaultDirectory();
  hvas::Diagnostics diagnostics;
  hvas::assembly::OpenOptions open;
  open.file = file;
  open.cache_directory = cache;
  open.rigid = wishes.rigid;
  auto product = hvas::assembly::OpenProduct(open, &diagnostics);
  if (!product) {
    std::printf("%s: %s\n", file.c_str(), product.error().ToString().c_str());
    return;
  }
  hvas::assembly::PrepareOptions prepare;
  prepare.first_parts = wishes.first;
  prepare.seed = wishes.seed;
  prepare.shape_cache = hvas::assembly::MakeShapeCache(cache);
  const Clock::time_point start = Clock::now();
  const auto model = hvas::assembly::PrepareModel(*std::move(product), prepare, &diagnostics);
  if (!model) {
    std::printf("%s: %s\n", file.c_str(), model.error().ToString().c_str());
    return;
  }
  std::vector<hvas::sequence::SequenceGap> gaps = (*model)->sequence.gaps;
  std::printf("%s: %zu parts, %zu given up, prepared in %.1f s\n", file.c_str(),
              (*model)->bodies.size(), gaps.size(), SecondsSince(start));
  for (const std::string& path : wishes.explained) {
    for (const auto& occurrence : (*model)->product->occurrences) {
      if (occurrence.path == path) {
        gaps.push_back({occurrence.id, "not given up"});
      }
    }
  }
  for (const hvas::sequence::SequenceGap& gap : gaps) {
    const Clock::time_point begin = Clock::now();
    const auto reason = hvas::orders::ExplainGap(**model, gap.occurrence, wishes.options);
    std::printf("  %s\n    planner: %s\n",
                (*model)->product->occurrences[gap.occurrence.index()].path.c_str(),
                gap.reason.c_str());
    if (!reason) {
      std::printf("    %s\n", reason.error().ToString().c_str());
      continue;
    }
    std::printf("    %.1f s, %llu looks, %zu parts there, proof: %s\n", SecondsSince(begin),
                static_cast<unsigned long long>(reason->looks), reason->present.size(),
                hvas::orders::NameOf(reason->proof));
    for (const std::string& line : hvas::orders::FormatGapReason(**model, *reason)) {
      std::printf("    | %s\n", line.c_str());
    }
    for (const hvas::orders::GapChange& change : reason->changes) {
      std::printf("      - %s\n",
                  hvas::orders::DescribeGapChange(**model, *reason, change).c_str());
    }
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Explains the parts that the order of assembly gives up");
  std::vector<std::string> files;
  Wishes wishes;
  app.add_option("files", files, "CAD files")->required();
  app.add_option("--first", wishes.first, "Parts that come first")->allow_extra_args(false);
  app.add_option("--rigid", wishes.rigid, "Parts that may not give")->allow_extra_args(false);
  app.add_option("--explain", wishes.explained, "Parts to explain that have a step")
      ->allow_extra_args(false);
  app.add_option("--seed", wishes.seed, "Seed of the actual sizes");
  app.add_option("--looks", wishes.options.looks, "Looks that an explanation may take");
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : files) {
    ExplainFile(file, wishes);
  }
  return 0;
}
