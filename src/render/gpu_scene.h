// The scene on the device: bodies, where their instances stand, and what shading reads beside the triangles themselves.
#pragma once

#include "assembly/assembly.h"
#include "common/instance.h"
#include "ldc/instances.h"
#include "ldc/triangle_buffers.h"
#include "path/frame.h"
#include "path/media_params.h"
#include "path/shading_numbers.h"
#include "render/deformer.h"
#include "render/generators.h"
#include "scene/environment.h"
#include "scene/media.h"

namespace peelray {

/// Throws NoRoom where the device cannot bind the triangles and vertices of the meshes that the scene shows: before
/// they are assembled, which takes long where they are so many.
void check_room(const Device& device, const Scene& scene);

/// The levels of an environment that a device binds at once: all, or all from some level on.
struct EnvironmentLevels {
    size_t first = 0;  ///< texel
    uint32_t width = 0, height = 0, levels = 0;
};
EnvironmentLevels levels_on(const Device& device, const Environment& environment);

/// Uploaded once per scene and environment; pose() moves it. Throws Error when the device has no room.
class GpuScene {
  public:
    GpuScene(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly,
             const Environment& environment);
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    TriangleBuffers triangles;  ///< in the spaces of their bodies
    BaseColorBuffers base_colors;
    Buffer normals, triangle_ids, triangle_objects;
    Buffer lights;
    Buffer lookups;                    ///< the tables of path/tables.h, then the environment map
    bool has_glass = false;            ///< some triangle lets light through
    bool splits = false;               ///< some reflects along two directions, or reflects and refracts
    bool has_blended = false;          ///< some covers a part of what is behind it
    bool layered = false;              ///< rays may be in several media at once (MediaPieces), at this moment
    Buffer media_ranks;                ///< uint32: number of materials, rank by material, material by rank
    bool has_unlit = false;            ///< some triangle is to be shown as it is
    std::vector<GpuLight> light_list;  ///< what `lights` holds
    std::vector<Light> lamp_list;      ///< the same
    Instances instances;
    std::vector<DrawRange> draws;  ///< all instances, a draw per body
    Buffer draw_table;             ///< the same, GpuDraw each
    uint64_t drawn = 0;            ///< triangles of all draws; draw_table is right up to 2^32

    /// Takes on another moment of the scene: transforms, joints, weights, lights, what is generated. Returns how many
    /// instances moved; those that are placed on the device all count.
    uint32_t pose(Commands& commands, const Scene& scene, const Moment& moment);

    /// The media that a point is in.
    MediaStack media_at(const Scene& scene, const Moment& moment, const glm::vec3& point) const;

    /// Records what computes the vertices of this moment.
    void record_animation(Commands& commands, const BodyTable& bodies);

    uint64_t bytes() const;

    /// The environment's and the instances' part of the frame constants.
    /// `env_sampled`: the environment's distribution is used.
    void describe(Frame& frame, bool env_sampled) const;
    /// Lamps that a frame with or without it has, the sun included.
    uint32_t lamps(bool env_sampled) const;
    /// Lamps of which hits draw one where lobes are sampled; 0: there are few.
    uint32_t drawn_lamps() const { return placed_lamps_ > LAMPS_EACH ? placed_lamps_ : 0; }
    uint32_t first_drawn() const { return first_placed_; }
    /// Triangles that light is looked for on.
    uint32_t emitters() const { return emitters_; }

  private:
    void upload_lookups(Commands& commands, const Environment& env, const std::vector<glm::vec4>& emitters);
    void upload_media(Commands& commands);
    void upload_lights(Commands& commands, const std::vector<Light>& own);

    Device& device_;
    std::vector<Assembly::Instance> placed_;
    std::vector<GpuTransform> transforms_;  ///< as they were uploaded last
    uint32_t fixed_bodies_, bodies_;
    Deformer deformer_;
    Generators generators_;
    MediaRanks media_order_;
    MediaPieces media_pieces_;
    std::vector<Light> environment_lights_;
    uint32_t first_placed_ = 0, placed_lamps_ = 0;
    glm::uvec2 env_size_{0};
    uint32_t env_levels_ = 0, env_quads_ = 0, env_depth_ = 0, first_emitter_ = 0, emitters_ = 0, blurred_first_ = 0;
    glm::uvec2 filtered_size_{0};
    uint32_t filtered_first_ = 0, filtered_levels_ = 0, filtered_directions_ = 0;
    bool env_is_image_ = false;
    float env_texels_ = 0;
    float sun_cosine_ = 2, rough_limit_ = 1e30f;
    glm::vec3 sun_direction_{0, 1, 0}, sun_radiance_{0};
    std::array<glm::vec3, 9> irradiance_{};
};

}  // namespace peelray
