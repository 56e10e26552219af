// `peelray render`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/text.h"
#include "cli/picture_maker.h"
#include "cli/stats.h"
#include "image/image.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

enum class Format { png, exr, hdr };

Format format_of(const fs::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".png") return Format::png;
    if (extension == ".exr") return Format::exr;
    if (extension == ".hdr") return Format::hdr;
    fail("cannot tell the picture's format from '{}': name it .png, .exr or .hdr", path.string());
}

fs::path aov_path(const fs::path& output, const std::string& name) {
    fs::path path = output;
    return path.replace_extension(name + ".exr");
}

void write_aovs(const Picture& result, const std::vector<std::string>& names, const fs::path& output) {
    const Aovs& a = result.aovs;
    const auto component = [](const std::vector<glm::vec4>& values, int i) {
        std::vector<float> channel;
        for (const glm::vec4& value : values) channel.push_back(value[i]);
        return channel;
    };
    for (const std::string& name : names) {
        const fs::path path = aov_path(output, name);
        const auto write = [&](const std::vector<std::string>& channels,
                               const std::vector<std::vector<float>>& values) {
            write_exr_channels(path, result.width, result.height, channels, values);
        };
        if (name == "depth") write({"Z"}, {a.depth});
        if (name == "triangle") write({"triangle"}, {a.triangle});
        if (name == "material") write({"material"}, {a.material});
        if (name == "normal")
            write({"X", "Y", "Z"}, {component(a.normal, 0), component(a.normal, 1), component(a.normal, 2)});
        if (name == "albedo")
            write({"R", "G", "B"}, {component(a.albedo, 0), component(a.albedo, 1), component(a.albedo, 2)});
        if (name == "position")
            write({"X", "Y", "Z"}, {component(a.position, 0), component(a.position, 1), component(a.position, 2)});
    }
}

void write_picture(const Picture& result, const fs::path& path) {
    if (format_of(path) == Format::png)
        write_png(path, Image8{result.width, result.height, result.encoded});
    else
        write_hdr(path, Image{result.width, result.height, result.radiance});
}

/// What a reader of the terminal wants to know, once.
void report(const RenderArguments& a, const MadePicture& made, size_t triangles, double seconds) {
    const Picture& picture = made.picture;
    const double rays = double(picture.rays.primary + picture.rays.secondary());
    fmt::print("{}: {}x{}, {} triangles, {}{}; {:.2f} s in all on {}\n", a.output.string(), picture.width,
               picture.height, triangles,
               rays < 1e5 ? fmt::format("{} rays", rays) : fmt::format("{:.1f} M rays", rays * 1e-6), made.summary,
               seconds, made.device);
}

}  // namespace

void run_render(const RenderArguments& a) {
    const auto start = std::chrono::steady_clock::now();
    a.tracing.check();
    check_ranges(a);
    format_of(a.output);
    if (a.tracing.tracer == "reference" && a.repeat > 1)
        fail("--repeat measures GPU frames; with --tracer reference leave it out");
    RenderSettings settings = settings_of(a);
    settings.aovs = !a.aovs.empty();
    std::vector<fs::path> outputs = {a.output};
    for (const std::string& name : a.aovs) outputs.push_back(aov_path(a.output, name));
    if (!a.stats.empty()) outputs.push_back(a.stats);
    check_outputs(outputs, {a.scene, a.env});

    PreparedScene scene = prepare_scene(a);
    watch_interrupts();
    const MadePicture made = PictureMaker(scene, a).make(a.tracing.tracer, settings);
    write_picture(made.picture, a.output);
    write_aovs(made.picture, a.aovs, a.output);
    if (!a.stats.empty()) write_json(a.stats, made.stats);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    report(a, made, scene.geometry.triangles.size(), seconds);
}

}  // namespace peelray
