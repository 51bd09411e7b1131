#include "record/recorder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "base/clock.h"
#include "base/crash_note.h"
#include "base/ring.h"
#include "record/packing.h"
#include "record/session_digest.h"

namespace hvas::record {
namespace {

// The writer looks for ticks 50 times a second, and writes what it has at least every 0.4 s, so
// that at most the last half second is missing on disk (docs/record.md).
constexpr std::chrono::milliseconds kPollPeriod{20};
constexpr std::int64_t kFlushPeriodNs = 2 * kNsPerSecond / 5;

// All but ticks.
using Item = std::variant<Event, Command, Frame, Attachment>;

// Takes what is added to the digest and, while the disk is well, to the file.
class Sink {
 public:
  Sink(std::optional<SessionFile> file, std::function<void(const Error&)> on_error)
      : file_(std::move(file)), on_error_(std::move(on_error)) {}

  void Add(const TickRecord& tick) {
    std::array<std::byte, kPackedTickSize> bytes{};
    Pack(tick, bytes);
    digest_.AddTick(bytes);
    if (is_writing()) {
      Note(file_->Add(tick.t_ns, bytes));
    }
  }

  void Add(const Event& event) {
    digest_.AddEvent(event);
    Write(event);
  }

  void Add(const Command& command) {
    digest_.AddCommand(command);
    Write(command);
  }

  void Add(const Frame& frame) { Write(frame); }

  void Add(const Attachment& attachment) { Write(attachment); }

  void Commit() {
    if (is_writing()) {
      Note(file_->Commit());
    }
  }

  void Close(Meta meta) {
    if (is_writing()) {
      meta[kMetaDigest] = digest_.Hex();
      Note(file_->Close(meta));
    }
    file_.reset();
  }

  [[nodiscard]] const SessionDigest& digest() const { return digest_; }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  [[nodiscard]] bool is_writing() const { return file_.has_value() && !error_.has_value(); }

  template <typename T>
  void Write(const T& item) {
    if (is_writing()) {
      Note(file_->Add(item));
    }
  }

  void Note(const Result<void>& done) {
    if (!done && !error_) {
      error_ = done.error();
      if (on_error_) {
        on_error_(*error_);
      }
    }
  }

  SessionDigest digest_;
  std::optional<SessionFile> file_;
  std::function<void(const Error&)> on_error_;
  std::optional<Error> error_;
};

}  // namespace

struct Recorder::Impl {
  Impl(std::optional<SessionFile> file, const RecorderOptions& options)
      : sink(std::move(file), options.on_error),
        is_threaded(options.is_threaded),
        waiting_frame_bytes(options.waiting_frame_bytes) {
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
      if (Drain() || MonotonicNs() - flushed_ns >= kFlushPeriodNs) {
        sink.Commit();
        flushed_ns = MonotonicNs();
      }
    }
  }

  // Takes the ticks before the items, and writes them after: a command that one of these ticks
  // obeyed is among these items or is written already. Returns whether an attachment was among
  // them: the product, without which the record is of little use, is not to wait for the next
  // commit.
  bool Drain() {
    ticks.clear();
    TickRecord tick;
    while (ticks.size() < ring->capacity() && ring->TryPop(&tick)) {
      ticks.push_back(tick);
    }
    std::vector<Item> taken;
    {
      const std::scoped_lock lock(items_mutex);
      taken.swap(items);
      frame_bytes = 0;
    }
    for (const Item& item : taken) {
      Sink* to = &sink;
      std::visit([to](const auto& one) { to->Add(one); }, item);
    }
    for (const TickRecord& one : ticks) {
      sink.Add(one);
    }
    return std::any_of(taken.begin(), taken.end(),
                       [](const Item& item) { return std::holds_alternative<Attachment>(item); });
  }

  void Add(Item item) {
    if (is_threaded) {
      const std::scoped_lock lock(items_mutex);
      items.push_back(std::move(item));
      return;
    }
    const std::scoped_lock lock(mutex);
    Sink* to = &sink;
    std::visit([to](const auto& one) { to->Add(one); }, item);
  }

  // Whether there is room for a frame among those that wait.
  bool Reserve(std::size_t bytes) {
    const std::scoped_lock lock(items_mutex);
    if (is_threaded && frame_bytes + bytes > waiting_frame_bytes) {
      ++dropped_frames;
      return false;
    }
    frame_bytes += bytes;
    return true;
  }

  mutable std::mutex mutex;  // Guards the sink; threaded, the writer alone holds it for long.
  Sink sink;
  const bool is_threaded;
  const std::size_t waiting_frame_bytes;
  bool is_finished{false};
  std::optional<Ring<TickRecord>> ring;
  std::vector<TickRecord> ticks;  // Of the writer thread.

  mutable std::mutex items_mutex;  // Guards what waits for the writer thread, and its count.
  std::vector<Item> items;
  std::size_t frame_bytes{0};
  std::uint64_t dropped_frames{0};

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
    Result<SessionFile> created = SessionFile::Create({.path = options.path,
                                                       .max_bytes = options.max_file_bytes,
                                                       .outlives_power = options.is_threaded,
                                                       .replaces = options.replaces},
                                                      whole);
    if (!created) {
      return Unexpected(created.error());
    }
    file.emplace(std::move(*created));
    NoteRecord(options.path.native());
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

void Recorder::AddEvent(Event event) {
  impl_->Add(std::move(event));
}

void Recorder::AddCommand(Command command) {
  impl_->Add(std::move(command));
}

bool Recorder::AddFrame(Frame frame) {
  const bool has_room = impl_->Reserve(frame.bytes.size());
  if (has_room) {
    impl_->Add(std::move(frame));
  }
  return has_room;
}

void Recorder::AddAttachment(Attachment attachment) {
  impl_->Add(std::move(attachment));
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
    impl_->sink.Close({{kMetaDropped, std::to_string(dropped_ticks())},
                       {kMetaDroppedFrames, std::to_string(dropped_frames())}});
    NoteRecord({});
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

std::uint64_t Recorder::dropped_frames() const {
  const std::scoped_lock lock(impl_->items_mutex);
  return impl_->dropped_frames;
}

std::optional<Error> Recorder::error() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->sink.error();
}

}  // namespace hvas::record
