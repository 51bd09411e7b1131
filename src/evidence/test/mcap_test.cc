// MCAP files, read as their specification says.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include "evidence/demonstrations.h"
#include "evidence/tables.h"
#include "evidence/test/evidence_fixture.h"
#include "record/compression.h"

namespace hvas::evidence {
namespace {

using nlohmann::json;
using testing::NumberAt;

/** A record of an MCAP file, read as its specification says (https://mcap.dev/spec). */
struct McapRecord {
  char opcode;
  std::size_t at;  ///< Where it begins.
  std::string content;
};

std::vector<McapRecord> ReadMcap(const std::string& bytes) {
  constexpr std::size_t kHead = 9;
  std::vector<McapRecord> records;
  for (std::size_t at = 0; at < bytes.size();) {
    const auto size = NumberAt<std::uint64_t>(bytes, at + 1);
    records.push_back({bytes[at], at, bytes.substr(at + kHead, size)});
    EXPECT_EQ(records.back().content.size(), size);
    at += kHead + size;
  }
  return records;
}

std::uint32_t Checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/** Records of a chunk, whose head says what comes out of it. */
std::string OpenChunk(const std::string& content) {
  EXPECT_EQ(content.substr(28, 8), std::string("\4\0\0\0zstd", 8));
  const std::string packed = content.substr(44);
  EXPECT_EQ(packed.size(), NumberAt<std::uint64_t>(content, 36));
  const auto size = NumberAt<std::uint64_t>(content, 16);
  const auto whole = record::Decompress(std::as_bytes(std::span(packed)), size);
  std::string records(reinterpret_cast<const char*>(whole.data()), whole.size());
  EXPECT_EQ(records.size(), size);
  EXPECT_EQ(Checksum(records), NumberAt<std::uint32_t>(content, 24));
  return records;
}

class McapTest : public testing::EvidenceTest {
 protected:
  void Write(int every) {
    ASSERT_TRUE(WriteMcap(&reader, {{}, every}, out / "x.mcap").has_value());
    Read();
  }

  void Read() {
    bytes_ = testing::ReadAll(out / "x.mcap");
    const std::string magic("\x89MCAP0\r\n", 8);
    ASSERT_EQ(bytes_.substr(0, 8), magic);
    ASSERT_EQ(bytes_.substr(bytes_.size() - 8), magic);
    // With the first eight bytes places are those in the file.
    bytes_.resize(bytes_.size() - 8);
    for (McapRecord& record : ReadMcap(bytes_.substr(8))) {
      record.at += 8;
      records_.push_back(std::move(record));
    }
  }

  [[nodiscard]] std::vector<McapRecord> OfKind(char opcode) const {
    std::vector<McapRecord> found;
    std::copy_if(records_.begin(), records_.end(), std::back_inserter(found),
                 [opcode](const McapRecord& record) { return record.opcode == opcode; });
    return found;
  }

  std::string bytes_;
  std::vector<McapRecord> records_;
};

TEST_F(McapTest, ItsMessagesAreInOrder) {
  Write(10);
  ASSERT_FALSE(HasFatalFailure());
  std::map<int, std::string> topics;
  for (const McapRecord& channel : OfKind(0x04)) {
    const auto length = NumberAt<std::uint32_t>(channel.content, 4);
    topics[NumberAt<std::uint16_t>(channel.content, 0)] = channel.content.substr(8, length);
  }
  std::map<std::string, std::size_t> counts;
  std::uint64_t last_ns = 0;
  for (const McapRecord& chunk : OfKind(0x06)) {
    for (const McapRecord& record : ReadMcap(OpenChunk(chunk.content))) {
      ASSERT_EQ(record.opcode, 0x05);
      const std::string& topic = topics.at(NumberAt<std::uint16_t>(record.content, 0));
      ++counts[topic];
      const auto t_ns = NumberAt<std::uint64_t>(record.content, 6);
      EXPECT_GE(t_ns, last_ns);
      last_ns = std::max(last_ns, t_ns);
      const json message = json::parse(record.content.substr(22));
      if (topic == "/hand0") {
        const auto& tick = ticks[t_ns / 1'000'000];
        ASSERT_EQ(message["felt_n"], tick.F_felt_W.f.norm());
      } else if (topic == "/tf") {
        ASSERT_EQ(message["transforms"][0]["child_frame_id"], "hand0");
      }
    }
  }
  EXPECT_EQ(counts["/hand0"], (ticks.size() + 9) / 10);
  EXPECT_EQ(counts["/tf"], counts["/hand0"]);
  EXPECT_EQ(counts["/events"], reader.ReadEvents()->size());
}

TEST_F(McapTest, DemonstrationsFollowEachOtherInTime) {
  Demonstration way;
  way.part = "rig/peg";
  way.source = "plan";
  way.is_seated = true;
  for (int i = 0; i < 5; ++i) {
    DemonstrationSample sample;
    sample.t = 3 + 0.02 * i;
    sample.X_WB = spatial::Pose(Vec3(0, 0, 1e-3 * (4 - i)));
    way.samples.push_back(sample);
  }
  ASSERT_TRUE(WriteMcap({way, way}, out / "x.mcap").has_value());
  Read();
  ASSERT_FALSE(HasFatalFailure());
  std::vector<std::uint64_t> times_ms;
  for (const McapRecord& chunk : OfKind(0x06)) {
    for (const McapRecord& record : ReadMcap(OpenChunk(chunk.content))) {
      const json message = json::parse(record.content.substr(22));
      if (!message.contains("demonstration")) {
        ASSERT_EQ(message["transforms"][1]["child_frame_id"], "rig/peg");
        continue;
      }
      times_ms.push_back(NumberAt<std::uint64_t>(record.content, 6) / 1'000'000);
      const auto i = static_cast<double>((times_ms.size() - 1) % 5);
      EXPECT_EQ(message["demonstration"], times_ms.size() > 5 ? 1 : 0);
      EXPECT_NEAR(message["to_goal_m"], 1e-3 * (4 - i), 1e-12);
    }
  }
  EXPECT_EQ(times_ms,
            (std::vector<std::uint64_t>{0, 20, 40, 60, 80, 1080, 1100, 1120, 1140, 1160}));
}

TEST_F(McapTest, TimesAreFoundByItsIndex) {
  Write(1);
  ASSERT_FALSE(HasFatalFailure());
  ASSERT_EQ(records_.front().opcode, 0x01);
  const McapRecord& footer = records_.back();
  ASSERT_EQ(footer.opcode, 0x02);
  const auto summary = NumberAt<std::uint64_t>(footer.content, 0);
  EXPECT_EQ(Checksum(bytes_.substr(summary, bytes_.size() - 4 - summary)),
            NumberAt<std::uint32_t>(footer.content, 16));
  const auto chunks = OfKind(0x06);
  ASSERT_GT(chunks.size(), 1u);
  const auto indexes = OfKind(0x08);
  ASSERT_EQ(indexes.size(), chunks.size());
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const std::string& index = indexes[i].content;
    EXPECT_GE(indexes[i].at, summary);
    EXPECT_EQ(index.substr(0, 16), chunks[i].content.substr(0, 16));  // first and last time
    EXPECT_EQ(NumberAt<std::uint64_t>(index, 16), chunks[i].at);
    EXPECT_EQ(NumberAt<std::uint64_t>(index, 24), chunks[i].content.size() + 9);
    const std::string messages = OpenChunk(chunks[i].content);
    const auto places = NumberAt<std::uint32_t>(index, 32);
    for (std::size_t k = 36; k < 36 + places; k += 10) {  // a channel, and where its index is
      const auto at = NumberAt<std::uint64_t>(index, k + 2);
      ASSERT_EQ(bytes_[at], 0x07);
      EXPECT_EQ(NumberAt<std::uint16_t>(bytes_, at + 9), NumberAt<std::uint16_t>(index, k));
      const auto size = NumberAt<std::uint32_t>(bytes_, at + 11);
      for (std::size_t m = at + 15; m < at + 15 + size; m += 16) {
        const std::size_t place = NumberAt<std::uint64_t>(bytes_, m + 8);
        ASSERT_EQ(messages[place], 0x05);
        ASSERT_EQ(NumberAt<std::uint16_t>(messages, place + 9), NumberAt<std::uint16_t>(index, k));
        ASSERT_EQ(NumberAt<std::uint64_t>(messages, place + 15),
                  NumberAt<std::uint64_t>(bytes_, m));
        ++count;
      }
    }
  }
  EXPECT_EQ(count, 2 * ticks.size() + reader.ReadEvents()->size());
  const auto statistics = OfKind(0x0b);
  ASSERT_EQ(statistics.size(), 1u);
  EXPECT_EQ(NumberAt<std::uint64_t>(statistics[0].content, 0), count);
  EXPECT_EQ(NumberAt<std::uint32_t>(statistics[0].content, 22), chunks.size());
}

}  // namespace
}  // namespace hvas::evidence
