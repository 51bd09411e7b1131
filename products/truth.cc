#include "truth.h"

#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Lin.hxx>
#include <gp_Pln.hxx>
#include <gp_Vec.hxx>
#include <nlohmann/json.hpp>

#include "relations.h"

namespace hvas::products {
namespace {

using Json = nlohmann::ordered_json;

/** Decimals that a truth file keeps; far below what any reader is asked for. */
double Round(double value, double steps_per_unit) {
  return std::round(value * steps_per_unit) / steps_per_unit;
}

/** An object with one line for each key, and one for each entry of a list of objects. */
std::string Format(const Json& json) {
  std::string text = "{\n";
  bool is_first = true;
  for (const auto& [key, value] : json.items()) {
    if (!is_first) text += ",\n";
    is_first = false;
    text += "  \"" + key + "\": ";
    if (!value.is_array() || value.empty() || !value.front().is_object()) {
      text += value.dump();
      continue;
    }
    text += "[\n";
    for (std::size_t i = 0; i < value.size(); ++i) {
      text += "    " + value[i].dump() + (i + 1 < value.size() ? ",\n" : "\n");
    }
    text += "  ]";
  }
  return text + "\n}\n";
}

Json DescribeMate(const DrawnMate& mate, const std::string& a, const std::string& b) {
  Json json;
  if (mate.kind == DrawnMate::Kind::kFaceFace) {
    json["kind"] = "face_face";
    json["a"] = a;
    json["b"] = b;
    json["area_mm2"] = Round(mate.overlap_area, 1e3);
    return json;
  }
  json["kind"] = "axis_hole";
  json["a"] = mate.a_is_hole ? a : b;
  json["b"] = mate.a_is_hole ? b : a;
  json["diameter_mm"] = Round(mate.hole_diameter, 1e6);
  json["clearance_mm"] = Round(mate.hole_diameter - mate.shaft_diameter, 1e6) + 0.0;
  json["overlap_mm"] = Round(mate.overlap_length, 1e6);
  return json;
}

Json DescribeParts(const Drawing& drawing, const std::vector<PlacedPart>& placed) {
  std::map<const PartDefinition*, int> counts;
  for (const PlacedPart& p : placed)
    ++counts[p.part];
  Json parts = Json::array();
  for (const PartDefinition& part : drawing.parts) {
    parts.push_back({{"name", part.name},
                     {"count", counts[&part]},
                     {"volume_mm3", Round(part.solid.volume_mm3, 1e4)},
                     {"material", part.material.name},
                     {"density_kg_m3", part.material.density_kg_m3}});
  }
  return parts;
}

Json FindAllMates(const std::vector<PlacedPart>& placed, const std::vector<std::string>& names,
                  Json& counts) {
  Relations relations;
  Json mates = Json::array();
  int axis_hole = 0, in_contact = 0, face_face = 0;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      if (!relations.BoxesOverlap(placed[i], placed[j], 1e-5)) continue;
      for (const DrawnMate& mate : relations.FindMates(placed[i], placed[j])) {
        mates.push_back(DescribeMate(mate, names[i], names[j]));
        const bool is_axis = mate.kind == DrawnMate::Kind::kAxisHole;
        axis_hole += is_axis ? 1 : 0;
        face_face += is_axis ? 0 : 1;
        in_contact += is_axis && mate.hole_diameter - mate.shaft_diameter < 1e-5 ? 1 : 0;
      }
    }
  }
  counts = {{"axis_hole", axis_hole}, {"axis_hole_nominal", in_contact}, {"face_face", face_face}};
  return mates;
}

Json DescribeFits(const Drawing& drawing, bool with_threads) {
  Json fits = Json::array();
  for (const DrawnFit& fit : drawing.fits) {
    if (fit.code == "thread" && !with_threads) continue;
    fits.push_back({{"hole", fit.hole},
                    {"shaft", fit.shaft},
                    {"diameter_mm", fit.diameter_mm},
                    {"fit", fit.code}});
  }
  return fits;
}

/** The number of a face as a reader of the file counts it: in the order of the solid. */
int FindFaceNumber(const TopoDS_Shape& shape, const DrawnSurface& surface) {
  constexpr double kClose = 1e-6;  // [mm]
  const auto& [x, y, z] = surface.point_mm;
  const TopoDS_Shape point = BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, z)).Vertex();
  const gp_Dir axis(surface.axis[0], surface.axis[1], surface.axis[2]);
  int number = 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next(), ++number) {
    const TopoDS_Face face = TopoDS::Face(at.Current());
    const BRepAdaptor_Surface geometry(face);
    const double distance = BRepExtrema_DistShapeShape(point, face).Value();
    if (surface.diameter_mm == 0 && geometry.GetType() == GeomAbs_Plane) {
      gp_Dir normal = geometry.Plane().Axis().Direction();
      if (!geometry.Plane().Direct()) normal.Reverse();
      if (face.Orientation() == TopAbs_REVERSED) normal.Reverse();
      if (distance < kClose && normal.IsEqual(axis, kClose)) return number;
    } else if (surface.diameter_mm > 0 && geometry.GetType() == GeomAbs_Cylinder) {
      const gp_Cylinder cylinder = geometry.Cylinder();
      const bool is_on_axis = gp_Lin(cylinder.Axis()).Distance(gp_Pnt(x, y, z)) < kClose;
      if (is_on_axis && std::abs(2 * cylinder.Radius() - surface.diameter_mm) < kClose &&
          std::abs(2 * distance - surface.diameter_mm) < kClose)
        return number;
    }
  }
  throw std::runtime_error("no such face of " + surface.occurrence);
}

Json DescribeUserMates(const Drawing& drawing) {
  const std::vector<PlacedPart> placed = Flatten(drawing);
  const auto side = [&placed](const DrawnSurface& surface) {
    for (const PlacedPart& p : placed) {
      if (p.name == surface.occurrence)
        return Json{{"occurrence", p.name}, {"face", FindFaceNumber(p.part->solid.shape, surface)}};
    }
    throw std::runtime_error("no such part: " + surface.occurrence);
  };
  Json mates = Json::array();
  for (const DrawnUserMate& mate : drawing.mates) {
    Json json{{"a", side(mate.a)}, {"b", side(mate.b)}};
    if (!mate.fit.empty()) json["fit"] = mate.fit;
    mates.push_back(json);
  }
  return mates;
}

/** Places by design, where the file has others. */
Json DescribeAssembled(const Drawing& drawing, const std::vector<PlacedPart>& placed) {
  Json assembled = Json::array();
  for (std::size_t i = 0; i < drawing.assembled.size(); ++i) {
    const gp_XYZ p = drawing.assembled[i].TranslationPart();
    const gp_Vec z = gp_Vec(0, 0, 1).Transformed(drawing.assembled[i]);
    assembled.push_back({{"occurrence", placed[i].name},
                         {"position_mm", {Round(p.X(), 1e9), Round(p.Y(), 1e9), Round(p.Z(), 1e9)}},
                         {"z", {Round(z.X(), 1e9), Round(z.Y(), 1e9), Round(z.Z(), 1e9)}}});
  }
  return assembled;
}

void WriteText(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

}  // namespace

std::vector<std::string> ReferenceNames(const std::vector<PlacedPart>& placed) {
  std::set<std::string> names;
  for (const PlacedPart& p : placed)
    names.insert(p.name);
  const bool is_unique = names.size() == placed.size();
  std::vector<std::string> references;
  references.reserve(placed.size());
  for (const PlacedPart& p : placed)
    references.push_back(is_unique ? p.name : p.path);
  return references;
}

std::string WriteTruth(const Drawing& drawing) {
  const std::vector<PlacedPart> placed = Flatten(drawing);
  double volume_mm3 = 0, mass_kg = 0;
  for (const PlacedPart& p : placed) {
    volume_mm3 += p.part->solid.volume_mm3;
    mass_kg += p.part->solid.volume_mm3 * 1e-9 * p.part->material.density_kg_m3;
  }
  Json json;
  json["format"] = "hvas-truth-1";
  json["product"] = drawing.name;
  json["occurrences"] = placed.size();
  json["unique_parts"] = drawing.parts.size();
  json["depth"] = CalcDepth(drawing);
  json["volume_mm3"] = Round(volume_mm3, 1e3);
  json["mass_kg"] = Round(mass_kg, 1e9);
  json["parts"] = DescribeParts(drawing, placed);
  json["mate_counts"] = nullptr;  // Keeps its place.
  json["fits"] = DescribeFits(drawing, /*with_threads=*/true);
  json["order"] = Json::array();
  for (const AssemblyStep& step : drawing.order) {
    json["order"].push_back({{"occurrence", step.occurrence}, {"direction", step.direction}});
  }
  std::vector<PlacedPart> assembled = placed;
  if (!drawing.assembled.empty()) {
    json["assembled"] = DescribeAssembled(drawing, placed);
    for (std::size_t i = 0; i < assembled.size(); ++i)
      assembled[i].X_WB = drawing.assembled[i];
  }
  Json counts;
  json["mates"] = FindAllMates(assembled, ReferenceNames(placed), counts);
  json["mate_counts"] = counts;
  return Format(json);
}

std::string WriteAssignments(const Drawing& drawing) {
  if (!drawing.mates.empty()) {
    return Format({{"format", "hvas-assignments-2"}, {"mates", DescribeUserMates(drawing)}});
  }
  return Format({{"format", "hvas-assignments-1"}, {"fits", DescribeFits(drawing, false)}});
}

void WriteProduct(const Drawing& drawing, const std::string& folder) {
  const std::string stem = folder + "/" + drawing.name;
  WriteStep(drawing, stem + ".step");
  WriteText(stem + ".truth.json", WriteTruth(drawing));
  WriteText(stem + ".hvas.json", WriteAssignments(drawing));
}

}  // namespace hvas::products
