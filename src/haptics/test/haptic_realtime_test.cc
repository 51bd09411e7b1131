// A tick allocates nothing, locks nothing, prints nothing and throws nothing, in every state (X4).
//
// The functions of the C library that would do it are replaced in this program by ones that count
// while a tick runs. Under a sanitizer the allocator stays the sanitizer's own and only the rest is
// counted.

#include <pthread.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "haptics/haptic_tick.h"
#include "haptics/test/rig.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HVAS_COUNTS_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define HVAS_COUNTS_MALLOC 0
#endif
#endif
#ifndef HVAS_COUNTS_MALLOC
#define HVAS_COUNTS_MALLOC 1
#endif

namespace {

enum Call { kMalloc, kFree, kLock, kWrite, kCallCount };

thread_local bool is_guarded = false;
thread_local std::array<int, kCallCount> calls{};

void Count(Call call) noexcept {
  if (is_guarded) {
    ++calls[call];
  }
}

template <typename Function>
Function* Next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

#if HVAS_COUNTS_MALLOC
// glibc's own names for its allocator; they need no dlsym, which itself allocates.
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* p);

void* malloc(std::size_t size) {
  Count(kMalloc);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  Count(kMalloc);
  return __libc_calloc(count, size);
}

void* realloc(void* p, std::size_t size) {
  Count(kMalloc);
  return __libc_realloc(p, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  Count(kMalloc);
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  Count(kMalloc);
  *p = __libc_memalign(alignment, size);
  return 0;
}

void free(void* p) {
  Count(kFree);
  __libc_free(p);
}
#endif

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  Count(kLock);
  static auto* next = Next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  return next(mutex);
}

ssize_t write(int file, const void* data, std::size_t size) {
  Count(kWrite);
  static auto* next = Next<ssize_t(int, const void*, std::size_t)>("write");
  return next(file, data, size);
}

int puts(const char* text) {
  Count(kWrite);
  static auto* next = Next<int(const char*)>("puts");
  return next(text);
}

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* file) {
  Count(kWrite);
  static auto* next = Next<std::size_t(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  return next(data, size, count, file);
}
}

namespace hvas::haptics {
namespace {

using testing::Above;
using testing::kDt;
using testing::MakeFit;
using testing::Rig;

static_assert(
    noexcept(std::declval<HapticTick&>().Tick(std::declval<const device::DeviceState&>())));
static_assert(noexcept(std::declval<HapticTick&>().Take(std::declval<const HeldPart*>())));
static_assert(noexcept(std::declval<HapticTick&>().Drop()));

/** Counts what happens while it lives. */
class Guard {
 public:
  Guard() {
    calls = {};
    is_guarded = true;
  }

  ~Guard() { is_guarded = false; }

  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
};

// The counters do count: a test that could not fail would prove nothing.
TEST(RealtimeGuard, SeesAllocationsLocksAndOutput) {
  static std::mutex mutex;
  int* volatile p = nullptr;
  {
    const Guard guard;
    p = new int(3);
    delete p;
    mutex.lock();
    mutex.unlock();
    if (write(STDERR_FILENO, "", 0) < 0) {
      std::abort();
    }
  }
#if HVAS_COUNTS_MALLOC
  EXPECT_EQ(calls[kMalloc], 1);
  EXPECT_EQ(calls[kFree], 1);
  {
    const Guard guard;
    try {
      throw std::runtime_error("an exception allocates");
    } catch (const std::exception&) {
    }
  }
  EXPECT_GT(calls[kMalloc], 0);  // So a tick without allocations has thrown nothing either.
#endif
  {
    const Guard guard;
    mutex.lock();
    mutex.unlock();
    if (write(STDERR_FILENO, "", 0) < 0) {
      std::abort();
    }
  }
  EXPECT_EQ(calls[kLock], 1);
  EXPECT_EQ(calls[kWrite], 1);
}

/** Ticks with a moving hand, each under the guard. */
class GuardedHand {
 public:
  GuardedHand(HapticTick* tick, const Vec3& p_WH) : tick_(tick), p_WH_(p_WH) {}

  void Move(const Vec3& d, double time, bool is_valid = true) {
    const int n = static_cast<int>(std::lround(time / kDt));
    for (int i = 0; i < n; ++i) {
      p_WH_ += d / n;
      device::DeviceState state;
      state.X_DH = spatial::Pose(p_WH_);
      state.V_DH.v = d / time;
      state.is_valid = is_valid;
      TickOutput out;
      {
        const Guard guard;
        out = tick_->Tick(state);
      }
      for (std::size_t k = 0; k < totals.size(); ++k) {
        totals[k] += calls[k];
      }
      ++ticks;
      contacts += out.contact_count;
      states.insert(out.state);
    }
  }

  std::array<int, kCallCount> totals{};
  int ticks{0};
  int contacts{0};
  std::set<HoldState> states;

 private:
  HapticTick* tick_;
  Vec3 p_WH_;
};

TEST(HapticTickRealtime, TicksInEveryStateTouchNoHeapLockOrFile) {
  Rig rig(MakeFit("H7/k6"), Above(40e-3, 25e-3));
  rig.tick->Drop();
  GuardedHand hand(rig.tick.get(), Above(40e-3, 25e-3) * rig.part.p_BoBcm_B);
  hand.Move(Vec3(0, 0, 1e-3), 0.1);  // Empty.
  {
    const Guard guard;
    rig.tick->Take(&rig.part);
  }
  EXPECT_EQ(calls, (std::array<int, kCallCount>{}));
  hand.Move(Vec3(0, 0, 20e-3), 0.2);
  hand.Move(Vec3(0, 0, -20e-3), 0.2);
  hand.Move(Vec3(-10e-3, 0, -44e-3), 0.5);  // Onto the rim.
  hand.Move(Vec3(0, 0, 9e-3), 0.4);
  hand.Move(Vec3(-15e-3, 0, 4e-3), 0.5);
  hand.Move(Vec3::Zero(), 0.05, false);  // A device without a pose.
  hand.Move(Vec3::Zero(), 0.5);
  hand.Move(Vec3(0, 0, -70e-3), 2);
  hand.Move(Vec3::Zero(), 0.3);
  {
    const Guard guard;
    (void)rig.tick->Drop();
  }
  EXPECT_EQ(calls, (std::array<int, kCallCount>{}));
  EXPECT_EQ(hand.totals, (std::array<int, kCallCount>{}));
  EXPECT_GT(hand.ticks, 4000);
  EXPECT_GT(hand.contacts, 100);
  EXPECT_EQ(hand.states,
            (std::set<HoldState>{HoldState::kEmpty, HoldState::kFree, HoldState::kNear,
                                 HoldState::kCaptured, HoldState::kMating, HoldState::kSeated}));
}

}  // namespace
}  // namespace hvas::haptics
