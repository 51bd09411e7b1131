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
inline constexpr std::uint32_t kProductFormat = 1;

/** All of a product. Equal products give equal bytes. */
void WriteProduct(const Product& product, ByteWriter* writer);

void WriteDiagnostics(const Diagnostics& diagnostics, ByteWriter* writer);

/** The product that WriteProduct made the bytes from, bit for bit; a failed reader where they are
 anything else. Takes any bytes: every index of a product that was read leads to something, and its
 tree is one. */
[[nodiscard]] Product ReadProduct(ByteReader* reader);

/** Reads diagnostics as ReadProduct() does a product. */
[[nodiscard]] Diagnostics ReadDiagnostics(ByteReader* reader);

/** A product on its own, behind its format's number. */
[[nodiscard]] std::vector<std::byte> SerialiseProduct(const Product& product);

/** Errors: kUnreadable for bytes that are no product of this format. */
[[nodiscard]] Result<Product> DeserialiseProduct(std::span<const std::byte> bytes);

}  // namespace hvas::product
