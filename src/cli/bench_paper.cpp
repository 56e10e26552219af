// `peelray bench --paper`: Table 1 of the paper, and ours beside it.
#include <fmt/ranges.h>

#include "base/progress.h"
#include "base/text.h"
#include "bench/paper_bench.h"
#include "cli/bench.h"
#include "cli/bench_output.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "cli/version.h"

namespace peelray {

using Json = nlohmann::ordered_json;

// ---- JSON

static Json spread_json(const Timing& spread) {
    return {{"median", spread.median}, {"least", spread.least}, {"most", spread.most}};
}

static Json row_json(const PaperRow& row) {
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
        {"left_out", measured ? Json(nullptr) : Json(reason_text(row.left_out))},
        {"layers", row.layers ? Json(*row.layers) : Json(nullptr)},
        {"a_ms", if_measured(spread_json(row.a))},
        {"b_ms", if_measured(spread_json(row.b))},
        {"frame_ms", if_measured(spread_json(row.frame))}};
    Json passes = Json::array();
    for (const PassTime& pass : row.passes) passes.push_back({{"name", pass.name}, {"ms", pass.ms}});
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

static std::string paper_table_head(const BenchArguments& a, const Machine& device) {
    std::string text = fmt::format(
        "{}, driver {}, Vulkan {}, commit {}; {}x{} pixels, {} each, blocks of {}x{}; GPU milliseconds, "
        "medians\n\n",
        device.name, device.driver, device.api_version, build_commit(), a.size.x, a.size.y,
        counted("{} frame{|s}", a.repeat), a.block.x, a.block.y);
    text +=
        "| scene | triangles | builder | traversal | hits | LDIs | object | layers | A | least to most | B | least to "
        "most | "
        "paper: "
        "layers | A | B | note |\n"
        "|---|---:|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n";
    return text;
}

static std::string table_row(const PaperRow& row) {
    const std::string unknown = "–";
    const bool measured = row.left_out.empty();
    const auto median = [&](const Timing& s) { return measured ? fmt::format("{:.3f}", s.median) : unknown; };
    const auto ends = [&](const Timing& s) {
        return measured ? fmt::format("{:.3f} to {:.3f}", s.least, s.most) : unknown;
    };
    const PaperScene::Time* time = row.scene->at(row.ldc);
    std::string note = row.stands_in ? row.shown : "";
    if (!measured) note += (note.empty() ? "left out: " : "; left out: ") + reason_text(row.left_out);
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
                                            table_cell(note)};
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

static std::string table_foot() {
    return "\nLDIs: of the largest cube, mostly the floor's; object: pixels along the longest side of what stands on "
           "it. "
           "Layers: samples of the fullest pixel. A: construction of the cubes, all anew. B: the rest of the frame: "
           "tracing and the final picture. The paper's own figures: GeForce 8800 GTX, 1280x1024, other meshes. A note "
           "that names "
           "a built-in scene: it stands in for a file that is missing.\n";
}

static Json paper_head_json(const BenchArguments& a, const Machine& machine) {
    Json json = {{"benchmark", "paper"}};
    json.update(machine_json(machine));
    json["image"] = {a.size.x, a.size.y};
    json["frames"] = a.repeat;
    json["block"] = {a.block.x, a.block.y};
    json["routing"] = name_of(a.routing);
    const PictureArguments defaults;
    json["bounces"] = defaults.bounces;
    json["spp"] = defaults.spp;
    for (const Effect effect : values_of<Effect>())
        if (defaults.effects.has(effect)) json["effects"].push_back(name_of(effect));
    json["rebuild"] = true;
    return json;
}

void run_paper_bench(const BenchArguments& a) {
    PaperBench bench(a, print_note);
    BenchOutput output(a, paper_head_json(a, bench.machine()), table_foot());
    output.say(paper_table_head(a, bench.machine()));
    Progress bar("measuring", double(bench.rows()), "rows");
    output.run(
        bench.rows(),
        [&] {
            bench.run([&](const PaperRow& row) { output.add(row_json(row), table_row(row), row.left_out); },
                      [&](double rows) { bar.update(rows); });
        },
        [&](bool) { output.say(table_foot()); });
}

}  // namespace peelray
