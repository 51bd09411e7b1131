#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "product/ids.h"
#include "session/json_values.h"
#include "studio/measure.h"
#include "study/study_session.h"

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

/** Longest text of a command whose schema gives no length [characters]: a choice. */
inline constexpr std::size_t kLongestText = 1000;

/** Required fields of a command. Errors: kInvalid, with the field's name and the expected type. */
[[nodiscard]] Result<std::string> TextAt(const Json& object, const char* name,
                                         std::size_t longest = kLongestText);
[[nodiscard]] Result<bool> FlagAt(const Json& object, const char* name);
[[nodiscard]] Result<std::uint32_t> IndexAt(const Json& object, const char* name);
/** A list of at most 65,536 occurrences, which need not exist. */
[[nodiscard]] Result<std::vector<product::OccurrenceId>> OccurrencesAt(const Json& object,
                                                                       const char* name);
[[nodiscard]] Result<std::size_t> HandAt(const Json& object, const char* name);

/** Closed interval of the values that a field may have. */
struct Limits {
  double low, high;
};

/** Reads a number within limits. */
[[nodiscard]] Result<double> NumberAt(const Json& object, const char* name, const Limits& limits);
/** A point or a direction: three numbers of at most 1e6 by size. */
[[nodiscard]] Result<Vec3> Vec3At(const Json& object, const char* name);
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

  /** `fields`, which are moved from, or the first error. */
  template <typename Fields>
  [[nodiscard]] Result<Fields> Or(Fields* fields) const {
    return error_ ? Result<Fields>(Unexpected(*error_)) : Result<Fields>(std::move(*fields));
  }

 private:
  std::optional<Error> error_;
};

using session::FlagOr;
using session::IndexOr;
using session::NumberOr;
using session::TextOr;

}  // namespace hvas::studio
