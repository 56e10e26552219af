// Recording and running work: the one place where barriers, debug labels and timestamps come from.
#pragma once

#include <chrono>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "gpu/acceleration_structure.h"
#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/pass.h"
#include "gpu/ray_pass.h"

namespace peelray {

/// A buffer, image or acceleration structure given to the binding of that name in a shader.
struct Binding {
    std::string_view name;
    const Buffer* buffer = nullptr;
    const Image2D* image = nullptr;
    const AccelerationStructure* structure = nullptr;
    bool optional = false;

    Binding(std::string_view n, const Buffer& b) : name(n), buffer(&b) {}
    Binding(std::string_view n, const Image2D& i) : name(n), image(&i) {}
    Binding(std::string_view n, const AccelerationStructure& s) : name(n), structure(&s) {}
    /// What some variants of a shader do without. Where the shader declares it and there is no buffer (null or empty),
    /// it is bound to the device's dummy, which the variant must not touch; a shader that does not declare it is not
    /// given it.
    static Binding if_used(std::string_view name, const Buffer* buffer) { return Binding(name, buffer); }
    static Binding if_used(std::string_view name, const Buffer& buffer) { return Binding(name, &buffer); }
    static Binding if_used(std::string_view name, const Image2D& image);

  private:
    Binding(std::string_view n, const Buffer* b) : name(n), buffer(b && *b ? b : nullptr), optional(true) {}
};

/// The same of all of them: for what several shaders read a part of each.
std::vector<Binding> if_used(std::span<const Binding> bindings);

/// How often a compute pass runs, in workgroups.
struct Groups {
    uint32_t x = 1, y = 1, z = 1;
};
/// Workgroups for `items` of them, `per_group` each, in rows as shaders/common/common.glsl counts them (GLOBAL_INDEX).
inline Groups groups_for(uint64_t items, uint32_t per_group) {
    const uint64_t groups = (items + per_group - 1) / per_group, row = 32768;
    return {uint32_t(groups < row ? groups : row), uint32_t((groups + row - 1) / row)};
}

/// Triangles of an instanced draw: the shader's gl_VertexIndex counts from first_triangle · 3, gl_InstanceIndex from
/// first_instance.
struct DrawRange {
    uint32_t first_triangle, triangles, first_instance, instances;
};

/// Draws whose numbers are read on the GPU: VkDrawIndirectCommand each, from byte `offset` on.
struct IndirectDraws {
    const Buffer& arguments;
    uint64_t offset = 0;
    uint32_t draws = 1;
};

/// What a rasterising pass draws into: cleared first, colours of integers to ~0u, others to 0, depth to the farthest.
struct DrawTargets {
    std::vector<const Image2D*> colors;  ///< in the formats of the pass
    const Image2D* depth = nullptr;
    uint32_t width = 0, height = 0;  ///< the part drawn into, from the first pixel on
    uint32_t viewport = 0;           ///< pixels along a side of what clip space covers; 0: width and height
    uint32_t layers = 1;             ///< gl_Layer says which
    bool apart = false;              ///< draw k goes into layer k, seen alone
};

/// GPU time of one pass of a submission.
struct PassTime {
    std::string name;  ///< "group/pass" inside a group
    double ms;
};

/// A recording of passes and copies for one submission. Barriers are derived: a pass waits for earlier ones exactly
/// when it touches what they wrote, or writes what they read (reflection knows readonly from writable bindings).
class Commands {
  public:
    explicit Commands(Device& device);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// Runs a compute pass. Every binding of the shader must be given once, by its name; `params` must have the size of
    /// its push-constant block (both are asserted).
    template <typename Params>
    void run(const Pass& pass, std::initializer_list<Binding> bindings, const Params& params, Groups groups) {
        record(pass, {bindings.begin(), bindings.size()}, &params, sizeof params, groups, nullptr, 0);
    }
    template <typename Params>
    void run(const Pass& pass, std::span<const Binding> bindings, const Params& params, Groups groups) {
        record(pass, bindings, &params, sizeof params, groups, nullptr, 0);
    }
    /// The same with the workgroup counts read on the GPU: three uint32 in `arguments` at byte `offset`.
    template <typename Params>
    void run_indirect(const Pass& pass, std::initializer_list<Binding> bindings, const Params& params,
                      const Buffer& arguments, uint64_t offset = 0) {
        record(pass, {bindings.begin(), bindings.size()}, &params, sizeof params, {}, &arguments, offset);
    }
    template <typename Params>
    void run_indirect(const Pass& pass, std::span<const Binding> bindings, const Params& params,
                      const Buffer& arguments, uint64_t offset = 0) {
        record(pass, bindings, &params, sizeof params, {}, &arguments, offset);
    }
    /// Draws `ranges` into `color` (R32G32_UINT, cleared to ~0u) with `depth` (D32, cleared to 0), then copies the
    /// colour to `target` (width·height pairs of uint32).
    template <typename Params>
    void draw(const RasterPass& pass, std::span<const Binding> bindings, const Params& params,
              std::span<const DrawRange> ranges, const Image2D& color, const Image2D& depth, const Buffer& target) {
        record_draw(pass, bindings, &params, sizeof params, ranges, nullptr,
                    {{&color}, &depth, color.width(), color.height()}, &target);
    }
    /// Draws `ranges` into any targets.
    template <typename Params>
    void draw(const RasterPass& pass, std::span<const Binding> bindings, const Params& params,
              std::span<const DrawRange> ranges, const DrawTargets& targets) {
        record_draw(pass, bindings, &params, sizeof params, ranges, nullptr, targets, nullptr);
    }
    template <typename Params>
    void draw_indirect(const RasterPass& pass, std::span<const Binding> bindings, const Params& params,
                       const IndirectDraws& draws, const DrawTargets& targets) {
        record_draw(pass, bindings, &params, sizeof params, {}, &draws, targets, nullptr);
    }

    /// Runs a ray tracing pass: its ray generation shader `rays` times, in a row.
    template <typename Params>
    void trace(const RayPass& pass, std::span<const Binding> bindings, const Params& params, uint32_t rays) {
        record_rays(pass, bindings, &params, sizeof params, rays, nullptr, 0);
    }
    /// The same with the number read on the GPU: VkTraceRaysIndirectCommandKHR in `arguments` at byte `offset`. Needs
    /// DeviceFeatures::indirect_rays.
    template <typename Params>
    void trace_indirect(const RayPass& pass, std::span<const Binding> bindings, const Params& params,
                        const Buffer& arguments, uint64_t offset) {
        record_rays(pass, bindings, &params, sizeof params, 0, &arguments, offset);
    }

    /// Builds acceleration structures, all at once: none may read what another writes.
    void build(const std::string& name, std::span<const StructureBuild> builds, const Buffer& scratch);
    /// What finished structures need at least, in bytes. Submits. They were built with
    /// VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR.
    std::vector<uint64_t> compacted_bytes(std::span<const AccelerationStructure> structures);
    /// Copies each of `from` into as little memory as it needs.
    void compact(const std::string& name, std::span<const AccelerationStructure> from,
                 std::span<const AccelerationStructure> to);

    /// Fills `bytes` from `offset` (multiples of 4; ~0ull: to the end) with `value`.
    void fill(const Buffer& buffer, uint32_t value, uint64_t offset = 0, uint64_t bytes = ~0ull);
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset = 0, uint64_t to_offset = 0);

    /// Passes between begin and end are timed under "name/" and labelled as one group.
    void begin_group(const std::string& name);
    void end_group();

    /// Times each pass, as it is at first, or only groups (as "group/all") and whole submissions ("all passes"): the
    /// passes then need not wait for timestamps. To be called while nothing is recorded.
    void time_passes(bool on) { time_passes_ = on; }

    /// Submits and waits. The recording is then empty again and can be filled anew.
    void submit();

    /// GPU times of the last submission in order of recording; empty where the device has no timestamps.
    const std::vector<PassTime>& times() const { return times_; }

    /// From the first pass's start to the last one's end of the last submission, in GPU milliseconds; 0 without
    /// timestamps.
    double elapsed_ms() const { return elapsed_ms_; }

    /// Uploads through staging memory; submits at once.
    template <typename T>
    void upload(const Buffer& buffer, std::span<const T> data, uint64_t offset = 0) {
        upload_bytes(buffer, std::as_bytes(data), offset);
    }
    /// The same of texels of four bytes, row by row from `first_row` on, counted through all layers.
    void upload(const Image2D& image, std::span<const uint32_t> texels, uint64_t first_row);
    /// Downloads `count` elements from byte `offset`; submits at once.
    template <typename T>
    std::vector<T> download(const Buffer& buffer, uint64_t count, uint64_t offset = 0) {
        std::vector<T> result(count);
        download_into(buffer, result, offset);
        return result;
    }
    /// As many as there is room for in `out`.
    template <typename T>
    void download_into(const Buffer& buffer, std::vector<T>& out, uint64_t offset = 0) {
        download_bytes(buffer, std::as_writable_bytes(std::span(out)), offset);
    }

  private:
    static constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    struct Access {
        bool written = false, read = false;
    };
    void begin();
    /// Buffers and images alike are known by their handles.
    void touch(uint64_t handle, bool reads, bool writes, bool& hazard);
    void touch(const Buffer& buffer, bool reads, bool writes, bool& hazard) {
        touch(uint64_t(buffer.handle()), reads, writes, hazard);
    }
    /// `fresh`: what the image holds may be lost.
    void touch(const Image2D& image, bool writes, bool fresh, VkImageLayout layout, bool& hazard);
    /// For the tracing of rays.
    void touch(const AccelerationStructure& structure, bool& hazard);
    Access& access(const Buffer& buffer) { return accesses_[uint64_t(buffer.handle())]; }
    Access& access(const Image2D& image) { return accesses_[uint64_t(image.handle())]; }
    /// Before a command of these stages: a barrier if there is a hazard, or if such stages have not been in any
    /// barrier.
    void barrier_if(bool hazard, VkPipelineStageFlags2 stages);
    void barrier();
    /// What is given to each binding of the pass, in their order. Throws Error if one is missing or one too many.
    static std::vector<const Binding*> match(const PassBase& pass, std::span<const Binding> bindings);
    const Image2D& image_of(const Binding& binding) const;
    VkDescriptorSet bind(const PassBase& pass, std::span<const Binding* const> given);
    /// Looks for hazards, before the pass's barrier, or notes what the pass does, after it.
    void touch(const PassBase& pass, std::span<const Binding* const> given, bool& hazard);
    void mark(const PassBase& pass, std::span<const Binding* const> given);
    static void check_params(const PassBase& pass, size_t bytes);
    /// Before a pass without targets: its set, the barrier it needs, and what it does to its bindings and to the buffer
    /// of its indirect command, if any.
    VkDescriptorSet prepare(const PassBase& pass, std::span<const Binding> bindings, const Buffer* arguments,
                            VkPipelineStageFlags2 stages);
    /// Opens the label and the timer of a pass and binds all that its command needs. To be closed by finish().
    void start(const PassBase& pass, VkPipelineBindPoint point, VkDescriptorSet set, const void* params, size_t bytes);
    void finish();
    void record(const Pass& pass, std::span<const Binding> bindings, const void* params, size_t bytes, Groups groups,
                const Buffer* arguments, uint64_t offset);
    void record_draw(const RasterPass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                     std::span<const DrawRange> ranges, const IndirectDraws* indirect, const DrawTargets& targets,
                     const Buffer* copied);
    void record_rays(const RayPass& pass, std::span<const Binding> bindings, const void* params, size_t bytes,
                     uint32_t rays, const Buffer* arguments, uint64_t offset);
    void begin_rendering(const RasterPass& pass, const DrawTargets& targets, uint32_t layer);
    void begin_timer(const std::string& name);
    void end_timer();
    size_t start_timer(const std::string& name);
    void stop_timer(size_t index);
    void label(const std::string& name);
    void end_label();
    void flush();
    void read_times();
    void upload_bytes(const Buffer& buffer, std::span<const std::byte> data, uint64_t offset);
    void download_bytes(const Buffer& buffer, std::span<std::byte> data, uint64_t offset);
    VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);

    Device& device_;
    VkPipelineStageFlags2 work_;  ///< all stages that do any
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    bool recording_ = false;
    VkPipelineStageFlags2 stages_ = 0;  ///< of what is recorded so far
    std::vector<VkDescriptorPool> set_pools_;
    size_t set_pool_ = 0;
    std::vector<VkQueryPool> query_pools_;
    std::vector<std::string> timed_;
    std::vector<PassTime> times_, host_times_;
    double elapsed_ms_ = 0;
    bool time_passes_ = true;
    size_t whole_timer_ = 0, group_timer_ = 0;
    std::optional<std::chrono::steady_clock::time_point> whole_start_;  ///< on the host, where passes are timed there
    std::chrono::steady_clock::time_point group_start_;
    std::string group_;
    std::unordered_map<uint64_t, Access> accesses_;
    std::vector<VkImageMemoryBarrier2> transitions_;  ///< of the next barrier
    Buffer staging_up_, staging_down_;
};

/// Makes `buffer`, if it holds more, hold just `bytes`, which stay. Submits then.
void shrink(Device& device, Commands& commands, Buffer& buffer, uint64_t bytes);

/// Makes `buffer` hold at least `bytes`; its first `kept` bytes stay. Submits if there is something to keep.
void grow(Device& device, Commands& commands, Buffer& buffer, const std::string& name, uint64_t bytes, uint64_t kept);

}  // namespace peelray
