#include "cli/paper_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "cli/version.h"

namespace peelray {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const PaperScene::Time* PaperScene::at(uint32_t ldc) const {
    const auto found = std::find_if(times.begin(), times.end(), [&](const Time& time) { return time.ldc == ldc; });
    return found == times.end() ? nullptr : &*found;
}

const std::vector<PaperScene>& paper_scenes() {
    // The stand-ins bring floors of their own, and their metal mirrors already.
    static const std::vector<PaperScene> scenes = {
        {"bunny",
         "Bunny",
         8192,
         8,
         {{{512, 7, 61}, {1024, 19, 115}}},
         "bunny_7k.off",
         MaterialOverride::mirror,
         "",
         "builtin:blob:6966",
         ""},
        {"car",
         "Car",
         20264,
         12,
         {{{512, 9, 82}, {1024, 25, 250}}},
         "car2.glb",
         std::nullopt,
         "",
         "builtin:blob:47002",
         ""},
        {"dragon",
         "Dragon",
         120'000,
         7,
         {{{512, 12, 205}, {1024, 31, 441}}},
         "chinesedragon.gltf",
         MaterialOverride::mirror,
         "",
         "builtin:blob:100960",
         ""},
        {"igea",
         "Max Planck (igea)",
         300'000,
         6,
         {{{512, 19, 160}, {1024, 53, 346}}},
         "igea.ply",
         MaterialOverride::mirror,
         "",
         "builtin:blob:268686",
         ""},
        {"tiny",
         "Tiny (animation)",
         1628,
         6,
         {{{512, 5, 44}, {1024, 16, 95}}},
         "tiny.glb",
         std::nullopt,
         "Walk",
         "builtin:walker",
         "walk"},
    };
    return scenes;
}

std::optional<fs::path> find_model(const fs::path& folder, const PaperScene& scene) {
    std::error_code error;
    for (const char* below : {"", "meshes", "skinned"}) {
        const fs::path path = folder / below / scene.file;
        if (fs::is_regular_file(path, error)) return path;
    }
    return std::nullopt;
}

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back()};
}

// ---- JSON

static Json spread_json(const Spread& spread) {
    return {{"median", spread.median}, {"least", spread.least}, {"most", spread.most}};
}

Json row_json(const BenchRow& row) {
    const bool measured = row.left_out.empty();
    const auto if_measured = [&](Json value) { return measured ? std::move(value) : Json(nullptr); };
    Json json = {
        {"scene", row.scene->name},
        {"shown", row.shown},
        {"stands_in", row.stands_in},
        {"triangles", row.triangles ? Json(row.triangles) : Json(nullptr)},
        {"builder", name_of(row.builder)},
        {"traversal", name_of(row.traversal)},
        {"hit", name_of(row.hit)},
        {"n", row.ldc},
        {"tolerance", row.hit == HitTest::tolerance && row.tolerance > 0 ? Json(row.tolerance) : Json(nullptr)},
        {"object_pixels", row.object_pixels ? Json(row.object_pixels) : Json(nullptr)},
        {"left_out", measured ? Json(nullptr) : Json(row.left_out)},
        {"layers", row.layers ? Json(*row.layers) : Json(nullptr)},
        {"a_ms", if_measured(spread_json(row.a))},
        {"b_ms", if_measured(spread_json(row.b))},
        {"frame_ms", if_measured(spread_json(row.frame))}};
    Json passes = Json::array();
    for (const RenderStats::Time& pass : row.passes) passes.push_back({{"name", pass.name}, {"ms", pass.ms}});
    json["passes"] = if_measured(passes);
    json["rays"] = row.stats ? rays_json(row.stats->rays) : Json(nullptr);
    json["ldc"] = row.stats ? cubes_json(*row.stats) : Json(nullptr);
    json["memory_bytes"] = row.stats ? memory_bytes_json(row.stats->render) : Json(nullptr);
    json["paper"] = {{"triangles", row.scene->triangles}, {"layers", row.scene->layers}};
    const PaperScene::Time* time = row.scene->at(row.ldc);
    json["paper"]["a_ms"] = time ? Json(time->a_ms) : Json(nullptr);
    json["paper"]["b_ms"] = time ? Json(time->b_ms) : Json(nullptr);
    return json;
}

// ---- Markdown

/// Fit for a cell.
static std::string cell(const std::string& text) {
    std::string out;
    for (const char c : one_line(text)) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return out;
}

std::string table_head(const BenchArguments& a, const Machine& device) {
    std::string text = fmt::format(
        "{}, driver {}, Vulkan {}, commit {}; {}x{} pixels, {} frame{} each, blocks of {}x{}; GPU milliseconds, "
        "medians\n\n",
        device.name, device.driver, device.api_version, build_commit(), a.size.x, a.size.y, a.repeat,
        a.repeat == 1 ? "" : "s", a.block.x, a.block.y);
    text +=
        "| scene | triangles | builder | traversal | hits | LDIs | object | layers | A | least to most | B | least to "
        "most | "
        "paper: "
        "layers | A | B | note |\n"
        "|---|---:|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n";
    return text;
}

std::string table_row(const BenchRow& row) {
    const std::string unknown = "–";
    const bool measured = row.left_out.empty();
    const auto median = [&](const Spread& s) { return measured ? fmt::format("{:.3f}", s.median) : unknown; };
    const auto ends = [&](const Spread& s) {
        return measured ? fmt::format("{:.3f} to {:.3f}", s.least, s.most) : unknown;
    };
    const PaperScene::Time* time = row.scene->at(row.ldc);
    std::string note = row.stands_in ? row.shown : "";
    if (!measured) note += (note.empty() ? "left out: " : "; left out: ") + row.left_out;
    const auto known = [&](uint64_t number) { return number ? fmt::format("{}", number) : unknown; };
    const std::vector<std::string> cells = {row.scene->title,
                                            known(row.triangles),
                                            name_of(row.builder),
                                            name_of(row.traversal),
                                            name_of(row.hit),
                                            fmt::format("{}²", row.ldc),
                                            known(row.object_pixels),
                                            row.layers ? fmt::format("{}", *row.layers) : unknown,
                                            median(row.a),
                                            ends(row.a),
                                            median(row.b),
                                            ends(row.b),
                                            fmt::format("{}", row.scene->layers),
                                            time ? fmt::format("{}", time->a_ms) : unknown,
                                            time ? fmt::format("{}", time->b_ms) : unknown,
                                            cell(note)};
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string table_foot() {
    return "\nLDIs: of the largest cube, mostly the floor's; object: pixels along the longest side of what stands on "
           "it. "
           "Layers: samples of the fullest pixel. A: construction of the cubes, all anew. B: the rest of the frame: "
           "tracing and the final picture. The paper's own figures: GeForce 8800 GTX, 1280x1024, other meshes. A note "
           "that names "
           "a built-in scene: it stands in for a file that is missing.\n";
}

}  // namespace peelray
