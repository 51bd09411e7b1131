#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"
#include "session/json_values.h"
#include "studio/measure.h"

namespace hvas::studio {

/** What a client sent as a command. Errors (kInvalid): it is no JSON object, or has more fields
 than any command: keeping them in order takes the square of their number. */
[[nodiscard]] Result<Json> ParseCommand(std::string_view text);

/** By which the reply is known: the command's "id", null where that is no whole number. */
[[nodiscard]] Json IdOf(const Json& command);

/** What a command is answered with. */
[[nodiscard]] Json MakeReply(const Json& id, const Result<Json>& result);

/** What the handler of a command returns that is answered later, by the event of MakeLateReply. */
[[nodiscard]] inline Json AnsweredLater() {
  return Json(Json::value_t::discarded);
}

/** For Hub::Broadcast. @param to  The client that waits for it. */
[[nodiscard]] Json MakeLateReply(const std::string& to, const Json& id, const Result<Json>& result);

/** Fields of a command. Errors (kInvalid) name the field and what it should be. */
[[nodiscard]] Result<std::string> TextAt(const Json& object, const char* name);
[[nodiscard]] Result<bool> FlagAt(const Json& object, const char* name);
[[nodiscard]] Result<std::uint32_t> IndexAt(const Json& object, const char* name);
/** "hand": 0 where there is none. */
[[nodiscard]] Result<std::size_t> HandAt(const Json& object);

/** A number within limits, ends included; `missing` where there is none. */
struct Limits {
  double low, high;
};

[[nodiscard]] Result<double> NumberAt(const Json& object, const char* name, const Limits& limits,
                                      double missing);
[[nodiscard]] Result<PickedFace> FaceAt(const Json& object, const char* name);

using session::FieldOf;
using session::FlagOr;
using session::IndexOr;
using session::NumberOr;
using session::TextOr;

}  // namespace hvas::studio
