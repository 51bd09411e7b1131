#include "paths/stl.h"

#include <array>
#include <cstdint>
#include <cstring>

#include "base/units.h"

namespace hvas::paths {
namespace {

template <typename T>
void Append(const T& value, std::string* bytes) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes->append(raw.data(), raw.size());
}

void AppendVector(const Vec3& vector, std::string* bytes) {
  for (const double x : vector) {
    Append(static_cast<float>(x), bytes);
  }
}

}  // namespace

std::string MakeStl(const SurfaceMesh& mesh) {
  constexpr std::size_t kHeader = 80;       // [bytes], any text.
  constexpr std::size_t kTriangle = 50;     // [bytes]: twelve floats and two of attributes.
  std::string bytes = "HVAS, millimetres";  // not "solid": that would be the format of text
  bytes.resize(kHeader, ' ');
  bytes.reserve(kHeader + sizeof(std::uint32_t) + kTriangle * mesh.triangles.size());
  Append(static_cast<std::uint32_t>(mesh.triangles.size()), &bytes);
  for (const auto& triangle : mesh.triangles) {
    const Vec3& a = mesh.vertices[triangle[0]];
    const Vec3& b = mesh.vertices[triangle[1]];
    const Vec3& c = mesh.vertices[triangle[2]];
    AppendVector((b - a).cross(c - a).normalized(), &bytes);
    for (const Vec3& corner : {a, b, c}) {
      AppendVector(units::ToMm(1) * corner, &bytes);
    }
    Append(std::uint16_t{0}, &bytes);
  }
  return bytes;
}

}  // namespace hvas::paths
