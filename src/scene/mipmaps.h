// The smaller levels of textures. Every tracer filters by the same ones.
#pragma once

#include <memory>
#include <vector>

#include "base/once.h"
#include "scene/scene.h"

namespace peelray {

/// Levels 1, 2, … of a texture, down to one texel: each has half the columns and rows of the one before, rounded down,
/// and its texels are the means of what they cover there, in linear light or, of `is_data`, as stored. As many bits a
/// channel as the texture has.
std::vector<Texture> make_mipmaps(const Texture& texture, bool is_data);

/// The levels of the textures that a scene's materials use, made when they are first asked for; threads may ask at
/// once. The scene must outlive it.
class Mipmaps {
  public:
    explicit Mipmaps(const Scene& scene);

    /// None of a texture that is not filtered by levels. Throws std::out_of_range if no material uses it so.
    const std::vector<Texture>& of(int texture, bool is_data) const;

  private:
    struct Made {
        Once once;
        std::vector<Texture> levels;
    };
    const Scene& scene_;
    std::vector<std::unique_ptr<Made>> made_;  ///< per texture, of colours and of data; null: no material uses it so
};

/// Which levels of a texture serve a footprint of so many texels, and how far it is from the first to the second.
struct LevelChoice {
    uint32_t first = 0, second = 0;
    double part = 0;
    bool nearest = false;  ///< the nearest texel; else the four around
};
/// `lod`: the binary logarithm of the footprint's width in texels of level 0; ≤ 0: the texture is magnified.
LevelChoice choose_level(const Texture& texture, double lod);

}  // namespace peelray
