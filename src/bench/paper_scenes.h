// Table 1 of the paper: its scenes and its figures.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "settings/choices.h"

namespace peelray {

/// A line of the paper's table.
struct PaperScene {
    struct Time {
        uint32_t ldc;
        double a_ms, b_ms;  ///< construction of the cube; tracing and the final picture
    };
    const char* name;    ///< as --scenes takes it
    const char* title;   ///< as the paper's table has it, and what ours is
    uint32_t triangles;  ///< as the paper has it
    uint32_t layers;     ///< LDIs required, section 3
    std::array<Time, 2> times;
    const char* file;  ///< ours
    std::optional<MaterialOverride> material;
    const char* animation;                      ///< see --animation; empty: none
    const char *stand_in, *stand_in_animation;  ///< where that file is missing

    const Time* at(uint32_t ldc) const;
};

const std::vector<PaperScene>& paper_scenes();

/// Where the scene's file is: in `folder`, or in its folders meshes and skinned; none: it is missing.
std::optional<std::filesystem::path> find_model(const std::filesystem::path& folder, const PaperScene& scene);

}  // namespace peelray
