// A record: all that replay, report, export and the studio's shelf take out of it. Besides the
// damaged bytes, a sound copy with one value of another kind, or with rows gone.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <sqlite3.h>
#include <stdlib.h>

#include "base/digest.h"
#include "base/random.h"
#include "base/scratch_folder.h"
#include "evidence/summary.h"
#include "evidence/tables.h"
#include "fuzz/target.h"
#include "record/reader.h"
#include "session/recorded_model.h"
#include "studio/record_parts.h"

namespace hvas::fuzz {
namespace {

constexpr std::array kColumns{"chunk.id",
                              "chunk.first_t_ns",
                              "chunk.last_t_ns",
                              "chunk.count",
                              "chunk.checksum",
                              "chunk.ticks",
                              "event.id",
                              "event.t_ns",
                              "event.kind",
                              "event.occurrence",
                              "event.json",
                              "event.checksum",
                              "command.t_ns",
                              "command.number",
                              "command.kind",
                              "command.json",
                              "frame.t_ns",
                              "frame.bytes",
                              "meta.key",
                              "meta.value",
                              "attachment.name",
                              "attachment.bytes",
                              "seal.id",
                              "seal.t_ns",
                              "seal.chunks",
                              "seal.entries",
                              "seal.hash",
                              "seal.is_last",
                              "schema_version.version"};
constexpr std::array kValues{"'x'",
                             "''",
                             "-1",
                             "0",
                             "9223372036854775807",
                             "1e999",
                             "zeroblob(9)",
                             "zeroblob(100000)",
                             "'{\"hand\": \"x\", \"force\": [], \"state\": 1e999}'",
                             "'[1, {\"path\": 3}, null]'",
                             "'{\"metrics\": {\"path_m\": \"x\"}, \"event\": 7}'"};

/** In memory where that can be: a disk takes longer than all else. */
ScratchFolder MakeFolder() {
  if (std::filesystem::is_directory("/dev/shm")) {
    ::setenv("TMPDIR", "/dev/shm", 1);
  }
  return ScratchFolder::Make().value();
}

void CheckError(const Error& error) {
  Check(!error.message.empty());
}

template <typename T>
void CheckOutcome(const Result<T>& result) {
  if (!result) {
    CheckError(result.error());
  }
}

void ReadAll(const std::filesystem::path& folder, const std::filesystem::path& file) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    CheckError(reader.error());
  } else {
    CheckOutcome(reader->Verify());
    CheckOutcome(reader->ReadTicks({}));
    CheckOutcome(reader->ReadEvents());
    CheckOutcome(reader->ReadCommands());
    CheckOutcome(reader->ForEachFrame({}, [](const record::Frame&) { return true; }));
    CheckOutcome(session::LoadProduct(&*reader));
    CheckOutcome(evidence::Summarise(&*reader));
    CheckOutcome(evidence::WriteJson(&*reader, {}, folder / "x.json"));
    CheckOutcome(evidence::WritePathGlb(&*reader, {}, folder / "x.glb"));
  }
  for (std::size_t part = 0; part < studio::kRecordParts.size(); ++part) {
    CheckOutcome(studio::ReadRecordPart(file, static_cast<studio::RecordPart>(part)));
  }
}

void Write(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void Tamper(const std::filesystem::path& file, Random* random) {
  const auto pick = [random](const auto& list) {
    return std::string(list[random->NextBits() % list.size()]);
  };
  const std::string column = pick(kColumns);
  const std::string table = column.substr(0, column.find('.'));
  const std::string rows = random->NextBits() % 2 == 0
                               ? ""
                               : " WHERE rowid % 3 = " + std::to_string(random->NextBits() % 3);
  const bool removes = random->NextBits() % 4 == 0;
  const std::string sql = removes ? "DELETE FROM " + table + rows
                                  : "UPDATE " + table + " SET " + column.substr(table.size() + 1) +
                                        " = " + pick(kValues) + rows;
  sqlite3* database = nullptr;
  if (sqlite3_open(file.c_str(), &database) == SQLITE_OK) {
    sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr);
  }
  sqlite3_close(database);
}

}  // namespace

void TestOne(std::string_view bytes) {
  static const ScratchFolder folder = MakeFolder();
  static const std::string sound(bytes);  // The first seed.
  const std::filesystem::path file = folder.path() / "record.hvasrec";
  Write(file, bytes);
  ReadAll(folder.path(), file);
  Random random(Checksum64(std::as_bytes(std::span(bytes))));
  Write(file, sound);
  Tamper(file, &random);
  ReadAll(folder.path(), file);
}

}  // namespace hvas::fuzz
