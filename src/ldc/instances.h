// Bodies placed in the world, and the hierarchy over their boxes.
#pragma once

#include <span>
#include <vector>

#include "common/instance.h"
#include "ldc/body_table.h"
#include "ldc/tree_params.h"

namespace peelray {

/// Instances whose triangles have copies in the world, which share a body: rays meet that one instead of them.
struct MergedBody {
    uint32_t body;                    ///< in the table of bodies; placed once, where its vertices are
    std::vector<uint32_t> instances;  ///< ascending
    std::vector<uint32_t> copies;     ///< of each: added to the number of a triangle, that of its copy
};

/// Instances of some bodies. Transforms may come from the host or from a pass that writes them; after
/// either, record() places the cubes anew.
class Instances {
  public:
    /// `infos`: at least one; instances of the same body need not lie together here. Throws Error beyond 2^24
    /// instances.
    Instances(Device& device, const std::vector<InstanceInfo>& infos);

    uint32_t count() const { return count_; }
    /// Those that rays meet: all, or those that are not merged and the one behind the last that shows what is.
    uint32_t met() const { return tree_.instances; }
    /// How many of up to 8 that rays meet show bare bodies of these; of more, 0.
    uint32_t bare(const BodyTable& bodies) const;

    /// Uploads where instances [first, first + transforms.size()) stand.
    void place(Commands& commands, std::span<const GpuTransform> transforms, uint32_t first = 0);
    const Buffer& transforms() const { return transforms_; }  ///< GpuTransform each

    /// From the next record() on copies stand for some of them. Submits.
    void merge(const MergedBody& merged);
    /// As if that had not been.
    void separate();

    /// Records the passes that place the bodies as they are now, into the group "instances". Every build of a moving
    /// body is followed by it. Without the `hierarchy` for rays that are not traced in the cubes.
    void record(Commands& commands, const BodyTable& bodies, bool hierarchy = true);

    const Buffer& table() const { return table_; }  ///< GpuInstance each, and one more
    const Buffer& cubes() const { return cubes_; }  ///< PeelrayInstance each, and one more
    const Buffer& boxes() const { return boxes_; }  ///< PeelrayBox: the hierarchy, see PeelrayTree
    const PeelrayTree& tree() const { return tree_; }
    uint64_t bytes() const;

  private:
    /// Makes room for a hierarchy over the instances that show these bodies.
    void make_tree(const std::vector<uint32_t>& bodies);
    void record_small(Commands& commands);
    void record_large(Commands& commands);
    TreeParams tree_params() const;
    uint32_t boxes_of(uint32_t level) const;

    Device& device_;
    uint32_t count_;
    std::vector<uint32_t> bodies_;  ///< that they show
    std::vector<uint32_t> few_;     ///< that up to 8 that rays meet show; of more, empty
    bool merging_ = false;
    PeelrayTree tree_{};
    Buffer infos_, transforms_, table_, cubes_, boxes_, unsorted_boxes_, roles_;
    Buffer middles_, keys_, sums_, block_sums_, unsorted_instances_;  ///< of large hierarchies only
};

}  // namespace peelray
