/** Time and memory of preparing parts for contact: the shape of each part of the CAD files named on
 the command line, built at the voxel that is chosen for it and at 0.5 mm, on one thread and on two,
 and loaded from the cache. CPU is that of the whole process, so other programs do not count.

   shape_bench [--json] [--parts] [--voxel MM] [--given] FILE...   Table of files; with --parts, of
                                                                   parts too.
 */
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/digest.h"
#include "base/file_cache.h"
#include "base/test/temporary_folder.h"
#include "base/units.h"
#include "cad/import.h"
#include "contact/shape.h"
#include "contact/shape_cache.h"
#include "contact/shape_io.h"
#include "simulation/shapes.h"

namespace {

using hvas::contact::Shape;
using hvas::contact::ShapeCache;
using hvas::contact::ShapeMemory;
using hvas::contact::ShapeOptions;
using hvas::contact::ShapeSource;

double CpuSeconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/** Of one part, or the sums of several, at one voxel. */
struct Row {
  std::size_t parts{0}, triangles{0};
  double area{0};                                                 // [m^2]
  double build_cpu{0}, build_wall{0}, load_cpu{0}, load_wall{0};  // [s]
  ShapeMemory memory;
  std::size_t points{0};
  std::uint64_t digest{0};  // Of the shapes' bytes, in their order.

  Row& operator+=(const Row& other) {
    parts += other.parts;
    triangles += other.triangles;
    area += other.area;
    build_cpu += other.build_cpu;
    build_wall += other.build_wall;
    load_cpu += other.load_cpu;
    load_wall += other.load_wall;
    memory += other.memory;
    points += other.points;
    const std::array both{digest, other.digest};
    digest = hvas::Checksum64(std::as_bytes(std::span(both)));
    return *this;
  }
};

double CalcArea(const ShapeSource& source) {
  double area = 0;
  for (const auto& t : source.triangles) {
    const hvas::Vec3& a = source.vertices[t[0]];
    area += 0.5 * (source.vertices[t[1]] - a).cross(source.vertices[t[2]] - a).norm();
  }
  return area;
}

/** CPU and wall time of a call. */
template <typename Call>
void Measure(Call call, double* cpu, double* wall) {
  const auto start = std::chrono::steady_clock::now();
  const double cpu_start = CpuSeconds();
  call();
  *cpu = CpuSeconds() - cpu_start;
  *wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/** False when the part has no shape. */
bool MeasurePart(const ShapeSource& source, const ShapeOptions& options, Row* row) {
  const hvas::testing::TemporaryFolder folder;
  ShapeCache cache(folder.path());
  std::shared_ptr<const Shape> shape;
  const auto prepare = [&] { shape = cache.LoadOrBuild(source, options).value_or(nullptr); };
  Measure(prepare, &row->build_cpu, &row->build_wall);
  if (shape == nullptr) {
    return false;
  }
  Measure(prepare, &row->load_cpu, &row->load_wall);
  row->parts = 1;
  row->triangles = source.triangles.size();
  row->area = CalcArea(source);
  row->memory = shape->CalcMemory();
  row->points = shape->point_count();
  row->digest = hvas::Checksum64(hvas::contact::SerialiseShape(*shape));
  return true;
}

std::string ToText(const std::string& name, double voxel, const Row& r) {
  const double area_mm2 = 1e6 * r.area;
  const auto mb = [](std::size_t bytes) { return 1e-6 * static_cast<double>(bytes); };
  const double each = 1 / static_cast<double>(std::max<std::size_t>(1, r.parts));
  return fmt::format(
      "{:28.28s} {:>6s} {:5d} {:8d} {:9.0f} {:8.1f} {:8.1f} {:7.3f} {:8.2f} {:6.2f} {:8.3f} "
      "{:7.2f} "
      "{:7.2f} {:7.2f} {:7.2f} {:7.2f} {:7d} {:016x}",
      name, voxel > 0 ? fmt::format("{:.2f}", hvas::units::ToMm(voxel)) : "chosen", r.parts,
      r.triangles, area_mm2, 1e3 * r.build_cpu, 1e3 * r.build_wall, each * r.build_cpu,
      1e3 * r.load_cpu, 100 * r.load_cpu / std::max(r.build_cpu, 1e-9),
      1e-3 * static_cast<double>(r.memory.total()) / area_mm2, mb(r.memory.total()),
      mb(r.memory.field), mb(r.memory.tables), mb(r.memory.mesh), mb(r.memory.shell), r.points,
      r.digest);
}

std::string ToJson(const std::string& name, double voxel, const Row& r) {
  return fmt::format(
      R"({{"name": "{}", "voxel_mm": {}, "parts": {}, "triangles": {}, "area_mm2": {:.6g}, )"
      R"("build_cpu_s": {:.6g}, "build_wall_s": {:.6g}, "load_cpu_s": {:.6g}, "load_wall_s": {:.6g}, )"
      R"("field_bytes": {}, "tables_bytes": {}, "mesh_bytes": {}, "shell_bytes": {}, "points": {}, "digest": "{:016x}"}})",
      name, hvas::units::ToMm(voxel), r.parts, r.triangles, 1e6 * r.area, r.build_cpu, r.build_wall,
      r.load_cpu, r.load_wall, r.memory.field, r.memory.tables, r.memory.mesh, r.memory.shell,
      r.points, r.digest);
}

struct Arguments {
  std::vector<std::string> files;
  bool is_json{false};
  bool with_parts{false};
  bool is_given_only{false};
  double voxel{0.5e-3};
};

constexpr const char* kUsage =
    "shape_bench [--json] [--parts] [--voxel MM] [--given] FILE...\n"
    "Prepares each part of the files at the chosen voxel and at MM (0.5).\n"
    "--json   One object a line instead of a table.\n"
    "--parts  Each part as well as each file.\n"
    "--given  Only at MM.\n";

Arguments Parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--json") {
      arguments.is_json = true;
    } else if (argument == "--parts") {
      arguments.with_parts = true;
    } else if (argument == "--given") {
      arguments.is_given_only = true;
    } else if (argument == "--voxel" && i + 1 < argc) {
      arguments.voxel = hvas::units::FromMm(std::atof(argv[++i]));
    } else if (argument == "--help") {
      fmt::print("{}", kUsage);
      std::exit(0);
    } else {
      arguments.files.emplace_back(argument);
    }
  }
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = Parse(argc, argv);
  if (arguments.files.empty()) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  const auto print = [&](const std::string& name, double voxel, const Row& row) {
    fmt::print("{}\n", arguments.is_json ? ToJson(name, voxel, row) : ToText(name, voxel, row));
    std::fflush(stdout);
  };
  if (!arguments.is_json) {
    fmt::print(
        "{:28s} {:>6s} {:>5s} {:>8s} {:>9s} {:>8s} {:>8s} {:>7s} {:>8s} {:>6s} {:>8s} {:>7s} "
        "{:>7s} "
        "{:>7s} {:>7s} {:>7s} {:>7s} {:>16s}\n",
        "file", "voxel", "parts", "tri", "area_mm2", "cpu_ms", "wall_ms", "s/part", "load_ms",
        "load_%", "kB/mm2", "MB", "field", "tables", "mesh", "shell", "points", "digest");
  }
  std::vector<double> voxels{arguments.voxel};
  if (!arguments.is_given_only) {
    voxels.insert(voxels.begin(), 0.0);
  }
  std::vector<Row> sums(voxels.size());
  for (const std::string& file : arguments.files) {
    // Imported and no more: mates change nothing in the shape of a part.
    hvas::Diagnostics diagnostics;
    hvas::cad::ImportControl control;
    control.cache_directory = hvas::FileCache::DefaultDirectory();
    const auto product = hvas::cad::Import(file, {}, &diagnostics, control);
    if (!product) {
      fmt::print(stderr, "{}\n", product.error().ToString());
      continue;
    }
    std::vector<Row> rows(voxels.size());
    for (const hvas::product::Part& part : product->parts) {
      const ShapeSource source = hvas::simulation::MakeShapeSource(part);
      for (std::size_t v = 0; v < voxels.size(); ++v) {
        Row row;
        ShapeOptions options;
        options.voxel = voxels[v];
        if (MeasurePart(source, options, &row)) {
          rows[v] += row;
          if (arguments.with_parts) {
            print("  " + part.name, voxels[v], row);
          }
        }
      }
    }
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      print(std::filesystem::path(file).filename().string(), voxels[v], rows[v]);
      sums[v] += rows[v];
    }
  }
  for (std::size_t v = 0; v < voxels.size(); ++v) {
    print("all", voxels[v], sums[v]);
  }
  return 0;
}
