// Work on other threads: order, bounds, errors, and what is left of it all.
#include "base/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/cores.h"

namespace peelray {
namespace {

using namespace std::chrono_literals;

TEST(WorkerPool, DoesEverythingOnceAndDeliversInOrder) {
    for (const size_t threads : {1, 2, 8}) {
        WorkerPool pool({.threads = threads, .items = 5});
        std::atomic<int> worked{0};
        std::vector<int> delivered;  // never two at once, so that it needs no lock
        for (int i = 0; i < 200; i++)
            pool.add(
                1,
                [&, i] {
                    if (i % 7 == 0) std::this_thread::sleep_for(1ms);
                    worked++;
                },
                [&, i] { delivered.push_back(i); });
        pool.finish();
        EXPECT_EQ(worked, 200);
        ASSERT_EQ(delivered.size(), 200u);
        for (int i = 0; i < 200; i++) EXPECT_EQ(delivered[size_t(i)], i);
        EXPECT_EQ(pool.finished(), 200u);
    }
}

TEST(WorkerPool, WorksOnAllThreadsAtOnce) {
    WorkerPool pool({.threads = 4, .items = 4});
    std::atomic<int> here{0};
    for (int i = 0; i < 4; i++)
        pool.add(1, [&] {
            here++;
            for (int k = 0; k < 10'000 && here < 4; k++) std::this_thread::sleep_for(1ms);
        });
    pool.finish();
    EXPECT_EQ(here, 4) << "one waited for another to end";
}

/// Slow work and a fast giver: what is held stays within the bounds.
TEST(WorkerPool, HoldsNoMoreThanItMay) {
    std::atomic<int> alive{0}, most{0};
    const auto item = [&] {
        most = std::max(most.load(), ++alive);
        return std::shared_ptr<int>(new int(0), [&](int* number) {
            alive--;
            delete number;
        });
    };
    {
        WorkerPool pool({.threads = 2, .items = 4});
        for (int i = 0; i < 40; i++) pool.add(100, [kept = item()] { std::this_thread::sleep_for(2ms); });
        pool.finish();
        EXPECT_EQ(pool.peak().items, 4u);
        EXPECT_LE(most, 5) << "four, and the one that waits for room";
        EXPECT_GT(pool.times().waited, 0);
    }
    most = 0;
    WorkerPool pool({.threads = 4, .items = 100, .bytes = 250});
    for (int i = 0; i < 40; i++) pool.add(100, [kept = item()] { std::this_thread::sleep_for(1ms); });
    pool.finish();
    EXPECT_EQ(pool.peak().bytes, 200u);
    EXPECT_LE(most, 3);
    EXPECT_EQ(alive, 0);
    pool.add(1000, [] {});  // larger than all that may be held: alone
    pool.finish();
    EXPECT_EQ(pool.peak().bytes, 1000u);
    EXPECT_EQ(pool.finished(), 41u);
}

/// A delivery that is stuck holds up those behind it: they count as held.
TEST(WorkerPool, ASlowReaderBoundsWhatIsMade) {
    std::atomic<int> made{0};
    std::atomic<bool> open{false};
    WorkerPool pool({.threads = 2, .items = 3});
    std::thread giver([&] {
        for (int i = 0; i < 20; i++)
            pool.add(
                1, [&] { made++; },
                [&] {
                    while (!open) std::this_thread::sleep_for(1ms);
                });
        pool.finish();
    });
    std::this_thread::sleep_for(100ms);
    EXPECT_LE(made, 3);
    open = true;
    giver.join();
    EXPECT_EQ(made, 20);
}

TEST(WorkerPool, TheFirstErrorEndsItOnce) {
    for (const bool in_order : {false, true}) {
        WorkerPool pool({.threads = 2, .items = 8});
        std::atomic<int> begun{0};
        std::string said;
        try {
            for (int i = 0; i < 1000; i++)
                pool.add(
                    1,
                    [&, i] {
                        begun++;
                        std::this_thread::sleep_for(1ms);
                        if (i >= 5 && !in_order) throw std::runtime_error("disk " + std::to_string(i));
                    },
                    in_order ? [i] { if (i >= 5) throw std::runtime_error("pipe " + std::to_string(i)); }
                             : WorkerPool::Work());
            pool.finish();
        } catch (const std::runtime_error& error) {
            said = error.what();
        }
        EXPECT_TRUE(in_order ? said == "pipe 5" : said == "disk 5" || said == "disk 6") << said;
        EXPECT_LT(begun, 5 + 8 + 2) << "what waited was dropped";
        EXPECT_GE(pool.finished(), in_order ? 5u : 4u);
        EXPECT_LE(pool.finished(), 6u);
        EXPECT_NO_THROW(pool.finish()) << "it was said";
    }
}

TEST(WorkerPool, LeavesNothingBehindWhenItGoes) {
    const auto kept = std::make_shared<int>(0);
    std::atomic<int> ended{0};
    {
        WorkerPool pool({.threads = 1, .items = 10});
        for (int i = 0; i < 10; i++)
            pool.add(1, [&, kept] {
                std::this_thread::sleep_for(20ms);
                ended++;
            });
    }
    EXPECT_EQ(kept.use_count(), 1);
    EXPECT_LE(ended, 2) << "those that nobody had begun are dropped";
}

TEST(WorkerPool, WhoWaitsCanDoSomethingMeanwhile) {
    WorkerPool pool({.threads = 1, .items = 1});
    int looks = 0;
    pool.add(1, [] { std::this_thread::sleep_for(350ms); });
    pool.finish([&] { looks++; });
    EXPECT_GE(looks, 2);
}

TEST(Cores, ThereAreSome) {
    EXPECT_GE(usable_cores(), 1u);
    EXPECT_GT(machine_memory(), size_t(1) << 20);
}

}  // namespace
}  // namespace peelray
