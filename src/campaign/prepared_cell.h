#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "assembly/open_product.h"
#include "base/result.h"
#include "campaign/fit_model.h"
#include "campaign/plan.h"
#include "campaign/run_result.h"
#include "contact/shape_cache.h"
#include "product/product.h"

namespace hvas::campaign {

/** A combination of a plan, ready for its seeds: the product with its fits and materials. */
struct PreparedCell {
  Cell cell;
  product::Product product;
  FitModel fits;
  Diagnostics diagnostics;
};

/** Opens and keeps the products of a plan and their combinations. All functions may be called by
 any thread. */
class CellStore {
 public:
  /** @param plan  Outlives the store.
   @param open  Options for opening; its file and fits are replaced by the plan's. */
  CellStore(const Plan* plan, assembly::OpenOptions open);

  /** Prepares a combination, or returns the one that is kept. Errors: those of
   assembly::OpenProduct and FitModel::Make; kInvalid for a material of a part that the product does
   not have. */
  [[nodiscard]] Result<std::shared_ptr<const PreparedCell>> Prepare(std::int64_t index);

  [[nodiscard]] const Plan& plan() const { return *plan_; }

  [[nodiscard]] const std::shared_ptr<contact::ShapeCache>& shapes() const { return shapes_; }

 private:
  using CellResult = Result<std::shared_ptr<const PreparedCell>>;

  /** A product with the fits that its files state. */
  struct OpenedProduct {
    std::size_t index{0};  ///< Index into Plan::products.
    product::Product product;
    Diagnostics diagnostics;
  };

  [[nodiscard]] Result<OpenedProduct> Open(std::size_t index);
  [[nodiscard]] CellResult PrepareNew(std::int64_t index);

  const Plan* plan_;
  assembly::OpenOptions open_;
  std::shared_ptr<contact::ShapeCache> shapes_;
  std::mutex mutex_;
  std::optional<OpenedProduct> opened_;                    // The one of the newest combination.
  std::deque<std::shared_ptr<const PreparedCell>> cells_;  // The newest last.
};

/** Options of one run with the method kAssemble. */
struct PlayOptions {
  std::filesystem::path record;  ///< Empty: none.
  bool is_record_replaced{false};
  std::shared_ptr<contact::ShapeCache> shapes;  ///< Null: contact shapes are always built.
  std::stop_token stop;
};

/** Assembles the product that a seed makes, by the plan's person in virtual time. Errors: those of
 assembly::PrepareModel and assembly::RunAssembly; that of a record that was not written. */
[[nodiscard]] Result<RunResult> PlayRun(const PreparedCell& cell, const Plan& plan,
                                        std::uint64_t seed, const PlayOptions& options);

/** Calculates the product that a seed makes from the formulas of its fits. */
[[nodiscard]] RunResult CalcRun(const PreparedCell& cell, const Plan& plan, std::uint64_t seed);

/** Words that play a run: `hvas assemble FILE --seed S ...` where that program draws the same
 product, or else `hvas campaign play`. */
[[nodiscard]] std::string DescribePlay(const Plan& plan, const RunResult& run);

}  // namespace hvas::campaign
