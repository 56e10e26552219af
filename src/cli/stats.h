// The stats file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "gpu/device.h"
#include "render/renderer.h"

namespace peelray {

/// Device, driver, API version and the build's commit.
nlohmann::ordered_json device_stats(const Device& device);
/// The cube: N, box, samples, layers, bytes, builder.
nlohmann::ordered_json cube_stats(const CubeGrid& grid, const LdcCounters& counts, uint32_t resolution, uint64_t bytes,
                                  uint64_t scratch, const char* sampling);
/// Rays by kind.
nlohmann::ordered_json ray_stats(const RayCounts& rays);
/// All of a picture that the GPU rendered.
nlohmann::ordered_json render_stats(const Device& device, const RenderResult& result, const Geometry& geometry);
/// Writes indented JSON, atomically. Throws Error if unwritable.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);
/// The same, but leaves a file that is there alone. Returns whether it wrote.
bool write_json_if_absent(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace peelray
