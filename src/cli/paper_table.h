// Table 1 of the paper: its scenes, its figures, and the table that sets ours beside them.
#pragma once

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "workspace/stats.h"

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

/// Median and ends of what was measured, milliseconds.
struct Spread {
    double median = 0, least = 0, most = 0;
};
Spread spread_of(std::vector<double> values);

/// A line of our table: a scene with one way to build and trace its cubes.
struct BenchRow {
    const PaperScene* scene = nullptr;
    std::string shown;  ///< file name or built-in scene
    bool stands_in = false;
    uint64_t triangles = 0;  ///< with the floor; 0: unknown
    BuilderKind builder = BuilderKind::compute;
    Traversal traversal = Traversal::voxel;
    HitTest hit = HitTest::exact;
    uint32_t ldc = 0;
    double tolerance = 0;            ///< world units
    std::optional<uint32_t> layers;  ///< samples of the fullest pixel; none: the cube has no such order
    uint32_t object_pixels = 0;      ///< along the longest side of what stands on the floor, in its LDIs; 0: unknown
    std::string left_out;            ///< why; empty: it was measured
    Spread a, b, frame;
    std::vector<RenderStats::Time> passes;  ///< medians
    std::optional<PictureStats> stats;      ///< of the last frame
};

nlohmann::ordered_json row_json(const BenchRow& row);

/// The table as Markdown: what stands before the rows, a row, what stands behind. `device`: that measured.
std::string table_head(const BenchArguments& arguments, const Machine& device);
std::string table_row(const BenchRow& row);
std::string table_foot();

}  // namespace peelray
