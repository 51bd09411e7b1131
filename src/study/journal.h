#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/descriptor.h"
#include "base/result.h"
#include "study/study_session.h"

namespace hvas::study {

/** Header of a journal. */
struct JournalHead {
  std::string participant;  ///< "P03"
  std::string protocol;     ///< Digest of the protocol.
  std::uint64_t seed{0};    ///< Seed of the study.
  bool is_simulated{false};
};

/** Journal of one participant: an append-only file with one line for each event. Each line has a
 checksum and is on the disk before Append() returns. However the program ends, at most the line
 that was being written is lost; reading drops it.

 A line is a JSON object and, after a tab, the 64-bit XXH3 of the object's bytes in hexadecimal. */
class Journal {
 public:
  /** Opens a journal to append to it, or begins it.
   @param is_synced  Whether each line is forced to the disk; false for journals that can be made
   again, those of simulated participants.
   Errors: kUnreadable for a damaged line before the last, with FILE:LINE; kInvalid for a journal of
   another participant, study or seed; kOutOfResource. */
  [[nodiscard]] static Result<Journal> Open(const std::filesystem::path& file,
                                            const JournalHead& head, bool is_synced = true);

  /** All events so far, in order. */
  [[nodiscard]] const std::vector<StudyEvent>& events() const { return events_; }

  /** Appends an event. Errors: kOutOfResource when it cannot be written; it then counts as
   not added. */
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

/** Content of a journal. */
struct ReadOnlyJournal {
  JournalHead head;
  std::vector<StudyEvent> events;
  std::int64_t good_bytes{0};  ///< Size without an incomplete last line.
};

/** Locks a journal against a session, until the descriptor is closed. Errors: kInvalid where the
 session of its participant is running; those of RegularFile::Open. */
[[nodiscard]] Result<Descriptor> LockJournal(const std::filesystem::path& file);

/** Reads a journal without changing the file. Errors: those of Journal::Open; kNotFound. */
[[nodiscard]] Result<ReadOnlyJournal> ReadJournal(const std::filesystem::path& file);

}  // namespace hvas::study
