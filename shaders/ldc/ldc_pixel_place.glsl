// Writing a sample of the by-pixel order to its final place, counted from the build's first sample.
// With the constant `streams`: fragments of drawn streams, whose triangles are gone.
#include "ldc/ldc_params.h"
#include "ldc/ldc_projected.glsl"

void placePixelSample(uint at, uint fragment) {
    const LdcFragment f = fragments[fragment];
    if (streams) {
        const LdcCaptured c = captured[fragment];
        samples[params.first_sample + at] = uvec2(f.local, c.slope);
        sample_ids[params.first_sample + at] = f.id;
        sample_attributes[params.first_sample + at] = uvec2(c.normal, c.color);
        return;
    }
    const CubeGrid grid = bodies[ldcBodyOfCell(params.first_cell + f.cell)].grid;
    const vec2 slope = ldcProjected(grid, f.id).slope;
    samples[params.first_sample + at] = uvec2(f.local, packSnorm2x16(slope / PEELRAY_SLOPE_RANGE));
    sample_ids[params.first_sample + at] = f.id;
}
