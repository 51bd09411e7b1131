#pragma once

#include <memory>
#include <string>

#include "contact/test/parts.h"
#include "product/product.h"

/** Small products with known geometry, made without a file. Lengths in metres. */
namespace hvas::sequence::testing {

using product::OccurrenceId;
using product::PartId;
using product::Product;
using spatial::Pose;

/** Sorts the triangles of a shape by their faces, as parts have them. */
contact::ShapeSource SortByFace(const contact::ShapeSource& source);

/** Adds a shape as a steel part with faces, features, mass, centre and inertia of its mesh. */
PartId AddPart(Product* product, const std::string& name, const contact::ShapeSource& source);

/** Adds a part at a place; its path is "name of the product/name". */
OccurrenceId Place(Product* product, PartId part, const std::string& name,
                   const Pose& X_WB = Pose());

/** Infers the mates and gives the box: to be called once everything is in place. */
void Complete(Product* product);

inline constexpr double kBoreRadius = 5e-3;
inline constexpr double kBlockHeight = 25e-3;
inline constexpr double kFloor = 5e-3;
inline constexpr double kPegLength = 30e-3;

/** A round block (radius 15 mm, 25 mm high) with a blind bore from above down to 5 mm, and a peg
 30 mm long on the floor of the bore. */
Product PegInBlock(const Pose& X_WP = Pose());

/** The peg in its block, and a finely meshed collar around the block that nothing joins to it: its
 contact shape takes longer than those of the two. */
Product PegInBlockInCollar();

/** A cup, a coin that lies loose on its floor, and a lid that lies on the rim. */
Product CoinUnderLid();

/** A cup, a lid on its rim, and a pendant that hangs under the lid, in the cup, where it touches
 nothing else. */
Product PendantUnderLid();

/** A ring between two flanges that turn it into a captive, with 1 mm of play to either side. */
Product CaptiveRing();

inline constexpr double kCollarHeight = 20e-3;  // Of the collar's lower side above the peg's end.
inline constexpr double kClampHeight = 35e-3;   // Of the clamp's top.

/** A trap. The block of PegInBlock, a peg with a collar that comes to rest on the block's top, and
 a clamp over the edge of the collar. Who puts the clamp there first meets it with the collar when
 the peg is a part of the way in its bore. */
Product CollarUnderClamp();

/** The clamped peg with a cap on its top, beside the clamp. */
Product CappedCollarUnderClamp();

/** A cup, a carrier with a through bore that stands on its floor, and a peg in the bore, 2 mm above
 the floor. Carrier and peg can be put together on the table and go in as one body. */
Product PegInCarrierInCup();

/** A neck with a bead, and a cap with a lip below it, 0.25 mm narrower; no name tells of a snap.
 @param outer_radius  The cap's: its wall is as thick as from 10.4 mm to it. */
Product CapOnBead(double outer_radius);

/** Blocks of equal size that stand side by side on a plate, 10 mm apart. */
Product BlocksOnPlate(int count);

/** States all parts of a product to be rigid. */
Product StateRigid(Product product);

}  // namespace hvas::sequence::testing
