#include "render/cube_maps.h"

#include <algorithm>
#include <bit>

#include "render/cube_faces.h"

namespace peelray {
namespace {

constexpr uint32_t kLargestFace = 512, kUsualFace = 128, kSmallestFace = 16, kMostSamples = 4;
constexpr uint64_t kMostCubeBytes = 512ull << 20, kTexelBytes = 8;

uint32_t level_size(uint32_t face, uint32_t level) {
    return std::max(face >> level, PROBE_SMALLEST_FACE);
}
/// Texels of the levels before `level`, as cubeLevelOffset of cubemap.glsl.
uint32_t level_offset(uint32_t face, uint32_t level) {
    uint32_t offset = 0;
    for (uint32_t i = 0; i < level; i++) offset += 6 * level_size(face, i) * level_size(face, i);
    return offset;
}

}  // namespace

CubeMaps::CubeMaps(Device& device, const GpuScene& scene, const Scene& source, const Geometry& geometry)
    : device_(device), scene_(scene), objects_(source, geometry), shadows_(device), target_(device) {}

bool CubeMaps::place_probes(const std::vector<uint32_t>& chosen, uint64_t room) {
    probes_.clear();
    texel_count_ = 0;
    for (uint32_t object : chosen) {
        const bool rough = objects_.objects()[object].roughest >= 0.05f;  // MIRROR_ROUGHNESS of shading.glsl
        const uint64_t texels = level_offset(face_, rough ? PROBE_LEVELS : 1);
        if ((texel_count_ + texels) * kTexelBytes > room) return false;
        probes_.push_back({object, uint32_t(texel_count_), rough});
        texel_count_ += texels;
    }
    return true;
}

void CubeMaps::choose_probes(const PictureSettings& settings, uint32_t pixels) {
    std::vector<uint32_t> chosen;
    if (settings.bounces > 0)
        for (uint32_t i = 0; i < objects_.objects().size(); i++)
            if (objects_.objects()[i].reflects_or_refracts(settings)) chosen.push_back(i);
    // Where not even the smallest faces fit, the largest objects come first.
    const auto size = [&](uint32_t i) {
        return glm::length(objects_.objects()[i].upper - objects_.objects()[i].lower);
    };
    std::stable_sort(chosen.begin(), chosen.end(), [&](uint32_t a, uint32_t b) { return size(a) > size(b); });
    const uint64_t room = std::min<uint64_t>(device_.limits().maxStorageBufferRange, kMostCubeBytes);
    for (face_ = std::clamp(std::bit_ceil(pixels), kUsualFace, kLargestFace);
         !place_probes(chosen, room) && face_ > kSmallestFace;)
        face_ /= 2;
    if (chosen.empty()) face_ = 0;
    left_out_ = uint32_t(chosen.size() - probes_.size());
    rounds_ = probes_.empty() ? 0 : settings.bounces > 1 ? 2 : 1;
    samples_ = std::min(settings.spp, kMostSamples);
}

/// Where an object's probe stands: in the middle of its box. But a sheet's middle may be where something stands on it,
/// and a floor's probe would see nothing but soles. Then it is lifted to the middle of what stands there, whose own
/// inside it does not see: a room's floor looks around from the middle of the room.
glm::vec3 CubeMaps::position(uint32_t object) const {
    const ObjectSummary& sheet = objects_.objects()[object];
    const glm::vec3 size = sheet.upper - sheet.lower;
    glm::vec3 middle = 0.5f * (sheet.lower + sheet.upper);
    const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
    if (size[axis] > 0.01f * std::max({size.x, size.y, size.z})) return middle;
    float largest = 0, lifted = middle[axis];
    for (uint32_t i = 0; i < objects_.objects().size(); i++) {
        const ObjectSummary& other = objects_.objects()[i];
        const float reach = 0.01f * glm::length(other.upper - other.lower),
                    height = other.upper[axis] - other.lower[axis];
        bool above = i != object && height > std::max(reach, largest);
        for (int k = 0; k < 3; k++) {
            const float margin = k == axis ? reach : 0;
            above &= middle[k] >= other.lower[k] - margin && middle[k] <= other.upper[k] + margin;
        }
        if (!above) continue;
        largest = height;
        lifted = 0.5f * (other.lower[axis] + other.upper[axis]);
    }
    middle[axis] = lifted;
    return middle;
}

void CubeMaps::upload_frames(Commands& commands, const Frame& picture) {
    std::vector<Frame> frames;
    for (const Probe& probe : probes_) {
        const ObjectSummary& object = objects_.objects()[probe.object];
        Frame frame = picture;
        frame.backdrop = BACKDROP_ENVIRONMENT;  // of cameras alone
        frame.width = frame.height = frame.row_pixels = face_;
        frame.near = 0.005f * glm::length(object.upper - object.lower);
        frame.cone = {0, 2.0f / float(face_)};  // a face sees a right angle
        const glm::vec3 eye = position(probe.object);
        // Outermost texel centres on the face's edges.
        for (uint32_t face = 0; face < 6; face++) {
            look_through_face(frame, eye, face, float(face_) / float(face_ - 1));
            frames.push_back(frame);
        }
    }
    ensure_size(device_, frames_, "probe views", frames.size() * sizeof(Frame));
    commands.upload(frames_, std::span<const Frame>(frames));
}

void CubeMaps::prepare(Commands& commands, const PictureSettings& settings, const Frame& picture, const Box& box) {
    objects_.upload(device_, commands);
    shadows_.prepare(commands, settings.shadow ? scene_.light_list : std::vector<GpuLight>(), box.lower, box.upper,
                     picture);
    choose_probes(settings, std::max(picture.width, picture.height));
    for (uint32_t i = 0; i < std::max(rounds_, 1u); i++)
        ensure_size(device_, texels_[i], "probes", texel_count_ * kTexelBytes);
    current_ = nullptr;
    if (probes_.empty()) return;
    std::vector<GpuObject> table = objects_.gpu_objects();
    bool rough = false;
    for (const Probe& probe : probes_) {
        table[probe.object].probe = probe.first;
        table[probe.object].face = face_;
        table[probe.object].levels = probe.rough ? PROBE_LEVELS : 1;
        rough |= probe.rough;
    }
    ensure_size(device_, with_probes_, "objects with probes", table.size() * sizeof(GpuObject));
    commands.upload(with_probes_, std::span<const GpuObject>(table));
    if (rough) ensure_size(device_, mips_, "levels of a probe", level_offset(face_, PROBE_LEVELS) * kTexelBytes);
    target_.resize(device_, face_, face_);
    upload_frames(commands, picture);
}

void CubeMaps::render(Commands& commands, PathQueues& queues, const std::function<void()>& submitted) {
    current_ = nullptr;
    shadows_.render(commands, scene_, objects_, submitted);
    for (uint32_t round = 0; round < rounds_; round++) {
        const Buffer& texels = texels_[round];
        for (size_t i = 0; i < probes_.size(); i++) {
            commands.begin_group("probe");
            record_probe(commands, queues, i, texels);
            commands.end_group();
            commands.submit();
            submitted();
        }
        current_ = &texels;
    }
}

void CubeMaps::record_probe(Commands& commands, PathQueues& queues, size_t index, const Buffer& texels) {
    for (uint32_t face = 0; face < 6; face++) record_face(commands, queues, index, face, texels);
    if (probes_[index].rough) record_blurred(commands, probes_[index], texels);
}

void CubeMaps::record_face(Commands& commands, PathQueues& queues, size_t index, uint32_t face, const Buffer& texels) {
    const Probe& probe = probes_[index];
    commands.copy(frames_, target_.frame, sizeof(Frame), (6 * index + face) * sizeof(Frame));
    LevelParams params{};
    params.capacity = face_ * face_;
    for (uint32_t sample = 0; sample < samples_; sample++) {
        params.jitter = sample_position(sample);
        objects_.record_visibility(commands, device_, scene_, target_, {probe.object, 0, params.jitter});
        record_primary(commands, device_, scene_, target_, queues, params);
        record_shading(commands, target_.frame, queues.level(0), params);
        commands.run(device_.pass("probe_store"),
                     {{"frame", target_.frame},
                      {"nodes", queues.level(0).nodes},
                      {"hits", queues.level(0).traced->hits},
                      {"probes", texels}},
                     MapParams{probe.first + face * face_ * face_, face_, 0, 0, 0, sample},
                     groups_for(params.capacity, 64));
    }
}

void CubeMaps::record_blurred(Commands& commands, const Probe& probe, const Buffer& texels) {
    // A pyramid of means to sample from, ...
    commands.copy(texels, mips_, level_offset(face_, 1) * kTexelBytes, probe.first * kTexelBytes);
    for (uint32_t level = 1; level < PROBE_LEVELS; level++) {
        const uint32_t size = level_size(face_, level);
        const MapParams p{level_offset(face_, level), size, level_offset(face_, level - 1),
                          level_size(face_, level - 1)};
        commands.run(device_.pass("probe_mip"), {{"mips", mips_}}, p, groups_for(6ull * size * size, 64));
    }
    // ... and from it each level by itself.
    for (uint32_t level = 1; level < PROBE_LEVELS; level++) {
        const uint32_t size = level_size(face_, level);
        const float root = float(level) / float(PROBE_LEVELS - 1);
        const MapParams p{probe.first + level_offset(face_, level), size, 0, face_, root * root};
        commands.run(device_.pass("probe_filter"), {{"mips", mips_}, {"probes", texels}}, p,
                     groups_for(6ull * size * size, 64));
    }
}

void CubeMaps::record_shading(Commands& commands, const Buffer& frame, const PathLevel& level,
                              const LevelParams& params) {
    const Groups groups = groups_for(params.capacity, 64);
    commands.run(device_.pass("cubemap_scatter", {scene_.base_colors.constant()}),
                 surface_bindings(scene_, frame,
                                  {{"rays", level.traced->rays},
                                   {"states", level.traced->states},
                                   {"hits", level.traced->hits},
                                   {"nodes", level.nodes},
                                   {"triangle_objects", scene_.triangle_objects},
                                   {"objects", current_ ? with_probes_ : objects_.without_probes()},
                                   Binding::if_used("probes", current_)}),
                 params, groups);
    commands.run(device_.pass("cubemap_shadow", {scene_.base_colors.constant()}),
                 surface_bindings(scene_, frame,
                                  {{"rays", level.traced->rays},
                                   {"hits", level.traced->hits},
                                   {"nodes", level.nodes},
                                   {"lights", scene_.lights},
                                   {"shadow_maps", shadows_.maps()},
                                   {"shadow_depths", shadows_.depths()}}),
                 params, groups);
}

CubeMaps::Stats CubeMaps::stats() const {
    return {uint32_t(probes_.size()), face_, rounds_, samples_, left_out_, rounds_ * texel_count_ * kTexelBytes,
            shadows_.stats()};
}

}  // namespace peelray
