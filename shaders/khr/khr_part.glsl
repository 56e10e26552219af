// Which triangle a hit shader is asked about. Bodies have a part for each run of triangles that are all opaque or none.
BUFFER(readonly, 1, uint, part_triangles)  // the first of each part

uint khrTriangle() { return part_triangles[gl_InstanceCustomIndexEXT + gl_GeometryIndexEXT] + gl_PrimitiveID; }
