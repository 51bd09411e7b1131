#include "exchange/mjcf.h"

#include <fmt/format.h>

#include "product/names.h"

namespace hvas::exchange {
namespace {

using product::Part;
using product::Product;

std::string JoinVertices(const std::vector<Vec3>& vertices) {
  std::string text;
  for (const Vec3& p : vertices) {
    text += (text.empty() ? "" : " ") + WriteNumbers(p);
  }
  return text;
}

// Pieces are a part's, in its frame: all of its bodies share them.
std::string PieceName(const Part& part, std::size_t piece) {
  return fmt::format("part{}_piece{}", part.id.index(), piece);
}

std::string WriteAssets(const ExportedProduct& exported) {
  const Product& product = *exported.product;
  std::string text;
  std::vector<bool> is_written(product.parts.size(), false);
  for (const ExportedBody& body : exported.bodies) {
    const Part& part = product.part_of(body.occurrence);
    if (is_written[part.id.index()]) {
      continue;
    }
    is_written[part.id.index()] = true;
    if (!part.display_mesh.triangles.empty()) {
      std::string faces;
      for (const auto& t : part.display_mesh.triangles) {
        faces += fmt::format("{}{} {} {}", faces.empty() ? "" : " ", t[0], t[1], t[2]);
      }
      text += fmt::format("    <mesh name=\"part{}\" vertex=\"{}\" face=\"{}\"/>\n",
                          part.id.index(), JoinVertices(part.display_mesh.vertices), faces);
    }
    for (std::size_t i = 0; i < body.form.pieces.size(); ++i) {
      text += fmt::format("    <mesh name=\"{}\" vertex=\"{}\"/>\n", PieceName(part, i),
                          JoinVertices(body.form.pieces[i]));
    }
  }
  return text;
}

std::string WriteInertia(const Part& part) {
  constexpr double kLeastMass = 1e-4;     // [kg], of what has none: a choice.
  constexpr double kLeastInertia = 1e-9;  // [kg m^2], of a ball of 1 cm with that: 2/5 m r^2.
  const product::MassProperties& mass = part.mass;
  if (mass.mass < kLeastMass) {
    return fmt::format("<inertial pos=\"{}\" mass=\"{}\" diaginertia=\"{} {} {}\"/>",
                       WriteNumbers(part.box_B.centre()), kLeastMass, kLeastInertia, kLeastInertia,
                       kLeastInertia);
  }
  const Mat3& I = mass.I_BBcm_B;
  return fmt::format("<inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>",
                     WriteNumbers(mass.p_BoBcm_B), WriteNumber(mass.mass), WriteNumber(I(0, 0)),
                     WriteNumber(I(1, 1)), WriteNumber(I(2, 2)), WriteNumber(I(0, 1)),
                     WriteNumber(I(0, 2)), WriteNumber(I(1, 2)));
}

std::string WriteBody(const ExportedProduct& exported, const ExportedBody& body) {
  const Product& product = *exported.product;
  const product::Occurrence& occurrence = product.occurrences[body.occurrence.index()];
  const Part& part = product.part_of(body.occurrence);
  std::string text =
      fmt::format("    <body name=\"{}\" pos=\"{}\" quat=\"{}\">\n", body.name,
                  WriteNumbers(occurrence.X_WB.p()), WriteNumbers(occurrence.X_WB.q()));
  if (body.occurrence != exported.base) {
    text += fmt::format("      <freejoint name=\"{}\"/>\n", body.name);
  }
  text += "      " + WriteInertia(part) + "\n";
  if (!part.display_mesh.triangles.empty()) {
    text += fmt::format(
        "      <geom class=\"seen\" type=\"mesh\" mesh=\"part{}\" rgba=\"{} {} {} 1\"/>\n",
        part.id.index(), part.color.r, part.color.g, part.color.b);
  }
  for (std::size_t i = 0; i < body.form.pieces.size(); ++i) {
    text +=
        fmt::format("      <geom class=\"met\" type=\"mesh\" mesh=\"{}\"/>\n", PieceName(part, i));
  }
  for (const Cylinder& cylinder : body.form.cylinders) {
    text += fmt::format(
        "      <geom class=\"met\" type=\"cylinder\" size=\"{} {}\" pos=\"{}\" quat=\"{}\"/>\n",
        WriteNumber(cylinder.radius), WriteNumber(cylinder.half_length),
        WriteNumbers(cylinder.X_BC.p()), WriteNumbers(cylinder.X_BC.q()));
  }
  for (const ExportedMate& exported_mate : exported.mates) {
    const product::Mate& mate = product.mates[exported_mate.mate.index()];
    for (const auto& [side, letter] : {std::pair{&mate.a, 'a'}, std::pair{&mate.b, 'b'}}) {
      if (side->occurrence == body.occurrence) {
        text +=
            fmt::format("      <site name=\"{}_{}\" pos=\"{}\" quat=\"{}\"/>\n", exported_mate.name,
                        letter, WriteNumbers(side->X_BM.p()), WriteNumbers(side->X_BM.q()));
      }
    }
  }
  return text + "    </body>\n";
}

std::string WriteMates(const ExportedProduct& exported) {
  std::string text;
  for (const ExportedMate& exported_mate : exported.mates) {
    const product::Mate& mate = exported.product->mates[exported_mate.mate.index()];
    text += fmt::format("    <text name=\"{}\" data=\"{}{}{}\"/>\n", exported_mate.name,
                        product::ToString(mate.kind), mate.fit ? " " : "",
                        mate.fit ? EscapeXml(mate.fit->code) : "");
    if (exported_mate.sizes) {
      const MateSizes& sizes = *exported_mate.sizes;
      text += fmt::format("    <numeric name=\"{}_sizes\" data=\"{} {} {} {}\"/>\n",
                          exported_mate.name, WriteNumber(sizes.hole), WriteNumber(sizes.shaft),
                          WriteNumber(sizes.min_clearance), WriteNumber(sizes.max_clearance));
    }
  }
  return text;
}

}  // namespace

std::string MakeMjcf(const ExportedProduct& exported) {
  std::string bodies;
  for (const ExportedBody& body : exported.bodies) {
    bodies += WriteBody(exported, body);
  }
  const std::string mates = WriteMates(exported);
  // Contact as stiff as a step of 1 ms can bear; friction of dry steel.
  return fmt::format(R"(<mujoco model="{}">
  <compiler angle="radian"/>
  <option timestep="0.001" cone="elliptic"/>
  <size njmax="8000" nconmax="2000"/>
  <default>
    <default class="seen"><geom group="2" contype="0" conaffinity="0" mass="0"/></default>
    <default class="met"><geom group="3" mass="0" condim="3" friction="0.15 0.005 0.0001" solref="0.004 1" solimp="0.95 0.99 0.0001"/></default>
    <site size="0.0005" group="4"/>
  </default>
  <asset>
{}  </asset>
  <worldbody>
    <light pos="0 0 2" dir="0 0 -1" directional="true"/>
{}  </worldbody>
{}</mujoco>
)",
                     EscapeXml(exported.product->name), WriteAssets(exported), bodies,
                     mates.empty() ? "" : "  <custom>\n" + mates + "  </custom>\n");
}

}  // namespace hvas::exchange
