#pragma once

#include <deque>

#include "drawing.h"

/** Tools and fixtures for the workbench (requirement X16), as products of one part each. They stand
 on z = 0 with z up, as on a bench; a hexagon key stands with the tip of its short arm at the origin
 and its long arm along x. */
namespace hvas::products {

/** L-shaped key for hexagon sockets: arms as in ISO 2936, drawn 1 % under its nominal width.
 Nominal width across flats 3, 4, 5 or 6 [mm]. */
[[nodiscard]] Drawing DrawHexKey(int width_mm);

/** All tools: hexagon keys, and the eight that stand on the studio's bench, each with its file's
 name. */
[[nodiscard]] std::deque<Drawing> DrawTools();

}  // namespace hvas::products
