// Assembles a CAD file in virtual time, and prints how each part fared:
//
//   assemble_product FILE [DEVICE]
//
// DEVICE is an address as `hvas devices` lists them, as emulated:haply; a real one works in real
// time. Exit status 0 when every part is in its place, 2 when one is not, 1 on an error.
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include <hvas/hvas.h>

namespace {

int Fail(const hvas::Error& error) {
  std::fprintf(stderr, "%s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: %s FILE [DEVICE]\n", argv[0]);
    return 1;
  }
  const auto cache = hvas::FileCache::DefaultDirectory();
  hvas::Diagnostics diagnostics;

  hvas::assembly::OpenOptions open;
  open.file = argv[1];
  open.cache_directory = cache;
  auto product = hvas::assembly::OpenProduct(open, &diagnostics);
  if (!product) {
    return Fail(product.error());
  }

  hvas::assembly::PrepareOptions prepare;
  prepare.shape_cache = hvas::assembly::MakeShapeCache(cache);
  const auto model = hvas::assembly::PrepareModel(*std::move(product), prepare, &diagnostics);
  if (!model) {
    return Fail(model.error());
  }
  for (const hvas::Diagnostic& item : diagnostics.items()) {
    if (item.severity == hvas::Severity::kWarning) {
      std::fprintf(stderr, "%s: %s\n", item.entity.c_str(), item.message.c_str());
    }
  }

  hvas::assembly::RunOptions run;
  if (argc == 3) {
    const std::string_view device = argv[2];
    run.devices = {std::string(device)};
    run.is_realtime = !device.starts_with("emulated:");
  }
  run.on_part = [&model](const auto& progress, const hvas::simulation::PartResult& part) {
    const std::string& path = (*model)->product->occurrences[part.occurrence.index()].path;
    std::printf("%zu of %zu: %s, %.2f s, %.2f N%s%s\n", progress.tried, progress.total,
                path.c_str(), part.time, part.peak_true,
                part.is_seated ? "" : "; NOT IN PLACE: ", part.reason.c_str());
  };
  const auto outcome = hvas::assembly::RunAssembly(*model, run);
  if (!outcome) {
    return Fail(outcome.error());
  }
  const auto seated = std::count_if(outcome->parts.begin(), outcome->parts.end(),
                                    [](const auto& part) { return part.is_seated; });
  std::printf("%td of %zu parts in place, digest %s\n", seated, outcome->parts.size(),
              outcome->digest.c_str());
  return outcome->is_complete() ? 0 : 2;
}
