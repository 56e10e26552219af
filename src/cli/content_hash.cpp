#include "cli/content_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <fstream>
#include <memory>
#include <vector>

#include "base/error.h"

namespace peelray {

std::string content_hash(const std::filesystem::path& path) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
    if (!state) throw std::bad_alloc();
    XXH3_128bits_reset(state.get());
    std::ifstream stream(path, std::ios::binary);
    std::vector<char> block(1 << 20);
    while (stream) {
        stream.read(block.data(), std::streamsize(block.size()));
        XXH3_128bits_update(state.get(), block.data(), size_t(stream.gcount()));
    }
    if (!stream.eof()) fail("cannot read {}; check the path", path.string());
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("xxh128:{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace peelray
