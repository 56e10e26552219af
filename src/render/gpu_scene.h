// The scene's attributes on the device: what shading reads beside the triangles themselves.
#pragma once

#include "gpu/commands.h"
#include "ldc/cube.h"
#include "params.h"
#include "scene/environment.h"
#include "scene/scene.h"

namespace peelray {

/// Uploaded once per scene and environment. Throws Error when the device has no room.
class GpuScene {
  public:
    GpuScene(Device& device, const Scene& scene, const Geometry& geometry, const Environment& environment);

    TriangleBuffers triangles;
    Buffer normals, uvs, colors, triangle_materials;
    Buffer materials, texture_infos, texels;
    Buffer lights, environment;
    bool has_glass = false;  ///< some triangle lets light through
    bool has_colors = false;
    std::vector<GpuLight> light_list;  ///< what `lights` holds

    uint64_t bytes() const;

    /// The environment's part of the frame constants.
    void describe(Frame& frame) const;

  private:
    void upload_materials(Device& device, Commands& commands, const Scene& scene, const Geometry& geometry);
    void upload_lights(Device& device, Commands& commands, const Scene& scene, const Environment& environment);

    glm::uvec2 env_size_{0};
    uint32_t env_levels_ = 0;
    float sun_cosine_ = 2, rough_limit_ = 1e30f;
    glm::vec3 sun_direction_{0, 1, 0}, sun_radiance_{0};
    std::array<glm::vec3, 9> irradiance_{};
};

}  // namespace peelray
