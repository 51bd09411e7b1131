#include "study/schedule.h"

#include <charconv>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/check.h"
#include "base/random.h"

namespace hvas::study {
namespace {

constexpr int kMaxParticipants = 999;  // Three digits, as in P001.

// Purposes of random streams, so that their seeds differ.
constexpr std::uint64_t kLabels = 1;
constexpr std::uint64_t kShuffle = 2;

void Shuffle(std::vector<std::size_t>* items, Random* random) {
  for (std::size_t i = items->size(); i > 1; --i) {
    const auto j = static_cast<std::size_t>(random->Uniform() * static_cast<double>(i));
    std::swap((*items)[i - 1], (*items)[j]);
  }
}

std::vector<std::size_t> Count(std::size_t count) {
  std::vector<std::size_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

/** Orders for participants and repetitions, as indices into Block::conditions. */
class Orders {
 public:
  Orders(const Block& block, std::size_t block_index, int participant, std::uint64_t seed)
      : block_(block),
        participant_(static_cast<std::size_t>(participant - 1)),
        labels_(Count(block.conditions.size())),
        random_(
            MixSeed(seed, kShuffle + 16 * block_index, static_cast<std::uint64_t>(participant))) {
    if (block.order == Order::kLatinSquare || block.order == Order::kBalanced) {
      Random drawn(MixSeed(seed, kLabels, block_index));
      Shuffle(&labels_, &drawn);
      square_ = MakeSquare(labels_.size(), block.order == Order::kBalanced);
    }
  }

  /** @param round  From 0, of the repetitions that the order is for. */
  std::vector<std::size_t> Next(std::size_t round) {
    std::vector<std::size_t> order = Count(labels_.size());
    if (block_.order == Order::kRandom) {
      Shuffle(&order, &random_);
    } else if (block_.order != Order::kGiven) {
      order = square_[(participant_ + round) % square_.size()];
    }
    for (std::size_t& place : order) {
      place = labels_[place];
    }
    return order;
  }

  /** All trials of identification, any order alike likely. */
  std::vector<std::size_t> ShuffleAll() {
    std::vector<std::size_t> all;
    for (int repetition = 0; repetition < block_.repetitions; ++repetition) {
      all.insert(all.end(), labels_.begin(), labels_.end());
    }
    Shuffle(&all, &random_);
    return all;
  }

 private:
  const Block& block_;
  std::size_t participant_;
  std::vector<std::size_t> labels_;
  Random random_;
  std::vector<std::vector<std::size_t>> square_;
};

std::vector<std::size_t> OrderOf(const Block& block, Orders* orders) {
  if (block.is_identification) {
    return orders->ShuffleAll();
  }
  std::vector<std::size_t> places;
  const auto repetitions = static_cast<std::size_t>(block.repetitions);
  if (block.keeps_repetitions_together) {
    for (const std::size_t place : orders->Next(0)) {
      places.insert(places.end(), repetitions, place);
    }
    return places;
  }
  for (std::size_t round = 0; round < repetitions; ++round) {
    const std::vector<std::size_t> order = orders->Next(round);
    places.insert(places.end(), order.begin(), order.end());
  }
  return places;
}

}  // namespace

std::vector<std::vector<std::size_t>> MakeSquare(std::size_t count, bool is_balanced) {
  HVAS_DEMAND(count >= 1);
  // The differences of neighbours in 0, 1, n-1, 2, n-2 ... are all different.
  std::vector<std::size_t> first = Count(count);
  if (is_balanced) {
    for (std::size_t i = 1; i < count; ++i) {
      first[i] = i % 2 == 1 ? (i + 1) / 2 : count - i / 2;
    }
  }
  std::vector<std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < count; ++row) {
    rows.push_back(first);
    for (std::size_t& number : rows.back()) {
      number = (number + row) % count;
    }
    if (is_balanced && count % 2 == 1 && count > 1) {
      rows.emplace_back(rows.back().rbegin(), rows.back().rend());
    }
  }
  return rows;
}

std::uint64_t MixSeed(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
  Random first(seed);
  Random second(first.NextBits() ^ a);
  return Random(second.NextBits() ^ b).NextBits();
}

std::vector<PlannedTrial> MakeSchedule(const Protocol& protocol, int participant,
                                       std::uint64_t seed) {
  std::vector<PlannedTrial> trials;
  for (std::size_t b = 0; b < protocol.blocks.size(); ++b) {
    const Block& block = protocol.blocks[b];
    Orders orders(block, b, participant, seed);
    std::vector<int> repetitions(block.conditions.size());
    for (const std::size_t place : OrderOf(block, &orders)) {
      trials.push_back({b, block.conditions[place], ++repetitions[place]});
    }
  }
  return trials;
}

std::string FormatParticipantId(int number) {
  return fmt::format("P{:02}", number);
}

Result<int> ParseParticipantId(std::string_view id) {
  int number = 0;
  const char* end = id.data() + id.size();
  const bool is_long = id.size() >= 3 && id[0] == 'P';
  const auto [rest, code] = std::from_chars(id.data() + (is_long ? 1 : 0), end, number);
  if (!is_long || code != std::errc() || rest != end || number < 1 || number > kMaxParticipants ||
      FormatParticipantId(number) != id) {
    return Fail(ErrorCode::kInvalid, "this is not a participant's id", std::string(id),
                "write P01 to P999; names are not used, to protect participants");
  }
  return number;
}

}  // namespace hvas::study
