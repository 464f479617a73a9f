// Reads a scene from TOML; the only user of the TOML library.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace mappm {

/// Reads `path`, applies `overrides` ("fluid.spacing=0.02", "body.0.radius=0.1") and checks every key, type, unit and
/// sign. Throws InputError naming file, key, value and fix.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);

/// The same from text; `name` stands for the file in messages.
Scene read_scene_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides);

/// The text of a scene file, which may be a pipe. Throws InputError where it cannot be read.
std::string scene_file_text(const std::string& path);

}  // namespace mappm
