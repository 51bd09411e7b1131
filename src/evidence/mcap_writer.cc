#include "evidence/mcap_writer.h"

#include <algorithm>
#include <numeric>
#include <span>

#include <zlib.h>

#include "record/compression.h"

namespace hvas::evidence {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kChunkSize = 1 << 20;  // of records, before they are compressed

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kDataEnd = 0x0f,
};

/** Content of a record, everything little-endian. */
class Content {
 public:
  template <typename T>
  Content& Number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }

  Content& Text(std::string_view text) {
    Number(static_cast<std::uint32_t>(text.size()));
    return Raw(text);
  }

  Content& Raw(std::string_view text) {
    bytes_.append(text);
    return *this;
  }

  /** Of pairs of numbers. */
  template <typename Pairs>
  Content& List(const Pairs& pairs) {
    Content list;
    for (const auto& [first, second] : pairs) {
      list.Number(first).Number(second);
    }
    return Text(list.bytes_);
  }

  /** Behind its opcode and its length. */
  [[nodiscard]] std::string MakeRecord(Opcode opcode) const {
    Content record;
    record.Number(opcode).Number(static_cast<std::uint64_t>(bytes_.size())).Raw(bytes_);
    return std::move(record.bytes_);
  }

 private:
  std::string bytes_;
};

std::uint32_t CalcChecksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

void McapWriter::Span::Include(std::uint64_t t_ns) {
  first_ns = is_empty ? t_ns : std::min(first_ns, t_ns);
  last_ns = is_empty ? t_ns : std::max(last_ns, t_ns);
  is_empty = false;
}

McapWriter::McapWriter(OutputFile* output) : output_(output) {
  Write(kMagic);
  Write(Content().Text("").Text("hvas").MakeRecord(Opcode::kHeader));
}

void McapWriter::Write(std::string_view bytes) {
  output_->Write(bytes);
  at_ += bytes.size();
}

std::uint16_t McapWriter::AddChannel(std::string_view topic, std::string_view schema_name,
                                     std::string_view json_schema) {
  const std::uint16_t number = ++channel_count_;  // of both: 0 is no schema
  std::string records = Content()
                            .Number(number)
                            .Text(schema_name)
                            .Text("jsonschema")
                            .Text(json_schema)
                            .MakeRecord(Opcode::kSchema);
  records += Content().Number(number).Number(number).Text(topic).Text("json").Text("").MakeRecord(
      Opcode::kChannel);
  Write(records);
  channels_ += records;
  return number;
}

void McapWriter::Add(std::uint16_t channel, std::int64_t t_ns, std::string_view message) {
  const auto t = static_cast<std::uint64_t>(t_ns);
  chunk_.messages[channel].emplace_back(t, chunk_.records.size());
  chunk_.span.Include(t);
  span_.Include(t);
  ++message_counts_[channel];
  chunk_.records += Content()
                        .Number(channel)
                        .Number(sequence_++)
                        .Number(t)
                        .Number(t)
                        .Raw(message)
                        .MakeRecord(Opcode::kMessage);
  if (chunk_.records.size() >= kChunkSize) {
    EndChunk();
  }
}

void McapWriter::EndChunk() {
  if (chunk_.messages.empty()) {
    return;
  }
  constexpr std::string_view kCompression = "zstd";
  const auto packed = record::Compress(std::as_bytes(std::span(chunk_.records)));
  const std::string_view bytes(reinterpret_cast<const char*>(packed.data()), packed.size());
  const auto full_size = static_cast<std::uint64_t>(chunk_.records.size());
  const auto size = static_cast<std::uint64_t>(bytes.size());
  const std::uint64_t start = at_;
  Write(Content()
            .Number(chunk_.span.first_ns)
            .Number(chunk_.span.last_ns)
            .Number(full_size)
            .Number(CalcChecksum(chunk_.records))
            .Text(kCompression)
            .Number(size)
            .Raw(bytes)
            .MakeRecord(Opcode::kChunk));
  const std::uint64_t end = at_;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> index_places;
  for (const auto& [channel, places] : chunk_.messages) {
    index_places.emplace_back(channel, at_);
    Write(Content().Number(channel).List(places).MakeRecord(Opcode::kMessageIndex));
  }
  chunk_indexes_ += Content()
                        .Number(chunk_.span.first_ns)
                        .Number(chunk_.span.last_ns)
                        .Number(start)
                        .Number(end - start)
                        .List(index_places)
                        .Number(at_ - end)
                        .Text(kCompression)
                        .Number(size)
                        .Number(full_size)
                        .MakeRecord(Opcode::kChunkIndex);
  ++chunk_count_;
  chunk_ = {};
}

void McapWriter::WriteSummary() {
  const std::uint64_t start = at_;
  const std::uint64_t message_count =
      std::accumulate(message_counts_.begin(), message_counts_.end(), std::uint64_t{0},
                      [](std::uint64_t sum, const auto& count) { return sum + count.second; });
  constexpr std::uint32_t kNone = 0;  // attachments, metadata
  std::string summary = channels_ + chunk_indexes_;
  summary += Content()
                 .Number(message_count)
                 .Number(channel_count_)
                 .Number(static_cast<std::uint32_t>(channel_count_))
                 .Number(kNone)
                 .Number(kNone)
                 .Number(chunk_count_)
                 .Number(span_.first_ns)
                 .Number(span_.last_ns)
                 .List(message_counts_)
                 .MakeRecord(Opcode::kStatistics);
  // The footer's checksum is of the summary and of the footer up to itself.
  constexpr std::uint64_t kNoOffsets = 0;
  std::string footer =
      Content().Number(start).Number(kNoOffsets).Number(kNone).MakeRecord(Opcode::kFooter);
  std::uint32_t checksum = 0;
  footer.resize(footer.size() - sizeof(checksum));
  summary += footer;
  checksum = CalcChecksum(summary);
  summary.append(reinterpret_cast<const char*>(&checksum), sizeof(checksum));
  Write(summary);
}

void McapWriter::Finish() {
  EndChunk();
  Write(Content().Number(std::uint32_t{0}).MakeRecord(Opcode::kDataEnd));  // chunks have checksums
  WriteSummary();
  Write(kMagic);
}

}  // namespace hvas::evidence
