#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <assimp/IOSystem.hpp>

namespace hvas::cad {

/** Lets assimp read files in one folder and below it, and nothing else: what a file names as its
 buffer or material library may be any path, or an address. */
class ConfinedIo : public Assimp::IOSystem {
 public:
  /** What became of the names that were asked for; outlives the object, which assimp owns. */
  struct Log {
    std::vector<std::filesystem::path> read;     ///< Absolute.
    std::vector<std::filesystem::path> missing;  ///< Absolute.
    std::vector<std::string> refused;            ///< Names that were asked for.
  };

  /** @param file  The file to be read, absolute and without links; its folder is the limit. */
  ConfinedIo(const std::filesystem::path& file, Log* log);

  bool Exists(const char* name) const override;

  char getOsSeparator() const override { return '/'; }

  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  /** The file that a name means; empty where it is none of ours. */
  [[nodiscard]] std::filesystem::path Resolve(const char* name) const;

  std::filesystem::path folder_;
  Log* log_;
};

}  // namespace hvas::cad
