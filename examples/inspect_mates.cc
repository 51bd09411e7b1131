// Lists the mates of a CAD file with their fits, and what the limits of the fit allow:
//
//   inspect_mates FILE
#include <cstdio>
#include <string>

#include <hvas/hvas.h>

namespace {

using hvas::product::Mate;
using hvas::product::Product;

const char* PathOf(const Product& product, const hvas::product::Connector& side) {
  return product.occurrences[side.occurrence.index()].path.c_str();
}

void Print(const Product& product, const Mate& mate) {
  constexpr double kMm = 1e3;
  constexpr double kUm = 1e6;
  std::printf("%s <- %s", PathOf(product, mate.a), PathOf(product, mate.b));
  if (!mate.fit || mate.fit->code.empty()) {
    std::printf("\n");
    return;
  }
  const double nominal = mate.fit->nominal_diameter;
  std::printf(", %.3g mm %s", kMm * nominal, mate.fit->code.c_str());
  if (const auto fit = hvas::fits::ParseFit(mate.fit->code)) {
    if (const auto limits = hvas::fits::CalcFitLimits(*fit, nominal)) {
      std::printf(", clearance %.1f to %.1f um", kUm * limits->min_clearance,
                  kUm * limits->max_clearance);
    }
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FILE\n", argv[0]);
    return 1;
  }
  hvas::Diagnostics diagnostics;
  hvas::assembly::OpenOptions options;
  options.file = argv[1];
  const auto product = hvas::assembly::OpenProduct(options, &diagnostics);
  if (!product) {
    std::fprintf(stderr, "%s\n", product.error().ToString().c_str());
    return 1;
  }
  for (const Mate& mate : product->mates) {
    Print(*product, mate);
  }
  std::printf("%zu mates, %zu parts\n", product->mates.size(), product->occurrences.size());
  return 0;
}
