// The triangle `id >> 2` of a body as its LDI of axis `id & 3` sees it.
LdcTriangle ldcProjected(CubeGrid grid, uint id) {
    const uvec3 corners = triangles[id >> 2u];
    const vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    return ldcProject(grid, a, b, c, ldcNormal(a, b, c, grid.inv_voxel), id & 3u);
}
