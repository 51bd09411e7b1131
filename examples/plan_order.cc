// Finds orders in which a product is assembled with few turns, changes of tool and loose parts:
//
//   plan_order FILE
#include <cstdio>
#include <utility>

#include <hvas/hvas.h>

namespace {

int Fail(const hvas::Error& error) {
  std::fprintf(stderr, "%s\n", error.ToString().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FILE\n", argv[0]);
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
  hvas::assembly::PlanOptions options;
  options.weights.turn = 8;  // Turning the product over is twice as bad as usual.
  options.most_orders = 2;
  const auto plan = hvas::assembly::PlanOrder(**model, options);
  if (!plan) {
    return Fail(plan.error());
  }
  int number = 0;
  for (const hvas::orders::FoundOrder& order : plan->search.orders) {
    std::printf("order %d, cost %.2f:", ++number, order.cost);
    for (const std::size_t move : order.moves) {
      const hvas::product::OccurrenceId part = plan->rules.moves[move].parts.front();
      std::printf(" %s;", (*model)->product->occurrences[part.index()].name.c_str());
    }
    std::printf("\n");
  }
  return 0;
}
