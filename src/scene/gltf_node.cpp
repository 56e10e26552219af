#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/gltf.h"

namespace peelray {

namespace {

void check_finite(const glm::mat4& m, const std::string& where) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) fail("{}: the transform is not finite; repair the node", where);
}

glm::mat4 local_transform(const JsonView& json) {
    glm::mat4 out{1};
    if (json.has("matrix")) {
        const auto m = json.vector<16>("matrix", {});
        for (int i = 0; i < 16; ++i) out[i / 4][i % 4] = m[static_cast<size_t>(i)];
        return out;
    }
    const auto t = json.vector<3>("translation", {0, 0, 0}), s = json.vector<3>("scale", {1, 1, 1});
    const auto r = json.vector<4>("rotation", {0, 0, 0, 1});
    glm::quat rotation;
    rotation.x = r[0], rotation.y = r[1], rotation.z = r[2], rotation.w = r[3];
    const float length = glm::length(rotation);
    rotation = length > 0 && std::isfinite(length) ? rotation / length : glm::quat(1, 0, 0, 0);
    out = glm::translate(out, {t[0], t[1], t[2]}) * glm::mat4_cast(rotation);
    return glm::scale(out, {s[0], s[1], s[2]});
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
    const float length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

class NodeReader {
  public:
    explicit NodeReader(GltfLoader& loader)
        : loader_(loader),
          visited_(loader.nodes.size()),
          cameras_(loader.file.root().objects("cameras")),
          lights_(loader.file.root().object("extensions").object("KHR_lights_punctual").objects("lights")) {}

    void read() {
        // A stack of our own: the depth of a hierarchy is the file's choice, the call stack's is not.
        std::vector<std::pair<uint32_t, int>> todo;  // node, parent in Scene::nodes
        const std::vector<uint32_t> roots = root_nodes();
        for (auto root = roots.rbegin(); root != roots.rend(); ++root) todo.emplace_back(*root, -1);
        while (!todo.empty()) {
            const auto [index, parent] = todo.back();
            todo.pop_back();
            const JsonView& json = loader_.nodes[index];
            if (visited_[index])
                fail("{}: the node is reached twice: it has two parents or is part of a cycle; repair the hierarchy",
                     json.where());
            visited_[index] = true;
            const int self = add_node(json, index, parent);
            const std::vector<uint32_t> children = json.indices("children", loader_.nodes.size(), "nodes");
            for (auto child = children.rbegin(); child != children.rend(); ++child) todo.emplace_back(*child, self);
        }
        aim_cameras();
    }

  private:
    std::vector<uint32_t> root_nodes() const {
        const std::vector<JsonView> scenes = loader_.file.root().objects("scenes");
        const uint32_t shown = loader_.file.root().index("scene", scenes.size(), "scenes").value_or(0);
        if (!scenes.empty()) return scenes[shown].indices("nodes", loader_.nodes.size(), "nodes");
        std::vector<bool> is_child(loader_.nodes.size());
        for (const JsonView& node : loader_.nodes)
            for (const uint32_t child : node.indices("children", loader_.nodes.size(), "nodes")) is_child[child] = true;
        std::vector<uint32_t> roots;
        for (uint32_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) roots.push_back(i);
        return roots;
    }

    int add_node(const JsonView& json, uint32_t index, int parent) {
        Node node;
        node.name = json.text("name", "");
        node.parent = parent;
        node.source = static_cast<int>(index);
        node.local = local_transform(json);
        const glm::mat4 world = parent < 0 ? node.local : worlds_[static_cast<size_t>(parent)] * node.local;
        check_finite(world, json.where());
        if (const auto mesh = json.index("mesh", loader_.meshes.size(), "meshes")) node.mesh = show_mesh(*mesh);
        if (const auto camera = json.index("camera", cameras_.size(), "cameras"))
            node.camera = add_camera(cameras_[*camera], node, world);
        const JsonView light = json.object("extensions").object("KHR_lights_punctual");
        if (const auto i = light.index("light", lights_.size(), "lights"))
            node.light = add_light(lights_[*i], node, world);
        if (json.has("skin")) ++loader_.ignored["{} skinned nodes shown in their rest pose"];
        loader_.scene.nodes.push_back(std::move(node));
        worlds_.push_back(world);
        return static_cast<int>(worlds_.size()) - 1;
    }

    int show_mesh(uint32_t mesh) {
        if (loader_.scene.meshes.empty()) {
            loader_.scene.meshes.resize(loader_.meshes.size());
            read_.resize(loader_.meshes.size());
        }
        if (!read_[mesh]) {
            read_[mesh] = true;
            loader_.scene.meshes[mesh].name = loader_.meshes[mesh].text("name", "");
            loader_.read_mesh(mesh);
        }
        return static_cast<int>(mesh);
    }

    int add_camera(const JsonView& json, const Node& node, const glm::mat4& world) {
        Camera camera;
        camera.name = json.text("name", node.name);
        camera.eye = glm::vec3(world[3]);
        camera.look = camera.eye + unit_or(-glm::vec3(world[2]), {0, 0, -1});
        camera.up = unit_or(glm::vec3(world[1]), {0, 1, 0});
        const std::string type = json.text("type", "");
        if (type == "perspective") {
            camera.vertical_fov = static_cast<float>(json.object("perspective").required_number("yfov"));
            if (!(camera.vertical_fov > 0 && camera.vertical_fov < 3.1415927f))
                fail("{}: yfov {} is outside of (0, pi)", json.where(), camera.vertical_fov);
        } else if (type == "orthographic") {
            camera.orthographic_height =
                2 * std::abs(static_cast<float>(json.object("orthographic").number("ymag", 0)));
            if (camera.orthographic_height == 0)
                fail("{}: ymag of the orthographic camera is 0 or missing", json.where());
        } else {
            fail("{}: the type \"{}\" is neither perspective nor orthographic", json.where(), printable(type, 20));
        }
        loader_.scene.cameras.push_back(std::move(camera));
        return static_cast<int>(loader_.scene.cameras.size()) - 1;
    }

    int add_light(const JsonView& json, const Node& node, const glm::mat4& world) {
        Light light;
        light.name = json.text("name", node.name);
        const std::string type = json.text("type", "");
        if (type == "point")
            light.kind = Light::Kind::point;
        else if (type == "spot")
            light.kind = Light::Kind::spot;
        else if (type != "directional")
            fail("{}: the light type \"{}\" is unknown", json.where(), printable(type, 20));
        const auto color = json.vector<3>("color", {1, 1, 1});
        light.color = glm::vec3(color[0], color[1], color[2]) * static_cast<float>(json.number("intensity", 1));
        light.position = glm::vec3(world[3]);
        light.direction = unit_or(-glm::vec3(world[2]), {0, 0, -1});
        const double range = json.number("range", light.range);
        if (range > 0) light.range = static_cast<float>(range);
        const JsonView spot = json.object("spot");
        light.inner_cone = static_cast<float>(spot.number("innerConeAngle", light.inner_cone));
        light.outer_cone = static_cast<float>(spot.number("outerConeAngle", light.outer_cone));
        loader_.scene.lights.push_back(std::move(light));
        return static_cast<int>(loader_.scene.lights.size()) - 1;
    }

    // A glTF camera has no target; ours looks at the point of its axis that is nearest to the middle of the scene.
    void aim_cameras() {
        glm::vec3 lower{INFINITY}, upper{-INFINITY};
        for (size_t i = 0; i < worlds_.size(); ++i) {
            if (loader_.scene.nodes[i].mesh < 0) continue;
            for (const Primitive& primitive :
                 loader_.scene.meshes[static_cast<size_t>(loader_.scene.nodes[i].mesh)].primitives)
                for (const glm::vec3& p : primitive.positions) {
                    const glm::vec3 at = glm::vec3(worlds_[i] * glm::vec4(p, 1));
                    lower = glm::min(lower, at);
                    upper = glm::max(upper, at);
                }
        }
        const glm::vec3 middle = 0.5f * lower + 0.5f * upper;
        for (Camera& camera : loader_.scene.cameras) {
            const glm::vec3 forward = camera.look - camera.eye;
            const float distance = glm::dot(middle - camera.eye, forward);
            if (std::isfinite(distance) && distance > 1e-3f) camera.look = camera.eye + forward * distance;
        }
    }

    GltfLoader& loader_;
    std::vector<bool> visited_, read_;
    std::vector<JsonView> cameras_, lights_;
    std::vector<glm::mat4> worlds_;
};

}  // namespace

void GltfLoader::read_nodes() {
    NodeReader(*this).read();
}

}  // namespace peelray
