#include "record/recorder.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/ring.h"
#include "record/packing.h"
#include "record/session_digest.h"

namespace hvas::record {
namespace {

constexpr std::chrono::milliseconds kPollPeriod{20};
constexpr std::int64_t kFlushPeriodNs = 2 * kNsPerSecond / 5;

// Takes ticks and events to the digest and, while the disk is well, to the file.
class Sink {
 public:
  explicit Sink(std::optional<SessionFile> file) : file_(std::move(file)) {}

  void Add(const TickRecord& tick) {
    std::array<std::byte, kPackedTickSize> bytes{};
    Pack(tick, bytes);
    digest_.AddTick(bytes);
    if (is_writing()) {
      Note(file_->AddTick(tick.t_ns, bytes));
    }
  }

  void Add(const Event& event) {
    digest_.AddEvent(event);
    if (is_writing()) {
      Note(file_->AddEvent(event));
    }
  }

  void Commit() {
    if (is_writing()) {
      Note(file_->Commit());
    }
  }

  void Close(std::uint64_t dropped_ticks) {
    if (is_writing()) {
      Note(file_->Close(
          {{kMetaDigest, digest_.Hex()}, {kMetaDropped, std::to_string(dropped_ticks)}}));
    }
    file_.reset();
  }

  [[nodiscard]] const SessionDigest& digest() const { return digest_; }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  [[nodiscard]] bool is_writing() const { return file_.has_value() && !error_.has_value(); }

  void Note(const Result<void>& done) {
    if (!done) {
      error_ = done.error();
    }
  }

  SessionDigest digest_;
  std::optional<SessionFile> file_;
  std::optional<Error> error_;
};

}  // namespace

struct Recorder::Impl {
  Impl(std::optional<SessionFile> file, const RecorderOptions& options)
      : sink(std::move(file)), is_threaded(options.is_threaded) {
    if (is_threaded) {
      ring.emplace(options.ring_ticks);
      writer = std::thread([this] { Write(); });
    }
  }

  // The writer thread.
  void Write() {
    std::int64_t flushed_ns = MonotonicNs();
    for (bool is_last = false; !is_last;) {
      {
        std::unique_lock lock(wake_mutex);
        wake.wait_for(lock, kPollPeriod, [this] { return is_stopping; });
        is_last = is_stopping;
      }
      const std::scoped_lock lock(mutex);
      Drain();
      if (MonotonicNs() - flushed_ns >= kFlushPeriodNs) {
        sink.Commit();
        flushed_ns = MonotonicNs();
      }
    }
  }

  void Drain() {
    TickRecord tick;
    while (ring->TryPop(&tick)) {
      sink.Add(tick);
    }
  }

  mutable std::mutex mutex;  // Guards the sink; never taken by AddTick() when threaded.
  Sink sink;
  const bool is_threaded;
  bool is_finished{false};
  std::optional<Ring<TickRecord>> ring;
  std::mutex wake_mutex;
  std::condition_variable wake;
  bool is_stopping{false};
  std::thread writer;
};

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Recorder::~Recorder() {
  static_cast<void>(Finish());
}

Result<std::unique_ptr<Recorder>> Recorder::Create(const RecorderOptions& options,
                                                   const Meta& meta) {
  std::optional<SessionFile> file;
  if (!options.path.empty()) {
    Meta whole = meta;
    whole[kMetaStarted] = std::to_string(WallClockNs());
    Result<SessionFile> created = SessionFile::Create(options.path, whole, options.max_file_bytes);
    if (!created) {
      return Unexpected(created.error());
    }
    file.emplace(std::move(*created));
  }
  return std::unique_ptr<Recorder>(new Recorder(std::make_unique<Impl>(std::move(file), options)));
}

bool Recorder::AddTick(const TickRecord& tick) noexcept {
  if (impl_->is_threaded) {
    return impl_->ring->TryPush(tick);
  }
  const std::scoped_lock lock(impl_->mutex);
  impl_->sink.Add(tick);
  return true;
}

void Recorder::AddEvent(const Event& event) {
  const std::scoped_lock lock(impl_->mutex);
  impl_->sink.Add(event);
}

Result<void> Recorder::Finish() {
  if (!std::exchange(impl_->is_finished, true)) {
    if (impl_->writer.joinable()) {
      {
        const std::scoped_lock lock(impl_->wake_mutex);
        impl_->is_stopping = true;
      }
      impl_->wake.notify_one();
      impl_->writer.join();
    }
    const std::scoped_lock lock(impl_->mutex);
    impl_->sink.Close(dropped_ticks());
  }
  if (const std::optional<Error> failed = error()) {
    return Unexpected(*failed);
  }
  return {};
}

std::string Recorder::Digest() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->sink.digest().Hex();
}

std::int64_t Recorder::tick_count() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->sink.digest().tick_count();
}

std::uint64_t Recorder::dropped_ticks() const {
  return impl_->ring.has_value() ? impl_->ring->dropped() : 0;
}

std::optional<Error> Recorder::error() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->sink.error();
}

}  // namespace hvas::record
