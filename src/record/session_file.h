#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "record/database.h"
#include "record/tick_record.h"

/** The layout of a record, shared by the one who writes it and the one who reads it. */
namespace hvas::record {

/** What a session was, as text under keys with units: product name, source, model, seed,
 options. */
using Meta = std::map<std::string, std::string>;

inline constexpr std::int64_t kApplicationId = 0x48564153;  // "HVAS", in the file's header.
/** 1: ticks of one hand. 2: ticks of both, with all that the device told. */
inline constexpr std::int64_t kSchemaVersion = 2;
inline constexpr std::int64_t kChunkTicks = 250;

/** Keys that the recorder adds when it ends; a record without them was cut short. */
inline constexpr const char* kMetaDigest = "digest";
inline constexpr const char* kMetaDropped = "dropped_ticks";
inline constexpr const char* kMetaStarted = "started_unix_ns";

/** The file under a running recorder: ticks gathered into chunks, chunks and events into
 transactions of at most half a second of session time. */
class SessionFile {
 public:
  /** Creates the file, replacing an older record there but nothing else.
   @param max_bytes The file may not grow beyond this; 0 for no limit. */
  static Result<SessionFile> Create(const std::filesystem::path& path, const Meta& meta,
                                    std::int64_t max_bytes);

  Result<void> AddTick(std::int64_t t_ns, std::span<const std::byte> packed_tick);
  Result<void> AddEvent(const Event& event);
  /** Makes all that was added survive the end of the process. */
  Result<void> Commit();
  /** Commits, adds the last meta entries and leaves one file without side files. */
  Result<void> Close(const Meta& meta);

 private:
  struct Statements {
    Statement meta;
    Statement chunk;
    Statement event;
  };

  SessionFile(Database database, Statements statements)
      : database_(std::move(database)), statements_(std::move(statements)) {}

  Result<void> AddMeta(const Meta& meta);
  Result<void> WriteChunk();
  Result<void> BeginIfNeeded(std::int64_t t_ns);
  Result<void> CommitIfDue(std::int64_t t_ns);

  Database database_;
  Statements statements_;
  std::vector<std::byte> chunk_;
  std::int64_t chunk_ticks_{0};
  std::int64_t chunk_first_ns_{0};
  std::int64_t chunk_last_ns_{0};
  std::optional<std::int64_t> transaction_start_ns_;
};

}  // namespace hvas::record
