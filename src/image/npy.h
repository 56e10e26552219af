// NumPy's .npy files for `peelray trace` (format: NumPy enhancement proposal 1).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/ray_costs.h"

namespace peelray {

/// One ray of RAYS.npy: world units; t counts in lengths of d, which need not be 1.
struct RayRecord {
    float ox, oy, oz, tmin, dx, dy, dz, tmax;
};
static_assert(sizeof(RayRecord) == 32);

/// One hit of HITS.npy. A miss: t = +inf, triangle = 4294967295, u = v = 0.
struct HitRecord {
    float t;
    uint32_t triangle;
    float u, v;  ///< barycentric weights of the triangle's second and third vertex
};
static_assert(sizeof(HitRecord) == 16);

/// Reads float32 (n, 8), C order, little endian, format version 1 to 3. Throws Error naming what the file holds
/// instead: another dtype, byte order, Fortran order, other shape, truncated or overlong data, not a .npy file. n = 0
/// is legal.
std::vector<RayRecord> read_rays(const std::filesystem::path& path);

/// Writes a structured array of shape (n,): [('t','<f4'),('triangle','<u4'),('u','<f4'),('v','<f4')]. Atomic. Throws
/// Error.
void write_hits(const std::filesystem::path& path, const std::vector<HitRecord>& hits);

/// The same with [('steps','<u4'),('cells','<u4'),('pixels','<u4'),('samples','<u4'),('triangles','<u4')].
void write_costs(const std::filesystem::path& path, const std::vector<RayCosts>& costs);

}  // namespace peelray
