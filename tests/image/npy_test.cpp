// NumPy's files: every legal spelling of the header, no illegal one.
#include <cstring>
#include <limits>

#include "image/npy.h"
#include "temp_folder.h"

namespace peelray {
namespace {

using Npy = TempFolder;

std::string rays(size_t count) {
    std::string bytes(count * 32, '\0');
    for (size_t i = 0; i < count * 8; ++i) {
        const float value = float(i) + 0.5f;
        std::memcpy(&bytes[i * 4], &value, 4);
    }
    return bytes;
}

std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
    std::string file = "\x93NUMPY";
    file += {char(version), '\0'};
    const auto length = uint32_t(dictionary.size());
    file.append(reinterpret_cast<const char*>(&length), version == 1 ? 2 : 4);
    return file + dictionary + data;
}

std::string dictionary(const std::string& shape, const std::string& descr = "'<f4'",
                       const std::string& fortran = "False") {
    return "{'descr': " + descr + ", 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}

TEST_F(Npy, ReadsWhatNumpyWrites) {
    std::string header = dictionary("(3, 8)");
    header.append(128 - 10 - 1 - header.size(), ' ');
    const std::vector<RayRecord> read = read_rays(put("r.npy", npy(header + "\n", rays(3))));
    ASSERT_EQ(read.size(), 3u);
    EXPECT_EQ(read[0].ox, 0.5f);
    EXPECT_EQ(read[0].tmin, 3.5f);
    EXPECT_EQ(read[1].dx, 12.5f);
    EXPECT_EQ(read[2].tmax, 23.5f);
}

TEST_F(Npy, ReadsEveryLegalHeader) {
    const std::string data = rays(2);
    for (const int version : {1, 2, 3})
        for (const std::string& header : {
                 dictionary("(2, 8)"),
                 dictionary("(2,8)") + "\n",
                 dictionary("(2, 8,)"),
                 dictionary("( 2 , 8 )"),
                 dictionary("(2L, 8L)"),
                 dictionary("(2, 8)", "'=f4'"),
                 dictionary("(2, 8)", "\"float32\""),
                 std::string("{\"shape\":(2,8),\"descr\":\"<f4\",\"fortran_order\":False}"),
                 std::string("  {\n'fortran_order' : False ,\t'shape' : (2, 8), 'descr' : '<f4'}   \n"),
             })
            EXPECT_EQ(read_rays(put("r.npy", npy(header, data, version))).size(), 2u) << version << " " << header;
}

TEST_F(Npy, NoRaysAreLegal) {
    EXPECT_TRUE(read_rays(put("r.npy", npy(dictionary("(0, 8)"), ""))).empty());
}

TEST_F(Npy, SaysWhatTheFileHoldsInstead) {
    const std::string data = rays(2);
    const auto refuse = [&](const std::string& header, const std::string& bytes, const std::string& part,
                            int version = 1) {
        SCOPED_TRACE(header);
        expect_error([&] { read_rays(put("r.npy", npy(header, bytes, version))); }, part);
    };
    refuse(dictionary("(2, 8)", "'<f8'"), data + data, "'<f8'");
    refuse(dictionary("(2, 8)", "'>f4'"), data, "'>f4'");
    refuse(dictionary("(2, 8)", "'<i4'"), data, "'<i4'");
    refuse(dictionary("(2,)", "[('a', '<f4', (8,)), (']', 'x')]"), data, "[('a', '<f4', (8,)), (']', 'x')]");
    refuse(dictionary("(2, 8)", "'<f4'", "True"), data, "Fortran");
    refuse(dictionary("(8, 2)"), data, "(8, 2)");
    refuse(dictionary("(16,)"), data, "(16,)");
    refuse(dictionary("()"), data.substr(0, 4), "()");
    refuse(dictionary("(1, 2, 8)"), data, "(1, 2, 8)");
    refuse(dictionary("(2, 8)"), data.substr(0, 63), "truncated");
    refuse(dictionary("(2, 8)"), "", "truncated");
    refuse(dictionary("(2, 8)"), data + "x", "too long");
    refuse(dictionary("(2, 8)"), data + data, "too long");
    refuse(dictionary("(1000000000000000, 8)"), data, "truncated");
    refuse(dictionary("(576460752303423490, 8)"), data, "truncated");  // · 32 overflows to 64
    refuse(dictionary("(18446744073709551618, 8)"), data, "header is broken");
    refuse(dictionary("(2, 8)"), data, "version 4.0", 4);
    refuse(dictionary("(2, 8)"), data, "version 0.0", 0);
}

TEST_F(Npy, RefusesBrokenHeaders) {
    for (const std::string& header : {
             std::string(""),
             std::string("{"),
             std::string("{}"),
             std::string("{'descr': '<f4', 'fortran_order': False}"),
             std::string("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), 'more': 'x'}"),
             std::string("{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (2, 8)}"),
             std::string("{'descr': '<f4' 'fortran_order': False, 'shape': (2, 8)}"),
             dictionary("(2, 8"),
             dictionary("(-2, 8)"),
             dictionary("(2.0, 8)"),
             dictionary("(2 8)"),
             dictionary("(16)"),
             dictionary("(2, 8)", "'<f4"),
             dictionary("(2, 8)", "[('a'"),
             dictionary("(2, 8)", "'<f4'", "0"),
             dictionary("(2, 8)") + "x",
         })
        expect_error([&] { read_rays(put("r.npy", npy(header, rays(2)))); }, "header is broken");
}

TEST_F(Npy, RefusesWhatIsNoNpyFile) {
    expect_error([&] { read_rays(folder / "none.npy"); }, "No such file");
    expect_error([&] { read_rays(folder); }, "Is a directory");
    expect_error([&] { read_rays(put("r.npy", "")); }, "empty");
    expect_error([&] { read_rays(put("r.npy", "PK\x03\x04 an npz")); }, "not a .npy file");
    const std::string whole = npy(dictionary("(2, 8)"), rays(2), 2);
    for (size_t length = 1; length < whole.size(); ++length)
        EXPECT_THROW(read_rays(put("r.npy", whole.substr(0, length))), Error) << length;
}

TEST_F(Npy, WritesHitsAsNumpyWould) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<HitRecord> hits = {{1.5f, 7, 0.25f, 0.5f}, {infinity, ~0u, 0, 0}};
    write_hits(folder / "h.npy", hits);
    const std::string bytes = get(folder / "h.npy");
    ASSERT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const size_t length = uint8_t(bytes[8]) | size_t(uint8_t(bytes[9])) << 8;
    EXPECT_EQ((10 + length) % 64, 0u);
    ASSERT_EQ(bytes.size(), 10 + length + 2 * sizeof(HitRecord));
    const std::string header = bytes.substr(10, length);
    EXPECT_TRUE(
        header.starts_with("{'descr': [('t', '<f4'), ('triangle', '<u4'), ('u', '<f4'), ('v', '<f4')], "
                           "'fortran_order': False, 'shape': (2,), }"));
    EXPECT_EQ(header.back(), '\n');
    EXPECT_EQ(std::memcmp(bytes.data() + 10 + length, hits.data(), 32), 0);
    expect_error([&] { write_hits("/proc/no/h.npy", hits); }, "/proc/no");
    EXPECT_EQ(files(), 1u);
}

TEST_F(Npy, WritesNoHits) {
    write_hits(folder / "h.npy", {});
    const std::string bytes = get(folder / "h.npy");
    EXPECT_NE(bytes.find("(0,)"), std::string::npos);
    EXPECT_EQ(bytes.size() % 64, 0u);
}

TEST_F(Npy, WritesCosts) {
    const std::vector<RayCosts> costs = {{1, 2, 3, 4, 5}, {0, 0, 0, 0, 4294967295u}};
    write_costs(folder / "c.npy", costs);
    const std::string bytes = get(folder / "c.npy");
    ASSERT_GT(bytes.size(), 40u);
    EXPECT_TRUE(bytes.substr(10).starts_with(
        "{'descr': [('steps', '<u4'), ('cells', '<u4'), ('pixels', '<u4'), ('samples', '<u4'), ('triangles', '<u4')], "
        "'fortran_order': False, 'shape': (2,), }"));
    EXPECT_EQ(std::memcmp(bytes.data() + bytes.size() - 40, costs.data(), 40), 0);
}

}  // namespace
}  // namespace peelray
