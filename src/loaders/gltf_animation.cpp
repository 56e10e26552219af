// Skins and animations of a glTF file.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.h"
#include "loaders/gltf.h"

namespace peelray {
namespace {

/// Scene::nodes by the file's own number; -1: not shown.
std::vector<int> nodes_by_source(const GltfLoader& loader) {
    std::vector<int> out(loader.file.model().nodes.size(), -1);
    for (size_t i = 0; i < loader.scene.nodes.size(); ++i)
        if (const int source = loader.scene.nodes[i].source; source >= 0) out[size_t(source)] = int(i);
    return out;
}

std::vector<glm::mat4> inverse_bind_matrices(GltfLoader& loader, int accessor, size_t joints,
                                             const std::string& where) {
    std::vector<glm::mat4> out(joints, glm::mat4(1));
    if (accessor < 0) return out;
    const GltfFile::Accessor info = loader.file.accessor(accessor);
    if (info.components != 16 || info.count < joints)
        fail("{}: inverseBindMatrices needs a 4x4 matrix for each of {} joints, {} has {} of {} numbers", where, joints,
             info.where, info.count, info.components);
    if (!info.is_float())
        fail("{}: inverseBindMatrices must be floats, {} are components of type {}", where, info.where,
             info.component_type);
    const std::vector<float> values = loader.file.floats(accessor);
    for (size_t i = 0; i < joints; ++i)
        for (int k = 0; k < 16; ++k) {
            const float value = values[i * 16 + size_t(k)];
            if (!std::isfinite(value)) fail("{}: the inverse bind matrix {} is not finite", where, i);
            out[i][k / 4][k % 4] = value;
        }
    const auto is_invalid = [](const glm::mat4& m) { return m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1; };
    if (const auto count = std::count_if(out.begin(), out.end(), is_invalid))
        loader.ignored
            ["{} inverse bind matri{x|ces} whose last row is not 0, 0, 0, 1 used as {it is|they are} "
             "(ACCESSOR_INVALID_IBM)"] += size_t(count);
    return out;
}

class AnimationReader {
  public:
    AnimationReader(GltfLoader& loader, size_t index)
        : loader_(loader),
          from_(loader.file.model().animations[index]),
          where_(loader.file.where("animations", index)) {}

    Animation read(const std::vector<int>& nodes) {
        Animation out;
        out.name = from_.name;
        std::set<std::pair<int, AnimationChannel::Path>> moved;
        for (size_t i = 0; i < from_.channels.size(); ++i) {
            const std::string where = fmt::format("{}.channels[{}]", where_, i);
            const tinygltf::AnimationChannel& from = from_.channels[i];
            if (from.sampler < 0 || size_t(from.sampler) >= from_.samplers.size())
                fail("{}: sampler {} is out of range, the animation has {}", where, from.sampler,
                     from_.samplers.size());
            // A channel without a node names one beyond the last, see check_gltf().
            const int node = size_t(from.target_node) < nodes.size() ? nodes[size_t(from.target_node)] : -1;
            AnimationChannel channel;
            if (!accept(from.target_path, node, channel)) continue;
            read_keys(from_.samplers[size_t(from.sampler)], channel, where);
            if (!moved.emplace(node, channel.path).second)
                ++loader_.ignored
                      ["{} animation channel{|s} that {moves|move} what an earlier one moves already: the later one "
                       "counts"];
            out.duration = std::max(out.duration, channel.times.back());
            out.channels.push_back(std::move(channel));
        }
        return out;
    }

  private:
    /// What the channel moves; false: nothing that is here.
    bool accept(const std::string& path, int node, AnimationChannel& channel) {
        using Path = AnimationChannel::Path;
        if (node < 0) {
            ++loader_.ignored["{} animation channel{|s} of nodes that are not shown ignored"];
            return false;
        }
        const Node& target = loader_.scene.nodes[size_t(node)];
        channel.node = node;
        if (path == "weights") {
            const int shown = shown_mesh(node);
            const Mesh* mesh = shown < 0 ? nullptr : &loader_.scene.meshes[size_t(shown)];
            size_t targets = 0;
            if (mesh)
                for (const Primitive& primitive : mesh->primitives)
                    targets = std::max(targets, primitive.targets.size());
            channel.path = Path::weights;
            channel.width = uint32_t(targets);
            if (targets == 0) ++loader_.ignored["{} animation channel{|s} of weights without morph targets ignored"];
            return targets > 0;
        }
        if (path != "translation" && path != "rotation" && path != "scale") {
            ++loader_.ignored["{} animation channel{|s} of an unknown path ignored"];
            return false;
        }
        if (target.fixed) {
            ++loader_.ignored["{} animation channel{|s} of nodes with a matrix ignored"];
            return false;
        }
        channel.path = path == "translation" ? Path::translation : path == "rotation" ? Path::rotation : Path::scale;
        channel.width = path == "rotation" ? 4 : 3;
        return true;
    }

    /// The node's mesh, or that of its instances, which come behind it; −1: none.
    int shown_mesh(int node) const {
        const std::vector<Node>& all = loader_.scene.nodes;
        const size_t next = size_t(node) + 1;
        const bool is_instanced = next < all.size() && all[next].is_instance && all[next].parent == node;
        return all[is_instanced ? next : size_t(node)].mesh;
    }

    void read_keys(const tinygltf::AnimationSampler& sampler, AnimationChannel& channel, const std::string& where) {
        using Interpolation = AnimationChannel::Interpolation;
        if (sampler.interpolation == "STEP")
            channel.interpolation = Interpolation::step;
        else if (sampler.interpolation == "CUBICSPLINE")
            channel.interpolation = Interpolation::cubic;
        else if (!sampler.interpolation.empty() && sampler.interpolation != "LINEAR")
            fail("{}: the interpolation \"{}\" is unknown: there are STEP, LINEAR and CUBICSPLINE", where,
                 printable(sampler.interpolation, 20));
        check_types(sampler, channel, where);
        channel.times = loader_.file.floats(sampler.input);
        channel.values = loader_.file.floats(sampler.output);
        if (channel.times.empty()) fail("{}: the animation has no keys", where);
        const size_t per_key = channel.width * (channel.interpolation == Interpolation::cubic ? 3 : 1);
        if (!loader_.file.accessor(sampler.input).is_backed) keep_last_key(channel, per_key);
        check_keys(channel, per_key, where);
    }

    /// Keys without times in the file are all at 0 seconds, where the last one holds.
    void keep_last_key(AnimationChannel& channel, size_t per_key) {
        if (channel.times.size() == 1 || channel.values.size() != channel.times.size() * per_key) return;
        channel.times.resize(1);
        channel.values.erase(channel.values.begin(), channel.values.end() - std::ptrdiff_t(per_key));
        ++loader_.ignored["{} animation channel{|s} whose keys are all at 0 seconds: the last one counts"];
    }

    static void check_keys(const AnimationChannel& channel, size_t per_key, const std::string& where) {
        if (channel.values.size() != channel.times.size() * per_key)
            fail("{}: {} keys need {} numbers, the output has {}", where, channel.times.size(),
                 channel.times.size() * per_key, channel.values.size());
        for (size_t i = 0; i < channel.times.size(); ++i) {
            if (!std::isfinite(channel.times[i]) || channel.times[i] < 0)
                fail("{}: the time {} of key {} is no number of seconds from 0 up; repair the animation", where,
                     channel.times[i], i);
            if (i > 0 && channel.times[i] <= channel.times[i - 1])
                fail("{}: the time {} of key {} is not after the one before; repair the animation", where,
                     channel.times[i], i);
        }
        for (const float value : channel.values)
            if (!std::isfinite(value)) fail("{}: a value is not finite; repair the animation", where);
    }

    void check_types(const tinygltf::AnimationSampler& sampler, const AnimationChannel& channel,
                     const std::string& where) const {
        const GltfFile::Accessor in = loader_.file.accessor(sampler.input), out = loader_.file.accessor(sampler.output);
        if (in.components != 1 || !in.is_float())
            fail("{}: key times must be single floats, {} has {} components of type {}", where, in.where, in.components,
                 in.component_type);
        // Weights are stored as one number per element, however many targets there are.
        const uint32_t components = channel.path == AnimationChannel::Path::weights ? 1 : channel.width;
        if (out.components != components)
            fail("{}: its values need {} components, {} has {}", where, components, out.where, out.components);
        if (!out.is_float() && !out.normalized)
            fail("{}: its values must be floats or normalized integers, {} are components of type {}", where, out.where,
                 out.component_type);
    }

    GltfLoader& loader_;
    const tinygltf::Animation& from_;
    const std::string where_;
};

}  // namespace

void GltfLoader::read_skins() {
    const std::vector<int> nodes = nodes_by_source(*this);
    for (size_t i = 0; i < file.model().skins.size(); ++i) {
        const tinygltf::Skin& from = file.model().skins[i];
        const std::string where = file.where("skins", i);
        Skin skin;
        skin.name = from.name;
        for (const int joint : from.joints) skin.joints.push_back(nodes[size_t(joint)]);
        skin.inverse_bind = inverse_bind_matrices(*this, from.inverseBindMatrices, skin.joints.size(), where);
        scene.skins.push_back(std::move(skin));
    }
    for (Node& node : scene.nodes) {
        if (node.skin < 0 || node.mesh < 0) continue;
        const Skin& skin = scene.skins[size_t(node.skin)];
        const std::string where = file.where("skins", size_t(node.skin));
        // Skins of nodes that nobody sees may be incomplete; this one is seen.
        for (size_t k = 0; k < skin.joints.size(); ++k)
            if (skin.joints[k] < 0) fail("{}: joint {} is not part of the scene; repair the hierarchy", where, k);
        for (const Primitive& primitive : scene.meshes[size_t(node.mesh)].primitives)
            for (const JointWeights& vertex : primitive.joints)
                for (size_t k = 0; k < vertex.joints.size(); ++k)
                    if (vertex.weights[k] > 0 && vertex.joints[k] >= skin.joints.size())
                        fail("{}: a vertex of the mesh \"{}\" follows joint {}, the skin has {}", where,
                             scene.meshes[size_t(node.mesh)].name, vertex.joints[k], skin.joints.size());
    }
}

void GltfLoader::read_animations() {
    const std::vector<int> nodes = nodes_by_source(*this);
    for (size_t i = 0; i < file.model().animations.size(); ++i)
        scene.animations.push_back(AnimationReader(*this, i).read(nodes));
}

}  // namespace peelray
