#include "cli/picture_files.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"
#include "image/image.h"
#include "image/metrics.h"
#include "settings/aovs.h"

namespace peelray {

namespace fs = std::filesystem;

namespace {

enum class Format { png, exr, hdr };

Format format_of(const fs::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".png") return Format::png;
    if (extension == ".exr") return Format::exr;
    if (extension == ".hdr") return Format::hdr;
    fail("cannot tell the picture's format from '{}': name it .png, .exr or .hdr", path.string());
}

fs::path aov_path(const fs::path& output, Aov aov) {
    return fs::path(output).replace_extension(std::string(name_of(aov)) + ".exr");
}

/// Numbers as they are, and in colours.
void write_costs(const Picture& picture, const RayCostField& field, Aov aov, const fs::path& output) {
    std::vector<float> counts;
    for (const RayCosts& costs : picture.aovs.costs) counts.push_back(float(costs.*field.value));
    write_exr_channels(aov_path(output, aov), picture.width, picture.height, {field.name}, {counts});
    const float scale = 1 / float(std::max(largest_of(picture.aovs.costs, field), 1u));
    for (float& count : counts) count *= scale;
    write_png(heat_map_path(output, aov), colorize({picture.width, picture.height, counts}));
}

void write_aovs(const Picture& result, const std::vector<Aov>& aovs, const fs::path& output) {
    const Aovs& a = result.aovs;
    const auto component = [](const std::vector<glm::vec4>& values, int i) {
        std::vector<float> channel;
        for (const glm::vec4& value : values) channel.push_back(value[i]);
        return channel;
    };
    for (const Aov aov : aovs) {
        const fs::path path = aov_path(output, aov);
        const auto write = [&](const std::vector<std::string>& channels,
                               const std::vector<std::vector<float>>& values) {
            write_exr_channels(path, result.width, result.height, channels, values);
        };
        if (const RayCostField* field = cost_field(aov)) write_costs(result, *field, aov, output);
        if (aov == Aov::depth) write({"Z"}, {a.depth});
        if (aov == Aov::triangle) write({"triangle"}, {a.triangle});
        if (aov == Aov::material) write({"material"}, {a.material});
        if (aov == Aov::normal)
            write({"X", "Y", "Z"}, {component(a.normal, 0), component(a.normal, 1), component(a.normal, 2)});
        if (aov == Aov::albedo)
            write({"R", "G", "B"}, {component(a.albedo, 0), component(a.albedo, 1), component(a.albedo, 2)});
        if (aov == Aov::reflection)
            write({"X", "Y", "Z"},
                  {component(a.reflection, 0), component(a.reflection, 1), component(a.reflection, 2)});
        if (aov == Aov::box) write({"X", "Y", "Z"}, {component(a.box, 0), component(a.box, 1), component(a.box, 2)});
        if (aov == Aov::directions)
            write({"x.U", "x.V", "y.U", "y.V", "z.U", "z.V"},
                  {component(a.directions_xy, 0), component(a.directions_xy, 1), component(a.directions_xy, 2),
                   component(a.directions_xy, 3), component(a.directions_z, 0), component(a.directions_z, 1)});
        if (aov == Aov::position)
            write({"X", "Y", "Z"}, {component(a.position, 0), component(a.position, 1), component(a.position, 2)});
    }
}

}  // namespace

void check_picture_name(const fs::path& path) {
    format_of(path);
}

std::vector<fs::path> aov_paths(const fs::path& output, Aov aov) {
    std::vector<fs::path> paths = {aov_path(output, aov)};
    if (cost_field(aov)) paths.push_back(heat_map_path(output, aov));
    return paths;
}

fs::path heat_map_path(const fs::path& output, Aov aov) {
    return fs::path(output).replace_extension(std::string(name_of(aov)) + ".png");
}

void write_picture(const Picture& picture, const std::vector<Aov>& aovs, const fs::path& path) {
    write_aovs(picture, aovs, path);
    if (format_of(path) == Format::png)
        write_png(path, Image8{picture.width, picture.height, picture.encoded});
    else
        write_hdr(path, Image{picture.width, picture.height, picture.radiance});
}

}  // namespace peelray
