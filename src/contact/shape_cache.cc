#include "contact/shape_cache.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/digest.h"
#include "contact/shape_io.h"

namespace hvas::contact {
namespace {

namespace fs = std::filesystem;

// To be raised whenever shapes are built or written differently.
constexpr std::uint32_t kVersion = 3;
constexpr std::array<char, 8> kMagic{'H', 'V', 'A', 'S', 'S', 'H', 'A', 'P'};
constexpr const char* kExtension = ".hvasshape";
constexpr const char* kUnfinished = ".tmp";
constexpr std::size_t kKeyLength = 32;

struct Header {
  std::array<char, 8> magic{kMagic};
  std::uint32_t version{kVersion};
  std::uint32_t header_size{0};
  std::array<char, kKeyLength> key{};
  std::uint64_t size{0};  // Of the bytes that follow.
  std::uint64_t checksum{0};
};

static_assert(sizeof(Header) == 64);

Header HeaderOf(const std::string& key, std::span<const std::byte> bytes) {
  Header header;
  header.header_size = sizeof(Header);
  std::copy_n(key.begin(), kKeyLength, header.key.begin());
  header.size = bytes.size();
  header.checksum = Checksum64(bytes);
  return header;
}

void AddVec3(const Vec3& v, Digest* digest) {
  for (int k = 0; k < 3; ++k) {
    digest->AddDouble(v[k]);
  }
}

template <typename T>
void AddInts(const std::vector<T>& values, Digest* digest) {
  digest->AddInt(static_cast<std::int64_t>(values.size()));
  digest->AddBytes(std::as_bytes(std::span(values)));
}

std::string KeyOf(const ShapeSource& source, const ShapeOptions& options) {
  Digest digest;
  digest.AddInt(kVersion);
  digest.AddText(__VERSION__);  // Another compiler may round differently.
  digest.AddDouble(options.voxel);
  digest.AddDouble(options.point_spacing);
  digest.AddInt(static_cast<std::int64_t>(source.vertices.size()));
  for (const Vec3& v : source.vertices) {
    AddVec3(v, &digest);
  }
  AddInts(source.triangles, &digest);
  AddInts(source.triangle_face, &digest);
  digest.AddInt(static_cast<std::int64_t>(source.faces.size()));
  for (const spatial::Surface& face : source.faces) {
    digest.AddInt(static_cast<std::int64_t>(face.kind));
    AddVec3(face.origin, &digest);
    AddVec3(face.axis, &digest);
    digest.AddDouble(face.radius);
    digest.AddDouble(face.second);
    digest.AddDouble(face.outward);
  }
  return digest.Hex();
}

std::optional<std::vector<std::byte>> ReadFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) {
    return std::nullopt;
  }
  const std::streamoff size = file.tellg();
  if (size < 0) {
    return std::nullopt;
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(size));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), size);
  return file ? std::optional(std::move(bytes)) : std::nullopt;
}

bool WriteFile(const fs::path& path, const Header& header, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  return !file.fail();
}

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

}  // namespace

ShapeCache::ShapeCache(fs::path directory, std::uintmax_t capacity)
    : directory_(std::move(directory)), capacity_(capacity) {}

std::optional<fs::path> ShapeCache::DefaultDirectory() {
  if (Variable("HVAS_CACHE") == "off") {
    return std::nullopt;
  }
  const fs::path caches = Variable("XDG_CACHE_HOME");
  if (caches.is_absolute()) {  // Others are to be ignored; XDG Base Directory Specification.
    return caches / "hvas";
  }
  const fs::path home = Variable("HOME");
  return home.is_absolute() ? std::optional(home / ".cache" / "hvas") : std::nullopt;
}

Result<std::shared_ptr<const Shape>> ShapeCache::LoadOrBuild(const ShapeSource& source,
                                                             const ShapeOptions& options) {
  const std::string key = KeyOf(source, options);
  if (auto shape = Load(key)) {
    ++loaded_;
    return shape;
  }
  auto shape = Shape::Build(source, options);
  if (shape) {
    ++built_;
    Store(key, **shape);
  }
  return shape;
}

fs::path ShapeCache::PathOf(const ShapeSource& source, const ShapeOptions& options) const {
  return PathOf(KeyOf(source, options));
}

fs::path ShapeCache::PathOf(const std::string& key) const {
  return directory_ / (key + kExtension);
}

std::optional<Error> ShapeCache::TakeProblem() {
  const std::lock_guard lock(mutex_);
  return std::exchange(problem_, std::nullopt);
}

std::shared_ptr<const Shape> ShapeCache::Load(const std::string& key) const {
  const fs::path path = PathOf(key);
  const auto file = ReadFile(path);
  if (!file || file->size() < sizeof(Header)) {
    return nullptr;
  }
  const auto bytes = std::span(*file).subspan(sizeof(Header));
  const Header expected = HeaderOf(key, bytes);
  if (std::memcmp(file->data(), &expected, sizeof(Header)) != 0) {
    return nullptr;
  }
  auto shape = DeserialiseShape(bytes);
  if (shape != nullptr) {
    std::error_code ignored;  // Only the order in which shapes go depends on it.
    fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  }
  return shape;
}

void ShapeCache::Store(const std::string& key, const Shape& shape) {
  const std::vector<std::byte> bytes = SerialiseShape(shape);
  const Header header = HeaderOf(key, bytes);
  const std::lock_guard lock(mutex_);
  std::error_code error;
  fs::create_directories(directory_, error);
  const fs::path path = PathOf(key);
  // Under a name of this program's own first, so that nobody sees half a file.
  static std::atomic<std::uint32_t> number{0};
  const fs::path unfinished =
      path.string() + fmt::format(".{}.{}{}", getpid(), number++, kUnfinished);
  bool is_written = !error && WriteFile(unfinished, header, bytes);
  if (is_written) {
    fs::rename(unfinished, path, error);
    is_written = !error;
  }
  if (is_written) {
    Trim(path);
    return;
  }
  std::error_code ignored;
  fs::remove(unfinished, ignored);
  if (!is_problem_known_) {
    is_problem_known_ = true;
    problem_ =
        Error{ErrorCode::kOutOfResource, "Contact shapes cannot be kept on disk",
              directory_.string(), "make room there and make it writable, or set HVAS_CACHE=off"};
  }
}

void ShapeCache::Trim(const fs::path& newest) const {
  struct Entry {
    fs::path path;
    fs::file_time_type time;
    std::uintmax_t size;
  };

  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  for (fs::directory_iterator i(directory_, error), end; !error && i != end; i.increment(error)) {
    std::error_code gone;  // Another program may trim as well.
    const fs::path extension = i->path().extension();
    const bool is_ours = extension == kExtension || extension == kUnfinished;
    const std::uintmax_t size = is_ours ? i->file_size(gone) : 0;
    const auto time = i->last_write_time(gone);
    if (!gone && size > 0) {
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
    if (entry.path != newest && fs::remove(entry.path, error)) {
      total -= entry.size;
    }
  }
}

}  // namespace hvas::contact
