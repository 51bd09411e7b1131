#pragma once

#include <cstdint>
#include <tuple>

#include "contact/scene.h"

namespace hvas::paths {

/** A face of the part and one of a body: body, face of the part, face of the body. */
using FacePair = std::tuple<contact::BodyId, std::uint32_t, std::uint32_t>;

/** The faces that a contact is between: each pair counts once, whatever its samples. */
[[nodiscard]] inline FacePair FacesOf(const contact::Contact& c) {
  return {c.body, c.held_face, c.scene_face};
}

}  // namespace hvas::paths
