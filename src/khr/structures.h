// The acceleration structures of a scene: one for each body, and one of the instances that place them in the world.
// Built as NVIDIA recommends ("Best Practices for Using NVIDIA RTX Ray Tracing", 2022): what stays is built for fast
// traces and compacted; what changes is built for fast builds, or refitted, all of it in one call; the structure of the
// instances is built anew, for fast traces, whenever something moves; what shows both sides and has no holes is opaque.
#pragma once

#include <functional>

#include "gpu/acceleration_structure.h"
#include "ldc/instances.h"
#include "ldc/triangle_buffers.h"

namespace peelray {

/// What becomes of a body's structure from frame to frame.
enum class StructureUpdate : uint8_t {
    rebuild,  ///< built anew
    refit,    ///< its boxes are fitted to the triangles as they are now
    keep,     ///< built once
};

/// As the stats call them.
const char* name_of(StructureUpdate update);

/// Triangles of a body in a row, of which all or none are opaque: without holes, and the same from both sides.
struct StructurePart {
    uint32_t first_triangle, triangles;
    bool opaque;
};

/// A body whose triangles get a structure of their own.
struct StructureBody {
    std::vector<StructurePart> parts;
    uint32_t last_vertex = 0;  ///< the largest that its triangles use
    StructureUpdate update = StructureUpdate::keep;
};

class Structures {
  public:
    /// All must outlive it. Throws Error where the device has no ray tracing, or no room.
    Structures(Device& device, const TriangleBuffers& triangles, const Instances& instances,
               const std::vector<StructureBody>& bodies);
    Structures(const Structures&) = delete;
    Structures& operator=(const Structures&) = delete;

    /// Builds what is built once, from the triangles as they are now, if that has not been done. Submits; after each
    /// submission `submitted` may read its times.
    void build_kept(Commands& commands, const std::function<void()>& submitted);

    /// Records the builds of a frame, into the group "build": of what changes and, where anything did or an instance
    /// `moved`, of the instances. They are read from Instances::table().
    void record(Commands& commands, bool moved);

    /// What rays are traced in.
    const AccelerationStructure& top() const { return top_; }
    /// uint32 for each part of each body: its first triangle.
    const Buffer& part_triangles() const { return part_triangles_; }

    struct Stats {
        uint32_t bodies = 0, kept = 0;
        uint64_t bytes = 0;          ///< of the structures, and what the instances are built from
        uint64_t scratch_bytes = 0;  ///< of the builds of a frame
        uint64_t kept_bytes = 0;     ///< of those that are built once, compacted
        uint64_t loose_bytes = 0;    ///< of the same, before
    };
    Stats stats() const;

  private:
    struct Body {
        StructureSource source;
        VkBuildAccelerationStructureFlagsKHR flags = 0;
        StructureSizes sizes;
        StructureUpdate update;
        AccelerationStructure structure;
        bool built = false;
    };
    void create_bodies(const TriangleBuffers& triangles, const std::vector<StructureBody>& bodies);
    void create_top();
    /// Puts structures of `bytes` each into one buffer.
    std::vector<AccelerationStructure> allocate(
        Buffer& storage, const std::string& name, const std::vector<uint64_t>& bytes,
        VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR);
    /// Records builds, as many at once as some scratch memory serves.
    void build(Commands& commands, const std::vector<Body*>& bodies, Buffer& scratch);
    void upload_addresses(Commands& commands);

    Device& device_;
    const Instances& instances_;
    std::vector<Body> bodies_;
    Buffer loose_storage_;  ///< of what is kept, until it is compacted
    Buffer kept_storage_, changing_storage_, top_storage_;
    Buffer scratch_, top_scratch_;
    Buffer part_triangles_;
    Buffer addresses_;  ///< KhrBody each
    Buffer placed_;     ///< KhrInstance each
    AccelerationStructure top_;
    StructureSource top_source_;
    uint64_t loose_bytes_ = 0;
    bool kept_built_ = false, top_built_ = false, changes_ = false;
};

}  // namespace peelray
