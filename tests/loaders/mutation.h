// Small files of every format that is read, and random changes to them: what a reader must survive.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace peelray::testing {

/// Changes a file's bytes; the same seed makes the same changes. One to four at a time: bits turned over, bytes
/// overwritten, a number replaced by an extreme one (in text) or four bytes by an extreme value (in binary), a piece
/// cut out, doubled or moved, the end cut off.
class Mutation {
  public:
    explicit Mutation(uint64_t seed) : state_(seed * 2 + 1) {}

    std::string operator()(std::string bytes);

  private:
    size_t random(size_t below);
    void change(std::string& bytes);
    void replace_number(std::string& bytes);
    void replace_word(std::string& bytes);

    uint64_t state_;
};

/// A file to change, and the name under which it is loaded.
struct Sample {
    std::string name, bytes;
    /// Makes the file from changed bytes where those are only a part of it, so that the changes reach what the file
    /// wraps: all lengths are right. Empty: they are the file.
    std::function<std::string(const std::string&)> wrapped = {};
    std::string file(const std::string& changed) const { return wrapped ? wrapped(changed) : changed; }
};

/// Formats: obj, mtl, ply, stl, off, gltf, glb, draco, meshopt; exr and hdr of environments.
const std::vector<std::string>& mutation_formats();
/// Valid files of a format, each with a surface or a picture. Throws std::out_of_range for another one.
const std::vector<Sample>& samples(const std::string& format);

/// What loading some thousands of changed files came to.
struct MutationResult {
    uint64_t loaded = 0, refused = 0;
    std::vector<std::string> wrong;  ///< what ended neither with a scene nor with an Error of one line
};

/// Changes a format's samples in turn and loads them from `folder`, where the last one is found after a crash.
MutationResult load_mutations(const std::string& format, uint64_t count, uint64_t seed, const std::string& folder);

}  // namespace peelray::testing
