// SPDX-License-Identifier: Apache-2.0
// A library with the functions of Open Image Denoise that Woodcock calls. It denoises nothing, but
// does what a test can compute: albedo alone is halved, normals alone are quartered, and colour
// gains both. $FAKE_OIDN says what goes wrong: "device", "version", "filter", "nan". To the file
// $FAKE_OIDN_LOG it adds a line for each filter.
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <string>

namespace {

bool failsAt(const char* what) {
    const char* wrong = std::getenv("FAKE_OIDN");
    return wrong && std::string(wrong) == what;
}

}  // namespace

struct Device {
    std::string error;
    int threads = 0;
    bool affinity = true, committed = false;
};

struct Filter {
    struct Image {
        float* pixels = nullptr;
        std::size_t width = 0, height = 0;
    };
    Device* device = nullptr;
    std::string type;
    std::map<std::string, Image> images;
    std::map<std::string, bool> flags;
    bool committed = false;
};

#define FAKE_OIDN_API extern "C" __attribute__((visibility("default")))

FAKE_OIDN_API Device* oidnNewDevice(int type) {
    return type == 1 && !failsAt("device") ? new Device : nullptr;
}
FAKE_OIDN_API void oidnSetDeviceBool(Device* device, const char* name, bool value) {
    if (std::string(name) == "setAffinity") device->affinity = value;
}
FAKE_OIDN_API void oidnSetDeviceInt(Device* device, const char* name, int value) {
    if (std::string(name) == "numThreads") device->threads = value;
}
FAKE_OIDN_API int oidnGetDeviceInt(Device*, const char* name) {
    const std::map<std::string, int> version{
        {"versionMajor", failsAt("version") ? 3 : 2}, {"versionMinor", 7}, {"versionPatch", 1}};
    const auto found = version.find(name);
    return found == version.end() ? -1 : found->second;
}
FAKE_OIDN_API void oidnCommitDevice(Device* device) { device->committed = true; }
FAKE_OIDN_API int oidnGetDeviceError(Device* device, const char** message) {
    static const std::string none = "no processor is good enough";
    static std::string last;
    last = device ? device->error : none;
    if (device) device->error.clear();
    *message = last.c_str();
    return last.empty() ? 0 : 1;
}
FAKE_OIDN_API void oidnReleaseDevice(Device* device) { delete device; }

FAKE_OIDN_API Filter* oidnNewFilter(Device* device, const char* type) {
    return new Filter{device, type, {}, {}, false};
}
FAKE_OIDN_API void oidnSetSharedFilterImage(Filter* filter, const char* name, void* pixels,
                                            int format, std::size_t width, std::size_t height,
                                            std::size_t byteOffset, std::size_t pixelStride,
                                            std::size_t rowStride) {
    if (format != 3 || byteOffset + pixelStride + rowStride != 0)
        filter->device->error = "the image has another layout";
    filter->images[name] = {static_cast<float*>(pixels), width, height};
}
FAKE_OIDN_API void oidnSetFilterBool(Filter* filter, const char* name, bool value) {
    filter->flags[name] = value;
}
FAKE_OIDN_API void oidnSetFilterInt(Filter*, const char*, int) {}
FAKE_OIDN_API void oidnCommitFilter(Filter* filter) { filter->committed = true; }
FAKE_OIDN_API void oidnExecuteFilter(Filter* filter) {
    if (!filter->committed || !filter->device->committed || filter->type != "RT")
        filter->device->error = "the filter is not ready";
    if (failsAt("filter")) filter->device->error = "the weights are lost";
    const auto& images = filter->images;
    const Filter::Image out = images.at("output");
    for (std::size_t i = 0; i < 3 * out.width * out.height; ++i) {
        const auto value = [&](const char* name) {
            const auto found = images.find(name);
            return found == images.end() ? 0.0f : found->second.pixels[i];
        };
        const bool beauty = images.count("color") > 0;
        out.pixels[i] = beauty ? value("color") + value("albedo") + value("normal")
                               : value("albedo") / 2 + value("normal") / 4;
        if (failsAt("nan")) out.pixels[i] = std::numeric_limits<float>::quiet_NaN();
    }
    if (const char* log = std::getenv("FAKE_OIDN_LOG")) {
        std::ofstream line(log, std::ios::app);
        for (const auto& [name, image] : images)
            line << name << ' ' << image.width << 'x' << image.height << ' ';
        for (const auto& [name, flag] : filter->flags)
            if (flag) line << name << ' ';
        line << "threads " << filter->device->threads << " affinity " << filter->device->affinity
             << '\n';
    }
}
FAKE_OIDN_API void oidnReleaseFilter(Filter* filter) { delete filter; }
