#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace hvas::cad {

enum class MeshFormat { kStl, kObj, kGltf, k3mf };

/** The mesh format of a file by its first bytes; where these leave it open (a text of coordinates,
 any JSON, any archive) its extension has to agree.
 @param head  The first bytes; 4 KiB will do. */
[[nodiscard]] std::optional<MeshFormat> FindMeshFormat(const std::filesystem::path& file,
                                                       std::string_view head);

/** "STL", ... */
[[nodiscard]] const char* NameOf(MeshFormat format);

}  // namespace hvas::cad
