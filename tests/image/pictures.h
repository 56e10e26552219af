// Pictures that the tests of the metrics compare, all exact: whole numbers, or floats without rounding.
#pragma once

#include <cstdint>

#include "image/image.h"

namespace peelray {

constexpr uint32_t rgb(int r, int g, int b) {
    return 0xff000000u | uint32_t(b) << 16 | uint32_t(g) << 8 | uint32_t(r);
}

inline Image8 constant(uint32_t width, uint32_t height, uint32_t color) {
    return {width, height, std::vector<uint32_t>(size_t(width) * height, color)};
}

inline Image constant(uint32_t width, uint32_t height, const glm::vec3& color) {
    return {width, height, std::vector<glm::vec4>(size_t(width) * height, glm::vec4(color, 1))};
}

inline int channel(uint32_t pixel, int c) {
    return int(pixel >> (8 * c) & 255);
}

/// Ramps and fine detail in all channels.
inline Image8 pattern(uint32_t width = 96, uint32_t height = 64) {
    Image8 image = constant(width, height, 0u);
    for (uint32_t i = 0; i < width * height; ++i) {
        const int x = int(i % width), y = int(i / width);
        image.pixels[i] = rgb((x * 5 + y * 3) & 255, (x * x / 7 + 2 * y) & 255, ((x ^ y) * 4) & 255);
    }
    return image;
}

/// pattern() (or any picture of at least 71×50) with less green at the right, blue inverted at the bottom left, a white
/// line and a black point.
inline Image8 changed(Image8 image) {
    for (uint32_t i = 0; i < image.width * image.height; ++i) {
        const uint32_t x = i % image.width, y = i / image.width, p = image.pixels[i];
        int r = channel(p, 0), g = channel(p, 1), b = channel(p, 2);
        if (x >= image.width / 2) g = g * 3 / 4;
        if (y == 20) r = g = b = 255;
        if (x == 70 && y == 40) r = g = b = 0;
        if (x < 32 && y >= 48) b = 255 - b;
        image.pixels[i] = rgb(r, g, b);
    }
    return image;
}

/// The squares of pattern(), 0 to 63.5, with a highlight 64 times as bright.
inline Image radiance() {
    const Image8 from = pattern();
    Image image = constant(from.width, from.height, glm::vec3(0));
    for (uint32_t i = 0; i < from.width * from.height; ++i) {
        const uint32_t x = i % from.width, y = i / from.width;
        const bool highlight = x >= 16 && x < 40 && y >= 8 && y < 24;
        for (int c = 0; c < 3; ++c) {
            const auto value = float(channel(from.pixels[i], c));
            image.pixels[i][c] = value * value / 1024 * (highlight ? 64.0f : 1.0f);
        }
    }
    return image;
}

/// radiance() with a brighter highlight, a grey line and a patch of less red.
inline Image radiance_changed() {
    Image image = radiance();
    for (uint32_t i = 0; i < image.width * image.height; ++i) {
        const uint32_t x = i % image.width, y = i / image.width;
        glm::vec4& pixel = image.pixels[i];
        if (x >= 16 && x < 40 && y >= 8 && y < 24) pixel = glm::vec4(1.25f * glm::vec3(pixel), 1);
        if (y == 50) pixel = glm::vec4(0.5f, 0.5f, 0.5f, 1);
        if (x >= 60 && x < 80 && y >= 30 && y < 40) pixel.x *= 0.75f;
    }
    return image;
}

}  // namespace peelray
