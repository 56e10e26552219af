#include "render/photons.h"

#include <algorithm>
#include <bit>
#include <numbers>

#include "base/error.h"
#include "common/ray.h"
#include "common/scan_params.h"
#include "render/base_colors.h"
#include "render/paths.h"

namespace peelray {
namespace {

/// Software devices end a shader's loops after 65,535 iterations, of which each takes four photons.
constexpr uint32_t kMostInSoftware = 200'000;
constexpr uint32_t kLeastBuckets = 1024, kMostBuckets = 1u << 22;
/// What radiance is counted in, over that of one photon in the middle of its disc, on a white surface.
constexpr double kUnit = 1.0 / (1 << 24);

}  // namespace

void PhotonMap::prepare(FrameState& f, PhotonPlan plan) {
    plan_ = std::move(plan);
    const MemoryPart part(device_, "photons");
    const uint64_t n = plan_.photons, most = device_.limits().maxStorageBufferRange;
    const uint64_t largest = n * (f.layered() ? sizeof(MediaWall) : sizeof(Photon));
    if (largest > most)
        fail("{} photons need {:.0f} MiB at once, but the device '{}' binds at most {:.0f}: choose a smaller {}", n,
             double(largest) / (1 << 20), device_.info().name, double(most) / (1 << 20), setting::caustics);
    if (device_.info().kind == "CPU" && n > kMostInSoftware)
        fail("{} photons are too many for the software device '{}': choose at most {} ({}), or {} reference", n,
             device_.info().name, kMostInSoftware, setting::caustics, setting::tracer);
    lamps_ = upload(device_, f.commands, "lamps of photons", plan_.lamps);
    targets_ = upload(device_, f.commands, "targets of photons", plan_.targets);
    thresholds_ = upload(device_, f.commands, "thresholds of targets", plan_.thresholds);
    ensure_size(device_, rays_, "rays of photons", n * sizeof(Ray));
    ensure_size(device_, skip_, "origins of photons", n * sizeof(SurfaceId));
    ensure_size(device_, hits_, "hits of photons", n * sizeof(Hit));
    ensure_size(device_, states_, "states of photons", n * sizeof(PhotonState));
    ensure_size(device_, photons_, "photons", n * sizeof(Photon));
    ensure_size(device_, sorted_, "sorted photons", n * sizeof(Photon));
    if (f.layered()) {
        ensure_size(device_, media_, "media of photons", n * sizeof(MediaStack));
        ensure_size(device_, walls_, "walls of media of photons", n * sizeof(MediaWall));
    }
    buckets_ = std::clamp(std::bit_ceil(plan_.photons), kLeastBuckets, kMostBuckets);
    ensure_size(device_, sums_, "buckets of photons", uint64_t(buckets_) * sizeof(glm::uvec2));
    ensure_size(device_, block_sums_, "sums of buckets of photons",
                (uint64_t(buckets_) / SCAN_BLOCK + 2) * sizeof(glm::uvec2));
}

void PhotonMap::record(FrameState& f, uint32_t sample) {
    const PhotonPass pass = photon_pass(plan_, f.settings, sample);
    radius_ = pass.radius;
    f.commands.begin_group("caustics");
    record_flight(f, pass);
    record_grid(f);
    f.commands.end_group();
}

void PhotonMap::record_flight(FrameState& f, const PhotonPass& pass) {
    f.commands.fill(f.queues.counters(), plan_.photons, QUEUE_PHOTON_RAYS * 4, 4);
    if (f.layered()) f.commands.fill(media_, 0);  // air
    PhotonEmitParams p{};
    p.centre = plan_.centre;
    p.reach = plan_.reach;
    p.count = plan_.photons;
    p.bits = pass.bits;
    p.seed = pass.seed;
    p.picture = pass.picture;
    p.offset = pass.offset;
    p.lamps = uint32_t(plan_.lamps.size());
    p.targets = uint32_t(plan_.targets.size());
    p.soft = is_sampled(f.settings);
    f.commands.run(device_.pass("photon_emit"),
                   {{"lights", f.scene.lights},
                    {"photon_lamps", lamps_},
                    {"photon_targets", targets_},
                    {"photon_thresholds", thresholds_},
                    {"rays", rays_},
                    {"skip", skip_},
                    {"photon_states", states_},
                    {"photons", photons_}},
                   p, groups_for(p.count, 64));
    const uint32_t levels = bounce_levels(f.settings, f.scene.has_blended);
    for (uint32_t level = 0; level <= levels; level++) {
        record_trace(f);
        record_scatter(f, pass, level, level == levels);
    }
}

void PhotonMap::record_trace(FrameState& f) {
    RayQueue queue{rays_, &skip_, plan_.photons};
    queue.counters = &f.queues.counters();
    queue.counter = QUEUE_PHOTON_RAYS;
    if (f.layered())
        f.tracer->trace_layered(f.commands,
                                {queue, hits_, media_, walls_, false, f.scene.base_colors.constant(), surfaces_of(f)});
    else
        f.tracer->trace(f.commands, queue, hits_, {});
}

void PhotonMap::record_scatter(FrameState& f, const PhotonPass& pass, uint32_t level, bool last) {
    const PhotonScatterParams p{plan_.photons, pass.bits, pass.seed, pass.picture, level, last, float(plan_.flux)};
    const bool layered = f.layered();
    f.commands.run(device_.pass("photon_scatter", {{"layered", layered}, f.scene.base_colors.constant()}),
                   surface_bindings(f.scene, f.view.target.frame,
                                    {{"rays", rays_},
                                     {"skip", skip_},
                                     {"hits", hits_},
                                     {"photon_states", states_},
                                     {"photons", photons_},
                                     {"lights", f.scene.lights},
                                     {"queue", f.queues.counters()},
                                     Binding::if_used("media_walls", layered ? &walls_ : nullptr),
                                     Binding::if_used("media_ranks", f.scene.media_ranks),
                                     Binding::if_used("media", layered ? &media_ : nullptr)}),
                   p, groups_for(p.count, 64));
}

PhotonGridParams PhotonMap::grid() const {
    return {plan_.box.lower, 1 / (2 * radius_), plan_.photons, buckets_ - 1};
}

void PhotonMap::record_grid(FrameState& f) {
    const PhotonGridParams p = grid();
    const Groups groups = groups_for(p.count, 64), scan_groups = groups_for(buckets_, SCAN_BLOCK);
    const ScanParams scan{buckets_, SCAN_NO_COUNTER};
    // No counter: any buffer does.
    const Buffer& counters = f.queues.counters();
    f.commands.fill(sums_, 0, 0, uint64_t(buckets_) * sizeof(glm::uvec2));
    f.commands.run(device_.pass("photon_count"), {{"photons", photons_}, {"photon_buckets", sums_}}, p, groups);
    f.commands.run(device_.pass("scan_reduce"), {{"counters", counters}, {"sums", sums_}, {"block_sums", block_sums_}},
                   scan, scan_groups);
    f.commands.run(device_.pass("scan_blocks"), {{"block_sums", block_sums_}}, scan, {1});
    f.commands.run(device_.pass("scan_apply"), {{"counters", counters}, {"sums", sums_}, {"block_sums", block_sums_}},
                   scan, scan_groups);
    f.commands.run(device_.pass("photon_sort"),
                   {{"photons", photons_}, {"photon_buckets", sums_}, {"sorted_photons", sorted_}}, p, groups);
}

void PhotonMap::record_gather(FrameState& f, const LevelParams& level) {
    const PhotonGridParams cells = grid();
    // One photon in the middle of its disc, on a white surface.
    const double brightest = plan_.flux * 2 / (std::numbers::pi * std::numbers::pi * double(radius_) * double(radius_));
    const PhotonGatherParams p{level,     cells.lower, cells.inverse_cell, radius_, float(1 / (brightest * kUnit)),
                               cells.mask};
    const PathLevel& here = f.queues.level(level.level);
    const bool layered = f.layered(), camera = level.level == 0 && !layered;
    const std::vector<Binding> bindings =
        surface_bindings(f.scene, f.view.target.frame,
                         {Binding::if_used("rays", camera ? nullptr : &here.traced->rays),
                          Binding::if_used("states", camera ? nullptr : &here.traced->states),
                          Binding::if_used("hits", camera ? nullptr : &here.traced->hits),
                          {"nodes", here.nodes},
                          {"branches", here.branches},
                          {"queue", f.queues.counters()},
                          {"visibility", f.view.target.visibility},
                          {"draws", f.scene.draw_table},
                          Binding::if_used("media_walls", here.traced->walls),
                          Binding::if_used("media_ranks", f.scene.media_ranks),
                          {"photon_buckets", sums_},
                          {"sorted_photons", sorted_}});
    const Pass& pass = device_.pass("photon_gather", {{"camera", camera},
                                                      {"by_number", camera && f.view.by_number()},
                                                      {"layered", layered},
                                                      {"material_kinds", f.shaded_kinds()}});
    if (level.level == 0)
        f.commands.run(pass, bindings, p, groups_for(level.capacity, 64));
    else
        f.commands.run_indirect(pass, bindings, p, f.queues.counters(), PathQueues::groups_offset(level.level));
}

uint64_t PhotonMap::bytes() const {
    uint64_t sum = 0;
    for (const Buffer* buffer : {&lamps_, &targets_, &thresholds_, &rays_, &skip_, &hits_, &states_, &media_, &walls_,
                                 &photons_, &sorted_, &sums_, &block_sums_})
        sum += buffer->bytes();
    return sum;
}

}  // namespace peelray
