#pragma once

#include <cstddef>
#include <string>

/** Small files that ask for much: thousands of parts at one place, assemblies of two that are
 assemblies of two, archives that unpack to gigabytes. Boxes measure 10 mm. */
namespace hvas::cad::testing {

/** 3MF whose build places one box `count` times at one place. */
[[nodiscard]] std::string MakeManyItems3mf(std::size_t count);

/** 3MF with a box, and `levels` objects of two components each: 2^levels boxes. */
[[nodiscard]] std::string MakeDoubling3mf(std::size_t levels);

/** 3MF with a box and two objects that are components of each other.
 @param is_built  Whether the build has one of them; else it has the box. */
[[nodiscard]] std::string MakeCircle3mf(bool is_built);

/** 3MF with a box below `levels` objects that each are a component of the next. */
[[nodiscard]] std::string MakeNested3mf(std::size_t levels);

/** glTF with a box and two nodes that are children of each other. */
[[nodiscard]] std::string MakeCircleGltf();

/** A STEP file of one part, with two assemblies added that use each other. @param part  As
 OpenCASCADE writes it. */
[[nodiscard]] std::string MakeCircleStep(const std::string& part);

/** 3MF with `count` boxes, `step` millimetres apart. */
[[nodiscard]] std::string MakeRow3mf(std::size_t count, double step);

/** 3MF with a box and a picture that takes so many bytes when it is unpacked. */
[[nodiscard]] std::string MakeBomb3mf(std::size_t bytes);

/** 3MF with a model whose comment takes so many bytes when it is unpacked. */
[[nodiscard]] std::string MakeBombModel3mf(std::size_t bytes);

/** glTF with `count` nodes that have one box, `step` metres apart. */
[[nodiscard]] std::string MakeManyNodesGltf(std::size_t count, double step = 0);

/** glTF with a node that has a box, and `levels` nodes that hold the one before twice. */
[[nodiscard]] std::string MakeDoublingGltf(std::size_t levels);

/** glTF with a box, and another one below `levels` nodes that each hold the next. */
[[nodiscard]] std::string MakeNestedGltf(std::size_t levels);

/** glTF with `count` boxes, each stretched otherwise, so that none can be shared. */
[[nodiscard]] std::string MakeStretchedGltf(std::size_t count);

/** OBJ with `count` objects, each the same four triangles at one place. */
[[nodiscard]] std::string MakeManyObjectsObj(std::size_t count);

/** OBJ with `count` objects of one triangle each, side by side. */
[[nodiscard]] std::string MakeManyTrianglesObj(std::size_t count);

/** Text STL with `count` solids, each the same four triangles at one place. */
[[nodiscard]] std::string MakeManySolidsStl(std::size_t count);

/** A STEP file of one part, with `levels` assemblies added that hold the one before twice.
 @param part  As OpenCASCADE writes it. */
[[nodiscard]] std::string MakeDoublingStep(const std::string& part, std::size_t levels);

}  // namespace hvas::cad::testing
