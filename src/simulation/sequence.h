#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contact/scene.h"
#include "haptics/held_part.h"
#include "product/product.h"

namespace hvas::simulation {

/** One part's way into the product. */
struct SequenceStep {
  product::OccurrenceId occurrence;
  Vec3 extraction_W{Vec3::UnitZ()};  ///< Unit; the way out. The way in is the reverse.
  double engage_distance{0};  ///< From the goal along the way out until nothing is engaged [m].
  bool is_base{false};        ///< The first part: it is held in the fixture.
};

/** Two parts that lie in one another as drawn, beyond what a mate between them explains. Contact
 between the two is left out: the drawing, not the hand, has put them there. */
struct DrawnOverlap {
  product::OccurrenceId a;
  product::OccurrenceId b;
  double depth{0};  ///< [m]
};

/** A part that cannot be brought in, and why. */
struct SequenceGap {
  product::OccurrenceId occurrence;
  std::string reason;
};

struct Sequence {
  std::vector<SequenceStep> steps;  ///< In the order of assembly.
  std::vector<SequenceGap> gaps;
  std::vector<DrawnOverlap> overlaps;
};

struct SequenceInput {
  const product::Product* product{nullptr};
  contact::Scene* scene{
      nullptr};  ///< All parts at their drawn poses; body index = occurrence index.
  std::vector<std::shared_ptr<const haptics::MateFaces>> faces_a;  ///< By MateId.
  std::vector<std::shared_ptr<const haptics::MateFaces>> faces_b;
  std::function<void(double fraction)> progress;
};

/** Takes the product apart along straight lines that its mates leave free, nothing in the way, and
 turns the order round (X17, N10). Deterministic. Disables bodies of the scene as it goes. */
[[nodiscard]] Sequence PlanSequence(const SequenceInput& input);

/** Re-orders: parts named (or given by path or index "o12") first, in the order given; the others
 follow in the order found. Errors: kNotFound for a name that matches nothing. */
Result<Sequence> Reorder(const product::Product& product, const Sequence& sequence,
                         const std::vector<std::string>& names);

}  // namespace hvas::simulation
