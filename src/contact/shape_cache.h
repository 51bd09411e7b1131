#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "base/file_cache.h"
#include "contact/shape.h"

namespace hvas::contact {

/** Shapes on disk, by the content that they were built from, so that a part is prepared once.

 What cannot be read (damaged, cut short, of another version) is built again and replaced; a
 directory that cannot be written to costs time and nothing else. Several threads and several
 programs may use one directory at once. */
class ShapeCache {
 public:
  /** @param directory  Made when the first shape is written.
   @param capacity  Of the directory [bytes]: beyond it, the shapes not used for longest go. */
  explicit ShapeCache(std::filesystem::path directory,
                      std::uintmax_t capacity = FileCache::kDefaultCapacity);

  /** The shape from the disk, else built and written there: the same shape to the last bit.
   Errors: those of Shape::Build. */
  Result<std::shared_ptr<const Shape>> LoadOrBuild(const ShapeSource& source,
                                                   const ShapeOptions& options);

  /** The file that holds, or would hold, the shape. */
  [[nodiscard]] std::filesystem::path PathOf(const ShapeSource& source,
                                             const ShapeOptions& options) const;

  [[nodiscard]] std::uint32_t loaded_count() const noexcept { return loaded_; }

  [[nodiscard]] std::uint32_t built_count() const noexcept { return built_; }

  /** Why shapes could not be written, the first time that it happened; empty afterwards. */
  [[nodiscard]] std::optional<Error> TakeProblem();

 private:
  [[nodiscard]] std::shared_ptr<const Shape> Load(const std::string& key) const;
  void Store(const std::string& key, const Shape& shape);

  FileCache files_;
  std::atomic<std::uint32_t> loaded_{0};
  std::atomic<std::uint32_t> built_{0};
  std::mutex mutex_;  // Of what follows, and of writing.
  std::optional<Error> problem_;
  bool is_problem_known_{false};
};

}  // namespace hvas::contact
