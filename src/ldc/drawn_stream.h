// Geometry that exists only while it is drawn: displaced in the vertex or tessellation stage, generated on the GPU,
// with holes that an alpha test cuts. The a-buffer takes it as it takes triangles.
#pragma once

#include <string>
#include <vector>

#include "gpu/commands.h"

namespace peelray {

/// Draws whose fragments become the samples of a body's cube. The front's last stage includes ldc_stream_vertex.glsl,
/// the fragment shader ldc_stream.glsl, which say what they must do; between them the library's geometry shader routes.
/// Triangles without area or with corners that are not finite are dropped; unlike those of buffers they are not
/// counted.
struct DrawnStream {
    std::string front;                  ///< FRONT.vert, and FRONT.tesc and FRONT.tese with `patch_points`
    std::string fragments;              ///< FRAGMENTS.frag
    uint32_t patch_points = 0;          ///< corners of a patch; 0: triangles
    std::vector<Binding> bindings;      ///< of all its stages, from 8 on; must outlive the recording
    Constants constants = {};           ///< of all its stages; the library's have none
    const Buffer* arguments = nullptr;  ///< DrawArguments each, written by the host or on the GPU
    uint32_t draws = 1;
    uint32_t body = 0;  ///< whose cube it goes into: of the builder's
};

}  // namespace peelray
