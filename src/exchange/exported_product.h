#pragma once

#include <map>
#include <string>
#include <vector>

#include "exchange/collision_form.h"
#include "exchange/mate_sizes.h"
#include "product/product.h"

namespace hvas::exchange {

/** A part as a body of another program. */
struct ExportedBody {
  product::OccurrenceId occurrence;
  std::string name;    ///< Unique; letters, digits and '_' only.
  CollisionForm form;  ///< Bodies that are met, in the part's frame.
};

/** A mate as a pair of frames, with its sizes. */
struct ExportedMate {
  product::MateId mate;
  std::string name;  ///< "mate_" and its key.
  std::optional<MateSizes> sizes;
};

/** What all formats are written from. */
struct ExportedProduct {
  const product::Product* product{nullptr};
  std::vector<ExportedBody> bodies;  ///< Bodies by OccurrenceId.
  std::vector<ExportedMate> mates;   ///< Mates by MateId.
  product::OccurrenceId base;        ///< It does not move.
};

/** A file of an export, by its path relative to the folder that it is written to. */
using ExportedFiles = std::map<std::string, std::string>;

/** Makes bodies and mates of a product with true sizes. The base is the largest part.
 @param product  Outlives the result. @pre it has a part. */
[[nodiscard]] ExportedProduct MakeExported(const product::Product& product);

/** Numbers in the shortest form that reads back as the same, with a space between. */
[[nodiscard]] std::string WriteNumbers(const Vec3& v);
[[nodiscard]] std::string WriteNumbers(const Quat& q);  ///< w, x, y, z.

/** The number in that form, 0 for a negative zero. */
[[nodiscard]] std::string WriteNumber(double x);

/** Text with what XML gives a meaning replaced. */
[[nodiscard]] std::string EscapeXml(std::string_view text);

}  // namespace hvas::exchange
