#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "base/result.h"

namespace hvas::cad {

/** The bytes of a file, as they lie there. Only for files that nobody makes shorter meanwhile. */
class MappedFile {
 public:
  /** The bytes behind an open file, which may be closed afterwards.
   Errors: kUnreadable, without saying which file. */
  [[nodiscard]] static Result<MappedFile> Open(int descriptor);
  /** The bytes of a regular file. Errors: those of RegularFile::Open(). */
  [[nodiscard]] static Result<MappedFile> Open(const std::filesystem::path& path);

  MappedFile() = default;
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

/** Checks that a file is there, can be read and holds something.
 @returns its absolute path, without which OpenCASCADE does not find the files that it refers to.
 Errors: kNotFound, kUnreadable. */
[[nodiscard]] Result<std::filesystem::path> CheckInputFile(const std::filesystem::path& file);

/** Checks a file as CheckInputFile() does, or a folder of meshes as FindMeshFolder() does
 (cad/mesh_folder.h). @returns its absolute path. Errors: those of both. */
[[nodiscard]] Result<std::filesystem::path> CheckInput(const std::filesystem::path& path);

/** What to choose instead of a file that is none of these. */
inline constexpr const char* kFormats =
    "choose a STEP file (.step or .stp; AP203, AP214 or AP242), an IGES file (.igs or .iges), a "
    "mesh "
    "(.obj, .stl, .gltf, .glb or .3mf), or a folder of meshes";

/** Digest of a file's bytes; empty where it cannot be read. */
[[nodiscard]] std::string DigestOf(const std::filesystem::path& path);

}  // namespace hvas::cad
