#include "workspace/stats.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/setting.h"
#include "base/text.h"
#include "settings/limits.h"

namespace peelray {

Machine machine_of(const Device& device) {
    const DeviceInfo& info = device.info();
    return {info.name, info.kind, info.driver, info.api_version};
}

PictureStats picture_stats(const Machine& machine, const PosedScene& scene, const Picture& picture) {
    PictureStats stats;
    stats.machine = machine;
    stats.width = picture.width;
    stats.height = picture.height;
    stats.triangles = scene.triangles();
    stats.box = scene.bounds();
    stats.origin = scene.scene().origin;
    stats.camera = scene.camera();
    stats.samples = picture.samples;
    stats.rays = picture.rays;
    return stats;
}

std::string count_of_cubes(const SceneCubes::Stats& cubes) {
    return fmt::format("{} of up to {}", counted("{} cube{|s}", cubes.cubes()), cubes.resolution);
}

std::string room_note(const SceneCubes::Stats& cubes) {
    if (cubes.no_room.empty()) return {};
    const bool other_hits = cubes.choice.hit != cubes.no_room_hit;
    return fmt::format(
        "{}, for {} hits at N = {}: rays are traced in cubes of N = {}{}", cubes.no_room, name_of(cubes.no_room_hit),
        cubes.no_room_resolution, cubes.resolution,
        other_hits ? fmt::format(", by {} hits, which are as good as their voxels are fine", name_of(cubes.choice.hit))
                   : std::string());
}

std::string cut_note(const RayCounts& rays, uint32_t bounces) {
    constexpr double kNoticed = 0.001;  // of the camera's rays
    const double share = double(rays.cut_refraction) / double(std::max<uint64_t>(rays.primary, 1));
    if (share <= kNoticed) return {};
    const uint32_t more = std::min(2 * bounces, uint32_t(kBounceLimits.most));
    const std::string text = fmt::format(
        "{} ({:.1f} % of the camera's) would pass through more glass or blended surfaces than {} {} follows: {} the "
        "environment there",
        counted("{} ray{|s}", rays.cut_refraction), 100 * share, setting::bounces, bounces,
        counted("{it sees|they see}", rays.cut_refraction));
    return more > bounces ? fmt::format("{}; {} {} goes further", text, setting::bounces, more) : text;
}

std::string crowded_note(const RayCounts& rays) {
    if (rays.crowded == 0) return {};
    return fmt::format("{} in more than {} overlapping volumes at once: those of the largest do not count there",
                       counted("{} ray{|s} {was|were}", rays.crowded), MEDIA_TOGETHER);
}

std::string caustics_note(const RayCounts& rays, const PictureSettings& settings, bool emissive) {
    if (settings.caustics == 0) return {};
    if (rays.photons == 0)
        return fmt::format("{} {} changes nothing: no lamp sends light to a mirror or glass of which rays are traced",
                           setting::caustics, settings.caustics);
    const bool image = settings.env_mode == EnvironmentMode::sampled;
    if (!emissive && !image) return {};
    return fmt::format("only lamps send photons: light of {} goes straight through glass, without caustics",
                       !emissive ? "the environment"
                       : !image  ? "emissive surfaces"
                                 : "the environment and of emissive surfaces");
}

std::string tolerance_note(const std::vector<LdcBody>& bodies, const CubeChoice& choice) {
    if (choice.hit != HitTest::tolerance) return {};
    // Between the centres of two pixels a surface of slope 1 rises by half a voxel over its sample.
    const LdcBody* worst = nullptr;
    const auto voxels = [](const LdcBody& body) { return body.tolerance * body.grid.inv_voxel; };
    // What is flat along an axis does not slope.
    const auto flat = [](const LdcBody& body) {
        return std::min({body.grid.dims.x, body.grid.dims.y, body.grid.dims.z}) <= 16;
    };
    for (const LdcBody& body : bodies)
        if (!flat(body) && (!worst || voxels(body) < voxels(*worst))) worst = &body;
    if (!worst || !(voxels(*worst) < 0.5f)) return {};
    return fmt::format(
        "the tolerance of {:.3g} is {:.2g} pixels of a cube: rays slip through sloping surfaces; {} {:.2g} makes it a "
        "pixel",
        choice.tolerance, voxels(*worst), setting::tolerance, choice.tolerance / voxels(*worst));
}

}  // namespace peelray
