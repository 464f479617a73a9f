// Reads the tables [[body]] of a scene: shapes, motion, and places. Private to the reader.
#pragma once

#include <vector>

#include "scene/fields.hpp"

namespace mappm {

/// Fills scene.bodies; the box and the fluid must have been read. Throws InputError.
void read_bodies(const std::vector<Fields>& tables, Scene& scene);

}  // namespace mappm
