#include <string>
#include <vector>

#include "evidence/hdf5_writer.h"
#include "evidence/output_file.h"
#include "evidence/tables.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;

/** An empty column that can grow, with its unit and description. */
Hdf5Handle MakeColumn(hid_t group, const Column& column, Hdf5Writer* writer) {
  Hdf5Handle set = writer->MakeSet(group, column.name, 1);
  writer->Describe(set.id(), "unit", column.unit);
  writer->Describe(set.id(), "description", column.description);
  return set;
}

Result<void> WriteTicks(record::Reader* reader, const Selection& selection, Hdf5Writer* writer) {
  const Hdf5Handle group = writer->MakeGroup(writer->root(), "ticks");
  std::vector<Hdf5Handle> sets;
  for (const Column& column : TickColumns()) {
    sets.push_back(MakeColumn(group.id(), column, writer));
  }
  std::vector<std::vector<double>> blocks(sets.size());
  hsize_t written = 0;
  const auto flush = [&] {
    for (std::size_t k = 0; k < sets.size() && !blocks[k].empty(); ++k) {
      writer->Append(sets[k].id(), written, blocks[k]);
    }
    written += blocks.front().size();
    for (std::vector<double>& block : blocks) {
      block.clear();
    }
  };
  Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
      blocks[k].push_back(TickColumns()[k].get(tick));
    }
    if (blocks.front().size() == Hdf5Writer::kBlock) {
      flush();
    }
  });
  flush();
  return done;
}

Result<void> WriteEvents(record::Reader* reader, Hdf5Writer* writer) {
  const auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  static constexpr Column kTime{"time_s", "s", "session time", nullptr};
  static constexpr Column kOccurrence{"occurrence", "1", "id of the part; -1: none", nullptr};
  const Hdf5Handle group = writer->MakeGroup(writer->root(), "events");
  std::vector<double> times;
  std::vector<double> occurrences;
  std::vector<std::string> kinds;
  std::vector<std::string> details;
  for (const record::Event& event : *events) {
    times.push_back(1e-9 * static_cast<double>(event.t_ns));
    occurrences.push_back(
        event.occurrence == record::kNoOccurrence ? -1.0 : static_cast<double>(event.occurrence));
    kinds.push_back(event.kind);
    details.push_back(event.json);
  }
  if (!times.empty()) {
    writer->Append(MakeColumn(group.id(), kTime, writer).id(), 0, times);
    writer->Append(MakeColumn(group.id(), kOccurrence, writer).id(), 0, occurrences);
  }
  writer->WriteTexts(group.id(), "kind", kinds);
  writer->WriteTexts(group.id(), "json", details);
  return {};
}

}  // namespace

Result<void> WriteHdf5(record::Reader* reader, const Selection& selection,
                       const std::filesystem::path& file) {
  auto output = OutputFile::Create(file);
  if (!output) {
    return Unexpected(output.error());
  }
  {
    Hdf5Writer writer(output->working_path());
    writer.Describe(writer.root(), "format", "hvas-session-1");
    for (const auto& [key, value] : reader->meta()) {
      writer.Describe(writer.root(), key.c_str(), value);
    }
    Result<void> done = WriteTicks(reader, selection, &writer);
    if (done) {
      done = WriteEvents(reader, &writer);
    }
    if (!done) {
      return done;
    }
    const Hdf5Handle parts = writer.MakeGroup(writer.root(), "parts");
    writer.WriteTexts(parts.id(), "path", ReadPaths(*reader));
    if (!writer.Flush()) {
      return Fail(ErrorCode::kOutOfResource, "the file could not be written completely",
                  file.string(), "free disk space, or choose another folder");
    }
  }
  return output->Finish();
}

}  // namespace hvas::evidence
