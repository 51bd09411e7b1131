#include "app/recording/export_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

#include "app/output/number_range.h"
#include "base/regular_file.h"
#include "evidence/demonstrations.h"
#include "evidence/tables.h"

namespace hvas::app {
namespace {

using Writer = Result<void> (*)(record::Reader*, const evidence::Selection&,
                                const std::filesystem::path&);

constexpr std::array<std::pair<std::string_view, Writer>, 6> kWriters{{
    {".csv", &evidence::WriteCsv},
    {".json", &evidence::WriteJson},
    {".h5", &evidence::WriteHdf5},
    {".hdf5", &evidence::WriteHdf5},
    {".mcap", &evidence::WriteMcap},
    {".glb", &evidence::WritePathGlb},
}};

Writer FindWriter(const std::string& ending) {
  const auto* const found = std::find_if(kWriters.begin(), kWriters.end(),
                                         [&](const auto& entry) { return entry.first == ending; });
  return found == kWriters.end() ? nullptr : found->second;
}

}  // namespace

void AddRecordSelection(CLI::App* command, RecordSelection* selection) {
  command
      ->add_option("--from", selection->from_s,
                   "For a record: begin of the exported session time [s]")
      ->check(AnyNumber());
  command->add_option("--to", selection->to_s, "For a record: end of the exported session time [s]")
      ->check(AnyNumber());
  command
      ->add_option("--every", selection->every,
                   "For a record: keep one of so many ticks of each hand (not for .glb)")
      ->check(CLI::Range(1, 1'000'000));
  command->add_flag(
      "--demonstrations", selection->is_demonstrations,
      "Write demonstrations to learn from, as .h5 in the layout of robomimic or as .mcap: of "
      "a record each hold of a part, of a CAD file the planned way of each part");
}

bool IsRecord(const std::filesystem::path& file) {
  constexpr std::string_view kMagic = "SQLite format 3";
  return ReadFileHead(file, kMagic.size()) == kMagic;
}

bool IsHdf5(const std::string& ending) {
  return ending == ".h5" || ending == ".hdf5";
}

bool IsRecordFormat(const std::string& ending) {
  return FindWriter(ending) != nullptr;
}

Result<std::string> ExportRecord(const std::filesystem::path& file,
                                 const std::filesystem::path& output, const std::string& ending,
                                 const RecordSelection& selection) {
  auto reader = record::Reader::Open(file);
  if (!reader) {
    return Unexpected(reader.error());
  }
  evidence::Selection chosen;
  chosen.span = {std::llround(1e9 * selection.from_s), std::llround(1e9 * selection.to_s)};
  chosen.every = selection.every;
  if (selection.is_demonstrations) {
    auto demonstrations = evidence::ListDemonstrations(&*reader, chosen);
    if (!demonstrations) {
      return Unexpected(demonstrations.error());
    }
    const auto written =
        evidence::WriteDemonstrations(*demonstrations, file.filename().string(), output);
    if (!written) {
      return Unexpected(written.error());
    }
  } else if (const auto written = FindWriter(ending)(&*reader, chosen, output); !written) {
    return Unexpected(written.error());
  }
  const auto verified = reader->Verify();
  return verified ? std::string() : verified.error().message;
}

}  // namespace hvas::app
