#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace hvas {

/** What kind of thing went wrong; the command line turns it into an exit status. */
enum class ErrorCode {
  kNotFound,       ///< A file or a named entity does not exist.
  kUnreadable,     ///< The bytes are not what they claim to be.
  kUnsupported,    ///< Understood, but outside what HVAS can do.
  kInvalid,        ///< A value is out of its documented range.
  kOutOfResource,  ///< Disk, memory or time ran out.
  kCancelled,      ///< Somebody stopped it.
  kInternal,       ///< A bug in HVAS.
};

/** An error that a person can act on: what happened, where, and what to do about it. */
struct Error {
  ErrorCode code{ErrorCode::kInternal};
  std::string message;  ///< One sentence that names the entity.
  std::string where;    ///< File, line or entity; may be empty.
  std::string remedy;   ///< What the reader can do; may be empty.

  /** "where: message (remedy)" in one line. */
  [[nodiscard]] std::string ToString() const;
};

template <typename T>
using Result = tl::expected<T, Error>;

using Unexpected = tl::unexpected<Error>;

/** Shorthand for a failed Result. */
[[nodiscard]] inline Unexpected Fail(ErrorCode code, std::string message, std::string where = {},
                                     std::string remedy = {}) {
  return Unexpected(Error{code, std::move(message), std::move(where), std::move(remedy)});
}

}  // namespace hvas
