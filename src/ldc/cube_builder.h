// Builds cubes: rasterises bodies into fragments and stores them in the order that the traversal reads.
#pragma once

#include <memory>

#include "gpu/commands.h"
#include "ldc/cubes.h"
#include "ldc/drawn_stream.h"

namespace peelray {

struct BuildState;
class BuildStage;

/// Builds the cubes of a range of bodies, all at once. One builder serves many frames; its scratch memory is kept and
/// grows as needed.
///
///     do {
///         builder.record(commands, triangles);
///         commands.submit();         // with whatever else belongs to the frame
///     } while (!builder.finish(commands));  // false: something did not fit; it has room now
class CubeBuilder {
  public:
    /// For `bodies` bodies of `cubes` (which must outlive it) from `first` on. `before`: what the tables hold of bodies
    /// that were built earlier and stay. Makes room: a guess from the bodies' bounds and numbers of triangles.
    CubeBuilder(Device& device, Commands& commands, Cubes& cubes, uint32_t first, uint32_t bodies,
                const TableSize& before = {}, const Refinement& refinement = {});
    ~CubeBuilder();

    /// What record() draws, where the layout says `streams`. The fragments are guessed from the bodies' triangles.
    void set_streams(std::vector<DrawnStream> streams);

    /// Records all passes of one build into the group "build". The bodies' bounds in `cubes` are those of their
    /// triangles now.
    void record(Commands& commands, const TriangleBuffers& triangles);

    /// After the submission: true if everything fitted. Otherwise the buffers have grown and the frame must be recorded
    /// again. Throws Error where a software device cannot sort what crowds into one list, NoRoom where the device does
    /// not bind or hold what it takes: then the builder and its cubes are of no use any more.
    bool finish(Commands& commands);

    /// record, submit and finish until it fits.
    void build(Commands& commands, const TriangleBuffers& triangles);

    /// Of the last finished build.
    const BuildCounts& counts() const { return counts_; }
    TableSize size() const;
    /// Bytes of scratch memory held beside the cubes.
    uint64_t scratch_bytes() const;
    /// How often a build had to be redone since the builder was made.
    uint32_t redone() const { return redone_; }

  private:
    void allocate(Commands& commands);

    Cubes& cubes_;
    std::unique_ptr<BuildState> state_;
    std::unique_ptr<BuildStage> rasterizer_, order_;
    BuildCounts counts_{};
    uint32_t redone_ = 0;
    bool settled_ = false;
};

}  // namespace peelray
