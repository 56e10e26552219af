#include "render/deformer.h"

#include <algorithm>

#include "render/base_colors.h"
#include "render/transforms.h"
#include "scene/deform.h"
#include "scene/transform.h"

namespace peelray {
namespace {

const Node& node_of(const Scene& scene, const Assembly::Piece& place) {
    return scene.nodes[size_t(place.node)];
}

const Primitive& primitive_of(const Scene& scene, const Assembly::Piece& place) {
    return scene.meshes[size_t(node_of(scene, place).mesh)].primitives[place.primitive];
}

bool is_skinned(const Scene& scene, const Assembly::Piece& place) {
    return node_of(scene, place).skin >= 0 && !primitive_of(scene, place).joints.empty();
}

/// World matrices of a piece: its node's, then those that take a vertex at rest to where each joint has it now.
std::vector<glm::mat4> matrices_of(const Scene& scene, const Assembly::Piece& place,
                                   const std::vector<glm::mat4>& worlds) {
    std::vector<glm::mat4> out = {worlds[size_t(place.node)]};
    if (!is_skinned(scene, place)) return out;
    const std::vector<glm::mat4> joints = joint_matrices(scene, node_of(scene, place), worlds, out[0]);
    out.insert(out.end(), joints.begin(), joints.end());
    return out;
}

/// Does the transform of the piece's first vertex turn it inside out?
bool is_mirrored(const Primitive& primitive, const std::vector<glm::mat4>& matrices) {
    glm::mat4 sum(0);
    float all = 0;
    if (matrices.size() > 1 && !primitive.joints.empty())
        for (int k = 0; k < JointWeights::most; k++) {
            const float weight = primitive.joints[0].weights[size_t(k)];
            if (weight == 0) continue;
            sum += weight * matrices[1 + primitive.joints[0].joints[size_t(k)]];
            all += weight;
        }
    return NormalTransform(all > 0 ? sum : matrices[0]).mirrors;
}

}  // namespace

Deformer::Deformer(Device& device, const Scene& scene, const Moment& moment, const Assembly& assembly)
    : device_(device), places_(assembly.pieces) {
    if (places_.empty()) return;
    Commands commands(device);
    has_tangents_ = !assembly.tangents.empty();
    uint32_t groups = 0;
    for (const Assembly::Piece& place : places_) {
        const Primitive& primitive = primitive_of(scene, place);
        DeformPiece piece{};
        piece.first_group = groups;
        piece.vertices = uint32_t(primitive.positions.size());
        piece.first_vertex = place.first_vertex;
        piece.first_triangle = place.first_triangle;
        piece.body = place.body;
        piece.flat_shaded = primitive.flat;
        piece.first_joint = joint_count_;
        piece.first_weight = weight_count_;
        add_rest(primitive, piece);
        if (is_skinned(scene, place)) add_influences(primitive, piece);
        add_targets(primitive, piece);
        const std::vector<glm::mat4> matrices = matrices_of(scene, place, moment.worlds);
        joint_count_ += uint32_t(matrices.size());
        weight_count_ += piece.targets;
        groups += (piece.vertices + 63) / 64;
        flat_ |= primitive.flat;
        mirrored_.push_back(place.mirrored);  // pose() turns over what this moment wants otherwise
        pieces_.push_back(piece);
    }
    const Assembly::Body &first = assembly.bodies[assembly.fixed], &last = assembly.bodies.back();
    params_ = {uint32_t(pieces_.size()), groups, first.first_triangle,
               last.first_triangle + last.triangles - first.first_triangle};
    piece_table_ = upload(device, commands, "deforming pieces", pieces_);
    rest_positions_ = upload(device, commands, "vertices at rest", gathered_.positions);
    rest_normals_ = upload(device, commands, "normals at rest", gathered_.normals);
    if (has_tangents_) rest_tangents_ = upload(device, commands, "tangents at rest", gathered_.tangents);
    influences_ = upload(device, commands, "joint weights", gathered_.influences);
    targets_ = upload(device, commands, "morph targets", gathered_.targets);
    weights_ = Buffer(device, "weights of morph targets", uint64_t(weight_count_) * 4);
    joints_ = Buffer(device, "joints", joint_count_ * sizeof(GpuTransform));
    gathered_ = {};
}

void Deformer::add_rest(const Primitive& primitive, DeformPiece& piece) {
    piece.first_rest = uint32_t(gathered_.positions.size());
    gathered_.positions.insert(gathered_.positions.end(), primitive.positions.begin(), primitive.positions.end());
    gathered_.normals.insert(gathered_.normals.end(), primitive.normals.begin(), primitive.normals.end());
    if (!has_tangents_) return;
    gathered_.tangents.insert(gathered_.tangents.end(), primitive.tangents.begin(), primitive.tangents.end());
    gathered_.tangents.resize(gathered_.positions.size(), glm::vec4(0));
}

/// As many influences for each vertex as the one with the most of them has.
void Deformer::add_influences(const Primitive& primitive, DeformPiece& piece) {
    piece.first_influence = uint32_t(gathered_.influences.size());
    const auto used = [](const JointWeights& vertex) {
        return uint32_t(std::count_if(vertex.weights.begin(), vertex.weights.end(), [](float w) { return w != 0; }));
    };
    for (const JointWeights& vertex : primitive.joints) piece.influences = std::max(piece.influences, used(vertex));
    for (const JointWeights& vertex : primitive.joints) {
        uint32_t count = 0;
        for (size_t k = 0; k < vertex.weights.size(); k++)
            if (vertex.weights[k] != 0) {
                gathered_.influences.push_back({vertex.joints[k], vertex.weights[k]});
                count++;
            }
        for (; count < piece.influences; count++) gathered_.influences.push_back({0, 0});
    }
}

void Deformer::add_targets(const Primitive& primitive, DeformPiece& piece) {
    piece.targets = uint32_t(primitive.targets.size());
    piece.first_target = uint32_t(gathered_.targets.size());
    const auto append = [&](const std::vector<glm::vec3>& differences) {
        gathered_.targets.insert(gathered_.targets.end(), differences.begin(), differences.end());
        if (differences.empty()) gathered_.targets.resize(gathered_.targets.size() + piece.vertices, glm::vec3(0));
    };
    for (const MorphTarget& target : primitive.targets) {
        append(target.positions);
        append(target.normals);
        if (has_tangents_) append(target.tangents);
    }
}

void Deformer::pose(Commands& commands, const Scene& scene, const Moment& moment, const Buffer& triangles) {
    if (empty()) return;
    std::vector<GpuTransform> joints;
    std::vector<float> weights;
    for (size_t i = 0; i < places_.size(); i++) {
        const Primitive& primitive = primitive_of(scene, places_[i]);
        const std::vector<glm::mat4> matrices = matrices_of(scene, places_[i], moment.worlds);
        for (const glm::mat4& matrix : matrices) joints.push_back(gpu_transform(matrix));
        std::vector<float> own = weights_of(scene, moment, size_t(places_[i].node));
        own.resize(primitive.targets.size(), 0.0f);
        weights.insert(weights.end(), own.begin(), own.end());
        const bool mirrors = is_mirrored(primitive, matrices);
        if (mirrors != mirrored_[i]) turn_over(commands, i, primitive, mirrors, triangles);
    }
    commands.upload(joints_, std::span<const GpuTransform>(joints));
    if (!weights.empty()) commands.upload(weights_, std::span<const float>(weights));
}

void Deformer::turn_over(Commands& commands, size_t piece, const Primitive& primitive, bool mirrors,
                         const Buffer& triangles) {
    std::vector<glm::uvec3> turned;
    for (glm::uvec3 t : primitive.triangles) {
        if (mirrors) std::swap(t.y, t.z);
        turned.push_back(t + pieces_[piece].first_vertex);
    }
    commands.upload(triangles, std::span<const glm::uvec3>(turned), pieces_[piece].first_triangle * sizeof(glm::uvec3));
    mirrored_[piece] = mirrors;
}

void Deformer::record(Commands& commands, const BodyTable& bodies, const TriangleBuffers& triangles,
                      const Buffer& normals, const BaseColorBuffers& base_colors) const {
    if (empty()) return;
    commands.begin_group("animate");
    DeformParams params = params_;
    params.first_tangent = base_colors.first_tangent;
    commands.run(device_.pass("deform", {{"with_tangents", has_tangents_}}),
                 {{"pieces", piece_table_},
                  {"rest_positions", rest_positions_},
                  {"rest_normals", rest_normals_},
                  Binding::if_used("rest_tangents", rest_tangents_),
                  Binding::if_used("tangents", has_tangents_ ? &base_colors.uvs : nullptr),
                  {"influences", influences_},
                  {"targets", targets_},
                  {"target_weights", weights_},
                  {"joints", joints_},
                  {"positions", triangles.positions},
                  {"normals", normals},
                  {"body_lower", bodies.lower},
                  {"body_upper", bodies.upper}},
                 params, groups_for(params.groups, 1));
    if (flat_)
        commands.run(device_.pass("deform_flat"),
                     {{"pieces", piece_table_},
                      {"positions", triangles.positions},
                      {"triangles", triangles.triangles},
                      {"normals", normals}},
                     params, groups_for(params.triangles, 64));
    commands.end_group();
}

uint64_t Deformer::bytes() const {
    uint64_t bytes = 0;
    for (const Buffer* buffer : {&piece_table_, &rest_positions_, &rest_normals_, &rest_tangents_, &influences_,
                                 &targets_, &weights_, &joints_})
        bytes += buffer->bytes();
    return bytes;
}

}  // namespace peelray
