#include "evidence/holds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "evidence/session_data.h"
#include "haptics/constraint_solver.h"
#include "haptics/haptic_tick.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;

constexpr std::int64_t kQuietNs = 100'000'000;  // contact that pauses for less goes on

/** One hand's present hold. */
struct Present {
  std::optional<std::size_t> hold;  ///< Index in the list.
  std::uint32_t occurrence{record::kNoOccurrence};
  Vec3 p_last{Vec3::Zero()};
  std::int64_t last_ns{0};
  std::int64_t last_contact_ns{0};
};

void Begin(const TickRecord& tick, const Vec3& p, Present* present, std::vector<Hold>* holds) {
  present->occurrence = tick.held;
  present->hold.reset();
  if (tick.held == record::kNoOccurrence) {
    return;
  }
  present->hold = holds->size();
  present->p_last = p;
  present->last_ns = tick.t_ns;
  present->last_contact_ns = tick.t_ns - kQuietNs;
  Hold& hold = holds->emplace_back();
  hold.occurrence = tick.held;
  hold.hand = static_cast<std::uint8_t>(HandOf(tick));
  hold.start_ns = tick.t_ns;
}

void Follow(const TickRecord& tick, const Vec3& p, Present* present, Hold* hold) {
  hold->end_ns = tick.t_ns;
  hold->is_seated = static_cast<haptics::HoldState>(tick.state) == haptics::HoldState::kSeated;
  hold->peak_true = std::max(hold->peak_true, tick.F_true_W.f.norm());
  hold->peak_felt = std::max(hold->peak_felt, tick.F_felt_W.f.norm());
  hold->insertion = std::max(hold->insertion, tick.depth);
  hold->deepest = std::max(hold->deepest, -tick.deepest);
  hold->path += (p - present->p_last).norm();
  if (tick.contact_count > 0) {
    hold->contact_ns += tick.t_ns - present->last_ns;
    hold->collisions += tick.t_ns - present->last_contact_ns >= kQuietNs ? 1 : 0;
    present->last_contact_ns = tick.t_ns;
  }
  if (hold->points.empty() || (p - hold->points.back()).norm() >= kPointGap) {
    hold->points.push_back(p);
    hold->point_ns.push_back(tick.t_ns);
  }
  present->p_last = p;
  present->last_ns = tick.t_ns;
}

}  // namespace

Result<std::vector<Hold>> FindHolds(record::Reader* reader, const record::Reader::Span& span,
                                    const std::function<Vec3(std::uint32_t occurrence)>& p_BQ) {
  std::vector<Hold> holds;
  std::array<Present, haptics::kMaxHands> hands;
  const Result<void> done = reader->ForEachTick(span, [&](const TickRecord& tick) {
    Present& present = hands[HandOf(tick)];
    const Vec3 p =
        tick.held == record::kNoOccurrence ? Vec3::Zero() : Vec3(tick.X_WD * p_BQ(tick.held));
    if (tick.held != present.occurrence) {
      Begin(tick, p, &present, &holds);
    }
    if (present.hold) {
      Follow(tick, p, &present, &holds[*present.hold]);
    }
    return true;
  });
  if (!done) {
    return Unexpected(done.error());
  }
  return holds;
}

std::function<Vec3(std::uint32_t occurrence)> MakeCentres(
    const std::optional<product::Product>& product) {
  std::vector<Vec3> centres;
  if (product) {
    for (const product::Occurrence& occurrence : product->occurrences) {
      centres.push_back(product->part_of(occurrence.id).mass.p_BoBcm_B);
    }
  }
  return [centres = std::move(centres)](std::uint32_t occurrence) {
    return occurrence < centres.size() ? centres[occurrence] : Vec3(Vec3::Zero());
  };
}

}  // namespace hvas::evidence
