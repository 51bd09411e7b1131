#pragma once

#include <filesystem>

namespace hvas::app {

/** The example products that come with the program: beside it when it is installed, or with its
 sources. */
[[nodiscard]] std::filesystem::path ProductsFolder();

/** The same of study protocols. */
[[nodiscard]] std::filesystem::path StudiesFolder();

}  // namespace hvas::app
