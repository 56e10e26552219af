// Machines staged in a folder: each with one failure, which must be named, and nothing else.
#include "doctor/diagnosis.h"

#include <map>
#include <set>

#include "image/temp_folder.h"

namespace peelray {
namespace {

namespace fs = std::filesystem;

class DiagnosisTest : public TempFolder {
  protected:
    void SetUp() override {
        TempFolder::SetUp();
        // A machine that has everything.
        around.root = folder;
        around.variable = [this](const char* name) -> std::optional<std::string> {
            const auto found = variables.find(name);
            return found == variables.end() ? std::nullopt : std::optional(found->second);
        };
        around.user = 4711;
        around.groups = {4711};
        around.loading_fault = [this](const std::string& library) {
            return libraries.contains(fs::path(library).filename()) ? "" : library + ": cannot open shared object file";
        };
        variables = {{"HOME", folder / "home/me"}, {"PATH", "/nowhere:" + (folder / "bin").string()}};
        libraries = {"libvulkan_radeon.so"};
        stage("bin/ffmpeg", "#!/bin/sh\n", 0755);
        stage("proc/meminfo", "MemTotal:       65000000 kB\nMemFree:        100 kB\nMemAvailable:   60000000 kB\n");
        stage(
            "usr/share/vulkan/icd.d/radeon_icd.json",
            R"({"ICD": {"api_version": "1.3.230", "library_path": "libvulkan_radeon.so"}, "file_format_version": "1"})");
        stage("dev/dri/renderD128", "", 0666);
        stage("dev/dri/card0", "", 0600);
        vulkan.loader = true;
        vulkan.devices = {gpu()};
    }

    void stage(const std::string& name, const std::string& text, unsigned mode = 0644) {
        fs::create_directories((folder / name).parent_path());
        put(name, text);
        fs::permissions(folder / name, fs::perms(mode));
    }
    /// NVIDIA's driver in the kernel, and its devices.
    void stage_nvidia() {
        fs::remove_all(folder / "dev/dri");
        for (const char* name : {"nvidia0", "nvidiactl", "nvidia-uvm"}) stage(std::string("dev/") + name, "", 0666);
        stage("proc/driver/nvidia/version",
              "NVRM version: NVIDIA UNIX x86_64 Kernel Module  535.129.03  Thu Oct 19 18:56:32 UTC 2023\n"
              "GCC version:  gcc version 12.3.0 (Ubuntu 12.3.0-1ubuntu1)\n");
    }

    static DeviceInfo gpu() {
        return {0, "AMD Radeon Graphics (RADV RENOIR)", "integrated", "radv Mesa 23.1", "1.3.246", 4ull << 30, true,
                ""};
    }
    static DeviceInfo software() {
        return {0, "llvmpipe (LLVM 15.0.6, 256 bits)", "CPU", "llvmpipe Mesa 22.3.6", "1.3.230", 2ull << 30, true, ""};
    }

    std::vector<Finding> find() const { return find_causes(around, vulkan); }
    /// The causes' names, in order, with blanks between them.
    std::string causes() const {
        std::string names;
        for (const Finding& finding : find()) {
            EXPECT_FALSE(finding.what.empty());
            EXPECT_FALSE(finding.remedy.empty());
            EXPECT_EQ(finding.line().find('\n'), std::string::npos);
            names += (names.empty() ? "" : " ") + finding.cause;
        }
        return names;
    }
    /// The first line must say all of these.
    void expect_says(const std::vector<std::string>& parts) const {
        const std::vector<Finding> findings = find();
        ASSERT_FALSE(findings.empty());
        for (const std::string& part : parts)
            EXPECT_NE(findings[0].line().find(part), std::string::npos) << part << " in: " << findings[0].line();
    }

    Surroundings around;
    VulkanState vulkan;
    std::map<std::string, std::string> variables;
    std::set<std::string> libraries;  ///< that can be loaded
};

TEST_F(DiagnosisTest, NothingIsAmiss) {
    EXPECT_EQ(causes(), "");
    EXPECT_TRUE(fs::is_empty(folder / "home/me/.cache/peelray")) << "it leaves nothing behind";
}

TEST_F(DiagnosisTest, NoLoader) {
    vulkan = {};
    EXPECT_EQ(causes(), "no-loader");
    expect_says({"libvulkan.so.1", "apt-get install libvulkan1"});
}

TEST_F(DiagnosisTest, NoDriverFile) {
    vulkan.devices.clear();
    fs::remove_all(folder / "usr/share/vulkan");
    EXPECT_EQ(causes(), "no-driver-file");
    expect_says({"/etc/vulkan/icd.d", "apt-get install mesa-vulkan-drivers"});
    // Any of the usual folders will do.
    for (const char* place : {"etc/vulkan/icd.d/a.json", "usr/local/share/vulkan/icd.d/a.json",
                              "home/me/.local/share/vulkan/icd.d/a.json", "home/me/.config/vulkan/icd.d/a.json"}) {
        stage(place, R"({"ICD": {"library_path": "libvulkan_radeon.so"}})");
        EXPECT_EQ(driver_files(around).size(), 1u) << place;
        fs::remove(folder / place);
    }
}

TEST_F(DiagnosisTest, VariablesThatLeadToNoDriverFile) {
    vulkan.devices.clear();
    fs::create_directories(folder / "none");
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
        variables[name] = folder / "none";
        EXPECT_EQ(causes(), "no-driver-file") << name;
        expect_says({(folder / "none").string(), "unset it"});
        variables.erase(name);
    }
    variables["VK_DRIVER_FILES"] =
        (folder / "none").string() + ":" + (folder / "usr/share/vulkan/icd.d/radeon_icd.json").string();
    EXPECT_EQ(driver_files(around).size(), 1u);
}

TEST_F(DiagnosisTest, ADriverThatCannotBeLoaded) {
    vulkan.devices.clear();
    libraries.clear();
    EXPECT_EQ(causes(), "driver-not-loadable");
    expect_says({"radeon_icd.json", "libvulkan_radeon.so: cannot open", "install the package again"});
    // A path is meant from the file's folder.
    stage("usr/share/vulkan/icd.d/radeon_icd.json", R"({"ICD": {"library_path": "../libs/libdriver.so"}})");
    expect_says({"icd.d/../libs/libdriver.so"});
    stage("usr/share/vulkan/icd.d/radeon_icd.json", R"({"ICD": {)");
    expect_says({"names no library"});
    // That of programs of 32 bits is none of ours, and nothing matters where a GPU works.
    around.loading_fault = [](const std::string&) { return "libvulkan_radeon.so: wrong ELF class: ELFCLASS32"; };
    stage("usr/share/vulkan/icd.d/radeon_icd.json", R"({"ICD": {"library_path": "libvulkan_radeon.so"}})");
    EXPECT_EQ(causes(), "no-device");
    vulkan.devices = {gpu()};
    EXPECT_EQ(causes(), "");
}

TEST_F(DiagnosisTest, AContainerWithoutTheDriversGraphics) {
    stage_nvidia();
    fs::remove_all(folder / "usr/share/vulkan");
    vulkan.devices.clear();
    variables["NVIDIA_DRIVER_CAPABILITIES"] = "compute,utility";
    EXPECT_EQ(causes(), "container-capability");
    expect_says({"NVIDIA_DRIVER_CAPABILITIES=compute,utility", "-e NVIDIA_DRIVER_CAPABILITIES=all"});
    // Without the variable a container gets no graphics either.
    variables.erase("NVIDIA_DRIVER_CAPABILITIES");
    stage(".dockerenv", "");
    EXPECT_EQ(causes(), "container-capability");
    // A software driver in the image is no GPU.
    vulkan.devices = {software()};
    EXPECT_EQ(causes(), "container-capability software-only");
    // With them, it is there.
    variables["NVIDIA_DRIVER_CAPABILITIES"] = "all";
    libraries.insert("libGLX_nvidia.so.0");
    vulkan.devices = {{0, "NVIDIA H200", "discrete", "NVIDIA 535.129.03", "1.3.242", 141ull << 30, true, ""}};
    EXPECT_EQ(causes(), "");
}

TEST_F(DiagnosisTest, NvidiasDriverWithoutItsVulkan) {
    stage_nvidia();
    fs::remove_all(folder / "usr/share/vulkan");
    vulkan.devices.clear();
    EXPECT_EQ(causes(), "no-vulkan-library");
    expect_says({"libGLX_nvidia.so.0", "apt-get install libnvidia-gl-535"});
    // In a container that has been given everything the host may lack it.
    stage(".dockerenv", "");
    variables["NVIDIA_DRIVER_CAPABILITIES"] = "compute,graphics,utility";
    EXPECT_EQ(causes(), "no-vulkan-library");
}

TEST_F(DiagnosisTest, NvidiasDriverWithoutItsFileOrWithoutXsLibraries) {
    stage_nvidia();
    vulkan.devices.clear();
    fs::remove_all(folder / "usr/share/vulkan");
    libraries.insert("libGLX_nvidia.so.0");
    EXPECT_EQ(causes(), "no-driver-file");
    expect_says({"/etc/vulkan/icd.d/nvidia_icd.json", "libGLX_nvidia.so.0"});
    stage("usr/share/vulkan/icd.d/nvidia_icd.json", R"({"ICD": {"library_path": "libGLX_nvidia.so.0"}})");
    around.loading_fault = [](const std::string&) {
        return "libXext.so.6: cannot open shared object file: No such file or directory";
    };
    EXPECT_EQ(causes(), "driver-not-loadable");
    expect_says({"libXext.so.6", "apt-get install"});
}

TEST_F(DiagnosisTest, ASplitGpu) {
    stage_nvidia();
    vulkan.devices.clear();
    libraries.insert("libGLX_nvidia.so.0");
    stage("usr/share/vulkan/icd.d/nvidia_icd.json", R"({"ICD": {"library_path": "libGLX_nvidia.so.0"}})");
    variables["NVIDIA_VISIBLE_DEVICES"] = "MIG-7f3b6a52-1c0d-5b0e-9d2e-0c1f5f0a7d11";
    EXPECT_EQ(causes(), "split-gpu");
    expect_says({"MIG", "whole GPU", "nvidia-smi -mig 0"});
    variables.erase("NVIDIA_VISIBLE_DEVICES");
    fs::create_directories(folder / "proc/driver/nvidia/capabilities/gpu0/mig");
    EXPECT_EQ(causes(), "no-device") << "it can be split, but is not";
    expect_says({"VK_LOADER_DEBUG=all"});
    stage("proc/driver/nvidia/capabilities/gpu0/mig/gi7/access", "");
    EXPECT_EQ(causes(), "split-gpu");
}

TEST_F(DiagnosisTest, NoPermissionOnTheRenderNode) {
    vulkan.devices = {software()};
    fs::permissions(folder / "dev/dri/renderD128", fs::perms(0660));
    EXPECT_EQ(causes(), "no-permission software-only");
    expect_says({"/dev/dri/renderD128", "usermod -aG"});
    stage("run/.containerenv", "");
    expect_says({"--group-add"});
    fs::permissions(folder / "dev/dri/renderD128", fs::perms(0664));
    EXPECT_EQ(causes(), "no-permission software-only") << "reading is not enough";
    around.groups.push_back(::getgid());
    EXPECT_EQ(causes(), "software-only") << "of its group";
    around.groups.pop_back();
    around.user = 0;
    EXPECT_EQ(causes(), "software-only") << "root may everything";
    stage_nvidia();
    around.user = 4711;
    fs::permissions(folder / "dev/nvidiactl", fs::perms(0600));
    EXPECT_EQ(causes(), "no-permission software-only");
    expect_says({"/dev/nvidiactl"});
}

TEST_F(DiagnosisTest, AGpuWithoutADevicesFile) {
    vulkan.devices = {software()};
    fs::remove_all(folder / "dev/dri");
    stage("sys/bus/pci/devices/0000:00:1f.2/class", "0x010601\n");
    stage("sys/bus/pci/devices/0000:00:1f.2/vendor", "0x8086\n");
    EXPECT_EQ(causes(), "software-only");
    stage("sys/bus/pci/devices/0000:65:00.0/class", "0x030200\n");
    stage("sys/bus/pci/devices/0000:65:00.0/vendor", "0x10de\n");
    EXPECT_EQ(causes(), "no-device-file software-only");
    expect_says({"a GPU by NVIDIA", "install and load its driver"});
    variables["KUBERNETES_SERVICE_HOST"] = "10.0.0.1";
    expect_says({"--gpus all"});
    stage("sys/bus/pci/devices/0000:65:00.0/vendor", "0x1002\n");
    expect_says({"a GPU by AMD", "--device /dev/dri"});
}

TEST_F(DiagnosisTest, AnOldVulkanAndAMissingFeature) {
    vulkan.devices[0].usable = false;
    vulkan.devices[0].lacking = "Vulkan 1.3";
    vulkan.devices[0].api_version = "1.2.131";
    EXPECT_EQ(causes(), "old-vulkan");
    expect_says({"RADV RENOIR", "1.2.131, not 1.3", "update its driver"});
    vulkan.devices[0].lacking = "scalarBlockLayout";
    EXPECT_EQ(causes(), "missing-feature");
    expect_says({"RADV RENOIR", "lacks scalarBlockLayout", "update its driver"});
}

TEST_F(DiagnosisTest, SoftwareOnly) {
    fs::remove_all(folder / "dev/dri");
    vulkan.devices = {software()};
    EXPECT_EQ(causes(), "software-only");
    expect_says({"llvmpipe", "--tracer cpu"});
    vulkan.devices = {gpu(), software()};
    EXPECT_EQ(causes(), "");
}

TEST_F(DiagnosisTest, LittleMemory) {
    vulkan.devices[0].memory = 512ull << 20;
    EXPECT_EQ(causes(), "little-memory");
    expect_says({"RADV RENOIR", "512 MiB", "--ldc"});
    vulkan.devices = {gpu()};
    stage("proc/meminfo", "MemTotal:       2000000 kB\nMemAvailable:    614400 kB\n");
    EXPECT_EQ(causes(), "little-memory");
    expect_says({"the machine has 600 MiB"});
}

TEST_F(DiagnosisTest, ACacheThatCannotBeWritten) {
    put("file", "");
    variables["XDG_CACHE_HOME"] = folder / "file";
    EXPECT_EQ(causes(), "cache");
    expect_says({(folder / "file").string(), "compiled anew", "XDG_CACHE_HOME"});
    variables.erase("XDG_CACHE_HOME");
    variables.erase("HOME");
    EXPECT_EQ(causes(), "cache");
    expect_says({"neither HOME nor XDG_CACHE_HOME"});
    variables["XDG_CACHE_HOME"] = folder / "new/cache";
    EXPECT_EQ(causes(), "");
}

TEST_F(DiagnosisTest, NoFfmpeg) {
    fs::permissions(folder / "bin/ffmpeg", fs::perms(0644));
    EXPECT_EQ(causes(), "no-ffmpeg") << "it cannot be executed";
    variables["PATH"] = "";
    EXPECT_EQ(causes(), "no-ffmpeg");
    expect_says({"videos", "apt-get install ffmpeg"});
}

TEST_F(DiagnosisTest, SeveralCausesOneLineEach) {
    stage_nvidia();
    vulkan = {};
    fs::remove_all(folder / "usr/share/vulkan");
    variables = {{"NVIDIA_DRIVER_CAPABILITIES", "compute"}, {"XDG_CACHE_HOME", "/dev/null"}};
    EXPECT_EQ(causes(), "no-loader container-capability cache no-ffmpeg");
}

TEST(Surroundings, OfThisMachine) {
    const Surroundings real = Surroundings::real();
    EXPECT_TRUE(real.has("proc/self"));
    EXPECT_EQ(real.user, ::geteuid());
    EXPECT_EQ(real.loading_fault("libc.so.6"), "");
    EXPECT_NE(real.loading_fault("libnothing.so.77"), "");
    EXPECT_EQ(real.variable_or("PEELRAY_NO_SUCH_VARIABLE", "x"), "x");
    EXPECT_TRUE(real.text("proc/nothing").empty());
}

}  // namespace
}  // namespace peelray
