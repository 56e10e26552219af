// Embree's device with a scene of one geometry. Private to src/reference.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>

namespace peelray {

struct EmbreeScene {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;  ///< null: nothing was made, and every ray misses

    EmbreeScene() = default;
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Starts Embree, robust: no ray slips between two triangles. Throws Error.
    void start();
    /// Builds the hierarchy over a geometry of so many triangles, which it takes over. Throws Error.
    void build(RTCGeometry geometry, size_t triangles);
};

}  // namespace peelray
