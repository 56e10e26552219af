// The LDI that a cell of its hierarchy belongs to. Include after the buffers bodies and counters.
#include "ldc/ldc_bodies.glsl"
#include "ldc/ldc_common.glsl"

struct LdcImage {
    uint first;      ///< its first pixel
    uvec2 size;      ///< pixels
    float tolerance; ///< voxels
};

/// Which LDI has the pixel with this number, counted from the build's first; false: none.
bool ldcImageOf(uint pixel, out LdcImage image) {
    const uint body = ldcBodyOfCell(params.first_cell + pixel);
    const CubeGrid grid = bodies[body].grid;
    uint first = bodies[body].first_cell;
    const uint inside = params.first_cell + pixel - first;
    const uvec3 sizes = uvec3(grid.dims.y * grid.dims.z, grid.dims.z * grid.dims.x, grid.dims.x * grid.dims.y);
    const uint axis = inside < sizes.x ? 0u : (inside < sizes.x + sizes.y ? 1u : 2u);
    first += axis == 0u ? 0u : (axis == 1u ? sizes.x : sizes.x + sizes.y);
    image = LdcImage(first, uvec3(peelrayToLdi(vec3(grid.dims), axis)).xy, bodies[body].tolerance * grid.inv_voxel);
    return inside < sizes.x + sizes.y + sizes.z;
}
