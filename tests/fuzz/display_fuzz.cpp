// SPDX-License-Identifier: Apache-2.0
// Input: four lines for --display, --view, --look and --exposure, then an OpenColorIO config; the
// shipped one where nothing is left.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tests/fuzz/memory_file.h"
#include "woodcock/base/error.h"
#include "woodcock/image/display.h"

namespace {

using namespace woodcock;

std::string takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    return line;
}

void show(const std::filesystem::path& config, const image::DisplaySettings& settings) {
    const image::ColorConfig colour(config);
    colour.chromaticities();
    std::array<float, 8> pixels{0.18f, 0.5f, 2.0f, 1.0f, 0.0f, -1.0f, 1e6f, 0.5f};
    colour.displayTransform(settings).apply(pixels);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    image::DisplaySettings settings;
    settings.display = takeLine(text);
    settings.view = takeLine(text);
    settings.look = takeLine(text);
    settings.exposure = std::strtod(takeLine(text).c_str(), nullptr);
    try {
        if (text.empty()) {
            show({}, settings);
        } else {
            const test::MemoryFile file(reinterpret_cast<const std::uint8_t*>(text.data()),
                                        text.size());
            show(file.path(), settings);
        }
    } catch (const Error&) {
    }
    return 0;
}
