#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <rapidcheck/Gen.h>

#include "product/product.h"

/** Products of forms that nobody drew, for the storm. A product is described by small numbers, each
 of which chooses from a table or is a number of grid steps, so that it becomes simpler when they
 get smaller: rapidcheck shrinks a case in this way. */
namespace hvas::fuzz {

/** A part: triangles as a mesh file has them. */
struct RandomPart {
  int form{0};
  int scale{0};   ///< Against the product's.
  int radius{0};  ///< Outer radius, or half the width.
  int bore{0};    ///< Inner radius.
  int length{0};
  int stretch{0};  ///< One axis of all points: by 1, by little, to nothing.
  int damage{0};   ///< What the mesh lacks.
  int name{0};
  int surface{0};  ///< Whether the file states the surfaces of its faces.
  std::uint32_t seed{0};
};

/** A subassembly. */
struct RandomNode {
  int parent{0};
  int name{0};
  int depth{0};  ///< Subassemblies with nothing else in them between it and its parent.
};

struct RandomOccurrence {
  int part{0};
  int node{0};
  int place{
      0};  ///< Relation to the part before it: on, in, beside, at its place, anywhere, far away.
  int turn{0};
  int x{0}, y{0}, z{0};
  int name{0};
};

/** An entry of the side file, about two parts. */
struct RandomStatement {
  int list{0};
  int a{0}, b{0};
  int face_a{0}, face_b{0};
  int choice{0};
};

struct RandomProduct {
  int scale{0};
  int name{0};
  std::vector<RandomPart> parts;
  std::vector<RandomNode> nodes;
  std::vector<RandomOccurrence> occurrences;
  std::vector<RandomStatement> statements;
  int options{
      0};  ///< Which part comes first, which is the base, what may not yield, a fit for all.
};

/** Generates products that are shrunk by fewer parts and smaller numbers. */
[[nodiscard]] rc::Gen<RandomProduct> GenerateProduct();

/** Builds the product as the readers of mesh files do (cad::BuildTrianglePart, cad::ProductTree).
 Errors of the readers leave parts out. */
[[nodiscard]] product::Product Build(const RandomProduct& random);

/** Writes what is stated of a product to the side file of `file`; nothing where nothing is stated.
 */
void WriteSideFile(const RandomProduct& random, const product::Product& product,
                   const std::filesystem::path& file);

/** A name by its number: of every kind that files have. */
[[nodiscard]] std::string MakeName(int number);

/** Describes a case in full, as text. */
[[nodiscard]] std::string Describe(const RandomProduct& random);

}  // namespace hvas::fuzz
