// For the last stage of a drawn stream before the library's geometry shader: the vertex or the tessellation evaluation shader. It sets
//     gl_Position.xyz  where the corner is, in the space of the stream's body, inside the body's bounds
//     stream_id        a number below 2^30 that every sample of the triangle carries; that of the first corner counts
//     stream_data0, 1  whatever the fragment shader wants interpolated
layout(location = 0) flat out uint stream_id;
layout(location = 1) out vec4 stream_data0;
layout(location = 2) out vec4 stream_data1;
