#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/descriptor.h"
#include "base/result.h"
#include "study/study_session.h"

namespace hvas::study {

/** What a journal says before its first event. */
struct JournalHead {
  std::string participant;  ///< "P03"
  std::string protocol;     ///< Its digest.
  std::uint64_t seed{0};    ///< The study's.
  bool is_simulated{false};
};

/** What happened to one participant, a line an event, to a file that only grows. Each line has its
 checksum, and is on the disk before Append() returns: whatever ends the program, at most the line
 that was just being written is lost, and reading drops it.

 A line is a JSON object and, after a tab, the 64-bit XXH3 of the object's bytes in hexadecimal. */
class Journal {
 public:
  /** Opens one to go on with, or begins it.
   Errors: kUnreadable for a line that is damaged and is not the last, with FILE:LINE; kInvalid for
   another participant's, study's or seed's; kOutOfResource.
   @param is_synced  False for what can be made again: simulated participants. */
  [[nodiscard]] static Result<Journal> Open(const std::filesystem::path& file,
                                            const JournalHead& head, bool is_synced = true);

  /** All so far. */
  [[nodiscard]] const std::vector<StudyEvent>& events() const { return events_; }

  /** Errors: kOutOfResource when the disk did not take it: then it has not happened. */
  [[nodiscard]] Result<void> Append(const StudyEvent& event);

 private:
  Journal(std::filesystem::path path, Descriptor file, bool is_synced)
      : path_(std::move(path)), file_(std::move(file)), is_synced_(is_synced) {}

  [[nodiscard]] Result<void> Write(const std::string& line);

  std::filesystem::path path_;
  Descriptor file_;
  bool is_synced_;
  std::int64_t size_{0};
  std::vector<StudyEvent> events_;
};

/** A journal as it was read. */
struct ReadOnlyJournal {
  JournalHead head;
  std::vector<StudyEvent> events;
  std::int64_t good_bytes{0};  ///< What comes after it is a torn line.
};

/** Without changing the file. Errors: as Journal::Open; kNotFound. */
[[nodiscard]] Result<ReadOnlyJournal> ReadJournal(const std::filesystem::path& file);

}  // namespace hvas::study
