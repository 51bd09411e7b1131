#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "product/product.h"
#include "sequence/blocking_graph.h"
#include "sequence/extraction.h"
#include "sequence/neighbours.h"

/** Kinds of ways by which parts are taken out of a product (docs/algorithms/sequence.md). */
namespace hvas::sequence {

/** Parts that are being taken apart, with nothing else there but fixtures. */
struct Level {
  const product::Product* product{nullptr};
  Extraction* extraction{nullptr};
  const Neighbours* neighbours{nullptr};
  const Unit* fixtures{nullptr};
  Unit rest;  ///< Parts that are there, the smallest first; the last one is the base, and stays.
  Unit connecting;  ///< Those of which others would hang in the air without them; sorted.
  std::optional<BlockingGraph> graph;  ///< Graph of `rest`; made by GraphOf().

  /** `rest`, and the fixtures. */
  [[nodiscard]] Unit WithFixtures() const;
};

/** Makes the graph of a level where it has none, and leaves in it what is still there. */
[[nodiscard]] BlockingGraph* GraphOf(Level* level);

/** What a strategy has taken out of a level. */
struct TakenOut {
  /** Parts that have come out as one body, the largest first. Empty: none has, but more is allowed
   than before, and cheaper strategies may succeed. */
  Unit unit;
  /** The step of the unit; around it the moves by which another part lets it pass. In the order of
   assembly. */
  std::vector<SequenceStep> steps;
};

/** A kind of way by which parts come out. */
class Strategy {
 public:
  Strategy() = default;
  Strategy(const Strategy&) = delete;
  Strategy& operator=(const Strategy&) = delete;
  virtual ~Strategy() = default;

  /** Takes the first part, or body of several parts, that comes out so out of a level; it is not in
   its rest any more. None: no part comes out so. */
  [[nodiscard]] virtual std::optional<TakenOut> TryTakeOut(Level* level) const = 0;

  /** Whether its ways are straight and nothing gives: they are looked for also where parts are
   drawn in one another. */
  [[nodiscard]] virtual bool goes_straight() const { return false; }
};

/** One part goes straight. */
class StraightStrategy final : public Strategy {
 public:
  /** @param may_disconnect  Also parts are taken without which others hang in the air. */
  explicit StraightStrategy(bool may_disconnect) : may_disconnect_(may_disconnect) {}

  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;

  [[nodiscard]] bool goes_straight() const override { return true; }

 private:
  bool may_disconnect_;
};

/** A part goes straight, with all that would hang in the air without it. */
class HangingStrategy final : public Strategy {
 public:
  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;

  [[nodiscard]] bool goes_straight() const override { return true; }
};

/** A subassembly of the file goes straight as one body. */
class SubassemblyStrategy final : public Strategy {
 public:
  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;

  [[nodiscard]] bool goes_straight() const override { return true; }
};

/** Several parts go straight as one body although the file has no subassembly of them, or a part
 goes along a direction of another one. */
class BodyStrategy final : public Strategy {
 public:
  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;
};

/** Parts that lie in one another as drawn, and block one another, are allowed more. */
class AllowanceStrategy final : public Strategy {
 public:
  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;
};

/** One part goes straight where it, or what is in its way, yields. */
class YieldingStrategy final : public Strategy {
 public:
  enum class By : std::uint8_t {
    kStatement,  ///< Parts yield as they are known to.
    kForm,       ///< A wall or an arm bends by what its form bears.
  };

  explicit YieldingStrategy(By by) : by_(by) {}

  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;

 private:
  By by_;
};

/** One part goes along a way of several pieces, along a screw that no mate describes, or along a
 way that turns. */
class TurningStrategy final : public Strategy {
 public:
  enum class Effort : std::uint8_t {
    kRings,  ///< Briefly, and only rings of round section: links of chains.
    kBrief,
    kLong,
  };

  explicit TurningStrategy(Effort effort) : effort_(effort) {}

  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;

 private:
  Effort effort_;
};

/** One part goes straight once another one is moved aside, which then goes back. */
class SidestepStrategy final : public Strategy {
 public:
  [[nodiscard]] std::optional<TakenOut> TryTakeOut(Level* level) const override;
};

/** Lists all strategies in the order of their cost. */
[[nodiscard]] std::vector<std::unique_ptr<Strategy>> ListStrategies();

}  // namespace hvas::sequence
