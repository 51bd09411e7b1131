#include "evidence/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "base/parse_json.h"
#include "evidence/session_data.h"
#include "haptics/constraint_solver.h"
#include "sequence/fit_of_mate.h"
#include "session/json_values.h"
#include "session/recorded_model.h"
#include "session/session_recorder.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;

constexpr std::size_t kBins = 1000;  // Bins of a plot, at least: a choice.

/** The ticks of a session, put into bins as they come: where there are twice as many as wanted, two
 neighbours become one. */
class Binner {
 public:
  void Add(const TickRecord& tick) {
    const std::int64_t index = tick.t_ns / width_ns_;
    if (bins_.empty() || index != last_index_) {
      last_index_ = index;
      bins_.push_back(
          {1e-9 * (static_cast<double>(index) + 0.5) * static_cast<double>(width_ns_), 0, 0, 0});
    }
    Take({0, tick.F_true_W.f.norm(), tick.F_felt_W.f.norm(), tick.depth}, &bins_.back());
    if (bins_.size() > 2 * kBins) {
      Halve();
    }
  }

  [[nodiscard]] std::vector<ForceBin> Finish() { return std::move(bins_); }

 private:
  static void Take(const ForceBin& from, ForceBin* to) {
    to->true_force = std::max(to->true_force, from.true_force);
    to->felt_force = std::max(to->felt_force, from.felt_force);
    to->insertion = std::max(to->insertion, from.insertion);
  }

  void Halve() {
    width_ns_ *= 2;
    std::vector<ForceBin> wider;
    std::int64_t last = -1;
    for (const ForceBin& bin : bins_) {
      const auto index = static_cast<std::int64_t>(1e9 * bin.t) / width_ns_;
      if (wider.empty() || index != last) {
        wider.push_back(
            {1e-9 * (static_cast<double>(index) + 0.5) * static_cast<double>(width_ns_), 0, 0, 0});
        last = index;
      }
      Take(bin, &wider.back());
    }
    bins_ = std::move(wider);
    last_index_ = last;
  }

  std::vector<ForceBin> bins_;
  std::int64_t width_ns_{1'000'000};
  std::int64_t last_index_{-1};
};

Result<void> ReadHands(record::Reader* reader, Summary* summary) {
  struct Reading {
    Binner bins;
    HandSummary hand;
    std::int64_t first_ns{0};
    std::int64_t last_ns{0};
  };

  std::array<Reading, haptics::kMaxHands> readings;
  Result<void> done = reader->ForEachTick({}, [&](const TickRecord& tick) {
    Reading& reading = readings[HandOf(tick)];
    HandSummary& hand = reading.hand;
    reading.first_ns = hand.ticks == 0 ? tick.t_ns : reading.first_ns;
    reading.last_ns = tick.t_ns;
    ++hand.ticks;
    hand.longest_model_age =
        std::max(hand.longest_model_age, 1e-9 * static_cast<double>(tick.model_age_ns));
    hand.shed_ticks += tick.effort_level > 0 ? 1 : 0;
    hand.truncated_ticks += (tick.status & session::kTruncatedStatus) != 0 ? 1 : 0;
    hand.crowded_ticks += (tick.status & session::kCrowdedStatus) != 0 ? 1 : 0;
    reading.bins.Add(tick);
    summary->duration = 1e-9 * static_cast<double>(tick.t_ns);
    return true;
  });
  for (Reading& reading : readings) {
    if (reading.hand.ticks > 0) {
      reading.hand.bins = reading.bins.Finish();
      reading.hand.period = 1e-9 * static_cast<double>(reading.last_ns - reading.first_ns) /
                            static_cast<double>(std::max<std::int64_t>(1, reading.hand.ticks - 1));
      summary->hands.push_back(std::move(reading.hand));
    }
  }
  return done;
}

Result<void> ReadEvents(record::Reader* reader, Summary* summary) {
  auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  for (record::Event& event : *events) {
    if (event.kind == "energy") {
      const auto json = ParseJson<nlohmann::json>(event.json);
      const auto* force = session::FieldOf(json, "force");
      const std::size_t hand = session::IndexOr(json, "hand", 0);
      if (force != nullptr && hand < summary->hands.size()) {
        // The newest account counts: it is kept from the beginning of its stretch.
        HandSummary& of = summary->hands[hand];
        of.energy_in = session::NumberOr(*force, "in_j", 0);
        of.energy_out = session::NumberOr(*force, "out_j", 0);
        of.has_energy = true;
      }
    } else if (event.kind == "safety" || event.kind == "device" || event.kind == "effort" ||
               event.kind == "flight") {
      summary->incidents.push_back(std::move(event));
    }
  }
  return {};
}

void DrawFits(Summary* summary) {
  const product::Product& product = *summary->product;
  const auto seed = summary->meta.find("seed");
  const std::uint64_t number =
      seed == summary->meta.end() ? 1 : std::strtoull(seed->second.c_str(), nullptr, 10);
  const auto pairs = session::FindPairChoice(summary->meta).value_or(fits::PairChoice::kAny);
  Diagnostics ignored;  // told of when the session was prepared
  for (const product::Mate& mate : product.mates) {
    const auto fit =
        mate.fit ? sequence::MakeFitForce(product, mate, number, pairs, &ignored) : nullptr;
    if (fit == nullptr) {
      continue;
    }
    const auto name = [&](const product::Connector& side) {
      return product.occurrences[side.occurrence.index()].name;
    };
    const double shaft = fit->shaft_diameter();
    const auto s = fit->clearances();
    const auto [least, largest] = std::minmax_element(s.begin(), s.end());
    summary->fits.push_back({name(mate.b) + " in " + name(mate.a), mate.fit->code,
                             mate.fit->nominal_diameter, shaft + 2 * fit->mean_clearance(), shaft,
                             2 * *least, 2 * *largest, fit->max_resistance()});
  }
}

}  // namespace

Result<Summary> Summarise(record::Reader* reader) {
  Summary summary;
  summary.meta = reader->meta();
  summary.is_complete = reader->is_complete();
  summary.paths = ReadPaths(*reader);
  if (const auto verified = reader->Verify(); !verified) {
    summary.damage = verified.error().message;
  }
  record::Reader::Span sound;
  Result<void> done = ReadHands(reader, &summary);
  if (!done && !summary.damage.empty()) {
    // Ticks before the chunk that cannot be read; hands share the time of a tick.
    sound.last_ns = std::llround(1e9 * summary.duration) - 1;
    done = {};
  }
  if (done) {
    done = ReadEvents(reader, &summary);
  }
  if (!done) {
    return Unexpected(done.error());
  }
  auto product = session::FindProduct(reader);
  if (!product) {
    return Unexpected(product.error());
  }
  summary.product = std::move(*product);
  auto holds = FindHolds(reader, sound, MakeCentres(summary.product));
  if (!holds) {
    return Unexpected(holds.error());
  }
  summary.holds = std::move(*holds);
  if (summary.product) {
    DrawFits(&summary);
    auto given = FindGivenParts(reader, sound, *summary.product);
    if (!given) {
      return Unexpected(given.error());
    }
    summary.given = std::move(*given);
  }
  return summary;
}

}  // namespace hvas::evidence
