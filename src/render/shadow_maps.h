// Shadow maps of all lights: one orthographic map for a directional light, one in perspective for a spot and for a
// point light that sees the whole scene in one direction, six for a point light in the midst of it.
#pragma once

#include <functional>

#include "render/object_table.h"

namespace peelray {

class ShadowMaps {
  public:
    explicit ShadowMaps(Device& device) : device_(device), single_(device), sixfold_(device) {}

    /// Lays out the maps of `lights` (none: no shadows) for a scene in the box [lower, upper] and makes room.
    /// `picture`: the constants that a map's view does not set itself. Throws Error where the smallest maps do not fit.
    void prepare(Commands& commands, const std::vector<GpuLight>& lights, const glm::vec3& lower,
                 const glm::vec3& upper, const Frame& picture);

    /// Renders all maps; `submitted` is called after each submission.
    void render(Commands& commands, const GpuScene& scene, const ObjectTable& objects,
                const std::function<void()>& submitted);

    const Buffer& maps() const { return map_buffer_; }  ///< GpuShadowMap, six per light
    const Buffer& depths() const { return depths_; }    ///< float per texel

    struct Stats {
        uint32_t maps = 0, size = 0, face_size = 0;  ///< texels along a side: single maps, faces of six
        uint64_t bytes = 0;
    };
    Stats stats() const { return stats_; }

  private:
    /// A light's views; `box`: the scene's corners.
    std::vector<Frame> views_of(const GpuLight& light, std::span<const glm::vec3> box, const Frame& picture) const;

    Device& device_;
    std::vector<GpuShadowMap> maps_;
    std::vector<uint32_t> used_;  ///< indices of the maps that are used, in the order of the frames
    ViewTarget single_, sixfold_;
    Buffer map_buffer_, frames_, depths_;
    Stats stats_;
};

}  // namespace peelray
