// Writing a sample of the by-pixel order to its final place, counted from the build's first sample.
// STREAM: fragments of drawn streams, whose triangles are gone.
void placePixelSample(uint at, uint fragment) {
    const LdcFragment f = fragments[fragment];
    if (STREAM) {
        const LdcCaptured c = captured[fragment];
        samples[params.first_sample + at] = uvec2(f.local, c.slope);
        sample_ids[params.first_sample + at] = f.id;
        sample_attributes[params.first_sample + at] = uvec2(c.normal, c.color);
        return;
    }
    const CubeGrid grid = bodies[ldcBodyOfCell(params.first_cell + f.cell)].grid;
    const uvec3 corners = triangles[f.id >> 2u];
    const LdcTriangle t = ldcProject(grid, positions[corners.x], positions[corners.y], positions[corners.z],
                                     ldcNormal(positions[corners.x], positions[corners.y], positions[corners.z], grid.inv_voxel), f.id & 3u);
    samples[params.first_sample + at] = uvec2(f.local, packSnorm2x16(t.slope / PEELRAY_SLOPE_RANGE));
    sample_ids[params.first_sample + at] = f.id;
}
