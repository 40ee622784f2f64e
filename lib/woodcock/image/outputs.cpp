// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/outputs.h"

#include <algorithm>
#include <new>

#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/image/image_format.h"
#include "woodcock/image/write_display.h"

namespace woodcock::image {

Outputs::Outputs(OutputSettings settings) : settings_(std::move(settings)) {
    const auto& files = settings_.files;
    for (auto file = files.begin(); file != files.end(); ++file) {
        if (std::find(files.begin(), file, *file) != file)
            throw usageError("output '{}' is named twice", file->string());
        const bool display = imageFormat(*file) != ImageFormat::Exr;
        checkWritable(*file);
        if (display && !transform_)
            transform_ = settings_.colour.displayTransform(settings_.display);
    }
}

ExrSettings Outputs::exrSettings() const {
    return {settings_.half, settings_.layers, settings_.colour.chromaticities(),
            settings_.colour.interopId(), settings_.multipart};
}

double Outputs::bytesPerPixel() const {
    constexpr double displayBytes = 4 * 4 + 3 * 4 + 2 * 4;  // floats, without alpha, and the file's
    double most = 0;
    for (const std::filesystem::path& file : settings_.files)
        most =
            std::max(most, imageFormat(file) == ImageFormat::Exr ? exrBytesPerPixel(exrSettings())
                                                                 : displayBytes);
    return most;
}

std::string Outputs::write(const Film& film, const RenderMetadata& metadata,
                           const FilmState* state) const {
    std::string failures, note;
    for (const std::filesystem::path& file : settings_.files) {
        try {
            if (imageFormat(file) == ImageFormat::Exr) {
                writeExr(file, film, metadata, exrSettings(), state);
                continue;
            }
            const double raised =
                writeDisplay(file, film, *transform_,
                             {settings_.withAlpha, settings_.glows, settings_.display.exposure});
            if (raised > 0 && note.empty())
                note = fmt::format(
                    "{}: {:.2g} % of the pixels emit more light than their alpha covers, as fire "
                    "does. This format cannot add light, so their alpha is raised to their "
                    "brightest channel. An EXR keeps light and alpha as they are",
                    file.string(), 100 * raised);
        } catch (const Error& e) {
            failures += (failures.empty() ? "" : "\n") + std::string(e.what());
        } catch (const std::bad_alloc&) {
            failures += fmt::format("{}cannot write '{}': there is not enough memory to encode it",
                                    failures.empty() ? "" : "\n", file.string());
        }
    }
    if (!failures.empty()) throw failure("{}", failures);
    return note;
}

}  // namespace woodcock::image
