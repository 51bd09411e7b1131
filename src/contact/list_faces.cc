#include "contact/list_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/shape_data.h"

namespace hvas::contact {
namespace {

constexpr double kOnFace = 1e-6;  // [m]; where two faces meet, CAD kernels are no better.

class ListReader {
 public:
  ListReader(const Mesh& mesh, const ExactTable& exact)
      : mesh_(mesh), exact_(exact), seen_(mesh.triangles.size(), 0) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const bool is_at_edge = mesh.IsRim(t, 0) || mesh.IsRim(t, 1) || mesh.IsRim(t, 2);
      is_at_edge_.push_back(is_at_edge ? 1 : 0);
    }
  }

  ListFaces Read(std::uint32_t list) {
    begin_ = exact_.list_begin[list];
    end_ = exact_.list_begin[list + 1];
    out_ = {};
    meets_ = {};
    if (!CollectFaces(list + 1)) {
      out_.count = 0;
      return out_;
    }
    if (out_.count > 1 && ReadEdges(list + 1)) {
      DecideKind();
    }
    return out_;
  }

 private:
  [[nodiscard]] std::size_t IndexOf(std::uint32_t face) const {
    return static_cast<std::size_t>(std::find(out_.faces, out_.faces + out_.count, face) -
                                    out_.faces);
  }

  bool CollectFaces(std::uint32_t mark) {
    at_edge_.clear();
    std::uint32_t last = kNoFace;
    for (std::size_t i = begin_; i < end_; ++i) {
      const std::uint32_t t = exact_.Listed(i).triangle;
      if (is_at_edge_[t] != 0) {
        seen_[t] = mark;
        at_edge_.push_back(t);
      }
      const std::uint32_t face = mesh_.face[t];
      if (face == last || IndexOf(face) < out_.count) {
        continue;
      }
      last = face;
      if (out_.count == ListFaces::kMost) {
        return false;
      }
      out_.faces[out_.count++] = static_cast<std::uint16_t>(face);
    }
    return true;
  }

  // What edge is closest to a point of the zone has the triangles on both sides in the list; the
  // others are somewhere else.
  bool ReadEdges(std::uint32_t mark) {
    for (const std::uint32_t t : at_edge_) {
      const std::size_t a = IndexOf(mesh_.face[t]);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = mesh_.neighbour[t][k];
        const EdgeKind kind = mesh_.edge_kind[t][k];
        if (kind == EdgeKind::kOpen) {
          return false;
        }
        if (other == kNoFace || seen_[other] != mark) {
          continue;
        }
        const std::size_t b = IndexOf(mesh_.face[other]);
        if (kind == EdgeKind::kSmooth && a == b) {
          continue;
        }
        if (kind == EdgeKind::kSmooth || a == b) {
          return false;
        }
        const auto bit = static_cast<std::uint8_t>(kind == EdgeKind::kConvex ? 1U : 2U);
        meets_[a][b] = static_cast<std::uint8_t>(meets_[a][b] | bit);
      }
    }
    return true;
  }

  // 1 where all of the list's triangles of face b lie inside face a or on it, 2 where outside, 0
  // where on it, else 3.
  [[nodiscard]] std::uint8_t SideOf(std::size_t a, std::size_t b) const {
    unsigned bits = 0;
    for (std::size_t i = begin_; i < end_; ++i) {
      const std::uint32_t t = exact_.Listed(i).triangle;
      if (mesh_.face[t] != out_.faces[b]) {
        continue;
      }
      for (const std::uint32_t v : mesh_.triangles[t]) {
        const auto at = spatial::CalcDistance(exact_.faces[out_.faces[a]], mesh_.vertices[v]);
        const bool is_on = at.is_valid && std::abs(at.distance) < kOnFace;
        bits |= is_on ? 0U : at.is_valid && at.distance < 0 ? 1U : at.is_valid ? 2U : 3U;
      }
    }
    return static_cast<std::uint8_t>(bits);
  }

  void DecideKind() {
    std::uint8_t all = 0;
    for (std::size_t a = 0; a < out_.count; ++a) {
      if (exact_.faces[out_.faces[a]].kind == spatial::SurfaceKind::kFreeform) {
        return;
      }
      for (std::size_t b = 0; b < a; ++b) {
        auto bits = static_cast<std::uint8_t>(meets_[a][b] | meets_[b][a]);
        if (bits == 0) {  // Two sides of a wall, or of a gap.
          bits = static_cast<std::uint8_t>(SideOf(a, b) | SideOf(b, a));
        }
        if (bits != 1 && bits != 2) {
          return;
        }
        all = static_cast<std::uint8_t>(all | bits);
      }
    }
    if (all == 1) {
      out_.kind = ListFaces::Kind::kIntersection;
    } else if (all == 2) {
      out_.kind = ListFaces::Kind::kUnion;
    }
  }

  const Mesh& mesh_;
  const ExactTable& exact_;
  std::vector<std::uint8_t> is_at_edge_;  // Of each triangle.
  std::vector<std::uint32_t> at_edge_;    // Of this list.
  std::vector<std::uint32_t> seen_;  // Of each triangle, the last list that it was in, and one.
  std::size_t begin_{0};
  std::size_t end_{0};
  ListFaces out_;
  std::array<std::array<std::uint8_t, ListFaces::kMost>, ListFaces::kMost> meets_{};
};

// Sorts a list's entries by the order of its faces.
void Group(const Mesh& mesh, std::uint32_t list, ExactTable* exact) {
  ListFaces& faces = exact->list_faces[list];
  const std::size_t begin = exact->list_begin[list];
  const std::size_t end = exact->list_begin[list + 1];
  if (end - begin > std::numeric_limits<std::uint16_t>::max()) {
    faces = {};
  }
  std::vector<std::uint32_t> sorted;
  for (std::size_t k = 0; k < faces.count; ++k) {
    faces.begin[k] = static_cast<std::uint16_t>(sorted.size());
    for (std::size_t i = begin; i < end; ++i) {
      if (mesh.face[exact->Listed(i).triangle] == faces.faces[k]) {
        sorted.push_back(exact->listed[i]);
      }
    }
  }
  std::copy(sorted.begin(), sorted.end(),
            exact->listed.begin() + static_cast<std::ptrdiff_t>(begin));
}

}  // namespace

void GroupLists(const Mesh& mesh, ExactTable* exact) {
  exact->list_faces.clear();
  ListReader reader(mesh, *exact);
  for (std::uint32_t list = 0; list + 1 < exact->list_begin.size(); ++list) {
    exact->list_faces.push_back(reader.Read(list));
    Group(mesh, list, exact);
  }
}

}  // namespace hvas::contact
