#include "contact/shape.h"

#include <cmath>
#include <new>

#include <fmt/format.h>

#include "contact/field_build.h"
#include "contact/helix_fit.h"
#include "contact/shape_data.h"
#include "contact/shell_build.h"
#include "contact/smooth_surface.h"

namespace hvas::contact {
namespace {

constexpr std::size_t kMaxFaces = 65536;  // What a query's face masks hold.

Result<void> Check(const ShapeSource& source) {
  const auto fail = [](const char* message) {
    return Fail(ErrorCode::kInvalid, message, "contact shape", "check the part's tessellation");
  };
  if (source.triangles.empty() || source.vertices.empty()) {
    return fail("the mesh is empty");
  }
  if (source.triangle_face.size() != source.triangles.size()) {
    return fail("every triangle must name its face");
  }
  if (source.faces.size() > kMaxFaces) {
    return fail("the part has more than 65536 faces");
  }
  for (const Vec3& v : source.vertices) {
    if (!v.allFinite()) {
      return fail("the mesh has a vertex that is not finite");
    }
  }
  for (std::size_t i = 0; i < source.triangles.size(); ++i) {
    for (const std::uint32_t v : source.triangles[i]) {
      if (v >= source.vertices.size()) {
        return fail("a triangle names a vertex that does not exist");
      }
    }
    if (source.triangle_face[i] >= source.faces.size()) {
      return fail("a triangle names a face that does not exist");
    }
  }
  return {};
}

// Queries look at triangles in the zones' lists, and at all of freeform faces.
void DropUnusedTriangles(Shape::Data* data) {
  ExactTable& exact = data->exact;
  std::vector<bool> is_used(data->mesh.triangles.size(), false);
  for (std::size_t i = 0; i < exact.listed.size(); ++i) {
    is_used[exact.Listed(i).triangle] = true;
  }
  for (std::size_t t = 0; t < is_used.size(); ++t) {
    is_used[t] = is_used[t] || exact.IsFreeform(data->mesh.face[t]);
  }
  std::vector<std::uint32_t> number;
  data->mesh = KeepTriangles(data->mesh, is_used, &number);
  const std::uint32_t distance = (1U << exact.distance_bits) - 1U;
  for (std::uint32_t& entry : exact.listed) {
    entry = number[entry >> exact.distance_bits] << exact.distance_bits | (entry & distance);
  }
  for (std::uint32_t& code : exact.zones) {
    if ((code & ~zone::kPayload) == zone::kSmooth) {
      code = zone::kSmooth | number[code & zone::kPayload];
    }
  }
  for (Shell* shell : {&data->shell, &data->features}) {
    for (std::uint32_t& t : shell->triangle) {
      t = t != kNoFace ? number[t] : kNoFace;
    }
  }
}

template <typename T>
std::size_t Bytes(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

std::size_t Bytes(const Shell& s) {
  return Bytes(s.nodes) + Bytes(s.x) + Bytes(s.y) + Bytes(s.z) + Bytes(s.leaf_count) +
         Bytes(s.faces) + Bytes(s.facing) + Bytes(s.triangle) + Bytes(s.order) + Bytes(s.rank) +
         Bytes(s.thread) + Bytes(s.leaf_thread);
}

// How many blocks a part's box has at its voxel.
double CountBlocks(const Shape::Data& data) {
  return (data.box_B.size() / (kBlockCells * data.voxel) + Vec3::Constant(2)).prod();
}

Result<void> Prepare(const ShapeSource& source, const ShapeOptions& options, Shape::Data* data) {
  for (const auto& triangle : source.triangles) {
    for (const std::uint32_t v : triangle) {
      data->box_B.Add(source.vertices[v]);
    }
  }
  data->p_BC = data->box_B.centre();
  data->mesh = MakeMesh(source, data->p_BC);
  if (data->mesh.triangles.empty()) {
    return Fail(ErrorCode::kInvalid, "the mesh has no triangle with an area", "contact shape");
  }
  for (const spatial::Surface& face : source.faces) {
    data->exact.faces.push_back(face);
    data->exact.faces.back().origin -= data->p_BC;
  }
  CheckFaces(data->mesh, &data->exact);
  FindBends(data->box_B.size().norm(), &data->exact, &data->mesh);
  data->helices = FindHelices(data->mesh, data->exact.faces);
  data->voxel = options.voxel > 0 ? options.voxel : ChooseVoxel(data->mesh, data->exact.faces);
  constexpr double kMostBlocks = 1U << 27U;  // Half a gigabyte of directory.
  if (!(CountBlocks(*data) <= kMostBlocks)) {
    return Fail(
        ErrorCode::kOutOfResource,
        fmt::format("A voxel of {:.3g} mm is too small for a part this large.", 1e3 * data->voxel),
        "contact shape", "Choose a larger voxel, or none.");
  }
  const auto cancelled = [] {
    return Fail(ErrorCode::kCancelled, "preparing a part was cancelled", "contact shape");
  };
  if (options.stop.stop_requested()) {
    return cancelled();
  }
  BuildField(options, data);
  if (options.stop.stop_requested()) {
    return cancelled();
  }
  data->spacing = options.point_spacing > 0 ? options.point_spacing : ChooseSpacing(data->mesh);
  BuildShells(data);
  DropUnusedTriangles(data);
  data->Complete();
  return {};
}

}  // namespace

Result<std::shared_ptr<const Shape>> Shape::Build(const ShapeSource& source,
                                                  const ShapeOptions& options) {
  if (auto check = Check(source); !check) {
    return Unexpected(check.error());
  }
  auto data = std::make_unique<Data>();
  try {
    if (auto prepared = Prepare(source, options, data.get()); !prepared) {
      return Unexpected(prepared.error());
    }
  } catch (const std::bad_alloc&) {
    return Fail(ErrorCode::kOutOfResource, "there is too little memory to prepare a part",
                "contact shape", "close other programs, or choose a larger voxel");
  }
  return std::make_shared<const Shape>(std::move(data));
}

Shape::Shape(std::unique_ptr<const Data> data) : data_(std::move(data)) {}

Shape::~Shape() = default;

const spatial::Box& Shape::box_B() const noexcept {
  return data_->box_B;
}

double Shape::voxel() const noexcept {
  return data_->voxel;
}

std::size_t Shape::point_count() const noexcept {
  return data_->shell.point_count;
}

ShapeMemory Shape::CalcMemory() const noexcept {
  const Data& d = *data_;
  const Mesh& m = d.mesh;
  ShapeMemory memory;
  memory.field =
      Bytes(d.field.top) + Bytes(d.field.nodes) + Bytes(d.field.slack) + Bytes(d.field.coarse);
  memory.tables = Bytes(d.exact.faces) + Bytes(d.exact.deviation) + Bytes(d.exact.zones) +
                  Bytes(d.exact.list_begin) + Bytes(d.exact.listed) + Bytes(d.exact.list_faces) +
                  Bytes(d.exact.forms) + Bytes(d.helices) + Bytes(d.list_thread);
  memory.mesh = Bytes(m.vertices) + Bytes(m.triangles) + Bytes(m.face) + Bytes(m.normals) +
                Bytes(m.neighbour) + Bytes(m.edge_kind) + Bytes(m.vertex_kind) +
                Bytes(m.vertex_normals) + Bytes(m.vertex_faces) + Bytes(m.is_vertex_open) +
                Bytes(m.bends);
  memory.shell = sizeof(Data) + Bytes(d.shell) + Bytes(d.features);
  return memory;
}

}  // namespace hvas::contact
