#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "sequence/extraction.h"
#include "simulation/model.h"

/** Why a part cannot be brought in, and what would let it in (docs/algorithms/reasons.md). */
namespace hvas::orders {

/** How sure it is that a part has no way, while the parts that are there stay as drawn. */
enum class GapProof : std::uint8_t {
  kNotFound,  ///< No way was found with the looks that there were; there may be one.
  kHeld,      ///< Contacts hold it in all six degrees of freedom, to first order.
  kCaged,     ///< A ball inside of the part cannot leave the space between the others.
  kDrawn,     ///< It is drawn in another part, deeper than any joint: no way was searched for.
};

/** A change that might let a part in. In the order of how little they change. */
enum class GapChangeKind : std::uint8_t {
  kOrder,      ///< It goes in before others, and they go in after it.
  kClearance,  ///< It, or what stops it, is smaller all over.
  kFlexible,   ///< A part gives.
  kLeaveOut,   ///< Others are not put in at all.
};

/** A change that was tried, and what came of it. */
struct GapChange {
  GapChangeKind kind{GapChangeKind::kOrder};
  /** kOrder, kLeaveOut: the others; kClearance: against which it is; kFlexible: what gives. */
  sequence::Unit parts;
  bool has_worked{false};
  /** kClearance: on each side, 0 beyond the depth that contact needs [m], twice as much in a
   diameter; kFlexible: how far the part has to give [m]. Where it has not worked: the largest that
   was tried. Worked out to GapReasonOptions::resolution. */
  double amount{0};
  Vec3 direction_W{Vec3::Zero()};  ///< Where it has worked: the way out; a
                                   ///< way that turns: its start.
  bool does_turn{false};           ///< The way that was found turns.
  bool does_give{false};           ///< Parts give on the way, as stated, or walls bend.
  bool do_others_turn{false};      ///< kOrder: one of the others has a way that turns.
  bool do_others_give{false};      ///< kOrder: one of the others gives on its way, or bends.
  /** kOrder: it goes in without the others, which then do not go in any more. */
  bool does_go_without{false};
};

/** Why a part cannot be brought in. */
struct GapReason {
  product::OccurrenceId occurrence;
  sequence::Unit
      present;  ///< Parts that are there when it has to go in, and cannot come out before it.
  /** There is a way after all: out along direction_W, while only `present` is there. */
  bool has_way{false};
  Vec3 direction_W{Vec3::Zero()};  ///< Unit; the best straight way out; zero: none was looked at.
  double travelled{0};             ///< How far the part gets along it [m].
  double way_length{0};            ///< How far it would have to get [m].
  std::vector<sequence::MetFaces> stops;  ///< What it meets all along that way; the deepest first.
  std::vector<product::MateId> mates;     ///< Mates that forbid this way.
  GapProof proof{GapProof::kNotFound};
  double caged_radius{0};          ///< kCaged: the radius of the ball that cannot get out [m].
  std::vector<GapChange> changes;  ///< What has worked first, and of that the smallest.
  std::uint64_t looks{0};          ///< Looks at parts that this took.
  bool is_limit_reached{false};    ///< The looks, or the time, ended before all changes were tried.
  bool is_stopped{false};          ///< A stop was asked for; the reason is incomplete.

  /** The smallest change that lets the part in; null: none that was tried. */
  [[nodiscard]] const GapChange* best() const {
    return changes.empty() || !changes.front().has_worked ? nullptr : &changes.front();
  }
};

/** How many looks at parts an explanation takes, about, unless another limit is given: some ten
 seconds for most parts. A choice. */
inline constexpr std::uint64_t kGapLooks = 300'000;

/** How many of the faces that stop a part are told, and shown in a picture: the deepest; what a
 reader takes in at a glance. A choice. */
inline constexpr std::size_t kToldStops = 3;

struct GapReasonOptions {
  /** How many looks at parts it may take; it is looked at between trials, one of which takes
   thousands. */
  std::uint64_t looks{kGapLooks};
  /** Ends it as the looks do, also between trials; what is found then depends on the machine. */
  std::optional<std::chrono::steady_clock::time_point> deadline;
  /** How many looks the search for ways that turn may take, of one trial; 0: none is searched for.
   As many as the order of assembly takes where it looks briefly. */
  std::uint64_t way_looks{10'000};
  double largest_clearance{
      2e-3};                   ///< The largest on each side [m]: more is another design. A choice.
  double largest_give{5e-3};   ///< The largest that a part may give [m]: as cables may at most.
  double resolution{10e-6};    ///< Step of clearances and of how far a part gives [m]: a choice.
  std::size_t most_others{6};  ///< How many parts are tried to be put in later: a choice.
  /** Parts that are there when it has to go in. None: those of the steps before its own; where it
   has no step, all parts of the sequence, and those given up after it, that do not come out before
   it. */
  std::optional<sequence::Unit> present;
  std::function<void(double fraction)> progress;
  std::stop_token stop;
};

/** Explains why a part of a model cannot be brought in: one that its sequence has given up, or one
 whose step comes when others are in its way. Looks at ways as the planner of the order does, and
 tries changes by looking for a way with them. Deterministic.
 Errors: kNotFound for a part that the model does not have, or that is a tool or a fixture. */
[[nodiscard]] Result<GapReason> ExplainGap(const simulation::Model& model, product::OccurrenceId id,
                                           const GapReasonOptions& options);

/** Describes a face for people: "hole 6.00 mm", "plane face 12". */
[[nodiscard]] std::string DescribeFace(const product::Product& product, product::OccurrenceId id,
                                       std::uint32_t face);

/** Describes a change that was tried, and what came of it, as one sentence. */
[[nodiscard]] std::string DescribeGapChange(const simulation::Model& model, const GapReason& reason,
                                            const GapChange& change);

/** Formats a reason for people: one to four lines, each a sentence. Names of parts are their paths;
 lengths are in millimetres. */
[[nodiscard]] std::vector<std::string> FormatGapReason(const simulation::Model& model,
                                                       const GapReason& reason);

[[nodiscard]] const char* NameOf(GapProof proof);
[[nodiscard]] const char* NameOf(GapChangeKind kind);

}  // namespace hvas::orders
