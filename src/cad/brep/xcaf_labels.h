#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <NCollection_DataMap.hxx>
#include <TDF_Label.hxx>
#include <TDocStd_Document.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>

#include "cad/step/material.h"
#include "product/product.h"

/** What the labels of an XCAF document say besides shapes and places. */
namespace hvas::cad {

using FaceColors = NCollection_DataMap<TopoDS_Shape, product::Color, TopTools_ShapeMapHasher>;

/** A label's name in valid UTF-8 without surrounding blanks; may be empty. */
[[nodiscard]] std::string NameOf(const TDF_Label& label);

/** The name of an instance: its own; that of what it is an instance of, where a program made its
 own up; "part" where there is neither. */
[[nodiscard]] std::string InstanceName(const TDF_Label& component, const TDF_Label& definition);

/** A label's own colour. */
[[nodiscard]] std::optional<product::Color> ColorOf(const TDF_Label& label);

struct PartColors {
  std::optional<product::Color> part;  ///< The definition's, or that of its first coloured solid.
  FaceColors faces;                    ///< Where a face, shell or solid has one of its own.
};

[[nodiscard]] PartColors CollectColors(const TDF_Label& definition);

/** The material of a definition or of a shape in it; nothing where there is none. */
[[nodiscard]] std::optional<StatedMaterial> FindStatedMaterial(const TDF_Label& definition);

}  // namespace hvas::cad
