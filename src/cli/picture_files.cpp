#include "cli/picture_files.h"

#include <algorithm>
#include <array>
#include <bit>

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

/// Names of the channels of a file, by the kinds of the table.
namespace channels {
std::vector<std::string> distance(Aov) {
    return {"Z"};
}
std::vector<std::string> index(Aov aov) {
    return {name_of(aov)};
}
std::vector<std::string> vector(Aov) {
    return {"X", "Y", "Z"};
}
std::vector<std::string> color(Aov) {
    return {"R", "G", "B"};
}
std::vector<std::string> directions(Aov) {
    return {"x.U", "x.V", "y.U", "y.V", "z.U", "z.V"};
}
}  // namespace channels

/// The first components of each pixel's value, one channel each.
template <typename Value>
void write_channels(const fs::path& path, const Picture& picture, const std::vector<std::string>& names,
                    const std::vector<Value>& pixels) {
    std::vector<std::vector<float>> values(names.size());
    for (const Value& pixel : pixels) {
        const auto components = std::bit_cast<std::array<float, sizeof(Value) / sizeof(float)>>(pixel);
        for (size_t i = 0; i < names.size(); i++) values[i].push_back(components[i]);
    }
    write_exr_channels(path, picture.width, picture.height, names, values);
}

void write_aov(const Picture& picture, Aov aov, const fs::path& output) {
    if (const RayCostField* field = cost_field(aov)) return write_costs(picture, *field, aov, output);
#define AOV_WRITE(name, type, kind, nothing) \
    if (aov == Aov::name) return write_channels(aov_path(output, aov), picture, channels::kind(aov), picture.aovs.name);
    SURFACE_AOVS(AOV_WRITE)
    RAY_SETUP_AOVS(AOV_WRITE)
#undef AOV_WRITE
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
    for (const Aov aov : aovs) write_aov(picture, aov, path);
    if (format_of(path) == Format::png)
        write_png(path, Image8{picture.width, picture.height, picture.encoded});
    else
        write_hdr(path, Image{picture.width, picture.height, picture.radiance});
}

}  // namespace peelray
