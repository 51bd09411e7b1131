#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "session/json_values.h"
#include "studio/measure.h"

namespace hvas::studio {

/** Parses a client's command. Errors: kInvalid for text that is no JSON object, or for more fields
 than any command has: an ordered object takes quadratic time in their number. */
[[nodiscard]] Result<Json> ParseCommand(std::string_view text);

/** The "id" of a command, which its reply repeats; null where it is no integer. */
[[nodiscard]] Json IdOf(const Json& command);

/** Makes the reply to a command. */
[[nodiscard]] Json MakeReply(const Json& id, const Result<Json>& result);

/** Result of a command's handler whose reply follows later, as the event of MakeDeferredReply. */
[[nodiscard]] inline Json MakeDeferredResult() {
  return Json(Json::value_t::discarded);
}

/** Makes a deferred reply for Hub::Broadcast. @param to  Id of the client that waits for it. */
[[nodiscard]] Json MakeDeferredReply(const std::string& to, const Json& id,
                                     const Result<Json>& result);

/** Required fields of a command. Errors: kInvalid, with the field's name and the expected type. */
[[nodiscard]] Result<std::string> TextAt(const Json& object, const char* name);
[[nodiscard]] Result<bool> FlagAt(const Json& object, const char* name);
[[nodiscard]] Result<std::uint32_t> IndexAt(const Json& object, const char* name);
/** Reads the field "hand"; 0 where it is missing. */
[[nodiscard]] Result<std::size_t> HandAt(const Json& object);

/** Closed interval of the values that a field may have. */
struct Limits {
  double low, high;
};

/** Reads a number within limits; `missing` where there is no such field. */
[[nodiscard]] Result<double> NumberAt(const Json& object, const char* name, const Limits& limits,
                                      double missing);
[[nodiscard]] Result<PickedFace> FaceAt(const Json& object, const char* name);

using session::FieldOf;
using session::FlagOr;
using session::IndexOr;
using session::NumberOr;
using session::TextOr;

}  // namespace hvas::studio
