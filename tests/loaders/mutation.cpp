#include "loaders/mutation.h"

#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>

#include "image/image.h"
#include "loaders/compressed_files.h"
#include "loaders/load.h"
#include "loaders/scene_files.h"

namespace peelray::testing {

namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

std::string stl_facet(uint16_t attribute) {
    return pack<float>({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1}) + pack<uint16_t>({attribute});
}

std::vector<Sample> ply_samples() {
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::string ascii =
        "ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 5\n" + xyz +
        "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar green\nproperty "
        "uchar "
        "blue\nproperty uchar alpha\nelement face 3\nproperty list uchar int vertex_indices\nproperty list uchar float "
        "texcoord\nproperty int texnumber\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
        "0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 0 255 0 255\n1 1 0 0 0 1 0 0 255 128\n0 1 0 0 0 1 9 9 9 9\n0.5 0.5 1e-1 "
        "0 0 1 1 2 3 4\n"
        "3 0 1 2 6 0 0 1 0 1 1 0\n4 0 2 3 4 8 0 0 1 1 0 1 0 0 0\n5 0 1 4 2 3 0 -1\n0 1\n";
    const std::string square = pack(unit_square);
    const std::string little =
        "ply\nformat binary_little_endian 1.0\nelement face 2\nproperty list uchar ushort vertex_index\n"
        "property float red\nproperty float green\nproperty float blue\nelement vertex 4\n" +
        xyz + "property double s\nproperty double t\nend_header\n" + std::string("\3", 1) + pack<uint16_t>({0, 1, 2}) +
        pack<float>({1, 0, 0.5f}) + std::string("\3", 1) + pack<uint16_t>({0, 2, 3}) + pack<float>({0, 1, 1}) +
        square.substr(0, 12) + pack<double>({0, 1}) + square.substr(12, 12) + pack<double>({1, 1}) +
        square.substr(24, 12) + pack<double>({1, 0}) + square.substr(36, 12) + pack<double>({0, 0});
    std::string body = square + pack<int32_t>({5, 0, 1, 3, -1, 2, 5, 0, 1, 3, 2, 2});
    for (size_t i = 0; i < body.size(); i += 4) std::swap(body[i], body[i + 3]), std::swap(body[i + 1], body[i + 2]);
    const std::string big = "ply\nformat binary_big_endian 1.0\nelement vertex 4\n" + xyz +
                            "element tristrips 2\nproperty list int int vertex_indices\nend_header\n" + body;
    return {{"a.ply", ascii}, {"b.ply", little}, {"c.ply", big}};
}

std::vector<Sample> stl_samples() {
    const std::string facet =
        "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0.5 -2e-1\n  vertex 0 1 0\n endloop\nendfacet\n";
    std::string magics = "COLOR=abcd,MATERIAL=efghijklmnop";
    magics.resize(80, ' ');
    const std::string count = pack<uint32_t>({3});
    return {{"a.stl", "solid a\n" + facet + facet + "endsolid a\nsolid b\n" + facet + "endsolid\n"},
            {"b.stl", magics + count + stl_facet(31) + stl_facet(0x8000) + stl_facet(992)},
            {"c.stl", std::string(80, '\0') + count + stl_facet(0x801F) + stl_facet(0) + stl_facet(0x83E0)}};
}

std::vector<Sample> off_samples() {
    const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    std::string binary = pack<int32_t>({4, 2, 0}) + pack(unit_square) +
                         pack<int32_t>({3, 0, 1, 2, 1, 7, 3, 0, 2, 3, 3}) + pack<float>({0, 0.5f, 1});
    for (size_t i = 0; i < binary.size(); i += 4)
        std::swap(binary[i], binary[i + 3]), std::swap(binary[i + 1], binary[i + 2]);
    return {{"a.off", "OFF # a comment\n4 3 0\n" + points + "4 0 1 2 3 255 0 0\n3 0 1 2 0.5 0.5 1\n3 0 2 3 17\n"},
            {"b.off",
             "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 255 0 0\n1 0 0 0 0 1 0 255 0 255 1 0\n0 1 0 0 0 1 0 0 255 255 0 1\n3 "
             "0 1 2\n"},
            {"c.off", "OFF BINARY\n" + binary}};
}

const std::string obj_text =
    "mtllib m.mtl\no one\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0.5 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 "
    "1\nusemtl a\n"
    "f 1/1/1 2/2/1 3/3/1\ns 1\ng two\nusemtl b\nf 1//1 3//1 4//1\nf -4 -3 -2 -1\n";
const std::string mtl_text =
    "newmtl a\nKd 0.5 0.25 1\nKs 0.5 0.5 0.5\nNs 90\nKe 0 0 1\nmap_Kd -s 2 2 1 t.png\nmap_Ke t.png\nillum 2\nnewmtl "
    "b\nKd 1 1 1\n"
    "d 0.5\nTf 1 0.5 1\nNi 1.5\nillum 7\nPr 0.25\nPm 1\nmap_d t.png\nnorm t.png\n";

std::vector<Sample> glb_samples() {
    json gltf = square();
    const std::string bytes = pack(unit_square) + pack<uint16_t>({0, 1, 2, 0, 2, 3});
    gltf["buffers"] = json::array({{{"byteLength", bytes.size()}}});
    gltf["bufferViews"] =
        json::array({{{"buffer", 0}, {"byteLength", 48}}, {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}});
    return {{"a.glb", glb(gltf.dump(), bytes)}};
}

std::vector<Sample> gltf_samples() {
    json gltf = square();
    gltf["materials"] =
        json::array({{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}, {"roughnessFactor", 0.25}}}}});
    primitive(gltf)["material"] = 0;
    gltf["nodes"][0]["translation"] = {1, 2, 3};
    return {{"a.gltf", gltf.dump(1)}};
}

std::vector<Sample> draco_samples() {
    std::vector<Sample> out;
    for (const DracoMethod method : {DracoMethod::sequential, DracoMethod::edgebreaker, DracoMethod::valence})
        for (const int bits : {0, 11}) {
            const DracoWriter writer = grid_writer(Grid(5), bits);
            out.push_back({"a.gltf", writer.stream(method),
                           [writer](const std::string& stream) { return writer.file(stream).dump(); }});
        }
    return out;
}

/// The view of an accessor compressed: what is changed are the compressed bytes.
Sample meshopt_sample(json gltf, size_t accessor, const std::string& bytes, size_t stride, const char* mode,
                      const char* filter) {
    compress_view(gltf, accessor, bytes, stride, mode, filter);
    return {"a.gltf", meshopt_stream(bytes, stride, mode), [gltf, accessor](const std::string& stream) {
                json changed = gltf;
                json& view = changed["bufferViews"][changed["accessors"][accessor]["bufferView"].get<size_t>()];
                json& extension = view["extensions"]["EXT_meshopt_compression"];
                extension["byteLength"] = stream.size();
                changed["buffers"][extension["buffer"].get<size_t>()] = {{"byteLength", stream.size()},
                                                                         {"uri", data_uri(stream)}};
                return changed.dump();
            }};
}

std::vector<Sample> meshopt_samples() {
    const Grid grid(9);
    const auto count = grid.vertices();
    json gltf = square();
    json& attributes = primitive(gltf)["attributes"];
    const size_t positions = add_accessor(gltf, pack(grid.positions), 5126, "VEC3", count);
    attributes["POSITION"] = positions;
    std::vector<float> normals, exponents = grid.positions;
    for (size_t i = 0; i < count; ++i)
        normals.insert(normals.end(), {grid.normals[3 * i], grid.normals[3 * i + 1], grid.normals[3 * i + 2], 0});
    const std::string octahedral = meshopt_filtered(normals, 8, "OCTAHEDRAL", 12);
    const size_t normal = add_accessor(gltf, octahedral, 5122, "VEC3", count, true);
    gltf["bufferViews"].back()["byteStride"] = 8;
    attributes["NORMAL"] = normal;
    const size_t indices = add_accessor(gltf, pack(grid.corners), 5125, "SCALAR", grid.corners.size());
    primitive(gltf)["indices"] = indices;
    Sample version_1 = meshopt_sample(gltf, positions, pack(grid.positions), 12, "ATTRIBUTES", "NONE");
    version_1.bytes = meshopt_stream_1(pack(grid.positions), 12, {2, 1, 0}, {0, 1, 3, 0, 0, 1, 3, 0, 0, 1, 3, 0});
    return {version_1,
            meshopt_sample(gltf, positions, pack(grid.positions), 12, "ATTRIBUTES", "NONE"),
            meshopt_sample(gltf, positions, meshopt_filtered(exponents, 12, "EXPONENTIAL", 15), 12, "ATTRIBUTES",
                           "EXPONENTIAL"),
            meshopt_sample(gltf, normal, octahedral, 8, "ATTRIBUTES", "OCTAHEDRAL"),
            meshopt_sample(gltf, indices, pack(grid.corners), 4, "TRIANGLES", "NONE"),
            meshopt_sample(gltf, indices, pack(grid.corners), 4, "INDICES", "NONE")};
}

/// The bytes of a picture that is written as `name`.
Sample written_picture(const std::string& name, const Image& image, bool full) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("peelray_sample_{}_{}", getpid(), name);
    write_hdr(file, image, {.half = !full});
    std::ifstream stream(file, std::ios::binary);
    Sample sample{name, {std::istreambuf_iterator<char>(stream), {}}};
    std::filesystem::remove(file);
    return sample;
}

/// Sixteen by two pixels, which both formats compress.
Image gradient(float alpha) {
    Image image{16, 2, {}};
    for (int i = 0; i < 32; ++i) image.pixels.emplace_back(0.25f * float(i), 1, 100, i == 7 ? alpha : 1);
    return image;
}

std::vector<Sample> hdr_samples() {
    const std::string plain = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\nEXPOSURE=2\nCOLORCORR=1 1 0.5\n\n+X 2 -Y 3\n";
    return {written_picture("a.hdr", gradient(1), false), {"b.hdr", plain + std::string("abcdefghijklmnopqrstuvwx")}};
}

std::vector<Sample> exr_samples() {
    return {written_picture("a.exr", gradient(1), false), written_picture("b.exr", gradient(0.5f), true)};
}

bool is_picture(const std::string& format) {
    return format == "exr" || format == "hdr";
}

}  // namespace

size_t Mutation::random(size_t below) {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<size_t>(state_ >> 33) % below;
}

void Mutation::replace_number(std::string& bytes) {
    static const std::array<const char*, 18> extremes = {
        "0",     "-1",         "1",           "255",        "256",        "65535",
        "65536", "2147483647", "-2147483648", "4294967295", "4294967296", "18446744073709551616",
        "1e38",  "-1e39",      "1e-45",       "1e999",      "nan",        "inf"};
    size_t begin = random(bytes.size());
    while (begin < bytes.size() && !is_digit(bytes[begin])) ++begin;
    size_t end = begin;
    while (end < bytes.size() && (is_digit(bytes[end]) || bytes[end] == '.')) ++end;
    bytes.replace(begin, end - begin, extremes[random(extremes.size())]);
}

void Mutation::replace_word(std::string& bytes) {
    static const std::array<uint32_t, 10> extremes = {0,          1,          0xFF,       0xFFFF,     0x7FFFFFFF,
                                                      0x80000000, 0xFFFFFFFF, 0x7F800000, 0x7FC00000, 0xFF7FFFFF};
    const std::string word = pack<uint32_t>({extremes[random(extremes.size())]});
    const size_t at = random(bytes.size());
    for (size_t i = 0; i < 4 && at + i < bytes.size(); ++i) bytes[at + i] = word[i];
}

void Mutation::change(std::string& bytes) {
    if (bytes.empty()) return;
    const size_t at = random(bytes.size()),
                 length = 1 + random(std::min<size_t>(bytes.size() - at, random(2) ? 4 : 64));
    switch (random(9)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ 1 << random(8));
            break;
        case 1:
            bytes[at] = static_cast<char>(random(256));
            break;
        case 2:
            replace_word(bytes);
            break;
        case 3:
            bytes.erase(at, length);
            break;
        case 4:
            bytes.insert(at, bytes.substr(at, length));
            break;
        case 5: {
            const std::string piece = bytes.substr(at, length);
            bytes.erase(at, length);
            bytes.insert(random(bytes.size() + 1), piece);
            break;
        }
        case 6:
            if (random(4) == 0) bytes.resize(at);
            break;
        default:
            replace_number(bytes);
    }
}

std::string Mutation::operator()(std::string bytes) {
    for (size_t i = 0, count = 1 + random(4); i < count; ++i) change(bytes);
    return bytes;
}

const std::vector<std::string>& mutation_formats() {
    static const std::vector<std::string> names = {"obj", "mtl",   "ply",     "stl", "off", "gltf",
                                                   "glb", "draco", "meshopt", "exr", "hdr"};
    return names;
}

const std::vector<Sample>& samples(const std::string& format) {
    static const std::map<std::string, std::vector<Sample>> all = {
        {"obj", {{"a.obj", obj_text}}}, {"mtl", {{"m.mtl", mtl_text}}}, {"ply", ply_samples()},
        {"stl", stl_samples()},         {"off", off_samples()},         {"gltf", gltf_samples()},
        {"glb", glb_samples()},         {"draco", draco_samples()},     {"meshopt", meshopt_samples()},
        {"exr", exr_samples()},         {"hdr", hdr_samples()}};
    return all.at(format);
}

MutationResult load_mutations(const std::string& format, uint64_t count, uint64_t seed, const std::string& folder) {
    const auto write = [&](const std::string& name, const std::string& bytes) {
        std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
    };
    write("t.png", tiny_png());
    write("m.mtl", mtl_text);
    write("model.obj", obj_text);
    MutationResult result;
    for (uint64_t i = 0; i < count; ++i) {
        const Sample& sample = samples(format)[i % samples(format).size()];
        // From the number alone, so that one that went wrong can be made again.
        write(sample.name, sample.file(Mutation(seed + i)(sample.bytes)));
        try {
            if (is_picture(format))
                read_hdr(folder + "/" + sample.name);
            else
                flatten(load_scene(folder + "/" + (format == "mtl" ? "model.obj" : sample.name)));
            ++result.loaded;
        } catch (const Error& error) {
            const std::string line = error.what();
            ++result.refused;
            if (line.empty() || line.find('\n') != line.npos)
                result.wrong.push_back(fmt::format("{}: {}", seed + i, line));
        } catch (const std::exception& error) {
            result.wrong.push_back(fmt::format("{}: {}", seed + i, error.what()));
        }
    }
    return result;
}

}  // namespace peelray::testing
