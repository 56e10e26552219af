#include <algorithm>
#include <cmath>
#include <optional>

#include "base/text.h"
#include "loaders/gltf.h"
#include "loaders/gltf_draco.h"
#include "scene/normals.h"
#include "scene/tangents.h"
#include "scene/thicken.h"
#include "scene/transform.h"

namespace peelray {

namespace {

class PrimitiveReader {
  public:
    /// `material`: the file's number of it, −1: the default one. `radius`: of points and lines; 0: they are left out.
    PrimitiveReader(GltfLoader& loader, const tinygltf::Primitive& from, int material, float radius, std::string where)
        : loader_(loader), from_(from), material_(material), radius_(radius), where_(std::move(where)) {}

    /// Takes the geometry from compressed data, as far as that has it, instead of from the accessors.
    void decompress(const DracoSource& source) {
        if (from_.mode < TINYGLTF_MODE_TRIANGLES || !has("POSITION")) return;
        try {
            draco_.emplace(loader_.file, source, from_, where_);
            if (!draco_->matches_accessors())
                ++loader_.ignored
                      ["{} primitive{|s} whose Draco data has other numbers of vertices or triangles than {its|their} "
                       "accessors say: the data counts"];
        } catch (const Error&) {
            if (!has_fallback()) throw;
            ++loader_.ignored
                  ["{} primitive{|s} whose Draco data cannot be decoded read from {its|their} uncompressed fallback"];
        }
    }

    /// False where the primitive has no triangles to show (points, lines, no positions).
    bool read(Primitive& out) {
        if (from_.mode > TINYGLTF_MODE_TRIANGLE_FAN)
            fail("{}.mode: {} is no primitive mode (0 to 6)", where_, from_.mode);
        if (is_thin() && radius_ == 0) {
            ++loader_.ignored["{} primitive{|s} of points or lines dropped"];
            return false;
        }
        if (!has("POSITION")) {
            ++loader_.ignored["{} primitive{|s} without positions dropped"];
            return false;
        }
        out.material =
            static_cast<uint32_t>(material_ >= 0 ? size_t(material_) : loader_.file.model().materials.size());
        out.positions = vectors<glm::vec3>("POSITION");
        check_positions(out);
        if (is_thin()) {
            read_thin(out);
        } else {
            read_triangles(out, draco_ ? TINYGLTF_MODE_TRIANGLES : from_.mode);
            read_attributes(out);
        }
        return true;
    }

  private:
    bool is_thin() const { return from_.mode < TINYGLTF_MODE_TRIANGLES; }

    /// Points and lines. Those without normals are not lit (glTF 2.0, section 3.7.2.1).
    void read_thin(Primitive& out) {
        const std::vector<uint32_t> corners = corners_of(out);
        const auto mode = static_cast<LineMode>(from_.mode);
        loader_.check_triangles(thickened_triangles(corners.size(), mode), where_);
        read_uvs(out);
        read_colors(out);
        read_joints(out);
        read_targets(out);
        if (!has("NORMAL")) out.material = loader_.unlit(out.material);
        thicken(out, corners, mode, radius_);
    }

    bool has_fallback() const {
        const auto is_backed = [&](int accessor) { return loader_.file.accessor(accessor).is_backed; };
        return is_backed(from_.attributes.at("POSITION")) && (from_.indices < 0 || is_backed(from_.indices));
    }

    bool has(const char* name) const { return from_.attributes.count(name) > 0; }

    GltfFile::Accessor info(const char* name) const {
        if (draco_ && draco_->has(name)) return draco_->accessor(name);
        return loader_.file.accessor(from_.attributes.at(name));
    }

    template <typename Vector>
    std::vector<Vector> vectors(const char* name) {
        if (draco_ && draco_->has(name)) return as_vectors<Vector>(name, info(name), draco_->floats(name));
        return vectors_of<Vector>(from_.attributes.at(name), name);
    }

    template <typename Vector>
    std::vector<Vector> vectors_of(int accessor, const char* name) {
        const GltfFile::Accessor info = loader_.file.accessor(accessor);
        note_format(info, name);
        return as_vectors<Vector>(name, info, loader_.file.floats(accessor));
    }

    template <typename Vector>
    std::vector<Vector> as_vectors(const char* name, const GltfFile::Accessor& info,
                                   const std::vector<float>& values) const {
        constexpr auto components = static_cast<uint32_t>(Vector::length());
        if (info.components != components)
            fail("{}: {} needs {} components, {} has {}", where_, name, components, info.where, info.components);
        std::vector<Vector> out(info.count);
        for (size_t i = 0; i < out.size(); ++i)
            for (uint32_t c = 0; c < components; ++c) out[i][static_cast<int>(c)] = values[i * components + c];
        return out;
    }

    /// Whole numbers where the format has floats, or that stand for themselves where they are to stand for [0, 1].
    void note_format(const GltfFile::Accessor& info, const std::string& name) const {
        if (info.is_float() || name.starts_with("JOINTS_")) return;
        const std::vector<std::string>& used = loader_.file.model().extensionsUsed;
        const bool is_unit =
            info.normalized && (info.component_type == 5121 || info.component_type == 5123) &&
            (name.starts_with("TEXCOORD_") || name.starts_with("COLOR_") || name.starts_with("WEIGHTS_"));
        const bool is_quantized =
            std::find(used.begin(), used.end(), "KHR_mesh_quantization") != used.end() &&
            (name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.starts_with("TEXCOORD_"));
        if (!is_unit && !is_quantized)
            ++loader_.ignored[fmt::format(
                "{{}} attribute{{|s}} {} of a type that the format does not have there used as {{it is|they are}} "
                "(MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT)",
                name)];
    }

    void check_count(const char* name, size_t count, const Primitive& out) const {
        if (count != out.positions.size())
            fail("{}: {} has {}, POSITION has {}", where_, name, counted("{} element{|s}", count),
                 out.positions.size());
    }

    void check_positions(const Primitive& out) const {
        for (size_t i = 0; i < out.positions.size(); ++i) {
            const glm::vec3& p = out.positions[i];
            if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
                fail("{}: vertex {} is at ({}, {}, {}); repair the mesh, positions must be finite", where_, i, p.x, p.y,
                     p.z);
        }
    }

    /// The vertices of the triangles, in the order of the mode.
    std::vector<uint32_t> corners_of(const Primitive& out) {
        std::vector<uint32_t> corners;
        if (draco_) {
            corners = draco_->corners();
        } else if (from_.indices >= 0) {
            corners = loader_.file.integers(from_.indices);
            for (size_t i = 0; i < corners.size(); ++i)
                if (corners[i] >= out.positions.size())
                    fail("{}: index {} is {}, the primitive has {}", where_, i, corners[i],
                         counted("{} vert{ex|ices}", out.positions.size()));
            const auto restart = static_cast<uint32_t>(loader_.file.accessor(from_.indices).largest());
            if (std::find(corners.begin(), corners.end(), restart) != corners.end())
                ++loader_.ignored
                      ["{} primitive{|s} whose largest index would restart {it|them} drawn with that vertex "
                       "(ACCESSOR_INDEX_PRIMITIVE_RESTART)"];
        } else {
            corners.resize(out.positions.size());
            for (size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<uint32_t>(i);
        }
        return corners;
    }

    void read_triangles(Primitive& out, int mode) {
        const std::vector<uint32_t> corners = corners_of(out);
        const size_t count = mode == TINYGLTF_MODE_TRIANGLES ? corners.size() / 3
                             : corners.size() < 3            ? 0
                                                             : corners.size() - 2;
        out.triangles.resize(count);
        for (size_t i = 0; i < count; ++i) {
            // The format's own order of corners, section 3.7.2.1: the provoking vertex comes first.
            if (mode == TINYGLTF_MODE_TRIANGLES)
                out.triangles[i] = {corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
            if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
                out.triangles[i] = {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]};
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) out.triangles[i] = {corners[i + 1], corners[i + 2], corners[0]};
        }
        if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3)
            ++loader_.ignored["{} primitive{|s} with one or two indices too many"];
    }

    void read_attributes(Primitive& out) {
        if (has("NORMAL")) {
            out.normals = vectors<glm::vec3>("NORMAL");
            check_count("NORMAL", out.normals.size(), out);
        }
        read_uvs(out);
        read_tangents(out);
        note_anisotropy(out);
        read_colors(out);
        read_joints(out);
        read_targets(out);
        const auto odd = std::count_if(out.normals.begin(), out.normals.end(), [](const glm::vec3& n) {
            return std::isfinite(glm::length(n)) && glm::length(n) > 0 && std::abs(glm::length(n) - 1) > 0.01f;
        });
        if (odd)
            loader_.ignored["{} normal{|s} of other than unit length scaled to it (ACCESSOR_VECTOR3_NON_UNIT)"] +=
                size_t(odd);
        if (out.normals.empty())
            make_flat(out);
        else if (const size_t repaired = repair_normals(out))
            loader_.ignored["{} normal{|s} without direction replaced"] += repaired;
    }

    /// The sets that the material's textures use, in its order; without textures the first.
    void read_uvs(Primitive& out) {
        const std::vector<uint32_t>& used = loader_.uv_sets[out.material];
        const Material& m = loader_.scene.materials[out.material];
        if (used.empty()) out.uvs = read_uv_set(0, out);
        bool missing = false;
        for (size_t i = 0; i < used.size(); ++i) {
            std::vector<glm::vec2> set = read_uv_set(used[i], out);
            missing |= set.empty() &&
                       std::ranges::any_of(material_textures, [&](auto use) { return m.*use && (m.*use).uv_set == i; });
            if (i == 0)
                out.uvs = std::move(set);
            else
                out.more_uvs.push_back(std::move(set));
        }
        if (missing)
            ++loader_.ignored
                  ["{} primitive{|s} without the texture coordinates that {its|their} material's textures use "
                   "(MESH_PRIMITIVE_TOO_FEW_TEXCOORDS): all of each shows one texel"];
    }

    /// TEXCOORD_`set`; empty where there is none.
    std::vector<glm::vec2> read_uv_set(uint32_t set, const Primitive& out) {
        const std::string name = fmt::format("TEXCOORD_{}", set);
        if (!has(name.c_str())) return {};
        std::vector<glm::vec2> uvs = vectors<glm::vec2>(name.c_str());
        check_count(name.c_str(), uvs.size(), out);
        for (glm::vec2& uv : uvs)
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
                uv = glm::vec2(0);
                ++loader_.ignored
                      ["{} texture coordinate{|s} that {is|are} not finite {counts|count} as 0 "
                       "(ACCESSOR_INVALID_FLOAT)"];
            }
        return uvs;
    }

    /// Where the material needs them, and all are right: else they are made. They belong to the file's normals.
    void read_tangents(Primitive& out) {
        const Material& m = loader_.scene.materials[out.material];
        if (!needs_tangents(m) || out.normals.empty() || !has("TANGENT")) return;
        out.tangents = vectors<glm::vec4>("TANGENT");
        check_count("TANGENT", out.tangents.size(), out);
        for (glm::vec4& tangent : out.tangents) {
            const glm::vec3 unit = unit_or(glm::dvec3(tangent), glm::vec3(0));
            if (unit == glm::vec3(0) || std::abs(tangent.w) != 1) {
                ++loader_.ignored
                      ["{} primitive{|s} whose tangents have no direction or no side (ACCESSOR_INVALID_SIGN), made "
                       "anew"];
                out.tangents.clear();
                return;
            }
            tangent = glm::vec4(unit, tangent.w);
        }
    }

    /// The direction of anisotropy is the tangent.
    void note_anisotropy(const Primitive& out) const {
        const Material& m = loader_.scene.materials[out.material];
        if (!(m.anisotropy > 0) || m.unlit || !out.tangents.empty()) return;
        if (tangent_coordinates(m, out).empty())
            ++loader_
                  .ignored["{} anisotropic primitive{|s} without tangents and texture coordinates drawn as isotropic"];
        else if (!has("TANGENT"))
            ++loader_.ignored
                  ["{} anisotropic primitive{|s} without TANGENT, which programs that optimise files drop: {its|their} "
                   "direction was computed from texture coordinates"];
    }

    void read_colors(Primitive& out) {
        if (!has("COLOR_0")) return;
        if (info("COLOR_0").components == 3) {
            for (const glm::vec3& color : vectors<glm::vec3>("COLOR_0")) out.colors.emplace_back(color, 1.f);
        } else {
            out.colors = vectors<glm::vec4>("COLOR_0");
        }
        check_count("COLOR_0", out.colors.size(), out);
        size_t outside = 0;
        for (glm::vec4& color : out.colors)
            for (int i = 0; i < 4; ++i) {
                outside += !(color[i] >= 0 && color[i] <= 1);
                color[i] = std::isfinite(color[i]) ? std::clamp(color[i], 0.f, 1.f) : 1.f;
            }
        if (outside) loader_.ignored["{} channel{|s} of vertex colours outside of 0 to 1 clamped"] += outside;
    }

    /// JOINTS_0 with WEIGHTS_0 and JOINTS_1 with WEIGHTS_1; whether the joints exist is for the skin to say.
    void read_joints(Primitive& out) {
        size_t read = 0;
        for (int set = 0; set < JointWeights::most / 4; ++set) {
            const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
            if (!has(joints.c_str()) || !has(weights.c_str())) break;
            read_joint_set(out, set, joints.c_str(), weights.c_str());
            read += 2;
        }
        const auto there = std::count_if(from_.attributes.begin(), from_.attributes.end(), [](const auto& attribute) {
            return attribute.first.starts_with("JOINTS_") || attribute.first.starts_with("WEIGHTS_");
        });
        if (static_cast<size_t>(there) > read)
            ++loader_.ignored
                  ["{} primitive{|s} with sets of joints or weights that lack their other half, or beyond "
                   "eight a vertex: those sets ignored"];
        rescale_weights(out);
    }

    void read_joint_set(Primitive& out, int set, const char* joints, const char* weights) {
        const GltfFile::Accessor type = info(joints);
        const bool is_unsigned =
            type.component_type == 5121 || type.component_type == 5123 || type.component_type == 5125;
        if (!is_unsigned || type.normalized)
            fail("{}: {} must be unsigned integers, {} are {}components of type {}", where_, joints, type.where,
                 type.normalized ? "normalized " : "", type.component_type);
        const std::vector<glm::vec4> j = vectors<glm::vec4>(joints), w = vectors<glm::vec4>(weights);
        check_count(joints, j.size(), out);
        check_count(weights, w.size(), out);
        out.joints.resize(out.positions.size());
        size_t refused = 0;
        for (size_t i = 0; i < j.size(); ++i)
            for (int k = 0; k < 4; ++k) {
                const auto slot = static_cast<size_t>(4 * set + k);
                out.joints[i].joints[slot] = static_cast<uint16_t>(std::clamp(j[i][k], 0.f, 65535.f));
                const bool is_weight = std::isfinite(w[i][k]) && w[i][k] >= 0;
                out.joints[i].weights[slot] = is_weight ? w[i][k] : 0.f;
                refused += !is_weight;
            }
        if (refused)
            loader_.ignored["{} joint weight{|s} that {is|are} negative or not finite {counts|count} as 0"] += refused;
    }

    void rescale_weights(Primitive& out) {
        size_t rescaled = 0, unheld = 0;
        for (JointWeights& vertex : out.joints) {
            double sum = 0;
            for (const float weight : vertex.weights) sum += weight;
            if (!(sum > 0)) {
                ++unheld;
                continue;
            }
            rescaled += std::abs(sum - 1) > 1e-2;
            for (float& weight : vertex.weights) weight = static_cast<float>(weight / sum);
        }
        if (rescaled) loader_.ignored["{} vert{ex|ices} whose joint weights do not sum to one rescaled"] += rescaled;
        if (unheld) loader_.ignored["{} vert{ex|ices} that no joint holds {follows its|follow their} node"] += unheld;
    }

    void read_targets(Primitive& out) {
        for (size_t i = 0; i < from_.targets.size(); ++i) {
            MorphTarget target;
            for (const auto& [name, accessor] : from_.targets[i]) {
                if (name != "POSITION" && name != "NORMAL" && (name != "TANGENT" || out.tangents.empty())) continue;
                if (!has(name.c_str()))
                    ++loader_.ignored
                          ["{} morph target{|s} of normals that the mesh does not have "
                           "(MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR)"];
                std::vector<glm::vec3>& values = name == "POSITION" ? target.positions
                                                 : name == "NORMAL" ? target.normals
                                                                    : target.tangents;
                values = vectors_of<glm::vec3>(accessor, name.c_str());
                check_count(fmt::format("targets[{}].{}", i, name).c_str(), values.size(), out);
                for (glm::vec3& v : values)
                    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
                        fail("{}: targets[{}].{} is not finite; repair the mesh", where_, i, name);
            }
            out.targets.push_back(std::move(target));
        }
    }

    GltfLoader& loader_;
    const tinygltf::Primitive& from_;
    const int material_;
    const float radius_;
    const std::string where_;
    std::optional<DracoGeometry> draco_;  ///< none: the accessors hold all
};

}  // namespace

size_t GltfLoader::target_count(uint32_t mesh) const {
    const std::vector<tinygltf::Primitive>& primitives = file.model().meshes[mesh].primitives;
    return primitives.empty() ? 0 : primitives[0].targets.size();
}

int GltfLoader::material_of(uint32_t mesh, size_t primitive) const {
    const std::map<size_t, int>& mapped = file.extensions().variant_materials[mesh][primitive];
    const auto found = variant ? mapped.find(*variant) : mapped.end();
    return found != mapped.end() ? found->second : file.model().meshes[mesh].primitives[primitive].material;
}

void GltfLoader::check_triangles(uint64_t more, const std::string& where) const {
    if (triangles + more > (uint64_t(1) << 28))
        fail("{}: more than {} triangles so far; split the scene", where, uint64_t(1) << 28);
}

void GltfLoader::read_mesh(uint32_t index, double scale) {
    const std::vector<tinygltf::Primitive>& primitives = file.model().meshes[index].primitives;
    Mesh& mesh = scene.meshes[index];
    mesh.name = file.model().meshes[index].name;
    mesh.weights.assign(file.model().meshes[index].weights.begin(), file.model().meshes[index].weights.end());
    const auto radius = static_cast<float>(scale > 0 ? point_size / 2 / scale : 0);
    const size_t targets = target_count(index);
    if (std::any_of(primitives.begin(), primitives.end(), [&](const auto& p) { return p.targets.size() != targets; }))
        ++ignored
            ["{} mesh{|es} whose primitives have unequal numbers of morph targets "
             "(MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT)"];
    if (!mesh.weights.empty() && mesh.weights.size() != targets)
        ++ignored["{} mesh{|es} with another number of weights than of morph targets (MESH_INVALID_WEIGHTS_COUNT)"];
    for (size_t i = 0; i < primitives.size(); ++i) {
        const std::string where = fmt::format("{}.primitives[{}]", file.where("meshes", index), i);
        Primitive out;
        PrimitiveReader reader(*this, primitives[i], material_of(index, i), radius, where);
        if (const auto& draco = file.extensions().draco_sources[index][i]) reader.decompress(*draco);
        if (!reader.read(out)) continue;
        check_triangles(out.triangles.size(), where);
        triangles += out.triangles.size();
        mesh.primitives.push_back(std::move(out));
    }
}

}  // namespace peelray
