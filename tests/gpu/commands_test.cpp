// Recording: derived barriers, checked bindings, indirect runs, timestamps, pools that grow.
#include <numeric>

#include "common/scan_params.h"
#include "ldc/ldc_params.h"
#include "probe_fixture.h"

namespace peelray {
namespace {

struct Rotate {
    uint32_t count, shift, add;
};
struct Add {
    uint32_t count, step;
};

class CommandsTest : public ProbeTest {
  protected:
    void rotate(const Buffer& from, const Buffer& to, uint32_t count, uint32_t shift, uint32_t add) {
        commands().run(device().pass("probe_rotate"), {{"from", from}, {"to", to}}, Rotate{count, shift, add},
                       groups_for(count, 64));
    }
    void add(const Buffer& data, uint32_t count, uint32_t step) {
        commands().run(device().pass("probe_add", {{"factor", 1}}), {{"data", data}}, Add{count, step},
                       groups_for(count, 64));
    }
};

TEST_F(CommandsTest, ChainsOverTheSameBuffersGiveTheRightSums) {
    // Every thread reads another workgroup's result; a missing barrier is also a message of synchronization validation.
    const uint32_t count = 10000;
    std::vector<uint32_t> data(count);
    std::iota(data.begin(), data.end(), 0u);
    const Buffer a = upload(data), b(device(), "b", count * 4);
    for (uint32_t round = 0; round < 20; round++) {
        rotate(a, b, count, 777, 1);  // write after read, read after write
        rotate(b, a, count, 1234, 2);
        add(a, count, 5);  // read and write in place, twice
        add(a, count, 7);
    }
    rotate(b, a, count / 2, 0, 1000);  // write after write
    const auto result = download<uint32_t>(a, count);
    const auto other = download<uint32_t>(b, count);
    // 20 rounds of (777 + 1234) places and 15; `b` is half a round behind.
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t in_b = (i + 19 * 2011 + 777) % count + 19 * 15 + 1;
        ASSERT_EQ(other[i], in_b) << i;
        ASSERT_EQ(result[i], i < count / 2 ? in_b + 1000 : (i + 20 * 2011) % count + 300) << i;
    }
}

TEST_F(CommandsTest, TransfersAndPassesWaitForEachOther) {
    const uint32_t count = 5000;
    const Buffer a(device(), "a", count * 4), b(device(), "b", count * 4);
    commands().fill(a, 1);
    commands().fill(a, 2);
    rotate(a, b, count, 1, 10);
    commands().fill(a, 3);
    commands().copy(b, a, count * 2);
    commands().copy(a, b, 400, count * 2, 0);
    add(b, count, 100);
    const auto in_a = download<uint32_t>(a, count), in_b = download<uint32_t>(b, count);
    for (uint32_t i = 0; i < count; i++) {
        ASSERT_EQ(in_a[i], i < count / 2 ? 12u : 3u);
        ASSERT_EQ(in_b[i], i < 100 ? 103u : 112u);
    }
}

TEST_F(CommandsTest, SubmissionsSeeEachOthersResults) {
    const Buffer a = upload(std::vector<uint32_t>(1000, 1)), b(device(), "b", 4000);
    for (int i = 0; i < 5; i++) {
        add(a, 1000, 1);
        commands().submit();
        rotate(a, b, 1000, 1, 0);
        commands().submit();
    }
    EXPECT_EQ(download<uint32_t>(b, 1000), std::vector<uint32_t>(1000, 6));
    commands().submit();  // nothing recorded: no effect
}

// The table of device functions is public: these tests count the barriers that go through it.
PFN_vkCmdPipelineBarrier2 real_barrier = nullptr;
int barriers = 0;
VKAPI_ATTR void VKAPI_CALL count_barrier(VkCommandBuffer commands, const VkDependencyInfo* info) {
    barriers++;
    real_barrier(commands, info);
}

TEST_F(CommandsTest, BarriersComeExactlyWhereHazardsAre) {
    const uint32_t count = 256;
    const Buffer a = upload(std::vector<uint32_t>(count, 1)), b(device(), "b", count * 4), c(device(), "c", count * 4),
                 d(device(), "d", 1024);
    real_barrier = device().vk.vkCmdPipelineBarrier2;
    device().vk.vkCmdPipelineBarrier2 = count_barrier;
    barriers = 0;
    const auto fresh = [&] { return std::exchange(barriers, 0); };
    rotate(a, b, count, 0, 0);
    EXPECT_EQ(fresh(), 1) << "the first pass waits for earlier submissions";
    rotate(a, c, count, 0, 0);
    EXPECT_EQ(fresh(), 0) << "two readers of one buffer";
    rotate(b, d, count, 0, 0);
    EXPECT_EQ(fresh(), 1) << "read after write";
    rotate(c, a, count, 0, 0);
    EXPECT_EQ(fresh(), 0) << "the barrier before served this one too";
    commands().fill(c, 1);
    EXPECT_EQ(fresh(), 1) << "write after read";
    commands().fill(c, 2);
    EXPECT_EQ(fresh(), 1) << "write after write";
    add(b, count, 1);
    EXPECT_EQ(fresh(), 0) << "in place, untouched since the last barrier";
    add(b, count, 1);
    EXPECT_EQ(fresh(), 1) << "in place, twice";
    commands().submit();
    device().vk.vkCmdPipelineBarrier2 = real_barrier;
}

TEST_F(CommandsTest, BindingsAreChecked) {
    const Buffer a(device(), "a", 256), b(device(), "b", 256);
    const Pass& pass = device().pass("probe_rotate");
    const Rotate p{1, 0, 0};
    const std::string name = "probe_rotate";
    expect_error([&] { commands().run(pass, {{"from", a}}, p, {1}); }, {name, "2 bindings", "1"});
    expect_error(
        [&] {
            commands().run(pass, {{"from", a}, {"to", b}, {"more", b}}, p, {1});
        },
        {name, "2 bindings", "3"});
    expect_error([&] { commands().run(pass, {{"from", a}, {"too", b}}, p, {1}); }, {name, "'to'"});
    expect_error([&] { commands().run(pass, {{"from", a}, {"from", b}}, p, {1}); }, {name, "'to'"});
    expect_error([&] { commands().run(pass, {{"from", a}, {"to", Buffer()}}, p, {1}); }, {name, "'to'"});
    expect_error([&] { commands().run(pass, {{"from", a}, {"to", b}}, uint32_t(1), {1}); }, {name, "12 bytes", "4"});
    const uint32_t most = device().limits().maxComputeWorkGroupCount[0];
    if (most != ~0u)
        expect_error(
            [&] {
                commands().run(pass, {{"from", a}, {"to", b}}, p, {most + 1});
            },
            {name, device().info().name});
    expect_error([&] { device().pass("no_such_shader"); }, {"no_such_shader"});
    // A refused run leaves the recording usable.
    commands().fill(a, 5);
    rotate(a, b, 64, 0, 1);
    EXPECT_EQ(download<uint32_t>(b, 64), std::vector<uint32_t>(64, 6));
}

TEST_F(CommandsTest, BindingsThatAVariantDoesNotUseMayBeMissing) {
    const Pass &without = device().pass("probe_variant", {{"sums", 0}}),
               &with = device().pass("probe_variant", {{"sums", 1}});
    const Buffer a = upload(std::vector<uint32_t>(64, 1)), extra = upload(std::vector<uint32_t>(64, 100));
    commands().run(without, {{"data", a}, Binding::if_used("extra", nullptr)}, Add{64, 1}, {1});
    commands().run(without, {{"data", a}, Binding::if_used("extra", Buffer())}, Add{64, 1}, {1});
    commands().run(with, {{"data", a}, Binding::if_used("extra", extra)}, Add{64, 1}, {1});
    commands().run(with, if_used(std::vector<Binding>{{"extra", extra}, {"data", a}, {"other", a}}), Add{64, 1}, {1});
    EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, 5));
    EXPECT_EQ(download<uint32_t>(extra, 64), std::vector<uint32_t>(64, 100 + 4 + 5));

    const std::string name = "probe_variant";
    const Add p{64, 1};
    expect_error([&] { commands().run(without, {{"data", a}}, p, {1}); }, {name, "2 bindings", "1"});
    expect_error([&] { commands().run(without, {{"data", a}, {"extra", Buffer()}}, p, {1}); }, {name, "'extra'"});
    expect_error(
        [&] {
            commands().run(without, {{"data", a}, Binding::if_used("extar", extra)}, p, {1});
        },
        {name, "2 bindings", "1"});
    expect_error(
        [&] {
            commands().run(without, {{"data", a}, {"extra", a}, {"other", a}}, p, {1});
        },
        {name, "2 bindings", "3"});
    EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, 5));
}

TEST_F(CommandsTest, TheDummyIsNoHazardAndNoMemoryOfTheProgram) {
    const Buffer a = upload(std::vector<uint32_t>(64, 1)), b = upload(std::vector<uint32_t>(64, 1));
    const Pass& pass = device().pass("probe_variant", {{"sums", 0}});
    const uint64_t held = device().allocated();
    real_barrier = device().vk.vkCmdPipelineBarrier2;
    device().vk.vkCmdPipelineBarrier2 = count_barrier;
    commands().run(pass, {{"data", a}, Binding::if_used("extra", nullptr)}, Add{64, 1}, {1});
    barriers = 0;
    commands().run(pass, {{"data", b}, Binding::if_used("extra", nullptr)}, Add{64, 1}, {1});
    EXPECT_EQ(barriers, 0) << "the shader may write what is bound to `extra`";
    commands().submit();
    device().vk.vkCmdPipelineBarrier2 = real_barrier;
    EXPECT_EQ(device().allocated(), held);
    for (const Allocation& piece : device().allocations()) EXPECT_EQ(piece.name.find("dummy"), std::string::npos);
}

TEST_F(CommandsTest, OrderOfBindingsDoesNotMatter) {
    const Buffer a = upload(std::vector<uint32_t>(64, 3)), b(device(), "b", 256);
    commands().run(device().pass("probe_rotate"), {{"to", b}, {"from", a}}, Rotate{64, 0, 1}, {1});
    EXPECT_EQ(download<uint32_t>(b, 64), std::vector<uint32_t>(64, 4));
}

TEST_F(CommandsTest, ConstantsMakePassesOfTheirOwn) {
    EXPECT_NE(&device().pass("probe_add", {{"factor", 1}}), &device().pass("probe_add", {{"factor", 3}}));
    EXPECT_EQ(&device().pass("probe_add", {{"factor", 3}}), &device().pass("probe_add", {{"factor", 3}}));
    const Buffer a = upload(std::vector<uint32_t>(64, 1));
    commands().run(device().pass("probe_add", {{"factor", 3}}), {{"data", a}}, Add{64, 10}, {1});
    EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, 31));
}

TEST_F(CommandsTest, ConstantsAreMatchedByTheirNames) {
    // The order in which they are given means nothing, and neither do their numbers in the shader.
    for (const Constants& constants : {Constants{{"factor", 3}, {"offset", 100}, {"twice", 1}},
                                       Constants{{"twice", 1}, {"offset", 100}, {"factor", 3}}}) {
        const Buffer a = upload(std::vector<uint32_t>(64, 1));
        commands().run(device().pass("probe_constants", constants), {{"data", a}}, Add{64, 10}, {1});
        EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, 1 + 2 * (10 * 3 + 100)));
    }
    const auto& declared = device().pass("probe_constants", {{"factor", 1}, {"offset", 0}, {"twice", 0}}).interface();
    EXPECT_EQ(declared.constants.size(), 3u) << "what no code uses is none";
    for (const auto& [name, id] : declared.constants)
        EXPECT_EQ(id, name == "factor" ? 7u : name == "offset" ? 2u : 4u) << name;
}

TEST_F(CommandsTest, ConstantsAreChecked) {
    const std::string name = "probe_constants";
    const auto refused = [&](const Constants& constants, std::initializer_list<std::string> parts) {
        expect_error([&] { device().pass(name, constants); }, parts);
        expect_error([&] { device().pass(name, constants); }, parts);  // no half-made pass is kept
    };
    refused({}, {name, "not given", "'"});
    refused({{"factor", 3}, {"offset", 1}}, {name, "not given", "'twice'"});
    refused({{"factor", 3}, {"offset", 1}, {"twice", 0}, {"thrice", 1}}, {name, "no constant", "'thrice'"});
    refused({{"factor", 3}, {"offset", 1}, {"twice", 0}, {"unused", 1}}, {name, "no constant", "'unused'"});
    refused({{"factor", 3}, {"offset", 1}, {"twice", 0}, {"factor", 3}}, {name, "'factor'", "twice"});
    refused({{"factor", 3}, {"factor", 3}, {"offset", 1}}, {name, "'factor'", "twice"});
}

TEST_F(CommandsTest, IndirectRunsReadTheirCountsOnTheGpu) {
    // The counts themselves are written by a pass of the same recording.
    const Buffer a = upload(std::vector<uint32_t>(1000, 1)), from = upload(std::vector<uint32_t>{0, 0, 0, 2, 0, 0}),
                 arguments(device(), "arguments", 24);
    rotate(from, arguments, 6, 0, 1);  // 1 1 1, 3 1 1
    commands().run_indirect(device().pass("probe_add", {{"factor", 1}}), {{"data", a}}, Add{1000, 1}, arguments);
    commands().run_indirect(device().pass("probe_add", {{"factor", 1}}), {{"data", a}}, Add{1000, 10}, arguments, 12);
    commands().fill(arguments, 0);  // must wait for both
    commands().run_indirect(device().pass("probe_add", {{"factor", 1}}), {{"data", a}}, Add{1000, 100}, arguments);
    const auto result = download<uint32_t>(a, 1000);
    for (uint32_t i = 0; i < 1000; i++) ASSERT_EQ(result[i], i < 64 ? 12u : i < 192 ? 11u : 1u) << i;
}

TEST_F(CommandsTest, TimesAreOnePerPassWithTheGroupsName) {
    ASSERT_GT(device().timestamp_period(), 0);
    const Buffer a = upload(std::vector<uint32_t>(100000, 1), "a"), b(device(), "b", 400000);
    rotate(a, b, 100000, 1, 1);
    commands().begin_group("build");
    add(a, 100000, 1);
    commands().fill(b, 0);
    commands().end_group();
    add(b, 100000, 1);
    commands().submit();
    const auto times = commands().times();
    ASSERT_EQ(times.size(), 4u);
    EXPECT_EQ(times[0].name, "probe_rotate");
    EXPECT_EQ(times[1].name, "build/probe_add");
    EXPECT_EQ(times[2].name, "build/fill b");
    EXPECT_EQ(times[3].name, "probe_add");
    double sum = 0;
    for (const auto& time : times) {
        EXPECT_GE(time.ms, 0);
        sum += time.ms;
    }
    EXPECT_GT(sum, 0);
    EXPECT_GE(commands().elapsed_ms(), sum * 0.99) << "passes one after another";
    EXPECT_LT(commands().elapsed_ms(), 60000);
    commands().fill(b, 0);
    commands().submit();
    EXPECT_EQ(commands().times().size(), 1u);
}

TEST_F(CommandsTest, OnlyGroupsAndTheWholeAreTimedOnDemand) {
    ASSERT_GT(device().timestamp_period(), 0);
    const Buffer a = upload(std::vector<uint32_t>(100000, 1), "a"), b(device(), "b", 400000);
    commands().time_passes(false);
    rotate(a, b, 100000, 1, 1);
    commands().begin_group("build");
    add(a, 100000, 1);
    commands().fill(b, 0);
    commands().end_group();
    add(b, 100000, 1);
    commands().submit();
    const auto times = commands().times();
    const double elapsed = commands().elapsed_ms();
    commands().time_passes(true);
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "all passes");
    EXPECT_EQ(times[1].name, "build/all");
    EXPECT_GT(times[1].ms, 0);
    EXPECT_GT(times[0].ms, times[1].ms);
    EXPECT_EQ(elapsed, times[0].ms);
    EXPECT_EQ(download<uint32_t>(b, 100000), std::vector<uint32_t>(100000, 1));
}

TEST_F(CommandsTest, OneRecordingMayHoldMorePassesThanAnyPool) {
    // 256 descriptor sets and 512 timers are one pool each.
    const uint32_t passes = 1300;
    for (int again = 0; again < 2; again++) {
        const Buffer a = upload(std::vector<uint32_t>(64, 0));
        for (uint32_t i = 0; i < passes; i++) add(a, 64, i);
        commands().submit();
        ASSERT_EQ(commands().times().size(), passes);
        double sum = 0;
        for (const auto& time : commands().times()) {
            ASSERT_GE(time.ms, 0);
            sum += time.ms;
        }
        EXPECT_GE(commands().elapsed_ms(), sum * 0.99);
        EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, passes * (passes - 1) / 2));
    }
}

TEST_F(CommandsTest, AnEmptyDispatchIsAllowed) {
    const Buffer a = upload(std::vector<uint32_t>(64, 1));
    commands().run(device().pass("probe_add", {{"factor", 1}}), {{"data", a}}, Add{0, 1}, groups_for(0, 64));
    EXPECT_EQ(download<uint32_t>(a, 64), std::vector<uint32_t>(64, 1));
    EXPECT_EQ(groups_for(1, 64).x, 1u);
    EXPECT_EQ(groups_for(64, 64).x, 1u);
    EXPECT_EQ(groups_for(65, 64).x, 2u);
}

TEST_F(CommandsTest, ReflectionSeesAccessNamesAndSizes) {
    const auto find = [&](const char* pass, const char* name) {
        for (const auto& b : device().pass(pass).interface().bindings)
            if (b.name == name) return b;
        ADD_FAILURE() << pass << " has no " << name;
        return ShaderBinding{};
    };
    const ShaderBinding counters = find("scan_reduce", "counters"), sums = find("scan_reduce", "block_sums"),
                        both = find("scan_apply", "sums");
    EXPECT_EQ(counters.binding, 0u);
    EXPECT_TRUE(counters.reads && !counters.writes);
    EXPECT_EQ(sums.binding, 2u);
    EXPECT_TRUE(!sums.reads && sums.writes);
    EXPECT_TRUE(both.reads && both.writes);
    const auto& reduce = device().pass("scan_reduce").interface();
    EXPECT_EQ(reduce.bindings.size(), 3u);
    EXPECT_EQ(reduce.push_constant_bytes, sizeof(ScanParams));
    EXPECT_EQ(reduce.group_size[0], 256u);
    const Constants raster = {{"masked", 0}, {"small_pixels", 48}, {"keeps_corners", 0}};
    EXPECT_EQ(device().pass("ldc_raster", raster).interface().push_constant_bytes, sizeof(LdcParams));
    // Every shader of the library must fit what Commands binds with.
    for (const auto& shader : peelray_shaders()) {
        ShaderInterface interface;
        interface.reflect(shader.code);
        EXPECT_LE(interface.push_constant_bytes, 128u) << shader.name << ": more than Vulkan guarantees";
        EXPECT_LE(interface.group_size[0] * interface.group_size[1] * interface.group_size[2], 256u) << shader.name;
        for (const auto& binding : interface.bindings)
            EXPECT_TRUE(binding.reads || binding.writes) << shader.name << " " << binding.name;
    }
}

}  // namespace
}  // namespace peelray
