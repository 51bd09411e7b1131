#include <memory>

#include "arguments.h"
#include "evidence/session_data.h"

namespace hvas::python {
namespace {

/** A record that is open. */
class PythonRecord {
 public:
  explicit PythonRecord(const std::filesystem::path& file)
      : reader_(Take(record::Reader::Open(file))) {}

  [[nodiscard]] const record::Meta& meta() const { return reader_.meta(); }

  [[nodiscard]] bool is_complete() const { return reader_.is_complete(); }

  [[nodiscard]] std::int64_t tick_count() const { return reader_.tick_count(); }

  /** All numbers of all ticks, by the name of the column: those of the exports. */
  py::dict Ticks(const py::object& every) {
    constexpr std::int64_t kMostEvery = 1'000'000'000;  // More than a record has: a choice.
    const auto columns = evidence::TickColumns();
    std::vector<std::vector<double>> values(columns.size());
    evidence::Selection selection;
    selection.every = ToInteger("every", every, 1, kMostEvery);
    const auto read = [&] {
      const py::gil_scoped_release unlocked;
      return evidence::ForEachSelected(&reader_, selection, [&](const record::TickRecord& tick) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
          values[i].push_back(columns[i].get(tick));
        }
      });
    }();
    if (!read) {
      Throw(read.error());
    }
    py::dict arrays;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      arrays[columns[i].name] =
          py::array_t<double>(static_cast<py::ssize_t>(values[i].size()), values[i].data());
    }
    return arrays;
  }

  py::list Events() {
    py::list list;
    const py::object loads = py::module_::import("json").attr("loads");
    for (const record::Event& event : Take(reader_.ReadEvents())) {
      py::object occurrence = py::none();
      if (event.occurrence != record::kNoOccurrence) {
        occurrence = py::int_(event.occurrence);
      }
      list.append(MakeDataclass(
          "Event", py::dict(py::arg("t") = 1e-9 * static_cast<double>(event.t_ns),
                            py::arg("kind") = event.kind, py::arg("occurrence") = occurrence,
                            py::arg("details") =
                                event.json.empty() ? py::object(py::dict()) : loads(event.json))));
    }
    return list;
  }

  std::string Verify() {
    auto digest = [&] {
      const py::gil_scoped_release unlocked;
      return reader_.Verify();
    }();
    return Take(std::move(digest));
  }

  py::object Replay(const py::object& progress) {
    std::stop_source stop;
    Diagnostics diagnostics;
    simulation::CompileOptions compile;
    compile.shape_cache = assembly::MakeShapeCache(FileCache::DefaultDirectory());
    session::ReplayOptions options;
    const auto tell = MakeProgress(progress, &stop);
    options.progress = [&tell](double fraction) { tell("replaying", fraction); };
    auto report = [&]() -> Result<session::ReplayReport> {
      const py::gil_scoped_release unlocked;
      const auto model = session::LoadModel(&reader_, compile, &diagnostics);
      if (!model) {
        return Unexpected(model.error());
      }
      return session::Replay(&reader_, *model, options);
    }();
    ThrowInterrupt();
    const session::ReplayReport replayed = Take(std::move(report));
    return MakeDataclass(
        "ReplayReport",
        py::dict(py::arg("ticks") = replayed.ticks,
                 py::arg("different_ticks") = replayed.different_ticks,
                 py::arg("exact") = replayed.is_exact(),
                 py::arg("largest_felt_difference") = replayed.largest_felt_difference));
  }

 private:
  record::Reader reader_;
};

}  // namespace

void DefineRecord(py::module_* module) {
  py::class_<PythonRecord>(*module, "Record", "A recorded session.")
      .def(py::init<const std::filesystem::path&>(), py::arg("file"))
      .def_property_readonly("meta", &PythonRecord::meta)
      .def_property_readonly("complete", &PythonRecord::is_complete)
      .def_property_readonly("tick_count", &PythonRecord::tick_count)
      .def(
          "ticks", &PythonRecord::Ticks, py::arg("every") = 1,
          "Arrays of all numbers of all ticks, or of every so many-th of each hand, by the name of "
          "the column, which ends with its unit.")
      .def("events", &PythonRecord::Events, "What happened: a list of hvas.types.Event.")
      .def("verify", &PythonRecord::Verify,
           "Reads everything against its checksums, and gives the digest.")
      .def("replay", &PythonRecord::Replay, py::arg("progress") = py::none(),
           "Runs every tick again from what is recorded, and compares it bit for bit.");
}

}  // namespace hvas::python
