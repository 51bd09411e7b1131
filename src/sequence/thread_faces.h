#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "haptics/held_part.h"
#include "product/product.h"

namespace hvas::sequence {

/** True where a mate is a thread whose screw is drawn wider than its hole, at the outer diameter in
 a hole of the core's; or an insert that is drawn wider than its bore. */
[[nodiscard]] bool IsDrawnThread(const product::Mate& mate);

/** Lists the faces of holes of a nut that are narrower than its thread, on the same axis: the ring
 of plastic or the bent slots that lock it, which a screw is drawn in.
 @param mate  A thread whose hole is the nut's. */
[[nodiscard]] std::vector<product::FaceId> ListLockingFaces(const product::Product& product,
                                                            const product::Mate& mate);

/** Lists those of some faces, and of all next to them, that may overlap while two parts pass one
 another: tips, chamfers and mouths. What the parts rest on each other with is none of them.
 @param own  The part whose faces these are. @returns sorted indices. */
[[nodiscard]] std::vector<std::uint32_t> ListPassing(const product::Product& product,
                                                     product::OccurrenceId own,
                                                     product::OccurrenceId other,
                                                     const haptics::MateFaces& faces);

/** What a thread takes out of contact on one side of its mate: its faces and all next to them,
 tips, chamfers and mouths, as these overlap when they pass one another. Not what the two parts rest
 on each other with: a head still stops on the face that its thread goes into.
 @param side  The mate's a or b. @param faces  That side's, as for any mate. */
[[nodiscard]] std::shared_ptr<const haptics::MateFaces> WidenForThread(
    const product::Product& product, const product::Mate& mate, const product::Connector& side,
    const haptics::MateFaces& faces);

}  // namespace hvas::sequence
