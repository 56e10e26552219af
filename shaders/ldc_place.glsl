// Writing a sample to its final place in its list, counted from the build's first sample.
void placeSample(uint at, uint id, uint voxel, bool last) {
    const uint cell = node_cells[voxel >> 6u].x;
    const CubeGrid grid = bodies[node_cells[voxel >> 6u].y].grid;
    const uvec3 position = uvec3(cell & 1023u, cell >> 10u & 1023u, cell >> 20u) * 4u + ldcCell64(voxel & 63u);
    const uvec3 corners = triangles[id >> 2u];
    const vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    const LdcTriangle t = ldcProject(grid, a, b, c, ldcNormal(a, b, c, grid.inv_voxel), id & 3u);
    uvec2 data = ldcPackSample(t, position, id & 3u, params.sampling);
    if (last) data.y |= 1u << 30u;
    samples[params.first_sample + at] = data;
    sample_ids[params.first_sample + at] = id;
}
