#include "cli/picture_files.h"

#include <algorithm>
#include <list>

#include "base/error.h"
#include "base/text.h"
#include "cli/standard_output.h"
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

/// A channel of a file, and which component of a pixel's value it holds.
struct Channel {
    std::string name;
    size_t component = 0;
};

/// Of an auxiliary picture, in a file of its own and among the layers of another.
struct Channels {
    std::vector<Channel> alone, layered;
};

/// By the kinds of the table.
namespace channels {
/// One component after the other; the layer is called as the picture is.
Channels named(Aov aov, const std::vector<std::string>& names) {
    Channels channels;
    for (size_t i = 0; i < names.size(); i++) {
        channels.alone.push_back({names[i], i});
        channels.layered.push_back({std::string(name_of(aov)) + "." + names[i], i});
    }
    return channels;
}
/// A number, which as a layer is X, as Blender has it.
Channels number(Aov aov, const std::string& alone) {
    return {{{alone}}, {{std::string(name_of(aov)) + ".X"}}};
}

Channels distance(Aov aov) {
    return named(aov, {"Z"});
}
Channels index(Aov aov) {
    return number(aov, name_of(aov));
}
Channels scalar(Aov aov) {
    return number(aov, name_of(aov));
}
Channels vector(Aov aov) {
    return named(aov, {"X", "Y", "Z"});
}
Channels color(Aov aov) {
    return named(aov, {"R", "G", "B"});
}
/// As layers what Blender's Vector Blur takes, of which Z and W are to go on as X and Y came; and what Nuke's nodes
/// know of the frame before.
Channels motion(Aov) {
    return {{{"X", 0}, {"Y", 1}},
            {{"Vector.X", 0}, {"Vector.Y", 1}, {"Vector.Z", 0}, {"Vector.W", 1}, {"backward.u", 0}, {"backward.v", 1}}};
}
Channels directions(Aov aov) {
    return named(aov, {"x.U", "x.V", "y.U", "y.V", "z.U", "z.V"});
}
}  // namespace channels

std::vector<float> counts_of(const Picture& picture, const RayCostField& field) {
    std::vector<float> counts(picture.aovs.costs.size());
    for (size_t i = 0; i < counts.size(); i++) counts[i] = float(picture.aovs.costs[i].*field.value);
    return counts;
}

/// What a file holds of auxiliary pictures, which must outlive it.
struct Planes {
    std::vector<ExrChannel> channels;
    std::list<std::vector<float>> counts;  ///< what is not a float in the picture

    template <typename Value>
    void add(const std::vector<Channel>& added, const std::vector<Value>& pixels) {
        static_assert(sizeof(Value) % sizeof(float) == 0);
        const float* values = reinterpret_cast<const float*>(pixels.data());
        for (const Channel& channel : added)
            channels.push_back({channel.name, values + channel.component, sizeof(Value) / sizeof(float)});
    }
};

void add_aov(Planes& planes, const Picture& picture, Aov aov, bool layered) {
    const auto add = [&](const Channels& channels, const auto& pixels) {
        planes.add(layered ? channels.layered : channels.alone, pixels);
    };
    if (const RayCostField* field = cost_field(aov))
        return add(channels::number(aov, field->name), planes.counts.emplace_back(counts_of(picture, *field)));
#define AOV_ADD(name, type, kind, nothing) \
    if (aov == Aov::name) return add(channels::kind(aov), picture.aovs.name);
    SURFACE_AOVS(AOV_ADD)
    RAY_SETUP_AOVS(AOV_ADD)
    SAMPLE_AOVS(AOV_ADD)
#undef AOV_ADD
}

/// Costs in colours.
void write_heat_map(const Picture& picture, const RayCostField& field, const fs::path& path) {
    std::vector<float> counts = counts_of(picture, field);
    const float scale = 1 / float(std::max(largest_of(picture.aovs.costs, field), 1u));
    for (float& count : counts) count *= scale;
    write_png(path, colorize({picture.width, picture.height, counts}));
}

}  // namespace

PictureFiles picture_files(const RenderArguments& a) {
    const ExrFormat exr{a.half.value_or(YesNo::yes) == YesNo::yes,
                        a.exr_compression.value_or(Compression::zip) == Compression::zip};
    return {a.aovs, a.exr_layers, exr};
}

bool shows_radiance(const fs::path& path) {
    return !is_standard_output(path) && format_of(path) != Format::png;
}

void check_picture_name(const RenderArguments& a) {
    const fs::path& path = a.output;
    const bool exr = !is_standard_output(path) && format_of(path) == Format::exr;
    if (!exr && a.exr_layers)
        fail(
            "--exr-layers puts the auxiliary pictures into the picture itself, and '{}' has no room for them: name it "
            ".exr, or leave --exr-layers out, which writes files beside it",
            path.string());
    if (!exr && a.half)
        fail("--half is about the channels of an .exr, and '{}' is none: name it .exr, or leave --half out",
             path.string());
    if (!exr && a.exr_compression && a.aovs.empty())
        fail("--exr-compression is for .exr files, and '{}' is none: name it .exr, or leave --exr-compression out",
             path.string());
    if (!is_standard_output(path)) check_picture_name(path, a.is_transparent());
}

void check_picture_name(const fs::path& path, bool transparent) {
    if (format_of(path) == Format::hdr && transparent)
        fail(
            "--background transparent needs an alpha channel, and '{}' has none: name it .png or .exr, or give a "
            "colour",
            path.string());
}

std::vector<fs::path> paths_beside(const fs::path& output, const std::vector<Aov>& aovs, bool exr_layers) {
    std::vector<fs::path> paths;
    for (const Aov aov : aovs) {
        if (!exr_layers) paths.push_back(aov_path(output, aov));
        if (cost_field(aov)) paths.push_back(heat_map_path(output, aov));
    }
    return paths;
}

fs::path heat_map_path(const fs::path& output, Aov aov) {
    return fs::path(output).replace_extension(std::string(name_of(aov)) + ".png");
}

size_t write_picture(const Picture& picture, const PictureFiles& files, const fs::path& path) {
    const uint32_t width = picture.width, height = picture.height;
    Planes layers;
    for (const Aov aov : files.aovs) {
        if (const RayCostField* field = cost_field(aov)) write_heat_map(picture, *field, heat_map_path(path, aov));
        if (files.exr_layers) {
            add_aov(layers, picture, aov, true);
            continue;
        }
        Planes planes;
        add_aov(planes, picture, aov, false);
        write_exr_channels(aov_path(path, aov), width, height, planes.channels, files.exr);
    }
    if (format_of(path) == Format::png) {
        write_png(path, {width, height, picture.encoded}, picture.transparent);
        return 0;
    }
    const ImageView radiance{width, height, picture.radiance};
    return files.exr_layers ? write_exr_layers(path, radiance, layers.channels, files.exr)
                            : write_hdr(path, radiance, files.exr);
}

std::string beyond_note(size_t values) {
    if (values == 0) return {};
    return fmt::format("{} brighter than half floats reach and became 65504: --half no keeps {}",
                       counted("{} value{ was|s were}", values), values == 1 ? "it" : "them");
}

}  // namespace peelray
