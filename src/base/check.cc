#include "base/check.h"

#include <cstdio>
#include <exception>

namespace hvas {

void FailCheck(const char* condition, const char* file, int line) noexcept {
  std::fprintf(stderr, "hvas: internal error: %s does not hold (%s:%d)\n", condition, file, line);
  std::terminate();
}

}  // namespace hvas
