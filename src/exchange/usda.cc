#include "exchange/usda.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "product/names.h"

namespace hvas::exchange {
namespace {

using product::Part;

std::string Tuple(const Vec3& v) {
  return fmt::format("({}, {}, {})", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string Tuple(const Quat& q) {
  return fmt::format("({}, {}, {}, {})", q.w() + 0.0, q.x() + 0.0, q.y() + 0.0, q.z() + 0.0);
}

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
    }
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

std::string WritePoints(const std::vector<Vec3>& points) {
  std::string text;
  for (const Vec3& p : points) {
    text += (text.empty() ? "" : ", ") + Tuple(p);
  }
  return "[" + text + "]";
}

std::string WritePose(const spatial::Pose& X, const std::string& indent) {
  return fmt::format(
      "{0}quatd xformOp:orient = {1}\n{0}double3 xformOp:translate = {2}\n"
      "{0}uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]\n",
      indent, Tuple(X.q()), Tuple(X.p()));
}

std::string WriteMesh(const Part& part) {
  std::string counts;
  std::string indices;
  for (const auto& t : part.display_mesh.triangles) {
    counts += counts.empty() ? "3" : ", 3";
    indices += fmt::format("{}{}, {}, {}", indices.empty() ? "" : ", ", t[0], t[1], t[2]);
  }
  return fmt::format(
      "        def Mesh \"shown\"\n        {{\n"
      "            int[] faceVertexCounts = [{}]\n            int[] faceVertexIndices = [{}]\n"
      "            point3d[] points = {}\n            uniform token subdivisionScheme = \"none\"\n"
      "            color3f[] primvars:displayColor = [({}, {}, {})]\n        }}\n",
      counts, indices, WritePoints(part.display_mesh.vertices), part.color.r, part.color.g,
      part.color.b);
}

// Readers make the hull of a piece from its points alone; one polygon through all is enough.
std::string WritePiece(const std::vector<Vec3>& points, std::size_t i) {
  std::string indices;
  for (std::size_t k = 0; k < points.size(); ++k) {
    indices += fmt::format("{}{}", k == 0 ? "" : ", ", k);
  }
  return fmt::format(
      "        def Mesh \"met{}\" (prepend apiSchemas = [\"PhysicsCollisionAPI\", "
      "\"PhysicsMeshCollisionAPI\"])\n        {{\n"
      "            uniform token purpose = \"guide\"\n"
      "            uniform token physics:approximation = \"convexHull\"\n"
      "            int[] faceVertexCounts = [{}]\n            int[] faceVertexIndices = [{}]\n"
      "            point3d[] points = {}\n        }}\n",
      i, points.size(), indices, WritePoints(points));
}

std::string WriteCylinder(const Cylinder& cylinder, std::size_t i) {
  return fmt::format(
             "        def Cylinder \"cylinder{}\" (prepend apiSchemas = "
             "[\"PhysicsCollisionAPI\"])\n        {{\n"
             "            uniform token purpose = \"guide\"\n"
             "            uniform token axis = \"Z\"\n            double radius = {}\n"
             "            double height = {}\n",
             i, WriteNumber(cylinder.radius), WriteNumber(2 * cylinder.half_length)) +
         WritePose(cylinder.X_BC, "            ") + "        }\n";
}

std::string WritePrototype(const Part& part, const CollisionForm& form) {
  std::string text = fmt::format("    class Xform \"part{}\"\n    {{\n", part.id.index());
  if (!part.display_mesh.triangles.empty()) {
    text += WriteMesh(part);
  }
  for (std::size_t i = 0; i < form.pieces.size(); ++i) {
    text += WritePiece(form.pieces[i], i);
  }
  for (std::size_t i = 0; i < form.cylinders.size(); ++i) {
    text += WriteCylinder(form.cylinders[i], i);
  }
  return text + "    }\n";
}

std::string WriteMass(const Part& part) {
  const product::MassProperties& mass = part.mass;
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(mass.I_BBcm_B);
  Mat3 axes = principal.eigenvectors();
  if (axes.determinant() < 0) {
    axes.col(2) = -axes.col(2);
  }
  return fmt::format(
      "        float physics:mass = {}\n        point3f physics:centerOfMass = {}\n"
      "        float3 physics:diagonalInertia = {}\n        quatf physics:principalAxes = {}\n",
      WriteNumber(mass.mass), Tuple(mass.p_BoBcm_B), Tuple(Vec3(principal.eigenvalues())),
      Tuple(Quat(axes).normalized()));
}

std::string WriteMate(const ExportedProduct& exported, const ExportedMate& exported_mate) {
  const product::Product& product = *exported.product;
  const product::Mate& mate = product.mates[exported_mate.mate.index()];
  const spatial::Pose X_WM = product.occurrences[mate.a.occurrence.index()].X_WB * mate.a.X_BM;
  std::string text = fmt::format(
      "    def Xform \"{}\"\n    {{\n        custom token hvas:kind = \"{}\"\n"
      "        custom rel hvas:a = </product/{}>\n        custom rel hvas:b = </product/{}>\n"
      "        custom string hvas:fit = {}\n",
      exported_mate.name, product::ToString(mate.kind),
      exported.bodies[mate.a.occurrence.index()].name,
      exported.bodies[mate.b.occurrence.index()].name, Quoted(mate.fit ? mate.fit->code : ""));
  if (exported_mate.sizes) {
    const MateSizes& sizes = *exported_mate.sizes;
    text += fmt::format(
        "        custom double hvas:hole = {}\n        custom double hvas:shaft = {}\n"
        "        custom double hvas:minClearance = {}\n"
        "        custom double hvas:maxClearance = {}\n",
        WriteNumber(sizes.hole), WriteNumber(sizes.shaft), WriteNumber(sizes.min_clearance),
        WriteNumber(sizes.max_clearance));
  }
  return text + WritePose(X_WM, "        ") + "    }\n";
}

}  // namespace

std::string MakeUsda(const ExportedProduct& exported) {
  const product::Product& product = *exported.product;
  std::string text =
      "#usda 1.0\n(\n    defaultPrim = \"product\"\n    kilogramsPerUnit = 1\n"
      "    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n\ndef Xform \"parts\"\n{\n";
  std::vector<bool> is_written(product.parts.size(), false);
  for (const ExportedBody& body : exported.bodies) {
    const Part& part = product.part_of(body.occurrence);
    if (!is_written[part.id.index()]) {
      is_written[part.id.index()] = true;
      text += WritePrototype(part, body.form);
    }
  }
  text += fmt::format("}}\n\ndef Xform \"product\" (displayName = {})\n{{\n", Quoted(product.name));
  for (const ExportedBody& body : exported.bodies) {
    const product::Occurrence& occurrence = product.occurrences[body.occurrence.index()];
    text += fmt::format(
        "    def Xform \"{}\" (\n        displayName = {}\n"
        "        prepend apiSchemas = [\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"]\n"
        "        instanceable = true\n        inherits = </parts/part{}>\n    )\n    {{\n",
        body.name, Quoted(occurrence.path), occurrence.part.index());
    if (body.occurrence == exported.base) {
      text += "        bool physics:kinematicEnabled = true\n";
    }
    text += WriteMass(product.part_of(body.occurrence)) + WritePose(occurrence.X_WB, "        ") +
            "    }\n";
  }
  text += "}\n\ndef Scope \"mates\"\n{\n";
  for (const ExportedMate& mate : exported.mates) {
    text += WriteMate(exported, mate);
  }
  return text + "}\n";
}

}  // namespace hvas::exchange
