#include "cli/options.h"

#include <CLI/CLI.hpp>

#include <algorithm>

#include "bench/paper_scenes.h"
#include "builtin/builtin.h"

namespace peelray {
namespace {

std::string flag_of(const SettingInfo& info) {
    return fmt::format("--{}", info.name);
}

CLI::Option* add_option(CLI::App& app, const SettingEntry& entry) {
    const SettingInfo& info = entry.info;
    const std::string flag = flag_of(info), flags = info.letter ? fmt::format("-{},{}", info.letter, flag) : flag;
    if (entry.is_flag)
        return app.add_flag_function(
            flags, [set = entry.set](int64_t count) { set(count > 0 ? "true" : "false"); }, info.help);
    const auto take = [set = entry.set, flag, expected = info.expected](const std::string& text) {
        if (!set(text)) throw CLI::ValidationError(flag, fmt::format("'{}' is not {}", text, expected));
    };
    if (info.several)
        return app
            .add_option_function<std::vector<std::string>>(
                flags,
                [take](const std::vector<std::string>& texts) { std::for_each(texts.begin(), texts.end(), take); },
                info.help)
            ->allow_extra_args(false);
    // As most programs have it, and so that a wrapper's options can be overruled.
    return app.add_option_function<std::string>(flags, take, info.help)->take_last();
}

void add_options(CLI::App& app, const SettingList& list) {
    for (const SettingEntry& entry : list) {
        const SettingInfo& info = entry.info;
        CLI::Option* option = add_option(app, entry);
        if (!info.form.empty()) option->type_name(info.form);
        const std::string preset = !info.preset.empty() ? info.preset : entry.text().value_or(info.none);
        if (!preset.empty() && !entry.is_flag) option->default_str(preset);
        if (!info.group.empty()) option->group(info.group);
        option->required(info.required);
        for (const std::string& other : info.excludes) option->excludes(app.get_option(fmt::format("--{}", other)));
        if (!info.needs.empty()) option->needs(app.get_option(fmt::format("--{}", info.needs)));
    }
}

/// Makes `app` say where several frames are to be had.
void refuse_sequence_options(CLI::App& app) {
    SequenceArguments unused;
    for (const SettingEntry& entry : sequence_settings(unused))
        app.add_option_function<std::vector<std::string>>(
               flag_of(entry.info),
               [flag = flag_of(entry.info)](const std::vector<std::string>&) {
                   throw CLI::ValidationError(
                       flag, "a comparison shows one moment (--time); several frames are for 'peelray render'");
               })
            ->expected(0, 1)
            ->group("");
}

/// What belongs together although each option is well-formed. Throws CLI::ValidationError.
void check_bench_usage(const BenchArguments& a) {
    if (!a.paper) return;
    const auto is_of_paper = [](const std::string& name) {
        const auto& scenes = paper_scenes();
        return std::any_of(scenes.begin(), scenes.end(), [&](const PaperScene& scene) { return scene.name == name; });
    };
    if (!std::all_of(a.scenes.begin(), a.scenes.end(), is_of_paper))
        throw CLI::ValidationError(
            "--scenes", fmt::format("'{}' is not a list out of bunny,car,dragon,igea,tiny, each once (--paper)",
                                    print_text(a.scenes)));
    if (std::find(a.ldc.begin(), a.ldc.end(), std::nullopt) != a.ldc.end())
        throw CLI::ValidationError(
            "--ldc", "'auto' is not a list of numbers such as 512,1024, each once, as --paper needs them");
}

}  // namespace

std::string builtin_list() {
    std::string text = "Built-in scenes:\n";
    for (const BuiltinScene& scene : builtin_scenes())
        text += fmt::format("  builtin:{:<10} {}\n", scene.name, scene.description);
    return text;
}

const char* const kSceneHelp = "a file (.gltf, .glb, .obj, .ply, .stl, .off) or builtin:NAME";

CLI::App* add_render(CLI::App& program, RenderArguments& a) {
    CLI::App& app = *program.add_subcommand("render", "Render a scene to a picture, several or a video");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    add_options(app, options_of(a));
    app.footer(builtin_list() +
               "\nExamples:\n"
               "  peelray render builtin:teapots -o teapots.png --spp 16\n"
               "  peelray render model.glb -o picture.png --env studio.hdr --eye 2,1,3 --look 0,0.5,0\n"
               "  peelray render bunny.off -o mirror.png --material mirror --floor --stats stats.json\n"
               "  peelray render walk.glb -o walk.mp4 --frames 0:90 --floor\n"
               "  peelray render bunny.off -o turn_%03d.png --turntable 120 --resume");
    return &app;
}

CLI::App* add_compare(CLI::App& program, CompareArguments& a) {
    CLI::App& app =
        *program.add_subcommand("compare", "Render a scene with several tracers and report how they differ");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    refuse_sequence_options(app);
    add_options(app, options_of(a));
    app.footer(
        "Pictures are compared with the one of --tracer reference, or with the last one where there is none.\n\n"
        "Examples:\n"
        "  peelray compare builtin:teapots -o report.html\n"
        "  peelray compare model.glb -o report.html --tracers ldc,reference --hit exact,planar --ldc 1024");
    return &app;
}

CLI::App* add_trace(CLI::App& program, TraceArguments& a) {
    CLI::App& app = *program.add_subcommand("trace", "Trace the rays of a .npy file and write what they hit");
    app.add_option("SCENE", a.scene, kSceneHelp)->required()->type_name("");
    add_options(app, options_of(a));
    app.footer(
        "Example, with NumPy: one ray from (0, 1, 9) along -z:\n"
        "  python3 -c \"import numpy as n; n.save('rays.npy', n.array([[0,1,9,0, 0,0,-1,100]], n.float32))\"\n"
        "  peelray trace builtin:teapots --rays rays.npy --out hits.npy\n"
        "  python3 -c \"import numpy as n; print(n.load('hits.npy'))\"");
    return &app;
}

CLI::App* add_bench(CLI::App& program, BenchArguments& a) {
    CLI::App& app = *program.add_subcommand(
        "bench", "Measure: cubes, rays and frames, against rivals on the same rays; the paper's Table 1 (--paper)");
    add_options(app, options_of(a));
    app.callback([&a] { check_bench_usage(a); });
    app.footer(
        "The time of rays is withheld when the oracle, a double-precision ray tracer, finds too many answers wrong.\n\n"
        "Examples:\n"
        "  peelray bench --quick\n"
        "  peelray bench --models models --out bench.json --markdown bench.md --plots plots\n"
        "  peelray bench --scenes blob:120000,car.glb --rays mirror,shadow --ldc auto,256 --sizes none\n"
        "  peelray bench --paper --models models --out bench.json\n"
        "  peelray bench --paper --scenes bunny --builders compute --traversals voxel --ldc 256,512,1024");
    return &app;
}

bool gives_any(const CLI::App& command, const SettingList& options, bool (*of)(const SettingInfo&)) {
    return std::any_of(options.begin(), options.end(), [&](const SettingEntry& entry) {
        return of(entry.info) && command.get_option(flag_of(entry.info))->count() > 0;
    });
}

std::vector<std::string> with_implied_values(std::vector<std::string> words) {
    RenderArguments unused;
    for (const SettingEntry& entry : options_of(unused)) {
        if (entry.info.implied.empty()) continue;
        for (auto word = words.begin(); word != words.end(); ++word)
            if (*word == flag_of(entry.info) && (word + 1 == words.end() || !entry.set(word[1])))
                word = words.insert(word + 1, entry.info.implied);
    }
    return words;
}

std::vector<GivenOption> given_options(const CLI::App& compare, PictureArguments& a) {
    std::vector<GivenOption> given;
    for (const SettingEntry& entry : picture_settings(a, false)) {
        const CLI::Option* option = compare.get_option(flag_of(entry.info));
        if (option->count() == 0) continue;
        given.push_back({entry.info.name, {flag_of(entry.info)}});
        if (!entry.is_flag)
            for (const std::string& value : option->reduced_results()) given.back().words.push_back(value);
    }
    return given;
}

}  // namespace peelray
