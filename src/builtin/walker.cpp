#include "builtin/walker.h"

#include "base/parallel.h"
#include "builtin/parted_mesh.h"
#include "builtin/shapes.h"
#include "builtin/skin_weights.h"
#include "builtin/walker_body.h"
#include "builtin/walker_face.h"
#include "scene/transform.h"

namespace peelray {

using glm::vec3;

const std::array<JointPlace, joint_count>& walker_joints() {
    static const std::array<JointPlace, joint_count> joints = {{
        {"root", Joint::root, {0, 0, 0}},
        {"hips", Joint::root, {0, 0.80f, 0}},
        {"spine", Joint::hips, {0, 0.90f, 0}},
        {"chest", Joint::spine, {0, 1.01f, 0}},
        {"neck", Joint::chest, {0, 1.17f, -0.005f}},
        {"head", Joint::neck, {0, 1.26f, 0}},
        {"left collar", Joint::chest, {0.035f, 1.12f, -0.005f}},
        {"left arm", Joint::left_collar, {0.158f, 1.115f, -0.005f}},
        {"left forearm", Joint::left_arm, {0.2692f, 0.9088f, 0.0036f}},
        {"left hand", Joint::left_forearm, {0.3562f, 0.7208f, 0.0476f}},
        {"right collar", Joint::chest, {-0.035f, 1.12f, -0.005f}},
        {"right arm", Joint::right_collar, {-0.158f, 1.115f, -0.005f}},
        {"right forearm", Joint::right_arm, {-0.2692f, 0.9088f, 0.0036f}},
        {"right hand", Joint::right_forearm, {-0.3562f, 0.7208f, 0.0476f}},
        {"left thigh", Joint::hips, {0.088f, 0.79f, 0}},
        {"left shin", Joint::left_thigh, {0.090f, 0.435f, 0.012f}},
        {"left foot", Joint::left_shin, {0.092f, 0.085f, -0.012f}},
        {"left toes", Joint::left_foot, {0.098f, 0.022f, 0.090f}},
        {"right thigh", Joint::hips, {-0.088f, 0.79f, 0}},
        {"right shin", Joint::right_thigh, {-0.090f, 0.435f, 0.012f}},
        {"right foot", Joint::right_shin, {-0.092f, 0.085f, -0.012f}},
        {"right toes", Joint::right_foot, {-0.098f, 0.022f, 0.090f}},
    }};
    return joints;
}

namespace {

std::vector<Bone> walker_bones() {
    std::vector<Bone> out;
    const auto add = [&](Joint joint, const vec3& a, const vec3& b, float radius) {
        out.push_back({uint16_t(joint), a, b, radius});
    };
    add(Joint::hips, {-0.05f, 0.80f, 0}, {0.05f, 0.80f, 0}, 0.12f);
    add(Joint::spine, {-0.06f, 0.93f, 0.01f}, {0.06f, 0.93f, 0.01f}, 0.125f);
    add(Joint::chest, {-0.06f, 1.07f, 0}, {0.06f, 1.07f, 0}, 0.12f);
    // The ribs below the armpits: otherwise the arms would draw them up.
    add(Joint::chest, {-0.065f, 1.00f, 0}, {0.065f, 1.00f, 0}, 0.125f);
    add(Joint::chest, {0.055f, 1.14f, 0.11f}, {0.072f, 1.00f, 0.138f}, 0.045f);  // the scarf's end
    add(Joint::neck, {0, 1.16f, 0}, {0, 1.23f, 0}, 0.10f);
    add(Joint::head, {0, 1.38f, 0}, {0, 1.64f, -0.03f}, 0.16f);
    const size_t middle = out.size();
    add(Joint::left_collar, joint_position(Joint::left_collar), {0.11f, 1.12f, -0.005f}, 0.085f);
    add(Joint::left_arm, 0.85f * joint_position(Joint::left_arm) + 0.15f * joint_position(Joint::left_forearm),
        joint_position(Joint::left_forearm), 0.060f);
    add(Joint::left_forearm, joint_position(Joint::left_forearm), joint_position(Joint::left_hand), 0.058f);
    const vec3 along = joint_position(Joint::left_hand) - joint_position(Joint::left_forearm);
    add(Joint::left_hand, joint_position(Joint::left_hand), joint_position(Joint::left_hand) + 0.5f * along, 0.055f);
    add(Joint::left_thigh, joint_position(Joint::left_thigh) - vec3(0, 0.05f, 0), joint_position(Joint::left_shin),
        0.08f);
    add(Joint::left_shin, joint_position(Joint::left_shin), joint_position(Joint::left_foot) + vec3(0, 0.06f, 0),
        0.066f);
    add(Joint::left_foot, {0.092f, 0.08f, -0.014f}, {0.097f, 0.03f, 0.060f}, 0.055f);
    add(Joint::left_foot, {0.092f, 0.03f, -0.03f}, {0.097f, 0.03f, 0.060f}, 0.055f);
    add(Joint::left_toes, {0.098f, 0.03f, 0.080f}, {0.099f, 0.03f, 0.14f}, 0.055f);
    const size_t end = out.size();
    constexpr int to_right = int(Joint::right_collar) - int(Joint::left_collar);
    for (size_t i = middle; i < end; ++i) {
        Bone bone = out[i];
        bone.joint = uint16_t(bone.joint + to_right);
        bone.a.x = -bone.a.x;
        bone.b.x = -bone.b.x;
        out.push_back(bone);
    }
    return out;
}

/// How far a joint's bend spreads over the skin.
float softness(const vec3& p) {
    if (p.y < 0.12f && p.z > 0) return 0.028f;
    if (p.y < 0.2f) return 0.022f;
    if (std::abs(p.x) > 0.25f) return p.y > 0.83f ? 0.045f : 0.025f;
    if (p.y > 1.2f) return 0.02f;
    if (std::abs(p.x) > 0.11f && p.y > 0.88f) return 0.042f;
    return 0.045f;
}

float cheeks(const vec3& p) {
    return glm::distance(vec3(std::abs(p.x), p.y, p.z), vec3(0.088f, 1.352f, 0.118f)) - 0.026f;
}

/// Edges are shorter where the surface bends more.
float triangle_size(const vec3& p) {
    if (cheeks(p) < 0.02f) return 0.0095f;
    if (p.y > 1.40f && p.y < 1.55f && glm::length(glm::vec2(p.x, p.z)) > 0.135f) return 0.012f;  // the cap's brim
    if (p.y > 1.25f && p.z > 0.05f) return 0.0155f;
    if (p.y < 0.035f) return 0.012f;
    if (p.y < 0.17f || (std::abs(p.x) > 0.27f && p.y < 0.8f)) return 0.015f;
    if (std::abs(p.x) > 0.12f && p.y > 0.84f && p.y < 1.02f) return 0.016f;                        // armpits and elbows
    if (p.z > 0.09f && std::abs(p.x - 0.06f) < 0.07f && p.y > 0.93f && p.y < 1.2f) return 0.015f;  // the scarf's end
    return std::abs(p.y - 0.77f) < 0.03f ? 0.017f : 0.0235f;
}

/// How far down the line between two joints of its side a point lies, and how far off that line.
glm::vec2 along(Joint left_from, Joint left_to, const vec3& p) {
    const vec3 from = joint_position(left_from), direction = glm::normalize(joint_position(left_to) - from);
    const vec3 way = vec3(std::abs(p.x), p.y, p.z) - from;
    const float down = glm::dot(way, direction);
    return {down, glm::length(way - down * direction)};
}

bool is_sleeve(const vec3& p) {
    return along(Joint::left_arm, Joint::left_forearm, p).y < 0.085f ||
           along(Joint::left_forearm, Joint::left_hand, p).y < 0.07f;
}

constexpr auto meanwhile = uint32_t(Garment::count), sleeves = meanwhile + 1;

/// Lets edges run along a line without giving anything away: a rounded hem needs them to shade evenly.
void draw_line(PartedMesh& mesh, uint32_t part, const Field& line) {
    mesh.give(part, meanwhile, line);
    mesh.give_rest(meanwhile, [&](const vec3&) { return part; });
}

/// Gives what of a part lies between two values of a coordinate to another part. One line after the other: a triangle
/// may be larger than the space between them.
void give_band(PartedMesh& mesh, uint32_t from, Garment to, const Field& coordinate, float low, float high) {
    mesh.give(from, meanwhile, [&](const vec3& p) { return coordinate(p) - high; });
    mesh.give(meanwhile, uint32_t(to), [&](const vec3& p) { return low - coordinate(p); });
    mesh.give_rest(meanwhile, [&](const vec3&) { return from; });
}

/// Hems, stripes around the chest and the arms, and red cheeks.
void paint(PartedMesh& mesh) {
    const Field height = [](const vec3& p) { return p.y; };
    const Field down_forearm = [](const vec3& p) { return along(Joint::left_forearm, Joint::left_hand, p).x; };
    constexpr auto jumper = uint32_t(Garment::jumper);
    draw_line(mesh, uint32_t(Garment::trousers), [](const vec3& p) { return p.y - 0.146f; });
    // Chest and sleeves have stripes of their own; they are told apart somewhere at the shoulder, without a cut.
    mesh.give_rest(jumper, [](const vec3& p) { return is_sleeve(p) ? sleeves : jumper; });
    for (const float height : {0.783f, 0.768f}) draw_line(mesh, jumper, [&](const vec3& p) { return p.y - height; });
    for (const float low : {0.832f, 0.876f}) give_band(mesh, jumper, Garment::stripes, height, low, low + 0.024f);
    for (const float low : {0.088f, 0.130f})
        give_band(mesh, sleeves, Garment::stripes, down_forearm, low, low + 0.022f);
    const float sleeve = glm::distance(joint_position(Joint::left_forearm), joint_position(Joint::left_hand));
    draw_line(mesh, sleeves,
              [&](const vec3& p) { return sleeve - 0.027f - along(Joint::left_forearm, Joint::left_hand, p).x; });
    mesh.give_rest(sleeves, [](const vec3&) { return jumper; });
    mesh.give(uint32_t(Garment::skin), uint32_t(Garment::cheeks), cheeks);
}

/// The surface of the body, each triangle with its garment.
PartedMesh dressed(const SoftBody& body, const Field& field) {
    ClosedMesh mesh = polygonise(field, {-0.45f, -0.03f, -0.25f}, {0.45f, 1.80f, 0.25f}, 0.02f);
    remesh(mesh, field, triangle_size, 4);
    PartedMesh out(std::move(mesh), field);
    constexpr uint32_t nobody = meanwhile;
    out.give_all(nobody);
    for (uint32_t part = 0; part < uint32_t(Garment::stripes); ++part)
        out.give(nobody, part, [&](const vec3& p) { return body.margin(part, p); });
    // Where three garments meet a triangle may be left over.
    out.give_rest(nobody, [&](const vec3& p) { return body.part_at(p); });
    paint(out);
    out.improve(0.0035f);
    return out;
}

/// What a part is painted onto.
Garment ground_of(Garment garment) {
    return garment == Garment::stripes ? Garment::jumper : garment == Garment::cheeks ? Garment::skin : garment;
}

/// The normal of a garment at a vertex: its own field's, as if it went on below the next garment, so that the crease
/// between them is sharp. On the crease, where the field has turned away from the triangles, that of the triangles.
vec3 normal_at(const PartedMesh& dress, uint32_t vertex, Garment ground, const Field& own) {
    const ClosedMesh& mesh = dress.mesh();
    vec3 sum(0);
    bool on_crease = false;
    mesh.for_each_around(vertex, [&](uint32_t h) {
        const bool is_own = ground_of(Garment(dress.parts()[h / 3])) == ground;
        if (is_own) sum += mesh.area_vector(h / 3);
        on_crease |= !is_own;
    });
    const vec3 of_triangles = unit_or(sum, vec3(0, 1, 0));
    return on_crease ? of_triangles : unit_or(gradient(own, mesh.positions[vertex]), of_triangles);
}

/// The triangles of one garment with their vertices.
Primitive piece_of(const PartedMesh& dress, Garment garment, const SoftBody& body,
                   const std::vector<JointWeights>& weights) {
    const ClosedMesh& mesh = dress.mesh();
    const Garment ground = ground_of(garment);
    const Field own = [&](const vec3& p) { return body.at(uint32_t(ground), p); };
    std::vector<uint32_t> renumbered(mesh.positions.size(), ClosedMesh::none);
    Primitive out;
    for (uint32_t t = 0; t < dress.parts().size(); ++t) {
        if (Garment(dress.parts()[t]) != garment) continue;
        glm::uvec3 triangle;
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh.from(3 * t + uint32_t(k));
            if (renumbered[vertex] == ClosedMesh::none) {
                renumbered[vertex] = uint32_t(out.positions.size());
                out.positions.push_back(mesh.positions[vertex]);
                out.normals.push_back(normal_at(dress, vertex, ground, own));
                out.joints.push_back(weights[vertex]);
            }
            triangle[k] = renumbered[vertex];
        }
        out.triangles.push_back(triangle);
    }
    return out;
}

/// Joint weights of a body that only the head carries.
void hang_on_head(Primitive& p) {
    JointWeights head;
    head.joints[0] = uint16_t(Joint::head);
    head.weights[0] = 1;
    p.joints.assign(p.positions.size(), head);
}

}  // namespace

std::vector<Material> walker_materials() {
    // In the order of Garment, then eyes, and brows with mouth.
    std::vector<Material> out = {matte("trousers", {0.045f, 0.075f, 0.19f}),
                                 matte("boots", {0.24f, 0.105f, 0.04f}),
                                 matte("soles", {0.80f, 0.74f, 0.62f}),
                                 matte("jumper", {0.83f, 0.45f, 0.04f}),
                                 matte("mittens", {0.60f, 0.06f, 0.045f}),
                                 matte("scarf", {0.60f, 0.06f, 0.045f}),
                                 matte("skin", {0.83f, 0.52f, 0.37f}),
                                 matte("hair", {0.10f, 0.045f, 0.02f}),
                                 matte("cap", {0.60f, 0.06f, 0.045f}),
                                 matte("brim", {0.83f, 0.78f, 0.68f}),
                                 matte("bobble", {0.83f, 0.78f, 0.68f}),
                                 matte("stripes", {0.83f, 0.78f, 0.68f}),
                                 matte("cheeks", {0.83f, 0.34f, 0.25f}),
                                 matte("eyes", {0.012f, 0.01f, 0.01f}),
                                 matte("brows and mouth", {0.09f, 0.035f, 0.02f})};
    out[size_t(Garment::count)].roughness = 0;
    return out;
}

std::vector<Primitive> walker_skin(uint32_t first_material) {
    const SoftBody body = walker_body();
    const Field field = [&](const vec3& p) { return body.at(p); };
    const PartedMesh dress = dressed(body, field);
    const std::vector<JointWeights> weights = soft_weights(dress.mesh(), walker_bones(), joint_count, softness);
    std::vector<Primitive> out;
    for (uint32_t part = 0; part < uint32_t(Garment::count); ++part)
        out.push_back(piece_of(dress, Garment(part), body, weights));
    WalkerFace face = walker_face([&](const vec3& p) { return body.at(uint32_t(Garment::skin), p); });
    for (Primitive* p : {&face.eyes, &face.lines}) {
        hang_on_head(*p);
        out.push_back(std::move(*p));
    }
    for (size_t i = 0; i < out.size(); ++i) out[i].material = first_material + uint32_t(i);
    return out;
}

}  // namespace peelray
