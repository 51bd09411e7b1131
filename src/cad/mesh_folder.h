#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

/** Data sets have a product as a folder of meshes, one file a part, all in one frame. */
namespace hvas::cad {

/** The mesh files (.3mf, .gltf, .glb, .obj, .stl) that lie directly in a folder, in the order in
 which people count: "2.obj" comes before "10.obj". Of files that differ in their extension alone,
 the first by that list. */
[[nodiscard]] std::vector<std::filesystem::path> ListMeshFiles(const std::filesystem::path& folder);

/** The folder of a product: this one where it holds mesh files, else the only folder in it that
 does. @returns its absolute path. Errors: kUnreadable (no folder of meshes, or several), naming
 what to choose instead. */
[[nodiscard]] Result<std::filesystem::path> FindMeshFolder(const std::filesystem::path& folder);

/** Digest of the names and bytes of the mesh files of a folder. */
[[nodiscard]] std::string DigestOfMeshes(const std::filesystem::path& folder);

}  // namespace hvas::cad
