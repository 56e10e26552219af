// A queued large triangle, projected again.
LdcTriangle bigTriangle(uint id) {
    const uvec3 corners = triangles[id >> 2u];
    const vec3 a = positions[corners.x], b = positions[corners.y], c = positions[corners.z];
    return ldcProject(params.grid, a, b, c, ldcNormal(a, b, c, params.grid.inv_voxel), id & 3u);
}
