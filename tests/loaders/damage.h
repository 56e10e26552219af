// Damages the bytes of a file in ways that a fixed generator picks.
#pragma once

#include <cstdint>
#include <string>

namespace peelray::testing {

class Damage {
  public:
    /// The file with some bytes overwritten, and sometimes cut. Nothing can happen to an empty one.
    std::string operator()(std::string bytes) {
        if (bytes.empty()) return bytes;
        for (size_t i = 0; i <= random(6); ++i)
            bytes[random(bytes.size())] = static_cast<char>(random(3) ? '0' + random(10) : random(256));
        if (random(8) == 0) bytes.resize(random(bytes.size()));
        return bytes;
    }

  private:
    size_t random(size_t below) {
        state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<size_t>(state_ >> 33) % below;
    }

    uint64_t state_ = 1;
};

}  // namespace peelray::testing
