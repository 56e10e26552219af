// The stats file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "gpu/device.h"
#include "render/renderer.h"

namespace peelray {

/// "2 cubes of up to 368": how many, and their voxels along the longest side.
std::string count_of_cubes(const SceneCubes::Stats& cubes);

/// Device, driver, API version and the build's commit.
nlohmann::ordered_json device_stats(const Device& device);
/// What to say where the tolerance of `tolerance` hits is so far below the voxels that surfaces have holes; empty:
/// nothing. `bodies`: with the grids of their cubes.
std::string tolerance_note(const std::vector<LdcBody>& bodies, const CubeChoice& choice);

/// The cubes: N (the largest), box, samples, layers, bytes, builder, and each one's own (the first 64). `bodies`: with
/// the cubes' grids; `shown`: instances of each; `box`: of the whole scene.
nlohmann::ordered_json cube_stats(const SceneCubes::Stats& cubes, const std::vector<LdcBody>& bodies,
                                  const std::vector<uint32_t>& shown, const Box& box, const CubeChoice& choice);
/// The acceleration structures of --tracer khr. `update`: of what is not kept.
nlohmann::ordered_json structure_stats(const Structures::Stats& structures, StructureUpdate update);
/// What rays of some kinds cost, named by `names`: means and the most of a single ray.
nlohmann::ordered_json counter_stats(const AllKindCosts& costs, std::span<const char* const> names);
/// All device memory by part and buffer, now and at the peak: sums are those of the device.
nlohmann::ordered_json memory_stats(const std::vector<Allocation>& now, const std::vector<Allocation>& peak);
/// Rays by kind.
nlohmann::ordered_json ray_stats(const RayCounts& rays);
/// All of a picture that the GPU rendered.
nlohmann::ordered_json render_stats(const Device& device, const RenderResult& result, uint64_t triangles,
                                    const Box& box);
/// Writes indented JSON, atomically. Throws Error if unwritable.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);
/// The same, but leaves a file that is there alone. Returns whether it wrote.
bool write_json_if_absent(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace peelray
