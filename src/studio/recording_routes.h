#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "studio/recording_shelf.h"

namespace hvas::studio {

/** What a GET under /api/recording is answered with. */
struct RecordingAnswer {
  std::string type;  ///< Media type.
  std::string bytes;
  std::optional<std::filesystem::path> file;  ///< In place of the bytes, for saving.
};

/** Errors: kNotFound for what is not there; those of the record. */
[[nodiscard]] Result<RecordingAnswer> AnswerRecording(RecordingShelf* shelf, std::string_view path);

}  // namespace hvas::studio
