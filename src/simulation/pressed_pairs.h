#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "haptics/giving_curve.h"
#include "product/product.h"
#include "sequence/sequence.h"

/** Springs, spring washers and gaskets that a part presses together when it goes to its place, slit
 pins and sleeves that their hole presses, and lips that their shaft spreads:
 docs/algorithms/flexible.md. */
namespace hvas::simulation {

/** A part that presses others together along its way. */
struct PressedPair {
  product::OccurrenceId moved;               ///< The part of the step that moves.
  std::vector<product::OccurrenceId> parts;  ///< What is pressed, one behind the other.
  product::OccurrenceId support;             ///< What the last of them stands on.
  product::OccurrenceId against;             ///< The part in its place to which `moved` comes.
  /** Compression of all, with `moved` in its place; lip: most, on its way [m]. */
  double compression{0};
  double force{0};        ///< Force then; slit pin, sleeve, lip: most, going in [N].
  bool is_radial{false};  ///< A hole or shaft presses or spreads it, all around.
  /** Radial: how far inner and outer radius grow in its place from what they are free [m]. */
  std::array<double, 2> growth{0, 0};
  std::string source;  ///< Closed form and source of the force.
  std::shared_ptr<const haptics::GivingCurve> curve;
};

/** Finds what presses what together: a part that moves along the axis of one that pushes back, to
 its end, where the other end stands on a part in its place. Parts that push back one behind the
 other are pressed by one force. Empty where nothing is pressed by 1 um or more. */
[[nodiscard]] std::vector<PressedPair> ListPressedPairs(const product::Product& product,
                                                        const sequence::Sequence& sequence);

/** Finds slit pins and sleeves of rubber that are narrower in their hole than free, or wider on
 their shaft, and what it takes to push them in: friction of their radial force, which grows with
 the length in the hole. Only where their mate has no fit of ISO 286, which would resist as well. */
[[nodiscard]] std::vector<PressedPair> ListSqueezedPairs(const product::Product& product,
                                                         const sequence::Sequence& sequence);

/** Finds lips of seals that a shaft spreads on its way, or that go over a shaft: their radial force
 is that of mates::CalcLipStiffness(), by how much wider than the free lip the cylinders and cones
 of the shaft are where the lip is. */
[[nodiscard]] std::vector<PressedPair> ListSpreadLips(const product::Product& product,
                                                      const sequence::Sequence& sequence);

}  // namespace hvas::simulation
