#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "contact/shape.h"

namespace hvas::contact {

/** All of a shape as little-endian bytes; equal shapes give equal bytes. */
[[nodiscard]] std::vector<std::byte> SerialiseShape(const Shape& shape);

/** The shape that SerialiseShape made the bytes from, bit for bit; null when there are fewer or
 more of them than a shape takes. Bytes that were changed must be told by a checksum beforehand. */
[[nodiscard]] std::shared_ptr<const Shape> DeserialiseShape(std::span<const std::byte> bytes);

}  // namespace hvas::contact
