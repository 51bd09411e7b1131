#pragma once

#include <cstdint>

namespace hvas::sequence {

/** Contact queries that the search for an order of assembly takes, in all of a product: the same
 on every machine. A query that tests many sample points counts as several. */
class SearchBudget {
 public:
  /** So many sample points take about as long as the rest of a query. Measured: a piston's rings
   take 50 us a query of some 80 points, a snap hook's search 14 million points a second. */
  static constexpr std::uint64_t kPointsOfQuery = 200;

  explicit SearchBudget(std::uint64_t queries) : total_(queries) {}

  void Spend(std::uint64_t queries, std::uint64_t points) {
    queries_ += queries;
    points_ += points;
  }

  [[nodiscard]] std::uint64_t total() const { return total_; }

  [[nodiscard]] std::uint64_t spent() const { return queries_ + points_ / kPointsOfQuery; }

  [[nodiscard]] std::uint64_t left() const {
    return total_ - (spent() < total_ ? spent() : total_);
  }

  [[nodiscard]] bool is_over() const { return left() == 0; }

 private:
  std::uint64_t total_;
  std::uint64_t queries_{0};
  std::uint64_t points_{0};
};

}  // namespace hvas::sequence
