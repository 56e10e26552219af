// `peelray doctor`.
#include <algorithm>

#include "base/text.h"
#include "cli/commands.h"
#include "cli/messages.h"
#include "cli/stats_json.h"
#include "doctor/checked_frame.h"
#include "doctor/diagnosis.h"

namespace peelray {
namespace {

using Json = nlohmann::ordered_json;

/// A tracer on this machine.
struct Trial {
    Tracer tracer;
    CheckedFrame frame;
};

/// The best of the devices by one tracer.
Trial try_devices(Tracer tracer, const VulkanState& vulkan, const std::optional<Image8>& expected) {
    Trial best{tracer, {}};
    best.frame.cause = "no Vulkan device can be used";
    bool tried = false;
    for (const DeviceInfo& device : vulkan.devices) {
        if (!device.usable) continue;
        CheckedFrame frame = check_frame(tracer, std::to_string(device.index), expected);
        // The devices are sorted, the fastest kind first.
        if (!tried || frame.passed) best.frame = frame;
        tried = true;
        if (frame.passed) break;
    }
    return best;
}

std::string describe(const Trial& trial) {
    const CheckedFrame& frame = trial.frame;
    if (!frame.passed) return fmt::format("does not work: {}", one_line(frame.cause));
    return fmt::format("works: a checked frame of {}x{} in {:.2f} ms, the first one in {:.2f} s, by {}", kCheckedSize.x,
                       kCheckedSize.y, frame.frame_ms, frame.first_seconds, one_line(frame.renderer));
}

void print(const VulkanState& vulkan, const std::vector<Trial>& trials, const std::vector<Finding>& findings) {
    for (const DeviceInfo& device : vulkan.devices)
        fmt::print("device {}  {}, {}, Vulkan {}, driver {}, {:.1f} GiB\n", device.index, one_line(device.name),
                   device.kind, device.api_version, one_line(device.driver), double(device.memory) / (1ull << 30));
    if (vulkan.devices.empty()) fmt::print("device    none by Vulkan\n");
    for (const Trial& trial : trials) fmt::print("{:<9} {}\n", name_of(trial.tracer), describe(trial));
    for (const Finding& finding : findings) fmt::print("{}: {}\n", finding.cause, one_line(finding.line()));
    if (findings.empty()) fmt::print("Nothing is amiss.\n");
}

void print_json(const VulkanState& vulkan, const std::vector<Trial>& trials, const std::vector<Finding>& findings,
                int status) {
    Json json = {{"status", status}};
    for (const Trial& trial : trials) json[name_of(trial.tracer)] = trial.frame.passed;
    for (const Trial& trial : trials) {
        const CheckedFrame& frame = trial.frame;
        json["causes"][name_of(trial.tracer)] = frame.passed ? Json(nullptr) : Json(frame.cause);
        json["frames"][name_of(trial.tracer)] = !frame.passed ? Json(nullptr)
                                                              : Json{{"renderer", frame.renderer},
                                                                     {"frame_ms", frame.frame_ms},
                                                                     {"first_seconds", frame.first_seconds},
                                                                     {"share_different", frame.different}};
    }
    json["devices"] = Json::array();
    for (const DeviceInfo& device : vulkan.devices)
        json["devices"].push_back({{"index", device.index},
                                   {"name", device.name},
                                   {"kind", device.kind},
                                   {"api_version", device.api_version},
                                   {"driver", device.driver},
                                   {"memory_bytes", device.memory},
                                   {"lacks", device.usable ? Json(nullptr) : Json(device.lacking)}});
    json["findings"] = Json::array();
    for (const Finding& finding : findings)
        json["findings"].push_back({{"cause", finding.cause}, {"what", finding.what}, {"remedy", finding.remedy}});
    fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

int run_doctor(bool as_json) {
    const VulkanState vulkan = vulkan_state();
    std::string no_reference;
    const std::optional<Image8> expected = reference_frame(no_reference);
    std::vector<Trial> trials{try_devices(Tracer::ldc, vulkan, expected),
                              try_devices(Tracer::khr, vulkan, expected),
                              {Tracer::cpu, check_frame(Tracer::cpu, "", expected)}};
    std::vector<Finding> findings = find_causes(Surroundings::real(), vulkan);
    // The first cause that keeps GPUs away tells more than that there is none.
    if (vulkan.devices.empty() && !findings.empty())
        for (Trial& trial : trials)
            if (!is_on_cpu(trial.tracer)) trial.frame.cause = findings.front().what;
    const int status = trials[0].frame.passed || trials[1].frame.passed ? 0 : 1;
    if (as_json)
        print_json(vulkan, trials, findings, status);
    else
        print(vulkan, trials, findings);
    return status;
}

}  // namespace peelray
