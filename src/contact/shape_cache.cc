#include "contact/shape_cache.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "base/digest.h"
#include "base/regular_file.h"
#include "contact/shape_io.h"

namespace hvas::contact {
namespace {

namespace fs = std::filesystem;

// To be raised whenever shapes are built or written differently.
constexpr std::uint32_t kVersion = 29;
constexpr std::array<char, 8> kMagic{'H', 'V', 'A', 'S', 'S', 'H', 'A', 'P'};
constexpr const char* kExtension = ".hvasshape";
constexpr std::size_t kKeyLength = 32;  // Hex digits of 128 bits.

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

}  // namespace

ShapeCache::ShapeCache(fs::path directory, std::uintmax_t capacity)
    : files_(std::move(directory), kExtension, capacity) {}

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
  return files_.PathOf(KeyOf(source, options));
}

std::optional<Error> ShapeCache::TakeProblem() {
  const std::lock_guard lock(mutex_);
  return std::exchange(problem_, std::nullopt);
}

std::shared_ptr<const Shape> ShapeCache::Load(const std::string& key) const {
  const auto file = ReadRegularFile(files_.PathOf(key));
  if (!file || file->size() < sizeof(Header)) {
    return nullptr;
  }
  const auto bytes = std::as_bytes(std::span(*file)).subspan(sizeof(Header));
  const Header expected = HeaderOf(key, bytes);
  if (std::memcmp(file->data(), &expected, sizeof(Header)) != 0) {
    return nullptr;
  }
  auto shape = DeserialiseShape(bytes);
  if (shape != nullptr) {
    files_.Touch(key);
  }
  return shape;
}

void ShapeCache::Store(const std::string& key, const Shape& shape) {
  const std::vector<std::byte> bytes = SerialiseShape(shape);
  const Header header = HeaderOf(key, bytes);
  const std::lock_guard lock(mutex_);
  if (!files_.Store(key, {std::as_bytes(std::span(&header, 1)), bytes}) && !is_problem_known_) {
    is_problem_known_ = true;
    problem_ = Error{ErrorCode::kOutOfResource, "contact shapes cannot be cached on disk",
                     files_.directory().string(),
                     "free disk space there and make the folder writable, or set HVAS_CACHE=off"};
  }
}

}  // namespace hvas::contact
