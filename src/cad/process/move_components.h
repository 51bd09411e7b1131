#pragma once

#include <map>
#include <string>

#include <TDocStd_Document.hxx>

#include "spatial/pose.h"

namespace hvas::cad {

/** Motions in the world, in metres, by the paths of occurrences as Import finds them. */
using Motions = std::map<std::string, spatial::Pose>;

/** Moves instances of parts in an XCAF document in millimetres. Every instance of a subassembly
 gets a definition of its own, so that its parts can move on their own; parts stay shared, and
 instances keep their names and colours. May throw what OpenCASCADE throws.
 @param name  Of the document's root, where it has no assembly of its own.
 @returns how many of the motions found their occurrence. */
[[nodiscard]] std::size_t MoveComponents(const opencascade::handle<TDocStd_Document>& document,
                                         const std::string& name, const Motions& motions);

}  // namespace hvas::cad
