#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/result.h"

/** The lines of an IGES file (IGES 5.3, section 2.2): 80 columns, a letter of the section in column
 73, and the number of the line in its section behind it. No entities, no geometry. */
namespace hvas::cad {

/** Whether a file is an IGES file: its first line belongs to the start section, or is the flag of
 the compressed or the binary form; or it is called .igs or .iges, so that its reader says what is
 wrong with it. */
[[nodiscard]] bool IsIgesFile(const std::filesystem::path& file, std::string_view head);

/** Checks what the sections of an IGES text say about each other: their order, the numbers of the
 lines that are referred to (sections D and P), and the counts in the terminate section. Takes any
 bytes. Errors: kUnsupported (compressed or binary form), kUnreadable with the line. @param name The
 file. */
[[nodiscard]] Result<void> CheckIgesText(std::string_view text, const std::string& name);

}  // namespace hvas::cad
