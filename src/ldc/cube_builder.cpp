#include "ldc/cube_builder.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "ldc/abuffer_rasterizer.h"
#include "ldc/compute_rasterizer.h"
#include "ldc/peel_rasterizer.h"
#include "ldc/pixel_order.h"
#include "ldc/stream_rasterizer.h"
#include "ldc/voxel_order.h"

namespace peelray {
namespace {

/// llvmpipe stops a shader's loops after 65,535 iterations in all, silently, and a ray walks through lists sample by
/// sample. Measured: a list of 30,000 is traced right, one of 45,000 is not; a ray may meet several.
constexpr uint32_t kLongestListOnCpu = 16'000;

BuildSize size_of(const std::vector<CubeBody>& bodies, uint32_t first, uint32_t count) {
    BuildSize size;
    for (uint32_t i = first; i < first + count; i++) {
        if (bodies[i].bare) continue;
        const glm::u64vec3 d = make_grid(bodies[i].lower, bodies[i].upper, bodies[i].resolution).dims;
        size.cells += d.x * d.y * d.z / 4096;
        size.pixels += d.x * d.y + d.y * d.z + d.z * d.x;
        size.triangles += bodies[i].triangles;
    }
    return size;
}

std::unique_ptr<BuildStage> make_order(const CubeLayout& layout) {
    if (layout.by_pixel()) return std::make_unique<PixelOrder>();
    return std::make_unique<VoxelOrder>();
}

/// The part of the program that scratch memory is accounted for as.
constexpr const char* kScratch = "build scratch";

std::unique_ptr<BuildStage> make_rasterizer(Device& device, const Cubes& cubes) {
    const MemoryPart part(device, kScratch);
    if (cubes.layout().streams) return std::make_unique<StreamRasterizer>(device, cubes);
    uint32_t largest = 16;
    for (const CubeBody& body : cubes.bodies()) largest = std::max(largest, round_resolution(body.resolution));
    check_builder(device.features, device.limits(), device.info().name, cubes.layout(), cubes.sampling(), largest);
    switch (cubes.layout().builder) {
        case BuilderKind::compute:
            return std::make_unique<ComputeRasterizer>();
        case BuilderKind::abuffer:
            return std::make_unique<AbufferRasterizer>(device, cubes);
        case BuilderKind::peel:
            return std::make_unique<PeelRasterizer>(device, cubes);
    }
    return nullptr;
}

}  // namespace

CubeBuilder::CubeBuilder(Device& device, Commands& commands, Cubes& cubes, uint32_t first, uint32_t bodies,
                         const TableSize& before, const Refinement& refinement)
    : cubes_(cubes),
      state_(new BuildState{
          device, cubes, before, cubes.has_patches() ? refinement : Refinement{}, {}, {}, {}, {}, {}, {}, {}, {}, {}}),
      rasterizer_(make_rasterizer(device, cubes)),
      order_(make_order(cubes.layout())) {
    const CubeBody &front = cubes.bodies()[first], &back = cubes.bodies()[first + bodies - 1];
    LdcParams& p = state_->params;
    p.first_body = first;
    p.bodies = bodies;
    p.first_triangle = front.first_triangle;
    p.triangles = back.first_triangle + back.triangles - front.first_triangle;
    p.first_cell = uint32_t(before.cells);
    p.first_occupied = uint32_t(before.occupied);
    p.first_node = uint32_t(before.nodes);
    p.first_sample = uint32_t(before.samples);
    p.sampling = uint32_t(cubes.sampling());
    p.by_pixel = cubes.layout().by_pixel() ? (cubes.layout().half_depth ? 2 : 1) : 0;
    const MemoryPart part(device, kScratch);
    state_->counters = Buffer(device, "build counters", sizeof(LdcCounters));
    state_->extent = Buffer(device, "build extent", sizeof(LdcExtent));
    state_->groups = Buffer(device, "build workgroups", LDC_GROUPS * 12);
    state_->readback = Buffer(device, "build counters readback", sizeof(LdcCounters), Buffer::Where::readback);
    const BuildSize size = size_of(cubes.bodies(), first, bodies);
    rasterizer_->guess(*state_, size);
    order_->guess(*state_, size);
    allocate(commands);
}

CubeBuilder::~CubeBuilder() = default;

void CubeBuilder::set_streams(std::vector<DrawnStream> streams) {
    state_->streams = std::move(streams);
}

void CubeBuilder::allocate(Commands& commands) {
    const MemoryPart part(state_->device, kScratch);
    ensure_size(state_->device, state_->fragments, "fragments",
                uint64_t(state_->params.fragment_capacity) * sizeof(LdcFragment));
    rasterizer_->allocate(commands, *state_);
    order_->allocate(commands, *state_);
}

void CubeBuilder::record(Commands& commands, const TriangleBuffers& triangles) {
    commands.begin_group("build");
    commands.fill(state_->counters, 0);
    rasterizer_->clear(commands, *state_);
    order_->clear(commands, *state_);
    commands.run(state_->device.pass("ldc_grids"),
                 {{"body_lower", cubes_.table.lower},
                  {"body_upper", cubes_.table.upper},
                  {"bodies", cubes_.table.entries},
                  {"counters", state_->counters},
                  {"extent", state_->extent}},
                 state_->params, {1});
    rasterizer_->record(commands, *state_, triangles);
    order_->record(commands, *state_, triangles);
    commands.end_group();
}

bool CubeBuilder::finish(Commands& commands) {
    counts_ = {};
    std::memcpy(static_cast<LdcCounters*>(&counts_), state_->readback.mapped(), sizeof(LdcCounters));
    order_->read(*state_, counts_);
    if (counts_.wrapped & LDC_FAR_TOLERANCE)
        fail(
            "the tolerance is more than {} voxels of a cube, which {} voxel cannot hold: choose a smaller {} or {}, or "
            "{} two-level",
            LDC_FARTHEST_BY_VOXEL, setting::traversal, setting::tolerance, setting::ldc, setting::traversal);
    if (counts_.wrapped)
        throw NoRoom(fmt::format("the cubes would hold more than 2^32 {}",
                                 counts_.wrapped & LDC_WRAPPED_CELLS ? "pixels or cells" : "samples"),
                     fmt::format("use a smaller {}", setting::ldc));
    bool grown = rasterizer_->grow(*state_, counts_);
    grown |= order_->grow(*state_, counts_);
    const DeviceInfo& device = state_->device.info();
    if (!grown && counts_.longest > kLongestListOnCpu && device.kind == "CPU")
        fail(
            "{} triangles crowd into one {}, more than rays can walk through on the software device '{}' ({}): use a "
            "larger {}, or a GPU",
            counts_.longest, cubes_.layout().by_pixel() ? "pixel" : "voxel", device.name, kLongestListOnCpu,
            setting::ldc);
    if (!grown) {
        if (!settled_) {
            rasterizer_->settle(*state_, counts_);
            order_->settle(*state_, counts_);
        }
        settled_ = true;
        return true;
    }
    redone_++;
    allocate(commands);
    return false;
}

void CubeBuilder::build(Commands& commands, const TriangleBuffers& triangles) {
    do {
        record(commands, triangles);
        commands.submit();
    } while (!finish(commands));
}

TableSize CubeBuilder::size() const {
    // What was to be refined has a block of finer voxels, behind the nodes.
    return {counts_.cells, counts_.occupied, uint64_t(counts_.nodes) + counts_.refine,
            uint64_t(counts_.fragments) + counts_.fine};
}

uint64_t CubeBuilder::scratch_bytes() const {
    return state_->counters.bytes() + state_->extent.bytes() + state_->groups.bytes() + state_->fragments.bytes() +
           state_->node_masks.bytes() + state_->captured.bytes() + rasterizer_->bytes() + order_->bytes();
}

}  // namespace peelray
