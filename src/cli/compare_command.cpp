// `peelray compare`.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/outputs.h"
#include "cli/render_plan.h"
#include "cli/stats_json.h"
#include "cli/version.h"
#include "image/report.h"
#include "scene/encoding.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// One column of the comparison.
struct Entry {
    std::string name;
    std::optional<Tracer> tracer;  ///< none: another program's picture
    std::optional<HitTest> hit;    ///< none: auto
    fs::path file;                 ///< of another program's picture
    std::string command;
    Image8 encoded;
    Image radiance;                     ///< empty: not known
    std::optional<PictureStats> stats;  ///< none: of another program's picture
};

/// The command that renders one picture of the comparison.
std::string render_command(const CompareArguments& a, const std::string& name, Tracer tracer,
                           std::optional<HitTest> hit) {
    std::string file = name + ".png";
    std::replace(file.begin(), file.end(), ' ', '-');
    std::vector<std::string> words = {"peelray", "render", a.scene, "-o", file};
    for (const GivenOption& option : a.given)
        // --repeat measures frames of a GPU.
        if (option.name != "repeat" || !is_on_cpu(tracer))
            words.insert(words.end(), option.words.begin(), option.words.end());
    words.insert(words.end(), {"--tracer", std::string(name_of(tracer))});
    if (tracer == Tracer::ldc) words.insert(words.end(), {"--hit", name_of(hit)});
    return shell_line(words);
}

std::string compare_command(const CompareArguments& a) {
    std::string hits;
    for (const auto& hit : a.hits) hits.append(hits.empty() ? "" : ",").append(name_of(hit));
    std::vector<std::string> words = {"peelray", "compare", a.scene, "-o", a.output.string()};
    for (const GivenOption& option : a.given) words.insert(words.end(), option.words.begin(), option.words.end());
    words.insert(words.end(), {"--tracers", print_text(a.tracers), "--hit", hits});
    for (const fs::path& picture : a.pictures) words.insert(words.end(), {"--picture", picture.string()});
    return shell_line(words);
}

void check_tracing(const CompareArguments& a, Tracer tracer, std::optional<HitTest> hit) {
    TracingArguments tracing = a.tracing;
    tracing.tracer = tracer;
    tracing.hit = hit;
    check(tracing);
}

std::vector<Entry> plan(const CompareArguments& a) {
    std::vector<Entry> entries;
    for (const auto& hit : a.hits) check_tracing(a, Tracer::ldc, hit);
    const bool uses_hits = std::find(a.tracers.begin(), a.tracers.end(), Tracer::ldc) != a.tracers.end();
    if (!uses_hits && a.hits != std::vector{std::optional<HitTest>()})
        print_note("--hit has no effect without ldc among the --tracers");
    for (const Tracer tracer : a.tracers) {
        if (tracer != Tracer::ldc) {
            const char* name = name_of(tracer);
            entries.push_back({name, tracer, std::nullopt, {}, render_command(a, name, tracer, std::nullopt)});
            continue;
        }
        for (const auto& hit : a.hits) {
            const std::string name = a.hits.size() > 1 ? fmt::format("ldc {}", name_of(hit)) : "ldc";
            entries.push_back({name, tracer, hit, {}, render_command(a, name, tracer, hit)});
        }
    }
    for (const Entry& entry : entries) check_tracing(a, *entry.tracer, entry.hit);
    return entries;
}

bool is_linear(const fs::path& path) {
    return lower_extension(path) == ".exr" || lower_extension(path) == ".hdr";
}

/// A transparent picture as it is on black: reports show no alpha, and colours of what is hardly covered say little.
void put_on_black(Image8& picture) {
    for (uint32_t& pixel : picture.pixels) {
        const double alpha = (pixel >> 24) / 255.0;
        uint32_t out = 0xff000000u;
        for (int shift = 0; shift < 24; shift += 8)
            out |= uint32_t(std::lround(255 * linear_to_srgb(alpha * srgb_to_linear((pixel >> shift & 255) / 255.0))))
                   << shift;
        pixel = out;
    }
}

/// A picture that another program made.
Entry read_picture(const CompareArguments& a, const fs::path& path) {
    Entry entry{path.filename().string(), std::nullopt, std::nullopt, path,
                fmt::format("(given as --picture {})", quoted(path.string()))};
    if (is_linear(path)) {
        entry.radiance = read_hdr(path);
        const RenderSettings settings = render_settings(a);
        entry.encoded = {entry.radiance.width, entry.radiance.height, {}};
        for (const glm::vec4& pixel : entry.radiance.pixels)
            entry.encoded.pixels.push_back(encode(glm::dvec3(pixel), settings.exposure, settings.tonemap));
    } else {
        entry.encoded = read_ldr(path);
    }
    if (a.is_transparent() && !is_linear(path)) put_on_black(entry.encoded);
    const Image8& picture = entry.encoded;
    if (picture.width != a.size.x || picture.height != a.size.y)
        fail("{} has {}x{} pixels, the others {}x{}: pictures must have the same size (--size)", path.string(),
             picture.width, picture.height, a.size.x, a.size.y);
    return entry;
}

void render(Entry& entry, Workspace& workspace, RenderSettings settings) {
    choose_hit(settings, entry.hit);
    settings.tracer = *entry.tracer;
    MadePicture made = render_with_bar(workspace, settings);
    entry.encoded = {made.picture.width, made.picture.height, std::move(made.picture.encoded)};
    if (made.picture.transparent) put_on_black(entry.encoded);
    entry.radiance = {made.picture.width, made.picture.height, std::move(made.picture.radiance)};
    entry.stats = std::move(made.stats);
}

/// The picture that the others are compared with.
size_t choose_reference(const std::vector<Entry>& entries) {
    for (size_t i = 0; i < entries.size(); i++)
        if (entries[i].tracer == Tracer::reference) return i;
    return entries.size() - 1;
}

Difference difference(const Entry& reference, const Entry& test) {
    if (!reference.radiance.pixels.empty() && !test.radiance.pixels.empty())
        return compare(reference.encoded, test.encoded, reference.radiance, test.radiance);
    return compare(reference.encoded, test.encoded);
}

std::string ms(double value) {
    return fmt::format("{:.2f} ms", value);
}

std::string mebibytes(uint64_t bytes) {
    return fmt::format("{:.1f} MiB", double(bytes) / (1 << 20));
}

/// `warm`: times are medians after a frame that warmed up.
std::vector<ReportFact> facts_of(const Entry& entry, bool warm) {
    std::vector<ReportFact> facts;
    if (!entry.stats) return facts;
    const PictureStats& stats = *entry.stats;
    const RenderStats& s = stats.render;
    const bool cpu = stats.by_cpu(), khr = s.tracer == Tracer::khr;
    facts.emplace_back("device", stats.machine.name + ", " + stats.machine.driver);
    facts.emplace_back(cpu ? "rays and shading" : warm ? "frame" : "frame, the first and cold", ms(s.frame_ms));
    if (s.build_ms > 0)
        facts.emplace_back(cpu   ? "hierarchy"
                           : khr ? "of which the acceleration structures"
                                 : "of which the cubes",
                           ms(s.build_ms));
    facts.emplace_back("secondary rays", fmt::format("{:.2f} M", double(stats.rays.secondary()) * 1e-6));
    if (stats.has_cubes()) {
        facts.emplace_back(
            "cubes", fmt::format("{} of up to {}³, {} hits", s.cubes.cubes(), s.cubes.resolution, name_of(s.hit)));
        facts.emplace_back("samples", fmt::format("{}", s.cubes.counts.fragments));
        facts.emplace_back("cubes in memory", mebibytes(s.cubes.bytes));
    }
    if (khr) {
        facts.emplace_back("acceleration structures",
                           fmt::format("{}, built: {}", s.structures.bodies,
                                       s.structures.kept == s.structures.bodies ? "once" : name_of(s.update)));
        facts.emplace_back("structures in memory", mebibytes(s.structures.bytes));
    }
    if (s.tracer == Tracer::cubemap) {
        const CubeMaps::Stats& maps = s.maps;
        facts.emplace_back("of which the maps", ms(s.maps_ms));
        facts.emplace_back("cube maps", fmt::format("{} of 6 × {}²", maps.probes, maps.face));
        facts.emplace_back("shadow maps", fmt::format("{} of {}²", maps.shadows.maps, maps.shadows.size));
        facts.emplace_back("maps in memory", mebibytes(maps.probe_bytes + maps.shadows.bytes));
    }
    return facts;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// The pixel where an error map is largest; the first of several.
glm::uvec2 worst_pixel(const ErrorMap& map) {
    const auto at = size_t(std::max_element(map.values.begin(), map.values.end()) - map.values.begin());
    return {uint32_t(at % map.width), uint32_t(at / map.width)};
}

Json json_of(const CompareArguments& a, const Report& report, const std::vector<Entry>& entries,
             const PosedScene& scene) {
    Json json = {{"scene", a.scene},
                 {"command", report.command},
                 {"commit", build_commit()},
                 {"image", {a.size.x, a.size.y}},
                 {"triangles", scene.triangles()},
                 {"reference", entries[report.reference].name},
                 {"notes", report.notes}};
    for (size_t i = 0; i < entries.size(); i++) {
        Json picture = {{"name", entries[i].name}, {"command", entries[i].command}};
        if (const auto& d = report.pictures[i].difference)
            picture["difference"] = {{"psnr_db", number(d->psnr)},
                                     {"identical", std::isinf(d->psnr)},
                                     {"ssim", d->ssim},
                                     {"flip", d->flip},
                                     {"hdr_flip", number(d->hdr_flip)},
                                     {"share_different", d->different},
                                     {"worst_pixel", {worst_pixel(d->map).x, worst_pixel(d->map).y}}};
        picture["stats"] =
            entries[i].stats ? picture_json(*entries[i].stats) : Json{{"file", entries[i].file.string()}};
        json["pictures"].push_back(std::move(picture));
    }
    return json;
}

/// All pictures in a row, in the order of the report.
Image8 strip_of(const std::vector<Entry>& entries) {
    constexpr uint32_t gap = 8;
    const uint32_t width = entries[0].encoded.width, height = entries[0].encoded.height;
    Image8 strip{uint32_t(entries.size()) * (width + gap) - gap, height, {}};
    strip.pixels.assign(size_t(strip.width) * height, 0xffffffffu);
    for (size_t i = 0; i < entries.size(); i++)
        for (uint32_t y = 0; y < height; y++)
            std::copy_n(&entries[i].encoded.pixels[size_t(y) * width], width,
                        &strip.pixels[size_t(y) * strip.width + i * (width + gap)]);
    return strip;
}

/// Surroundings of each picture's worst pixel, magnified, one row each: the picture, the reference, the error map.
Image8 worst_of(const Report& report) {
    const Image8& reference = report.pictures[report.reference].picture;
    const uint32_t side = std::min({48u, reference.width, reference.height}), zoom = 6, gap = 8;
    const uint32_t tile = side * zoom;
    Image8 sheet{3 * (tile + gap) - gap, 0, {}};
    for (const ReportPicture& picture : report.pictures) {
        if (!picture.difference) continue;
        const Image8 errors = colorize(picture.difference->map);
        const glm::uvec2 room(reference.width - side, reference.height - side);
        const glm::uvec2 centre = worst_pixel(picture.difference->map), half(side / 2);
        const glm::uvec2 corner = glm::min(glm::max(centre, half) - half, room);
        const uint32_t top = sheet.height ? sheet.height + gap : 0;
        sheet.height = top + tile;
        sheet.pixels.resize(size_t(sheet.width) * sheet.height, 0xffffffffu);
        const Image8* columns[] = {&picture.picture, &reference, &errors};
        for (uint32_t column = 0; column < 3; column++)
            for (uint32_t y = 0; y < tile; y++)
                for (uint32_t x = 0; x < tile; x++)
                    sheet.pixels[size_t(top + y) * sheet.width + column * (tile + gap) + x] =
                        columns[column]->pixels[size_t(corner.y + y / zoom) * reference.width + corner.x + x / zoom];
    }
    return sheet;
}

Report report_of(const CompareArguments& a, const std::vector<Entry>& entries, const PosedScene& scene) {
    Report report;
    report.title = a.scene;
    report.command = compare_command(a);
    report.reference = choose_reference(entries);
    report.facts = {
        {"triangles", fmt::format("{}", scene.triangles())},
        {"picture", fmt::format("{} × {}, {}, {}", a.size.x, a.size.y, counted("{} sample{|s} per pixel", a.spp),
                                counted("{} bounce{|s}", a.bounces))},
        {"program", fmt::format("peelray {}", build_commit())}};
    if (!is_reflective(scene.scene(), a.spp))
        report.notes.push_back(
            "nothing in this scene reflects or refracts enough to be traced: the tracers can differ in shadows only");
    const Entry& reference = entries[report.reference];
    if (reference.tracer != Tracer::reference && entries.size() > 1)
        report.notes.push_back(
            fmt::format("without --tracers reference the pictures are compared with '{}'", reference.name));
    for (const Entry& entry : entries) {
        ReportPicture picture{entry.name, entry.command, entry.encoded, facts_of(entry, a.repeat > 1), {}};
        if (&entry != &reference) picture.difference = difference(reference, entry);
        report.pictures.push_back(std::move(picture));
    }
    return report;
}

void print(const CompareArguments& a, const Report& report) {
    const size_t count = report.pictures.size();
    fmt::print("{}: {}", a.output.string(), counted("{} picture{|s}", count));
    if (count > 1) fmt::print(", compared with '{}'", one_line(report.pictures[report.reference].name));
    fmt::print("\n");
    for (const ReportPicture& picture : report.pictures) {
        const auto& d = picture.difference;
        if (!d) continue;
        const std::string hdr = std::isnan(d->hdr_flip) ? "     --" : fmt::format("{:.5f}", d->hdr_flip);
        const std::string decibels = std::isinf(d->psnr) ? "equal    " : fmt::format("{:6.2f} dB", d->psnr);
        fmt::print("  {:<14} FLIP {:.5f}  HDR-FLIP {}  SSIM {:.5f}  PSNR {}  pixels off {:.4f} %\n",
                   one_line(picture.name), d->flip, hdr, d->ssim, decibels, d->different * 100);
    }
}

}  // namespace

void run_compare(const CompareArguments& a) {
    const std::string extension = lower_extension(a.output);
    if (extension != ".html" && extension != ".htm")
        fail("the report is an HTML file: name '{}' .html", a.output.string());
    for (const fs::path& path : {a.strip, a.worst})
        if (!path.empty() && lower_extension(path) != ".png") fail("{} would be a PNG: name it .png", path.string());
    std::vector<Entry> entries = plan(a);
    if (!a.worst.empty() && entries.size() + a.pictures.size() < 2)
        fail("{} needs two pictures to compare: name more --tracers or a --picture", a.worst.string());
    std::vector<fs::path> outputs = {a.output}, inputs = {a.scene, a.env};
    for (const fs::path& path : {a.json, a.strip, a.worst})
        if (!path.empty()) outputs.push_back(path);
    inputs.insert(inputs.end(), a.pictures.begin(), a.pictures.end());
    check_outputs(outputs, inputs);
    std::vector<Entry> given;
    for (const fs::path& path : a.pictures) {
        given.push_back(read_picture(a, path));
        const auto same = std::count_if(given.begin(), given.end(),
                                        [&](const Entry& other) { return other.file.filename() == path.filename(); });
        if (same > 1) given.back().name += fmt::format(" ({})", same);
    }

    Workspace workspace(a, print_note);
    const PosedScene& scene = workspace.scene();
    watch_interrupts();
    for (const Entry& entry : entries) workspace.check(*entry.tracer);
    for (Entry& entry : entries) render(entry, workspace, render_settings(a));
    entries.insert(entries.begin(), given.begin(), given.end());
    const Report report = report_of(a, entries, scene);
    check_interrupt();
    for (const std::string& text : report.notes) print_note(text);
    // The report comes last: where it is, everything is.
    if (!a.json.empty()) write_json(a.json, json_of(a, report, entries, scene));
    if (!a.strip.empty()) write_png(a.strip, strip_of(entries));
    if (!a.worst.empty()) write_png(a.worst, worst_of(report));
    write_report(a.output, report);
    print(a, report);
}

}  // namespace peelray
