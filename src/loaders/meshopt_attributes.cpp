#include "loaders/meshopt_attributes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace peelray {

namespace {

constexpr size_t group_size = 16;

class AttributeStream {
  public:
    AttributeStream(std::span<const uint8_t> stream, size_t stride) : stride_(stride) {
        const size_t tail = stride + stride / 4, padded = std::max<size_t>(tail, 24);
        if (stream.size() < 1 + padded) {
            is_broken_ = true;
            return;
        }
        const std::span<const uint8_t> end = stream.last(tail);
        previous_.assign(end.begin(), end.begin() + std::ptrdiff_t(stride));
        channels_ = end.subspan(stride);
        data_ = stream.subspan(1, stream.size() - 1 - padded);
        for (const uint8_t channel : channels_)
            is_broken_ |= (channel & 15) > 2 || ((channel & 15) < 2 && channel > 15);
    }

    std::optional<Bytes> decode(size_t count) {
        const size_t most = std::min<size_t>((8192 / stride_) & ~(group_size - 1), 256);
        if (is_broken_) return std::nullopt;
        Bytes out(count * stride_);
        for (size_t first = 0; first < count && !is_broken_; first += most) {
            const size_t elements = std::min(most, count - first);
            read_block(elements);
            if (!is_broken_) add_deltas(elements, out.data() + first * stride_);
        }
        if (is_broken_ || !data_.empty()) return std::nullopt;
        return out;
    }

  private:
    /// The next bytes; of a stream that is too short, zeros.
    std::span<const uint8_t> take(size_t size) {
        static constexpr uint8_t nothing[256] = {};
        if (size > data_.size()) {
            is_broken_ = true;
            return std::span(nothing).first(size);
        }
        const std::span<const uint8_t> taken = data_.first(size);
        data_ = data_.subspan(size);
        return taken;
    }

    /// The deltas of a block's elements, byte position by byte position.
    void read_block(size_t elements) {
        per_byte_ = (elements + group_size - 1) / group_size * group_size;
        deltas_.assign(per_byte_ * stride_, 0);
        const std::span<const uint8_t> controls = take(stride_ / 4);
        for (size_t byte = 0; byte < stride_ && !is_broken_; ++byte) {
            const int control = controls[byte / 4] >> (byte % 4 * 2) & 3;
            uint8_t* const out = deltas_.data() + byte * per_byte_;
            if (control < 2) read_groups(control, out);
            if (control == 3) std::memcpy(out, take(elements).data(), elements);
        }
    }

    void read_groups(int control, uint8_t* out) {
        const size_t groups = per_byte_ / group_size;
        const std::span<const uint8_t> headers = take((groups + 3) / 4);
        for (size_t group = 0; group < groups && !is_broken_; ++group) {
            const int header = headers[group / 4] >> (group % 4 * 2) & 3;
            // Widths of 0, 1, 2, 4 or of 1, 2, 4, 8 bits.
            const int step = header + control, bits = step == 0 ? 0 : 1 << (step - 1);
            read_group(bits, out + group * group_size);
        }
    }

    /// Sixteen deltas of few bits each; those with all bits set follow as bytes.
    void read_group(int bits, uint8_t* out) {
        if (bits == 0) return;
        const std::span<const uint8_t> packed = take(size_t(bits) * group_size / 8);
        if (bits == 8) {
            std::memcpy(out, packed.data(), group_size);
            return;
        }
        const int per_byte = 8 / bits, all = (1 << bits) - 1;
        for (int i = 0; i < int(group_size); ++i) {
            const int place = i % per_byte;
            // Single bits count from the lowest one up, the others from the highest down.
            const int shift = bits == 1 ? place : 8 - bits * (place + 1);
            const int value = packed[size_t(i / per_byte)] >> shift & all;
            out[i] = value == all ? take(1)[0] : static_cast<uint8_t>(value);
        }
    }

    void add_deltas(size_t elements, uint8_t* out) {
        for (size_t i = 0; i < elements; ++i, out += stride_) {
            for (size_t channel = 0; channel < stride_ / 4; ++channel) {
                uint32_t delta = 0, value;
                for (size_t k = 0; k < 4; ++k)
                    delta |= static_cast<uint32_t>(deltas_[(4 * channel + k) * per_byte_ + i]) << (8 * k);
                std::memcpy(&value, &previous_[4 * channel], 4);
                value = next(value, delta, channels_[channel]);
                std::memcpy(&previous_[4 * channel], &value, 4);
            }
            std::memcpy(out, previous_.data(), stride_);
        }
    }

    static uint32_t next(uint32_t value, uint32_t delta, uint8_t channel) {
        if (channel & 2) return value ^ std::rotr(delta, channel >> 4);
        const int width = channel & 1 ? 16 : 8;  // of the numbers that the four bytes hold
        const uint32_t mask = (1u << width) - 1;
        uint32_t sum = 0;
        for (int shift = 0; shift < 32; shift += width) {
            const uint32_t zigzag = delta >> shift & mask, difference = zigzag & 1 ? ~(zigzag >> 1) : zigzag >> 1;
            sum |= (((value >> shift) + difference) & mask) << shift;
        }
        return sum;
    }

    const size_t stride_;
    std::span<const uint8_t> data_, channels_;
    Bytes previous_;  ///< the last element
    Bytes deltas_;    ///< of a block: `per_byte_` for each byte position
    size_t per_byte_ = 0;
    bool is_broken_ = false;
};

template <typename Unsigned, typename Signed>
void decode_colors(Bytes& data) {
    constexpr int largest = static_cast<Unsigned>(~0);
    for (size_t at = 0; at + 4 * sizeof(Unsigned) <= data.size(); at += 4 * sizeof(Unsigned)) {
        Unsigned in[4];
        std::memcpy(in, data.data() + at, sizeof in);
        const int y = in[0], co = static_cast<Signed>(in[1]), cg = static_cast<Signed>(in[2]), a = in[3];
        // The highest bit of alpha says how many bits the numbers have.
        const int one = a == 0 ? 0 : (1 << std::bit_width(static_cast<unsigned>(a))) - 1, low = a & one >> 1;
        const int rgba[4] = {y + co - cg, y + cg, y - co - cg, low << 1 | (low & 1)};
        for (int k = 0; k < 4; ++k) {
            const double value = one == 0 ? 0 : std::round(static_cast<double>(rgba[k]) * largest / one);
            in[k] = static_cast<Unsigned>(std::clamp<double>(value, 0, largest));
        }
        std::memcpy(data.data() + at, in, sizeof in);
    }
}

}  // namespace

std::optional<Bytes> decode_meshopt_attributes_1(std::span<const uint8_t> stream, size_t count, size_t stride) {
    return AttributeStream(stream, stride).decode(count);
}

void decode_meshopt_colors(Bytes& data, size_t stride) {
    if (stride == 4)
        decode_colors<uint8_t, int8_t>(data);
    else
        decode_colors<uint16_t, int16_t>(data);
}

}  // namespace peelray
