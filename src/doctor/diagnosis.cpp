#include "doctor/diagnosis.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "base/error.h"
#include "base/search_path.h"
#include "base/text.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kGiB = 1ull << 30;
constexpr const char* kNvidiaLibrary = "libGLX_nvidia.so.0";

class Doctor {
  public:
    Doctor(const Surroundings& around, const VulkanState& vulkan) : around_(around), vulkan_(vulkan) {}

    std::vector<Finding> take() {
        const auto is_gpu = [](const DeviceInfo& device) { return device.kind != "CPU"; };
        const bool has_gpu = std::any_of(vulkan_.devices.begin(), vulkan_.devices.end(),
                                         [&](const DeviceInfo& d) { return is_gpu(d) && d.usable; });
        const bool sees_gpu = std::any_of(vulkan_.devices.begin(), vulkan_.devices.end(), is_gpu);
        look_for_loader();
        if (!sees_gpu) {
            look_for_gpu();
            look_for_drivers();
        }
        look_at_devices();
        if (!has_gpu) look_for_software();
        look_at_memory();
        look_at_cache();
        look_for_ffmpeg();
        return std::move(out_);
    }

  private:
    void add(const char* cause, std::string what, std::string remedy) {
        out_.push_back({cause, std::move(what), std::move(remedy)});
    }

    void look_for_loader() {
        if (!vulkan_.loader)
            add("no-loader", "Vulkan's loader, libvulkan.so.1, is not installed",
                "install it (Debian/Ubuntu: apt-get install libvulkan1)");
    }

    /// Why none of Vulkan's devices is a GPU.
    void look_for_gpu() {
        const bool nvidia = around_.has("dev/nvidiactl") || around_.has("proc/driver/nvidia/version");
        if (nvidia) look_at_nvidia();
        for (const fs::path& node : around_.files("dev/dri", "renderD")) look_at_node(node);
        if (nvidia || !around_.files("dev/dri", "renderD").empty()) return;
        for (const fs::path& device : around_.files("sys/bus/pci/devices")) {
            if (!around_.text(device / "class").starts_with("0x03")) continue;
            const std::string vendor = around_.text(device / "vendor").substr(0, 6);
            const char* maker = vendor == "0x10de"   ? "NVIDIA"
                                : vendor == "0x1002" ? "AMD"
                                : vendor == "0x8086" ? "Intel"
                                                     : nullptr;
            if (!maker) continue;
            const bool is_nvidia = vendor == "0x10de";
            add("no-device-file",
                fmt::format("there is a GPU by {} on the bus, but no file in /dev to use it by", maker),
                around_.in_container()
                    ? fmt::format("start the container with {}", is_nvidia ? "--gpus all" : "--device /dev/dri")
                    : fmt::format("install and load its driver{}", is_nvidia ? ", NVIDIA's own" : ""));
            return;
        }
    }

    void look_at_node(const fs::path& node) {
        if (around_.may_use(node)) return;
        const std::string group = around_.group_of(node);
        add("no-permission", fmt::format("/{} may not be used by this user", node.string()),
            around_.in_container() ? fmt::format("start the container with --group-add {}", group)
                                   : fmt::format("join its group (sudo usermod -aG {} $USER) and log in again", group));
    }

    bool is_split() const {
        for (const char* name : {"NVIDIA_VISIBLE_DEVICES", "CUDA_VISIBLE_DEVICES"})
            if (around_.variable_or(name, "").starts_with("MIG")) return true;
        // Of a GPU that is split, each slice has a folder.
        for (const fs::path& gpu : around_.files("proc/driver/nvidia/capabilities", "gpu"))
            if (!around_.files(gpu / "mig", "gi").empty()) return true;
        return false;
    }

    void look_at_nvidia() {
        std::vector<fs::path> nodes = around_.files("dev", "nvidia");
        std::erase_if(nodes, [](const fs::path& node) {
            const std::string rest = node.filename().string().substr(6);
            return rest != "ctl" && (rest.empty() || !std::all_of(rest.begin(), rest.end(), ::isdigit));
        });
        const auto barred =
            std::find_if(nodes.begin(), nodes.end(), [&](const fs::path& node) { return !around_.may_use(node); });
        if (barred != nodes.end()) return look_at_node(*barred);
        if (is_split())
            return add("split-gpu", "the GPU is split (MIG), and its slices have no Vulkan",
                       "ask for a whole GPU, or have it joined (sudo nvidia-smi -mig 0)");
        const std::string fault = around_.loading_fault(kNvidiaLibrary);
        if (fault.empty()) return;
        // It is there, and wants another one: the container's image has none of X's libraries.
        if (fault.find(kNvidiaLibrary) == std::string::npos)
            return add("driver-not-loadable",
                       fmt::format("NVIDIA's Vulkan driver cannot be loaded ({})", printable(fault, 160)),
                       "install what it misses (Debian/Ubuntu: apt-get install libx11-6 libxext6 libegl1)");
        const auto capabilities = around_.variable("NVIDIA_DRIVER_CAPABILITIES");
        if (capabilities || around_.in_container()) {
            const std::string given = capabilities.value_or("");
            const bool graphics = given == "all" || given.find("graphics") != std::string::npos;
            if (!graphics)
                return add(
                    "container-capability",
                    fmt::format(
                        "the container has NVIDIA's driver without its graphics part{}",
                        given.empty() ? "" : fmt::format(" (NVIDIA_DRIVER_CAPABILITIES={})", printable(given, 80))),
                    "start it with -e NVIDIA_DRIVER_CAPABILITIES=all");
        }
        // "NVRM version: NVIDIA UNIX x86_64 Kernel Module  535.129.03  ..."
        const std::string version = around_.text("proc/driver/nvidia/version");
        std::string major;
        for (size_t i = 1; i + 1 < version.size() && major.empty(); i++)
            if (std::isdigit(version[i]) && std::isspace(version[i - 1])) {
                const size_t dot = version.find_first_not_of("0123456789", i);
                if (dot != std::string::npos && version[dot] == '.') major = version.substr(i, dot - i);
            }
        add("no-vulkan-library", "NVIDIA's driver is loaded, but its Vulkan part, libGLX_nvidia.so.0, is not installed",
            fmt::format("install it, of the same version (Ubuntu: apt-get install libnvidia-gl-{})",
                        major.empty() ? "NNN" : major));
    }

    void look_for_drivers() {
        // What keeps a GPU from being used may have been said.
        const bool explained =
            !out_.empty() && out_.back().cause != "no-loader" && out_.back().cause != "no-device-file";
        const std::vector<DriverFile> drivers = driver_files(around_);
        for (const DriverFile& driver : drivers)
            // Those for programs of 32 bits are not for us; NVIDIA's has been looked at.
            if (!driver.fault.empty() && driver.fault.find("wrong ELF class") == std::string::npos &&
                driver.library.find(kNvidiaLibrary) == std::string::npos)
                add("driver-not-loadable",
                    fmt::format("the driver of {} cannot be loaded ({})", driver.file.string(),
                                printable(driver.fault, 160)),
                    "install the package again that it comes from, or remove the file");
        if (explained || !vulkan_.devices.empty()) return;
        if (drivers.empty()) return add_no_driver_file();
        if (out_.empty())
            add("no-device", "Vulkan's drivers find no device that they could drive",
                "VK_LOADER_DEBUG=all peelray devices shows what they look for");
    }

    void add_no_driver_file() {
        const std::string named = around_.variable_or("VK_DRIVER_FILES", around_.variable_or("VK_ICD_FILENAMES", ""));
        const bool is_nvidia = around_.has("dev/nvidiactl") && around_.loading_fault(kNvidiaLibrary).empty();
        add("no-driver-file",
            named.empty()
                ? std::string("no file in /usr/share/vulkan/icd.d or /etc/vulkan/icd.d tells Vulkan of a driver")
                : fmt::format("VK_DRIVER_FILES or VK_ICD_FILENAMES leads to no driver's file ({})",
                              printable(named, 120)),
            !named.empty() ? "unset it, or name a file that is there"
            : is_nvidia    ? "NVIDIA's driver itself is there: write {\"file_format_version\": \"1.0.0\", \"ICD\": "
                             "{\"library_path\": \"libGLX_nvidia.so.0\", \"api_version\": \"1.3.0\"}} into "
                             "/etc/vulkan/icd.d/nvidia_icd.json"
                        : "install the GPU's driver (Debian/Ubuntu: apt-get install mesa-vulkan-drivers has those of "
                          "AMD, Intel and any CPU)");
    }

    void look_at_devices() {
        for (const DeviceInfo& device : vulkan_.devices) {
            if (device.usable) continue;
            if (device.lacking == "Vulkan 1.3")
                add("old-vulkan", fmt::format("'{}' has Vulkan {}, not 1.3", device.name, device.api_version),
                    "update its driver, or choose another --device");
            else
                add("missing-feature", fmt::format("'{}' lacks {}", device.name, device.lacking),
                    "update its driver, or choose another --device");
        }
    }

    void look_for_software() {
        const auto usable =
            std::find_if(vulkan_.devices.begin(), vulkan_.devices.end(), [](const DeviceInfo& d) { return d.usable; });
        if (usable == vulkan_.devices.end()) return;
        add("software-only", fmt::format("no Vulkan device but software on the CPU, '{}'", usable->name),
            "--tracer cpu, which is chosen by itself, is faster there; a GPU needs its driver");
    }

    void look_at_memory() {
        for (const DeviceInfo& device : vulkan_.devices)
            if (device.usable && device.kind != "CPU" && device.memory < kGiB)
                add("little-memory", fmt::format("'{}' has {} MiB of memory", device.name, device.memory >> 20),
                    "keep to small scenes and pictures (--ldc 256, --size, --memory-limit)");
        const std::string info = around_.text("proc/meminfo");
        const size_t at = info.find("MemAvailable:");
        if (at == std::string::npos) return;
        const uint64_t bytes = std::strtoull(info.c_str() + at + 13, nullptr, 10) << 10;
        if (bytes < kGiB)
            add("little-memory", fmt::format("the machine has {} MiB of memory left", bytes >> 20),
                "end other programs, or keep to small scenes and pictures");
    }

    void look_at_cache() {
        const fs::path folder =
            cache_folder(around_.variable_or("XDG_CACHE_HOME", ""), around_.variable_or("HOME", ""));
        const char* loss = "shaders are compiled anew in every run";
        if (folder.empty())
            return add("cache", fmt::format("neither HOME nor XDG_CACHE_HOME is set, and {}", loss),
                       "set XDG_CACHE_HOME to a folder");
        const fs::path file = folder / fmt::format("doctor.{}.tmp", ::getpid());
        std::error_code error;
        fs::create_directories(folder, error);
        std::ofstream stream(file);
        stream << "x";
        stream.close();
        if (!stream)
            add("cache", fmt::format("nothing can be written in {}, and {}", folder.string(), loss),
                "make it writable, or set XDG_CACHE_HOME to a folder that is");
        fs::remove(file, error);
    }

    void look_for_ffmpeg() {
        if (!find_program(around_.variable_or("PATH", ""), "ffmpeg"))
            add("no-ffmpeg", "there is no ffmpeg on the PATH, which encodes videos",
                "install it (Debian/Ubuntu: apt-get install ffmpeg), or write pictures");
    }

    const Surroundings& around_;
    const VulkanState& vulkan_;
    std::vector<Finding> out_;
};

}  // namespace

VulkanState vulkan_state() {
    VulkanState out;
    out.loader = has_vulkan_loader();
    try {
        out.devices = list_devices();
    } catch (const Error&) {
        // Why there are none is what find_causes() looks for.
    }
    return out;
}

std::vector<Finding> find_causes(const Surroundings& around, const VulkanState& vulkan) {
    return Doctor(around, vulkan).take();
}

}  // namespace peelray
