// The one source that knows HDF5.

#include <string>
#include <utility>
#include <vector>

#include <hdf5.h>

#include "evidence/output_file.h"
#include "evidence/tables.h"

namespace hvas::evidence {
namespace {

using record::TickRecord;

constexpr hsize_t kBlock = 4096;  // values that are written, and compressed, together
constexpr unsigned kDeflate = 4;  // A level from 0 to 9: a choice, not measured.

/** A handle that is closed by its own function. */
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  Handle(hid_t id, Closer close) : id_(id), close_(close) {}

  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;

  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }

  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
  Closer close_;
};

/** Keeps in mind whether all has gone well; HDF5 itself is kept from printing. */
class Writer {
 public:
  explicit Writer(const std::filesystem::path& path)
      : text_(H5Tcopy(H5T_C_S1), &H5Tclose),
        scalar_(H5Screate(H5S_SCALAR), &H5Sclose),
        file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), &H5Fclose) {
    Note(H5Tset_size(text_.id(), H5T_VARIABLE));
    Note(H5Tset_cset(text_.id(), H5T_CSET_UTF8));
    Note(file_.id());
  }

  void Describe(hid_t object, const char* name, const std::string& text) {
    const Handle attribute(
        H5Acreate2(object, name, text_.id(), scalar_.id(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
    const char* value = text.c_str();
    Note(attribute.id() < 0 ? -1 : H5Awrite(attribute.id(), text_.id(), &value));
  }

  Handle MakeGroup(const char* name) {
    Handle group(H5Gcreate2(file_.id(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), &H5Gclose);
    Note(group.id());
    return group;
  }

  /** An empty column that can grow. */
  Handle MakeColumn(hid_t group, const Column& column) {
    const hsize_t none = 0;
    const hsize_t any = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &any), &H5Sclose);
    const Handle how(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose);
    Note(H5Pset_chunk(how.id(), 1, &kBlock));
    Note(H5Pset_shuffle(how.id()));
    Note(H5Pset_deflate(how.id(), kDeflate));
    Handle set(H5Dcreate2(group, column.name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, how.id(),
                          H5P_DEFAULT),
               &H5Dclose);
    Note(set.id());
    Describe(set.id(), "unit", column.unit);
    Describe(set.id(), "description", column.description);
    return set;
  }

  void Append(hid_t set, hsize_t at, const std::vector<double>& values) {
    const hsize_t count = values.size();
    const hsize_t size = at + count;
    Note(H5Dset_extent(set, &size));
    const Handle in_file(H5Dget_space(set), &H5Sclose);
    Note(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, &at, nullptr, &count, nullptr));
    const Handle in_memory(H5Screate_simple(1, &count, nullptr), &H5Sclose);
    Note(
        H5Dwrite(set, H5T_NATIVE_DOUBLE, in_memory.id(), in_file.id(), H5P_DEFAULT, values.data()));
  }

  void WriteTexts(hid_t group, const char* name, const std::vector<std::string>& texts) {
    std::vector<const char*> values;
    for (const std::string& text : texts) {
      values.push_back(text.c_str());
    }
    const hsize_t count = values.size();
    const Handle space(H5Screate_simple(1, &count, nullptr), &H5Sclose);
    const Handle set(
        H5Dcreate2(group, name, text_.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        &H5Dclose);
    Note(set.id() < 0 || count == 0
             ? set.id()
             : H5Dwrite(set.id(), text_.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  }

  void Note(hid_t outcome) { is_good_ = is_good_ && outcome >= 0; }

  [[nodiscard]] bool Flush() {
    Note(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL));
    return is_good_;
  }

  [[nodiscard]] hid_t root() const { return file_.id(); }

 private:
  Handle text_;
  Handle scalar_;
  Handle file_;
  bool is_good_{true};
};

Result<void> WriteTicks(record::Reader* reader, const Selection& selection, Writer* writer) {
  const Handle group = writer->MakeGroup("ticks");
  std::vector<Handle> sets;
  for (const Column& column : TickColumns()) {
    sets.push_back(writer->MakeColumn(group.id(), column));
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
  const Result<void> done = ForEachSelected(reader, selection, [&](const TickRecord& tick) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
      blocks[k].push_back(TickColumns()[k].get(tick));
    }
    if (blocks.front().size() == kBlock) {
      flush();
    }
  });
  flush();
  return done;
}

Result<void> WriteEvents(record::Reader* reader, Writer* writer) {
  const auto events = reader->ReadEvents();
  if (!events) {
    return Unexpected(events.error());
  }
  static constexpr Column kTime{"time_s", "s", "session time", nullptr};
  static constexpr Column kOccurrence{"occurrence", "1", "id of the part; -1: none", nullptr};
  const Handle group = writer->MakeGroup("events");
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
    writer->Append(writer->MakeColumn(group.id(), kTime).id(), 0, times);
    writer->Append(writer->MakeColumn(group.id(), kOccurrence).id(), 0, occurrences);
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
  // What a full disk did not take must not be tried again when the program ends: that crashes.
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  {
    Writer writer(output->working_path());
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
    const Handle parts = writer.MakeGroup("parts");
    writer.WriteTexts(parts.id(), "path", ReadPaths(*reader));
    if (!writer.Flush()) {
      return Fail(ErrorCode::kOutOfResource, "the file could not be written completely",
                  file.string(), "free disk space, or choose another folder");
    }
  }
  return output->Finish();
}

}  // namespace hvas::evidence
