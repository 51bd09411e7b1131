#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hvas::cad {

/** The content of the first entry of a ZIP archive whose name pleases, stored or deflated. Takes
 any bytes. Empty where there is none, where it is damaged, or when it is larger than `limit`. */
[[nodiscard]] std::optional<std::string> ReadZipEntry(
    std::span<const std::byte> archive, const std::function<bool(std::string_view name)>& pleases,
    std::size_t limit);

/** What all entries of a ZIP archive take when they are unpacked, as its directory has it [bytes];
 libraries unpack no more of an entry than this says. Takes any bytes. */
[[nodiscard]] std::uint64_t SumUnpackedSizes(std::span<const std::byte> archive);

}  // namespace hvas::cad
