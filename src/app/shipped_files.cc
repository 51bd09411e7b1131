#include "app/shipped_files.h"

#include <system_error>

namespace hvas::app {
namespace {

std::filesystem::path FindFolder(const char* installed_name, const char* built) {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path installed =
      program.parent_path().parent_path() / "share" / "hvas" / installed_name;
  return std::filesystem::exists(installed, failed) ? installed : std::filesystem::path(built);
}

}  // namespace

std::filesystem::path FindProductsFolder() {
  return FindFolder("products", HVAS_BUILT_FILES "/products");
}

std::filesystem::path FindStudiesFolder() {
  return FindFolder("studies", HVAS_BUILT_FILES "/data/studies");
}

}  // namespace hvas::app
