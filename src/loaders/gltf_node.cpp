#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "loaders/gltf.h"

namespace peelray {

namespace {

void check_finite(const glm::mat4& m, const std::string& where) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) fail("{}: the transform is not finite; repair the node", where);
}

template <typename T>
glm::vec<3, T> to_vector(const std::vector<double>& v, T missing) {
    return v.empty() ? glm::vec<3, T>(missing) : glm::vec<3, T>(v[0], v[1], v[2]);
}

/// From x, y, z, w; a rotation without direction counts as none.
template <typename T, typename From>
glm::qua<T> rotation_of(const From* xyzw) {
    glm::qua<T> rotation;
    rotation.x = static_cast<T>(xyzw[0]), rotation.y = static_cast<T>(xyzw[1]);
    rotation.z = static_cast<T>(xyzw[2]), rotation.w = static_cast<T>(xyzw[3]);
    const T length = glm::length(rotation);
    return length > 0 && std::isfinite(length) ? rotation / length : glm::qua<T>(1, 0, 0, 0);
}

/// Rounded to T.
template <typename T>
Placement placement_of(const tinygltf::Node& from) {
    Placement out;
    if (!from.rotation.empty()) out.rotation = glm::dquat(rotation_of<T>(from.rotation.data()));
    out.translation = to_vector<T>(from.translation, 0);
    out.scale = to_vector<T>(from.scale, 1);
    return out;
}

ExactNode exact_node(const tinygltf::Node& from) {
    ExactNode out;
    out.rest = placement_of<double>(from);
    out.local = from.matrix.empty() ? out.rest.matrix(true) : glm::make_mat4(from.matrix.data());
    return out;
}

/// Whether the columns are at right angles and the last row is that of a placement.
bool is_placement(const glm::mat4& m) {
    if (m[0].w != 0 || m[1].w != 0 || m[2].w != 0 || m[3].w != 1) return false;
    for (int a = 0; a < 3; ++a)
        for (int b = a + 1; b < 3; ++b) {
            const glm::dvec3 u(m[a]), v(m[b]);
            if (std::abs(glm::dot(u, v)) > 0.01 * glm::length(u) * glm::length(v)) return false;
        }
    return true;
}

/// KHR_node_visibility; what hangs below a hidden node is hidden, too, cameras excepted.
bool is_node_hidden(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    return found != node.extensions.end() && found->second.Has("visible") && !found->second.Get("visible").Get<bool>();
}

class NodeReader {
  public:
    explicit NodeReader(GltfLoader& loader)
        : loader_(loader), model_(loader.file.model()), visited_(model_.nodes.size()), read_(model_.meshes.size()) {}

    void read() {
        // A stack of our own: the depth of a hierarchy is the file's choice, the call stack's is not.
        std::vector<std::pair<int, int>> todo;  // node, parent in Scene::nodes
        const auto push = [&](const std::vector<int>& nodes, int parent) {
            for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) todo.emplace_back(*node, parent);
        };
        push(root_nodes(), -1);
        while (!todo.empty()) {
            const auto [index, parent] = todo.back();
            todo.pop_back();
            const auto i = static_cast<size_t>(index);
            if (visited_[i])
                fail("{}: the node is reached twice: it has two parents or is part of a cycle; repair the hierarchy",
                     loader_.file.where("nodes", i));
            visited_[i] = true;
            push(model_.nodes[i].children, add_node(i, parent));
        }
        sort_cameras();
    }

  private:
    std::vector<int> root_nodes() {
        std::vector<size_t> parents(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes)
            for (const int child : node.children) ++parents[static_cast<size_t>(child)];
        if (const auto count = std::count_if(parents.begin(), parents.end(), [](size_t n) { return n > 1; }))
            loader_.ignored["{} node{|s} with two parents, of which one counts (NODE_PARENT_OVERRIDE)"] +=
                size_t(count);
        std::vector<int> roots;
        if (model_.scenes.empty()) {
            for (size_t i = 0; i < parents.size(); ++i)
                if (parents[i] == 0) roots.push_back(static_cast<int>(i));
            return roots;
        }
        roots = model_.scenes[static_cast<size_t>(std::max(model_.defaultScene, 0))].nodes;
        for (const int root : roots)
            if (parents[static_cast<size_t>(root)] > 0)
                ++loader_.ignored["{} node{|s} of the scene shown without {its|their} parents (SCENE_NON_ROOT_NODE)"];
        return roots;
    }

    int add_node(size_t index, int parent) {
        const tinygltf::Node& from = model_.nodes[index];
        Node node;
        node.name = from.name;
        node.parent = parent;
        node.source = static_cast<int>(index);
        node.fixed = !from.matrix.empty();
        node.rest = placement_of<float>(from);
        glm::mat4 local(node.rest.matrix());
        for (int i = 0; i < 16 && node.fixed; ++i)
            local[i / 4][i % 4] = static_cast<float>(from.matrix[static_cast<size_t>(i)]);
        node.local = glm::dmat4(local);
        note_transform(from, local);
        node.skin = from.skin;
        node.weights.assign(from.weights.begin(), from.weights.end());
        const glm::mat4 world = parent < 0 ? local : worlds_[static_cast<size_t>(parent)] * local;
        check_finite(world, loader_.file.where("nodes", index));
        const bool is_hidden = is_node_hidden(from) || (parent >= 0 && hidden_[static_cast<size_t>(parent)]);
        hidden_.push_back(is_hidden);
        if (from.mesh >= 0 && !is_hidden) {
            node.mesh = from.mesh;
            read_mesh(size_t(from.mesh), world);
        }
        if (node.mesh >= 0) note_skin(from);
        if (node.mesh >= 0 && !from.weights.empty() && from.weights.size() != loader_.target_count(uint32_t(node.mesh)))
            ++loader_.ignored
                  ["{} node{|s} with another number of weights than {its|their} mesh has morph targets "
                   "(NODE_WEIGHTS_INVALID)"];
        if (from.camera >= 0) node.camera = add_camera(static_cast<size_t>(from.camera), node);
        if (const auto light = from.extensions.find("KHR_lights_punctual");
            light != from.extensions.end() && light->second.Has("light") && !is_hidden)
            node.light = add_light(static_cast<size_t>(light->second.Get("light").GetNumberAsInt()), node);
        const std::vector<Placement> instances = is_hidden ? std::vector<Placement>() : instances_of(index);
        loader_.scene.nodes.push_back(std::move(node));
        loader_.exact_nodes.push_back(exact_node(from));
        worlds_.push_back(world);
        const int added = static_cast<int>(worlds_.size()) - 1;
        if (!instances.empty()) add_instances(added, instances);
        return added;
    }

    /// What is invalid, but drawn; with the code that Khronos's validator has for it.
    void note_transform(const tinygltf::Node& from, const glm::mat4& local) {
        Tally& ignored = loader_.ignored;
        if (from.rotation.size() == 4) {
            const double length = std::hypot(std::hypot(from.rotation[0], from.rotation[1]),
                                             std::hypot(from.rotation[2], from.rotation[3]));
            if (std::abs(length - 1) > 0.005)
                ++ignored["{} node rotation{|s} that {is|are} not of unit length scaled to it (ROTATION_NON_UNIT)"];
        }
        if (from.matrix.empty()) return;
        if (!is_placement(local))
            ++ignored
                ["{} node matri{x|ces} that no translation, rotation and scale make used as {it is|they are} "
                 "(NODE_MATRIX_NON_TRS)"];
    }

    void note_skin(const tinygltf::Node& from) {
        const auto& primitives = model_.meshes[static_cast<size_t>(from.mesh)].primitives;
        const bool has_joints = std::any_of(primitives.begin(), primitives.end(), [](const tinygltf::Primitive& p) {
            return p.attributes.contains("JOINTS_0");
        });
        if (from.skin >= 0 && !has_joints)
            ++loader_.ignored
                  ["{} node{|s} with a skin {follows its|follow their} node, for {its mesh has|their meshes have} no "
                   "joints "
                   "(NODE_SKIN_WITH_NON_SKINNED_MESH)"];
        if (from.skin < 0 && has_joints)
            ++loader_.ignored
                  ["{} node{|s} without a skin {follows its|follow their} node, although {its mesh has|their meshes "
                   "have} joints "
                   "(NODE_SKINNED_MESH_WITHOUT_SKIN)"];
    }

    /// EXT_mesh_gpu_instancing: transforms inside of the node; none: the mesh is shown once.
    std::vector<Placement> instances_of(size_t index) {
        const tinygltf::Node& from = model_.nodes[index];
        const auto extension = from.extensions.find("EXT_mesh_gpu_instancing");
        if (extension == from.extensions.end() || from.mesh < 0) return {};
        const std::string where = loader_.file.where("nodes", index) + ".extensions.EXT_mesh_gpu_instancing";
        std::optional<uint32_t> count;
        const auto read = [&](const char* name, uint32_t components) -> std::vector<float> {
            const tinygltf::Value& attributes = extension->second.Get("attributes");
            if (!attributes.Has(name)) return {};
            const int accessor = attributes.Get(name).GetNumberAsInt();
            const GltfFile::Accessor info = loader_.file.accessor(accessor);
            if (info.components != components)
                fail("{}: {} needs {} numbers an instance, {} has {}", where, name, components, info.where,
                     info.components);
            if (count && *count != info.count)
                fail("{}: {} has {} instances, another attribute {}", where, name, info.count, *count);
            count = info.count;
            return loader_.file.floats(accessor);
        };
        const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                                 scales = read("SCALE", 3);
        std::vector<Placement> out;
        for (size_t i = 0; i < count.value_or(0); ++i) {
            Placement at;
            if (!translations.empty()) at.translation = glm::make_vec3(&translations[3 * i]);
            if (!rotations.empty()) at.rotation = glm::dquat(rotation_of<float>(&rotations[4 * i]));
            if (!scales.empty()) at.scale = glm::make_vec3(&scales[3 * i]);
            out.push_back(at);
            check_finite(glm::mat4(at.matrix()), fmt::format("{}: instance {}", where, i));
        }
        return out;
    }

    /// The node's mesh, shown by children that stand where the instances are.
    void add_instances(int parent, const std::vector<Placement>& instances) {
        const auto p = static_cast<size_t>(parent);
        Node node;
        node.name = loader_.scene.nodes[p].name;
        node.parent = parent;
        node.mesh = std::exchange(loader_.scene.nodes[p].mesh, -1);
        node.skin = std::exchange(loader_.scene.nodes[p].skin, -1);
        node.weights = loader_.scene.nodes[p].weights;
        node.is_instance = true;
        for (const Placement& instance : instances) {
            node.local = instance.matrix();
            loader_.scene.nodes.push_back(node);
            loader_.exact_nodes.push_back({instance.matrix(true), {}});
            worlds_.push_back(worlds_[p] * glm::mat4(node.local));
            hidden_.push_back(false);
        }
    }

    void read_mesh(size_t mesh, const glm::mat4& world) {
        loader_.scene.meshes.resize(model_.meshes.size());
        const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(world))));
        if (!read_[mesh]) loader_.read_mesh(static_cast<uint32_t>(mesh), scale);
        read_[mesh] = true;
    }

    /// Nothing, and a note, of one that cannot see.
    std::optional<Camera> camera_of(size_t index) {
        const tinygltf::Camera& from = model_.cameras[index];
        Camera camera;
        camera.name = from.name;
        camera.number = static_cast<uint32_t>(index);
        if (from.type == "perspective") {
            camera.vertical_fov = static_cast<float>(from.perspective.yfov);
        } else {
            camera.orthographic_height = 2 * std::abs(static_cast<float>(from.orthographic.ymag));
        }
        const bool sees = from.type == "perspective" ? camera.vertical_fov > 0 && camera.vertical_fov < 3.1415927f
                                                     : camera.orthographic_height > 0;
        if (!sees) {
            if (blind_cameras_.insert(index).second)
                ++loader_.ignored["{} camera{|s} of an unknown type or without a field of view ignored"];
            return std::nullopt;
        }
        return camera;
    }

    int add_camera(size_t index, const Node& node) {
        std::optional<Camera> camera = camera_of(index);
        if (!camera) return -1;
        if (camera->name.empty()) camera->name = node.name;
        camera->node = node.name;
        loader_.scene.cameras.push_back(std::move(*camera));
        return static_cast<int>(loader_.scene.cameras.size()) - 1;
    }

    /// By the file's numbers, and those that no node shows.
    void sort_cameras() {
        Scene& scene = loader_.scene;
        std::vector<size_t> order(scene.cameras.size());
        std::iota(order.begin(), order.end(), size_t(0));
        std::stable_sort(order.begin(), order.end(),
                         [&](size_t a, size_t b) { return scene.cameras[a].number < scene.cameras[b].number; });
        std::vector<Camera> sorted;
        std::vector<int> places(order.size());
        for (const size_t i : order) {
            places[i] = static_cast<int>(sorted.size());
            sorted.push_back(std::move(scene.cameras[i]));
        }
        scene.cameras = std::move(sorted);
        for (Node& node : scene.nodes)
            if (node.camera >= 0) node.camera = places[static_cast<size_t>(node.camera)];
        std::vector<bool> is_placed(model_.cameras.size());
        for (const Camera& camera : scene.cameras) is_placed[camera.number] = true;
        for (size_t i = 0; i < is_placed.size(); ++i)
            if (!is_placed[i])
                if (std::optional<Camera> camera = camera_of(i)) scene.unplaced_cameras.push_back(std::move(*camera));
    }

    int add_light(size_t index, const Node& node) {
        const tinygltf::Light& from = model_.lights[index];
        Light light;
        light.name = from.name.empty() ? node.name : from.name;
        if (from.type == "point")
            light.kind = Light::Kind::point;
        else if (from.type == "spot")
            light.kind = Light::Kind::spot;
        else if (from.type != "directional") {
            ++loader_.ignored["{} light{|s} of an unknown type ignored (VALUE_NOT_IN_LIST)"];
            return -1;
        }
        light.color = to_vector<float>(from.color, 1) * static_cast<float>(from.intensity);
        if (from.range > 0) light.range = static_cast<float>(from.range);
        light.inner_cone = static_cast<float>(from.spot.innerConeAngle);
        light.outer_cone = static_cast<float>(from.spot.outerConeAngle);
        if (light.kind == Light::Kind::spot && light.inner_cone >= light.outer_cone)
            ++loader_.ignored
                  ["{} spot light{|s} whose inner cone reaches {its|their} outer one {ends|end} in a hard edge "
                   "(KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES)"];
        loader_.scene.lights.push_back(std::move(light));
        return static_cast<int>(loader_.scene.lights.size()) - 1;
    }

    GltfLoader& loader_;
    const tinygltf::Model& model_;
    std::vector<bool> visited_, read_;
    std::set<size_t> blind_cameras_;  ///< those that have been noted
    std::vector<bool> hidden_;        ///< of Scene::nodes
    std::vector<glm::mat4> worlds_;
};

}  // namespace

void GltfLoader::read_nodes() {
    NodeReader(*this).read();
}

}  // namespace peelray
