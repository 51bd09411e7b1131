/** CPU time of an import against the bare calls of OpenCASCADE that it cannot do without: reading
 and transferring the file, and meshing each part at the deflection and angle that the import chose
 for it, one after another; also as the program does it, by a process of its own and from the cache.
 Of several runs the quickest counts. Prints a table for the STEP files named on the command line.

   import_bench [-n REPEATS] FILE... */
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <BRepMesh_IncrementalMesh.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>

#include "base/test/temporary_folder.h"
#include "base/units.h"
#include "cad/brep/part_shape.h"
#include "cad/import.h"
#include "cad/process/read_cad.h"

namespace {

using hvas::cad::MeshLevel;

/** CPU time of this process and of those that it has waited for [s]. */
double ReadCpuTime() {
  double seconds = 0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    ::getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
  }
  return seconds;
}

double SecondsSince(double start) {
  return ReadCpuTime() - start;
}

/** The shapes of the parts of a document that have faces, each definition once. */
std::vector<TopoDS_Shape> ListParts(const Handle(TDocStd_Document) & document) {
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetShapes(labels);
  std::vector<TopoDS_Shape> shapes;
  for (const TDF_Label& label : labels) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (!XCAFDoc_ShapeTool::IsAssembly(label) && hvas::cad::CountContent(shape).faces > 0) {
      shapes.push_back(shape);
    }
  }
  return shapes;
}

Handle(TDocStd_Document) ReadBare(const std::filesystem::path& file) {
  STEPCAFControl_Reader reader;
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  reader.ReadFile(std::filesystem::canonical(file).c_str());
  reader.Transfer(document);
  return document;
}

/** How finely the import meshes each part. */
std::vector<MeshLevel> CalcLevels(const std::filesystem::path& file) {
  const Handle(TDocStd_Document) document = ReadBare(file);
  std::vector<MeshLevel> levels;
  for (const TopoDS_Shape& shape : ListParts(document)) {
    hvas::product::Part part;
    hvas::Diagnostics diagnostics;
    const auto level = hvas::cad::BuildPartShape(
        shape, {}, [](const TopoDS_Face&) { return std::nullopt; }, &part, &diagnostics);
    levels.push_back(level.value_or(MeshLevel{}));
  }
  XCAFApp_Application::GetApplication()->Close(document);
  return levels;
}

struct Times {
  double read{1e9}, mesh{1e9}, import{1e9};  // [s]
  double process{1e9};                       // The import by a process of its own, kept [s]
  double cached{1e9};                        // The same once more [s]
};

void MeasureBare(const std::filesystem::path& file, const std::vector<MeshLevel>& levels,
                 Times* times) {
  auto start = ReadCpuTime();
  const Handle(TDocStd_Document) document = ReadBare(file);
  times->read = std::min(times->read, SecondsSince(start));
  start = ReadCpuTime();
  const std::vector<TopoDS_Shape> shapes = ListParts(document);
  for (std::size_t i = 0; i < std::min(shapes.size(), levels.size()); ++i) {
    if (levels[i].deflection > 0) {
      BRepMesh_IncrementalMesh(shapes[i], hvas::units::ToMm(levels[i].deflection), false,
                               levels[i].angle);
    }
  }
  times->mesh = std::min(times->mesh, SecondsSince(start));
  XCAFApp_Application::GetApplication()->Close(document);
}

void MeasureImport(const std::filesystem::path& file, Times* times, std::string* counts) {
  hvas::Diagnostics diagnostics;
  const auto start = ReadCpuTime();
  const auto product = hvas::cad::ReadCad(file, {}, &diagnostics);
  times->import = std::min(times->import, SecondsSince(start));
  if (!product) {
    *counts = product.error().ToString();
    return;
  }
  std::size_t triangles = 0;
  std::size_t display_triangles = 0;
  for (const hvas::product::Part& part : product->parts) {
    triangles += part.mesh.triangles.size();
    display_triangles += part.display_mesh.triangles.size();
  }
  *counts = fmt::format("{:5d} {:5d} {:8d} {:8d}", product->occurrences.size(),
                        product->parts.size(), triangles, display_triangles);
}

/** As the program opens a file: first by hvas-cad, then from the cache. */
void MeasureProgram(const std::filesystem::path& file, Times* times) {
  hvas::cad::ImportControl control;
  const hvas::testing::TemporaryFolder cache;
  control.cache_directory = cache.path();
  for (double* best : {&times->process, &times->cached}) {
    hvas::Diagnostics diagnostics;
    const auto start = ReadCpuTime();
    const auto product = hvas::cad::Import(file, {}, &diagnostics, control);
    *best = std::min(*best, SecondsSince(start));
  }
}

}  // namespace

int main(int argc, char** argv) {
  int repeats = 3;
  int first = 1;
  if (argc > 2 && std::string(argv[1]) == "-n") {
    repeats = std::max(1, std::atoi(argv[2]));
    first = 3;
  }
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  fmt::print(
      "{:32s} {:>8s} {:>8s} {:>9s} {:>6s} {:>10s} {:>6s} {:>9s} {:>6s}   {:>5s} {:>5s} {:>8s} "
      "{:>8s}\n",
      "file", "read_ms", "mesh_ms", "import_ms", "ratio", "process_ms", "ratio", "cached_ms",
      "ratio", "occ", "parts", "fine", "display");
  for (int i = first; i < argc; ++i) {
    const std::filesystem::path file = argv[i];
    const std::vector<MeshLevel> levels = CalcLevels(file);
    Times times;
    std::string counts;
    for (int n = 0; n < repeats; ++n) {
      MeasureBare(file, levels, &times);
      MeasureImport(file, &times, &counts);
      MeasureProgram(file, &times);
    }
    const double bare = times.read + times.mesh;
    fmt::print("{:32s} {:8.0f} {:8.0f} {:9.0f} {:6.2f} {:10.0f} {:6.2f} {:9.2f} {:6.3f}   {}\n",
               file.filename().string(), 1e3 * times.read, 1e3 * times.mesh, 1e3 * times.import,
               times.import / bare, 1e3 * times.process, times.process / bare, 1e3 * times.cached,
               times.cached / bare, counts);
  }
  return 0;
}
