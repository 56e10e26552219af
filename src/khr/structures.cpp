#include "khr/structures.h"
#include "khr/khr_params.h"

#include <algorithm>

namespace peelray {
namespace {

/// Builds share scratch memory of so many bytes; a larger one has as much as it needs.
constexpr uint64_t kScratchBytes = 256ull << 20;

uint64_t round_up(uint64_t value, uint64_t to) {
    return (value + to - 1) / to * to;
}

VkBuildAccelerationStructureFlagsKHR flags_for(StructureUpdate update) {
    switch (update) {
        case StructureUpdate::rebuild:
            return VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_BUILD_BIT_KHR;
        case StructureUpdate::refit:
            return VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                   VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
        case StructureUpdate::keep:
            return VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                   VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
    }
    return 0;
}

}  // namespace

const char* name_of(StructureUpdate update) {
    switch (update) {
        case StructureUpdate::rebuild:
            return "rebuild";
        case StructureUpdate::refit:
            return "refit";
        case StructureUpdate::keep:
            return "keep";
    }
    return "";
}

Structures::Structures(Device& device, const TriangleBuffers& triangles, const Instances& instances,
                       const std::vector<StructureBody>& bodies)
    : device_(device), instances_(instances) {
    device.check_ray_tracing();
    create_bodies(triangles, bodies);
    create_top();
}

void Structures::create_bodies(const TriangleBuffers& triangles, const std::vector<StructureBody>& bodies) {
    std::vector<uint32_t> firsts;
    std::vector<uint64_t> kept, changing;
    for (const StructureBody& from : bodies) {
        Body& body = bodies_.emplace_back();
        for (const StructurePart& part : from.parts) {
            body.source.add_triangles(triangles.positions, triangles.triangles, part.first_triangle, part.triangles,
                                      from.last_vertex, part.opaque);
            firsts.push_back(part.first_triangle);
        }
        body.update = from.update;
        body.flags = flags_for(body.update);
        body.sizes = sizes_of(device_, body.source, body.flags);
        (body.update == StructureUpdate::keep ? kept : changing).push_back(body.sizes.structure);
    }
    changes_ = !changing.empty();
    std::vector<AccelerationStructure> of_kept, of_changing;
    if (!kept.empty()) of_kept = allocate(loose_storage_, "acceleration structures, not yet compacted", kept);
    if (changes_) of_changing = allocate(changing_storage_, "acceleration structures of what changes", changing);
    size_t next_kept = 0, next_changing = 0;
    for (Body& body : bodies_)
        body.structure =
            std::move(body.update == StructureUpdate::keep ? of_kept[next_kept++] : of_changing[next_changing++]);
    part_triangles_ = Buffer(device_, "first triangles of parts", firsts.size() * 4);
    addresses_ = Buffer(device_, "addresses of acceleration structures", bodies_.size() * sizeof(KhrBody));
    Commands commands(device_);
    commands.upload(part_triangles_, std::span<const uint32_t>(firsts));
}

void Structures::create_top() {
    placed_ = Buffer(device_, "instances of acceleration structures", instances_.count() * sizeof(KhrInstance));
    top_source_.set_instances(placed_, instances_.count(), {});
    const StructureSizes sizes =
        sizes_of(device_, top_source_, VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR);
    top_ = std::move(allocate(top_storage_, "acceleration structure of the instances", {sizes.structure},
                              VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR)[0]);
    top_scratch_ = Buffer(device_, "scratch memory of the instances' build",
                          sizes.build + device_.ray_tracing_limits().scratch_alignment, Buffer::Where::ray_tracing);
}

std::vector<AccelerationStructure> Structures::allocate(Buffer& storage, const std::string& name,
                                                        const std::vector<uint64_t>& bytes,
                                                        VkAccelerationStructureTypeKHR type) {
    std::vector<uint64_t> offsets;
    uint64_t total = 0;
    for (uint64_t size : bytes) {
        offsets.push_back(total);
        total += round_up(size, AccelerationStructure::kAlignment);
    }
    storage = Buffer(device_, name, total, Buffer::Where::ray_tracing);
    std::vector<AccelerationStructure> structures;
    for (size_t i = 0; i < bytes.size(); i++) structures.emplace_back(device_, storage, offsets[i], bytes[i], type);
    return structures;
}

void Structures::build(Commands& commands, const std::vector<Body*>& bodies, Buffer& scratch) {
    const uint64_t alignment = device_.ray_tracing_limits().scratch_alignment;
    const auto updates = [](const Body& body) { return body.update == StructureUpdate::refit && body.built; };
    std::vector<std::vector<StructureBuild>> batches(1);
    uint64_t used = 0, most = 0;
    for (Body* body : bodies) {
        const bool update = updates(*body);
        const uint64_t bytes = round_up(update ? body->sizes.update : body->sizes.build, alignment);
        if (used > 0 && used + bytes > kScratchBytes) batches.emplace_back(), used = 0;
        batches.back().push_back({body->source, body->structure, body->flags, update, used});
        used += bytes;
        most = std::max(most, used);
        body->built = true;
    }
    if (!scratch || scratch.bytes() < most + alignment) {
        scratch.reset();  // first, so that both never live at once
        scratch = Buffer(device_, "scratch memory of builds", most + alignment, Buffer::Where::ray_tracing);
    }
    for (const auto& batch : batches) commands.build("blas", batch, scratch);
}

void Structures::build_kept(Commands& commands, const std::function<void()>& submitted) {
    if (kept_built_) return;
    kept_built_ = true;
    std::vector<Body*> kept;
    for (Body& body : bodies_)
        if (body.update == StructureUpdate::keep) kept.push_back(&body);
    Buffer scratch;
    if (!kept.empty()) {
        commands.begin_group("build");
        build(commands, kept, scratch);
        commands.end_group();
    }
    commands.submit();
    submitted();
    if (!kept.empty()) {
        scratch.reset();
        std::vector<AccelerationStructure> loose;
        for (Body* body : kept) loose.push_back(std::move(body->structure));
        loose_bytes_ = loose_storage_.bytes();
        std::vector<AccelerationStructure> compact =
            allocate(kept_storage_, "acceleration structures", commands.compacted_bytes(loose));
        commands.begin_group("build");
        commands.compact("compact", loose, compact);
        commands.end_group();
        commands.submit();
        submitted();
        for (size_t i = 0; i < kept.size(); i++) kept[i]->structure = std::move(compact[i]);
        loose.clear();
        loose_storage_.reset();
    }
    upload_addresses(commands);
}

/// Where the bodies' structures lie, which is known once what is kept is compacted.
void Structures::upload_addresses(Commands& commands) {
    std::vector<KhrBody> addresses;
    uint32_t part = 0;
    for (const Body& body : bodies_) {
        const VkDeviceAddress address = body.structure.address();
        addresses.push_back({{uint32_t(address), uint32_t(address >> 32)}, part});
        part += uint32_t(body.source.counts().size());
    }
    commands.upload(addresses_, std::span<const KhrBody>(addresses));
    for (const Buffer* storage : {&kept_storage_, &changing_storage_})
        if (*storage) top_.shown.push_back(storage);
    top_source_.set_instances(placed_, instances_.count(), top_.shown);
}

void Structures::record(Commands& commands, bool moved) {
    if (top_built_ && !moved && !changes_) return;
    commands.begin_group("build");
    std::vector<Body*> changing;
    for (Body& body : bodies_)
        if (body.update != StructureUpdate::keep) changing.push_back(&body);
    if (!changing.empty()) build(commands, changing, scratch_);
    commands.run(device_.pass("khr_instances"),
                 {{"instances", instances_.table()}, {"khr_bodies", addresses_}, {"khr_instances", placed_}},
                 instances_.count(), groups_for(instances_.count(), 64));
    const StructureBuild top{top_source_, top_, VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR};
    commands.build("tlas", std::span(&top, 1), top_scratch_);
    commands.end_group();
    top_built_ = true;
}

Structures::Stats Structures::stats() const {
    Stats stats;
    stats.bodies = uint32_t(bodies_.size());
    for (const Body& body : bodies_) stats.kept += body.update == StructureUpdate::keep;
    stats.kept_bytes = kept_storage_.bytes();
    stats.loose_bytes = loose_bytes_;
    for (const Buffer* buffer :
         {&kept_storage_, &changing_storage_, &top_storage_, &placed_, &part_triangles_, &addresses_})
        stats.bytes += buffer->bytes();
    stats.scratch_bytes = scratch_.bytes() + top_scratch_.bytes();
    return stats;
}

}  // namespace peelray
