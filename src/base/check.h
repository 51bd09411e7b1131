#pragma once

namespace hvas {

/** Ends the program by std::terminate(), after saying on the standard error stream what does not
 hold and where. */
[[noreturn]] void FailCheck(const char* condition, const char* file, int line) noexcept;

}  // namespace hvas

/** Ends the program where a precondition does not hold: the mistake is the caller's, and what would
 follow could be a wrong answer. For functions that the tick does not reach. */
#define HVAS_DEMAND(condition) \
  (static_cast<bool>(condition) ? void() : ::hvas::FailCheck(#condition, __FILE__, __LINE__))

/** Demands it in builds without NDEBUG, as those with sanitizers are: for what the tick reaches, or
 what costs too much to be asked for always. */
#ifdef NDEBUG
#define HVAS_ASSERT(condition) (void(sizeof(static_cast<bool>(condition))))
#else
#define HVAS_ASSERT(condition) HVAS_DEMAND(condition)
#endif
