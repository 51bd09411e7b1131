#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

/** Values to little-endian bytes, and back from any bytes at all. */
namespace hvas {

static_assert(std::endian::native == std::endian::little, "values are written as they lie there");

class ByteWriter {
 public:
  static constexpr bool kIsReader = false;

  /** @pre T has no padding, whose bytes nobody sets. */
  template <typename T>
  void Plain(const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > 0) {
      const std::size_t end = bytes_.size();
      bytes_.resize(end + count * sizeof(T));
      std::memcpy(bytes_.data() + end, values, count * sizeof(T));
    }
  }

  void Size(std::size_t size) {
    const auto value = static_cast<std::uint64_t>(size);
    Plain(&value, 1);
  }

  void Text(const std::string& text) {
    Size(text.size());
    Plain(text.data(), text.size());
  }

  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/** Reads what a ByteWriter wrote. Once something does not fit it has failed and stays so; what is
 read from then on keeps the value that it had. */
class ByteReader {
 public:
  static constexpr bool kIsReader = true;

  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <typename T>
  void Plain(T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (has_failed_ || rest_.size() / sizeof(T) < count) {
      Fail();
      return;
    }
    if (count > 0) {
      std::memcpy(values, rest_.data(), count * sizeof(T));
      rest_ = rest_.subspan(count * sizeof(T));
    }
  }

  /** A number of elements, each of which takes at least that many bytes: more than the rest can
   hold is a failure, so that no bytes ask for more memory than they are worth. 0 after a failure.
   @pre element_size > 0. */
  [[nodiscard]] std::size_t Size(std::size_t element_size) {
    std::uint64_t size = 0;
    Plain(&size, 1);
    if (size > rest_.size() / element_size) {
      Fail();
    }
    return has_failed_ ? 0 : static_cast<std::size_t>(size);
  }

  void Text(std::string* text) {
    text->resize(Size(1));
    Plain(text->data(), text->size());
  }

  /** The next bytes, where they lie; empty after a failure. */
  [[nodiscard]] std::span<const std::byte> Block(std::size_t size) {
    if (has_failed_ || size > rest_.size()) {
      Fail();
      return {};
    }
    const auto block = rest_.first(size);
    rest_ = rest_.subspan(size);
    return block;
  }

  /** Marks values that fit the bytes but not their meaning as a failure. */
  void Fail() { has_failed_ = true; }

  [[nodiscard]] bool has_failed() const { return has_failed_; }

  [[nodiscard]] bool is_finished() const { return !has_failed_ && rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
  bool has_failed_{false};
};

}  // namespace hvas
