#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/** How hvas-cad talks to the program that started it; the other end is cad/worker.h. */
namespace hvas::cad {

/** Tells how far a stage is; seldom enough not to cost anything. */
void SendStage(std::string_view stage, double fraction);

/** Tells which part is worked at from now on. */
void SendPart(std::uint32_t number, std::string_view name);

/** Writes what was made. @returns the exit status. */
[[nodiscard]] int HandOver(std::span<const std::byte> output);

}  // namespace hvas::cad
