// A build in two stages: a rasteriser makes fragments of triangles, an order stores them as a traversal reads them.
// Private to src/ldc.
#pragma once

#include "gpu/commands.h"
#include "ldc/cubes.h"
#include "ldc/drawn_stream.h"

namespace peelray {

/// Guessed sizes of a build, before anything is counted.
struct BuildSize {
    uint64_t cells = 0;   ///< 16³ cells of all grids
    uint64_t pixels = 0;  ///< of all LDIs
    uint64_t triangles = 0;
};

/// What the stages share.
struct BuildState {
    Device& device;
    Cubes& cubes;
    TableSize before;  ///< what the tables hold of bodies that were built earlier and stay
    Refinement refinement;
    LdcParams params{};  ///< with the capacities that the buffers have now
    Buffer counters;     ///< one LdcCounters
    Buffer readback;     ///< the same after the build, for the host
    Buffer extent;       ///< one LdcExtent
    Buffer groups;       ///< LDC_GROUPS workgroup counts
    Buffer fragments;    ///< LdcFragment each
    Buffer node_masks;   ///< two uint32 per 16³ cell: its occupied nodes; by pixel: not used
    Buffer captured;     ///< LdcCaptured of each fragment; of drawn streams only
    std::vector<DrawnStream> streams;

    /// Bytes that the device binds at once.
    uint64_t most() const { return device.limits().maxStorageBufferRange; }
    /// Are triangles tested for holes as they are rasterised? Conservative samples keep what may be one: a hit decides
    /// at its own place.
    bool tests_alpha(const TriangleBuffers& triangles) const {
        return triangles.masks && cubes.sampling() != Sampling::conservative;
    }
    /// Counts the workgroups of the indirect passes again.
    void record_groups(Commands& commands) const;
};

class BuildStage {
  public:
    virtual ~BuildStage() = default;
    /// Sets the capacities of `state.params` that are this stage's own.
    virtual void guess(BuildState& state, const BuildSize& size) = 0;
    /// Makes room for the capacities.
    virtual void allocate(Commands& commands, BuildState& state) = 0;
    /// Clears what the build counts in. Runs before all stages.
    virtual void clear(Commands&, const BuildState&) {}
    virtual void record(Commands& commands, const BuildState& state, const TriangleBuffers& triangles) = 0;
    /// After the submission: adds what this stage counted apart from the counters.
    virtual void read(const BuildState&, BuildCounts&) const {}
    /// Raises the capacities that were too small; true if there were any.
    virtual bool grow(BuildState& state, const BuildCounts& counts) = 0;
    /// After the first build that fitted: lowers the capacities that were guessed to what is needed, with a reserve,
    /// since passes run as often as they say. The buffers stay.
    virtual void settle(BuildState&, const BuildCounts&) {}
    /// Bytes of scratch memory held.
    virtual uint64_t bytes() const = 0;
};

/// `count` elements of so many bytes, as many of them as the device binds.
uint32_t bounded(const BuildState& state, uint64_t count, uint64_t bytes_each);
/// What is left of `most` after `used`.
inline uint64_t left_of(uint64_t most, uint64_t used) {
    return most > used ? most - used : 0;
}
/// Raises `capacity` if `needed` exceeds it, to half as much more if `most` allows; returns whether it did.
bool grow_capacity(uint32_t& capacity, uint32_t needed, uint64_t most);

/// Lowers `capacity` to an eighth more than what was needed.
void settle_capacity(uint32_t& capacity, uint32_t needed);

/// The three passes of the prefix sum over `sums` (uvec2 each): as many as counter number `counter` says.
void record_scan(Commands& commands, const BuildState& state, uint32_t capacity, uint32_t counter, const Buffer& sums,
                 const Buffer& block_sums);

}  // namespace peelray
