#include "exchange/urdf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "product/names.h"

namespace hvas::exchange {
namespace {

using product::Part;
using product::Product;

// Corners of the largest piece with a mesh of its own; a whole convex part has more, and its own
// mesh.
constexpr std::size_t kMostCorners = 64;

/** A binary STL file: 80 bytes, the number of triangles, then 50 bytes each. */
class StlWriter {
 public:
  explicit StlWriter(std::size_t triangles) : bytes_(80, ' ') {
    Append(static_cast<std::uint32_t>(triangles));
  }

  void Add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a).normalized();
    for (const Vec3& v : {normal.allFinite() ? normal : Vec3(Vec3::Zero()), a, b, c}) {
      for (int i = 0; i < 3; ++i) {
        Append(static_cast<float>(v[i]));
      }
    }
    Append(std::uint16_t{0});
  }

  [[nodiscard]] std::string Take() { return std::move(bytes_); }

 private:
  template <typename T>
  void Append(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }

  std::string bytes_;
};

std::string WritePart(const Part& part) {
  const product::Mesh& mesh = part.display_mesh;
  StlWriter stl(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    stl.Add(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  return stl.Take();
}

/** Corners of a face of a small convex piece, counterclockwise from outside: those in the plane of
 three of them; empty where the plane has corners on both sides, or fewer of them are its first. */
std::vector<Vec3> ListFace(const std::vector<Vec3>& points, std::size_t a, std::size_t b,
                           std::size_t c, double slack) {
  Vec3 normal = (points[b] - points[a]).cross(points[c] - points[a]);
  std::vector<std::size_t> on_plane;
  bool has_above = false;
  bool has_below = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = (points[i] - points[a]).dot(normal);
    has_above = has_above || height > slack;
    has_below = has_below || height < -slack;
    if (std::abs(height) <= slack) {
      on_plane.push_back(i);
    }
  }
  if (has_above == has_below || on_plane[0] != a || on_plane[1] != b || on_plane[2] != c) {
    return {};
  }
  normal = has_above ? Vec3(-normal) : normal;
  Vec3 middle = Vec3::Zero();
  for (const std::size_t i : on_plane) {
    middle += points[i] / static_cast<double>(on_plane.size());
  }
  const Vec3 x = (points[a] - middle).normalized();
  const Vec3 y = normal.cross(x).normalized();
  const auto angle_of = [&](std::size_t i) {
    return std::atan2((points[i] - middle).dot(y), (points[i] - middle).dot(x));
  };
  std::sort(on_plane.begin(), on_plane.end(),
            [&](std::size_t i, std::size_t j) { return angle_of(i) < angle_of(j); });
  std::vector<Vec3> face;
  face.reserve(on_plane.size());
  for (const std::size_t i : on_plane) {
    face.push_back(points[i]);
  }
  return face;
}

/** The hull of a few points: every three of them are tried. */
std::string WriteHull(const std::vector<Vec3>& points) {
  double size = 0;
  for (const Vec3& p : points) {
    size = std::max(size, (p - points.front()).norm());
  }
  const double slack = 1e-9 * size * size * size;  // Far above rounding, far below a thin wall.
  std::vector<std::array<Vec3, 3>> triangles;
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      for (std::size_t c = b + 1; c < points.size(); ++c) {
        const std::vector<Vec3> face = ListFace(points, a, b, c, slack);
        for (std::size_t i = 2; i < face.size(); ++i) {
          triangles.push_back({face[0], face[i - 1], face[i]});
        }
      }
    }
  }
  StlWriter stl(triangles.size());
  for (const auto& [a, b, c] : triangles) {
    stl.Add(a, b, c);
  }
  return stl.Take();
}

/** Fixed axes roll, pitch and yaw of URDF: R = Rz(yaw) Ry(pitch) Rx(roll) [rad]. */
Vec3 ToRollPitchYaw(const Quat& q) {
  const Mat3 R = q.toRotationMatrix();
  const double pitch = std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0)));
  constexpr double kUpright = 1e-9;  // The cosine of a pitch at which roll and yaw are one.
  if (std::abs(std::cos(pitch)) < kUpright) {
    return {0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  }
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::string WriteOrigin(const spatial::Pose& X) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", WriteNumbers(X.p()),
                     WriteNumbers(ToRollPitchYaw(X.q())));
}

std::string WriteInertial(const Part& part) {
  const product::MassProperties& mass = part.mass;
  const Mat3& I = mass.I_BBcm_B;
  return fmt::format(
      "    <inertial><origin xyz=\"{}\"/><mass value=\"{}\"/>"
      "<inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/></inertial>\n",
      WriteNumbers(mass.p_BoBcm_B), WriteNumber(mass.mass), WriteNumber(I(0, 0)),
      WriteNumber(I(0, 1)), WriteNumber(I(0, 2)), WriteNumber(I(1, 1)), WriteNumber(I(1, 2)),
      WriteNumber(I(2, 2)));
}

std::string WriteLink(const ExportedBody& body, const Part& part, const std::string& folder) {
  std::string text = fmt::format("  <link name=\"{}\">\n", body.name) + WriteInertial(part);
  const std::string own = fmt::format("{}/part{}.stl", folder, part.id.index());
  text += fmt::format("    <visual><geometry><mesh filename=\"{}\"/></geometry></visual>\n", own);
  for (std::size_t i = 0; i < body.form.pieces.size(); ++i) {
    const std::string file = body.form.pieces[i].size() > kMostCorners
                                 ? own
                                 : fmt::format("{}/part{}_piece{}.stl", folder, part.id.index(), i);
    text += fmt::format("    <collision><geometry><mesh filename=\"{}\"/></geometry></collision>\n",
                        file);
  }
  for (const Cylinder& cylinder : body.form.cylinders) {
    text += fmt::format(
        "    <collision>{}<geometry><cylinder radius=\"{}\" "
        "length=\"{}\"/></geometry></collision>\n",
        WriteOrigin(cylinder.X_BC), WriteNumber(cylinder.radius),
        WriteNumber(2 * cylinder.half_length));
  }
  return text + "  </link>\n";
}

std::string WriteMate(const ExportedProduct& exported, const ExportedMate& exported_mate) {
  const product::Mate& mate = exported.product->mates[exported_mate.mate.index()];
  const auto frame = [&](const char* name, const product::Connector& side) {
    return fmt::format("<{} link=\"{}\">{}</{}>", name,
                       exported.bodies[side.occurrence.index()].name, WriteOrigin(side.X_BM), name);
  };
  std::string text =
      fmt::format("  <hvas:mate name=\"{}\" kind=\"{}\" fit=\"{}\">", exported_mate.name,
                  product::ToString(mate.kind), mate.fit ? EscapeXml(mate.fit->code) : "");
  text += frame("hvas:a", mate.a) + frame("hvas:b", mate.b);
  if (exported_mate.sizes) {
    const MateSizes& sizes = *exported_mate.sizes;
    text += fmt::format(
        "<hvas:sizes hole=\"{}\" shaft=\"{}\" min_clearance=\"{}\" max_clearance=\"{}\"/>",
        WriteNumber(sizes.hole), WriteNumber(sizes.shaft), WriteNumber(sizes.min_clearance),
        WriteNumber(sizes.max_clearance));
  }
  return text + "</hvas:mate>\n";
}

}  // namespace

ExportedFiles MakeUrdf(const ExportedProduct& exported, const std::string& name) {
  const Product& product = *exported.product;
  const std::string folder = name + "_meshes";
  ExportedFiles files;
  std::string links;
  std::string joints;
  const spatial::Pose X_RW = product.occurrences[exported.base.index()].X_WB.Inverse();
  const std::string& root = exported.bodies[exported.base.index()].name;
  for (const ExportedBody& body : exported.bodies) {
    const Part& part = product.part_of(body.occurrence);
    links += WriteLink(body, part, folder);
    files.emplace(fmt::format("{}/part{}.stl", folder, part.id.index()), WritePart(part));
    for (std::size_t i = 0; i < body.form.pieces.size(); ++i) {
      if (body.form.pieces[i].size() <= kMostCorners) {
        files.emplace(fmt::format("{}/part{}_piece{}.stl", folder, part.id.index(), i),
                      WriteHull(body.form.pieces[i]));
      }
    }
    if (body.occurrence != exported.base) {
      joints += fmt::format(
          "  <joint name=\"{}_place\" type=\"floating\"><parent link=\"{}\"/><child link=\"{}\"/>{}"
          "</joint>\n",
          body.name, root, body.name,
          WriteOrigin(X_RW * product.occurrences[body.occurrence.index()].X_WB));
    }
  }
  std::string mates;
  for (const ExportedMate& mate : exported.mates) {
    mates += WriteMate(exported, mate);
  }
  files[name + ".urdf"] = fmt::format(
      "<?xml version=\"1.0\"?>\n<robot name=\"{}\" "
      "xmlns:hvas=\"urn:hvas:mates\">\n{}{}{}</robot>\n",
      EscapeXml(product.name), links, joints, mates);
  return files;
}

}  // namespace hvas::exchange
