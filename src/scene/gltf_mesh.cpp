#include <algorithm>
#include <cmath>

#include "scene/gltf.h"
#include "scene/normals.h"

namespace peelray {

namespace {

enum Mode : uint64_t { triangles_mode = 4, strip_mode = 5, fan_mode = 6 };

class PrimitiveReader {
  public:
    PrimitiveReader(GltfLoader& loader, const JsonView& json)
        : loader_(loader), json_(json), attributes_(json.object("attributes")) {}

    /// False where the primitive has no triangles to show (points, lines, no positions).
    bool read(Primitive& out) {
        const uint64_t mode = json_.count("mode", triangles_mode);
        if (mode > fan_mode) fail("{}.mode: {} is no primitive mode (0 to 6)", json_.where(), mode);
        if (mode < triangles_mode) {
            ++loader_.ignored["{} primitives of points or lines dropped"];
            return false;
        }
        if (!attributes_.has("POSITION")) {
            ++loader_.ignored["{} primitives without positions dropped"];
            return false;
        }
        out.material = json_.index("material", loader_.scene.materials.size() - 1, "materials")
                           .value_or(static_cast<uint32_t>(loader_.scene.materials.size() - 1));
        out.positions = vectors<glm::vec3>("POSITION");
        check_positions(out);
        read_triangles(out, mode);
        read_attributes(out);
        if (json_.has("targets")) ++loader_.ignored["{} primitives with morph targets shown in their base shape"];
        return true;
    }

  private:
    template <typename Vector>
    std::vector<Vector> vectors(const char* name) {
        const uint32_t accessor = attributes_.required_index(name, loader_.file.accessor_count(), "accessors");
        const GltfFile::Accessor info = loader_.file.accessor(accessor);
        constexpr auto components = static_cast<uint32_t>(Vector::length());
        if (info.components != components)
            fail("{}: {} needs {} components, {} has {}", json_.where(), name, components, info.where, info.components);
        const std::vector<float> values = loader_.file.floats(accessor);
        std::vector<Vector> out(info.count);
        for (size_t i = 0; i < out.size(); ++i)
            for (uint32_t c = 0; c < components; ++c) out[i][static_cast<int>(c)] = values[i * components + c];
        return out;
    }

    void check_count(const char* name, size_t count, const Primitive& out) const {
        if (count != out.positions.size())
            fail("{}: {} has {} elements, POSITION has {}", json_.where(), name, count, out.positions.size());
    }

    void check_positions(const Primitive& out) const {
        for (size_t i = 0; i < out.positions.size(); ++i) {
            const glm::vec3& p = out.positions[i];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                fail("{}: vertex {} is at ({}, {}, {}); repair the mesh, positions must be finite", json_.where(), i,
                     p.x, p.y, p.z);
        }
    }

    void read_triangles(Primitive& out, uint64_t mode) {
        std::vector<uint32_t> corners;
        if (const auto accessor = json_.index("indices", loader_.file.accessor_count(), "accessors")) {
            corners = loader_.file.integers(*accessor);
            for (size_t i = 0; i < corners.size(); ++i)
                if (corners[i] >= out.positions.size())
                    fail("{}: index {} is {}, the primitive has {} vertices", json_.where(), i, corners[i],
                         out.positions.size());
        } else {
            corners.resize(out.positions.size());
            for (size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<uint32_t>(i);
        }
        const size_t count = mode == triangles_mode ? corners.size() / 3 : corners.size() < 3 ? 0 : corners.size() - 2;
        out.triangles.resize(count);
        for (size_t i = 0; i < count; ++i) {
            // The format's own order of corners, section 3.7.2.1: the provoking vertex comes first.
            if (mode == triangles_mode) out.triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
            if (mode == strip_mode) out.triangles[i] = {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
            if (mode == fan_mode) out.triangles[i] = {corners[i + 1], corners[i + 2], corners[0]};
        }
        if (mode == triangles_mode && corners.size() % 3)
            ++loader_.ignored["{} primitives with one or two indices too many"];
    }

    void read_attributes(Primitive& out) {
        if (attributes_.has("NORMAL")) {
            out.normals = vectors<glm::vec3>("NORMAL");
            check_count("NORMAL", out.normals.size(), out);
        }
        read_uvs(out);
        read_colors(out);
        if (out.normals.empty())
            make_flat(out);
        else if (const size_t repaired = repair_normals(out))
            loader_.ignored["{} normals without direction replaced"] += repaired;
    }

    void read_uvs(Primitive& out) {
        const UvSource& source = loader_.uv_sources[out.material];
        const std::string name = fmt::format("TEXCOORD_{}", source.used ? source.set : 0);
        if (!attributes_.has(name.c_str())) return;
        out.uvs = vectors<glm::vec2>(name.c_str());
        check_count(name.c_str(), out.uvs.size(), out);
        const float c = std::cos(source.rotation), s = std::sin(source.rotation);
        for (glm::vec2& uv : out.uvs) {
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = glm::vec2(0);
            const glm::vec2 scaled = uv * source.scale;
            uv = glm::vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + source.offset;
        }
    }

    void read_colors(Primitive& out) {
        if (!attributes_.has("COLOR_0")) return;
        const uint32_t accessor = attributes_.required_index("COLOR_0", loader_.file.accessor_count(), "accessors");
        if (loader_.file.accessor(accessor).components == 3) {
            for (const glm::vec3& color : vectors<glm::vec3>("COLOR_0")) out.colors.emplace_back(color, 1.f);
        } else {
            out.colors = vectors<glm::vec4>("COLOR_0");
        }
        check_count("COLOR_0", out.colors.size(), out);
        for (glm::vec4& color : out.colors)
            for (int i = 0; i < 4; ++i) color[i] = std::isfinite(color[i]) ? std::clamp(color[i], 0.f, 1.f) : 1.f;
    }

    GltfLoader& loader_;
    const JsonView& json_;
    JsonView attributes_;
};

}  // namespace

void GltfLoader::read_mesh(uint32_t index) {
    const JsonView& json = meshes[index];
    Mesh& mesh = scene.meshes[index];
    const std::vector<JsonView> primitives = json.objects("primitives");
    for (const JsonView& primitive : primitives) {
        Primitive out;
        if (!PrimitiveReader(*this, primitive).read(out)) continue;
        triangles += out.triangles.size();
        if (triangles > (uint64_t(1) << 28))
            fail("{}: more than {} triangles so far; split the scene", primitive.where(), uint64_t(1) << 28);
        mesh.primitives.push_back(std::move(out));
    }
}

}  // namespace peelray
