// Files that say they are records, and were made by somebody else: nothing in them works, takes
// memory or time beyond what a record of their size does.

#include <sys/stat.h>

#include <array>
#include <cstring>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <zstd.h>

#include "base/digest.h"
#include "record/compression.h"
#include "record/reader.h"
#include "record/recorder.h"
#include "record/session_digest.h"
#include "record/table_check.h"
#include "record/test/sample.h"

namespace hvas::record {
namespace {

/** Runs SQL on a file as its maker may. */
void Forge(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  // Nobody waits for the disk.
  const std::string quick = "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;" + sql;
  ASSERT_EQ(sqlite3_exec(database, quick.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database) << ": " << sql;
  sqlite3_close(database);
}

std::string ReadBytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class RecordOfAStranger : public ::testing::Test {
 protected:
  RecordOfAStranger() : file_("stranger.hvasrec") {
    WriteSampleRecord(file_.path(), {{"product", "x"}}, 600);
  }

  /** Reads all that can be read. @returns the first error. */
  std::optional<Error> ReadAll() const {
    auto reader = Reader::Open(file_.path());
    if (!reader) {
      return reader.error();
    }
    std::optional<Error> first;
    const auto note = [&first](const auto& result) {
      if (!result && !first) {
        first = result.error();
      }
    };
    note(reader->ReadLength());
    note(reader->ForEachTick({}, [](const TickRecord&) { return true; }));
    note(reader->ReadEvents());
    note(reader->ReadCommands());
    note(reader->ForEachFrame({}, [](const Frame&) { return true; }));
    const auto names = reader->ListAttachments();
    note(names);
    for (const std::string& name : names.value_or(std::vector<std::string>())) {
      note(reader->ReadAttachment(name));
    }
    note(reader->Verify());
    return first;
  }

  /** Expects that the file is refused before anything is read out of it. */
  void ExpectRefused(const std::string& named) const {
    const auto reader = Reader::Open(file_.path());
    ASSERT_FALSE(reader.has_value());
    EXPECT_EQ(reader.error().code, ErrorCode::kUnreadable) << reader.error().ToString();
    EXPECT_NE(reader.error().message.find(named), std::string::npos) << reader.error().message;
  }

  TemporaryFile file_;
};

TEST_F(RecordOfAStranger, WithAnEndlessViewInPlaceOfAnyTableIsRefused) {
  const std::string sound = ReadBytes(file_.path());
  for (const std::string table :
       {"schema_version", "meta", "chunk", "event", "command", "frame", "attachment", "seal"}) {
    SCOPED_TRACE(table);
    std::ofstream(file_.path(), std::ios::binary | std::ios::trunc) << sound;
    Forge(file_.path(), "DROP TABLE " + table + "; CREATE VIEW " + table +
                            "(id, t_ns, kind, occurrence, json, checksum) AS WITH RECURSIVE "
                            "n(i) AS (VALUES(1) UNION ALL SELECT i + 1 FROM n) "
                            "SELECT i, i, i, i, i, i FROM n");
    ExpectRefused("\"" + table + "\" is another");
  }
}

TEST_F(RecordOfAStranger, WithMoreThanItsTablesIsRefused) {
  const std::string sound = ReadBytes(file_.path());
  for (const auto& [sql, named] : {
           std::pair("CREATE TRIGGER t AFTER INSERT ON meta BEGIN DELETE FROM event; END", "\"t\""),
           std::pair("CREATE VIEW more AS SELECT * FROM meta", "\"more\""),
           std::pair("CREATE INDEX i ON event (kind)", "\"i\""),
           std::pair("CREATE VIRTUAL TABLE v USING fts4(x)", "_v_segdir"),
           std::pair("CREATE TABLE other (x)", "\"other\""),
           std::pair("ALTER TABLE event ADD COLUMN y AS (hex(kind))", "\"event\""),
           std::pair("DROP TABLE seal; CREATE TABLE seal (id)", "\"seal\""),
           std::pair("DROP TABLE frame", "\"frame\" is missing"),
           std::pair("ANALYZE", "sqlite_stat"),
       }) {
    SCOPED_TRACE(sql);
    std::ofstream(file_.path(), std::ios::binary | std::ios::trunc) << sound;
    Forge(file_.path(), sql);
    ExpectRefused(named);
  }
}

TEST_F(RecordOfAStranger, WithAThousandTablesIsRefused) {
  std::string sql = "BEGIN;";
  for (int i = 0; i < 1000; ++i) {
    sql += "CREATE TABLE t" + std::to_string(i) + " (x);";
  }
  Forge(file_.path(), sql + "COMMIT");
  ExpectRefused("");
}

TEST_F(RecordOfAStranger, WithSchemaOfAnOlderVersionThanItSaysIsRefused) {
  Forge(file_.path(), "UPDATE schema_version SET version = 2");
  ExpectRefused("does not belong into it");
}

TEST_F(RecordOfAStranger, WithValuesOfOtherTypesIsNamedDamaged) {
  const std::string sound = ReadBytes(file_.path());
  constexpr std::array kColumns{
      "chunk.first_t_ns", "chunk.last_t_ns",  "chunk.count",        "chunk.checksum",
      "chunk.ticks",      "event.t_ns",       "event.kind",         "event.json",
      "event.checksum",   "event.occurrence", "command.t_ns",       "command.number",
      "command.kind",     "command.json",     "command.checksum",   "frame.t_ns",
      "frame.checksum",   "frame.bytes",      "meta.value",         "attachment.bytes",
      "seal.t_ns",        "seal.chunks",      "seal.entries",       "seal.hash",
      "seal.is_last",     "attachment.name",  "attachment.checksum"};
  constexpr std::array kValues{"'x'",
                               "x'00ff'",
                               "-1",
                               "9223372036854775807",
                               "1e999",
                               "-0.5",
                               "zeroblob(1000000)",
                               "hex(zeroblob(500000))"};
  for (const std::string column : kColumns) {
    for (const std::string value : kValues) {
      SCOPED_TRACE(column + " = " + value);
      std::ofstream(file_.path(), std::ios::binary | std::ios::trunc) << sound;
      const std::string table = column.substr(0, column.find('.'));
      Forge(file_.path(), "UPDATE OR IGNORE " + table + " SET " + column.substr(table.size() + 1) +
                              " = " + value);
      const auto error = ReadAll();
      ASSERT_TRUE(error.has_value());
      EXPECT_EQ(error->code, ErrorCode::kUnreadable) << error->ToString();
      EXPECT_FALSE(error->remedy.empty());
    }
  }
}

TEST_F(RecordOfAStranger, WithMoreEventsThanAreReadNamesTheLimit) {
  Forge(file_.path(),
        "WITH RECURSIVE n(i) AS (VALUES(1) UNION ALL SELECT i + 1 FROM n WHERE i < 500001) "
        "INSERT INTO event (t_ns, kind, json, checksum) SELECT 0, 'a', '{}', " +
            std::to_string(
                static_cast<std::int64_t>(CalcChecksum(Event{0, "a", kNoOccurrence, "{}"}))) +
            " FROM n");
  auto reader = Reader::Open(file_.path());
  ASSERT_TRUE(reader.has_value());
  const auto events = reader->ReadEvents();
  ASSERT_FALSE(events.has_value());
  EXPECT_EQ(events.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(events.error().message.find("500000 events"), std::string::npos);
}

TEST_F(RecordOfAStranger, WithPagesThatAreCutOffIsAnErrorOrIsRead) {
  const std::string sound = ReadBytes(file_.path());
  for (std::size_t size = 0; size < sound.size(); size += sound.size() / 60) {
    SCOPED_TRACE(size);
    std::ofstream(file_.path(), std::ios::binary | std::ios::trunc) << sound.substr(0, size);
    const auto error = ReadAll();
    ASSERT_TRUE(error.has_value());
    EXPECT_EQ(error->code, ErrorCode::kUnreadable) << error->ToString();
  }
}

/** Makes all pages of a table's tree lead to one page: a file of some pages with rows without end.
 */
TEST_F(RecordOfAStranger, WithPagesThatLeadToOneAnotherManyTimesEnds) {
  std::string sql = "BEGIN;";
  for (int i = 0; i < 20'000; ++i) {
    sql += "INSERT INTO event (t_ns, kind, json, checksum) VALUES (1, 'a', '{}', 7);";
  }
  Forge(file_.path(), sql + "COMMIT");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file_.path().c_str(), &database), SQLITE_OK);
  sqlite3_stmt* root = nullptr;
  sqlite3_prepare_v2(database, "SELECT rootpage FROM sqlite_master WHERE name = 'event'", -1, &root,
                     nullptr);
  ASSERT_EQ(sqlite3_step(root), SQLITE_ROW);
  const auto page = static_cast<std::size_t>(sqlite3_column_int64(root, 0));
  sqlite3_finalize(root);
  sqlite3_close(database);
  std::fstream stream(file_.path(), std::ios::in | std::ios::out | std::ios::binary);
  constexpr std::size_t kPage = 16384;  // [bytes] of a record.
  std::string bytes(kPage, '\0');
  const auto at = static_cast<std::streamoff>((page - 1) * kPage);
  stream.seekg(at);
  stream.read(bytes.data(), kPage);
  ASSERT_EQ(bytes[0], 5) << "an inner page of a table";
  const auto cells = static_cast<std::size_t>(static_cast<unsigned char>(bytes[3]) * 256 +
                                              static_cast<unsigned char>(bytes[4]));
  ASSERT_GT(cells, 5u);
  const std::string first = [&] {
    const auto cell = static_cast<std::size_t>(static_cast<unsigned char>(bytes[12]) * 256 +
                                               static_cast<unsigned char>(bytes[13]));
    return bytes.substr(cell, 4);
  }();
  for (std::size_t i = 0; i < cells; ++i) {
    const auto cell = static_cast<std::size_t>(static_cast<unsigned char>(bytes[12 + 2 * i]) * 256 +
                                               static_cast<unsigned char>(bytes[13 + 2 * i]));
    bytes.replace(cell, 4, first);
  }
  stream.seekp(at);
  stream.write(bytes.data(), kPage);
  stream.close();
  auto reader = Reader::Open(file_.path());
  ASSERT_TRUE(reader.has_value()) << reader.error().ToString();
  const auto events = reader->ReadEvents();
  ASSERT_FALSE(events.has_value());
  EXPECT_EQ(events.error().code, ErrorCode::kUnreadable);
}

TEST_F(RecordOfAStranger, StatementThatTakesMoreStepsThanTheFileHasWorkForEnds) {
  auto database = Database::Open(file_.path(), Database::Mode::kReadOnly);
  ASSERT_TRUE(database.has_value());
  const auto endless = database->QueryInt(
      "SELECT count(*) FROM event AS a, event AS b, event AS c, event AS d, event AS e, event AS "
      "f, "
      "event AS g, event AS h, event AS i, event AS j, event AS k, event AS l, event AS m, event "
      "AS n, event AS o, event AS p, event AS q, event AS r, event AS s");
  ASSERT_FALSE(endless.has_value());
  EXPECT_EQ(endless.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(endless.error().message.find("more steps"), std::string::npos);
}

/** A Zstandard frame that says how many bytes it holds, as ZSTD_getFrameContentSize() reads it. */
std::vector<std::byte> MakeFalseFrame(std::uint64_t claimed) {
  std::vector<std::byte> block = Compress(MakeBytes(1, 100));
  // Magic number, descriptor with a size of eight bytes in a single segment, the size, the rest.
  std::vector<std::byte> lie(block.begin(), block.begin() + 4);
  lie.push_back(std::byte{0xe0});
  const auto* bytes = reinterpret_cast<const std::byte*>(&claimed);
  lie.insert(lie.end(), bytes, bytes + sizeof(claimed));
  lie.insert(lie.end(), block.begin() + 6, block.end());
  return lie;
}

TEST(CompressionOfAStranger, TakesMemoryForWhatComesOutAndNotForWhatIsClaimed) {
  constexpr std::uint64_t kClaimed = std::uint64_t{4} << 30;
  const auto lie = MakeFalseFrame(kClaimed);
  ASSERT_EQ(ZSTD_getFrameContentSize(lie.data(), lie.size()), kClaimed);
  EXPECT_TRUE(Decompress(lie, std::size_t{8} << 30).empty());
  // As much in truth: the limit counts what comes out.
  const std::vector<std::byte> zeros(std::size_t{4} << 20);
  const auto bomb = Compress(zeros);
  EXPECT_LT(bomb.size(), 1000u);
  EXPECT_TRUE(Decompress(bomb, zeros.size() - 1).empty());
  EXPECT_EQ(Decompress(bomb, zeros.size()), zeros);
}

TEST_F(RecordOfAStranger, WithAnAttachmentThatClaimsFourGibibytesIsDamaged) {
  for (const std::uint64_t claimed : {std::uint64_t{4} << 30, std::uint64_t{60} << 20}) {
    const auto lie = MakeFalseFrame(claimed);
    std::string hex;
    for (const std::byte byte : lie) {
      constexpr const char* kDigits = "0123456789abcdef";
      hex += kDigits[static_cast<unsigned>(byte) >> 4];
      hex += kDigits[static_cast<unsigned>(byte) & 15];
    }
    Forge(file_.path(), "UPDATE attachment SET bytes = x'" + hex + "', checksum = " +
                            std::to_string(static_cast<std::int64_t>(Checksum64(lie))));
    auto reader = Reader::Open(file_.path());
    ASSERT_TRUE(reader.has_value());
    const auto bytes = reader->ReadAttachment("product");
    ASSERT_FALSE(bytes.has_value());
    EXPECT_EQ(bytes.error().code, ErrorCode::kUnreadable);
  }
}

TEST_F(RecordOfAStranger, IsNoPipeNorHasOneBesideIt) {
  const TemporaryFile pipe("pipe.hvasrec");
  ASSERT_EQ(::mkfifo(pipe.path().c_str(), 0600), 0);
  const auto opened = Database::Open(pipe.path(), Database::Mode::kReadOnly);
  ASSERT_FALSE(opened.has_value());
  EXPECT_NE(opened.error().message.find("pipe"), std::string::npos);
  for (const char* suffix : {"-wal", "-shm", "-journal"}) {
    const std::string beside = file_.path().string() + suffix;
    ASSERT_EQ(::mkfifo(beside.c_str(), 0600), 0);
    EXPECT_FALSE(Reader::Open(file_.path()).has_value()) << suffix;
    std::filesystem::remove(beside);
  }
  EXPECT_TRUE(Reader::Open(file_.path()).has_value());
}

TEST_F(RecordOfAStranger, IsNotLargerThanWhatIsRead) {
  std::filesystem::resize_file(file_.path(), Database::kMostFileBytes + 1);  // A hole.
  const auto reader = Reader::Open(file_.path());
  ASSERT_FALSE(reader.has_value());
  EXPECT_EQ(reader.error().code, ErrorCode::kUnsupported);
}

TEST(TablesOfARecord, OfEverySchemaAreThoseThatWereWritten) {
  for (const char* path :
       {HVAS_RECORD_OF_SCHEMA_1, HVAS_RECORD_OF_SCHEMA_2, HVAS_RECORD_OF_SCHEMA_3,
        HVAS_RECORD_OF_SCHEMA_4, HVAS_RECORD_OF_SCHEMA_5}) {
    const auto reader = Reader::Open(path);
    EXPECT_TRUE(reader.has_value()) << reader.error().ToString();
  }
}

}  // namespace
}  // namespace hvas::record
