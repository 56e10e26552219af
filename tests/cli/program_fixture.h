// Runs the real program as a user would and looks at all it leaves behind.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "image/temp_folder.h"

namespace peelray {

struct Outcome {
    int status = -1;  ///< exit status; -N: ended by signal N
    std::string out, err;

    /// The lines on standard error that are no notes.
    std::vector<std::string> complaints() const {
        std::vector<std::string> lines;
        std::istringstream stream(err);
        for (std::string line; std::getline(stream, line);)
            if (!line.starts_with("peelray: note: ")) lines.push_back(line);
        return lines;
    }
};

/// The program at work.
struct Running {
    pid_t process = -1;
    std::filesystem::path out, err;  ///< where its output goes

    Outcome wait() const {
        int status = 0;
        ::waitpid(process, &status, 0);
        Outcome run;
        run.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        const auto text = [](const std::string& path) -> std::string {
            if (!std::filesystem::is_regular_file(path)) return "";
            std::ifstream file(path, std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(file), {});
        };
        run.out = text(out);
        run.err = text(err);
        return run;
    }
};

/// Starts the program with `variables` added to the environment. `name`: a different one for each at the same time.
/// `own_group`: as a shell starts it on a terminal.
inline Running start_program(const std::vector<std::string>& arguments, const std::filesystem::path& scratch,
                             const std::map<std::string, std::string>& variables = {}, const std::string& name = "",
                             bool own_group = false) {
    std::vector<char*> argv;
    std::string program = PEELRAY_PROGRAM;
    std::vector<std::string> copies = arguments;
    argv.push_back(program.data());
    for (std::string& text : copies) argv.push_back(text.data());
    argv.push_back(nullptr);
    Running running{-1, scratch / ("stdout" + name), scratch / ("stderr" + name)};
    running.process = ::fork();
    if (running.process == 0) {
        if (own_group) ::setpgid(0, 0);
        ::signal(SIGINT, SIG_DFL);  // who runs the tests in the background has it ignored
        ::setenv("XDG_CACHE_HOME", PEELRAY_CACHE, 1);
        for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
        const int flags = O_WRONLY | O_CREAT | O_TRUNC;
        ::dup2(::open("/dev/null", O_RDONLY), 0);
        ::dup2(::open(running.out.c_str(), flags, 0600), 1);
        ::dup2(::open(running.err.c_str(), flags, 0600), 2);
        ::execv(program.c_str(), argv.data());
        ::_exit(127);
    }
    return running;
}

/// `folder` holds the inputs, out/ the outputs, scratch/ what the program has no business with.
class ProgramTest : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        std::filesystem::create_directory(folder / "out");
        std::filesystem::create_directory(folder / "scratch");
    }

    Outcome run(const std::vector<std::string>& arguments,
                const std::map<std::string, std::string>& variables = {}) const {
        return start(arguments, variables).wait();
    }
    Running start(const std::vector<std::string>& arguments, const std::map<std::string, std::string>& variables = {},
                  const std::string& name = "", bool own_group = false) const {
        return start_program(arguments, folder / "scratch", variables, name, own_group);
    }
    std::string in(const std::string& name) const { return folder / name; }
    std::string out(const std::string& name) const { return folder / "out" / name; }

    /// The names in out/, sorted.
    std::vector<std::string> outputs() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
            names.push_back(entry.path().filename());
        std::sort(names.begin(), names.end());
        return names;
    }

    void remove_outputs() const {
        std::filesystem::remove_all(folder / "out");
        std::filesystem::create_directory(folder / "out");
    }

    /// Status 0, no complaint, and no outputs but these.
    void expect_done(const Outcome& run, const std::vector<std::string>& names) const {
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_TRUE(run.complaints().empty()) << run.err;
        EXPECT_EQ(outputs(), names);
    }

    /// One line that says `part`, and nothing else anywhere.
    void expect_refused(const Outcome& run, int status, const std::string& part) const {
        EXPECT_EQ(run.status, status) << run.err;
        EXPECT_EQ(run.out, "");
        const auto lines = run.complaints();
        ASSERT_EQ(lines.size(), 1u) << run.err;
        EXPECT_TRUE(run.err.ends_with('\n'));
        EXPECT_TRUE(lines[0].starts_with("peelray: ")) << lines[0];
        EXPECT_NE(lines[0].find(part), std::string::npos) << lines[0] << "\n  should say: " << part;
        EXPECT_EQ(lines[0].find("internal error"), std::string::npos) << lines[0];
        EXPECT_EQ(outputs(), std::vector<std::string>());
    }

    /// `peelray render SCENE -o out/a.png --size 64x48 …`
    Outcome render(const std::string& scene, std::vector<std::string> more = {},
                   const std::string& name = "a.png") const {
        std::vector<std::string> arguments = {"render", scene, "-o", out(name), "--size", "64x48"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
};

/// A cube from 0 to 1, two triangles a side: +z, -z, +x, -x, +y, -y.
inline const char* const kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 5 6 7\nf 5 7 8\nf 2 1 4\nf 2 4 3\nf 6 2 3\nf 6 3 7\nf 1 5 8\nf 1 8 4\nf 8 7 3\nf 8 3 4\nf 1 2 6\nf 1 6 5\n";

/// Bytes of plain values, one after the other.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A square of two triangles in the plane z = 0; its buffer "square.bin" is square_bytes().
inline std::string square_bytes(std::vector<float> corners = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0},
                                std::vector<uint16_t> indices = {0, 1, 2, 0, 2, 3}) {
    return bytes_of(corners) + bytes_of(indices);
}

inline nlohmann::json square_gltf() {
    return nlohmann::json::parse(R"({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"uri": "square.bin", "byteLength": 60}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}]})");
}

/// A .npy file: version 1.0 with this header and body.
inline std::string npy(const std::string& descr, const std::string& shape, const std::string& body,
                       bool fortran = false) {
    std::string header =
        "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
    while ((10 + header.size() + 1) % 64) header += ' ';
    header += '\n';
    return std::string("\x93NUMPY\x01\x00", 8) + char(header.size() & 255) + char(header.size() >> 8) + header + body;
}

/// Rays in the layout of RAYS.npy, eight numbers each.
inline std::string rays_npy(const std::vector<float>& numbers) {
    std::ostringstream shape;
    shape << "(" << numbers.size() / 8 << ", 8)";
    return npy("'<f4'", shape.str(), bytes_of(numbers));
}

}  // namespace peelray
