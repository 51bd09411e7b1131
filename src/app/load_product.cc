#include "app/load_product.h"

#include "cad/import.h"
#include "mates/assignments.h"
#include "mates/infer.h"
#include "mates/stated_fits.h"

namespace hvas::app {

Result<product::Product> LoadProduct(
    const std::filesystem::path& file, const std::vector<std::string>& fits,
    Diagnostics* diagnostics, const std::function<void(std::string_view, double)>& progress) {
  auto product = cad::Import(file, {}, diagnostics, {{}, progress, {}, {}});
  if (!product) {
    return product;
  }
  mates::Infer(&*product, diagnostics);
  mates::AssignStatedFits(&*product);
  const std::filesystem::path side_file = mates::FindAssignmentFile(file);
  if (std::filesystem::exists(side_file)) {
    if (const auto applied = mates::ApplyAssignments(side_file, &*product); !applied) {
      return Unexpected(applied.error());
    }
  }
  for (const std::string& fit : fits) {
    if (const auto assigned = mates::AssignFit(&*product, fit); !assigned) {
      return Unexpected(assigned.error());
    }
  }
  return product;
}

}  // namespace hvas::app
