// Finding and opening devices, and the pipeline cache on disk.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "device_fixture.h"
#include "gpu/pass.h"
#include "gpu/pipeline_cache.h"

namespace fs = std::filesystem;

namespace peelray {
namespace {

using DeviceChoice = DeviceTest;

TEST_F(DeviceChoice, ListIsCompleteAndBestFirst) {
    const auto devices = list_devices();
    ASSERT_FALSE(devices.empty());
    const std::vector<std::string> order = {"discrete", "integrated", "virtual", "CPU", "other"};
    ptrdiff_t last = 0;
    for (size_t i = 0; i < devices.size(); i++) {
        const auto& d = devices[i];
        EXPECT_EQ(d.index, i);
        EXPECT_FALSE(d.name.empty());
        EXPECT_FALSE(d.driver.empty());
        EXPECT_EQ(d.api_version.rfind("1.", 0), 0u) << d.api_version;
        EXPECT_GT(d.memory, 0u);
        EXPECT_EQ(d.usable, d.lacking.empty());
        const auto rank = std::find(order.begin(), order.end(), d.kind) - order.begin();
        ASSERT_LT(rank, ptrdiff_t(order.size())) << d.kind;
        EXPECT_GE(rank, last);
        last = rank;
    }
}

TEST_F(DeviceChoice, ByIndexAndByPartOfTheName) {
    const auto devices = list_devices();
    for (const auto& d : devices) {
        if (!d.usable) continue;
        const Device by_index(DeviceOptions{std::to_string(d.index)});
        EXPECT_EQ(by_index.info().index, d.index);
        EXPECT_EQ(by_index.info().name, d.name);
        // The middle of the name, in the other case; the first device that matches is meant.
        std::string part = d.name.substr(1, 4);
        for (char& c : part) c = char(std::isupper((unsigned char)c) ? std::tolower(c) : std::toupper(c));
        const Device by_name(DeviceOptions{part});
        EXPECT_LE(by_name.info().index, d.index);
        std::string a = by_name.info().name, b = part;
        std::transform(a.begin(), a.end(), a.begin(), ::tolower);
        std::transform(b.begin(), b.end(), b.begin(), ::tolower);
        EXPECT_NE(a.find(b), std::string::npos);
    }
    EXPECT_EQ(Device().info().index,
              std::find_if(devices.begin(), devices.end(), [](auto& d) { return d.usable; })->index);
}

TEST_F(DeviceChoice, UnknownNamesSayWhatThereIs) {
    const std::string there = "0: " + list_devices()[0].name;
    for (const char* name : {"no such chip", "99", "-1", "00", "4294967296"})
        expect_error([&] { Device device(DeviceOptions{name}); },
                     {std::string("'") + name + "'", there, "peelray devices"});
}

TEST_F(DeviceChoice, CheckValidationThrowsWhatTheLayersSaid) {
    Device own(DeviceOptions{"", true});
    own.check_validation();
    // Two fills of one buffer without a barrier: also the proof that synchronization validation watches all other
    // tests.
    {
        Buffer buffer(own, "victim", 256);
        VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, own.queue_family};
        VkCommandPool pool;
        ASSERT_EQ(own.vk.vkCreateCommandPool(own.handle, &pool_info, nullptr, &pool), VK_SUCCESS);
        VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                         VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        VkCommandBuffer commands;
        ASSERT_EQ(own.vk.vkAllocateCommandBuffers(own.handle, &info, &commands), VK_SUCCESS);
        VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        own.vk.vkBeginCommandBuffer(commands, &begin);
        own.vk.vkCmdFillBuffer(commands, buffer.handle(), 0, 256, 1);
        EXPECT_TRUE(own.validation_messages().empty());
        own.vk.vkCmdFillBuffer(commands, buffer.handle(), 0, 256, 2);
        own.vk.vkEndCommandBuffer(commands);
        own.vk.vkDestroyCommandPool(own.handle, pool, nullptr);
    }
    ASSERT_FALSE(own.validation_messages().empty());
    EXPECT_NE(own.validation_messages()[0].find("SYNC-HAZARD-WRITE-AFTER-WRITE"), std::string::npos)
        << own.validation_messages()[0];
    EXPECT_THROW(own.check_validation(), Error);
}

TEST(PipelineCacheFile, UnsealGivesBackOnlyWhatSealMade) {
    std::vector<char> data(1000);
    for (size_t i = 0; i < data.size(); i++) data[i] = char(i * 37);
    const auto file = PipelineCache::seal(data);
    EXPECT_EQ(PipelineCache::unseal(file), data);
    EXPECT_TRUE(PipelineCache::unseal(PipelineCache::seal({})).empty());
    for (size_t size = 0; size < file.size(); size++)
        ASSERT_TRUE(PipelineCache::unseal({file.begin(), file.begin() + ptrdiff_t(size)}).empty())
            << "truncated to " << size;
    for (size_t bit = 0; bit < file.size() * 8; bit += 3) {
        auto bad = file;
        bad[bit / 8] = char(bad[bit / 8] ^ (1 << bit % 8));
        ASSERT_TRUE(PipelineCache::unseal(bad).empty()) << "bit " << bit;
    }
    auto longer = file;
    longer.push_back(0);
    EXPECT_TRUE(PipelineCache::unseal(longer).empty());
    EXPECT_TRUE(PipelineCache::unseal(std::vector<char>(4096, 'x')).empty());
    EXPECT_TRUE(PipelineCache::unseal(std::vector<char>(4096, 0)).empty());
}

/// Each test has a cache folder of its own.
class PipelineCacheFolder : public testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "peelray-cache-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        if (const char* old = std::getenv("XDG_CACHE_HOME")) old_ = old, had_ = true;
        use(folder_);
    }
    void TearDown() override {
        if (had_)
            ::setenv("XDG_CACHE_HOME", old_.c_str(), 1);
        else
            ::unsetenv("XDG_CACHE_HOME");
        fs::remove_all(folder_);
    }
    static void use(const fs::path& path) { ::setenv("XDG_CACHE_HOME", path.c_str(), 1); }
    static fs::path file() {
        static const VkPhysicalDeviceProperties properties = Device().properties();
        return PipelineCache::file_for(properties);
    }
    /// Opens a device, compiles a shader, closes the device, as any run of the program does.
    static void run() {
        Device device;
        device.pass("scan_reduce");
    }
    static std::vector<char> contents(const fs::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    fs::path folder_;
    std::string old_;
    bool had_ = false;
};

TEST_F(PipelineCacheFolder, IsMadeFilledAndLeftAlone) {
    EXPECT_EQ(file().parent_path(), folder_ / "peelray");
    run();
    ASSERT_TRUE(fs::is_regular_file(file()));
    const auto first = contents(file());
    EXPECT_FALSE(PipelineCache::unseal(first).empty());
    run();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "peelray"), {}), 1) << "temporary files remain";
    EXPECT_FALSE(PipelineCache::unseal(contents(file())).empty());
}

TEST_F(PipelineCacheFolder, DamagedFilesAreReplaced) {
    run();
    const auto good = contents(file());
    auto flipped = good;
    flipped[flipped.size() / 2] = char(flipped[flipped.size() / 2] ^ 0x40);
    const std::vector<char> half(good.begin(), good.begin() + ptrdiff_t(good.size() / 2));
    // Sealed rightly, but no driver ever wrote this: the driver must see and refuse it.
    const auto foreign = PipelineCache::seal(std::vector<char>(500, 'z'));
    for (const auto& bad : {std::vector<char>{}, flipped, half, foreign, std::vector<char>(100000, '\xff')}) {
        std::ofstream(file(), std::ios::binary).write(bad.data(), std::streamsize(bad.size()));
        EXPECT_NO_THROW(run());
        EXPECT_FALSE(PipelineCache::unseal(contents(file())).empty());
        EXPECT_NE(contents(file()), bad);
    }
}

TEST_F(PipelineCacheFolder, UnusablePlacesAreNoError) {
    const fs::path plain = folder_ / "plain";
    std::ofstream(plain) << "not a folder";
    for (const fs::path& path : {plain, fs::path("/proc"), fs::path("/proc/self/no/such"), fs::path("/dev/null"),
                                 fs::path("/nonexistent/x"), fs::path(std::string(300, 'a'))}) {
        use(path);
        EXPECT_NO_THROW(run()) << path;
    }
    EXPECT_EQ(contents(plain).size(), 12u);
}

TEST_F(PipelineCacheFolder, AFolderInTheFilesPlaceIsNoError) {
    fs::create_directories(file() / "inside");
    EXPECT_NO_THROW(run());
    EXPECT_TRUE(fs::is_directory(file() / "inside"));
}

TEST_F(PipelineCacheFolder, WithoutAnyHomeNothingIsWritten) {
    const char* home = std::getenv("HOME");
    const std::string saved = home ? home : "";
    ::setenv("XDG_CACHE_HOME", "", 1);
    ::setenv("HOME", folder_.c_str(), 1);
    EXPECT_EQ(file().parent_path(), folder_ / ".cache" / "peelray");
    ::unsetenv("HOME");
    EXPECT_TRUE(file().empty());
    EXPECT_NO_THROW(run());
    if (home) ::setenv("HOME", saved.c_str(), 1);
}

}  // namespace
}  // namespace peelray
