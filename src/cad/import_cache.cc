#include "cad/import_cache.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>

#include "base/digest.h"
#include "cad/input_file.h"
#include "product/product_io.h"

namespace hvas::cad {
namespace {

namespace fs = std::filesystem;

// To be raised whenever entries are named or written differently.
constexpr std::int64_t kVersion = 1;
constexpr const char* kExtension = ".hvasproduct";
constexpr const char* kUnfinished = ".hvasproduct-tmp";
constexpr auto kForgottenAfter = std::chrono::hours(1);
constexpr std::size_t kKeyLength = 32;

/** Tells builds of the worker apart. */
void AddWorker(const fs::path& worker, Digest* digest) {
  struct stat status {};

  if (::stat(worker.c_str(), &status) == 0) {
    digest->AddInt(status.st_size);
    digest->AddInt(status.st_mtim.tv_sec);
    digest->AddInt(status.st_mtim.tv_nsec);
  }
}

std::string KeyOf(const fs::path& worker, const fs::path& file, const ImportOptions& options) {
  // Whoever adds an option has to add it here, to the arguments of the process (import.cc), and to
  // what the process makes of them (worker_import.cc).
  const auto& [relative_deflection, min_deflection, max_angle, max_triangles, length_unit,
               with_tolerances, skipped_parts, threads] = options;
  static_cast<void>(threads);  // The result does not depend on it.
  Digest digest;
  digest.AddInt(kVersion);
  digest.AddInt(product::kProductFormat);
  AddWorker(worker, &digest);
  digest.AddDouble(relative_deflection);
  digest.AddDouble(min_deflection);
  digest.AddDouble(max_angle);
  digest.AddInt(static_cast<std::int64_t>(max_triangles));
  digest.AddInt(with_tolerances ? 1 : 0);
  digest.AddInt(static_cast<std::int64_t>(skipped_parts.size()));
  for (const std::uint32_t part : skipped_parts) {
    digest.AddInt(part);
  }
  digest.AddDouble(length_unit);
  digest.AddText(file.filename().string());  // It is in the product.
  digest.AddText(DigestOf(file));
  return digest.Hex();
}

/** While it lives, no Ctrl-C ends the program: an unfinished file would stay behind. */
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

bool WriteAll(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(descriptor, bytes.data(), bytes.size());
    if (size <= 0) {
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

}  // namespace

ImportCache::ImportCache(fs::path directory, const fs::path& worker, fs::path file,
                         const ImportOptions& options, std::uintmax_t capacity)
    : directory_(std::move(directory)),
      file_(std::move(file)),
      capacity_(capacity),
      key_(KeyOf(worker, file_, options)),
      path_(directory_ / (key_ + kExtension)) {}

std::optional<ImportResult> ImportCache::Load() const {
  const auto file = MappedFile::Open(path_);
  if (!file || file->bytes().size() < kKeyLength ||
      std::memcmp(file->bytes().data(), key_.data(), kKeyLength) != 0) {
    return std::nullopt;
  }
  const auto bytes = file->bytes().subspan(kKeyLength);
  auto result = DeserialiseImportResult(bytes);
  if (!result || !AreUnchanged(result->referred_files)) {
    return std::nullopt;
  }
  std::error_code ignored;  // Only the order in which entries go depends on it.
  fs::last_write_time(path_, fs::file_time_type::clock::now(), ignored);
  return result;
}

bool ImportCache::AreUnchanged(const std::vector<ReferredFile>& files) const {
  return std::all_of(files.begin(), files.end(), [this](const ReferredFile& file) {
    return DigestOf(file_.parent_path() / file.path) == file.digest;
  });
}

bool ImportCache::Store(std::span<const std::byte> result) const {
  std::error_code error;
  fs::create_directories(directory_, error);
  // Under a name of this program's own first, so that nobody sees half a file.
  static std::atomic<std::uint32_t> number{0};
  const fs::path unfinished =
      directory_ / fmt::format("{}.{}.{}{}", key_, ::getpid(), number++, kUnfinished);
  const SignalShield shield;
  const int descriptor =
      ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) {
    return false;
  }
  bool is_written =
      WriteAll(descriptor, std::as_bytes(std::span(key_))) && WriteAll(descriptor, result);
  is_written = ::close(descriptor) == 0 && is_written;
  if (is_written) {
    fs::rename(unfinished, path_, error);
    is_written = !error;
  }
  if (is_written) {
    Trim();
  } else {
    fs::remove(unfinished, error);
  }
  return is_written;
}

void ImportCache::Trim() const {
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
    std::error_code gone;  // Another program may trim as well.
    const fs::path extension = i->path().extension();
    if (extension != kExtension && extension != kUnfinished) {
      continue;
    }
    const std::uintmax_t size = i->file_size(gone);
    const auto time = i->last_write_time(gone);
    if (gone) {
      continue;
    }
    if (extension == kUnfinished && now - time > kForgottenAfter) {
      fs::remove(i->path(), gone);  // Of a program that was killed.
    } else if (extension == kExtension) {
      entries.push_back({i->path(), time, size});
      total += size;
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.time != b.time ? a.time < b.time : a.path < b.path;
  });
  for (const Entry& entry : entries) {
    if (total <= capacity_) {
      return;
    }
    if (entry.path != path_ && fs::remove(entry.path, error)) {
      total -= entry.size;
    }
  }
}

}  // namespace hvas::cad
