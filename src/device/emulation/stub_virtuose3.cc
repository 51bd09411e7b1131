// virtuoseAPI.so as version 3 has it: one function for all calls, behind inline ones in its header.

#include <cstdint>

extern "C" __attribute__((visibility("default"))) std::uintptr_t virtCallDLL(int /*function*/,
                                                                             ...) {
  return 0;
}
