// Loads many randomly changed files of one format, in a folder for scratch:
//
//     mutated_files FORMAT COUNT [SEED [FOLDER]]
//
// Prints how many loaded and how many were refused; exit status 1 if one ended with neither a scene nor an Error of one
// line. A crash leaves the file that caused it in FOLDER (the present one if none is given).
#include <fmt/core.h>

#include <exception>
#include <string>

#include "loaders/mutation.h"

int main(int count, char** words) {
    if (count < 3) {
        fmt::print(stderr,
                   "usage: {} FORMAT COUNT [SEED [FOLDER]]; formats: obj mtl ply stl off gltf glb draco meshopt exr "
                   "hdr\n",
                   words[0]);
        return 2;
    }
    try {
        const peelray::testing::MutationResult result = peelray::testing::load_mutations(
            words[1], std::stoull(words[2]), count > 3 ? std::stoull(words[3]) : 1, count > 4 ? words[4] : ".");
        fmt::print("{}: {} loaded, {} refused, {} wrong\n", words[1], result.loaded, result.refused,
                   result.wrong.size());
        for (const std::string& line : result.wrong) fmt::print("{}\n", line);
        return result.wrong.empty() ? 0 : 1;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", words[0], error.what());
        return 2;
    }
}
