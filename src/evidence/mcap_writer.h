#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "evidence/output_file.h"

namespace hvas::evidence {

/** Messages with times in an MCAP file (https://mcap.dev/spec): in compressed chunks with
 checksums, and an index at the end, by which a viewer finds a time without reading all before it.
 */
class McapWriter {
 public:
  /** @param output  Outlives this; nothing else writes to it. */
  explicit McapWriter(OutputFile* output);

  /** Adds a channel of JSON messages. @returns its number. */
  std::uint16_t AddChannel(std::string_view topic, std::string_view schema_name,
                           std::string_view json_schema);

  /** Messages come in the order of their times. */
  void Add(std::uint16_t channel, std::int64_t t_ns, std::string_view message);

  void Finish();

 private:
  struct Span {
    std::uint64_t first_ns{0};
    std::uint64_t last_ns{0};
    bool is_empty{true};

    void Include(std::uint64_t t_ns);
  };

  /** What is to go into a chunk. */
  struct Chunk {
    std::string records;
    Span span;
    /** Time and place among the records of each channel's messages. */
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> messages;
  };

  void Write(std::string_view bytes);
  void EndChunk();
  void WriteSummary();

  OutputFile* output_;
  std::uint64_t at_{0};   ///< How much has been written.
  std::string channels_;  ///< Records of all schemas and channels, again for the summary.
  std::uint16_t channel_count_{0};
  Chunk chunk_;
  std::string chunk_indexes_;  ///< Records for the summary.
  std::uint32_t chunk_count_{0};
  Span span_;
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  std::uint32_t sequence_{0};
};

}  // namespace hvas::evidence
