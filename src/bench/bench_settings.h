// What a benchmark measures, and how often.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "settings/settings.h"

namespace peelray {

struct BenchSettings {
    bool all = false;    ///< of the paper's: every way to build and trace
    bool quick = false;  ///< of rays: few ways
    std::vector<std::string> scenes;
    std::vector<BuilderKind> builders;
    std::vector<Traversal> traversals;
    std::vector<HitTest> hits;
    std::vector<RayKind> rays;
    std::vector<std::optional<uint32_t>> ldc;      ///< none: auto
    std::optional<std::vector<glm::uvec2>> sizes;  ///< of the series of picture sizes
    std::optional<uint32_t> refine, merge;
    glm::uvec2 block{8}, size{0};
    Routing routing = Routing::geometry;
    std::optional<double> tolerance;  ///< none: in proportion to the scene
    uint32_t repeat = 0;
    std::optional<std::filesystem::path> models;  ///< none: the folder "models", if there is one
    DeviceArguments device;
};

/// Receives how many rows are done, the current one in part.
using RowProgress = std::function<void(double rows)>;

}  // namespace peelray
