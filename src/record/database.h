#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/scratch_folder.h"

struct sqlite3;
struct sqlite3_stmt;

namespace hvas::record {

struct ReadGuard;

/** A prepared statement: bind from 1, read columns from 0, as SQLite counts. */
class Statement {
 public:
  Statement& Bind(int index, std::int64_t value);
  Statement& Bind(int index, std::string_view text);
  Statement& Bind(int index, std::span<const std::byte> blob);
  Statement& BindReal(int index, double value);
  Statement& BindNull(int index);

  /** True when there is a row to read, false at the end. Errors, of a file that is read:
   kUnreadable where the row has a value of another type than its column declares, or where finding
   it takes more steps than a file of this size has work for. */
  Result<bool> Step();
  /** Runs a statement that gives no rows, and makes it ready for the next bindings. */
  Result<void> Run();

  [[nodiscard]] std::int64_t ReadInt(int column) const;
  [[nodiscard]] double ReadReal(int column) const;
  [[nodiscard]] std::string ReadText(int column) const;
  /** Valid until the next Step(). */
  [[nodiscard]] std::span<const std::byte> ReadBlob(int column) const;

  /** Bytes of the row's texts and blobs. */
  [[nodiscard]] std::uint64_t CountBytes() const;

 private:
  friend class Database;

  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };

  Statement(sqlite3* database, sqlite3_stmt* statement, std::string path, ReadGuard* guard);

  [[nodiscard]] Result<void> CheckTypes() const;

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
  std::string path_;
  ReadGuard* guard_;        ///< Null for a file that this program writes.
  std::vector<int> types_;  ///< SQLite's type of each column; 0: any. Empty without a guard.
};

/** A connection to an SQLite file; one thread at a time. */
class Database {
 public:
  enum class Mode { kReadOnly, kCreate };

  /** Opens a file of one's own to write it, or any file to read it. Who made a file that is read is
   not known: it has to be a regular file of at most kMostFileBytes; views, triggers, extensions and
   functions that its schema names do not run; each statement may take as many steps as reading
   every row of a file of this size; and a value has the type that its column declares. What tables
   it has is checked by CheckTables(). Read-only also where the folder may not be written, in which
   a killed writer can have left a journal: a journal is then read from a copy in a temporary
   folder. */
  static Result<Database> Open(const std::filesystem::path& path, Mode mode);

  /** Largest file that is read [bytes]: two hands at 1 kHz for three days. A choice. */
  static constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{64} << 30;

  /** Makes an empty database in memory, whose bytes are those of a file (Serialize). */
  static Result<Database> OpenInMemory();

  /** Returns the whole database as the bytes of a file; equal statements give equal bytes. Errors:
   kOutOfResource where there is no memory for a copy. */
  [[nodiscard]] Result<std::string> Serialize() const;

  Result<void> Execute(const std::string& sql);
  Result<Statement> Prepare(std::string_view sql);
  /** The first column of the first row. */
  Result<std::int64_t> QueryInt(std::string_view sql);

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };

  struct GuardEnd {
    void operator()(ReadGuard* guard) const;
  };

  Database(sqlite3* database, std::string path) : database_(database), path_(std::move(path)) {}

  static Result<Database> OpenName(const std::string& name, int flags, std::string path);
  static Result<Database> OpenToRead(const std::filesystem::path& path);
  static Result<Database> OpenGuarded(const std::string& name, int flags,
                                      const std::filesystem::path& path);
  static Result<Database> OpenUnwritable(const std::filesystem::path& path);
  Result<void> Guard();

  std::optional<ScratchFolder> copy_;           // Outlives the connection.
  std::unique_ptr<ReadGuard, GuardEnd> guard_;  // Outlives it, too; null for one that is written.
  std::unique_ptr<sqlite3, Closer> database_;
  std::string path_;
};

}  // namespace hvas::record
