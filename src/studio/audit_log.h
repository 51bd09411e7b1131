#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "base/job_thread.h"
#include "studio/access.h"
#include "studio/json.h"

namespace hvas::studio {

/** Who did what in the studio: a file with one JSON object in each line (docs/access.md). What is
 refused is noted once a minute for each visitor's link, and of what is done a number of lines a
 minute, with the number of those left out, so that nobody fills the disk, or drives out what others
 have done. Any thread may call it; the file is written on a thread of its own. */
class AuditLog {
 public:
  /** Beyond this size a file is renamed to NAME.1, and a new one is begun [bytes]: some 50,000
   lines. A choice. */
  static constexpr std::uintmax_t kMaxBytes = 10 << 20;
  /** Lines that wait for a slow disk; further ones are counted and not kept. A choice. */
  static constexpr std::size_t kMostWaiting = 1000;
  static constexpr std::int64_t kRefusalPauseNs = 60'000'000'000;  ///< A minute: a choice.

  /** @param file  Empty: nothing is written. */
  explicit AuditLog(std::filesystem::path file) : file_(std::move(file)) {}

  struct Entry {
    std::string who;      ///< ToString(Visitor), or "stranger".
    std::string address;  ///< IP address.
    std::string client;   ///< Id of the client; empty: none.
    Json did;             ///< Object: command or request, and its fields of interest.
  };

  /** Lines of a link in a minute: more than a person does. A choice. */
  static constexpr std::uint64_t kMostInMinute = 120;

  /** @param link  Visitor::link(), or kStranger. @param now_ns  MonotonicNs(). */
  void Note(std::uint32_t link, const Entry& entry, std::int64_t now_ns);

  /** @param why  Code of the error. */
  void NoteRefusal(std::uint32_t link, const Entry& entry, const std::string& why,
                   std::int64_t now_ns);

  /** Stands for the link of nobody: browsers are counted from 1. */
  static constexpr std::uint32_t kStranger = 0xFFFFFFFF;

  /** Waits until all is written; nothing is written after it. */
  void Stop();

 private:
  struct Refusals {
    std::int64_t noted_ns{0};
    std::uint64_t unnoted{0};  ///< Since the last line.
  };

  struct Deeds {
    std::int64_t minute{0};
    std::uint64_t noted{0};    ///< Lines in this minute.
    std::uint64_t unnoted{0};  ///< Since the last line.
  };

  void Print(const Entry& entry);
  void Write(const Json& line);

  const std::filesystem::path file_;
  std::mutex mutex_;  ///< Protects what follows.
  std::map<std::uint32_t, Refusals> refusals_;
  std::map<std::uint32_t, Deeds> deeds_;
  std::uint64_t lost_{0};  ///< Lines for which there was no room.
  bool can_write_{true};   ///< Used by the writer alone.
  JobThread writer_;       ///< The last member: it ends first.
};

/** What the audit log keeps of a command: its name and the fields that tell what it is about, and
 nothing that a user has written. */
[[nodiscard]] Json DescribeForAudit(const Json& command);

}  // namespace hvas::studio
