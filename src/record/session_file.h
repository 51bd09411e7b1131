#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "record/database.h"
#include "record/ledger.h"
#include "record/packing.h"
#include "record/tick_record.h"
#include "record/write_claim.h"

/** The layout of a record, shared by the one who writes it and the one who reads it. */
namespace hvas::record {

/** What a session was, as text under keys with units: product name, source, model, seed,
 options. */
using Meta = std::map<std::string, std::string>;

inline constexpr std::int64_t kApplicationId = 0x48564153;  // "HVAS", in the file's header.
// As many ticks are compressed together at most: those of two hands between two transactions.
inline constexpr std::int64_t kChunkTicks = 1000;

/** The statements that make the tables of a record of a schema, from 1 to kSchemaVersion. */
[[nodiscard]] std::string ListTables(std::int64_t schema);

/** Keys that the recorder adds when it ends; a record without them was cut short. */
inline constexpr const char* kMetaDigest = "digest";
inline constexpr const char* kMetaDropped = "dropped_ticks";
inline constexpr const char* kMetaDroppedFrames = "dropped_frames";
inline constexpr const char* kMetaStarted = "started_unix_ns";

struct SessionFileOptions {
  std::filesystem::path path;
  std::int64_t max_bytes{0};  ///< The file may not grow beyond this; 0 for no limit.
  /** What was committed survives a power cut, too, and not only the end of the process. */
  bool outlives_power{false};
  bool replaces{false};  ///< A finished record that is there.
};

/** The file under a running recorder: ticks gathered into chunks, chunks and all else into
 transactions of at most half a second of session time. */
class SessionFile {
 public:
  /** Creates the file, which only its owner can read. Errors: those of WriteClaim::Make(). */
  static Result<SessionFile> Create(const SessionFileOptions& options, const Meta& meta);

  Result<void> Add(std::int64_t t_ns, std::span<const std::byte> packed_tick);
  Result<void> Add(const Event& event);
  Result<void> Add(const Command& command);
  Result<void> Add(const Frame& frame);
  /** Replaces one of the same name. */
  Result<void> Add(const Attachment& attachment);

  /** Makes all that was added survive the end of the process.
   Errors: those of the disk; kNotFound when the file is no longer there. */
  Result<void> Commit() { return Commit(false); }

  /** Commits, adds the last meta entries and, unless somebody reads it, leaves one file without
   side files. */
  Result<void> Close(const Meta& meta);

 private:
  struct Statements {
    Statement meta;
    Statement chunk;
    Statement event;
    Statement command;
    Statement frame;
    Statement attachment;
    Statement seal;
  };

  SessionFile(WriteClaim claim, Database database, Statements statements)
      : claim_(std::move(claim)),
        database_(std::move(database)),
        statements_(std::move(statements)) {}

  static Result<Statements> Prepare(Database* database);
  Result<void> AddMeta(const Meta& meta);
  Result<void> Insert(std::int64_t t_ns, Statement* statement);
  Result<void> WriteChunk();
  Result<void> WriteSeal(bool is_last);
  Result<void> Commit(bool is_last);
  Result<void> MoveIntoFile();
  Result<void> BeginIfNeeded(std::int64_t t_ns);
  Result<void> CommitIfDue(std::int64_t t_ns);

  WriteClaim claim_;  // Outlives the database, whose locks would go with it.
  Database database_;
  Statements statements_;
  Ledger ledger_;
  std::string sealed_entries_;  // Those of the last seal that has them.
  std::int64_t last_seal_{0};
  std::int64_t moved_ns_{0};  // Time of the machine's clock.
  std::vector<std::byte> chunk_;
  std::int64_t chunk_ticks_{0};
  std::int64_t chunk_first_ns_{0};
  std::int64_t chunk_last_ns_{0};
  std::optional<std::int64_t> transaction_start_ns_;
};

}  // namespace hvas::record
