#pragma once

#include "product/mate.h"
#include "sequence/sequence.h"

namespace hvas::sequence {

/** Finds the way by which the shaft or inner part of a mate leaves the hole or outer part, as they
 are drawn: the reverse of the step that joins the two. Unit; zero where no step does. */
[[nodiscard]] Vec3 FindWayOut(const Sequence& sequence, const product::Mate& mate);

}  // namespace hvas::sequence
