#include "render/shadow_maps.h"

#include <algorithm>

#include "base/error.h"
#include "render/cube_faces.h"

namespace peelray {
namespace {

constexpr uint32_t kSingle = 2048, kFace = 1024, kSmallest = 32;
constexpr uint64_t kMostShadowBytes = 512ull << 20;
constexpr float kWidest = 1.75f;  // tangent of the half angle beyond which six faces serve better than one map

void set_view(Frame& frame, const glm::vec3& eye, const glm::vec3& forward, float half) {
    const glm::vec3 side = std::abs(forward.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    frame.eye = eye;
    frame.forward = forward;
    frame.right = glm::normalize(glm::cross(forward, side)) * half;
    frame.up = glm::normalize(glm::cross(frame.right, forward)) * half;
}

/// The box's extent around the axis `forward` from `eye`, as the tangent of an angle; infinite if some of it lies
/// behind.
float tangent_around(const glm::vec3& eye, const glm::vec3& forward, std::span<const glm::vec3> box) {
    float tangent = 0;
    for (const glm::vec3& corner : box) {
        const float ahead = glm::dot(corner - eye, forward);
        if (!(ahead > 0)) return INFINITY;
        tangent = std::max(tangent, glm::length(corner - eye - ahead * forward) / ahead);
    }
    return tangent;
}

}  // namespace

std::vector<Frame> ShadowMaps::views_of(const GpuLight& light, std::span<const glm::vec3> box,
                                        const Frame& picture) const {
    Frame frame = picture;
    const glm::vec3 centre = 0.5f * (box.front() + box.back());
    const float radius = std::max(0.5f * glm::length(box.back() - box.front()), 1e-30f);
    if (light.kind == 0) {
        set_view(frame, centre, light.direction, 1);
        glm::vec3 half(0);
        for (const glm::vec3& corner : box) {
            const glm::vec3 p = corner - centre;
            half = glm::max(
                half, glm::abs(glm::vec3(glm::dot(p, frame.right), glm::dot(p, frame.up), glm::dot(p, frame.forward))));
        }
        // A little larger, for the taps beside the outermost point; never flat.
        half = glm::max(half, glm::vec3(1e-3f * radius)) * (1 + 8.0f / kSingle);
        frame.right *= half.x;
        frame.up *= half.y;
        frame.eye = centre - frame.forward * (half.z + 0.01f * radius);
        frame.orthographic = 1;
        frame.far = 2 * (half.z + 0.01f * radius);
        return {frame};
    }
    frame.orthographic = 0;
    frame.near = 1e-4f * radius;
    glm::vec3 axis = light.direction;
    float tangent = INFINITY;
    if (light.kind == 2) {
        const float cosine = std::clamp(-light.cone_offset / light.cone_scale, 0.0f, 1.0f);
        tangent = cosine > 1e-3f ? std::sqrt(1 - cosine * cosine) / cosine : INFINITY;
    } else if (glm::length(centre - light.position) > 0) {
        axis = glm::normalize(centre - light.position);
        tangent = tangent_around(light.position, axis, box);
    }
    if (tangent <= kWidest) {
        set_view(frame, light.position, axis, std::max(tangent, 1e-3f) * (1 + 8.0f / kSingle));
        return {frame};
    }
    std::vector<Frame> faces;
    // Two texels more on each side: taps stay on their face.
    for (uint32_t face = 0; face < 6; face++) {
        look_through_face(frame, light.position, face, 1 + 4.0f / (stats_.face_size - 4));
        faces.push_back(frame);
    }
    return faces;
}

void ShadowMaps::prepare(Commands& commands, const std::vector<GpuLight>& lights, const glm::vec3& lower,
                         const glm::vec3& upper, const Frame& picture) {
    std::vector<glm::vec3> box;  // opposite corners first and last
    for (int i = 0; i < 8; i++)
        box.push_back({i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z});
    const uint64_t room = std::min<uint64_t>(device_.limits().maxStorageBufferRange, kMostShadowBytes);
    std::vector<Frame> frames;
    uint64_t texels = 0;
    for (uint32_t shift = 0;; shift++) {
        stats_ = {};
        stats_.size = kSingle >> shift;
        stats_.face_size = kFace >> shift;
        if (stats_.face_size < kSmallest)
            fail("the shadow maps of {} lights do not fit into {} MiB: leave shadow out of {}, or use another {}",
                 lights.size(), room >> 20, setting::effects, setting::tracer);
        maps_.assign(std::max<size_t>(lights.size(), 1) * 6, GpuShadowMap{});
        frames.clear();
        used_.clear();
        texels = 0;
        for (size_t i = 0; i < lights.size(); i++) {
            const std::vector<Frame> views = views_of(lights[i], box, picture);
            const uint32_t size = views.size() == 1 ? stats_.size : stats_.face_size;
            for (size_t k = 0; k < views.size(); k++) {
                Frame frame = views[k];
                frame.width = frame.height = frame.row_pixels = size;
                used_.push_back(uint32_t(6 * i + k));
                maps_[6 * i + k] = {frame.eye, uint32_t(texels),   frame.right,  size,
                                    frame.up,  frame.orthographic, frame.forward};
                frames.push_back(frame);
                texels += uint64_t(size) * size;
            }
        }
        if (texels * 4 <= room) break;
    }
    stats_.maps = uint32_t(used_.size());
    stats_.bytes = texels * 4;
    ensure_size(device_, map_buffer_, "shadow map table", maps_.size() * sizeof(GpuShadowMap));
    commands.upload(map_buffer_, std::span<const GpuShadowMap>(maps_));
    ensure_size(device_, depths_, "shadow maps", texels * 4);
    if (frames.empty()) return;
    ensure_size(device_, frames_, "shadow map views", frames.size() * sizeof(Frame));
    commands.upload(frames_, std::span<const Frame>(frames));
}

void ShadowMaps::render(Commands& commands, const GpuScene& scene, const ObjectTable& objects,
                        const std::function<void()>& submitted) {
    commands.begin_group("shadow_map");
    for (size_t i = 0; i < used_.size(); i++) {
        const GpuShadowMap& map = maps_[used_[i]];
        ViewTarget& target = map.size == stats_.size ? single_ : sixfold_;
        target.resize(device_, map.size, map.size);
        commands.copy(frames_, target.frame, sizeof(Frame), i * sizeof(Frame));
        objects.record_visibility(commands, device_, scene, target, {~0u, 1, glm::vec2(0.5f)});
        commands.run(device_.pass("shadow_depth"),
                     {{"frame", target.frame},
                      {"positions", scene.triangles.positions},
                      {"triangles", scene.triangles.triangles},
                      {"visibility", target.visibility},
                      {"shadow_depths", depths_},
                      {"instances", scene.instances.table()}},
                     MapParams{map.first, map.size}, groups_for(uint64_t(map.size) * map.size, 64));
    }
    commands.end_group();
    commands.submit();
    submitted();
}

}  // namespace peelray
