#pragma once

#include <vector>

#include "product/product.h"

namespace hvas::product {

/** What stands around a product without being part of it (X16). It is kept in the product's tree,
 in a subassembly with a name of its own, so that records and saved work have it. */
enum class AccessoryKind {
  kTool,     ///< It lies on the table, is held, and turns fasteners.
  kFixture,  ///< It stands where it was put.
  kBench,    ///< It stands on the table, where there is room.
};

/** Name of the subassembly that holds all accessories of a kind. */
[[nodiscard]] const char* ToString(AccessoryKind kind);

/** Adds all parts of another product as accessories. They get no mates.
 @param X_WA  Pose of the other product's world in W. */
void AddAccessory(const Product& accessory, AccessoryKind kind, const Pose& X_WA, Product* product);

/** Lists the accessories of a kind. */
[[nodiscard]] std::vector<OccurrenceId> ListAccessories(const Product& product, AccessoryKind kind);

}  // namespace hvas::product
