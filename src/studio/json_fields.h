#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/result.h"
#include "session/json_values.h"
#include "studio/measure.h"
#include "study/study_session.h"

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

/** Longest text of a command whose own longest one is not told [bytes]. */
inline constexpr std::size_t kLongestText = 1000;

/** Fields of a command. Errors (kInvalid) name the field and what it should be. */
[[nodiscard]] Result<std::string> TextAt(const Json& object, const char* name,
                                         std::size_t longest = kLongestText);
[[nodiscard]] Result<bool> FlagAt(const Json& object, const char* name);
[[nodiscard]] Result<std::uint32_t> IndexAt(const Json& object, const char* name);
[[nodiscard]] Result<std::size_t> HandAt(const Json& object, const char* name);

/** A number within limits, ends included. */
struct Limits {
  double low, high;
};

[[nodiscard]] Result<double> NumberAt(const Json& object, const char* name, const Limits& limits);
[[nodiscard]] Result<PickedFace> FaceAt(const Json& object, const char* name);
/** A whole number, a text, or null for none. */
[[nodiscard]] Result<study::AnswerValue> AnswerAt(const Json& object, const char* name);
/** Which of these words it is. */
[[nodiscard]] Result<std::size_t> WordIndexAt(const Json& object, const char* name,
                                              std::span<const char* const> words);

/** Word is an enumeration in the order of the words. */
template <typename Word, std::size_t kCount>
[[nodiscard]] Result<Word> WordAt(const Json& object, const char* name,
                                  const std::array<const char*, kCount>& words) {
  const auto index = WordIndexAt(object, name, words);
  return index ? Result<Word>(static_cast<Word>(*index)) : Result<Word>(Unexpected(index.error()));
}

using session::FieldOf;

[[nodiscard]] inline bool HasField(const Json& object, const char* name) {
  return FieldOf(object, name) != nullptr;
}

/** False for null, too. */
[[nodiscard]] inline bool HasValue(const Json& object, const char* name) {
  const Json* field = FieldOf(object, name);
  return field != nullptr && !field->is_null();
}

/** What is read into a structure field by field: all of it, or the first error. */
class FirstError {
 public:
  template <typename Value, typename Target>
  void Keep(Result<Value> read, Target* target) {
    if (read) {
      *target = std::move(*read);
    } else if (!error_) {
      error_ = read.error();
    }
  }

  template <typename Fields>
  [[nodiscard]] Result<Fields> Or(Fields fields) const {
    return error_ ? Result<Fields>(Unexpected(*error_)) : Result<Fields>(std::move(fields));
  }

 private:
  std::optional<Error> error_;
};

using session::FlagOr;
using session::IndexOr;
using session::NumberOr;
using session::TextOr;

}  // namespace hvas::studio
