#include "truth.h"

#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

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
  Json counts;
  json["mates"] = FindAllMates(placed, ReferenceNames(placed), counts);
  json["mate_counts"] = counts;
  return Format(json);
}

std::string WriteAssignments(const Drawing& drawing) {
  return Format({{"format", "hvas-assignments-1"}, {"fits", DescribeFits(drawing, false)}});
}

void WriteProduct(const Drawing& drawing, const std::string& folder) {
  const std::string stem = folder + "/" + drawing.name;
  WriteStep(drawing, stem + ".step");
  WriteText(stem + ".truth.json", WriteTruth(drawing));
  WriteText(stem + ".hvas.json", WriteAssignments(drawing));
}

}  // namespace hvas::products
