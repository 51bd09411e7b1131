#pragma once

#include <filesystem>

namespace hvas::app {

/** The example products that come with the program: beside it when it is installed, or with its
 sources. */
[[nodiscard]] std::filesystem::path FindProductsFolder();

/** The folder of study protocols that are shipped. */
[[nodiscard]] std::filesystem::path FindStudiesFolder();

}  // namespace hvas::app
