#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "base/descriptor.h"
#include "base/result.h"

namespace hvas::device {

/** Connects to the UNIX socket of a service, for calls that do not wait. RT-safe.
 @param type  SOCK_STREAM or SOCK_SEQPACKET.
 @returns a closed one when that fails, with errno. */
[[nodiscard]] Descriptor TryConnect(const char* path, int type) noexcept;

/** Listens at a path, whose folders are made; for calls that do not wait. Error: kOutOfResource. */
[[nodiscard]] Result<Descriptor> ListenAt(const std::filesystem::path& path, int type);

/** The next one who connected; a closed one when nobody did. */
[[nodiscard]] Descriptor TryAccept(const Descriptor& listener) noexcept;

/** What came of a call that does not wait. */
enum class Transfer : std::uint8_t { kDone, kNothing, kClosed };

/** Reads what is there, at most the buffer; its size to `count`. RT-safe. */
[[nodiscard]] Transfer TryReceive(const Descriptor& from, std::span<std::byte> buffer,
                                  std::size_t* count) noexcept;

}  // namespace hvas::device
