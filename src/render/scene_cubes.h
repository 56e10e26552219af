// The cubes of a scene: those of bodies that never change their shape, built once, and those that are built for every
// frame.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "assembly/assembly.h"
#include "ldc/cube_builder.h"
#include "ldc/tracer.h"

namespace peelray {

/// How cubes are to be: what the settings say, with what `auto` stands for filled in.
struct CubeChoice {
    uint32_t ldc = 0;  ///< voxels along the longest side of the largest body; 0: chosen for each
    /// Of resolutions that are chosen: less than 1 where those would find no room.
    float fineness = 1;
    /// Voxels with more samples become finer ones; none: chosen. No hit depends on it.
    std::optional<uint32_t> refine;
    /// Of moving objects with at most so many triangles copies share a cube (MergedInstances); none: chosen.
    std::optional<uint32_t> merge;
    bool may_be_planar = false;  ///< `hit`, exact, was chosen: planar hits may take its place
    HitTest hit = HitTest::exact;
    bool ldc_each = false;     ///< `ldc` voxels for every body, not only for the largest
    float tolerance = 0.001f;  ///< of HitTest::tolerance, world units
    CubeLayout layout;
    bool operator==(const CubeChoice&) const = default;
};

/// What to try where the device has no room for the cubes of `choice`. A resolution that may be chosen becomes coarser,
/// step by step, which no exact hit depends on; then a hit test that may be chosen becomes planar, as fine as it gets.
/// None: the settings leave no choice.
std::optional<CubeChoice> smaller_than(const CubeChoice& choice);

/// Voxels along the longest side of the cube of each body: `ldc` for the largest, as many per metre for smaller ones,
/// but at least a quarter of it. `fixed`: of the first so many bodies they are built once, of the others for every
/// frame.
std::vector<uint32_t> choose_resolutions(const Assembly& assembly, const CubeChoice& choice, uint32_t fixed);

/// The largest resolution that was asked for, or chosen.
uint32_t largest_resolution(const Assembly& assembly, const CubeChoice& choice, uint32_t fixed);

class SceneCubes {
  public:
    /// Makes room for the cubes; nothing is built yet.
    /// `fixed`: the cubes of the first so many bodies are built once, the others for every frame.
    /// `scales`: of each body the smallest scale at which an instance shows it. Throws Error where the choice is
    /// impossible.
    SceneCubes(Device& device, const Assembly& assembly, const CubeChoice& choice, uint32_t fixed,
               const std::vector<float>& scales);

    const Cubes& cubes() const { return cubes_; }
    const CubeChoice& choice() const { return choice_; }
    uint32_t fixed() const { return fixed_; }  ///< cubes that are built once

    /// Builds what is built once, if that has not been done; true if it did. Submits, until everything fits.
    bool build_fixed(Commands& commands, const TriangleBuffers& triangles);

    /// Records the build of what deforms.
    void record(Commands& commands, const TriangleBuffers& triangles);
    /// After the submission: false if something did not fit; then record again.
    bool finish(Commands& commands);

    struct Stats {
        uint32_t bodies = 0, fixed = 0;  ///< fixed: built once
        uint32_t bare = 0;               ///< of the bodies, those without a cube (CubeBody::bare)
        uint32_t merged = 0;             ///< instances that share the last body's cube (MergedInstances)
        uint64_t merged_triangles = 0;   ///< of that cube
        uint32_t cubes() const { return bodies - bare; }
        uint32_t resolution = 0;  ///< what was asked for, or the largest of all
        CubeChoice choice;        ///< what they were built with
        /// What found no room, with this largest resolution and this hit test; empty: the first choice did.
        std::string no_room;
        uint32_t no_room_resolution = 0;
        HitTest no_room_hit = HitTest::exact;
        BuildCounts counts{};  ///< of all bodies; longest: the longest list of all
        uint64_t bytes = 0;    ///< of the tables in use
        uint64_t scratch_bytes = 0;
        uint32_t redone = 0;  ///< how often a build did not fit and was done again
    };
    Stats stats() const;

  private:
    Device& device_;
    CubeChoice choice_;
    uint32_t fixed_;
    Cubes cubes_;
    BuildCounts fixed_counts_{};
    TableSize fixed_size_;
    bool fixed_built_ = false;
    uint32_t fixed_redone_ = 0;
    std::unique_ptr<CubeBuilder> builder_;  ///< of what deforms
};

}  // namespace peelray
