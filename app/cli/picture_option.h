// `run --picture`: what a picture of the cloth shows, and how the options say it.
#pragma once

#include <optional>
#include <string>

#include "cloth/cloth_system.h"
#include "io/text_file.h"
#include "parse.h"
#include "scene/scene.h"

namespace clothlab::cli {

struct PictureArguments {
  std::string file;  ///< empty: none
  std::string view = "corner", size = "1280x960", theme = "light";
};

/// --picture, --view, --size and --theme; what they may not be is bad usage.
void add_picture(CLI::App& command, PictureArguments& arguments);

/// Writes the cloth in that state with the scene's obstacles where they are then. Precondition: the options
/// were checked.
std::optional<cloth::IoError> write_picture(const PictureArguments& arguments, const cloth::Scene& scene,
                                            const cloth::ClothSystem& system, const cloth::ClothState& state);

}  // namespace clothlab::cli
