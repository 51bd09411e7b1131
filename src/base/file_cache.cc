#include "base/file_cache.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/descriptor.h"
#include "base/user_folder.h"
#include "base/write_all.h"

namespace hvas {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnfinished = "-tmp";  // Behind the extension.
// An unfinished file this old was left by a process that was killed: a choice, as no shape takes so
// long to build.
constexpr auto kForgottenAfter = std::chrono::hours(1);

/** While it lives, no Ctrl-C that comes to this thread ends the program: an unfinished file would
 stay behind. One that another thread gets finds the file without a name where that can be had. */
class SignalShield {
 public:
  SignalShield() {
    sigset_t blocked;
    ::sigemptyset(&blocked);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
      ::sigaddset(&blocked, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }

  ~SignalShield() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

  SignalShield(const SignalShield&) = delete;
  SignalShield& operator=(const SignalShield&) = delete;

 private:
  sigset_t before_{};
};

bool WriteNew(const fs::path& path, std::initializer_list<std::span<const std::byte>> pieces) {
  constexpr mode_t kMode = S_IRUSR | S_IWUSR;
  Descriptor file(::open(path.parent_path().c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kMode));
  const bool is_nameless = file.is_open();
  if (!is_nameless) {  // Not every file system knows files without a name.
    file = Descriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode));
  }
  if (!file.is_open()) {
    return false;
  }
  bool is_written = std::all_of(pieces.begin(), pieces.end(), [&file](const auto piece) {
    return WriteAll(file.value(), piece) == 0;
  });
  if (is_written && is_nameless) {
    is_written = ::linkat(AT_FDCWD, fmt::format("/proc/self/fd/{}", file.value()).c_str(), AT_FDCWD,
                          path.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }
  return file.Close() && is_written;
}

}  // namespace

FileCache::FileCache(fs::path directory, std::string extension, std::uintmax_t capacity)
    : directory_(std::move(directory)), extension_(std::move(extension)), capacity_(capacity) {}

std::optional<fs::path> FileCache::DefaultDirectory() {
  const char* wanted = std::getenv("HVAS_CACHE");
  const bool is_off = wanted != nullptr && std::string_view(wanted) == "off";
  return is_off ? std::nullopt : FindUserFolder("XDG_CACHE_HOME", ".cache");
}

fs::path FileCache::PathOf(const std::string& key) const {
  return directory_ / (key + extension_);
}

bool FileCache::Store(const std::string& key,
                      std::initializer_list<std::span<const std::byte>> pieces) const {
  std::error_code error;
  fs::create_directories(directory_, error);
  const fs::path path = PathOf(key);
  // Under a name of this program's own first, so that nobody sees half a file.
  static std::atomic<std::uint32_t> number{0};
  const fs::path unfinished =
      directory_ / fmt::format("{}.{}.{}{}{}", key, ::getpid(), number++, extension_, kUnfinished);
  const SignalShield shield;
  bool is_stored = WriteNew(unfinished, pieces);
  if (is_stored) {
    fs::rename(unfinished, path, error);
    is_stored = !error;
  }
  if (is_stored) {
    Trim(path);
  } else {
    fs::remove(unfinished, error);
  }
  return is_stored;
}

void FileCache::Touch(const std::string& key) const {
  std::error_code ignored;  // Only the order in which files go depends on it.
  fs::last_write_time(PathOf(key), fs::file_time_type::clock::now(), ignored);
}

void FileCache::Trim(const fs::path& newest) const {
  struct Entry {
    fs::path path;
    fs::file_time_type time;
    std::uintmax_t size;
  };

  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  const auto now = fs::file_time_type::clock::now();
  std::error_code error;
  for (fs::directory_iterator i(directory_, error), end; !error && i != end; i.increment(error)) {
    const bool is_finished = i->path().extension() == extension_;
    if (!is_finished && i->path().extension() != extension_ + kUnfinished) {
      continue;
    }
    std::error_code gone;  // Another program may trim as well.
    const auto time = i->last_write_time(gone);
    const std::uintmax_t size = gone ? 0 : i->file_size(gone);
    if (gone) {
      continue;
    }
    if (is_finished) {
      entries.push_back({i->path(), time, size});
      total += size;
    } else if (now - time > kForgottenAfter) {
      fs::remove(i->path(), gone);  // Of a program that was killed.
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.time != b.time ? a.time < b.time : a.path < b.path;
  });
  for (const Entry& entry : entries) {
    if (total <= capacity_) {
      return;
    }
    if (entry.path != newest && fs::remove(entry.path, error)) {
      total -= entry.size;
    }
  }
}

}  // namespace hvas
