// Plots of what plain `peelray bench` found out.
#pragma once

#include <filesystem>

#include "bench/ray_rows.h"

namespace peelray {

/// Writes those plots into `folder` that the rows have points for:
/// - triangles_rate.svg, triangles_dynamic.svg, triangles_build.svg: of blobs, against their triangles;
/// - rays.svg: against the number of mirror rays;
/// - ldc_rate.svg, ldc_dynamic.svg: against the resolution of the LDIs.
/// Throws Error.
void write_plots(const std::filesystem::path& folder, const std::vector<RayRow>& rows);

}  // namespace peelray
