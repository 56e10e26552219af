#include "render/merged_instances.h"

#include <algorithm>

#include "ldc/merge_params.h"
#include "render/base_colors.h"
#include "render/transforms.h"

namespace peelray {
namespace {

/// Triangles of a body that `auto` merges: what the rays of builtin:particles gain is many times what the build takes,
/// on software devices as well (docs/lab_notes.md).
constexpr uint32_t kMerged = 1000;
/// Up to eight instances are looked through without a stack.
constexpr size_t kFew = 8;
/// Copies: as many as cubes build in some milliseconds, and of what stands still in half of one.
constexpr uint64_t kMostTriangles = 32'000'000, kMostStill = 1'000'000;

uint32_t most_triangles(const CubeChoice& cubes) {
    const bool possible = cubes.hit == HitTest::exact && !cubes.layout.by_pixel();
    return possible ? cubes.merge.value_or(kMerged) : 0;
}

/// Those that are small and move by themselves or are not alone. If any of them moves, or anything deforms, their cube
/// is built for every frame: then those that stand still are among them only where they are few. Mirrored ones show
/// their triangles from the other side, which copies would not.
std::vector<uint32_t> choose(const Assembly& assembly, const std::vector<glm::mat4>& worlds, uint32_t most) {
    std::vector<uint32_t> chosen, shown(assembly.bodies.size());
    for (const Assembly::Instance& instance : assembly.instances) shown[instance.body]++;
    bool anything_moves = assembly.fixed < assembly.bodies.size();
    uint64_t still = 0;
    for (uint32_t i = 0; i < assembly.instances.size(); i++) {
        const Assembly::Instance& instance = assembly.instances[i];
        const uint32_t triangles = assembly.bodies[instance.body].triangles;
        if (instance.body >= assembly.fixed || triangles > most) continue;
        if (!instance.moves && shown[instance.body] == 1) continue;
        if (glm::determinant(glm::mat3(world_of(instance, worlds))) < 0) continue;
        chosen.push_back(i);
        anything_moves |= instance.moves;
        still += instance.moves ? 0 : triangles;
    }
    if (anything_moves && still > kMostStill)
        std::erase_if(chosen, [&](uint32_t i) { return !assembly.instances[i].moves; });
    return chosen;
}

bool is_worthwhile(const Device& device, const Assembly& assembly, const std::vector<uint32_t>& chosen) {
    if (chosen.size() <= kFew) return false;
    uint64_t triangles = 0, vertices = 0;
    for (const uint32_t i : chosen) {
        triangles += assembly.bodies[assembly.instances[i].body].triangles;
        vertices += assembly.bodies[assembly.instances[i].body].vertices;
    }
    if (triangles > kMostTriangles) return false;
    for (const Assembly::Body& body : assembly.bodies) {
        triangles += body.triangles;
        vertices += body.vertices;
    }
    const uint64_t bytes = std::max(triangles * sizeof(LdcCorners), vertices * sizeof(glm::vec3));
    return bytes <= device.limits().maxStorageBufferRange && triangles < 1u << 30;
}

/// Workgroups for `count` vertices or triangles of each.
template <typename Count>
std::vector<glm::uvec2> groups_of(const std::vector<MergedInstance>& table, Count count) {
    std::vector<glm::uvec2> groups;
    for (uint32_t i = 0; i < table.size(); i++)
        for (uint32_t first = 0; first < count(table[i]); first += 64) groups.emplace_back(i, first);
    return groups;
}

}  // namespace

std::unique_ptr<MergedInstances> MergedInstances::make(Device& device, Commands& commands, const Assembly& assembly,
                                                       const std::vector<glm::mat4>& worlds, const TracerChoice& choice,
                                                       TriangleBuffers& triangles) {
    if (choice.tracer != Tracer::ldc) return nullptr;
    const uint32_t most = most_triangles(choice.cubes);
    const std::vector<uint32_t> chosen = most == 0 ? std::vector<uint32_t>() : choose(assembly, worlds, most);
    if (!is_worthwhile(device, assembly, chosen)) return nullptr;
    return std::unique_ptr<MergedInstances>(new MergedInstances(device, commands, assembly, worlds, chosen, triangles));
}

MergedInstances::MergedInstances(Device& device, Commands& commands, const Assembly& assembly,
                                 const std::vector<glm::mat4>& worlds, const std::vector<uint32_t>& chosen,
                                 TriangleBuffers& triangles)
    : device_(device) {
    std::vector<MergedInstance> table;
    body_.first_triangle = triangles.count;
    body_.first_vertex = triangles.vertices;
    body_.merged = true;
    body_.lower = glm::vec3(INFINITY);
    body_.upper = glm::vec3(-INFINITY);
    merged_.body = uint32_t(assembly.bodies.size());
    for (const uint32_t i : chosen) add(assembly, worlds, i, table);
    moves_ |= assembly.fixed < assembly.bodies.size();  // then it comes behind what deforms
    const std::vector<glm::uvec2> vertex_groups = groups_of(table, [](const auto& each) { return each.vertices; });
    const std::vector<glm::uvec2> groups = groups_of(table, [](const auto& each) { return each.triangles; });
    vertex_groups_ = uint32_t(vertex_groups.size());
    grow(device, commands, triangles.positions, "vertex positions",
         (uint64_t(body_.first_vertex) + body_.vertices) * sizeof(glm::vec3),
         uint64_t(body_.first_vertex) * sizeof(glm::vec3));
    grow(device, commands, triangles.triangles, "triangle indices",
         (uint64_t(body_.first_triangle) + body_.triangles) * sizeof(glm::uvec3),
         uint64_t(body_.first_triangle) * sizeof(glm::uvec3));
    table_ = upload(device, commands, "merged instances", table);
    groups_ = upload(device, commands, "vertices of merged instances", vertex_groups);
    copied_ = Buffer(device, "whose the triangles of merged instances are", body_.triangles * sizeof(glm::uvec2));
    const Buffer triangle_groups = upload(device, commands, "triangles of merged instances", groups);
    commands.run(
        device.pass("merge_triangles"),
        {{"merged", table_}, {"groups", triangle_groups}, {"triangles", triangles.triangles}, {"copied", copied_}},
        MergeParams{uint32_t(groups.size()), body_.first_triangle, merged_.body}, groups_for(groups.size(), 1));
    commands.submit();
}

void MergedInstances::add(const Assembly& assembly, const std::vector<glm::mat4>& worlds, uint32_t instance,
                          std::vector<MergedInstance>& table) {
    const Assembly::Instance& from = assembly.instances[instance];
    const Assembly::Body& body = assembly.bodies[from.body];
    const uint32_t triangle = body_.first_triangle + body_.triangles;
    table.push_back({instance, body.first_triangle, body.first_vertex, triangle, body.triangles,
                     body_.first_vertex + body_.vertices, body.vertices});
    merged_.instances.push_back(instance);
    merged_.copies.push_back(triangle - body.first_triangle);
    moves_ |= from.moves;
    body_.triangles += body.triangles;
    body_.vertices += body.vertices;
    const glm::mat4 to_world = world_of(from, worlds);
    for (int corner = 0; corner < 8; corner++) {
        const glm::bvec3 upper(corner & 1, corner & 2, corner & 4);
        const auto p = glm::vec3(to_world * glm::vec4(glm::mix(body.lower, body.upper, upper), 1));
        body_.lower = glm::min(body_.lower, p);
        body_.upper = glm::max(body_.upper, p);
    }
}

void MergedInstances::record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles,
                             const Instances& instances) const {
    bodies.record_emptying(commands, merged_.body, merged_.body + 1);
    commands.run(device_.pass("merge_vertices"),
                 {{"merged", table_},
                  {"groups", groups_},
                  {"transforms", instances.transforms()},
                  {"positions", triangles.positions},
                  {"body_lower", bodies.lower},
                  {"body_upper", bodies.upper}},
                 MergeParams{vertex_groups_, body_.first_triangle, merged_.body}, groups_for(vertex_groups_, 1));
}

uint64_t MergedInstances::bytes() const {
    return table_.bytes() + groups_.bytes() + copied_.bytes() + body_.triangles * sizeof(glm::uvec3) +
           body_.vertices * sizeof(glm::vec3);
}

}  // namespace peelray
