#include "cad/input_file.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>
#include <utility>
#include <vector>

#include "base/digest.h"
#include "base/regular_file.h"
#include "cad/mesh_folder.h"

namespace hvas::cad {

namespace fs = std::filesystem;

Result<MappedFile> MappedFile::Open(int descriptor) {
  struct stat status {};

  if (::fstat(descriptor, &status) != 0) {
    return Fail(ErrorCode::kUnreadable, "the file cannot be read");
  }
  MappedFile file;
  if (status.st_size > 0) {
    const auto size = static_cast<std::size_t>(status.st_size);
    void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (data == MAP_FAILED) {  // NOLINT(performance-no-int-to-ptr)
      return Fail(ErrorCode::kUnreadable, "the file cannot be read");
    }
    file.bytes_ = {static_cast<const std::byte*>(data), size};
  }
  return file;
}

Result<MappedFile> MappedFile::Open(const fs::path& path) {
  const auto file = RegularFile::Open(path);
  return file ? Open(file->descriptor()) : Unexpected(file.error());
}

MappedFile::MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) {
    ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  }
}

Result<fs::path> CheckInputFile(const fs::path& file) {
  const auto opened = RegularFile::Open(file);
  std::error_code error;
  if (!opened) {
    Error refused = opened.error();
    if (refused.code != ErrorCode::kNotFound && !fs::is_regular_file(file, error)) {
      refused.remedy = kFormats;
    }
    return Unexpected(std::move(refused));
  }
  if (opened->size() == 0) {
    return Fail(ErrorCode::kUnreadable, "the file is empty", file.string(), kFormats);
  }
  fs::path path = fs::canonical(file, error);
  if (error) {
    return Fail(ErrorCode::kNotFound, "there is no such file", file.string(), "check the path");
  }
  return path;
}

Result<fs::path> CheckInput(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? FindMeshFolder(path) : CheckInputFile(path);
}

std::string DigestOf(const fs::path& path) {
  // Not mapped: somebody may be writing a new export over it.
  const auto file = RegularFile::Open(path);
  if (!file) {
    return {};
  }
  Digest digest;
  std::vector<std::byte> block(1 << 18);
  ssize_t size = 0;
  while ((size = ::read(file->descriptor(), block.data(), block.size())) > 0) {
    digest.AddBytes(std::span(block).first(static_cast<std::size_t>(size)));
  }
  return size == 0 ? digest.Hex() : std::string();
}

}  // namespace hvas::cad
