#pragma once

#include <cstddef>
#include <functional>

namespace hvas {

/** Calls `work` for every index below `count`, on as many threads as the machine has cores, or on
 `threads` of them if that is not 0; on the calling thread alone if it is 1. Indices start in
 ascending order. The calling thread calls `progress` now and then with the number of indices that
 are done. The first exception by index is thrown again when all threads have ended; later indices
 are not begun after one. */
void ForEachIndex(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(std::size_t)>& progress = {});

}  // namespace hvas
