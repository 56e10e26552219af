// Buffers: limits, sizes, transfers, moves.
#include <numeric>

#include "device_fixture.h"

namespace peelray {
namespace {

using BufferTest = DeviceTest;

TEST_F(BufferTest, BeyondTheBindingLimitSaysWhatAndHowMuch) {
    const uint64_t most = device().limits().maxStorageBufferRange;
    const uint64_t before = device().allocated();
    const std::pair<const char*, const char*> parts[] = {
        {"cubes", "--ldc"}, {"build scratch", "--ldc"}, {"frame", "--size"}, {"scene", "--tracer reference"}};
    for (const auto& [name, advice] : parts) {
        const MemoryPart part(device(), name);
        expect_error([&] { Buffer(device(), "the thing", most + 1); },
                     {"the thing", "MiB", device().info().name, advice, "--device"});
    }
    EXPECT_THROW(Buffer(device(), "the thing", most + 1), NoRoom);
    EXPECT_EQ(device().allocated(), before);
}

TEST(SmallDevice, BindsAndHoldsNoMoreThanItIsTold) {
    DeviceOptions options;
    options.most_bound = 1 << 20;
    options.most_held = 3 << 20;
    Device device(options);
    EXPECT_EQ(device.limits().maxStorageBufferRange, 1u << 20);
    EXPECT_THROW(Buffer(device, "too large", (1 << 20) + 1), NoRoom);
    const Buffer first(device, "first", 1 << 20), second(device, "second", 1 << 20);
    const auto two_more = [&] { const Buffer one(device, "third", 1 << 20), other(device, "fourth", 1 << 20); };
    EXPECT_THROW(two_more(), NoRoom);
    const Buffer third(device, "third", 1 << 19);  // what was freed is free again
    EXPECT_TRUE(third);
}

TEST_F(BufferTest, EvenAnEmptyBufferCanBeBound) {
    Buffer buffer(device(), "nothing", 0);
    EXPECT_TRUE(buffer);
    EXPECT_EQ(buffer.bytes(), 16u);
    EXPECT_EQ(download<uint32_t>(buffer, 0).size(), 0u);
    commands().upload(buffer, std::span<const uint32_t>());
    EXPECT_FALSE(Buffer());
}

TEST_F(BufferTest, MemoryIsCountedAndGivenBack) {
    const uint64_t before = device().allocated();
    {
        Buffer a(device(), "a", 1 << 20);
        EXPECT_GE(device().allocated(), before + (1 << 20));
        Buffer b(std::move(a));
        EXPECT_FALSE(a);
        EXPECT_EQ(a.bytes(), 0u);
        EXPECT_EQ(b.name(), "a");
        b = Buffer(device(), "c", 1 << 10);
        EXPECT_LT(device().allocated(), before + (1 << 20));
        EXPECT_GE(device().peak_allocated(), before + (1 << 20));
        Image2D image(device(), "image", 16, 16, VK_FORMAT_R32_UINT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                      VK_IMAGE_ASPECT_COLOR_BIT);
        Image2D other(std::move(image));
        EXPECT_EQ(other.width(), 16u);
    }
    EXPECT_EQ(device().allocated(), before);
}

TEST_F(BufferTest, EnsureSizeGrowsOnlyWhenItMust) {
    Buffer buffer;
    ensure_size(device(), buffer, "grows", 100);
    const VkBuffer first = buffer.handle();
    ensure_size(device(), buffer, "grows", 100);
    ensure_size(device(), buffer, "grows", 4);
    EXPECT_EQ(buffer.handle(), first);
    ensure_size(device(), buffer, "grows", 5000);
    EXPECT_GE(buffer.bytes(), 5000u);
}

TEST_F(BufferTest, TransfersLargerThanTheStagingMemoryComeBackWhole) {
    // 64 MiB is one piece: this is one, and a short second one that is no multiple of anything.
    const size_t count = (64u << 18) + 12345, offset = 64;
    ASSERT_GT(device().limits().maxStorageBufferRange, count * 4 + offset);
    std::vector<uint32_t> data(count);
    for (size_t i = 0; i < count; i++) data[i] = uint32_t(i) * 2654435761u;
    Buffer buffer(device(), "large", count * 4 + offset);
    commands().fill(buffer, 0xabcdabcd);
    commands().upload(buffer, std::span<const uint32_t>(data), offset);
    EXPECT_TRUE(download<uint32_t>(buffer, count, offset) == data);
    EXPECT_EQ(download<uint32_t>(buffer, 17, 0)[15], 0xabcdabcdu);
    EXPECT_EQ(download<uint32_t>(buffer, 17, 0)[16], data[0]);
}

TEST_F(BufferTest, OffsetsAreBytes) {
    std::vector<uint32_t> data(100);
    std::iota(data.begin(), data.end(), 0u);
    const Buffer buffer = upload(data);
    const std::vector<uint32_t> piece = {1000, 1001, 1002};
    commands().upload(buffer, std::span<const uint32_t>(piece), 40);
    const auto read = download<uint32_t>(buffer, 5, 36);
    EXPECT_EQ(read, (std::vector<uint32_t>{9, 1000, 1001, 1002, 13}));
    EXPECT_EQ(download<uint16_t>(buffer, 2, 160), (std::vector<uint16_t>{40, 0}));
}

TEST_F(BufferTest, TransfersBeyondTheEndAreRefused) {
    const Buffer buffer = upload(std::vector<uint32_t>(100), "short");
    const std::vector<uint32_t> data(100);
    expect_error([&] { commands().upload(buffer, std::span<const uint32_t>(data), 4); }, {"short"});
    expect_error([&] { download<uint32_t>(buffer, 101); }, {"short"});
    expect_error([&] { download<uint32_t>(buffer, 1, 400); }, {"short"});
}

TEST_F(BufferTest, FillAndCopyTouchTheirRangeOnly) {
    std::vector<uint32_t> data(64);
    std::iota(data.begin(), data.end(), 0u);
    const Buffer from = upload(data), to(device(), "to", 256);
    commands().fill(to, 7);
    commands().fill(to, 9, 16, 8);
    commands().copy(from, to, 12, 40, 100);
    const auto read = download<uint32_t>(to, 64);
    for (uint32_t i = 0; i < 64; i++) EXPECT_EQ(read[i], i == 4 || i == 5 ? 9u : i >= 25 && i < 28 ? i - 15 : 7u) << i;
}

}  // namespace
}  // namespace peelray
