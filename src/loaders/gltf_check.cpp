#include "loaders/gltf_check.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "loaders/files.h"

namespace peelray {

namespace {

using nlohmann::json;

constexpr std::array supported_extensions = std::to_array<std::string_view>({"EXT_lights_image_based",
                                                                             "EXT_mesh_gpu_instancing",
                                                                             "EXT_meshopt_compression",
                                                                             "EXT_texture_webp",
                                                                             "KHR_draco_mesh_compression",
                                                                             "KHR_lights_punctual",
                                                                             "KHR_materials_anisotropy",
                                                                             "KHR_materials_clearcoat",
                                                                             "KHR_materials_diffuse_transmission",
                                                                             "KHR_materials_dispersion",
                                                                             "KHR_materials_emissive_strength",
                                                                             "KHR_materials_ior",
                                                                             "KHR_materials_iridescence",
                                                                             "KHR_materials_pbrSpecularGlossiness",
                                                                             "KHR_materials_sheen",
                                                                             "KHR_materials_specular",
                                                                             "KHR_materials_transmission",
                                                                             "KHR_materials_unlit",
                                                                             "KHR_materials_variants",
                                                                             "KHR_materials_volume",
                                                                             "KHR_node_visibility",
                                                                             "KHR_mesh_quantization",
                                                                             "KHR_meshopt_compression",
                                                                             "KHR_texture_transform"});

/// Half of pi, and what rounding may add to it.
constexpr double kRightAngle = 1.5707964;

enum class Kind {
    flag,
    text,
    texts,
    number,
    numbers,
    whole,
    whole_map,
    size,
    index,
    indices,
    index_map,
    index_maps,
    object,
    objects
};

/// One member of an object of the format, see the functions below.
struct Member {
    const char* key;
    Kind kind;
    std::vector<Member> members = {};  ///< object, objects: theirs
    const char* list = "";             ///< index…: the list that is pointed into
    size_t length = 0;                 ///< numbers: how many
    bool required = false;
    json missing = nullptr;                     ///< what stands for a missing one; null: nothing
    double least = -INFINITY, most = INFINITY;  ///< number, numbers: the format's range
};
using Members = std::vector<Member>;

Member flag(const char* key) {
    return {key, Kind::flag};
}
Member text(const char* key) {
    return {key, Kind::text};
}
Member texts(const char* key) {
    return {key, Kind::texts};
}
Member number(const char* key) {
    return {key, Kind::number};
}
/// `length` 0: any number of them.
Member numbers(const char* key, size_t length) {
    return {key, Kind::numbers, {}, "", length};
}
Member whole(const char* key) {
    return {key, Kind::whole};
}  ///< tinygltf keeps it in an int
Member whole_map(const char* key) {
    return {key, Kind::whole_map};
}
Member size(const char* key) {
    return {key, Kind::size};
}  ///< tinygltf keeps it in a size_t
Member index(const char* key, const char* list) {
    return {key, Kind::index, {}, list};
}
Member indices(const char* key, const char* list) {
    return {key, Kind::indices, {}, list};
}
Member index_map(const char* key, const char* list) {
    return {key, Kind::index_map, {}, list};
}
Member index_maps(const char* key, const char* list) {
    return {key, Kind::index_maps, {}, list};
}
Member object(const char* key, Members members) {
    return {key, Kind::object, std::move(members)};
}
Member objects(const char* key, Members members) {
    return {key, Kind::objects, std::move(members)};
}
Member required(Member member) {
    member.required = true;
    return member;
}
Member or_else(Member member, json missing) {
    member.missing = std::move(missing);
    return member;
}

Member within(double least, double most, Member member) {
    member.least = least;
    member.most = most;
    return member;
}

Member texture(const char* key, const Members& more = {}) {
    Members members = {
        required(index("index", "textures")), whole("texCoord"),
        object("extensions", {object("KHR_texture_transform", {numbers("offset", 2), numbers("scale", 2),
                                                               number("rotation"), whole("texCoord")})})};
    members.insert(members.end(), more.begin(), more.end());
    return object(key, members);
}

/// What EXT_meshopt_compression says of a buffer view or a buffer.
Member meshopt(const Members& members) {
    return object("extensions",
                  {object("EXT_meshopt_compression", members), object("KHR_meshopt_compression", members)});
}

Members view_members() {
    return {required(index("buffer", "buffers")), size("byteOffset"), required(size("byteLength")), size("byteStride"),
            meshopt({required(index("buffer", "buffers")), size("byteOffset"), required(size("byteLength")),
                     required(size("byteStride")), required(size("count")), required(text("mode")), text("filter")})};
}

Members primitive_members() {
    return {
        or_else(index_map("attributes", "accessors"), json::object()),
        index("indices", "accessors"),
        index("material", "materials"),
        whole("mode"),
        index_maps("targets", "accessors"),
        object("extensions",
               {object("KHR_draco_mesh_compression",
                       {required(index("bufferView", "bufferViews")), required(whole_map("attributes"))}),
                object("KHR_materials_variants", {objects("mappings", {required(index("material", "materials")),
                                                                       required(indices("variants", "variants"))})})})};
}

Members texture_members() {
    const Members source = {index("source", "images")};
    return {index("source", "images"), index("sampler", "samplers"),
            object("extensions", {object("EXT_texture_webp", source), object("KHR_texture_basisu", source),
                                  object("EXT_texture_avif", source), object("MSFT_texture_dds", source)})};
}

Members accessor_members(size_t view_without_bytes) {
    return {or_else(index("bufferView", "bufferViews"), view_without_bytes),
            size("byteOffset"),
            required(size("componentType")),
            required(size("count")),
            required(text("type")),
            flag("normalized"),
            object("sparse",
                   {required(whole("count")),
                    required(object("indices", {required(index("bufferView", "bufferViews")), whole("byteOffset"),
                                                required(whole("componentType"))})),
                    required(object("values", {required(index("bufferView", "bufferViews")), whole("byteOffset")}))})};
}

Members material_extensions() {
    return {
        object("KHR_materials_anisotropy", {within(0, 1, number("anisotropyStrength")), number("anisotropyRotation"),
                                            texture("anisotropyTexture")}),
        object("KHR_materials_clearcoat",
               {within(0, 1, number("clearcoatFactor")), texture("clearcoatTexture"),
                within(0, 1, number("clearcoatRoughnessFactor")), texture("clearcoatRoughnessTexture"),
                texture("clearcoatNormalTexture", {number("scale")})}),
        object(
            "KHR_materials_diffuse_transmission",
            {within(0, 1, number("diffuseTransmissionFactor")), texture("diffuseTransmissionTexture"),
             within(0, 1, numbers("diffuseTransmissionColorFactor", 3)), texture("diffuseTransmissionColorTexture")}),
        object("KHR_materials_dispersion", {within(0, INFINITY, number("dispersion"))}),
        object("KHR_materials_emissive_strength", {within(0, INFINITY, number("emissiveStrength"))}),
        object("KHR_materials_ior", {within(0, INFINITY, number("ior"))}),
        object(
            "KHR_materials_iridescence",
            {within(0, 1, number("iridescenceFactor")), texture("iridescenceTexture"),
             within(1, INFINITY, number("iridescenceIor")), within(0, INFINITY, number("iridescenceThicknessMinimum")),
             within(0, INFINITY, number("iridescenceThicknessMaximum")), texture("iridescenceThicknessTexture")}),
        object("KHR_materials_pbrSpecularGlossiness",
               {within(0, 1, numbers("diffuseFactor", 4)), texture("diffuseTexture"),
                within(0, 1, numbers("specularFactor", 3)), within(0, 1, number("glossinessFactor")),
                texture("specularGlossinessTexture")}),
        object("KHR_materials_sheen", {within(0, 1, numbers("sheenColorFactor", 3)), texture("sheenColorTexture"),
                                       within(0, 1, number("sheenRoughnessFactor")), texture("sheenRoughnessTexture")}),
        object("KHR_materials_specular",
               {within(0, 1, number("specularFactor")), texture("specularTexture"),
                within(0, INFINITY, numbers("specularColorFactor", 3)), texture("specularColorTexture")}),
        object("KHR_materials_transmission",
               {within(0, 1, number("transmissionFactor")), texture("transmissionTexture")}),
        object("KHR_materials_unlit", {}),
        object("KHR_materials_volume", {within(0, INFINITY, number("thicknessFactor")), texture("thicknessTexture"),
                                        within(0, 1, numbers("attenuationColor", 3)), number("attenuationDistance")})};
}

Members material_members() {
    return {
        text("name"),
        text("alphaMode"),
        number("alphaCutoff"),
        flag("doubleSided"),
        within(0, 1, numbers("emissiveFactor", 3)),
        texture("normalTexture", {number("scale")}),
        texture("occlusionTexture", {within(0, 1, number("strength"))}),
        texture("emissiveTexture"),
        object("pbrMetallicRoughness", {within(0, 1, numbers("baseColorFactor", 4)),
                                        within(0, 1, number("metallicFactor")), within(0, 1, number("roughnessFactor")),
                                        texture("baseColorTexture"), texture("metallicRoughnessTexture")}),
        object("extensions", material_extensions())};
}

/// What the loader reads of a file. What is not listed never reaches tinygltf.
Members file_members(size_t view_without_bytes, size_t no_node) {
    return {
        required(object("asset", {required(text("version"))})), texts("extensionsUsed"), index("scene", "scenes"),
        objects("scenes", {indices("nodes", "nodes")}),
        objects("nodes", {text("name"), indices("children", "nodes"), index("mesh", "meshes"),
                          index("camera", "cameras"), index("skin", "skins"), numbers("matrix", 16),
                          numbers("translation", 3), numbers("rotation", 4), numbers("scale", 3), numbers("weights", 0),
                          object("extensions", {object("KHR_lights_punctual", {index("light", "lights")}),
                                                object("KHR_node_visibility", {flag("visible")}),
                                                object("EXT_mesh_gpu_instancing",
                                                       {required(index_map("attributes", "accessors"))})})}),
        objects("meshes", {text("name"), numbers("weights", 0), objects("primitives", primitive_members())}),
        objects("materials", material_members()), objects("textures", texture_members()),
        objects("images", {text("name"), text("uri"), index("bufferView", "bufferViews")}),
        objects("samplers", {whole("magFilter"), whole("minFilter"), whole("wrapS"), whole("wrapT")}),
        objects("buffers", {text("uri"), required(size("byteLength")), meshopt({flag("fallback")})}),
        or_else(objects("bufferViews", view_members()), json::array()),
        objects("accessors", accessor_members(view_without_bytes)),
        objects("animations", {text("name"),
                               objects("samplers", {required(index("input", "accessors")),
                                                    required(index("output", "accessors")), text("interpolation")}),
                               objects("channels", {required(whole("sampler")),
                                                    required(object("target", {or_else(index("node", "nodes"), no_node),
                                                                               required(text("path"))}))})}),
        objects("skins",
                {text("name"), index("inverseBindMatrices", "accessors"), required(indices("joints", "nodes"))}),
        // The values that stand for missing ones are those that the loader does not use.
        objects("cameras", {text("name"), required(text("type")),
                            object("perspective", {required(number("yfov")), or_else(number("znear"), 0.1)}),
                            object("orthographic", {or_else(number("xmag"), 1.0), or_else(number("ymag"), 0.0),
                                                    or_else(number("zfar"), 1.0), or_else(number("znear"), 0.0)})}),
        object(
            "extensions",
            {object("KHR_materials_variants", {objects("variants", {required(text("name"))})}),
             object("KHR_lights_punctual",
                    {objects("lights", {text("name"), required(text("type")), within(0, 1, numbers("color", 3)),
                                        within(0, INFINITY, number("intensity")), within(0, INFINITY, number("range")),
                                        or_else(object("spot", {within(0, kRightAngle, number("innerConeAngle")),
                                                                within(0, kRightAngle, number("outerConeAngle"))}),
                                                json::object())})})})};
}

const json* find(const json& value, const char* key) {
    const auto found = value.is_object() ? value.find(key) : value.end();
    return found == value.end() ? nullptr : &*found;
}

size_t length_of(const json* list) {
    return list && list->is_array() ? list->size() : 0;
}

class Checker {
  public:
    Checker(const json& root, Tally& ignored) : ignored_(ignored) {
        for (const auto& [key, value] : root.items()) lengths_[key] = length_of(&value);
        const json* extensions = find(root, "extensions");
        const json* lights = extensions ? find(*extensions, "KHR_lights_punctual") : nullptr;
        lengths_["lights"] = length_of(lights ? find(*lights, "lights") : nullptr);
        const json* variants = extensions ? find(*extensions, "KHR_materials_variants") : nullptr;
        lengths_["variants"] = length_of(variants ? find(*variants, "variants") : nullptr);
    }

    json object(const json& in, const Members& members, const std::string& where) {
        expect(in.is_object(), in, where, "an object");
        json out = json::object();
        for (const Member& member : members) {
            if (const json* value = find(in, member.key))
                out[member.key] = checked(*value, member, where + "." + member.key);
            else if (member.required)
                fail("{}: \"{}\" is missing", where, member.key);
            else if (!member.missing.is_null())
                out[member.key] = member.missing;
        }
        return out;
    }

  private:
    json checked(const json& in, const Member& member, const std::string& where) {
        switch (member.kind) {
            case Kind::flag:
                expect(in.is_boolean(), in, where, "true or false");
                return in;
            case Kind::text:
                expect(in.is_string(), in, where, "a string");
                return in;
            case Kind::texts:
                return each(in, where, [&](const json& element) {
                    expect(element.is_string(), element, where, "a list of strings");
                    return element;
                });
            case Kind::number:
                return ranged(number(in, where), member);
            case Kind::numbers:
                expect(in.is_array(), in, where, "an array");
                if (member.length && in.size() != member.length)
                    fail("{}: has {}, needs {}", where, counted("{} number{|s}", in.size()), member.length);
                return each(in, where, [&](const json& element) { return ranged(number(element, where), member); });
            case Kind::whole:
                return whole(in, where, INT_MAX);
            case Kind::whole_map:
                return each_value(in, where,
                                  [](const json& value, const std::string& at) { return whole(value, at, INT_MAX); });
            case Kind::size:
                return whole(in, where, uint64_t(1) << 53);
            case Kind::index:
                return index(in, member.list, where);
            case Kind::indices:
                return each(in, where, [&](const json& element) { return index(element, member.list, where); });
            case Kind::index_map:
                return index_map(in, member.list, where);
            case Kind::index_maps:
                return each(in, where, [&](const json& element) { return index_map(element, member.list, where); });
            case Kind::object:
                return object(in, member.members, where);
            case Kind::objects:
                break;
        }
        size_t i = 0;
        return each(in, where, [&](const json& element) {
            return object(element, member.members, fmt::format("{}[{}]", where, i++));
        });
    }

    static void expect(bool is_right, const json& in, const std::string& where, const char* wanted) {
        if (!is_right) fail("{}: is {}, must be {}", where, in.type_name(), wanted);
    }

    template <typename Check>
    static json each(const json& in, const std::string& where, Check check) {
        expect(in.is_array(), in, where, "an array");
        json out = json::array();
        for (const json& element : in) out.push_back(check(element));
        return out;
    }

    static json number(const json& in, const std::string& where) {
        expect(in.is_number(), in, where, "a number");
        const double value = in.get<double>();
        // Largest float; beyond it the conversion to float is undefined.
        if (!(std::abs(value) <= 3.4028234e38)) fail("{}: {} is no 32-bit floating point number", where, value);
        return value;
    }

    static json whole(const json& in, const std::string& where, uint64_t limit) {
        expect(in.is_number(), in, where, "a whole number");
        const double value = in.get<double>();
        if (!(value >= 0 && value <= static_cast<double>(limit)) || value != std::floor(value))
            fail("{}: {} is no whole number from 0 to {}", where, value, limit);
        return static_cast<uint64_t>(value);
    }

    json ranged(const json& value, const Member& member) {
        const auto number = value.get<double>();
        if (number < member.least || number > member.most)
            ++ignored_[fmt::format("{{}} value{{|s}} of {} out of {{its|their}} range (VALUE_NOT_IN_RANGE)",
                                   member.key)];
        return value;
    }

    /// "mesh" or "meshes", "buffer view" or "buffer views".
    static std::string words_for(const std::string& list, bool one) {
        const std::string words = list == "bufferViews" ? "buffer views" : list;
        return one ? words.substr(0, words.size() - (list == "meshes" ? 2 : 1)) : words;
    }

    json index(const json& in, const std::string& list, const std::string& where) const {
        json out = whole(in, where, INT_MAX);
        const auto found = lengths_.find(list);
        const size_t length = found == lengths_.end() ? 0 : found->second;
        if (out.get<uint64_t>() >= length)
            fail("{}: {} is out of range, the file has {} {}", where, out.get<uint64_t>(), length,
                 words_for(list, length == 1));
        return out;
    }

    json index_map(const json& in, const char* list, const std::string& where) const {
        return each_value(in, where, [&](const json& value, const std::string& at) { return index(value, list, at); });
    }

    template <typename Check>
    static json each_value(const json& in, const std::string& where, Check check) {
        expect(in.is_object(), in, where, "an object");
        json out = json::object();
        for (const auto& [key, value] : in.items()) out[key] = check(value, where + "." + printable(key, 60));
        return out;
    }

    std::map<std::string, size_t> lengths_;
    Tally& ignored_;
};

/// Extensions that objects have and "extensionsUsed" does not name: those that are known are read all the same.
void note_undeclared(const json& root, Tally& ignored) {
    std::set<std::string> declared, undeclared;
    if (const json* list = find(root, "extensionsUsed"))
        for (const json& element : *list)
            if (element.is_string()) declared.insert(element.get<std::string>());
    // A stack of our own: the depth of the file is its author's choice.
    std::vector<const json*> todo = {&root};
    while (!todo.empty()) {
        const json& value = *todo.back();
        todo.pop_back();
        if (value.is_array())
            for (const json& element : value) todo.push_back(&element);
        if (!value.is_object()) continue;
        for (const auto& [key, element] : value.items()) {
            if (key != "extras") todo.push_back(&element);
            if (key != "extensions" || !element.is_object()) continue;
            for (const auto& [name, extension] : element.items())
                if (!declared.contains(name)) undeclared.insert(name);
        }
    }
    for (const std::string& name : undeclared)
        ++ignored[fmt::format("{{}} extension in use that extensionsUsed does not name, {}: {} (UNDECLARED_EXTENSION)",
                              escaped(name, 60),
                              is_supported_extension(name) ? "read all the same" : "without effect")];
}

void check_required_extensions(const json& root, const std::string& name) {
    const json* list = find(root, "extensionsRequired");
    if (!list) return;
    for (const json& element : *list) {
        const std::string extension = element.is_string() ? element.get<std::string>() : element.type_name();
        if (!is_supported_extension(extension))
            fail("{}: requires the extension {}, which is not supported; export the scene without it", name,
                 printable(extension, 60));
    }
}

}  // namespace

bool is_supported_extension(const std::string& name) {
    return std::find(supported_extensions.begin(), supported_extensions.end(), name) != supported_extensions.end();
}

json check_gltf(const json& root, const std::string& name, Tally& ignored) {
    if (!root.is_object()) fail("{}: not a glTF file: its JSON is {}, must be an object", name, root.type_name());
    if (!root.contains("asset")) fail("{}: not a glTF file: it has no \"asset\"", name);
    const json* version = find(root["asset"], "version");
    if (version && version->is_string() && !version->get<std::string>().starts_with("2."))
        fail("{}: glTF version \"{}\" is not supported; convert it to glTF 2.0", name,
             printable(version->get<std::string>(), 20));
    check_required_extensions(root, name);  // before the parts whose gaps such an extension would explain
    note_undeclared(root, ignored);
    json out =
        Checker(root, ignored)
            .object(root, file_members(length_of(find(root, "bufferViews")), length_of(find(root, "nodes"))), name);
    out["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}});
    return out;
}

}  // namespace peelray
