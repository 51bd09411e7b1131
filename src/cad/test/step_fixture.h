#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <Quantity_Color.hxx>
#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Trsf.hxx>

#include "base/diagnostics.h"

/** Makes small STEP files and XCAF documents for tests, in millimetres. */
namespace hvas::cad::testing {

inline const Quantity_Color kRed(1, 0, 0, Quantity_TOC_sRGB);
inline const Quantity_Color kTeal(0, 0.5, 0.5, Quantity_TOC_sRGB);

class DocumentBuilder {
 public:
  DocumentBuilder();
  ~DocumentBuilder();
  DocumentBuilder(const DocumentBuilder&) = delete;
  DocumentBuilder& operator=(const DocumentBuilder&) = delete;

  TDF_Label AddPart(const TopoDS_Shape& shape, const std::string& name);
  TDF_Label AddAssembly(const std::string& name);
  void AddComponent(const TDF_Label& assembly, const TDF_Label& definition,
                    const TopLoc_Location& location, const std::string& name);
  /** Gives a component (1 is the first) any placement, also one that AddComponent refuses. */
  void SetLocation(const TDF_Label& assembly, int component, const gp_Trsf& placement);
  void SetColor(const TDF_Label& label, const Quantity_Color& color);
  void SetFaceColor(const TDF_Label& part, const TopoDS_Shape& face, const Quantity_Color& color);
  /** The density is written as it is given. */
  void SetMaterial(const TDF_Label& part, const std::string& name, double density);
  [[nodiscard]] const Handle(TDocStd_Document) & document();
  /** @param unit As OpenCASCADE calls it: "MM", "INCH", "M". */
  void Write(const std::filesystem::path& file, const std::string& unit = "MM");

 private:
  Handle(TDocStd_Document) document_;
};

/** A 60 x 40 x 10 mm plate with a through hole of 10 mm diameter about (20, 20) along z. */
[[nodiscard]] TopoDS_Shape MakePlate();

/** How many diagnostics have this code. */
[[nodiscard]] int CountCode(const Diagnostics& diagnostics, std::string_view code);

[[nodiscard]] TopLoc_Location Translation(double x_mm, double y_mm, double z_mm);

}  // namespace hvas::cad::testing
