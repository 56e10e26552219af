// The prefix sum of pairs: three passes over any number of elements, counted on the host or on the GPU.
#include "common/scan_params.h"
#include "probe_fixture.h"

namespace peelray {
namespace {

using glm::uvec2;

class Scan : public ProbeTest {
  protected:
    /// Runs the three passes as the builder does; returns what `sums` and the grand total hold afterwards.
    std::pair<std::vector<uvec2>, uvec2> scan(const std::vector<uvec2>& values, uint32_t capacity,
                                              const Buffer& counters, uint32_t counter) {
        const Buffer sums = upload(values);
        const uint32_t blocks = (capacity + SCAN_BLOCK - 1) / SCAN_BLOCK;
        const Buffer block_sums(device(), "block sums", (blocks + 1) * 8);
        commands().fill(block_sums, 0xdeadbeef);
        const ScanParams p{capacity, counter};
        const Groups groups = groups_for(capacity, SCAN_BLOCK);
        commands().run(device().pass("scan_reduce"),
                       {{"counters", counters}, {"sums", sums}, {"block_sums", block_sums}}, p, groups);
        commands().run(device().pass("scan_blocks"), {{"block_sums", block_sums}}, p, {1});
        commands().run(device().pass("scan_apply"),
                       {{"counters", counters}, {"sums", sums}, {"block_sums", block_sums}}, p, groups);
        return {download<uvec2>(sums, values.size()), download<uvec2>(block_sums, 1, blocks * 8)[0]};
    }
    std::vector<uvec2> values(size_t count) {
        std::vector<uvec2> list(count);
        for (auto& v : list) v = uvec2(bits() % 1000, bits() % 3);
        return list;
    }
    static void expect_scanned(const std::vector<uvec2>& in, const std::vector<uvec2>& out, size_t count, uvec2 total) {
        uvec2 sum(0);
        for (size_t i = 0; i < in.size(); i++) {
            ASSERT_EQ(out[i], i < count ? sum : in[i]) << i << " of " << count;
            if (i < count) sum += in[i];
        }
        EXPECT_EQ(total, sum);
    }
};

constexpr uint32_t kSizes[] = {0, 1, 2, 3, 4, 5, 255, 256, 257, 1023, 1024, 1025, 4097, 262144, 262145, 300000};

TEST_F(Scan, CountedOnTheHost) {
    const Buffer counters = upload(std::vector<uint32_t>(4, 7));
    for (uint32_t size : kSizes) {
        const auto in = values(size + 10);  // what lies behind stays
        const auto [out, total] = scan(in, size, counters, SCAN_NO_COUNTER);
        expect_scanned(in, out, size, total);
    }
}

TEST_F(Scan, CountedOnTheGpuAndClampedToTheCapacity) {
    for (uint32_t size : kSizes)
        for (const uint32_t capacity : {300000u, size, size - size / 3}) {
            const Buffer counters = upload(std::vector<uint32_t>{9, 9, size, 9});
            const auto in = values(capacity + 10);
            const auto [out, total] = scan(in, capacity, counters, 2);
            expect_scanned(in, out, std::min(size, capacity), total);
        }
}

TEST_F(Scan, SumsWrapLikeUnsignedIntegers) {
    const std::vector<uvec2> in(3000, uvec2(0xffffffffu, 0x40000000u));
    const Buffer counters = upload(std::vector<uint32_t>{0});
    const auto [out, total] = scan(in, 3000, counters, SCAN_NO_COUNTER);
    expect_scanned(in, out, 3000, total);
}

}  // namespace
}  // namespace peelray
