#include "workspace/stats.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/setting.h"

namespace peelray {

Machine machine_of(const Device& device) {
    const DeviceInfo& info = device.info();
    return {info.name, info.kind, info.driver, info.api_version};
}

std::string count_of_cubes(const SceneCubes::Stats& cubes) {
    return fmt::format("{} cube{} of up to {}", cubes.cubes(), cubes.cubes() == 1 ? "" : "s", cubes.resolution);
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
