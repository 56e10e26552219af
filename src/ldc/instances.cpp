#include "ldc/instances.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "base/error.h"
#include "common/scan_params.h"

namespace peelray {
namespace {

uint32_t filled(uint32_t boxes) {
    return (boxes + 7) / 8 * 8;
}

/// Buckets along the Morton curve, many more than instances, for these cluster: bits of each axis.
uint32_t bits_for(uint32_t instances) {
    return std::clamp((uint32_t(std::bit_width(instances)) + 2) / 3 + 2, 3u, 7u);
}

}  // namespace

Instances::Instances(Device& device, const std::vector<InstanceInfo>& infos)
    : device_(device), count_(uint32_t(infos.size())) {
    Commands commands(device);
    assert(!infos.empty());
    if (infos.size() > 1u << 24)
        fail("the scene has {} instances of moving or repeated objects, at most 2^24 are supported", infos.size());
    // Room for one that shows what is merged.
    const uint64_t room = count_ + 1ull;
    infos_ = Buffer(device, "what instances show", room * sizeof(InstanceInfo));
    commands.upload(infos_, std::span<const InstanceInfo>(infos));
    transforms_ = Buffer(device, "where instances stand", room * sizeof(GpuTransform));
    const GpuTransform nowhere_else{glm::mat3(1), glm::vec3(0)};
    commands.upload(transforms_, std::span(&nowhere_else, 1), count_ * sizeof(GpuTransform));
    table_ = Buffer(device, "instances", room * sizeof(GpuInstance));
    cubes_ = Buffer(device, "cubes of instances", room * sizeof(PeelrayInstance));
    for (const InstanceInfo& info : infos) bodies_.push_back(info.body);
    make_tree(bodies_);
}

void Instances::make_tree(const std::vector<uint32_t>& bodies) {
    const auto count = uint32_t(bodies.size());
    few_.clear();
    tree_ = {};
    tree_.instances = count;
    uint32_t total = 0;
    for (uint32_t boxes = filled(count);; boxes = filled(boxes / 8)) {
        tree_.first[tree_.levels++] = total;
        total += boxes;
        if (boxes <= 8) break;
    }
    boxes_ = Buffer(device_, "boxes of instances", total * sizeof(PeelrayBox));
    for (Buffer* buffer : {&unsorted_boxes_, &middles_, &keys_, &sums_, &block_sums_, &unsorted_instances_})
        buffer->reset();
    if (count <= 8) {
        few_ = bodies;
        return;
    }
    unsorted_boxes_ = Buffer(device_, "unsorted boxes of instances", filled(count) * sizeof(PeelrayBox));
    if (count <= TREE_SMALL) return;
    const uint64_t buckets = 1ull << (3 * bits_for(count));
    middles_ = Buffer(device_, "middles of instances", 24);
    keys_ = Buffer(device_, "keys of instances", count * sizeof(TreeKey));
    sums_ = Buffer(device_, "buckets of instances", buckets * 8);
    block_sums_ = Buffer(device_, "prefix sums of buckets", (buckets / SCAN_BLOCK + 2) * 8);
    unsorted_instances_ = Buffer(device_, "instances by bucket", count * 4);
}

void Instances::merge(const MergedBody& merged) {
    std::vector<InstanceRole> roles(count_ + 1ull);
    for (size_t i = 0; i < merged.instances.size(); i++)
        roles[merged.instances[i]] = {INSTANCE_MERGED, merged.copies[i]};
    std::vector<uint32_t> met;
    for (uint32_t i = 0; i <= count_; i++) {
        if (roles[i].box == INSTANCE_MERGED) continue;
        roles[i].box = uint32_t(met.size());
        met.push_back(i < count_ ? bodies_[i] : merged.body);
    }
    Commands commands(device_);
    const InstanceInfo info{merged.body, 0, 0};
    commands.upload(infos_, std::span(&info, 1), count_ * sizeof(InstanceInfo));
    roles_ = Buffer(device_, "roles of instances", roles.size() * sizeof(InstanceRole));
    commands.upload(roles_, std::span<const InstanceRole>(roles));
    merging_ = true;
    make_tree(met);
}

void Instances::separate() {
    if (!std::exchange(merging_, false)) return;
    roles_.reset();
    make_tree(bodies_);
}

void Instances::place(Commands& commands, std::span<const GpuTransform> transforms, uint32_t first) {
    commands.upload(transforms_, transforms, first * sizeof(GpuTransform));
}

uint32_t Instances::boxes_of(uint32_t level) const {
    uint32_t boxes = filled(tree_.instances);
    for (uint32_t i = 0; i < level; i++) boxes = i + 1 == level ? boxes / 8 : filled(boxes / 8);
    return boxes;
}

TreeParams Instances::tree_params() const {
    TreeParams p{};
    p.tree = tree_;
    p.bits = bits_for(tree_.instances);
    return p;
}

uint32_t Instances::bare(const BodyTable& bodies) const {
    return uint32_t(std::count_if(few_.begin(), few_.end(), [&](uint32_t body) { return bodies.bodies()[body].bare; }));
}

void Instances::record(Commands& commands, const BodyTable& bodies, bool hierarchy) {
    commands.begin_group("instances");
    InstanceParams p{count() + (merging_ ? 1 : 0), met(), filled(met()), 0};
    uint32_t next_bare = 0, next_cube = bare(bodies);
    for (size_t i = 0; i < few_.size(); i++)
        p.slots |= (bodies.bodies()[few_[i]].bare ? next_bare++ : next_cube++) << (4 * i);
    // The only group of a small hierarchy needs no order.
    const Buffer& boxes = met() <= 8 ? boxes_ : unsorted_boxes_;
    commands.run(device_.pass("instances", {{"merging", merging_}}),
                 {{"transforms", transforms_},
                  {"infos", infos_},
                  {"bodies", bodies.entries},
                  {"body_lower", bodies.lower},
                  {"body_upper", bodies.upper},
                  {"instances", table_},
                  {"instance_cubes", cubes_},
                  {"instance_boxes", boxes},
                  Binding::if_used("roles", roles_)},
                 p, groups_for(p.count + p.padded - p.boxes, 64));
    if (hierarchy && met() > TREE_SMALL)
        record_large(commands);
    else if (hierarchy && met() > 8)
        record_small(commands);
    commands.end_group();
}

void Instances::record_small(Commands& commands) {
    commands.run(device_.pass("tree_small"), {{"unsorted_boxes", unsorted_boxes_}, {"instance_boxes", boxes_}},
                 tree_params(), {1});
}

void Instances::record_large(Commands& commands) {
    TreeParams p = tree_params();
    const Groups groups = groups_for(met(), 64);
    const uint32_t buckets = 1u << (3 * p.bits);
    commands.fill(middles_, ~0u, 0, 12);
    commands.fill(middles_, 0, 12, 12);
    commands.fill(sums_, 0, 0, uint64_t(buckets) * 8);
    commands.run(device_.pass("tree_middles"), {{"unsorted_boxes", unsorted_boxes_}, {"middles", middles_}}, p,
                 groups_for(met(), 256));
    commands.run(device_.pass("tree_keys"),
                 {{"unsorted_boxes", unsorted_boxes_}, {"middles", middles_}, {"tree_keys", keys_}, {"sums", sums_}}, p,
                 groups);
    const ScanParams scan{buckets, SCAN_NO_COUNTER};
    const Groups scan_groups = groups_for(buckets, SCAN_BLOCK);
    // No counter: any buffer does.
    commands.run(device_.pass("scan_reduce"), {{"counters", infos_}, {"sums", sums_}, {"block_sums", block_sums_}},
                 scan, scan_groups);
    commands.run(device_.pass("scan_blocks"), {{"block_sums", block_sums_}}, scan, {1});
    commands.run(device_.pass("scan_apply"), {{"counters", infos_}, {"sums", sums_}, {"block_sums", block_sums_}}, scan,
                 scan_groups);
    commands.run(device_.pass("tree_scatter"),
                 {{"tree_keys", keys_}, {"sums", sums_}, {"unsorted_instances", unsorted_instances_}}, p, groups);
    commands.run(device_.pass("tree_leaves"),
                 {{"unsorted_boxes", unsorted_boxes_},
                  {"tree_keys", keys_},
                  {"sums", sums_},
                  {"unsorted_instances", unsorted_instances_},
                  {"instance_boxes", boxes_}},
                 p, groups_for(filled(met()), 64));
    for (p.level = 1; p.level < tree_.levels; p.level++) {
        p.boxes = boxes_of(p.level);
        p.filled = filled(p.boxes);
        commands.run(device_.pass("tree_level"), {{"instance_boxes", boxes_}}, p, groups_for(p.filled, 64));
    }
}

uint64_t Instances::bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&infos_, &transforms_, &table_, &cubes_, &boxes_, &roles_, &unsorted_boxes_, &middles_,
                                 &keys_, &sums_, &block_sums_, &unsorted_instances_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
