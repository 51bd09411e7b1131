#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/bytes.h"
#include "base/diagnostics.h"
#include "base/result.h"
#include "product/product.h"

/** Products as bytes, for the way between processes and for the disk: little-endian, meshes as they
 lie in memory. Made to be read by the program that wrote them; exchange formats are elsewhere. */
namespace hvas::product {

/** The version is raised whenever the bytes change: a field, an enumerator, their order. */
inline constexpr std::uint32_t kProductFormat = 4;

/** The oldest version that can be read. It has no identities, header, relations and contact pairs;
 versions before 3 have no `Occurrence::bodies`, those before 4 no prismatic mates. */
inline constexpr std::uint32_t kFirstProductFormat = 1;

/** All of a product but Product::removed_mates and Product::placement, which only editing needs:
 the poses of the bytes are the assembled ones. Equal products give equal bytes. */
void WriteProduct(const Product& product, ByteWriter* writer);

void WriteDiagnostics(const Diagnostics& diagnostics, ByteWriter* writer);

/** The product that WriteProduct made the bytes from, bit for bit; a failed reader where they are
 anything else. Takes any bytes: every index of a product that was read leads to something, and its
 tree is one. */
[[nodiscard]] Product ReadProduct(ByteReader* reader, std::uint32_t format = kProductFormat);

/** Reads diagnostics as ReadProduct() does a product. */
[[nodiscard]] Diagnostics ReadDiagnostics(ByteReader* reader);

/** A product on its own, behind its format's number. */
[[nodiscard]] std::vector<std::byte> SerialiseProduct(const Product& product);

/** Errors: kUnreadable for bytes that are no product of this format. */
[[nodiscard]] Result<Product> DeserialiseProduct(std::span<const std::byte> bytes);

}  // namespace hvas::product
