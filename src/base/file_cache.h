#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>

namespace hvas {

/** Files in a directory, each under a key that says what it was made from, so that it is made once.

 Several threads and several programs may use one directory at once, and caches of different
 extensions may share it: nobody sees half a file, and whatever cannot be done (touching, removing,
 storing) costs time and nothing else. What a file holds is checked by whoever reads it. */
class FileCache {
 public:
  /** [bytes], some hundred products: a choice. */
  static constexpr std::uintmax_t kDefaultCapacity = 2'000'000'000;

  /** @param directory  Made when the first file is stored.
   @param extension  Of this cache's files, with its dot.
   @param capacity  Of this cache's files together [bytes]: beyond it, those not used for longest
   go, but never the one just stored. */
  FileCache(std::filesystem::path directory, std::string extension,
            std::uintmax_t capacity = kDefaultCapacity);

  /** $XDG_CACHE_HOME/hvas, else ~/.cache/hvas; none when HVAS_CACHE is "off" or there is no home.
   */
  [[nodiscard]] static std::optional<std::filesystem::path> DefaultDirectory();

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }

  /** The file that holds, or would hold, what belongs to the key. */
  [[nodiscard]] std::filesystem::path PathOf(const std::string& key) const;

  /** Keeps the pieces, one behind the other, in place of what was there, then makes room.
   @returns false where they cannot be kept; nothing unfinished stays behind. */
  [[nodiscard]] bool Store(const std::string& key,
                           std::initializer_list<std::span<const std::byte>> pieces) const;

  /** Says that the key's file was used just now. */
  void Touch(const std::string& key) const;

 private:
  void Trim(const std::filesystem::path& newest) const;

  std::filesystem::path directory_;
  std::string extension_;
  std::uintmax_t capacity_;
};

}  // namespace hvas
