/** What an import keeps of files, against the bare calls of OpenCASCADE: the faces that the text of
 the file has and those that OpenCASCADE transfers and the import keeps, copies counted; the box of
 the B-rep against that of the triangles; the volume of its solids against that of the triangles.
 Prints a table for the STEP files named on the command line.

   import_fidelity FILE... */
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <fmt/format.h>

#include "base/regular_file.h"
#include "base/units.h"
#include "cad/process/read_cad.h"
#include "cad/step/step_text.h"

namespace {

using hvas::Vec3;
using hvas::spatial::Box;

/** What there is of a product: copies of parts count, lengths are in metres. */
struct Content {
  std::size_t faces{0};
  Box box;
  double volume{0};
};

std::size_t CountFaceEntities(const std::filesystem::path& file) {
  const hvas::cad::StepText text(hvas::ReadRegularFile(file).value_or(std::string()));
  return static_cast<std::size_t>(
      std::count_if(text.statements().begin(), text.statements().end(), [](const auto& statement) {
        const std::size_t begin = statement.body.find_first_not_of(" \t\r\n");
        const auto rest = statement.body.substr(std::min(begin, statement.body.size()));
        return rest.rfind("ADVANCED_FACE", 0) == 0 || rest.rfind("FACE_SURFACE", 0) == 0;
      }));
}

Vec3 ToMetres(const gp_Pnt& p) {
  return hvas::units::kMetresPerMillimetre * Vec3(p.X(), p.Y(), p.Z());
}

Content ReadBare(const std::filesystem::path& file) {
  STEPCAFControl_Reader reader;
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  reader.ReadFile(std::filesystem::canonical(file).c_str());
  reader.Transfer(document);
  TDF_LabelSequence roots;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(roots);
  const BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const TDF_Label& label : roots) {
    builder.Add(all, XCAFDoc_ShapeTool::GetShape(label));
  }
  Content content;
  Bnd_Box box;
  for (TopExp_Explorer it(all, TopAbs_FACE); it.More(); it.Next()) {
    ++content.faces;
    BRepBndLib::AddOptimal(it.Current(), box, /*useTriangulation=*/false,
                           /*useShapeTolerance=*/false);
  }
  if (!box.IsVoid() && !box.IsOpen()) {
    content.box.Add(ToMetres(box.CornerMin()));
    content.box.Add(ToMetres(box.CornerMax()));
  }
  for (TopExp_Explorer it(all, TopAbs_SOLID); it.More(); it.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(it.Current(), properties);
    content.volume += hvas::units::FromMm3(std::abs(properties.Mass()));
  }
  XCAFApp_Application::GetApplication()->Close(document);
  return content;
}

/** The volume that the triangles of a part enclose. */
double CalcMeshVolume(const hvas::product::Mesh& mesh, const Vec3& about) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles) {
    six_volumes += (mesh.vertices[t[0]] - about)
                       .dot((mesh.vertices[t[1]] - about).cross(mesh.vertices[t[2]] - about));
  }
  return six_volumes / 6;
}

Content Count(const hvas::product::Product& product) {
  Content content;
  content.box = product.box_W;
  for (const auto& occurrence : product.occurrences) {
    const hvas::product::Part& part = product.part_of(occurrence.id);
    content.faces += static_cast<std::size_t>(
        std::count_if(part.faces.begin(), part.faces.end(),
                      [](const auto& face) { return face.triangle_count > 0; }));
    if (part.solid_count > 0) {
      content.volume += CalcMeshVolume(part.mesh, part.mass.p_BoBcm_B);
    }
  }
  return content;
}

/** The largest distance of a side of one box from that of the other, in diagonals [%]. */
double CompareBoxes(const Box& bare, const Box& own) {
  if (bare.is_empty() || own.is_empty()) {
    return bare.is_empty() == own.is_empty() ? 0 : 100;
  }
  const double worst = std::max((bare.low - own.low).cwiseAbs().maxCoeff(),
                                (bare.high - own.high).cwiseAbs().maxCoeff());
  return 100 * worst / std::max(bare.size().norm(), 1e-12);
}

}  // namespace

int main(int argc, char** argv) {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
  fmt::print("{:40s} {:>8s} {:>8s} {:>8s} {:>8s} {:>8s}  {}\n", "file", "in_file", "bare", "import",
             "box_%", "volume_%", "warnings");
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path file = argv[i];
    hvas::Diagnostics diagnostics;
    const auto product = hvas::cad::ReadCad(file, {}, &diagnostics);
    Interface_Static::SetCVal("read.step.codepage", "UTF8");
    const Content bare = ReadBare(file);
    const Content own = product ? Count(*product) : Content{};
    const double volume =
        bare.volume > 0 ? 100 * (own.volume - bare.volume) / bare.volume : 100 * own.volume;
    std::string codes;
    for (const hvas::Diagnostic& item : diagnostics.items()) {
      if (item.severity != hvas::Severity::kNote && codes.find(item.code) == std::string::npos) {
        codes += item.code + " ";
      }
    }
    fmt::print("{:40s} {:8d} {:8d} {:8d} {:8.3f} {:8.3f}  {}\n", file.filename().string(),
               CountFaceEntities(file), bare.faces, own.faces, CompareBoxes(bare.box, own.box),
               volume, product ? codes : product.error().message);
    std::fflush(stdout);
  }
  return 0;
}
