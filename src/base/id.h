#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <limits>

namespace hvas {

/** An index that cannot be mistaken for another kind of index. Default: invalid. */
template <typename Tag>
class Id {
 public:
  constexpr Id() = default;

  constexpr explicit Id(std::size_t index) : value_(static_cast<std::uint32_t>(index)) {}

  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }

  [[nodiscard]] constexpr std::size_t index() const { return value_; }

  [[nodiscard]] constexpr bool is_valid() const { return value_ != kInvalid; }

  constexpr auto operator<=>(const Id&) const = default;  // NOLINT(modernize-use-nullptr): clang 14

 private:
  static constexpr std::uint32_t kInvalid = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value_{kInvalid};
};

}  // namespace hvas

template <typename Tag>
struct std::hash<hvas::Id<Tag>> {
  std::size_t operator()(hvas::Id<Tag> id) const noexcept { return id.value(); }
};
