#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "contact/shape_data.h"

namespace hvas::contact {
namespace {

constexpr double kReach = 0.5;  // [m]; beyond it single precision is worse than 0.1 um.

// The origin on the axis, or on the plane, that is closest to the part.
Vec3 NearestOrigin(const spatial::Surface& surface) {
  const double height = surface.origin.dot(surface.axis);
  switch (surface.kind) {
    case spatial::SurfaceKind::kPlane:
      return height * surface.axis;
    case spatial::SurfaceKind::kCylinder:
      return surface.origin - height * surface.axis;
    default:
      return surface.origin;
  }
}

// First the sample where most faces meet, of those the one in the middle; then always the one that
// is furthest from those before it, so that as few as one likes are spread over the leaf.
std::array<std::uint8_t, 8> OrderOf(const Shell& shell, std::size_t leaf) {
  const std::size_t count = shell.leaf_count[leaf];
  std::array<Vec3, 8> p;
  std::array<std::size_t, 8> rank{};
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = 8 * leaf + i;
    p[i] = shell.point(k);
    mean += p[i] / static_cast<double>(count);
    const auto& faces = shell.faces[k].faces;
    rank[i] = static_cast<std::size_t>(
        std::count_if(faces.begin(), faces.end(), [](std::uint32_t f) { return f != kNoFace; }));
  }
  std::array<double, 8> score{};
  for (std::size_t i = 0; i < count; ++i) {
    score[i] = static_cast<double>(rank[i]) - (p[i] - mean).norm();  // Leaves are far below 1 m.
  }
  std::array<std::uint8_t, 8> order{};
  std::array<double, 8> way;
  way.fill(std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < count; ++n) {
    const auto& by = n == 0 ? score : way;
    const auto best = static_cast<std::size_t>(
        std::max_element(by.begin(), by.begin() + static_cast<std::ptrdiff_t>(count)) - by.begin());
    order[n] = static_cast<std::uint8_t>(best);
    for (std::size_t i = 0; i < count; ++i) {
      way[i] = std::min(way[i], (p[i] - p[best]).norm());
    }
    way[best] = -1;
  }
  return order;
}

void OrderLeaves(Shell* shell) {
  shell->order.clear();
  shell->rank.assign(shell->x.size(), 0);
  for (std::size_t leaf = 0; leaf < shell->leaf_count.size(); ++leaf) {
    const std::array<std::uint8_t, 8> order = OrderOf(*shell, leaf);
    shell->order.insert(shell->order.end(), order.begin(), order.end());
    for (std::size_t place = 0; place < shell->leaf_count[leaf]; ++place) {
      shell->rank[8 * leaf + order[place]] = static_cast<std::uint8_t>(place);
    }
  }
  shell->Bind();
}

/** Shell::thread of a point. */
std::uint8_t ThreadOf(const Vec3& p, const std::vector<Helix>& helices) {
  for (std::size_t i = 0; i < helices.size(); ++i) {
    const Helix& helix = helices[i];
    const HelixPoint at = Locate(helix, p);
    if (IsInThread(helix, at, helix.deviation)) {
      return static_cast<std::uint8_t>(i + 1);
    }
    // Beyond the span crests are cut off, but what is left of flanks goes on.
    constexpr double kBeyond = 1;  // Of a pitch. A choice.
    const double reach = kBeyond * helix.pitch;
    if (at.height > helix.low - reach && at.height < helix.high + reach &&
        std::abs(CalcHelixDistance(helix, at).distance) < helix.deviation) {
      return static_cast<std::uint8_t>(i + 1 + kMaxHelices);
    }
  }
  return 0;
}

/** That of the points of a leaf together. */
std::uint8_t ThreadOf(std::span<const std::uint8_t> points) {
  const std::uint8_t last = *std::max_element(points.begin(), points.end());
  const auto within = static_cast<std::uint8_t>(last > kMaxHelices ? last - kMaxHelices : last);
  const bool is_one = std::all_of(points.begin(), points.end(), [&](std::uint8_t thread) {
    return thread == last || thread == within;
  });
  return is_one ? last : 0;
}

void FindThreadPoints(const std::vector<Helix>& helices, Shell* shell) {
  shell->thread.clear();
  shell->leaf_thread.clear();
  for (std::size_t leaf = 0; !helices.empty() && leaf < shell->leaf_count.size(); ++leaf) {
    for (std::size_t k = 8 * leaf; k < 8 * leaf + 8; ++k) {
      shell->thread.push_back(ThreadOf(shell->point(k), helices));
    }
    shell->leaf_thread.push_back(
        ThreadOf(std::span(shell->thread).subspan(8 * leaf, shell->leaf_count[leaf])));
  }
}

std::vector<std::uint8_t> FindThreadLists(const Shape::Data& shape) {
  std::vector<std::uint8_t> on_thread;
  for (const Vec3& p : shape.mesh.vertices) {
    const std::uint8_t thread = ThreadOf(p, shape.helices);
    on_thread.push_back(thread <= kMaxHelices ? thread : std::uint8_t{0});
  }
  const ExactTable& exact = shape.exact;
  std::vector<std::uint8_t> threads(exact.list_begin.size() - 1);
  for (std::size_t list = 0; list < threads.size(); ++list) {
    std::vector<std::uint8_t> corners;
    for (std::size_t i = exact.list_begin[list]; i < exact.list_begin[list + 1]; ++i) {
      for (const std::uint32_t v : shape.mesh.triangles[exact.Listed(i).triangle]) {
        corners.push_back(on_thread[v]);
      }
    }
    threads[list] = corners.empty() ? std::uint8_t{0} : ThreadOf(corners);
  }
  return threads;
}

template <typename... T>
void Shrink(std::vector<T>&... vectors) {
  (vectors.shrink_to_fit(), ...);
}

// What was appended to one by one has room for more.
void Shrink(Shell* shell) {
  Shrink(shell->nodes, shell->x, shell->y, shell->z, shell->leaf_count, shell->faces, shell->facing,
         shell->triangle, shell->order, shell->rank, shell->thread, shell->leaf_thread);
  shell->Bind();
}

void Shrink(Mesh* mesh) {
  Shrink(mesh->vertices, mesh->triangles, mesh->face, mesh->normals, mesh->neighbour,
         mesh->edge_kind, mesh->vertex_kind, mesh->vertex_normals, mesh->vertex_faces,
         mesh->is_vertex_open, mesh->bends);
}

}  // namespace

FaceForm MakeFaceForm(const spatial::Surface& surface) {
  FaceForm form;
  if (surface.kind == spatial::SurfaceKind::kCone) {
    form.cosine = std::cos(surface.second);
    form.sine = std::sin(surface.second);
  }
  const Vec3 origin = NearestOrigin(surface);
  if (surface.kind == spatial::SurfaceKind::kFreeform || origin.norm() + surface.radius > kReach) {
    return form;
  }
  for (int k = 0; k < 3; ++k) {
    form.origin[k] = static_cast<float>(origin[k]);
    form.axis[k] = static_cast<float>(surface.axis[k]);
  }
  form.outward = static_cast<float>(surface.outward);
  form.kind = FaceForm::Kind::kStraight;
  switch (surface.kind) {
    case spatial::SurfaceKind::kPlane:
      form.along = 1;
      break;
    case spatial::SurfaceKind::kCylinder:
      form.across = 1;
      form.radius = static_cast<float>(surface.radius);
      break;
    case spatial::SurfaceKind::kCone:
      form.across = static_cast<float>(form.cosine);
      form.along = static_cast<float>(-form.sine);
      break;
    case spatial::SurfaceKind::kSphere:
      form.kind = FaceForm::Kind::kRound;
      form.minor = static_cast<float>(surface.radius);
      break;
    default:
      form.kind = FaceForm::Kind::kRound;
      form.radius = static_cast<float>(surface.radius);
      form.minor = static_cast<float>(surface.second);
      break;
  }
  return form;
}

void Shape::Data::Complete() {
  static std::atomic<std::uint64_t> last_serial{0};
  serial = ++last_serial;
  closest = ChooseClosestKernels().four;
  if (exact.list_faces.empty()) {  // A shape from disk has them.
    GroupLists(mesh, &exact);
  }
  exact.most_deviation = 0;
  for (std::size_t f = 0; f < exact.faces.size(); ++f) {
    if (!exact.IsFreeform(static_cast<std::uint32_t>(f))) {
      exact.most_deviation = std::max(exact.most_deviation, exact.deviation[f]);
    }
  }
  exact.forms.clear();
  for (const spatial::Surface& surface : exact.faces) {
    exact.forms.push_back(MakeFaceForm(surface));
  }
  // A file may have anything.
  std::erase_if(helices, [](const Helix& helix) {
    return helix.corners.size() < 2 || !(helix.pitch > 0) || !(helix.low < helix.high);
  });
  for (Helix& helix : helices) {
    helix.Complete();
  }
  FindThreadPoints(helices, &shell);
  FindThreadPoints(helices, &features);
  list_thread.clear();
  if (!helices.empty() && !exact.list_begin.empty()) {
    list_thread = FindThreadLists(*this);
  }
  OrderLeaves(&shell);
  OrderLeaves(&features);
  Shrink(&mesh);
  Shrink(exact.zones, exact.list_begin, exact.listed, exact.list_faces, exact.forms,
         exact.deviation, exact.faces);
  Shrink(&shell);
  Shrink(&features);
}

}  // namespace hvas::contact
