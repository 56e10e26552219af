#include "cli/bench_rays.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <thread>

#include "base/progress.h"
#include "base/text.h"
#include "bench/embree_contender.h"
#include "bench/ray_bench.h"
#include "cli/bench.h"
#include "cli/bench_output.h"
#include "cli/bench_plots.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "cli/version.h"

namespace peelray {

using Json = nlohmann::ordered_json;

// ---- JSON

static Json set_json(const TracedSet& set) {
    const Judgement& j = set.judged;
    Json json = {{"rays", set.rays},
                 {"checked", j.checked},
                 {"wrong", j.wrong},
                 {"right_for_a_ray_beside", j.second_look},
                 {"counted", j.counted},
                 {"wrong_allowed_share", j.allowed},
                 {"withheld", j.passes() ? Json(nullptr) : Json("too many answers are wrong")}};
    json["trace_ms"] = set.counts() ? timing_json(set.time) : Json(nullptr);
    json["mrays_per_second"] = set.counts() ? Json(set.mrays_per_second()) : Json(nullptr);
    if (!set.way.empty()) json["way"] = set.way;
    if (set.costs) json["costs"] = kind_costs_json(*set.costs);
    return json;
}

Json ray_row_json(const RayRow& row) {
    const bool measured = row.left_out.empty();
    Json json = {{"scene", row.scene},
                 {"shown", row.shown},
                 {"stands_in", row.stands_in},
                 {"triangles", row.triangles ? Json(row.triangles) : Json(nullptr)},
                 {"image", {row.size.x, row.size.y}},
                 {"series", row.series ? Json("rays") : Json(nullptr)},
                 {"contender", row.is_ours() ? "ldc" : row.contender},
                 {"hit", row.hit ? Json(name_of(*row.hit)) : Json(nullptr)},
                 {"traversal", row.is_ours() ? Json(name_of(row.traversal)) : Json(nullptr)},
                 {"ldc", !row.is_ours() ? Json(nullptr)
                         : row.ldc      ? Json(*row.ldc)
                                        : Json("auto")},
                 {"n", row.resolution ? Json(row.resolution) : Json(nullptr)},
                 {"left_out", measured ? Json(nullptr) : Json(reason_text(row.left_out))},
                 {"build_ms", timing_json(row.build)},
                 {"refit_ms", timing_json(row.refit)}};
    Json sets = Json::object();
    for (const TracedSet& set : row.sets) sets[name_of(set.kind)] = set_json(set);
    json["rays"] = sets;
    const auto dynamic = row.dynamic_ms();
    json["dynamic_ms"] = dynamic ? Json(*dynamic) : Json(nullptr);
    json["frame_ms"] = timing_json(row.frame);
    if (!row.frame_left_out.empty()) json["frame_left_out"] = reason_text(row.frame_left_out);
    json["memory_bytes"] = Json::object();
    for (const auto& [name, bytes] : row.memory) json["memory_bytes"][name] = bytes;
    return json;
}

// ---- Markdown

static const char* const kUnknown = "–";

static std::string milliseconds(const Timing& timing) {
    return timing.runs ? fmt::format("{:.3f}", timing.median) : kUnknown;
}

static std::string set_cell(const TracedSet* set) {
    if (!set) return kUnknown;
    if (!set->judged.passes()) return fmt::format("wrong: {} of {}", set->judged.wrong, set->judged.counted);
    return set->time.runs ? fmt::format("{:.3f} ({:.1f})", set->time.median, set->mrays_per_second()) : kUnknown;
}

std::string ray_table_head(const std::vector<RayKind>& kinds) {
    std::string names, rule;
    for (const RayKind kind : kinds) {
        names += fmt::format(" {} |", name_of(kind));
        rule += "---:|";
    }
    return fmt::format(
        "| scene | triangles | picture | who | N | build | least to most | refit |{} dynamic | frame | MiB | note |\n"
        "|---|---:|---|---|---:|---:|---:|---:|{}---:|---:|---:|---|\n",
        names, rule);
}

std::string ray_table_row(const RayRow& row, const std::vector<RayKind>& kinds) {
    std::vector<std::string> cells = {
        row.scene,
        row.triangles ? fmt::format("{}", row.triangles) : kUnknown,
        fmt::format("{}x{}", row.size.x, row.size.y),
        row.label(),
        row.resolution ? fmt::format("{}", row.resolution) : kUnknown,
        milliseconds(row.build),
        row.build.runs ? fmt::format("{:.3f} to {:.3f}", row.build.least, row.build.most) : kUnknown,
        milliseconds(row.refit)};
    for (const RayKind kind : kinds) cells.push_back(set_cell(row.set(kind)));
    const auto dynamic = row.dynamic_ms();
    cells.push_back(dynamic ? fmt::format("{:.3f}", *dynamic) : kUnknown);
    cells.push_back(milliseconds(row.frame));
    uint64_t bytes = 0;
    for (const auto& part : row.memory) bytes += part.second;
    cells.push_back(bytes ? fmt::format("{:.1f}", double(bytes) / (1 << 20)) : kUnknown);
    std::vector<std::string> notes;
    if (row.stands_in) notes.push_back(row.shown);
    if (!row.left_out.empty()) notes.push_back("left out: " + reason_text(row.left_out));
    if (!row.frame_left_out.empty()) notes.push_back("no frame: " + reason_text(row.frame_left_out));
    cells.push_back(table_cell(fmt::format("{}", fmt::join(notes, "; "))));
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string ray_table_foot() {
    return "\nMilliseconds, medians; of rays also, in brackets, million rays per second. Who: our cubes by hit test "
           "and "
           "--ldc, or a rival on the same rays. N: voxels along the largest cube. Build: everything anew; refit: where "
           "only vertices moved. Dynamic: build, mirror and shadow rays. Frame: a whole picture, everything built "
           "anew. "
           "MiB: all structures, scratch memory included. Wrong: a time withheld, since the oracle disagrees with "
           "more of the answers checked than may be. A note that names a built-in scene: it stands in for a file that "
           "is missing.\n";
}

std::string ratio_table(const std::vector<RayRow>& rows, const std::vector<RayKind>& kinds) {
    std::string body, names, rule;
    for (const RayKind kind : kinds) {
        names += fmt::format(" {} |", name_of(kind));
        rule += "---:|";
    }
    for (const RayRow& ours : rows)
        for (const RayRow& rival : rows) {
            if (!ours.is_ours() || rival.is_ours() || !rival.left_out.empty() || !ours.left_out.empty() ||
                rival.scene != ours.scene || rival.size != ours.size || rival.series != ours.series)
                continue;
            std::vector<std::string> cells = {ours.scene, fmt::format("{}x{}", ours.size.x, ours.size.y), ours.label(),
                                              rival.label()};
            const auto ratio = [](double a, double b) { return b > 0 ? fmt::format("{:.2f}", a / b) : kUnknown; };
            for (const RayKind kind : kinds) {
                const TracedSet *a = ours.set(kind), *b = rival.set(kind);
                cells.push_back(a && b && a->counts() && b->counts() ? ratio(a->time.median, b->time.median)
                                                                     : kUnknown);
            }
            cells.push_back(ours.build.runs && rival.build.runs ? ratio(ours.build.median, rival.build.median)
                                                                : kUnknown);
            const auto a = ours.dynamic_ms(), b = rival.dynamic_ms();
            cells.push_back(a && b ? ratio(*a, *b) : kUnknown);
            body += fmt::format("| {} |\n", fmt::join(cells, " | "));
        }
    if (body.empty()) return body;
    return fmt::format(
        "\nTime of ours by that of the rival, below 1: ours is faster\n\n"
        "| scene | picture | ours | rival |{} build | dynamic |\n|---|---|---|---|{}---:|---:|\n{}",
        names, rule, body);
}

std::string costs_table(const std::vector<RayRow>& rows) {
    std::string body, names, rule;
    for (const RayCostField& field : kRayCostFields) {
        names += fmt::format(" {} |", field.name);
        rule += "---:|";
    }
    for (const RayRow& row : rows)
        for (const TracedSet& set : row.sets) {
            if (!set.costs) continue;
            body += fmt::format("| {} | {}x{} | {} | {} |", row.scene, row.size.x, row.size.y, row.label(),
                                name_of(set.kind));
            for (size_t i = 0; i < kRayCostFields.size(); i++)
                body += fmt::format(" {} / {} / {} |", set.costs->percentile(i, 0.5), set.costs->percentile(i, 0.99),
                                    set.costs->largest.*kRayCostFields[i].value);
            body += "\n";
        }
    if (body.empty()) return body;
    return fmt::format(
        "\nWhat a ray costs: 50 of 100 rays at most, 99 of 100, and the dearest\n\n"
        "| scene | picture | ours | rays |{}\n|---|---|---|---|{}\n{}",
        names, rule, body);
}

// ---- The run

static Json ray_head_json(const BenchArguments& a, const Machine& machine) {
    Json json = {{"benchmark", "rays"}};
    json.update(machine_json(machine));
    json["cpu_threads"] = std::thread::hardware_concurrency();
    json["embree"] = EmbreeContender::version();
    json["image"] = {a.size.x, a.size.y};
    json["repeat"] = a.repeat;
    for (const RayKind kind : a.rays) json["rays"].push_back(name_of(kind));
    return json;
}

void run_ray_bench(const BenchArguments& a) {
    RayBench bench(a, print_note);
    const Machine machine = bench.machine();
    BenchOutput output(a, ray_head_json(a, machine), ray_table_foot());
    output.say(fmt::format("{}, driver {}, Vulkan {}, commit {}; {} on {}; {} each\n\n{}", machine.name, machine.driver,
                           machine.api_version, build_commit(), EmbreeContender::version(),
                           counted("{} CPU thread{|s}", std::thread::hardware_concurrency()),
                           counted("{} run{|s}", a.repeat), ray_table_head(bench.kinds())));
    Progress bar("measuring", double(bench.rows()), "rows");
    std::vector<RayRow> rows;
    output.run(
        std::nullopt,
        [&] {
            bench.run(
                [&](const RayRow& row) {
                    rows.push_back(row);
                    output.add(ray_row_json(row), ray_table_row(row, bench.kinds()), row.left_out);
                },
                [&](double done) { bar.update(done); });
        },
        [&](bool) {
            output.say(ray_table_foot());
            output.say(ratio_table(rows, bench.kinds()));
            output.say(costs_table(rows));
            if (!a.plots.empty()) write_plots(a.plots, rows);
        });
}

}  // namespace peelray
