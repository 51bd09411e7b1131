#include "cad/scene/mesh_format.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string>
#include <system_error>

namespace hvas::cad {
namespace {

std::string LowerExtension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/** Whether the size is that which the count of triangles in the head asks for. */
bool IsBinaryStl(const std::filesystem::path& file, std::string_view head) {
  constexpr std::size_t kHeader = 80;    // [bytes], any text; then the count in 4.
  constexpr std::size_t kTriangle = 50;  // [bytes]: twelve floats and two of attributes.
  if (head.size() < kHeader + 4) {
    return false;
  }
  std::uint64_t count = 0;
  for (std::size_t i = 4; i > 0; --i) {
    count = count << 8 | static_cast<unsigned char>(head[kHeader + i - 1]);
  }
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  return !error && count > 0 && size == kHeader + 4 + kTriangle * count;
}

bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

/** Whether a line of the text starts with a keyword and a blank. */
bool HasLine(std::string_view head, std::string_view keyword) {
  for (std::size_t at = head.find(keyword); at != std::string_view::npos;
       at = head.find(keyword, at + 1)) {
    const std::size_t end = at + keyword.size();
    if ((at == 0 || head[at - 1] == '\n' || head[at - 1] == '\r') && end < head.size() &&
        (head[end] == ' ' || head[end] == '\t')) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::optional<MeshFormat> FindMeshFormat(const std::filesystem::path& file, std::string_view head) {
  const std::string extension = LowerExtension(file);
  if (StartsWith(head, "glTF")) {
    return MeshFormat::kGltf;
  }
  if (StartsWith(head, "PK\x03\x04") &&
      (extension == ".3mf" || head.find("3D/") != std::string_view::npos)) {
    return MeshFormat::k3mf;
  }
  if (IsBinaryStl(file, head)) {
    return MeshFormat::kStl;
  }
  std::string_view text = head;
  if (StartsWith(text, "\xEF\xBB\xBF")) {
    text.remove_prefix(3);
  }
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  if (StartsWith(text, "solid") &&
      (extension == ".stl" || text.find("facet") != std::string_view::npos)) {
    return MeshFormat::kStl;
  }
  if (StartsWith(text, "{") &&
      (extension == ".gltf" || text.find("\"asset\"") != std::string_view::npos)) {
    return MeshFormat::kGltf;
  }
  if (HasLine(text, "v") && (extension == ".obj" || HasLine(text, "f") || HasLine(text, "o"))) {
    return MeshFormat::kObj;
  }
  // Damaged or unusual, but called so: its reader says what is wrong.
  if (extension == ".stl") {
    return MeshFormat::kStl;
  }
  if (extension == ".obj") {
    return MeshFormat::kObj;
  }
  if (extension == ".glb" || extension == ".gltf") {
    return MeshFormat::kGltf;
  }
  return extension == ".3mf" ? std::optional(MeshFormat::k3mf) : std::nullopt;
}

const char* NameOf(MeshFormat format) {
  switch (format) {
    case MeshFormat::kStl:
      return "STL";
    case MeshFormat::kObj:
      return "OBJ";
    case MeshFormat::kGltf:
      return "glTF";
    case MeshFormat::k3mf:
      break;
  }
  return "3MF";
}

}  // namespace hvas::cad
