#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace hvas::fuzz {

/** What each target does with any bytes: read them, and check what must hold of any answer. Linked
 with replay.cc, which feeds it damaged copies of seeds, or with libfuzzer.cc. */
void TestOne(std::string_view bytes);

/** Ends the program, with the line, when something that must hold does not. */
inline void Check(bool holds, int line = __builtin_LINE()) {
  if (!holds) {
    std::fprintf(stderr, "line %d does not hold\n", line);
    std::abort();
  }
}

}  // namespace hvas::fuzz
