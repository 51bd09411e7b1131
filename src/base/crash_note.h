#pragma once

#include <string>
#include <string_view>

/** What the program was doing, for the message that it writes when it crashes. Each setter keeps
 the first 511 bytes of a text and allocates nothing. Any thread may call them; a crash meanwhile
 may show a mixture of two texts. */
namespace hvas {

/** The command with its arguments, or the request that is being served: "assemble bushing.step". */
void NoteWork(std::string_view work) noexcept;

/** The part of the work that has begun: "contact shapes". Empty: none. */
void NoteStage(std::string_view stage) noexcept;

/** The part of the work that was noted last; empty: none. */
[[nodiscard]] std::string NotedStage();

/** The file into which the session is being recorded. Empty: none. */
void NoteRecord(std::string_view path) noexcept;

/** Writes to standard error that the program has crashed by this signal, what it was doing, and
 where the record lies. Async-signal-safe. */
void WriteCrashNote(int signal) noexcept;

}  // namespace hvas
