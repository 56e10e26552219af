// The buffers of the tree of rays below a band of pixels: one set per level (bounce), and the queue of the shadow rays
// of all levels.
#pragma once

#include <memory>
#include <vector>

#include "gpu/buffer.h"
#include "path/media_params.h"
#include "path/path_params.h"

namespace peelray {

/// Rays and what they hit.
struct PathRays {
    uint32_t capacity = 0;
    Buffer rays, states, skip, hits;
    Buffer media, walls;  ///< MediaStack and MediaWall each; only while media may overlap

    uint64_t bytes() const;
};

/// A level's rays, their hits and the tree's nodes; entry i of each belongs to the same ray.
struct PathLevel {
    uint32_t capacity = 0;
    /// Of level 0 only where they are kept (PathQueues::keep_camera_rays). Deeper levels take turns with two of them,
    /// but where somebody looks at their hits later (Needs::keeps): a level's rays are not wanted any more when those
    /// of the next have been made.
    std::shared_ptr<PathRays> traced;
    Buffer nodes, branches;
};

/// Shadow rays; those of a node follow each other.
struct LightQueue {
    uint32_t capacity = 0;
    Buffer rays, skip;
    Buffer light;  ///< vec3 each: what arrives along the ray; before it is traced, what may
    Buffer media;  ///< MediaStack each, where the ray starts; only while media may overlap
};

/// Makes room on demand: level 0 for a band's pixels, the others by what the last band needed.
class PathQueues {
  public:
    explicit PathQueues(Device& device);

    /// What there is to be room for.
    struct Needs {
        uint32_t pixels = 0;        ///< camera rays
        uint32_t levels = 1;        ///< in all
        uint32_t usual = 1;         ///< of them those that many rays reach; beyond, there are only few as a rule
        bool branching = false;     ///< hits may start two rays
        uint32_t lights = 0;        ///< shadow rays that a hit may start
        uint32_t usual_lights = 1;  ///< how many of them there are as a rule
        bool layered = false;       ///< media may overlap; level 0's rays are then kept as well
        bool keeps = false;         ///< all levels' rays and hits are there until the band is done
    };
    void prepare(const Needs& needs);
    /// What they take at first, in bytes.
    uint64_t bytes_of(const Needs& needs) const;
    /// Gives everything back.
    void release();

    /// Room for level 0's rays and hits, for passes that want them in buffers.
    void keep_camera_rays();

    /// Reads the counters of a finished submission; true if every queue fitted, else the queues have grown.
    bool finish();

    /// The last band needed more shadow rays than one queue holds: its successor must be lower.
    bool crowded() const { return count(QUEUE_LIGHT) > most_lights_; }

    /// Shadow rays that one queue holds.
    uint32_t most_lights() const { return most_lights_; }

    PathLevel& level(uint32_t index) { return levels_[index]; }
    const PathLevel& level(uint32_t index) const { return levels_[index]; }
    const LightQueue& lights() const { return lights_; }
    /// QUEUE_WORDS counters, to be cleared for each band.
    const Buffer& counters() const { return counters_; }
    /// Where in the counters the workgroups of a level are, or those of QUEUE_GROUPS_*.
    static uint64_t groups_offset(uint32_t level) { return (QUEUE_GROUPS + 3ull * level) * 4; }
    /// Where in them the number of rays of a level is, or of QUEUE_GROUPS_LIGHT, for launching as many: uvec3(count, 1,
    /// 1).
    static uint64_t launch_offset(uint32_t level) { return (QUEUE_LAUNCHES + 3ull * level) * 4; }
    const Buffer& readback() const { return readback_; }
    /// A counter (QUEUE_*) of the last finished band.
    uint32_t count(uint32_t counter) const { return reinterpret_cast<const uint32_t*>(readback_.mapped())[counter]; }
    uint64_t bytes() const;

  private:
    /// Room at first for the rays of each level, the one behind the last included; those of lights in the end.
    std::vector<uint64_t> capacities(const Needs& needs) const;
    void share_rays(bool keeps);
    void allocate(PathLevel& level, uint32_t index, uint32_t capacity);
    void allocate_media();
    void allocate_lights(uint64_t capacity);

    Device& device_;
    std::vector<PathLevel> levels_;
    LightQueue lights_;
    uint32_t most_lights_;
    bool layered_ = false, keeps_ = false;
    Buffer counters_, readback_;
};

}  // namespace peelray
