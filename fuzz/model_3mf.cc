// The model in a 3MF file, and the ZIP archive around it.
#include "cad/scene/model_3mf.h"

#include <limits>
#include <span>

#include "cad/scene/zip_entry.h"
#include "fuzz/target.h"

namespace hvas::fuzz {

void TestOne(std::string_view bytes) {
  constexpr std::size_t kLimit = 1 << 20;
  const cad::Model3mf model = cad::ParseModel3mf(bytes);
  Check(model.length_unit > 0 && model.length_unit < 1e3);
  const auto entry = cad::ReadZipEntry(
      std::as_bytes(std::span(bytes)), [](std::string_view) { return true; }, kLimit);
  Check(!entry || entry->size() <= kLimit);
}

}  // namespace hvas::fuzz
